//! All groups together: each against a baseline.

use super::group::Group;
use super::question::Question;
use super::ratios::{self, Cost};
use crate::compare::verdict::Outcome;
use crate::error::{Error, Result};
use crate::report::data::Interval;

/// What the groups of a sweep say together.
#[derive(Clone, Debug)]
pub struct Analysis {
    pub question: Question,
    pub groups: Vec<Group>,
    /// Index of the group that the others are held against.
    pub baseline: usize,
    /// Of each group, region by region.
    pub against: Vec<Vec<Against>>,
}

/// What a group's error costs in a region. The ratios are of the noise alone where there is no reference,
/// and absent between groups that are held against different ones: an error of another picture is
/// neither more nor less.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Against {
    /// None unless the verdict finds a difference.
    pub crossing: Option<Interval>,
    pub efficiency: Option<Interval>,
    /// Error at equal time, over the baseline's.
    pub equal_time: Option<Interval>,
    /// Time to equal error, over the baseline's.
    pub equal_error: Option<Interval>,
}

impl Analysis {
    /// `baseline` names a group; the first is taken where it is absent.
    ///
    /// # Errors
    /// [`Error::Usage`] where there is no group, or none of that name.
    pub fn new(question: Question, groups: Vec<Group>, baseline: Option<&str>) -> Result<Self> {
        let named = |name: &str| groups.iter().position(|group| group.name == name);
        let Some(baseline) = baseline
            .map_or(Some(0), named)
            .filter(|_| !groups.is_empty())
        else {
            let names: Vec<_> = groups.iter().map(|group| group.name.as_str()).collect();
            return Err(Error::Usage(format!(
                "no group to compare with; there are: {}",
                names.join(", ")
            )));
        };
        let against = |index: usize| {
            let regions = 0..question.regions.len();
            regions
                .map(|region| Against::new(&groups, [index, baseline], region))
                .collect()
        };
        let against = (0..groups.len()).map(against).collect();
        Ok(Self {
            question,
            groups,
            baseline,
            against,
        })
    }
}

impl Against {
    fn new(groups: &[Group], [group, baseline]: [usize; 2], region: usize) -> Self {
        let alike = groups[group].reference == groups[baseline].reference;
        let cost = |index: usize| Cost {
            energy: &groups[index].regions[region].energy,
            seconds: groups[index].seconds,
        };
        let of = cost(group);
        let ratio = |compare: fn(Cost, Cost) -> Option<Interval>| {
            if group == baseline {
                // Whatever its error is, it is the same error.
                return Some(Interval {
                    value: 1.0,
                    low: 1.0,
                    high: 1.0,
                });
            }
            alike.then(|| compare(of, cost(baseline))).flatten()
        };
        let samples = groups[group].samples;
        // A bias that the verdict does not see may be one of the many numbers here that are clear of 0 by
        // chance.
        let verdict = groups[group].regions[region].verdict.as_ref();
        let biased = verdict.is_some_and(|verdict| verdict.outcome == Outcome::Different);
        Self {
            crossing: biased
                .then(|| ratios::crossing(of.energy, samples))
                .flatten(),
            efficiency: groups[group]
                .reference
                .is_some()
                .then(|| ratios::efficiency(of))
                .flatten(),
            equal_time: ratio(ratios::equal_time),
            equal_error: ratio(ratios::equal_error),
        }
    }
}
