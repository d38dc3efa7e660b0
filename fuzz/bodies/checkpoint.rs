//! A checkpoint: as it is, and with its checksum made right, without which no change is read. What is read is
//! gone on with.

use super::support;
use lampray::cpu::Cpu;
use lampray::film::{Checkpoint, Stop};
use lampray::pack::Traversal;
use lampray::render::{self, Rendering, Task};
use lampray::scene::Scene;
use std::ops::ControlFlow;

/// Bytes of the hash at the end.
const HASH: usize = 32;
const SCENE: &str = r#"version = 1
[camera]
position = [0, 0, 4]
look_at = [0, 0, 0]
[image]
width = 4
height = 3
[background]
emission = [1, 1, 1]
[materials.a]
[[spheres]]
center = [0, 0, 0]
radius = 1
material = "a"
"#;

pub fn run(bytes: &[u8]) {
    read(bytes);
    read(&mended(bytes));
}

fn mended(bytes: &[u8]) -> Vec<u8> {
    let content = &bytes[..bytes.len().saturating_sub(HASH)];
    [content, blake3::hash(content).as_bytes()].concat()
}

fn read(bytes: &[u8]) {
    let file = support::file(bytes);
    let checkpoint = match Checkpoint::read(file.path()) {
        Ok(checkpoint) => checkpoint,
        Err(error) => return support::refusal(&error),
    };
    let film = &checkpoint.film;
    let pixels = film.region.area();
    assert!(pixels > 0);
    assert_eq!(
        [film.sums.len(), film.squares.len(), film.counts.len()],
        [pixels; 3]
    );
    assert_eq!(film.counts.iter().sum::<u64>(), film.paths);
    let scene = Scene::parse("fuzz.toml", SCENE, &[]).expect("a scene");
    let [from, to] = checkpoint.samples;
    let task = Task {
        region: film.region,
        samples: from..to,
        traversal: Traversal::General,
        ..Task::new(&scene)
    };
    let mut other = checkpoint.record.clone();
    other.seed ^= 1;
    let refused = checkpoint.refuse_other(file.path(), &other, checkpoint.samples);
    support::refusal(&refused.expect_err("another seed is another render"));
    // The command line says which region and samples there are; these are legal.
    let whole = render::whole(&scene);
    if film.region.x1 > whole.x1 || film.region.y1 > whole.y1 || from >= to || to > 1 << 63 {
        return;
    }
    if let Some(rendering) = Rendering::of_checkpoint(&task, checkpoint) {
        go_on(&task, rendering);
    }
}

/// One block more, which shows that there was nothing in the checkpoint that could not be added to.
fn go_on(task: &Task, mut rendering: Rendering) {
    let before = rendering.film.paths;
    let mut watch = |_: &Rendering| ControlFlow::Break(Stop::Time);
    let outcome = render::go_on(&mut Cpu::new(), task, &mut rendering, &mut watch);
    outcome.expect("the CPU twin goes on");
    assert!(rendering.film.paths >= before);
    let _ = render::record(task, &lampray::cpu::info(), &rendering);
}
