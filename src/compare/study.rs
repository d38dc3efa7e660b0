//! A pair of pictures under comparison: every figure is found once, when it is asked for.

use super::flip::{self, Exposures};
use super::metric::{Figure, Metric};
use super::pair::{Display, Linear, Pair};
use super::survey::{Survey, survey};
use super::{Lines, Map, similarity};
use crate::error::{Error, Result};
use rayon::prelude::*;
use std::cell::OnceCell;

/// How pictures are looked at.
#[derive(Clone, Copy, Debug)]
pub struct Viewing {
    /// Pixels per degree of the observer's sight.
    pub ppd: f32,
    /// Stops that linear pictures are brightened by before they are looked at.
    pub exposure: f64,
    /// The exposures of HDR-FLIP; found from the reference where absent.
    pub exposures: Option<Exposures>,
}

impl Default for Viewing {
    fn default() -> Self {
        Self {
            ppd: flip::DEFAULT_PPD,
            exposure: 0.0,
            exposures: None,
        }
    }
}

pub struct Study<'a> {
    pub pair: &'a Pair,
    pub viewing: Viewing,
    pub survey: Survey,
    flip: OnceCell<Map>,
    high: OnceCell<(Map, Exposures)>,
    similarity: OnceCell<(f64, Map)>,
}

impl<'a> Study<'a> {
    pub fn new(pair: &'a Pair, viewing: Viewing) -> Self {
        Self {
            pair,
            viewing,
            survey: survey(pair),
            flip: OnceCell::new(),
            high: OnceCell::new(),
            similarity: OnceCell::new(),
        }
    }

    /// The pictures as a screen shows them: reference, test.
    pub fn displays(&self) -> [Display<'_>; 2] {
        let gain = self.viewing.exposure.exp2() as f32;
        [&self.pair.reference, &self.pair.test].map(|image| Display { image, gain })
    }

    /// FLIP's map.
    ///
    /// # Errors
    /// [`Error::Usage`] for a resolution that FLIP does not have.
    pub fn flip(&self) -> Result<&Map> {
        once(&self.flip, || {
            let [reference, test] = self.displays();
            flip::ldr(&reference, &test, self.viewing.ppd)
        })
    }

    /// HDR-FLIP's map, and the exposures that it was found with.
    ///
    /// # Errors
    /// [`Error::Usage`] where neither picture has high dynamic range, and as [`Study::flip`].
    pub fn hdr_flip(&self) -> Result<&(Map, Exposures)> {
        once(&self.high, || {
            if !self.pair.is_high_dynamic_range() {
                return Err(Error::Usage(
                    "hdr-flip is for EXR pictures; for others there is flip".into(),
                ));
            }
            let (reference, test) = (Linear(&self.pair.reference), Linear(&self.pair.test));
            let found = || Exposures::of(&reference);
            let exposures = self.viewing.exposures.unwrap_or_else(found);
            let map = flip::hdr(&reference, &test, self.viewing.ppd, exposures)?;
            Ok((map, exposures))
        })
    }

    fn ssim(&self) -> Result<&(f64, Map)> {
        once(&self.similarity, || {
            let [reference, test] = self.displays();
            similarity::ssim(&reference, &test).ok_or_else(|| too_small("ssim", similarity::WINDOW))
        })
    }

    fn ms_ssim(&self) -> Result<f64> {
        let [reference, test] = self.displays();
        let value = similarity::ms_ssim(&reference, &test);
        value.ok_or_else(|| too_small("ms-ssim", similarity::SHORTEST))
    }

    /// A metric's value over the picture.
    ///
    /// # Errors
    /// [`Error::Usage`] for a metric that these pictures have no value of.
    pub fn figure(&self, metric: Metric) -> Result<Figure> {
        let value = match metric {
            Metric::Ssim => self.ssim()?.0,
            Metric::MsSsim => self.ms_ssim()?,
            Metric::Flip => self.flip()?.mean(),
            Metric::HdrFlip => self.hdr_flip()?.0.mean(),
            linear => linear.of_sums(&self.survey.sums).unwrap_or(f64::NAN),
        };
        Ok(Figure {
            metric,
            value,
            settings: self.settings(metric)?,
        })
    }

    /// Colour space and settings, for people.
    fn settings(&self, metric: Metric) -> Result<String> {
        let display = format!("sRGB at exposure {}", self.viewing.exposure);
        let ppd = self.viewing.ppd;
        Ok(match metric {
            Metric::Ssim => format!("{display}, luma, Gaussian window of 11 x 11"),
            Metric::MsSsim => format!("{display}, luma, Gaussian window of 11 x 11, 5 scales"),
            Metric::Flip => format!("{display}, {ppd:.2} pixels per degree"),
            Metric::HdrFlip => {
                let Exposures { start, stop, count } = self.hdr_flip()?.1;
                format!(
                    "linear light, ACES, exposures {start},{stop},{count}, {ppd:.2} pixels per degree"
                )
            }
            Metric::Psnr => "linear light, peak 1".into(),
            Metric::RelMse | Metric::Mrse => "linear light, 0.01 added to the reference".into(),
            _ => "linear light".into(),
        })
    }

    /// The error of each pixel; none for metrics that have none. 0 where nothing differs.
    ///
    /// # Errors
    /// As [`Study::figure`].
    pub fn pixel_errors(&self, metric: Metric) -> Result<Option<Vec<f32>>> {
        Ok(match metric {
            Metric::Flip => Some(self.flip()?.values.clone()),
            Metric::HdrFlip => Some(self.hdr_flip()?.0.values.clone()),
            Metric::Ssim => Some(self.ssim()?.1.values.iter().map(|s| 1.0 - s).collect()),
            Metric::Psnr | Metric::MsSsim => None,
            linear => Some(self.per_pixel(|a, b| linear.of_pixel(a, b).unwrap_or(f32::NAN))),
        })
    }

    /// One value of each pixel in linear light.
    pub fn per_pixel<T: Copy + Default + Send>(
        &self,
        value: impl Fn([f32; 3], [f32; 3]) -> T + Sync,
    ) -> Vec<T> {
        let width = self.pair.width() as usize;
        let (reference, test) = (Linear(&self.pair.reference), Linear(&self.pair.test));
        let mut values = vec![T::default(); self.pair.len()];
        let rows = values.par_chunks_exact_mut(width).enumerate();
        rows.for_each_init(
            || [vec![[0.0; 3]; width], vec![[0.0; 3]; width]],
            |[first, second], (y, row)| {
                reference.line(y as u32, first);
                test.line(y as u32, second);
                for (out, (a, b)) in row.iter_mut().zip(first.iter().zip(second.iter())) {
                    *out = value(*a, *b);
                }
            },
        );
        values
    }
}

/// Finds something once; what failed is tried again.
fn once<T>(cell: &OnceCell<T>, find: impl FnOnce() -> Result<T>) -> Result<&T> {
    if cell.get().is_none() {
        // Only here is it ever set.
        let _ = cell.set(find()?);
    }
    cell.get()
        .ok_or_else(|| Error::Internal("a figure was lost".into()))
}

fn too_small(metric: &str, least: u32) -> Error {
    Error::Usage(format!(
        "{metric} needs pictures of {least} x {least} pixels or more"
    ))
}
