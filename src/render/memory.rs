//! How much memory a render takes, and whether there is that much: a machine that runs out of it kills programs
//! without asking, hours after they began.

use super::{Task, plan};
use crate::error::{Error, Result};
use crate::knobs::LightChoice;
use crate::pack::Tally;
use std::fs;
use std::path::{Path, PathBuf};
use std::thread;

/// Program, driver, compiler.
const FIXED: u64 = 192 << 20;
/// Of a pixel: sums in f64, the picture made of them in f32, and its PNG on the way to the disk.
const PIXEL: u64 = 56 + 28 + 9;
/// Of a pixel with layers of first hits: as traced, and as planes.
const FEATURES: u64 = 32 + 32;
/// Of a pixel while its picture is denoised: the picture as it was, what is known of the pixel without noise, and its
/// light as it is and as it will be; then the picture as it becomes and its PNG on the way to the disk.
const DENOISED: u64 = 28 + 48 + 12 + 3 * 16 + 12 + 9;
/// Of a pixel whose samples are shared out by scouts: their sums, how far it is, and what follows from the sums.
const SCOUTS: u64 = 56 + 32 + 10 * 8;
/// Of a pixel whose samples are cut into randomisations: the sum of the open one.
const RANDOMISED: u64 = 24;
/// Of a body: as parsed, as packed, in its tree while that is built, and all of that on the device.
const BODY: u64 = 1024;
/// Of a lamp, one of which is chosen: its pair of the light tree while that is built, as packed, and on the
/// device. The alias table takes less.
const CHOSEN_LAMP: u64 = 512;
/// Results of a block are in the device's memory and in the host's, of several blocks at a time.
const TALLY_COPIES: u64 = 10;

/// Addresses of a graphics driver on the CPU with its compiler; measured are 0.85 GiB of lavapipe with two threads.
const DRIVER: u64 = 768 << 20;
/// Addresses of a thread: its stack and the arena that it allocates from, most of both never touched.
const THREAD: u64 = 80 << 20;

/// The most memory that rendering a task and writing its picture is expected to take, bytes.
pub fn memory_estimate(task: &Task) -> u64 {
    let pixels = task.region.area() as u64;
    let bodies = (task.scene.spheres.len() + task.scene.boxes.len()) as u64;
    let lamps = match task.scene.settings.light.choice {
        LightChoice::All => 0,
        _ => task.scene.lamps().count() as u64,
    };
    let randomised = task.scene.settings.render.randomisation().is_some();
    let of_pixel = PIXEL
        + if task.features { FEATURES } else { 0 }
        + if task.denoised { DENOISED } else { 0 }
        + if randomised { RANDOMISED } else { 0 }
        + if task.terms().is_some() { SCOUTS } else { 0 };
    let tallies = plan::most_tallies(task.region, &task.samples) * size_of::<Tally>() as u64;
    let of_scene = bodies * BODY + lamps * CHOSEN_LAMP;
    FIXED + of_scene + pixels.saturating_mul(of_pixel) + tallies * TALLY_COPIES
}

/// Refuses a render that this machine, or the control group that the program runs in, has too little memory for.
/// Where neither is known nothing is refused.
///
/// # Errors
/// [`Error::TooLarge`] with the estimate and the limit.
pub fn refuse_too_large(task: &Task) -> Result<()> {
    let Some((limit, whose)) = limit() else {
        return Ok(());
    };
    let wanted = memory_estimate(task);
    if wanted <= limit {
        return Ok(());
    }
    Err(Error::TooLarge(format!(
        "{} x {} pixels take about {} of memory, and {whose} is {}: render parts of the image by --crop, or fewer pixels",
        task.region.width(),
        task.region.height(),
        shown(wanted),
        shown(limit)
    )))
}

/// Refuses to load graphics drivers into too small an address space: short of memory they end the whole program,
/// where this only says so.
///
/// # Errors
/// [`Error::Device`] with what is wanted and the limit.
pub fn refuse_drivers() -> Result<()> {
    let threads = thread::available_parallelism().map_or(1, |count| count.get() as u64);
    // Threads of the driver, and those of this program.
    let wanted = DRIVER + 2 * threads * THREAD;
    match address_space() {
        Some(limit) if limit < wanted => Err(Error::Device(format!(
            "graphics drivers may need {} of address space, and the limit of this process (ulimit -v) is {}: raise it, or use --device cpu",
            shown(wanted),
            shown(limit)
        ))),
        _ => Ok(()),
    }
}

fn shown(bytes: u64) -> String {
    format!("{:.1} GiB", bytes as f64 / (1u64 << 30) as f64)
}

/// The memory that there is, bytes, and whose limit that is.
fn limit() -> Option<(u64, &'static str)> {
    let machine = fs::read_to_string("/proc/meminfo").unwrap_or_default();
    let machine = memory_of_machine(&machine).map(|bytes| (bytes, "this machine's"));
    let own = address_space().map(|bytes| (bytes, "the limit of this process (ulimit -v)"));
    let groups = fs::read_to_string("/proc/self/cgroup").unwrap_or_default();
    let group = limit_of_groups(&groups, Path::new("/sys/fs/cgroup"))
        .map(|bytes| (bytes, "the limit of its control group"));
    machine.into_iter().chain(own).chain(group).min()
}

