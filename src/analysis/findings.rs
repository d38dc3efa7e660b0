//! What the data say, in sentences, most important first: whether they can be trusted, which groups are
//! biased, what changes the noise, which is best for its time, and where more samples stop helping.

use super::group::Group;
use super::quantity::Quantity;
use super::sweep::Analysis;
use super::words::{inverted, list, negated, number, percent, ranged};
use crate::compare::verdict::{Outcome, quantile};

/// Region of the whole picture.
const WHOLE: usize = 0;

impl Analysis {
    /// Sentences, each with its numbers.
    pub fn findings(&self) -> Vec<String> {
        let parts = [
            self.disagreements(),
            self.biased(),
            self.unbiased(),
            self.changes(),
            self.best(),
            self.crossings(),
        ];
        parts.concat()
    }

    /// Groups whose runs vary otherwise than their variances say; all else rests on these. So the chance
    /// of a false alarm is that of the verdicts, and as small for each.
    fn disagreements(&self) -> Vec<String> {
        let regions = self.question.regions.len() as f64;
        let limit = quantile(1.0 - 0.5 * self.question.terms.alpha * regions);
        let mut sentences = Vec::new();
        for group in &self.groups {
            let Some(agreement) = group.regions[WHOLE].agreement else {
                continue;
            };
            if (agreement.value - 1.0).abs() > limit * agreement.error {
                sentences.push(format!(
                    "{}: the runs vary {} times as much as their own variances say; they share random numbers, or differ in more than their seed, and their intervals cannot be relied on.",
                    group.name,
                    ranged(agreement.interval())
                ));
            }
        }
        sentences
    }

    fn outcome(&self, group: usize, region: usize) -> Option<Outcome> {
        let verdict = self.groups[group].regions[region].verdict.as_ref()?;
        Some(verdict.outcome)
    }

    /// Groups that are different anywhere, the most biased first.
    fn biased(&self) -> Vec<String> {
        let regions = 0..self.question.regions.len();
        let mut found: Vec<(f64, String)> = Vec::new();
        for (index, group) in self.groups.iter().enumerate() {
            let differs = |region: &usize| self.outcome(index, *region) == Some(Outcome::Different);
            let bias = |region: usize| group.regions[region].relative_bias;
            let clear = |region: &usize| bias(*region).is_some_and(is_clear);
            let Some(first) = regions.clone().find(differs) else {
                continue;
            };
            let size = |region: &usize| bias(*region).map_or(0.0, |bias| bias.value.abs());
            let worst = regions
                .clone()
                .filter(|region| differs(region) && clear(region))
                .max_by(|a, b| size(a).total_cmp(&size(b)));
            let sentence = match worst {
                Some(worst) => self.bias_sentence(index, worst),
                None => format!(
                    "{} differs from its reference in places of the {}, though its mean there does not show it.",
                    group.name, self.question.regions[first].name
                ),
            };
            found.push((worst.as_ref().map_or(0.0, size), sentence));
        }
        found.sort_by(|a, b| b.0.total_cmp(&a.0));
        found.into_iter().map(|(_, sentence)| sentence).collect()
    }

    /// With the whole picture's bias, and that of the region where it is largest.
    fn bias_sentence(&self, group: usize, worst: usize) -> String {
        let figures = &self.groups[group].regions;
        let amount = |region: usize| {
            let bias = figures[region]
                .relative_bias
                .filter(|bias| is_clear(*bias))?;
            let interval = bias.interval();
            Some(match bias.value < 0.0 {
                true => format!("{} too dark", percent(negated(interval))),
                false => format!("{} too bright", percent(interval)),
            })
        };
        let mut places = vec![WHOLE];
        places.extend((worst != WHOLE).then_some(worst));
        let places = places.into_iter().filter_map(|region| {
            let name = &self.question.regions[region].name;
            amount(region).map(|amount| format!("the {name} is {amount}"))
        });
        let places: Vec<String> = places.collect();
        format!(
            "{} is biased: {}.",
            self.groups[group].name,
            places.join(", ")
        )
    }

