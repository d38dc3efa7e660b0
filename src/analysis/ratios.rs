//! What an error costs: efficiency, and one group against another at equal time and at equal error.

use super::energy::Energy;
use super::quantity::{Quantity, from_logarithms};
use crate::report::data::Interval;

/// A group's error in a region, and the time of one of its runs.
#[derive(Clone, Copy, Debug)]
pub struct Cost<'a> {
    pub energy: &'a Energy,
    pub seconds: Quantity,
}

/// Mean of the times of runs. A single one says nothing of how they vary, and gets no error.
pub fn seconds(times: &[f64]) -> Quantity {
    let count = times.len() as f64;
    let mean = times.iter().sum::<f64>() / count;
    if times.len() < 2 {
        return Quantity::exact(mean);
    }
    let squares: f64 = times.iter().map(|time| (time - mean).powi(2)).sum();
    Quantity::new(mean, squares / (count - 1.0) / count, count - 1.0)
}

/// 1 / (MSE x seconds), after Hammersley and Handscomb (1964). None where the MSE is lost in the noise of
/// the reference, or no time passed.
pub fn efficiency(cost: Cost) -> Option<Interval> {
    let mse = cost.energy.mse();
    let parts = [mse.logarithm()?, cost.seconds.logarithm()?];
    let value = 1.0 / (mse.value * cost.seconds.value);
    Some(from_logarithms(value, &parts))
}

/// The group's MSE after the time of a run of the baseline, over the baseline's; below 1 is better.
///
/// Noise falls with time, bias^2 does not: (bias^2 + u t / t0) / MSE0, with u the noise of a run of the group and
/// t its time. None where one of the two errors is not above 0.
pub fn equal_time(group: Cost, baseline: Cost) -> Option<Interval> {
    let times = [group.seconds.logarithm()?, baseline.seconds.logarithm()?];
    let factor = group.seconds.value / baseline.seconds.value;
    let error = group.energy.at(factor);
    let other = baseline.energy.mse();
    // How much of the error the time decides.
    let share = group.energy.noise() * factor / error.value;
    let [own, others] = times.map(|time| time.times(share));
    let parts = [error.logarithm()?, other.logarithm()?, own, others];
    Some(from_logarithms(error.value / other.value, &parts))
}

/// The time that the group takes to the baseline's MSE, over the baseline's; below 1 is better.
///
/// u t / (MSE0 - bias^2) / t0. None where bias alone is more than the baseline's error, or as good as: no time
/// is enough then.
pub fn equal_error(group: Cost, baseline: Cost) -> Option<Interval> {
    let [own, others] = [group.seconds.logarithm()?, baseline.seconds.logarithm()?];
    let factor = group.seconds.value / baseline.seconds.value;
    let other = baseline.energy.mse();
    let room = other.value - group.energy.bias_squared().value;
    let noise = group.energy.noise();
    // d log(u / room) = (d bias^2 + room / u du - d MSE0) / room.
    let error = group.energy.at(room / noise).error;
    let gap = Quantity::new(
        room,
        error * error + other.error * other.error,
        other.freedom,
    );
    if noise <= 0.0 || !gap.is_above_zero() {
        return None;
    }
    let parts = [
        Quantity {
            value: room,
            ..group.energy.at(room / noise)
        }
        .logarithm()?,
        Quantity {
            value: room,
            ..other
        }
        .logarithm()?,
        own,
        others,
    ];
    Some(from_logarithms(noise * factor / room, &parts))
}

/// Samples a pixel at which bias^2 and variance / N are equal, for runs of `samples`; none where bias^2 is not
/// clearly above 0.
pub fn crossing(energy: &Energy, samples: f64) -> Option<Interval> {
    let bias = energy.bias_squared();
    let noise = energy.noise();
    if !bias.is_above_zero() || noise <= 0.0 {
        return None;
    }
    // d log(u / bias^2) = -(d bias^2 - bias^2 / u du) / bias^2.
    let error = energy.at(-bias.value / noise).error;
    let part = Quantity { error, ..bias };
    let value = samples * noise / bias.value;
    Some(from_logarithms(value, &[part.logarithm()?]))
}
