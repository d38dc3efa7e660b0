//! How the samples of a pixel are cut into randomisations.
//!
//! Samples that fill their space together are not independent, and their own spread says nothing of how far
//! their mean may be off. So a pixel's samples are cut into runs, each a point set made random anew: the means of
//! the runs are independent, and their spread tells the standard error of the pixel's mean.

use super::choice::Sequence;
use super::settings::Render;

/// Samples of the shortest randomisation: as many as a device adds up before the host sees them.
pub const SHORTEST: u64 = 16;
/// Samples of the longest, as a power of two: numbers have so many bits.
const MOST_BITS: u32 = 24;

/// Samples of one randomisation where `samples` are planned and `randomisations` are wanted at least: the largest
/// power of two of which there are as many, but no fewer than [`SHORTEST`]. Few samples give fewer randomisations.
pub fn length(samples: u64, randomisations: u64) -> u64 {
    let most = (samples / randomisations.max(1)).max(SHORTEST);
    1 << most.ilog2().min(MOST_BITS)
}

impl Render {
    /// Samples of one randomisation; none where samples are independent.
    pub fn randomisation(&self) -> Option<u64> {
        let independent = self.sequence == Sequence::Independent;
        (!independent).then(|| length(self.samples, self.randomisations))
    }
}

#[cfg(test)]
mod tests {

    #[test]
    fn randomisations_are_powers_of_two_and_as_many_as_asked_for() {
        let lengths = [
            (32, 8, 16),
            (64, 8, 16),
            (128, 8, 16),
            (256, 8, 32),
            (1000, 8, 64),
            (1024, 8, 128),
            (1024, 2, 512),
            (1 << 31, 2, 1 << 24),
        ];
        for (samples, least, length) in lengths {
            assert_eq!(super::length(samples, least), length, "{samples} / {least}");
            assert!(samples < 16 * least || samples / length >= least);
        }
    }
}