    /// Groups without a difference: those shown to be the same, and those that need more samples.
    fn unbiased(&self) -> Vec<String> {
        let of = |outcome| {
            let groups = self.groups.iter().enumerate();
            let names: Vec<_> = groups
                .filter(|(index, _)| self.outcome(*index, WHOLE) == Some(outcome))
                .map(|(_, group)| group.name.as_str())
                .collect();
            (!names.is_empty()).then(|| list(&names))
        };
        let margin = number(100.0 * self.question.terms.margin);
        let reference = match self.question.references.len() {
            ..=1 => "the reference",
            _ => "their reference",
        };
        let same = of(Outcome::Same)
            .map(|names| format!("Same mean as {reference}, within {margin} %: {names}."));
        let open = of(Outcome::NotEnoughSamples).map(|names| {
            format!(
                "Not enough samples to show the mean of {reference} within {margin} %: {names}."
            )
        });
        same.into_iter().chain(open).collect()
    }

    /// The group with the least error for its time, by the whole picture.
    fn best(&self) -> Vec<String> {
        let ratio = |index: &usize| self.against[*index][WHOLE].equal_time;
        let rivals = (0..self.groups.len()).filter_map(|index| Some((index, ratio(&index)?)));
        let best = rivals
            .filter(|(index, _)| *index != self.baseline)
            .min_by(|a, b| a.1.value.total_cmp(&b.1.value));
        let Some((best, ratio)) = best else {
            return Vec::new();
        };
        let baseline = &self.groups[self.baseline].name;
        let what = match self.groups[self.baseline].reference {
            Some(_) => "error",
            None => "noise",
        };
        let group = &self.groups[best];
        let but = match self.outcome(best, WHOLE) {
            Some(Outcome::Different) => ", bias included",
            _ => "",
        };
        let sentence = if ratio.high < 1.0 {
            format!(
                "{} has the least squared {what} at equal time{but}: {baseline} has {} times as much.",
                group.name,
                ranged(inverted(ratio))
            )
        } else if ratio.low > 1.0 {
            format!(
                "{baseline} has the least squared {what} at equal time; the next, {}, has {} times as much.",
                group.name,
                ranged(ratio)
            )
        } else {
            format!(
                "No group is shown to have less squared {what} at equal time than {baseline}; {} has {} times as much.",
                group.name,
                ranged(ratio)
            )
        };
        vec![self.among() + &sentence]
    }

    /// Whom a comparison with the baseline is of, where that is not all groups.
    fn among(&self) -> String {
        let baseline = &self.groups[self.baseline];
        let alike = |other: &Group| other.reference == baseline.reference;
        match self.groups.iter().all(alike) {
            true => String::new(),
            false => format!(
                "Of the groups held against the reference of {}: ",
                baseline.name
            ),
        }
    }

    /// Where bias overtakes noise, the fewest samples first, and of many only the first.
    fn crossings(&self) -> Vec<String> {
        let mut found = Vec::new();
        for (group, regions) in self.groups.iter().zip(&self.against) {
            for (region, against) in self.question.regions.iter().zip(regions) {
                if let Some(crossing) = against.crossing {
                    let what = match crossing.value < 1.0 {
                        true => "bias is larger than the noise of a single sample".into(),
                        false => format!(
                            "bias overtakes noise at {} samples a pixel",
                            ranged(crossing)
                        ),
                    };
                    let sentence = format!("{}, {}: {what}.", group.name, region.name);
                    found.push((crossing.value, sentence));
                }
            }
        }
        found.sort_by(|a, b| a.0.total_cmp(&b.0));
        let sentences = found.into_iter().map(|(_, sentence)| sentence).collect();
        first_of(sentences, |more| {
            format!(
                "Bias overtakes noise in {more} more of these places: the table has the samples of each."
            )
        })
    }
}

/// Sentences of a kind that are said.
const MOST: usize = 4;

/// The most important of the sentences, and how many more there are.
pub(super) fn first_of(
    mut sentences: Vec<String>,
    more: impl FnOnce(usize) -> String,
) -> Vec<String> {
    let left = sentences.len().saturating_sub(MOST);
    sentences.truncate(MOST);
    sentences.extend((left > 0).then(|| more(left)));
    sentences
}

/// Whether its interval leaves 0 out.
fn is_clear(bias: Quantity) -> bool {
    bias.is_above_zero() || bias.times(-1.0).is_above_zero()
}
