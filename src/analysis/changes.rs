//! What changes the noise and the time, in sentences.

use super::effects::Effect;
use super::findings::first_of;
use super::sweep::Analysis;
use super::words::{number, plain, ranged};
use crate::report::data::Interval;

impl Analysis {
    /// The largest change first, then what shows none.
    pub(super) fn changes(&self) -> Vec<String> {
        let mut effects = self.effects();
        let size = |effect: &Effect| match is_one(effect.variance) {
            true => -1.0,
            false => effect.variance.value.ln().abs(),
        };
        effects.sort_by(|a, b| size(b).total_cmp(&size(a)));
        first_of(effects.iter().map(sentence).collect(), |more| {
            format!(
                "{more} more pairs of values differ less: the table has the variance of one sample and the time of each group."
            )
        })
    }
}

/// Whether nothing shows that the ratio is not 1.
fn is_one(ratio: Interval) -> bool {
    ratio.low <= 1.0 && 1.0 <= ratio.high
}

fn sentence(effect: &Effect) -> String {
    let Effect { path, variance, .. } = effect;
    let [value, base] = [&effect.value, &effect.base].map(plain);
    let ratio = ranged(*variance);
    let noise = match is_one(*variance) {
        true => format!(
            "no difference in noise is seen between {value} and {base} (the variance is {ratio} times as large)"
        ),
        false => format!("{value} has {ratio} times the variance of {base}"),
    };
    let time = match effect.seconds {
        Some(seconds) if is_one(seconds) => {
            "; no difference in the time of a sample is seen".into()
        }
        Some(seconds) => format!("; a sample costs {} times the time", ranged(seconds)),
        None => String::new(),
    };
    format!("{path}: {noise}{}{time}.", range(&effect.each))
}

/// Of what a ratio is the mean, where it is of several pairs.
fn range(each: &[f64]) -> String {
    let least = each.iter().copied().fold(f64::INFINITY, f64::min);
    let most = each.iter().copied().fold(0.0, f64::max);
    match each.len() {
        ..=1 => String::new(),
        pairs => format!(
            ", the geometric mean of {pairs} settings of the other axes, {} to {}",
            number(least),
            number(most)
        ),
    }
}
