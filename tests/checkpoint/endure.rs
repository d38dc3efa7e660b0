//! Renders whose device is lost.

use super::room::{Fragile, lost, room, undisturbed};
use lampray::device::DeviceKind;
use lampray::render::{Rendering, Spares, Task, endure};
use lampray::{Error, Result};
use std::ops::ControlFlow;

/// Renders on a device that is lost after `first` blocks; `next` are those that follow it, none for one that does not open. What the
/// rendering came to, and what was told.
fn endured(
    task: &Task,
    first: usize,
    next: &[Option<usize>],
    any: bool,
) -> (Result<()>, Rendering, Vec<String>) {
    let mut rendering = Rendering::new(task);
    let mut device = Fragile::boxed(first, lost);
    let mut told = Vec::new();
    let mut next = next.iter();
    let outcome = endure(
        &mut device,
        task,
        &mut rendering,
        Spares {
            anew: &mut || match next.next().expect("no device is opened but these") {
                Some(blocks) => Ok(Fragile::boxed(*blocks, lost)),
                None => Err(Error::Device("there is no such device".into())),
            },
            any,
            tell: &mut |text| told.push(text.to_string()),
        },
        &mut |_: &_| ControlFlow::Continue(()),
    );
    (outcome, rendering, told)
}

fn kinds(rendering: &Rendering) -> Vec<DeviceKind> {
    rendering.devices.iter().map(|device| device.kind).collect()
}

const ENOUGH: usize = usize::MAX;

#[test]
fn a_lost_device_is_opened_anew() {
    let scene = room(&[]);
    let task = Task::new(&scene);
    let wanted = undisturbed(&task);
    for blocks in 0..3 {
        let (outcome, rendering, told) = endured(&task, blocks, &[Some(ENOUGH)], false);
        outcome.expect("it goes on");
        assert_eq!(rendering.film, wanted, "{blocks}");
        assert_eq!(kinds(&rendering), [DeviceKind::Hardware]);
        assert!(
            told.len() == 1 && told[0].contains("opened anew"),
            "{told:?}"
        );
    }
}

/// Each time it has done something it may be opened again.
#[test]
fn a_device_that_is_lost_now_and_then_comes_to_an_end() {
    let scene = room(&["render.samples=400"]);
    let task = Task::new(&scene);
    let (outcome, rendering, told) =
        endured(&task, 2, &[Some(1), Some(2), Some(1), Some(ENOUGH)], false);
    outcome.expect("it goes on");
    assert_eq!(rendering.film, undisturbed(&task));
    assert_eq!(told.len(), 4, "{told:?}");
}

#[test]
fn a_device_that_is_lost_at_once_gives_way_to_the_twin() {
    let scene = room(&[]);
    let task = Task::new(&scene);
    let wanted = undisturbed(&task);
    for (first, next) in [(0, Some(0)), (3, Some(0)), (3, None)] {
        let (outcome, rendering, told) = endured(&task, first, &[next], true);
        outcome.expect("the twin goes on");
        // The fragile one traces as the twin does, so that no block is lost and none is there twice.
        assert_eq!(rendering.film, wanted);
        assert_eq!(kinds(&rendering), [DeviceKind::Hardware, DeviceKind::Cpu]);
        let last = told.last().expect("a line");
        assert!(last.contains("built-in CPU renderer"), "{told:?}");
    }
}

#[test]
fn a_device_that_is_asked_for_has_no_stand_in() {
    let scene = room(&[]);
    let task = Task::new(&scene);
    let mut before = 0;
    for (first, next) in [(0, Some(0)), (2, Some(0)), (3, None)] {
        let (outcome, rendering, _) = endured(&task, first, &[next], false);
        assert!(matches!(outcome, Err(Error::DeviceLost(_))), "{outcome:?}");
        assert!(!rendering.complete());
        // What was done is still there, to be saved.
        assert!(rendering.film.paths > before || first == 0);
        assert_eq!(
            rendering.film.counts.iter().sum::<u64>(),
            rendering.film.paths
        );
        before = rendering.film.paths;
    }
}

/// What a device cannot take, only another kind of device can.
#[test]
fn a_scene_that_a_device_cannot_take_is_begun_anew_by_the_twin() {
    let scene = room(&[]);
    let task = Task::new(&scene);
    for (any, goes_on) in [(true, true), (false, false)] {
        let mut rendering = Rendering::new(&task);
        let mut device = Fragile::boxed(2, || Error::Device("too long a path".into()));
        let outcome = endure(
            &mut device,
            &task,
            &mut rendering,
            Spares {
                anew: &mut || panic!("the same device cannot take it either"),
                any,
                tell: &mut |_| {},
            },
            &mut |_: &_| ControlFlow::Continue(()),
        );
        assert_eq!(outcome.is_ok(), goes_on);
        if goes_on {
            assert_eq!(rendering.film, undisturbed(&task));
            assert_eq!(kinds(&rendering), [DeviceKind::Cpu]);
            assert_eq!(device.info().kind, DeviceKind::Cpu);
        }
    }
}
