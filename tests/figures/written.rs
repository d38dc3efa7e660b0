//! The folder of files, as it is written.

use super::sample::{about, figures};
use lampray::figures::files;

/// For eyes and for the check in a browser: writes the sample to the folder that is named.
#[test]
#[ignore = "writes where FIGURES_FOLDER says"]
fn sample_is_written() {
    let folder = std::env::var_os("FIGURES_FOLDER").expect("FIGURES_FOLDER names a folder");
    files::write(folder.as_ref(), &figures(), &about()).unwrap();
}
