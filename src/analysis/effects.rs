//! What the value of one axis does to noise and time: groups that differ in nothing else, compared.
//!
//! The variance of one sample does not depend on how many are taken, and the runs of fewer samples share
//! their random numbers with those of more: of groups that differ in `render.samples` alone, only the one
//! with the most samples counts.
//!
//! Each value is held against the axis's first, in every setting of the other axes; the ratios of these pairs
//! are pooled by their geometric mean. The pairs are of the same seeds, so their errors may rise and fall
//! together; as with channels, the error of the mean is the mean of the errors, which by Cauchy's inequality
//! is never too small.

use super::group::Group;
use super::quantity::Quantity;
use super::sweep::Analysis;
use crate::report::data::Interval;
use serde_json::{Map, Value};

const SAMPLES: &str = "render.samples";

/// One value of an axis against its first one, by the whole picture.
#[derive(Clone, Debug)]
pub struct Effect {
    /// The axis.
    pub path: String,
    pub value: Value,
    pub base: Value,
    /// Variance of one sample, over that of `base`.
    pub variance: Interval,
    /// Of every pair, in the order of the groups.
    pub each: Vec<f64>,
    /// Time of one sample, over that of `base`. None where a group has a single run, which says nothing of how
    /// times vary.
    pub seconds: Option<Interval>,
}

impl Analysis {
    /// The effects of all axes that have several values, but `render.samples`.
    pub fn effects(&self) -> Vec<Effect> {
        let groups = with_most_samples(&self.groups);
        let mut effects = Vec::new();
        for path in axes(&groups) {
            let [base, others @ ..] = &values(&groups, path)[..] else {
                continue;
            };
            let of = |value: &&Value| Effect::new(&groups, path, value, base);
            effects.extend(others.iter().filter_map(of));
        }
        effects
    }
}

impl Effect {
    /// None where no two groups differ in this alone, or a variance is 0.
    fn new(groups: &[&Group], path: &str, value: &Value, base: &Value) -> Option<Self> {
        let is_of = |group: &&&Group, value: &Value| group.values.get(path) == Some(value);
        let mut pairs = Vec::new();
        for group in groups.iter().filter(|group| is_of(group, value)) {
            let bases = groups.iter().filter(|other| is_of(other, base));
            let mut like = bases.filter(|other| alike(other, group, &[path, SAMPLES]));
            pairs.extend(like.next().map(|base| [*group, *base]));
        }
        let variances = pairs.iter().map(|pair| log_ratio(pair.map(variance)));
        let variances: Vec<Quantity> = variances.collect::<Option<_>>()?;
        let several = pairs.iter().flatten().all(|group| group.runs > 1);
        let seconds = pairs.iter().map(|pair| log_ratio(pair.map(seconds)));
        let seconds: Option<Vec<Quantity>> = seconds.collect();
        Some(Self {
            path: path.into(),
            value: value.clone(),
            base: base.clone(),
            variance: pooled(&variances)?,
            each: variances.iter().map(|ratio| ratio.value.exp()).collect(),
            seconds: seconds
                .filter(|_| several)
                .and_then(|ratios| pooled(&ratios)),
        })
    }
}

/// Of groups that are alike but for their number of samples, that with the most.
fn with_most_samples(groups: &[Group]) -> Vec<&Group> {
    let mut kept: Vec<&Group> = Vec::new();
    for group in groups {
        match kept
            .iter_mut()
            .find(|other| alike(other, group, &[SAMPLES]))
        {
            Some(other) if other.samples < group.samples => *other = group,
            Some(_) => {}
            None => kept.push(group),
        }
    }
    kept
}

/// Whether two have the same values but for those of some axes.
fn alike(one: &Group, other: &Group, but: &[&str]) -> bool {
    let values = |group: &Group| -> Map<String, Value> {
        let all = group.values.clone().into_iter();
        all.filter(|(path, _)| !but.contains(&path.as_str()))
            .collect()
    };
    values(one) == values(other)
}

fn axes<'g>(groups: &[&'g Group]) -> Vec<&'g str> {
    let paths = groups
        .first()
        .into_iter()
        .flat_map(|group| group.values.keys());
    let paths = paths.map(String::as_str);
    paths.filter(|path| *path != SAMPLES).collect()
}

/// The values of an axis in the order of the groups, each once.
fn values<'g>(groups: &[&'g Group], path: &str) -> Vec<&'g Value> {
    let mut seen: Vec<&Value> = Vec::new();
    for value in groups.iter().filter_map(|group| group.values.get(path)) {
        if !seen.contains(&value) {
            seen.push(value);
        }
    }
    seen
}

fn variance(group: &Group) -> Quantity {
    Quantity::over(&group.regions[0].variance)
}

fn seconds(group: &Group) -> Quantity {
    group.seconds.times(1.0 / group.samples)
}

/// Logarithm of the first over the second. Degrees of freedom after Welch and Satterthwaite.
fn log_ratio([value, base]: [Quantity; 2]) -> Option<Quantity> {
    let parts = [value.logarithm()?, base.logarithm()?];
    let [own, others] = parts.map(|part| part.error.powi(2));
    let spread = own * own / parts[0].freedom + others * others / parts[1].freedom;
    let freedom = match spread > 0.0 {
        true => (own + others).powi(2) / spread,
        false => f64::INFINITY,
    };
    let ratio = parts[0].value - parts[1].value;
    Some(Quantity::new(ratio, own + others, freedom))
}

/// Geometric mean of ratios that are given by their logarithms.
fn pooled(logarithms: &[Quantity]) -> Option<Interval> {
    let count = logarithms.len() as f64;
    let mean = |of: fn(&Quantity) -> f64| logarithms.iter().map(of).sum::<f64>() / count;
    let freedoms = logarithms.iter().map(|ratio| ratio.freedom);
    let pooled = Quantity {
        value: mean(|ratio| ratio.value),
        error: mean(|ratio| ratio.error),
        freedom: freedoms.fold(f64::INFINITY, f64::min),
    };
    let interval = pooled.interval();
    (!logarithms.is_empty()).then(|| Interval {
        value: interval.value.exp(),
        low: interval.low.exp(),
        high: interval.high.exp(),
    })
}
