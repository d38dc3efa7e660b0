//! Scenes, pictures that are made up, and the denoiser run on them.

use crate::fragile::{Fault, Fragile};
use crate::support::stream::Stream;
use lampray::Result;
use lampray::cpu::Cpu;
use lampray::denoise::denoise;
use lampray::device::Device;
use lampray::film::{Denoising, Picture};
use lampray::render::{Rendering, Spares, Task, picture, render};
use lampray::scene::{Assignment, Scene};
use std::ops::ControlFlow;

/// A scene of the folder `scenes` in another size.
pub fn shipped(name: &str, width: u32, height: u32, samples: u64) -> Scene {
    shipped_with(name, width, height, samples, &[])
}

/// The same with knobs set.
pub fn shipped_with(name: &str, width: u32, height: u32, samples: u64, knobs: &[String]) -> Scene {
    let sets = [
        format!("image.width={width}"),
        format!("image.height={height}"),
        format!("render.samples={samples}"),
        "render.seed=5".into(),
    ];
    let assignments: Vec<_> = sets
        .iter()
        .chain(knobs)
        .map(|set| Assignment::parse(set).unwrap())
        .collect();
    let path = format!("{}/scenes/{name}.toml", env!("CARGO_MANIFEST_DIR"));
    Scene::load(path.as_ref(), &assignments).unwrap()
}

/// A camera at the origin that looks along -z at what is given, in 64 x 64 pixels.
pub fn scene(bodies: &str) -> Scene {
    let text = format!(
        "version = 1\ncamera = {{ position = [0, 0, 0], look_at = [0, 0, -1], fov = 40 }}\nimage = {{ width = 64, height = 64 }}\n\
         materials.white.albedo = [0.8, 0.8, 0.8]\nmaterials.dark.albedo = [0.2, 0.1, 0.05]\n{bodies}"
    );
    Scene::parse("room.toml", &text, &[]).unwrap()
}

pub fn body(min: [f64; 3], max: [f64; 3], material: &str) -> String {
    format!("[[boxes]]\nmin = {min:?}\nmax = {max:?}\nmaterial = \"{material}\"\n")
}

/// A picture whose pixels have this expectation, each the mean of `samples` paths; a path's brightness follows an
/// exponential law, all channels together, as uneven as indirect light.
pub fn made_up(task: &Task, expected: impl Fn(u32, u32) -> [f64; 3], samples: u32) -> Picture {
    let mut picture = picture(task, &lampray::cpu::info(), &Rendering::new(task), &[]);
    let mut stream = Stream::new(11);
    let (width, count) = (picture.width, f64::from(samples));
    for pixel in 0..picture.pixels() {
        let at = pixel as u32;
        let expected = expected(at % width, at / width);
        let draws: Vec<f64> = (0..samples).map(|_| -(1.0 - stream.unit()).ln()).collect();
        let mean = draws.iter().sum::<f64>() / count;
        let squares: f64 = draws.iter().map(|draw| (draw - mean).powi(2)).sum();
        let variance = squares / (count - 1.0);
        picture.mean[pixel] = expected.map(|value| (value * mean) as f32);
        picture.variance[pixel] = expected.map(|value| (value * value * variance) as f32);
        picture.samples[pixel] = samples as f32;
    }
    picture
}

/// Renders on the CPU twin.
pub fn rendered(task: &Task) -> Picture {
    let mut twin = Cpu::new();
    let rendering = render(&mut twin, task, &mut |_| ControlFlow::Continue(())).unwrap();
    picture(task, twin.info(), &rendering, &[])
}

/// Denoises to the end; `any` is whether the CPU twin may step in.
pub fn denoised_by(
    device: &mut Box<dyn Device>,
    task: &Task,
    picture: &Picture,
    any: bool,
) -> Result<Picture> {
    let spares = Spares {
        anew: &mut || panic!("no other device is asked for"),
        any,
        tell: &mut |_| (),
    };
    let mut watch = |_| ControlFlow::Continue(());
    denoise(device, task, picture, Denoising::USUAL, spares, &mut watch)
        .map(|picture| picture.expect("nobody stopped it"))
}

/// With something wrong in every pass.
pub fn denoised_with(fault: Fault, task: &Task, picture: &Picture) -> Picture {
    let mut device: Box<dyn Device> = Box::new(Fragile::new(usize::MAX, fault));
    denoised_by(&mut device, task, picture, false).unwrap()
}

/// On the CPU twin.
pub fn denoised(task: &Task, picture: &Picture) -> Picture {
    let mut twin: Box<dyn Device> = Box::new(Cpu::new());
    denoised_by(&mut twin, task, picture, false).unwrap()
}

/// Mean of a channel over the pixels of columns and rows.
pub fn mean(
    picture: &Picture,
    channel: usize,
    columns: std::ops::Range<u32>,
    rows: std::ops::Range<u32>,
) -> f64 {
    let count = columns.len() * rows.len();
    let at =
        |(x, y): (u32, u32)| f64::from(picture.mean[(y * picture.width + x) as usize][channel]);
    let all = rows.flat_map(|y| columns.clone().map(move |x| (x, y)));
    all.map(at).sum::<f64>() / count as f64
}
