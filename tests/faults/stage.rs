//! A folder with a scene, and the program run in it.

use lampray::device::DeviceKind;
use lampray::film::{Checkpoint, read_exr};
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Output, Stdio};
use std::sync::OnceLock;
use std::thread::sleep;
use std::time::{Duration, Instant};

const SCENE: &str = r#"version = 1
[camera]
position = [0.0, 1.0, 3.4]
look_at = [0.0, 1.0, 0.0]
[image]
width = 24
height = 16
[render]
max_bounces = 4
[materials.white]
albedo = [0.7, 0.7, 0.7]
[materials.mirror]
scatter = "mirror"
[materials.lamp]
emission = [20.0, 20.0, 20.0]
[[spheres]]
center = [0.0, 1.7, 0.0]
radius = 0.15
material = "lamp"
[[spheres]]
center = [-0.45, 0.4, -0.4]
radius = 0.4
material = "mirror"
[[boxes]]
min = [-1.1, -0.1, -1.1]
max = [1.1, 0.0, 1.1]
material = "white"
"#;

/// A render of about a second on one core, to be disturbed.
pub const LONG: &[&str] = &[
    "render",
    "s.toml",
    "-o",
    "o.exr",
    "--no-times",
    "--spp",
    "12000",
];
/// A render that is over at once.
pub const SHORT: &[&str] = &["render", "s.toml", "-o", "o.exr", "--spp", "4"];
/// A render that does not end by itself.
pub const ENDLESS: &[&str] = &["render", "s.toml", "-o", "o.exr", "--spp", "1000000000"];
pub const CPU: &[&str] = &["--device", "cpu"];
/// The first graphics device, and no other.
pub const GRAPHICS: &[&str] = &["--device", "0"];
/// A checkpoint when the render stops.
pub const SAVED: &[&str] = &["--checkpoint", "c"];
/// Checkpoints as often as can be.
pub const KEPT: &[&str] = &["--checkpoint", "c", "--checkpoint-every", "0.02"];
pub const RESUMED: &[&str] = &[
    "--checkpoint",
    "c",
    "--checkpoint-every",
    "0.02",
    "--resume",
];

/// Longer than anything that a row waits for takes, on any machine.
const FOREVER: Duration = Duration::from_secs(120);

pub struct Stage {
    folder: tempfile::TempDir,
}

impl Stage {
    pub fn new() -> Self {
        let folder = tempfile::tempdir().expect("a folder");
        fs::write(folder.path().join("s.toml"), SCENE).expect("the scene");
        Self { folder }
    }

    pub fn path(&self) -> &Path {
        self.folder.path()
    }

    pub fn join(&self, name: impl AsRef<Path>) -> PathBuf {
        self.path().join(name)
    }

    /// What a render is to find in its way.
    pub fn old(&self, name: &str) -> &Self {
        fs::write(self.join(name), "old").expect("an old file");
        self
    }

    /// Another scene under the same name.
    pub fn change_scene(&self) {
        let changed = SCENE.replace("radius = 0.4", "radius = 0.41");
        fs::write(self.join("s.toml"), changed).expect("the scene");
    }

    /// The program in this folder. It renders with one thread, which is as fast on every machine.
    pub fn command(&self, parts: &[&[&str]]) -> Command {
        let mut command = Command::new(env!("CARGO_BIN_EXE_lampray"));
        self.set_up(&mut command).args(parts.concat());
        command
    }

    /// A script in which `lampray` is the program.
    pub fn script(&self, script: &str) -> Command {
        let mut command = Command::new("sh");
        let text = format!("lampray() {{ \"$LAMPRAY\" \"$@\"; }}\n{script}");
        self.set_up(&mut command).args(["-c", &text]);
        command
    }

