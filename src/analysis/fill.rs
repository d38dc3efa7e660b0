//! The analysis as a report shows it.

use super::group::{Group, RegionFigures};
use super::images::{Kind, image, picture_image};
use super::quantity::Quantity;
use super::reference::Reference;
use super::sweep::{Against, Analysis};
use crate::compare::verdict::Outcome;
use crate::report::data::{
    GroupData, ImageData, ReferenceData, RegionData, RegionResult, ReportData,
};

impl Analysis {
    /// Fills groups, regions, reference and findings, and adds their images to those that are there.
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
        let reference = self.question.reference.as_ref();
        data.reference = reference.map(|reference| reference_data(reference, &mut data.images));
        let groups = self.groups.iter().zip(&self.against);
        let size = self.question.size;
        data.groups = groups
            .map(|(group, against)| group_data(group, against, size, &mut data.images))
            .collect();
        data.findings = self.findings();
    }
}

/// Adds an image and says where it is.
fn push(images: &mut Vec<ImageData>, image: ImageData) -> Option<usize> {
    images.push(image);
    Some(images.len() - 1)
}

fn reference_data(reference: &Reference, images: &mut Vec<ImageData>) -> ReferenceData {
    let picture = reference.picture();
    ReferenceData {
        name: reference.name.clone(),
        samples: picture.record.samples,
        image: push(images, picture_image(&reference.name, picture)),
        mean: picture.record.mean,
        standard_error: picture.record.standard_error,
    }
}

fn group_data(
    group: &Group,
    against: &[Against],
    size: [u32; 2],
    images: &mut Vec<ImageData>,
) -> GroupData {
    let maps = &group.maps;
    let mut add = |kind: Kind, pixels: &[[f32; 3]]| {
        let name = format!("{}, {}", group.name, kind.name());
        push(images, image(&name, kind, size, pixels))
    };
    let regions = group.regions.iter().zip(against);
    GroupData {
        name: group.name.clone(),
        values: group.values.clone(),
        runs: group.runs,
        samples: group.samples.round() as u64,
        seconds: group.seconds.interval(),
        regions: regions
            .map(|(figures, against)| region_result(figures, against))
            .collect(),
        mean_image: add(Kind::Radiance, &maps.mean),
        bias_image: maps.bias.as_ref().and_then(|bias| add(Kind::Bias, bias)),
        deviation_image: add(Kind::Deviation, &maps.deviation),
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
