//! What runs are held against: a picture of many samples, which has noise of its own.

use crate::compare::verdict::Side;
use crate::error::{Error, Result};
use crate::film::{Picture, Record};

#[derive(Clone, Debug)]
pub struct Reference {
    pub name: String,
    pub(super) picture: Picture,
}

impl Reference {
    /// # Errors
    /// [`Error::Usage`] for a picture whose noise is not known.
    pub fn new(name: &str, picture: Picture) -> Result<Self> {
        check(&picture, name)?;
        Ok(Self {
            name: name.into(),
            picture,
        })
    }

    /// # Errors
    /// [`Error::Usage`] where it cannot be held against pictures of this size.
    pub fn fits(&self, [width, height]: [u32; 2]) -> Result<()> {
        let picture = &self.picture;
        if [picture.width, picture.height] == [width, height] {
            return Ok(());
        }
        Err(Error::Usage(format!(
            "the reference {} has {} x {} pixels, the runs have {width} x {height}",
            self.name, picture.width, picture.height
        )))
    }

    pub fn picture(&self) -> &Picture {
        &self.picture
    }

    pub(super) fn side(&self) -> Side<'_> {
        Side {
            mean: &self.picture.mean,
            variance: &self.picture.variance,
            samples: &self.picture.samples,
            run: run(&self.picture.record),
        }
    }

    pub(super) fn mean(&self, pixel: usize, channel: usize) -> f64 {
        f64::from(self.picture.mean[pixel][channel])
    }

    /// Variance of the mean of a pixel.
    pub(super) fn noise(&self, pixel: usize, channel: usize) -> f64 {
        f64::from(self.picture.variance[pixel][channel]) / f64::from(self.picture.samples[pixel])
    }
}

/// Samples behind one independent estimate of a picture's variances: 1, or the length of a randomisation.
pub(super) fn run(record: &Record) -> f64 {
    record.randomisation.map_or(1.0, |length| length as f64)
}

/// What every picture here must be: whole, finite, and with two samples a pixel or more.
pub(super) fn check(picture: &Picture, name: &str) -> Result<()> {
    let fail = |reason: &str| Err(Error::Usage(format!("{name}: {reason}")));
    let lengths = [
        picture.mean.len(),
        picture.variance.len(),
        picture.samples.len(),
    ];
    if picture.pixels() == 0 || lengths != [picture.pixels(); 3] {
        return fail("a plane has not as many pixels as the picture");
    }
    if picture
        .samples
        .iter()
        .any(|n| !(n.is_finite() && *n >= 2.0))
    {
        return fail("its noise is not known: every pixel needs two samples or more");
    }
    let least = 2.0 * run(&picture.record);
    if picture.samples.iter().any(|n| f64::from(*n) < least) {
        return fail("its noise is not known: every pixel needs two randomisations or more");
    }
    let planes = [&picture.mean, &picture.variance];
    let mut values = planes.into_iter().flat_map(|plane| plane.as_flattened());
    if !values.all(|value| value.is_finite()) {
        return fail("it has pixels that are not finite");
    }
    Ok(())
}
