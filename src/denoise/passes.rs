//! The passes over a picture, block by block: the device sees a window at a time, whatever the picture's size.

use super::hands::Hands;
use super::{GUIDES, Watch};
use crate::error::Result;
use crate::film::Denoising;
use crate::pack::{DenoiseJob, Estimate, Rect, Site};

/// Pixels of a block, each way: a dispatch takes some hundredths of a second on two cores.
const BLOCK: u32 = 256;
/// Passes that spread the variance before: what few samples say of it is very uncertain, and low where by chance
/// the bright ones are missing.
const SPREADS: u32 = 2;
/// What a pass takes for noise of the differences that the one before took: what is left is less and less noise, and
/// neighbours have taps in common, which their variance does not show. Dammertz et al. halve it, without a variance.
const NARROWING: f64 = 0.85;
/// Taps on each side.
const REACH: u32 = 2;

/// One pass.
#[derive(Clone, Copy)]
struct Pass {
    step: u32,
    only_variance: bool,
    /// What the width for differences of light is multiplied by.
    narrowed: f64,
}

/// All passes in order; none where `watch` stopped it.
pub(super) fn run(
    hands: &mut Hands,
    size: [u32; 2],
    by: Denoising,
    sites: &[Site],
    mut estimates: Vec<Estimate>,
    watch: &mut Watch,
) -> Result<Option<Vec<Estimate>>> {
    let spreads = (0..SPREADS).map(|number| Pass {
        step: 1 << number,
        only_variance: true,
        narrowed: 1.0,
    });
    let smooths = (0..by.passes).map(|number| Pass {
        step: 1 << number,
        only_variance: false,
        narrowed: NARROWING.powi(number as i32),
    });
    let all: Vec<_> = spreads.chain(smooths).collect();
    for (done, pass) in all.iter().enumerate() {
        let mut next = vec![Estimate::default(); estimates.len()];
        for rect in blocks(size) {
            let share = (done as f64 + f64::from(rect.y0) / f64::from(size[1])) / all.len() as f64;
            if watch(GUIDES + (1.0 - GUIDES) * share).is_break() {
                return Ok(None);
            }
            let (job, around) = job(size, by, *pass, rect);
            let own_sites = window(sites, size[0], around);
            let own = window(&estimates, size[0], around);
            let made = hands.ask(|device| device.denoise(&job, &own_sites, &own))?;
            put(&mut next, size[0], rect, &made);
        }
        if pass.only_variance {
            keep_larger(&mut next, &estimates);
        }
        estimates = next;
    }
    Ok(Some(estimates))
}

/// A pixel that one rare bright path fell on is as uncertain as it is bright, whatever its neighbours say: with their
/// variance it would stand out for good.
fn keep_larger(spread: &mut [Estimate], own: &[Estimate]) {
    for (spread, own) in spread.iter_mut().zip(own) {
        spread.variance = spread.variance.max(own.variance);
    }
}

/// The blocks of a picture, row by row.
fn blocks([width, height]: [u32; 2]) -> impl Iterator<Item = Rect> {
    let rows = (0..height).step_by(BLOCK as usize);
    rows.flat_map(move |y0| {
        let columns = (0..width).step_by(BLOCK as usize);
        columns.map(move |x0| Rect {
            x0,
            y0,
            x1: (x0 + BLOCK).min(width),
            y1: (y0 + BLOCK).min(height),
        })
    })
}

/// A job that says only how differences are measured.
pub(super) fn widths(by: Denoising) -> DenoiseJob {
    let inverse_square = |width: f64| (1.0 / (width * width)) as f32;
    DenoiseJob {
        light: inverse_square(by.light),
        normal: inverse_square(by.normal),
        depth: inverse_square(by.depth),
        ..DenoiseJob::default()
    }
}

/// A block's job, and the window of the picture that it sees.
fn job([width, height]: [u32; 2], by: Denoising, pass: Pass, rect: Rect) -> (DenoiseJob, Rect) {
    let apron = REACH * pass.step;
    let around = Rect {
        x0: rect.x0.saturating_sub(apron),
        y0: rect.y0.saturating_sub(apron),
        x1: (rect.x1 + apron).min(width),
        y1: (rect.y1 + apron).min(height),
    };
    let job = DenoiseJob {
        corner: [rect.x0 - around.x0, rect.y0 - around.y0],
        size: [rect.width(), rect.height()],
        window: [around.width(), around.height()],
        step: pass.step,
        only_variance: pass.only_variance.into(),
        ..widths(Denoising {
            light: by.light * pass.narrowed,
            ..by
        })
    };
    (job, around)
}

/// The pixels of a rectangle of a picture of `width` columns.
pub fn window<T: Copy>(pixels: &[T], width: u32, rect: Rect) -> Vec<T> {
    let row = |y: u32| {
        let start = y as usize * width as usize;
        &pixels[start + rect.x0 as usize..start + rect.x1 as usize]
    };
    (rect.y0..rect.y1).flat_map(row).copied().collect()
}

/// The reverse of [`window`].
fn put<T: Copy>(pixels: &mut [T], width: u32, rect: Rect, made: &[T]) {
    for (y, row) in (rect.y0..rect.y1).zip(made.chunks(rect.width() as usize)) {
        let start = y as usize * width as usize + rect.x0 as usize;
        pixels[start..start + row.len()].copy_from_slice(row);
    }
}
