//! From a rendering to a picture with its record.

use super::{Rendering, Task, adaptive, whole};
use crate::device::DeviceInfo;
use crate::film::{
    AdaptiveRecord, Aov, Features, Film, Picture, PilotRecord, Record, Seconds, Tiles,
};

/// Identifies a scene's text in records.
pub fn scene_hash(text: &str) -> String {
    blake3::hash(text.as_bytes()).to_hex()[..16].into()
}

/// The picture of a rendering, with the layers that were asked for. The record's outputs are still
/// empty, and its times hold what the rendering knows of them.
pub fn picture(task: &Task, device: &DeviceInfo, rendering: &Rendering, aovs: &[Aov]) -> Picture {
    let features = rendering
        .features
        .as_ref()
        .and_then(|pixels| Features::new(pixels, aovs));
    let text = task.scene.source.text.clone();
    rendering
        .film
        .picture(record(task, device, rendering), features, Some(text))
}

/// The record of a rendering as it stands, but for what its film knows.
pub fn record(task: &Task, device: &DeviceInfo, rendering: &Rendering) -> Record {
    let (scene, settings) = (task.scene, &task.scene.settings);
    let several = rendering.devices.len() > 1;
    let crop = (task.region != whole(scene)).then_some(task.region);
    Record {
        version: env!("CARGO_PKG_VERSION").into(),
        scene: scene.source.name.clone(),
        scene_hash: scene_hash(&scene.source.text),
        shader_hash: crate::shader::library_hash(),
        preset: settings.preset.to_string(),
        knobs: scene.knobs.clone(),
        kernel: device.traversal(task.traversal).to_string(),
        pilot: task.pilot().map(|pilot| PilotRecord {
            hash: pilot.hash(),
            paths: pilot.paths,
            rays: pilot.rays,
        }),
        device: device.clone(),
        devices: if several {
            rendering.devices.clone()
        } else {
            Vec::new()
        },
        width: task.region.width(),
        height: task.region.height(),
        crop: crop.map(|rect| [rect.x0, rect.y0, rect.x1, rect.y1]),
        samples: rendering.film.counts.iter().copied().min().unwrap_or(0),
        sample_range: taken(task.samples.start, &rendering.film),
        sample_ranges: Vec::new(),
        seed: settings.render.seed,
        complete: rendering.complete(),
        stopped: rendering.stopped,
        target_error: task.target_error,
        adaptive: rendering.scouts.as_ref().map(|scouts| AdaptiveRecord {
            rule: adaptive::RULE.into(),
            tile: Tiles::of(task.region).side(),
            allowed: vec![[task.samples.start, task.samples.end]],
            scout_paths: scouts.film.paths,
            scout_rays: scouts.film.rays,
            scout_non_finite: scouts.film.non_finite,
        }),
        biased: scene.biased(),
        denoised: None,
        seconds: Seconds {
            setup: rendering.setup.as_secs_f64(),
            render: rendering.tracing.as_secs_f64(),
            total: (rendering.setup + rendering.tracing).as_secs_f64(),
            longest_block: rendering.longest.as_secs_f64(),
        },
        paths: 0,
        rays: 0,
        non_finite: 0,
        mean: [0.0; 3],
        standard_error: None,
        error_estimate: rendering.film.error_estimate(),
        randomisation: settings.render.randomisation(),
        randomisation_means: Vec::new(),
        outputs: Vec::new(),
    }
}

/// The samples that some pixel has: a render that was stopped may have given some more than others.
fn taken(first: u64, film: &Film) -> [u64; 2] {
    [
        first,
        first + film.counts.iter().copied().max().unwrap_or(0),
    ]
}
