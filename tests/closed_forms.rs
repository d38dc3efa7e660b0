//! Renders beside closed forms, on the CPU twin and on the first Vulkan device.
//!
//! | file | form |
//! |---|---|
//! | `enclosure` | a closed even enclosure: e (1 + rho + ... + rho^N) |
//! | `efficiency` | the same, by paths that split |
//! | `bodies`, `lobe` | a lone body under an even sky: rho L, less what a lobe loses below the surface |
//! | `concentric` | two concentric spheres: partial sums of a two-by-two matrix |
//! | `lamp` | a sphere over a face, also cut by the horizon: rho L F |
//! | `crowd` | many balls before a light, which are a tree: rho L (F - f) |
//! | `shade` | a ball that shades a floor from an even sky |
//! | `panel` | a box over a floor: the parallel rectangle, and any box by Lambert's polygon sum |
//! | `pinhole` | the ellipse that a sphere is in a picture |
//! | `seen` | what is seen directly, and nothing at all: the very bits |
//! | `view` | Lambert's floor from head-on to grazing |
//! | `rough` | a lone rough mirror under an even sky: rho L, less what facets hide, by quadrature |
//! | `glass` | clear glass under an even sky, which cannot be seen; a slab of glass; rooms with glass |
//! | `lens` | the circle of confusion |
//! | `literal` | the paper's weight: its bias by quadrature |
//! | `sequences` | two of these under each sequence of numbers, and whether its intervals hold the truth |
//! | `agreement` | no closed form: all unbiased settings agree with one long render |
//!
//! `cross` crosses them with the knobs that must not matter. One form that others use has no
//! counterpart: a point light in the middle of a sphere; here are no point lights.
//!
//! Every comparison is one of [`support::gate::Form`]'s: a mean within 4 standard errors of the truth
//! (p = 6.3e-5, two-sided), or within 1e-5 of it, at a standard error of 0.2 % of it or less; or, where an
//! estimator has no variance, every sample within 1e-5; or the very bits. Seeds are fixed, so that a
//! device gives the same answer every time, and no two renders share one. Each gate is also shown to
//! reject renders that are wrong by little.

mod support;

mod closed_forms {
    mod agreement;
    mod bodies;
    mod concentric;
    mod cross;
    mod crowd;
    mod efficiency;
    mod enclosure;
    mod glass;
    mod lamp;
    mod lens;
    mod literal;
    mod lobe;
    mod panel;
    mod pinhole;
    mod rough;
    mod seen;
    mod sequences;
    mod shade;
    mod view;
}
