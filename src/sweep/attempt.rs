//! One render, of a run or of a reference, on a device that may be lost on the way.

use super::ledger::Status;
use super::run::Open;
use super::summary::Rules;
use crate::device::Device;
use crate::error::{Error, Result};
use crate::film::{Picture, Stop};
use crate::render::{self, Task};
use crate::scene::Scene;
use std::ops::ControlFlow;
use std::time::Instant;

/// How it ended.
pub(super) enum Attempt {
    Ok(Box<Picture>),
    Bad(Status, String),
    Stopped,
}

/// Hears how many paths are done, and may stop.
pub(super) type Hear<'a> = dyn FnMut(u64) -> ControlFlow<()> + 'a;

/// Renders, again where the rules say so, and says how many attempts it took. The device stays in
/// `device` for the next, unless it was lost.
///
/// # Errors
/// Those of opening a device.
pub(super) fn persist(
    scene: &Scene,
    device: &mut Option<Box<dyn Device>>,
    open: &mut Open,
    rules: Rules,
    hear: &mut Hear,
) -> Result<(Attempt, u32)> {
    let mut attempts = 0;
    loop {
        attempts += 1;
        let mut on = match device.take() {
            Some(device) => device,
            None => open()?,
        };
        let attempt = attempt(scene, on.as_mut(), rules, hear);
        let lost = matches!(attempt, Attempt::Bad(Status::DeviceLost, _));
        // A lost device does not come back, but another one may.
        *device = (!lost).then_some(on);
        match attempt {
            Attempt::Bad(..) if attempts <= rules.retries => {}
            end => return Ok((end, attempts)),
        }
    }
}

fn attempt(scene: &Scene, device: &mut dyn Device, rules: Rules, hear: &mut Hear) -> Attempt {
    let started = Instant::now();
    let task = Task::one_of_many(scene);
    if let Err(error) = render::refuse_too_large(&task) {
        return Attempt::Bad(Status::Failed, error.to_string());
    }
    let (mut stopped, mut late) = (false, false);
    let rendering = render::render(device, &task, &mut |rendering| {
        late = rules.timeout.is_some_and(|limit| started.elapsed() > limit);
        stopped = hear(rendering.film.paths).is_break();
        if late || stopped {
            ControlFlow::Break(if late { Stop::Time } else { Stop::Signal })
        } else {
            ControlFlow::Continue(())
        }
    });
    match rendering {
        Ok(rendering) if rendering.complete() => {
            let mut picture = render::picture(&task, device.info(), &rendering, &[]);
            picture.record.seconds.total = started.elapsed().as_secs_f64();
            Attempt::Ok(Box::new(picture))
        }
        Ok(_) if stopped => Attempt::Stopped,
        Ok(_) => {
            let seconds = rules.timeout.unwrap_or_default().as_secs_f64();
            Attempt::Bad(Status::Timeout, format!("not done after {seconds} s"))
        }
        Err(Error::DeviceLost(reason)) => Attempt::Bad(Status::DeviceLost, reason),
        Err(error) => Attempt::Bad(Status::Failed, error.to_string()),
    }
}
