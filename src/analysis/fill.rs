//! The analysis as a report shows it.

use super::group::{Group, RegionFigures};
use super::images::{Kind, image};
use super::quantity::Quantity;
use super::reference::Reference;
use super::room::Room;
use super::sweep::{Against, Analysis};
use crate::compare::verdict::Outcome;
use crate::report::data::{
    GroupData, ImageData, ReferenceData, RegionData, RegionResult, ReportData,
};

impl Analysis {
    /// Fills groups, regions, references, findings and notes, and adds the images that there is room for to
    /// those that are there.
    pub fn fill(&self, data: &mut ReportData) {
        let regions = self.question.regions.iter();
        data.regions = regions
            .map(|region| RegionData {
                name: region.name.clone(),
                rect: [
                    region.rect.x0,
                    region.rect.y0,
                    region.rect.x1,
                    region.rect.y1,
                ],
            })
            .collect();
        let biased = self.groups.iter().filter(|group| group.maps.bias.is_some());
        let (groups, biased) = (self.groups.len(), biased.count());
        let references = &self.question.references;
        let room = Room::new(self.question.size, groups, biased, references.len());
        let mut pictures = Pictures {
            size: self.question.size,
            room,
            images: &mut data.images,
        };
        data.references = references
            .iter()
            .map(|reference| pictures.reference(reference))
            .collect();
        let groups_of = self.groups.iter().zip(&self.against);
        data.groups = groups_of
            .map(|(group, against)| pictures.group(group, against))
            .collect();
        data.findings = self.findings();
        data.notes.extend(self.without_ratios());
        data.notes.extend(room.notes(groups, biased));
    }

    /// Why groups of another reference than the baseline's have no ratios.
    fn without_ratios(&self) -> Option<String> {
        let baseline = &self.groups[self.baseline];
        let others = self.groups.iter();
        let count = others
            .filter(|group| group.reference != baseline.reference)
            .count();
        (count > 0).then(|| {
            format!(
                "{count} of {} groups have no ratios: they are not held against the reference of {}, and errors of different pictures cannot be compared.",
                self.groups.len(),
                baseline.name
            )
        })
    }
}

/// Where images go, and how many more maps there is room for.
struct Pictures<'a> {
    size: [u32; 2],
    room: Room,
    images: &'a mut Vec<ImageData>,
}

impl Pictures<'_> {
    /// Adds an image and says where it is.
    fn add(&mut self, name: &str, kind: Kind, pixels: &[[f32; 3]]) -> Option<usize> {
        let (size, pixels) = self.room.fit(self.size, pixels);
        self.images.push(image(name, kind, size, &pixels));
        Some(self.images.len() - 1)
    }

    fn reference(&mut self, reference: &Reference) -> ReferenceData {
        let picture = reference.picture();
        ReferenceData {
            name: reference.name.clone(),
            samples: picture.record.samples,
            image: self.add(&reference.name, Kind::Radiance, &picture.mean),
            mean: picture.record.mean,
            standard_error: picture.record.standard_error,
        }
    }

    fn group(&mut self, group: &Group, against: &[Against]) -> GroupData {
        let maps = &group.maps;
        let name = |kind: Kind| format!("{}, {}", group.name, kind.name());
        let mut fits = |left: fn(&mut Room) -> &mut usize| {
            let left = left(&mut self.room);
            let fits = *left > 0;
            *left = left.saturating_sub(1);
            fits
        };
        let bias = maps.bias.as_ref().filter(|_| fits(|room| &mut room.bias));
        let deviation = fits(|room| &mut room.deviation).then_some(&maps.deviation);
        let regions = group.regions.iter().zip(against);
        GroupData {
            name: group.name.clone(),
            values: group.values.clone(),
            reference: group.reference,
            runs: group.runs,
            samples: group.samples.round() as u64,
            seconds: group.seconds.interval(),
            regions: regions
                .map(|(figures, against)| region_result(figures, against))
                .collect(),
            mean_image: self.add(&name(Kind::Radiance), Kind::Radiance, &maps.mean),
            bias_image: bias.and_then(|map| self.add(&name(Kind::Bias), Kind::Bias, map)),
            deviation_image: deviation
                .and_then(|map| self.add(&name(Kind::Deviation), Kind::Deviation, map)),
        }
    }
}

fn region_result(figures: &RegionFigures, against: &Against) -> RegionResult {
    let interval = |quantity: Quantity| quantity.interval();
    let has_reference = figures.bias.is_some();
    RegionResult {
        mean: Quantity::over(&figures.mean).interval(),
        bias: figures.relative_bias.map(interval),
        variance: Quantity::over(&figures.variance).interval(),
        mse: has_reference.then(|| figures.energy.mse().interval()),
        relmse: figures.relative.map(|relative| relative.mse().interval()),
        crossing: against.crossing.map(|crossing| crossing.value),
        efficiency: against.efficiency,
        equal_time: against.equal_time,
        equal_error: against.equal_error,
        verdict: figures
            .verdict
            .as_ref()
            .map(|verdict| outcome(verdict.outcome).into()),
    }
}

/// As JSON has it.
fn outcome(outcome: Outcome) -> &'static str {
    match outcome {
        Outcome::Same => "same",
        Outcome::Different => "different",
        Outcome::NotEnoughSamples => "not-enough-samples",
    }
}
