//! Pictures of renders that were stopped, when some pixels had more samples than others: rendered again to the same
//! pixels, or not at all.

use crate::room::room;
use lampray::cpu::Cpu;
use lampray::film::{Picture, Stop, Target, merge, read_exr};
use lampray::render::{Plan, Rendering, Task, go_on_by, picture, render};
use lampray::scene::Scene;
use std::collections::BTreeSet;
use std::ops::ControlFlow;
use std::path::Path;
use std::process::{Command, Output};

fn stopped_scene() -> Scene {
    room(&["image.width=40", "image.height=24", "render.samples=9000"])
}

/// Renders a while, by small blocks, and writes `p.exr` and `p.png` as a render does whose time is up.
fn stopped(folder: &Path, adaptive: bool, blocks: usize) -> Picture {
    let scene = stopped_scene();
    let task = Task {
        target_error: Some(0.004),
        adaptive,
        ..Task::new(&scene)
    };
    let mut rendering = Rendering::new(&task);
    let (mut before, mut left) = (0, blocks);
    let mut watch = |rendering: &Rendering| {
        left -= usize::from(rendering.traced() > before);
        before = rendering.traced();
        match left {
            0 => ControlFlow::Break(Stop::Time),
            _ => ControlFlow::Continue(()),
        }
    };
    let plan = Plan::with_budget(task.region, task.samples.clone(), 5000);
    let plan = if adaptive { plan } else { plan.with_looks() };
    go_on_by(&mut Cpu::new(), &task, plan, &mut rendering, &mut watch).expect("some blocks");
    assert_eq!(rendering.stopped, Some(Stop::Time));
    let picture = picture(&task, &rendering.devices[0], &rendering, &[]);
    let names = ["p.exr", "p.png"].map(|name| folder.join(name));
    for target in Target::prepare_all(&names).expect("a folder") {
        target.write(&picture).expect("a file");
    }
    picture
}

fn rerun(folder: &Path, from: &str, to: &str) -> Output {
    let mut command = Command::new(env!("CARGO_BIN_EXE_lampray"));
    command.args(["rerun", from, "-o", to]).current_dir(folder);
    command.output().expect("the program runs")
}

fn counts(picture: &Picture) -> usize {
    let counts = picture.samples.iter().map(|count| *count as u64);
    counts.collect::<BTreeSet<_>>().len()
}

/// The record says what the first did of how many samples there were to be, and where.
fn assert_same_end(again: &Picture, first: &Picture) {
    let [again, first] = [&again.record, &first.record];
    assert!(!again.complete && again.stopped == Some(Stop::Time));
    assert_eq!(again.target_error, Some(0.004));
    assert_eq!(again.adaptive, first.adaptive);
    assert_eq!(again.samples, first.samples);
    assert_eq!(again.sample_range, first.sample_range);
}

/// The sum of a picture and of samples that are all there.
fn with_another_range(folder: &Path, name: &str) -> Picture {
    let scene = stopped_scene();
    let task = Task {
        samples: 9000..9016,
        ..Task::new(&scene)
    };
    let rendering = render(&mut Cpu::new(), &task, &mut |_| ControlFlow::Continue(()));
    let rendering = rendering.expect("a picture");
    let other = picture(&task, &rendering.devices[0], &rendering, &[]);
    assert!(other.record.complete);
    let path = folder.join("other.exr");
    for target in Target::prepare_all(std::slice::from_ref(&path)).expect("a folder") {
        target.write(&other).expect("a file");
    }
    merge(&[folder.join(name), path], false).expect("two parts of one render")
}

#[test]
fn stopped_pictures_are_rendered_again_to_the_same_pixels() {
    for (adaptive, blocks) in [(false, 30), (false, 47), (true, 30), (true, 150)] {
        let folder = tempfile::tempdir().expect("a folder");
        let at = folder.path();
        let first = stopped(at, adaptive, blocks);
        assert!(counts(&first) > 1, "{adaptive}, {blocks}: all are alike");
        // What was rendered again can be once more.
        for (from, to) in [("p.exr", "q.exr"), ("q.exr", "r.exr")] {
            let output = rerun(at, from, to);
            assert!(output.status.success(), "{output:?}");
            let again = read_exr(at.join(to)).expect("a picture");
            assert!(again.samples == first.samples, "{adaptive}, {blocks}");
            assert!(again.mean == first.mean && again.variance == first.variance);
            assert_same_end(&again, &first);
            let told = String::from_utf8_lossy(&output.stderr);
            let [least, most] = [first.record.samples, first.record.sample_range[1]];
            let range = format!("{least} to {most} (mean ");
            assert_eq!(told.contains(&range), adaptive, "{told}");
            // The first one's time was up, not this one's.
            assert!(!told.contains("time is up"), "{told}");
        }
        let sum = with_another_range(at, "q.exr");
        assert!(!sum.record.complete && sum.record.stopped == Some(Stop::Time));
        let output = rerun(at, "p.png", "s.exr");
        let told = String::from_utf8_lossy(&output.stderr);
        assert_eq!(output.status.code(), Some(65), "{told}");
        assert!(told.contains("give the EXR"), "{told}");
        assert!(!at.join("s.exr").exists());
    }
}
