//! Devices to render on, and renders that are long enough.

use super::gpu;
use lampray::device::Device;
use lampray::film::Film;
use lampray::render::{Task, render};
use lampray::scene::Scene;
use std::ops::{ControlFlow, Range};

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

/// The CPU twin, and the first graphics device where there is one. Without one, a line says that
/// half of the test is not run; with `LAMPRAY_REQUIRE_GPU=1` the test fails.
pub fn benches() -> Vec<Bench> {
    let test = std::thread::current();
    match gpu(test.name().unwrap_or("a test")) {
        Some(_) => vec![Bench::Twin, Bench::Vulkan],
        None => vec![Bench::Twin],
    }
}

impl Bench {
    /// Does something with the device.
    pub fn with<T>(self, what: impl FnOnce(&mut dyn Device) -> T) -> T {
        match self {
            Bench::Twin => what(&mut lampray::cpu::Cpu::new()),
            Bench::Vulkan => {
                let mut gpu = gpu("a device's answer").expect("only benches that are there");
                what(&mut *gpu)
            }
        }
    }

    /// Renders some samples of every pixel.
    pub fn film(self, scene: &Scene, samples: Range<u64>) -> Film {
        self.with(|device| trace(device, scene, samples))
    }

    /// Renders until the relative standard error of every channel is at most `precision`.
    ///
    /// A pilot of other samples tells how many are needed, so that the samples that count never
    /// decide on their own number. Where it misled, all are thrown away and twice as many taken.
    pub fn measure(self, scene: &Scene, precision: f64) -> Film {
        // Where the error is told by randomisations, those that are planned: the error of a few is a guess.
        let render = &scene.settings.render;
        let length = render.randomisation().unwrap_or(1);
        let least = if length > 1 {
            render.samples.next_multiple_of(length)
        } else {
            PILOT
        };
        let pilot = self.film(scene, 0..least);
        let most = (MOST_PATHS / pilot.region.area() as u64).max(least);
        let wanted = least as f64 * (relative_error(&pilot) / (0.95 * precision)).powi(2);
        let whole = |samples: u64| samples.next_multiple_of(length);
        let most = whole(most);
        let mut samples = whole((wanted.ceil() as u64).clamp(least, most));
        let mut start = least;
        loop {
            let film = self.film(scene, start..start + samples);
            if relative_error(&film) <= precision || samples == most {
                return film;
            }
            start += samples;
            samples = whole((2 * samples).min(most));
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
