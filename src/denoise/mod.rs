//! From a picture to one without noise, for people who want to look at it. It is biased, so it is never the only one.
//!
//! ```text
//! Device::guides ─→ Site, shade ─┐
//! Picture: mean, variance, samples ┴→ Estimate ─spread variance─→ ─Device::denoise, step 1, 2, 4, ..→ Picture
//! ```
//!
//! What is filtered is light before the surfaces' albedo, so that a step in albedo costs nothing. How much of a
//! difference is noise goes by the variance of each pixel's mean, which is known: where there is none, nothing
//! changes. Light is counted in the picture's own brightness, each channel in its own, so that its unit does not matter.
//! Pixels that see something shine are filtered by themselves. Dammertz et al. (2010) and Schied et al. (2017), as `shaders/denoise.wgsl` says.

mod hands;
mod light;
mod passes;
mod sites;

use crate::device::Device;
use crate::error::Result;
use crate::film::{Denoised, Denoising, Picture};
use crate::pack::Packed;
use crate::render::{Spares, Task};
use hands::Hands;
use std::ops::ControlFlow;
use std::time::Instant;

pub use light::is_faint;
pub use passes::window;

/// The share of the time that guides take, about.
const GUIDES: f64 = 0.3;

/// Who watches: hears how much is done, 0 to 1, and may stop it.
pub type Watch<'a> = dyn FnMut(f64) -> ControlFlow<()> + 'a;

/// Denoises a picture of a task; none where `watch` stopped it. Where the device is lost the CPU twin goes on, if any
/// device will do.
///
/// # Errors
/// Those of the device's calls.
pub fn denoise<'a>(
    device: &'a mut Box<dyn Device>,
    task: &Task,
    picture: &Picture,
    by: Denoising,
    spares: Spares<'a>,
    watch: &mut Watch,
) -> Result<Option<Picture>> {
    let began = Instant::now();
    let packed = Packed::by(task.scene, task.traversal);
    let mut hands = Hands::new(device, packed, spares)?;
    let Some(mut lit) = sites::sites(&mut hands, task, by, watch)? else {
        return Ok(None);
    };
    let units = light::units(picture, &lit);
    let shades = light::shades(&lit, units);
    light::leave_out(picture, units, &shades, &mut lit.sites);
    let estimates = light::estimates(picture, units, &shades);
    let size = [picture.width, picture.height];
    let Some(smoothed) = passes::run(&mut hands, size, by, &lit.sites, estimates, watch)? else {
        return Ok(None);
    };
    let mean = light::means(picture, units, &shades, &smoothed);
    let mut record = picture.record.clone();
    record.mean = light::mean_of(&mean);
    record.denoised = Some(Denoised::new(
        by,
        [picture.record.mean, record.mean],
        light::of_unknown_variance(picture),
        began.elapsed().as_secs_f64(),
    ));
    Ok(Some(Picture {
        width: picture.width,
        height: picture.height,
        mean,
        variance: Vec::new(),
        samples: Vec::new(),
        features: None,
        record,
        scene_text: picture.scene_text.clone(),
    }))
}
