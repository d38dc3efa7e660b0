//! One measurement: a scene put onto a device and traced once.

use super::effort::Effort;
use super::machine::{forget_peak, peak};
use crate::device::Device;
use crate::error::Result;
use crate::film::Stop;
use crate::pack::{Packed, Traversal};
use crate::render::{self, Task};
use crate::scene::Scene;
use std::ops::ControlFlow;
use std::time::Instant;

/// What one measurement found; times in seconds.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Measured {
    pub effort: Effort,
    /// What found the bodies.
    pub kernel: Traversal,
    pub paths: u64,
    pub rays: u64,
    /// From the scene to its flat buffers.
    pub pack: f64,
    /// Getting those onto a fresh device: pipelines, uploading, the first dispatch, at which drivers compile.
    pub load: f64,
    /// The render after that, from scene to film.
    pub total: f64,
    /// The part of it in which the device worked, copying its results back included.
    pub tracing: f64,
    /// The part of `tracing` that copied results out of the device's memory.
    pub readback: f64,
    /// Bytes that the process held at most; on Linux.
    pub peak: Option<u64>,
}

impl Measured {
    /// Millions of rays a second of tracing, shadow rays included.
    pub fn mrays(&self) -> f64 {
        self.rays as f64 / self.tracing / 1e6
    }

    /// Millions of paths a second of tracing.
    pub fn msamples(&self) -> f64 {
        self.paths as f64 / self.tracing / 1e6
    }

    /// The share of a render that is not tracing: set-up, copying back, adding up.
    pub fn outside(&self) -> f64 {
        ((self.total - self.tracing + self.readback) / self.total).clamp(0.0, 1.0)
    }
}

/// Measures on a device that has compiled nothing yet; none where `watch` stopped it. Its argument is how
/// much is traced, 0 to 1.
///
/// # Errors
/// As [`render::render`].
pub fn measure(
    device: &mut dyn Device,
    scene: &mut Scene,
    effort: Effort,
    watch: &mut dyn FnMut(f64) -> ControlFlow<()>,
) -> Result<Option<Measured>> {
    effort.apply(scene);
    let counts_memory = forget_peak();
    let started = Instant::now();
    let packed = Packed::new(scene);
    let pack = started.elapsed().as_secs_f64();
    let started = Instant::now();
    device.load(&packed)?;
    let load = started.elapsed().as_secs_f64();
    drop(packed);
    let traced = trace(device, scene, effort, watch)?;
    Ok(traced.map(|traced| Measured {
        pack,
        load,
        peak: counts_memory.then(peak).flatten(),
        ..traced
    }))
}

/// The render itself, of a scene whose pipelines the device has.
fn trace(
    device: &mut dyn Device,
    scene: &Scene,
    effort: Effort,
    watch: &mut dyn FnMut(f64) -> ControlFlow<()>,
) -> Result<Option<Measured>> {
    let before = device.readback();
    let started = Instant::now();
    let task = Task::new(scene);
    let kernel = device.info().traversal(task.traversal);
    let rendering = render::render(device, &task, &mut |rendering| {
        watch(rendering.share()).map_break(|()| Stop::Signal)
    })?;
    let total = started.elapsed().as_secs_f64();
    let readback = device.readback() - before;
    Ok(rendering.complete().then(|| Measured {
        effort,
        kernel,
        paths: rendering.film.paths,
        rays: rendering.film.rays,
        pack: 0.0,
        load: 0.0,
        total,
        tracing: rendering.tracing.as_secs_f64().max(1e-9),
        readback: readback.as_secs_f64(),
        peak: None,
    }))
}

/// Finds how much work takes about `seconds` here; none where `watch` stopped it.
///
/// # Errors
/// As [`measure`].
pub fn calibrate(
    device: &mut dyn Device,
    scene: &mut Scene,
    seconds: f64,
    watch: &mut dyn FnMut(f64) -> ControlFlow<()>,
) -> Result<Option<(Effort, Measured)>> {
    let image = &scene.settings.image;
    let size = [image.width, image.height];
    let mut effort = Effort::least(size);
    let Some(first) = measure(device, scene, effort, watch)? else {
        return Ok(None);
    };
    let mut took = first.tracing;
    loop {
        let (next, last) = effort.next(size, took, seconds);
        if last {
            return Ok(Some((next, first)));
        }
        effort = next;
        effort.apply(scene);
        let Some(traced) = trace(device, scene, effort, watch)? else {
            return Ok(None);
        };
        took = traced.tracing;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bench::room;
    use crate::cpu::Cpu;

    #[test]
    fn a_measurement_counts_what_was_asked_for() {
        let mut scene = room(8, &[]).unwrap();
        let effort = Effort {
            width: 16,
            height: 16,
            samples: 4,
        };
        let go = &mut |_| ControlFlow::Continue(());
        let found = measure(&mut Cpu::new(), &mut scene, effort, go);
        let found = found.unwrap().expect("nothing stopped it");
        assert_eq!(found.paths, 16 * 16 * 4);
        assert!(found.rays > found.paths && found.tracing <= found.total);
        assert!((0.0..=1.0).contains(&found.outside()));
        let rates = found.mrays() / found.msamples();
        assert!((rates - found.rays as f64 / found.paths as f64).abs() < 1e-9);
    }

    #[test]
    fn a_stopped_measurement_is_none() {
        let mut scene = room(8, &[]).unwrap();
        let effort = Effort {
            width: 64,
            height: 64,
            samples: 64,
        };
        let stop = &mut |_| ControlFlow::Break(());
        let found = measure(&mut Cpu::new(), &mut scene, effort, stop).unwrap();
        assert_eq!(found, None);
        let found = calibrate(&mut Cpu::new(), &mut scene, 0.1, stop).unwrap();
        assert_eq!(found, None);
    }
}
