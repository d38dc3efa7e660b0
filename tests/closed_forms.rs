//! Renders beside closed forms, on the CPU twin and on the first Vulkan device.
//!
//! Every comparison is one of [`support::gate::Form`]'s: a mean within 4 standard errors of the truth
//! (p = 6.3e-5, two-sided) at a standard error of 0.2 % of it or less; or, where an estimator has
//! no variance, every sample within 1e-5; or the very bits. Seeds are fixed, so that a device gives the
//! same answer every time, and no two renders share one. Each gate is also shown to reject
//! renders that are wrong by little.

mod support;

mod closed_forms {
    mod agreement;
    mod bodies;
    mod concentric;
    mod cross;
    mod enclosure;
    mod lamp;
    mod literal;
    mod lobe;
    mod seen;
    mod shade;
}
