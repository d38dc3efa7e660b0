//! The samples that are taken depend on the seed and the scene alone.

use crate::room::{Fragile, lost, room};
use crate::support::bench::benches;
use lampray::cpu::Cpu;
use lampray::device::Device;
use lampray::film::{Checkpoint, Film, Scouts, Stop};
use lampray::pack::Rect;
use lampray::render::{Plan, Rendering, Spares, Task, endure, go_on_by, record};
use lampray::scene::{Assignment, Scene};
use std::ops::ControlFlow;
use std::path::Path;

/// Three tiles by two, those at the edges cut; some need a few times as many samples as others.
fn scene() -> Scene {
    room(&["image.width=39", "image.height=21", "render.samples=9000"])
}

const TARGET: f64 = 0.006;

fn task(scene: &Scene) -> Task<'_> {
    Task {
        target_error: Some(TARGET),
        adaptive: true,
        ..Task::new(scene)
    }
}

/// All that a render has measured.
fn sums(rendering: &Rendering) -> (Film, Scouts) {
    let scouts = rendering.scouts.clone();
    (rendering.film.clone(), scouts.expect("adaptive"))
}

/// Goes on by blocks of `budget` samples, and stops after some.
fn go_on_a_while(
    device: &mut dyn Device,
    task: &Task,
    budget: u64,
    blocks: usize,
    rendering: &mut Rendering,
) {
    let (mut before, mut left) = (rendering.traced(), blocks);
    let mut watch = |rendering: &Rendering| {
        left -= usize::from(rendering.traced() > before && left > 0);
        before = rendering.traced();
        match left {
            0 => ControlFlow::Break(Stop::Signal),
            _ => ControlFlow::Continue(()),
        }
    };
    let plan = Plan::with_budget(task.region, task.samples.clone(), budget);
    go_on_by(device, task, plan, rendering, &mut watch).expect("some blocks");
}

fn in_one_go(device: &mut dyn Device, task: &Task, budget: u64) -> Rendering {
    let mut rendering = Rendering::new(task);
    go_on_a_while(device, task, budget, usize::MAX, &mut rendering);
    rendering
}

/// What a checkpoint of it gives back.
fn reread(task: &Task, rendering: &Rendering) -> Rendering {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("c");
    let mut head = record(task, &rendering.devices[0], rendering);
    rendering.film.describe(&mut head);
    let samples = [task.samples.start, task.samples.end];
    let scouts = rendering.scouts.as_ref();
    Checkpoint::save(&path, &head, samples, &rendering.film, scouts).expect("a checkpoint");
    let checkpoint = Checkpoint::read(&path).expect("a checkpoint");
    assert_eq!(checkpoint.scouts.as_ref(), scouts);
    Rendering::of_checkpoint(task, checkpoint).expect("of this task")
}

#[test]
fn tiles_get_what_they_need() {
    let scene = scene();
    let rendering = in_one_go(&mut Cpu::new(), &task(&scene), 1 << 16);
    let (film, scouts) = sums(&rendering);
    let counts = &film.counts;
    assert!(
        counts.iter().max() > counts.iter().min(),
        "all alike: {:?}",
        scouts.wanted
    );
    for (pixel, count) in counts.iter().enumerate() {
        let tile = pixel / 39 / 16 * 3 + pixel % 39 / 16;
        assert_eq!(*count, scouts.wanted[tile], "pixel {pixel}");
        assert_eq!(scouts.film.counts[pixel], scouts.asked, "pixel {pixel}");
    }
    assert!(scouts.asked > 16, "{}", scouts.asked);
    assert_eq!(rendering.stopped, Some(Stop::TargetError));
    assert!(film.relative_error().reaches(TARGET));
}

/// Pictures of other samples by the same scouts share them out alike wherever they climbed as far: no sample of a
/// picture has a say in what its own tile gets beside the others.
#[test]
fn tiles_share_by_their_scouts_alone() {
    let small = ["image.width=48", "image.height=48", "render.max_bounces=3"];
    let sets: Vec<_> = small
        .iter()
        .map(|set| Assignment::parse(set).expect("a knob"))
        .collect();
    let path = Path::new("scenes/cornell-small-lamp.toml");
    let scene = Scene::load(path, &sets).expect("a scene");
    let of_range = |number: u64| {
        let task = Task {
            target_error: Some(0.07),
            samples: number << 40..(number << 40) + 2000,
            adaptive: true,
            ..Task::new(&scene)
        };
        sums(&in_one_go(&mut Cpu::new(), &task, 1 << 22)).1
    };
    let all: Vec<_> = (0..5).map(of_range).collect();
    let mut alike = 0;
    for (one, other) in all.iter().zip(&all[1..]) {
        assert!(one.asked == 16 && one.film == other.film, "{}", one.asked);
        // Before there are scouts all tiles climb alike: what they had then says nothing.
        let least = |scouts: &Scouts| scouts.wanted.iter().copied().min();
        let before = least(one).max(least(other)).expect("tiles");
        let climbed = |scouts: &Scouts| -> Vec<u64> {
            scouts
                .wanted
                .iter()
                .map(|count| *count.max(&before))
                .collect()
        };
        if one.rung == other.rung {
            assert_eq!(climbed(one), climbed(other));
            alike += climbed(one).iter().filter(|count| **count > before).count();
        }
    }
    assert!(alike > 8, "{alike} tiles of pictures that climbed as far");
}

