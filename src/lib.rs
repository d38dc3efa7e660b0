//! A headless path tracer for studying how light is sampled.
//!
//! The renderer is written twice: as WGSL compute shaders, run through wgpu on any Vulkan, Metal or
//! DX12 device, software drivers included; and as the [`cpu`] twin in Rust, which needs no driver.
//! It implements Le Thi Kim Nga et al., "A sampling technique for light display" (2021), as
//! published and with unbiased weights.
//!
//! # The way of the data
//!
//! ```text
//! scene.toml ─parse→ Scene ─Packed::new→ flat buffers ─┬→ gpu (shaders/*.wgsl) ─┐
//!            knobs ↗         Task ─Plan→ blocks ───────┴→ cpu (the twin) ───────┴→ Film → Picture → EXR, PNG + record
//!                                 ↑────────────── Checkpoint ←──────────────────────┘
//!
//! Picture, guides ─denoise→ Picture for looking at, marked as such
//!
//! any EXR, PNG ─RasterFile→ Pair ─┬→ metrics, limits, maps ─┬→ Comparison → text, JSON, exit code
//!                                 └→ verdict ───────────────┘
//!
//! grid ─sweep→ runs.jsonl, pictures, references ─Answer::read→ Analysis ─┬fill→ ReportData ─report→ report.html
//! studies ─reproduce→ folders of sweeps ──────────Answer::read→ Analysis ─┴figures→ index.html, claims.md, plots, data
//! ```
//!
//! One direction: a room knows the rooms before it, never those after it.
//!
//! | room | what lives there |
//! |---|---|
//! | `shaders/` | kernels (`trace`, `features`, `guides`, `denoise`, `points`, `probe`, `canary`: group 1 and one entry point) and libraries (functions only; `scene`, `choice` and the traversals `loops`, `bvh` and `baked` alone read group 0) |
//! | [`knobs`] | the one table of knobs, the presets, the typed settings |
//! | [`scene`] | the scene's types, the TOML parser with places, the checks |
//! | [`bvh`] | bodies' bounds as a tree that is walked without a stack |
//! | [`pack`] | a scene as `#[repr(C)]` buffers and a strategy of override constants |
//! | [`shader`] | joins the WGSL files, prints constants from the Rust enums and scenes as straight-line code, parses and validates |
//! | [`device`] | what a device is; [`gpu`] and [`cpu`] are the two that there are |
//! | [`doctor`] | known-answer checks of a device, before it is trusted with a picture |
//! | [`render`] | choice of device, the plan of blocks, the thread that feeds a device ahead, stop rules, what happens when a device is lost |
//! | [`denoise`] | a picture without noise beside the one that was measured, for looking at |
//! | [`film`] | sums in f64, checkpoints, EXR, PNG, run record, merge; any program's images for comparing |
//! | [`compare`] | two picture files: metrics, limits, maps, the verdict; never renders |
//! | [`sweep`] | a grid of renders with their references: axes, plan, ledger, table, and the way back from a folder |
//! | [`analysis`] | the pictures of a sweep: bias, variance and cost, with intervals; never renders |
//! | [`figures`] | the paper's figures from what sweeps wrote: numbers, sentences, plots, pages; never renders |
//! | [`reproduce`] | renders what the figures are made of |
//! | [`calibrate`] | limits that are measured: renders and compares |
//! | [`theory`] | closed forms and quadratures of the paper's samplers and weights |
//! | [`points`] | the samplers alone, as data or as a plot |
//! | [`mod@bench`] | how fast devices trace: scenes by primitive count, paired ratios; renders, and keeps no picture |
//! | [`report`] | one page of HTML that shows a sweep's numbers and pictures |
//! | `panics` | panics of other people's code, caught where they are called |
//! | `wording` | plurals, signs and names in what is told to people |
//! | [`place`] | files that are whole or not there |
//! | [`cache`] | files that may vanish: verdicts of the doctor, compiled pipelines |
//! | [`cli`] | one file a command, each a thin face over the library |
//!
//! # The life of a sample
//!
//! 1. A sample has an address: seed, pixel, sample index. `random.wgsl` hashes it into a key, and the
//!    key with a dimension (vertex, slot) into four numbers. There is no other state: crops, sample
//!    ranges and splits draw the same numbers. Under another `render.sequence` `sequence.wgsl` stands before it: the
//!    samples of a pixel are cut into randomisations, each a well spread point set that is made random anew,
//!    and a number is a function of the same address.
//! 2. `trace.wgsl` starts a path at the pixel (`camera.wgsl`) and takes it from hit to hit: nearest
//!    hit (`loops`, `bvh`, or what `shader/bake` prints beside `baked`, with `sphere` and `box`; `scene` says what it is), emission, one shadow ray to each lamp (`light`, with
//!    `cap` for projected solid angle; `rectangle` for boxes) or to one that is drawn (`choice`, by a `light_tree`), and to
//!    the `background` where asked for, the interruption test (`interruption`), the next direction (`scatter`). By the rule
//!    `efficiency` a pilot on the CPU twin ([`cpu::pilot`]) says before the first sample what the rays that leave each body
//!    are worth; a path may then split (`efficiency`, `branch`), and its branches are traced one after the other as one sample.
//! 3. A lane adds its samples in f32 over runs that end at multiples of [`pack::RUN_LENGTH`] and writes a
//!    [`pack::Tally`]; [`film::Film`] adds tallies in f64, run by run. So the picture does not depend
//!    on how the work was split. Variances are those of samples, or of the means of randomisations.
//! 4. A [`render::Plan`] cuts the work into blocks of about 0.15 s. One thread owns the device and starts each
//!    block before the one in hand is done; another adds up what comes back and asks whoever watches. A film is
//!    plain data: a checkpoint is its sums, and [`render::go_on`] takes up any film where its plan left it, on
//!    the same device or, when that is lost, on another.
//!
//! # How to add
//!
//! - **A knob**: a row in `knobs/table.rs`, a field in [`knobs::Settings`].
//! - **A light sampler**: a name in [`knobs::LightSampler`], its sample and inverse density in
//!   `shaders/light.wgsl` and `src/cpu/light.rs` (or a library of its own, as `cap`), its chi-square case in the tests. The naga
//!   tests and the cross of the closed forms fail until all agree.
//! - **A sequence of numbers**: a name in [`knobs::Sequence`], a branch of `sequence_bits` in
//!   `shaders/sequence.wgsl` and `src/cpu/sequence.rs`; its strata in `tests/samplers/sequence.rs`. Whatever draws
//!   a number calls `sequence_unit`, with a slot of its own.
//! - **A scattering**: a name in [`knobs::Scatter`]; sample, evaluate and density in `scatter` of both
//!   twins; fields in [`pack::Material`].
//! - **A metric**: a name in [`compare::Metric`] with its definition; of linear light in
//!   `compare/survey.rs`, of what a screen shows in a file of its own; its value by hand or from
//!   another program in the tests.
//! - **A way to find bodies**: a name in [`knobs::RenderKernel`] and [`pack::Traversal`]; a file beside
//!   `loops.wgsl` and `bvh.wgsl` with the same functions, which `shader/join.rs` puts where `traversal` is
//!   imported; its twin behind [`cpu::scene::Traversal`]. `tests/bvh` holds that pictures stay the same bits.
//! - **A kernel**: a file in `shaders/`, a name in [`shader::Kernel`] and in `shader/library.rs`.