/// The most addresses that this process may have, bytes, where there is such a limit.
fn address_space() -> Option<u64> {
    address_space_of(&fs::read_to_string("/proc/self/limits").ok()?)
}

/// `Max address space` of /proc/self/limits: the limit in force, then the highest that it may be set to.
fn address_space_of(text: &str) -> Option<u64> {
    let line = text
        .lines()
        .find_map(|line| line.strip_prefix("Max address space"))?;
    line.split_whitespace().next()?.parse().ok()
}

/// `MemTotal` of /proc/meminfo.
fn memory_of_machine(text: &str) -> Option<u64> {
    let line = text
        .lines()
        .find_map(|line| line.strip_prefix("MemTotal:"))?;
    let kilobytes: u64 = line.trim().strip_suffix("kB")?.trim().parse().ok()?;
    kilobytes.checked_mul(1024)
}

/// The smallest limit of the groups that /proc/self/cgroup names and of those that they are in, of both versions
/// of control groups.
fn limit_of_groups(text: &str, root: &Path) -> Option<u64> {
    let files = text.lines().filter_map(|line| {
        let mut parts = line.splitn(3, ':').skip(1);
        let (controllers, group) = (parts.next()?, parts.next()?);
        match controllers {
            "" => Some((root.to_path_buf(), group, "memory.max")),
            names if names.split(',').any(|name| name == "memory") => {
                Some((root.join("memory"), group, "memory.limit_in_bytes"))
            }
            _ => None,
        }
    });
    let limits = files.flat_map(|(root, group, name)| {
        let own: PathBuf = root.join(group.trim_start_matches('/'));
        let up: Vec<_> = own.ancestors().map(Path::to_path_buf).collect();
        // In a container the group's own folder may be mounted as the root.
        up.into_iter()
            .take_while(move |folder| folder.starts_with(&root))
            .filter_map(move |folder| fs::read_to_string(folder.join(name)).ok())
    });
    limits.filter_map(|text| text.trim().parse().ok()).min()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::pack::Rect;
    use crate::scene::Scene;

    #[test]
    fn the_smallest_limit_counts() {
        let root = tempfile::tempdir().unwrap();
        let job = root.path().join("slurm/job_7");
        fs::create_dir_all(&job).unwrap();
        fs::write(job.join("memory.max"), "max\n").unwrap();
        fs::write(root.path().join("slurm/memory.max"), "4096\n").unwrap();
        fs::write(root.path().join("memory.max"), "8192\n").unwrap();
        let text = "0::/slurm/job_7\n";
        assert_eq!(limit_of_groups(text, root.path()), Some(4096));
        assert_eq!(limit_of_groups("0::/\n", root.path()), Some(8192));
        assert_eq!(limit_of_groups("", root.path()), None);

        let old = root.path().join("memory/job");
        fs::create_dir_all(&old).unwrap();
        fs::write(old.join("memory.limit_in_bytes"), "1000\n").unwrap();
        let text = "5:cpu,memory:/job\n4:pids:/job\n";
        assert_eq!(limit_of_groups(text, root.path()), Some(1000));
    }

    #[test]
    fn a_machine_says_what_it_has() {
        let text = "MemFree: 1 kB\nMemTotal:       24689764 kB\n";
        assert_eq!(memory_of_machine(text), Some(24_689_764 * 1024));
        assert_eq!(memory_of_machine("MemTotal: much\n"), None);
    }

    #[test]
    fn a_process_may_be_limited() {
        let of = |limit: &str| {
            address_space_of(&format!(
                "Limit  Soft Limit  Hard Limit  Units\nMax address space  {limit}  unlimited  bytes\n"
            ))
        };
        assert_eq!(of("819200000"), Some(819_200_000));
        assert_eq!(of("unlimited"), None);
        assert_eq!(address_space_of(""), None);
    }

    #[test]
    fn the_largest_picture_of_many_layers_is_estimated() {
        let text = "version = 1\ncamera = { position = [0, 0, 0], look_at = [0, 0, -1] }\n";
        let scene = Scene::parse("a.toml", text, &[]).unwrap();
        let region = Rect {
            x0: 0,
            y0: 0,
            x1: 16384,
            y1: 16384,
        };
        let task = Task {
            region,
            ..Task::new(&scene)
        };
        let gib = memory_estimate(&task) as f64 / (1u64 << 30) as f64;
        assert!((23.0..25.0).contains(&gib), "{gib}");
        let layers = Task {
            features: true,
            ..task
        };
        assert!(memory_estimate(&layers) > (39 << 30));
        let denoised = Task {
            denoised: true,
            features: false,
            ..layers
        };
        let gib = memory_estimate(&denoised) as f64 / (1u64 << 30) as f64;
        assert!((62.0..65.0).contains(&gib), "{gib}");
    }
}
