//! The comparisons of one test, alone and pooled.

use super::judge::{Comparison, Fault, compare};
use super::{Case, LEVEL, MOST_ERRORS};
use crate::support::bench::Bench;

/// Relative standard error that a mutant is rendered to: 1 % is then twelve of them.
const MUTANT_PRECISION: f64 = 0.0008;

/// The comparisons of one test.
#[derive(Debug)]
pub struct Family {
    name: &'static str,
    seed: u64,
    made: Vec<Comparison>,
}

impl Family {
    /// Renders of this family have the seeds from `first_seed` on, each its own.
    pub fn new(name: &'static str, first_seed: u64) -> Self {
        Self {
            name,
            seed: first_seed,
            made: Vec::new(),
        }
    }

    fn next_seed(&mut self) -> u64 {
        self.seed += 1;
        self.seed
    }

    /// Renders a case and compares it with what it must be.
    pub fn check(&mut self, bench: Bench, case: &Case) {
        // A measured truth's own error takes its part.
        let film = case.film(bench, self.next_seed(), 0.95 * case.most_error);
        self.made.extend(compare(case, bench, &film));
    }

    /// Renders a case that is wrong on purpose: the gate must find it different in some channel.
    /// Being too noisy to say is not enough.
    pub fn reject(&mut self, bench: Bench, mutant: &Case) {
        let precision = mutant.most_error.min(MUTANT_PRECISION);
        let film = mutant.film(bench, self.next_seed(), precision);
        let made = compare(mutant, bench, &film);
        let caught = made.iter().any(|one| one.fault == Some(Fault::Apart));
        let lines: Vec<_> = made.iter().map(Comparison::to_string).collect();
        assert!(caught, "the gate let a mutant pass:\n{}", lines.join("\n"));
        let z = made.iter().map(|one| one.z().abs().min(9999.0));
        let z = z.fold(0.0, f64::max);
        let (name, sets) = (&self.name, mutant.sets.join(" "));
        println!("{name}: rejected on {bench:?} with |z| {z:.1}: {sets}");
    }

    /// Says how many comparisons there were, and fails with all that did not pass.
    pub fn finish(self) {
        println!("{}", self.summary());
        let at_fault = self.made.iter().filter(|one| one.fault.is_some());
        let faults: Vec<_> = at_fault.map(Comparison::to_string).collect();
        assert!(
            faults.is_empty(),
            "{} of {} comparisons fail:\n{}",
            faults.len(),
            self.made.len(),
            faults.join("\n")
        );
        for bench in [Bench::Twin, Bench::Vulkan] {
            for channel in 0..3 {
                self.pool(bench, channel);
            }
        }
    }

    /// Number of comparisons, largest |z|, and the chance of a false alarm among them all: at most
    /// the sum of theirs (Bonferroni), for the channels of one render are not independent.
    fn summary(&self) -> String {
        let noisy: Vec<_> = self.made.iter().filter(|one| one.is_noisy()).collect();
        let largest = noisy.iter().map(|one| one.z().abs()).fold(0.0, f64::max);
        format!(
            "{}: {} comparisons, {} of them with noise; largest |z| {largest:.2}, {MOST_ERRORS} allowed; chance of a false alarm at most {:.1e}",
            self.name,
            self.made.len(),
            noisy.len(),
            LEVEL * noisy.len() as f64
        )
    }

    /// Each case has a seed of its own, so that the z of one device and channel, summed over n cases
    /// and divided by sqrt n, is again a standard normal number. It finds a bias that all cases
    /// share and none shows. Cases that share a measured truth are not independent: they are left out.
    fn pool(&self, bench: Bench, channel: usize) {
        let chosen = |one: &&Comparison| {
            one.bench == bench && one.channel == channel && one.is_noisy() && one.independent
        };
        let z: Vec<_> = self.made.iter().filter(chosen).map(Comparison::z).collect();
        let pooled = z.iter().sum::<f64>() / (z.len().max(1) as f64).sqrt();
        if z.is_empty() {
            return;
        }
        let line = format!(
            "{}: {bench:?}, channel {channel}: z of {} cases pooled {pooled:+.2}",
            self.name,
            z.len()
        );
        assert!(pooled.abs() <= MOST_ERRORS, "{line}");
        println!("  {line}");
    }
}