// One call of wgpu is unsafe, in `gpu`, which forbids it in all of its files but one. No other room has any.
#![deny(unsafe_code)]

#[forbid(unsafe_code)]
pub mod analysis;
#[forbid(unsafe_code)]
pub mod bench;
#[forbid(unsafe_code)]
pub mod bvh;
#[forbid(unsafe_code)]
pub mod cache;
#[forbid(unsafe_code)]
pub mod calibrate;
#[forbid(unsafe_code)]
pub mod cli;
#[forbid(unsafe_code)]
pub mod compare;
#[forbid(unsafe_code)]
pub mod cpu;
#[forbid(unsafe_code)]
pub mod denoise;
#[forbid(unsafe_code)]
pub mod device;
#[forbid(unsafe_code)]
pub mod doctor;
#[forbid(unsafe_code)]
pub mod error;
#[forbid(unsafe_code)]
pub mod figures;
#[forbid(unsafe_code)]
pub mod film;
pub mod gpu;
#[forbid(unsafe_code)]
pub mod knobs;
#[forbid(unsafe_code)]
pub mod pack;
#[forbid(unsafe_code)]
mod panics;
#[forbid(unsafe_code)]
pub mod place;
#[forbid(unsafe_code)]
pub mod points;
#[forbid(unsafe_code)]
pub mod render;
#[forbid(unsafe_code)]
pub mod report;
#[forbid(unsafe_code)]
pub mod reproduce;
#[forbid(unsafe_code)]
pub mod scene;
#[forbid(unsafe_code)]
pub mod shader;
#[forbid(unsafe_code)]
pub mod sweep;
#[forbid(unsafe_code)]
pub mod theory;
#[forbid(unsafe_code)]
mod wording;

pub use error::{Error, Result};