    fn set_up<'a>(&self, command: &'a mut Command) -> &'a mut Command {
        if std::env::var_os("XDG_RUNTIME_DIR").is_none() {
            // The Vulkan loader complains without.
            command.env("XDG_RUNTIME_DIR", std::env::temp_dir());
        }
        command
            .current_dir(self.path())
            .env("LAMPRAY", env!("CARGO_BIN_EXE_lampray"))
            .env("RAYON_NUM_THREADS", "1")
            .stdin(Stdio::null())
    }

    pub fn run(&self, parts: &[&[&str]]) -> Output {
        self.command(parts).output().expect("the program runs")
    }

    /// Under a limit of the shell's, such as `ulimit -v 100000`.
    pub fn run_limited(&self, limit: &str, parts: &[&[&str]]) -> Output {
        let mut command = self.script(&format!("{limit}; exec \"$LAMPRAY\" \"$@\""));
        let command = command.arg("sh").args(parts.concat());
        command.output().expect("the program runs")
    }

    /// As a user for whom modes of files count, which they do not for root.
    pub fn run_as_anybody(&self, parts: &[&[&str]]) -> Output {
        if !is_root() {
            return self.run(parts);
        }
        let mut command = Command::new("setpriv");
        let command = self.set_up(&mut command).args(["--bounding-set", "-all"]);
        let command = command
            .arg(env!("CARGO_BIN_EXE_lampray"))
            .args(parts.concat());
        command.output().expect("setpriv of util-linux")
    }

    /// With variables of the environment.
    pub fn run_with(&self, variables: &[(&str, &str)], parts: &[&[&str]]) -> Output {
        let mut command = self.command(parts);
        for (name, value) in variables {
            command.env(name, value);
        }
        command.output().expect("the program runs")
    }

    pub fn start(&self, parts: &[&[&str]]) -> Running {
        let mut command = self.command(parts);
        Running::start(command.stdout(Stdio::piped()))
    }

    /// Waits until a file of the folder is there.
    pub fn wait_for(&self, name: &str) {
        self.wait_until(name, || self.join(name).exists());
    }

    pub fn wait_until(&self, what: &str, is_so: impl Fn() -> bool) {
        let started = Instant::now();
        while !is_so() {
            assert!(started.elapsed() < FOREVER, "waiting for {what}");
            sleep(Duration::from_millis(2));
        }
    }

    /// Waits for a checkpoint in which every pixel has a sample, and for the one before it; or for the end of the
    /// program that is to write them.
    pub fn wait_for_checkpoints(&self, child: &Running) {
        let is_so = || {
            let saved = Checkpoint::read(&self.join("c"));
            saved.is_ok_and(|saved| !saved.film.counts.contains(&0))
                && self.join("c.previous").exists()
        };
        self.wait_until("checkpoints", || is_so() || child.has_ended());
    }

    /// Starts the program and sends it a signal once there are checkpoints of a picture.
    pub fn stop(&self, signal: &str, parts: &[&[&str]]) -> Output {
        let child = self.start(parts);
        self.wait_for_checkpoints(&child);
        send(signal, &child);
        child.end()
    }

    /// Leaves a checkpoint of a render that was ended by SIGTERM, with the one before it.
    pub fn stopped(&self, parts: &[&[&str]]) -> &Self {
        for _ in 0..10 {
            let output = self.stop("TERM", parts);
            if self.is_checkpoint("c") && self.is_checkpoint("c.previous") {
                assert_eq!(output.status.code(), Some(143), "{output:?}");
                return self;
            }
            // On a machine with much else to do it may have come to its end before.
            assert!(output.status.success() || self.join("o.exr").exists());
        }
        panic!("ten renders ended before they could be stopped");
    }

    /// The picture of the same command in a folder of its own.
    pub fn elsewhere(parts: &[&[&str]]) -> Vec<u8> {
        let stage = Self::new();
        let output = stage.run(parts);
        assert!(output.status.success(), "{output:?}");
        fs::read(stage.join("o.exr")).expect("a picture")
    }

    pub fn read(&self, name: &str) -> Vec<u8> {
        fs::read(self.join(name)).unwrap_or_default()
    }

    /// A bit in the middle of a file is another.
    pub fn flip_bit(&self, name: &str) {
        let mut bytes = self.read(name);
        let middle = bytes.len() / 2;
        bytes[middle] ^= 4;
        fs::write(self.join(name), bytes).expect("a damaged file");
    }

    pub fn cut_in_half(&self, name: &str) {
        let bytes = self.read(name);
        fs::write(self.join(name), &bytes[..bytes.len() / 2]).expect("a short file");
    }

    pub fn is_checkpoint(&self, name: &str) -> bool {
        Checkpoint::read(&self.join(name)).is_ok()
    }
}

/// The program at work; it does not outlive the test.
pub struct Running(Option<Child>);

impl Running {
    pub fn start(command: &mut Command) -> Self {
        let child = command.stderr(Stdio::piped()).spawn();
        Self(Some(child.expect("the program runs")))
    }

    pub fn id(&self) -> u32 {
        self.0.as_ref().map_or(0, Child::id)
    }

    /// Whether it has ended, though nobody has asked for what it said.
    pub fn has_ended(&self) -> bool {
        let state = fs::read_to_string(format!("/proc/{}/stat", self.id()));
        state.is_ok_and(|state| state.contains(") Z "))
    }

    /// Waits for its end.
    pub fn end(mut self) -> Output {
        let child = self.0.take().expect("it was started");
        child.wait_with_output().expect("its words")
    }
}

impl Drop for Running {
    fn drop(&mut self) {
        if let Some(mut child) = self.0.take() {
            let _ = child.kill();
            let _ = child.wait();
        }
    }
}

/// Sends a signal by its name.
pub fn send(signal: &str, child: &Running) {
    let mut kill = Command::new("kill");
    let kill = kill.args([&format!("-{signal}"), &child.id().to_string()]);
    assert!(kill.status().expect("kill runs").success());
}

/// The bytes of the picture that [`LONG`] gives where nothing goes wrong, on the kind of device that made the
/// picture at `path`.
pub fn undisturbed(path: &Path) -> Vec<u8> {
    static PICTURES: [OnceLock<Vec<u8>>; 2] = [OnceLock::new(), OnceLock::new()];
    let on_cpu = read_exr(path).is_ok_and(|picture| picture.record.device.kind == DeviceKind::Cpu);
    let device = if on_cpu { CPU } else { GRAPHICS };
    let picture = PICTURES[usize::from(on_cpu)].get_or_init(|| Stage::elsewhere(&[LONG, device]));
    picture.clone()
}

pub fn is_root() -> bool {
    let output = Command::new("id").arg("-u").output().expect("id runs");
    output.stdout == b"0\n"
}

pub fn words(output: &Output) -> String {
    String::from_utf8_lossy(&output.stderr).into_owned()
}

/// Makes a FIFO.
pub fn fifo(path: &Path) {
    let made = Command::new("mkfifo").arg(path).status();
    assert!(made.expect("mkfifo runs").success());
}
