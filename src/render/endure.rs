//! A render that outlives its device.

use super::{Rendering, Task, Watch, go_on};
use crate::cpu::Cpu;
use crate::device::{Device, DeviceKind};
use crate::error::{Error, Result};

/// What a render may go on with when its device fails.
pub struct Spares<'a> {
    /// Opens the same device anew.
    pub anew: &'a mut dyn FnMut() -> Result<Box<dyn Device>>,
    /// Whether any other device will do.
    pub any: bool,
    /// Hears in a line what happened.
    pub tell: &'a mut dyn FnMut(&str),
}

/// Renders what is left of a task, on other devices where one fails.
///
/// When a device is lost the blocks in flight are thrown away, and the device is opened anew once; if that one
/// is lost before it has done anything, or cannot be opened, the CPU twin goes on where any device will do. A
/// device that cannot take the scene has its part done again by the CPU twin from the start: which of the samples it can
/// take depends on how the work is split, and the picture must not.
///
/// # Errors
/// As [`go_on`], where there is no other device; `rendering` then holds all that was done.
pub fn endure(
    device: &mut Box<dyn Device>,
    task: &Task,
    rendering: &mut Rendering,
    spares: Spares,
    watch: &mut Watch,
) -> Result<()> {
    let Spares { anew, any, tell } = spares;
    let mut tried_anew = false;
    loop {
        let before = rendering.traced();
        let Err(error) = go_on(device.as_mut(), task, rendering, watch) else {
            return Ok(());
        };
        let twin_is_left = any && device.info().kind != DeviceKind::Cpu;
        tried_anew &= rendering.traced() == before;
        *device = match &error {
            Error::DeviceLost(reason) if !tried_anew => {
                tried_anew = true;
                match anew() {
                    Ok(fresh) => {
                        tell(&format!("{reason}; going on with it opened anew"));
                        fresh
                    }
                    Err(_) if twin_is_left => twin(reason, tell),
                    Err(_) => return Err(error),
                }
            }
            Error::DeviceLost(reason) if twin_is_left => twin(reason, tell),
            Error::Device(reason) if twin_is_left => {
                *rendering = Rendering::new(task);
                twin(reason, tell)
            }
            _ => return Err(error),
        };
    }
}

fn twin(reason: &str, tell: &mut dyn FnMut(&str)) -> Box<dyn Device> {
    tell(&format!(
        "{reason}; rendering with the built-in CPU renderer"
    ));
    Box::new(Cpu::new())
}
