//! The program, as the cases run it.

use crate::support;
use lampray::film::{Picture, read_exr};
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Output, Stdio};

/// A camera at `eye` that looks along -z, and a few materials.
pub fn scene(eye: [f64; 3], more: &str) -> String {
    let [x, y, z] = eye;
    let ahead = z - 1.0_f64.max(z.abs());
    format!(
        "version = 1
[camera]
position = [{x:?}, {y:?}, {z:?}]
look_at = [{x:?}, {y:?}, {ahead:?}]
[materials.grey]
albedo = [0.5, 0.5, 0.5]
[materials.white]
albedo = [1, 1, 1]
{more}"
    )
}

/// An empty folder, with a scene in it.
pub struct Case {
    folder: tempfile::TempDir,
}

/// How the program ended.
#[derive(Debug)]
pub struct Ended {
    pub code: i32,
    pub said: String,
    pub printed: String,
}

impl Case {
    pub fn new(scene: &str) -> Self {
        let folder = tempfile::tempdir().unwrap();
        std::fs::write(folder.path().join("s.toml"), scene).unwrap();
        Self { folder }
    }

    pub fn path(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    fn command(&self, arguments: &[&str]) -> Command {
        let mut command = Command::new(env!("CARGO_BIN_EXE_lampray"));
        command.current_dir(self.folder.path()).args(arguments);
        command
    }

    pub fn run(&self, arguments: &[&str]) -> Ended {
        ended(self.command(arguments).output().unwrap())
    }

    /// The same where no more than so many bytes of addresses may be asked for.
    #[cfg(unix)]
    pub fn run_within(&self, bytes: u64, arguments: &[&str]) -> Ended {
        let mut command = Command::new("sh");
        let limited = format!("ulimit -v {}; exec \"$0\" \"$@\"", bytes / 1024);
        command.args(["-c", &limited, env!("CARGO_BIN_EXE_lampray")]);
        command.current_dir(self.folder.path()).args(arguments);
        ended(command.output().unwrap())
    }

    pub fn start(&self, arguments: &[&str]) -> Child {
        let mut command = self.command(arguments);
        command.stdout(Stdio::null()).stderr(Stdio::piped());
        command.spawn().unwrap()
    }

    /// Renders to a.exr by a device; the picture, or what was said instead.
    pub fn try_render(&self, device: &str, more: &[&str]) -> Result<Picture, Ended> {
        let file = ["render", "s.toml", "-q", "-o", "a.exr", "--device", device];
        let ended = self.run(&[&file, more].concat());
        match ended.code {
            0 => Ok(read_exr(self.path("a.exr")).unwrap()),
            _ => Err(ended),
        }
    }

    pub fn render(&self, device: &str, more: &[&str]) -> Picture {
        let outcome = self.try_render(device, more);
        outcome.unwrap_or_else(|ended| panic!("{device} {more:?}: {ended:?}"))
    }
}

fn ended(output: Output) -> Ended {
    let text = |bytes: &[u8]| String::from_utf8_lossy(bytes).into_owned();
    let said = text(&output.stderr);
    assert!(!said.contains("internal error"), "{said}");
    Ended {
        code: output.status.code().expect("an exit code, not a signal"),
        said,
        printed: text(&output.stdout),
    }
}

/// The CPU twin, and the first graphics device where there is one.
pub fn devices(what: &str) -> Vec<&'static str> {
    match support::gpu(what) {
        Some(_) => vec!["cpu", "0"],
        None => vec!["cpu"],
    }
}

/// The mean of a picture whose every number is finite and whose record says so.
pub fn mean(picture: &Picture) -> [f64; 3] {
    let numbers = [&picture.mean, &picture.variance];
    let fine = |value: &f32| value.is_finite() && *value >= 0.0;
    assert!(
        numbers
            .iter()
            .all(|plane| plane.as_flattened().iter().all(fine))
    );
    assert_eq!(picture.record.non_finite, 0);
    picture.record.mean
}

/// Every channel of a mean lies in a band.
pub fn within(mean: [f64; 3], low: f64, high: f64) -> bool {
    mean.iter().all(|value| (low..=high).contains(value))
}

/// The bands are narrow enough to tell.
#[test]
fn a_band_leaves_out_what_is_beside_it() {
    assert!(within([0.5; 3], 0.49, 0.51));
    assert!(!within([0.5, 0.52, 0.5], 0.49, 0.51));
    assert!(!within([0.5, 0.5, f64::NAN], 0.49, 0.51));
}

pub fn exists(path: &Path) -> bool {
    path.try_exists().unwrap()
}
