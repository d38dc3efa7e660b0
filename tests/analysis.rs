//! What a sweep's pictures say: numbers by hand, intervals that hold the truth as often as they say, wrong
//! formulas that the same gates reject, and sentences.
//!
//! All pictures are made up, so that their mean, variance and bias are known.

mod support;

mod analysis {
    mod coverage;
    mod effects;
    mod figures;
    mod hand;
    mod mutants;
    mod sentences;
    mod worlds;
}