/// Of any block size, on either device.
#[test]
fn the_split_changes_no_bit() {
    let scene = scene();
    let whole = task(&scene);
    let crop = Task {
        region: Rect {
            x0: 3,
            y0: 2,
            x1: 38,
            y1: 20,
        },
        samples: 5..2000,
        ..whole.clone()
    };
    for bench in benches() {
        bench.with(|device| {
            for task in [&whole, &crop] {
                let wanted = sums(&in_one_go(device, task, 1 << 22));
                for budget in [3000, 40_000] {
                    assert!(
                        sums(&in_one_go(device, task, budget)) == wanted,
                        "{bench:?}, {budget}"
                    );
                }
            }
        });
    }
}

/// Stopped in the picture's first samples, among the scouts and on the climb, saved, read and gone on with.
#[test]
fn a_render_goes_on_from_any_block() {
    let scene = scene();
    let task = task(&scene);
    let wanted = sums(&in_one_go(&mut Cpu::new(), &task, 1 << 22));
    let (mut among_scouts, mut climbing) = (0, 0);
    for (budget, blocks) in [(700, 9), (5000, 4), (20_000, 1), (1 << 22, 1)] {
        let mut rendering = Rendering::new(&task);
        while matches!(rendering.stopped, None | Some(Stop::Signal)) {
            go_on_a_while(&mut Cpu::new(), &task, budget, blocks, &mut rendering);
            let stopped = rendering.stopped;
            rendering = reread(&task, &rendering);
            rendering.stopped = stopped;
            let scouts = rendering.scouts.as_ref().expect("adaptive");
            let pixels = scouts.film.counts.len() as u64;
            let scouting = scouts.film.paths < scouts.asked * pixels;
            among_scouts += usize::from(scouts.film.paths > 0 && scouting);
            climbing += usize::from(scouts.rung > 0 && !scouting);
        }
        assert!(sums(&rendering) == wanted, "{blocks} blocks of {budget}");
    }
    assert!(
        among_scouts > 3 && climbing > 3,
        "{among_scouts} {climbing}"
    );
}

/// A checkpoint whose sums no adaptive render of the task can have left is not gone on from.
#[test]
fn sums_of_another_rule_are_refused() {
    let scene = scene();
    let task = task(&scene);
    let rendering = in_one_go(&mut Cpu::new(), &task, 1 << 22);
    let goes_on = |change: &dyn Fn(&mut Rendering)| {
        let mut rendering = rendering.clone();
        change(&mut rendering);
        let mut watch = |_: &_| ControlFlow::Continue(());
        lampray::render::go_on(&mut Cpu::new(), &task, &mut rendering, &mut watch).is_ok()
    };
    let scouts = |change: fn(&mut Scouts)| {
        goes_on(&|rendering| change(rendering.scouts.as_mut().expect("adaptive")))
    };
    assert!(goes_on(&|_| {}));
    assert!(!goes_on(&|rendering| rendering.scouts = None));
    assert!(!goes_on(&|rendering| rendering.film.counts[7] += 16));
    assert!(!goes_on(&|rendering| rendering.film.counts[7] -= 1));
    assert!(!scouts(|scouts| scouts.asked = 0));
    assert!(!scouts(|scouts| scouts.asked = 1 << 40));
    assert!(!scouts(|scouts| scouts.asked += 16));
    assert!(!scouts(|scouts| scouts.rung = 0));
    assert!(!scouts(|scouts| scouts.rung += 19));
    assert!(!scouts(|scouts| scouts.rung = u64::MAX));
    assert!(!scouts(|scouts| scouts.wanted[1] = 17));
    assert!(!scouts(|scouts| scouts.wanted[1] = u64::MAX));
    assert!(!scouts(|scouts| scouts.wanted[1] = 32));
    assert!(!scouts(|scouts| scouts.wanted.truncate(3)));
    assert!(!scouts(|scouts| scouts.film.counts[3] *= 2));
}

/// A device that is lost among the first samples, the scouts or the rest costs nothing but its blocks in flight.
#[test]
fn a_lost_device_changes_no_bit() {
    let scene = scene();
    let task = task(&scene);
    let wanted = sums(&in_one_go(&mut Cpu::new(), &task, 1 << 22));
    for blocks in [0, 1, 5, 12] {
        let mut rendering = Rendering::new(&task);
        let mut device = Fragile::boxed(blocks, lost);
        let mut told = 0;
        let spares = Spares {
            anew: &mut || Ok(Fragile::boxed(usize::MAX, lost)),
            any: false,
            tell: &mut |_| told += 1,
        };
        endure(&mut device, &task, &mut rendering, spares, &mut |_| {
            ControlFlow::Continue(())
        })
        .expect("it goes on");
        assert!(
            sums(&rendering) == wanted && told == 1,
            "lost after {blocks}"
        );
    }
}
