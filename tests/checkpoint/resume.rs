//! Going on gives the bits of a render that never stopped.

use super::room::{after, room, undisturbed};
use crate::sample::Folder;
use lampray::cpu::Cpu;
use lampray::device::{Block, Device};
use lampray::film::{Checkpoint, Film, Stop};
use lampray::pack::{Packed, Rect};
use lampray::render::{Rendering, Task, go_on, record};
use std::ops::ControlFlow;

/// Goes on to the end from what a file holds; none where it can hold nothing of the task.
fn resumed(task: &Task, rendering: &Rendering, folder: &Folder) -> Option<Rendering> {
    let mut record = record(task, &rendering.devices[0], rendering);
    rendering.film.describe(&mut record);
    let path = folder.join("c");
    let samples = [task.samples.start, task.samples.end];
    let scouts = rendering.scouts.as_ref();
    Checkpoint::save(&path, &record, samples, &rendering.film, scouts).expect("a checkpoint");
    let checkpoint = Checkpoint::read(&path).expect("a checkpoint");
    let mut rendering = Rendering::of_checkpoint(task, checkpoint)?;
    let mut watch = |_: &_| ControlFlow::Continue(());
    go_on(&mut Cpu::new(), task, &mut rendering, &mut watch).expect("the rest");
    Some(rendering)
}

/// Whole images, crops, ranges that start within a run; and samples that are cut into randomisations.
fn each_task(check: impl Fn(&Task)) {
    let scene = room(&[]);
    let whole = Task::new(&scene);
    let crop = Rect {
        x0: 2,
        y0: 1,
        x1: 5,
        y1: 4,
    };
    check(&whole);
    check(&Task {
        samples: 5..77,
        ..whole.clone()
    });
    check(&Task {
        region: crop,
        samples: 16..40,
        ..whole
    });
    for sequence in ["render.sequence=sobol", "render.sequence=blue-noise"] {
        let scene = room(&[sequence, "render.randomisations=2"]);
        let whole = Task::new(&scene);
        check(&Task {
            region: crop,
            samples: 32..100,
            ..whole.clone()
        });
        check(&whole);
    }
}

#[test]
fn a_render_goes_on_from_any_block() {
    let folder = Folder::new();
    each_task(|task| {
        let wanted = undisturbed(task);
        for budget in [1, 40, 300, 2000] {
            for blocks in [1, 2, 3, 7, 20] {
                let rendering = resumed(task, &after(task, budget, blocks), &folder);
                let rendering = rendering.expect("of this task");
                assert_eq!(rendering.film, wanted, "{blocks} blocks of {budget}");
                assert!(rendering.complete());
            }
        }
    });
}

/// The comparison finds a block that is added twice, or left out: without that it would prove nothing.
#[test]
fn a_block_too_many_or_too_few_is_found() {
    let scene = room(&[]);
    let task = Task::new(&scene);
    let wanted = undisturbed(&task);
    let mut device = Cpu::new();
    let packed = Packed::new(&scene);
    device.load(&packed).expect("a scene");
    let block = Block {
        rect: Rect {
            x0: 0,
            y0: 0,
            x1: 7,
            y1: 1,
        },
        first_sample: 0,
        samples: 16,
    };
    let tallies = device.trace(block.rect, block.first_sample, block.samples);
    let tallies = tallies.expect("a block");

    let mut twice = wanted.clone();
    twice.add_block(&block, &tallies);
    assert_ne!(twice, wanted);
    // Nor can such a film be gone on from.
    let folder = Folder::new();
    let mut rendering = after(&task, 40, 7);
    rendering.film.add_block(&block, &tallies);
    let outcome = resumed(&task, &rendering, &folder);
    assert!(outcome.is_none(), "a row has samples that no plan gives it");
    let mut fewer = wanted.clone();
    fewer.counts[3] -= 1;
    assert_ne!(fewer, wanted);
}

/// Where a render stops by its error depends on its samples alone.
#[test]
fn a_stop_by_error_does_not_depend_on_the_split() {
    let scene = room(&["render.samples=3000"]);
    let task = Task {
        target_error: Some(0.12),
        ..Task::new(&scene)
    };
    let folder = Folder::new();
    let stops = |film: &Film| (film.counts[0], film.paths);
    let wanted = undisturbed(&task);
    let (count, _) = stops(&wanted);
    assert!((64..3000).contains(&count), "stopped at {count}");
    for budget in [1, 100, 5000, 1 << 20] {
        let whole = after(&task, budget, usize::MAX);
        assert_eq!(whole.stopped, Some(Stop::TargetError), "{budget}");
        assert_eq!(whole.film, wanted, "{budget}");
        for blocks in [1, 3, 8, 30] {
            let part = after(&task, budget, blocks);
            if part.stopped == Some(Stop::TargetError) {
                assert_eq!(part.film, wanted, "{blocks} blocks of {budget}");
                continue;
            }
            let rendering = resumed(&task, &part, &folder).expect("of this task");
            assert_eq!(rendering.stopped, Some(Stop::TargetError));
            assert_eq!(rendering.film, wanted, "{blocks} blocks of {budget}");
        }
    }
    // A smaller error takes more samples: the rule does something.
    let smaller = Task {
        target_error: Some(0.08),
        ..task.clone()
    };
    assert!(stops(&undisturbed(&smaller)) > stops(&wanted));
}
