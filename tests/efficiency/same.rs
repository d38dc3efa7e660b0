//! The bits of a picture.

use super::pilot::room;
use crate::support::bench::benches;
use lampray::film::{Checkpoint, Film};
use lampray::render::{Plan, Rendering, Task, go_on, go_on_by, record};
use std::ops::ControlFlow;

fn film(device: &mut dyn lampray::device::Device, task: &Task) -> Film {
    let mut rendering = Rendering::new(task);
    go_on(device, task, &mut rendering, &mut |_| {
        ControlFlow::Continue(())
    })
    .unwrap();
    rendering.film
}

#[test]
fn splits_and_stops_change_no_bit() {
    let scene = room(&[]);
    let task = Task::new(&scene);
    for bench in benches() {
        bench.with(|device| {
            let wanted = film(device, &task);
            for budget in [1, 300, 5000] {
                let plan = Plan::with_budget(task.region, task.samples.clone(), budget);
                let mut rendering = Rendering::new(&task);
                let mut blocks = 0;
                let mut stop = |_: &Rendering| {
                    blocks += 1;
                    match blocks < 4 {
                        true => ControlFlow::Continue(()),
                        false => ControlFlow::Break(lampray::film::Stop::Signal),
                    }
                };
                go_on_by(device, &task, plan, &mut rendering, &mut stop).unwrap();
                let mut on = |_: &Rendering| ControlFlow::Continue(());
                // A task of its own, which asks for a pilot of its own.
                go_on(device, &Task::new(&scene), &mut rendering, &mut on).unwrap();
                assert_eq!(rendering.film, wanted, "{bench:?}, {budget}");
            }
        });
    }
}

#[test]
fn ways_to_find_bodies_change_no_bit() {
    for bench in benches() {
        let by = |kernel: &str| {
            let scene = room(&[&format!("render.kernel={kernel}")]);
            bench.with(|device| film(device, &Task::new(&scene)))
        };
        let wanted = by("general");
        assert_eq!(by("bvh"), wanted, "{bench:?}");
        assert_eq!(by("baked"), wanted, "{bench:?}");
    }
}

/// Devices round differently, and now and then a ray meets another body for it.
#[test]
fn devices_agree_on_nearly_every_pixel() {
    let scene = room(&[]);
    let films: Vec<_> = benches()
        .into_iter()
        .map(|bench| bench.with(|device| film(device, &Task::new(&scene))))
        .collect();
    let [twin, .., other] = films.as_slice() else {
        return;
    };
    let near = |pixel: usize| {
        let (a, b) = (twin.mean(pixel), other.mean(pixel));
        (0..3).all(|c| (a[c] - b[c]).abs() <= 1e-4 * a[c].max(0.01))
    };
    let apart = (0..twin.counts.len()).filter(|pixel| !near(*pixel)).count();
    assert!(apart * 50 <= twin.counts.len(), "{apart} pixels");
}

#[test]
fn records_tell_the_pilot_and_checkpoints_of_another_are_refused() {
    let scene = room(&[]);
    let task = Task::new(&scene);
    let info = lampray::cpu::info();
    let told = record(&task, &info, &Rendering::new(&task));
    let pilot = told.pilot.clone().expect("a pilot is recorded");
    assert_eq!(pilot.hash, task.pilot().unwrap().hash());
    assert!(pilot.paths > 0 && pilot.rays > pilot.paths);
    let checkpoint = |record| Checkpoint {
        scouts: None,
        record,
        samples: [0, 40],
        film: Film::new(task.region),
    };
    let path = std::path::Path::new("c");
    checkpoint(told.clone())
        .refuse_other(path, &told, [0, 40])
        .unwrap();
    let mut other = told.clone();
    other.pilot.as_mut().unwrap().hash = "another".into();
    let error = checkpoint(other)
        .refuse_other(path, &told, [0, 40])
        .unwrap_err();
    assert!(error.to_string().contains("pilot"), "{error}");
}

#[test]
fn literal_weights_are_refused() {
    let sets =
        ["interruption.weight=literal"].map(|set| lampray::scene::Assignment::parse(set).unwrap());
    let refused = lampray::scene::Scene::parse("room", super::pilot::ROOM, &sets);
    let error = refused.expect_err("a literal pilot").to_string();
    assert!(
        error.contains("interruption.rule") && error.contains("compensated"),
        "{error}"
    );
}
