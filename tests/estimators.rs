//! What the estimators are said to do beside their mean: their variance, their cost, and where
//! the paper's literal ones are off.
//!
//! | file | prediction |
//! |---|---|
//! | `spread` | the gate for variances |
//! | `lamp` | relative variance of one direct light sample, by sampler, pole and size of the lamp |
//! | `penumbra` | share of a half hidden lamp, under the paper's weight and under the true density |
//! | `roulette` | mean, variance and length of interrupted paths in a closed enclosure |
//! | `efficiency` | mean, variance and cost of paths that are thinned out and split |
//! | `growth` | the variance of paths that are interrupted too often |
//!
//! Truths are integrated or summed in f64, and known figures are compared with those. A variance
//! must be within 4 of its standard errors, and those at most 1.2 %, so that it is within 5 %; the
//! standard error comes from the fourth moment of the truth, not from the samples. Each gate must
//! also reject estimators that it does not describe.

mod support;

mod estimators {
    mod efficiency;
    mod growth;
    mod lamp;
    mod penumbra;
    mod roulette;
    mod spread;
}
