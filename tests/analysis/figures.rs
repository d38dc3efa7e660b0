//! Every figure of a group as an interval, and what it truly is.

use super::worlds::{Estimator, World};
use lampray::analysis::{Analysis, Quantity};
use lampray::report::data::Interval;

/// A figure of a group, and its truth.
pub type Figure = (
    &'static str,
    fn(&Analysis, usize) -> Option<Interval>,
    fn(&World, usize) -> f64,
);

fn over(channels: &[Quantity; 3]) -> Interval {
    Quantity::over(channels).interval()
}

/// Noise of a run of an estimator, relative.
fn noise(world: &World, group: usize) -> f64 {
    let Estimator { deviation, .. } = world.estimators[group];
    deviation * deviation / f64::from(world.samples)
}

fn square(world: &World, group: usize) -> f64 {
    world.estimators[group].bias.powi(2)
}

fn seconds(world: &World, group: usize) -> f64 {
    world.estimators[group].seconds
}

fn relative_mse(world: &World, group: usize) -> f64 {
    square(world, group) + noise(world, group)
}

pub const FIGURES: [Figure; 13] = [
    (
        "mean",
        |analysis, group| Some(over(&analysis.groups[group].regions[0].mean)),
        |world, group| (1.0 + world.estimators[group].bias) * world.moment(1),
    ),
    (
        "mean of green",
        |analysis, group| Some(analysis.groups[group].regions[0].mean[1].interval()),
        |world, group| {
            let colours: f64 = super::worlds::COLOUR.iter().sum();
            let green = 3.0 * super::worlds::COLOUR[1] / colours;
            (1.0 + world.estimators[group].bias) * world.moment(1) * green
        },
    ),
    (
        "bias",
        |analysis, group| analysis.groups[group].regions[0].bias.as_ref().map(over),
        |world, group| world.estimators[group].bias * world.moment(1),
    ),
    (
        "relative bias",
        |analysis, group| {
            let bias = analysis.groups[group].regions[0].relative_bias;
            bias.map(|bias| bias.interval())
        },
        |world, group| world.estimators[group].bias,
    ),
    (
        "variance",
        |analysis, group| Some(over(&analysis.groups[group].regions[0].variance)),
        |world, group| world.estimators[group].deviation.powi(2) * world.moment(2),
    ),
    (
        "bias^2",
        |analysis, group| {
            let energy = &analysis.groups[group].regions[0].energy;
            Some(energy.bias_squared().interval())
        },
        |world, group| square(world, group) * world.moment(2),
    ),
    (
        "MSE",
        |analysis, group| Some(analysis.groups[group].regions[0].energy.mse().interval()),
        |world, group| relative_mse(world, group) * world.moment(2),
    ),
    (
        "relMSE",
        |analysis, group| {
            let relative = analysis.groups[group].regions[0].relative;
            relative.map(|relative| relative.mse().interval())
        },
        |world, group| {
            relative_mse(world, group)
                * world.mean_of(|truth| truth * truth / (truth * truth + 0.01))
        },
    ),
    (
        "crossing",
        |analysis, group| analysis.against[group][0].crossing,
        |world, group| f64::from(world.samples) * noise(world, group) / square(world, group),
    ),
    (
        "efficiency",
        |analysis, group| analysis.against[group][0].efficiency,
        |world, group| 1.0 / (relative_mse(world, group) * world.moment(2) * seconds(world, group)),
    ),
    (
        "equal time",
        |analysis, group| analysis.against[group][0].equal_time,
        |world, group| {
            let factor = seconds(world, group) / seconds(world, 0);
            (square(world, group) + noise(world, group) * factor) / relative_mse(world, 0)
        },
    ),
    (
        "equal error",
        |analysis, group| analysis.against[group][0].equal_error,
        |world, group| {
            let factor = seconds(world, group) / seconds(world, 0);
            noise(world, group) * factor / (relative_mse(world, 0) - square(world, group))
        },
    ),
    (
        "agreement",
        |analysis, group| {
            let agreement = analysis.groups[group].regions[0].agreement;
            agreement.map(|agreement| agreement.interval())
        },
        |_, _| 1.0,
    ),
];
