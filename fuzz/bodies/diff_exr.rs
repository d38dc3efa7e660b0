//! Any program's EXR.

use super::support;

pub fn run(bytes: &[u8]) {
    support::image(bytes);
}
