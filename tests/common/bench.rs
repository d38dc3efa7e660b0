//! Devices to render on, and renders that are long enough.

use lampray::device::Device;
use lampray::film::Film;
use lampray::gpu::{Gpu, adapters};
use lampray::render::{Task, render};
use lampray::scene::Scene;
use std::ops::{ControlFlow, Range};
use std::sync::{LazyLock, Mutex, PoisonError};

/// Samples of each pixel that tell how many more are needed; they are thrown away.
const PILOT: u64 = 32;
/// The most paths of one measurement: a case that needs more is too dear for this suite.
const MOST_PATHS: u64 = 60_000_000;

/// Where a test renders.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Bench {
    Twin,
    Vulkan,
}

/// One graphics device for the whole process: software drivers keep memory for each that was open.
static VULKAN: LazyLock<Option<Mutex<Gpu>>> = LazyLock::new(|| {
    let found = adapters();
    let Some(info) = found.infos().next() else {
        let required = std::env::var("LAMPRAY_REQUIRE_GPU").is_ok_and(|value| value == "1");
        assert!(
            !required,
            "LAMPRAY_REQUIRE_GPU=1, and there is no Vulkan device"
        );
        return None;
    };
    println!("Vulkan device: {} ({})", info.name, info.driver);
    let gpu = Gpu::open(&found, 0).unwrap_or_else(|error| panic!("{error}"));
    Some(Mutex::new(gpu))
});

/// The CPU twin, and the first graphics device where there is one. Without one, a line says that
/// half of the test is not run; with `LAMPRAY_REQUIRE_GPU=1` the test fails.
pub fn benches() -> Vec<Bench> {
    if VULKAN.is_some() {
        return vec![Bench::Twin, Bench::Vulkan];
    }
    let test = std::thread::current();
    let name = test.name().unwrap_or("a test").to_string();
    eprintln!("NOT RUN on Vulkan, for there is no Vulkan device: {name}");
    vec![Bench::Twin]
}

impl Bench {
    /// Renders some samples of every pixel.
    pub fn film(self, scene: &Scene, samples: Range<u64>) -> Film {
        match self {
            Bench::Twin => trace(&mut lampray::cpu::Cpu::new(), scene, samples),
            Bench::Vulkan => {
                let gpu = VULKAN.as_ref().expect("only benches that are there");
                // Another test's failure leaves the device as good as it was.
                let mut gpu = gpu.lock().unwrap_or_else(PoisonError::into_inner);
                trace(&mut *gpu, scene, samples)
            }
        }
    }

    /// Renders until the relative standard error of every channel is at most `precision`.
    ///
    /// A pilot of other samples tells how many are needed, so that the samples that count never
    /// decide on their own number. Where it misled, all are thrown away and twice as many taken.
    pub fn measure(self, scene: &Scene, precision: f64) -> Film {
        let pilot = self.film(scene, 0..PILOT);
        let most = (MOST_PATHS / pilot.region.area() as u64).max(PILOT);
        let wanted = PILOT as f64 * (relative_error(&pilot) / (0.95 * precision)).powi(2);
        let mut samples = (wanted.ceil() as u64).clamp(PILOT, most);
        let mut start = PILOT;
        loop {
            let film = self.film(scene, start..start + samples);
            if relative_error(&film) <= precision || samples == most {
                return film;
            }
            start += samples;
            samples = (2 * samples).min(most);
        }
    }
}

/// The largest of the channels' standard errors over their means.
fn relative_error(film: &Film) -> f64 {
    let (mean, error) = (film.picture_mean(), film.standard_error());
    let relative = |channel: usize| error[channel] / mean[channel].max(1e-30);
    (0..3).map(relative).fold(0.0, f64::max)
}

fn trace(device: &mut dyn Device, scene: &Scene, samples: Range<u64>) -> Film {
    let task = Task {
        samples,
        ..Task::new(scene)
    };
    let rendering = render(device, &task, &mut |_| ControlFlow::Continue(()));
    rendering.unwrap_or_else(|error| panic!("{error}")).film
}
