//! What a sweep is asked: against which references, where, and how sure the answer has to be.

use super::group::Group;
use super::reference::Reference;
use super::runs::Runs;
use crate::compare::kinship;
use crate::compare::verdict::Terms;
use crate::error::{Error, Result};
use crate::pack::Rect;

/// A part of the picture that is looked at by itself.
#[derive(Clone, Debug, PartialEq)]
pub struct Region {
    pub name: String,
    pub rect: Rect,
}

impl Region {
    /// # Errors
    /// [`Error::Usage`] where it is not inside of a picture of this size.
    pub fn fits(&self, [width, height]: [u32; 2]) -> Result<()> {
        let Rect { x0, y0, x1, y1 } = self.rect;
        if x0 < x1 && y0 < y1 && x1 <= width && y1 <= height {
            return Ok(());
        }
        Err(Error::Usage(format!(
            "region {}: {x0},{y0},{x1},{y1} is not a part of a picture of {width} x {height}",
            self.name
        )))
    }
}

#[derive(Clone, Debug)]
pub struct Question {
    pub(super) size: [u32; 2],
    /// One for each expected picture.
    pub(super) references: Vec<Reference>,
    /// The first is the whole picture.
    pub(super) regions: Vec<Region>,
    /// Of each verdict.
    pub(super) terms: Terms,
}

impl Question {
    /// `size` is that of every picture; the whole picture is put before `regions`. `terms.alpha` is the
    /// chance of a false alarm among all verdicts, of which there is one for each of so many groups in
    /// each region (Bonferroni).
    ///
    /// # Errors
    /// [`Error::Usage`] for a reference of another size or a region that is not inside.
    pub fn new(
        size: [u32; 2],
        references: Vec<Reference>,
        regions: Vec<Region>,
        terms: Terms,
        groups: usize,
    ) -> Result<Self> {
        let [x1, y1] = size;
        let whole = Region {
            name: "whole picture".into(),
            rect: Rect {
                x0: 0,
                y0: 0,
                x1,
                y1,
            },
        };
        references
            .iter()
            .try_for_each(|reference| reference.fits(size))?;
        regions.iter().try_for_each(|region| region.fits(size))?;
        let regions: Vec<_> = std::iter::once(whole).chain(regions).collect();
        let verdicts = (groups.max(1) * regions.len()) as f64;
        Ok(Self {
            size,
            references,
            regions,
            terms: Terms {
                alpha: terms.alpha / verdicts,
                ..terms
            },
        })
    }

    pub fn references(&self) -> &[Reference] {
        &self.references
    }

    /// Width and height of every picture.
    pub fn size(&self) -> [u32; 2] {
        self.size
    }

    pub fn regions(&self) -> &[Region] {
        &self.regions
    }

    /// What the runs of one group say, held against the reference of this number or against none. Takes
    /// the runs, so that their memory is given back.
    ///
    /// # Errors
    /// [`Error::Usage`] for a group without runs, of another size, one that shares random numbers
    /// with its reference, or a reference that there is not.
    pub fn answer(&self, runs: Runs, reference: Option<usize>) -> Result<Group> {
        let fail = |reason: &str| Err(Error::Usage(format!("{}: {reason}", runs.name)));
        if runs.is_empty() {
            return fail("a group without runs");
        }
        if runs.size != self.size {
            return fail("its pictures are not of the size of the others");
        }
        if reference.is_some_and(|number| number >= self.references.len()) {
            return fail("there is no reference of this number");
        }
        if let Some(reference) = reference.map(|number| &self.references[number]) {
            let shared = |record| kinship(&reference.picture.record, record).paired;
            if runs.records.iter().any(shared) {
                return fail(
                    "a run has the random numbers of the reference; give the reference a seed of its own",
                );
            }
        }
        Ok(Group::new(self, runs, reference))
    }

    /// Row by row, every other one from right to left: each pixel follows one that it touches, which
    /// is what the spread between neighbours is read from.
    pub(super) fn pixels(&self, rect: Rect) -> Vec<usize> {
        let width = self.size[0] as usize;
        let at = |x: u32, y: u32| y as usize * width + x as usize;
        let row = |y: u32| {
            (rect.x0..rect.x1).map(move |x| match (y - rect.y0) % 2 {
                0 => at(x, y),
                _ => at(rect.x0 + rect.x1 - 1 - x, y),
            })
        };
        (rect.y0..rect.y1).flat_map(row).collect()
    }
}
