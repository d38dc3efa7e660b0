//! What each fuzz target does with its bytes. The same code runs under the fuzzer and, over the corpus that
//! is kept, in the test suite: a body panics where the library breaks a promise, and returns otherwise.

pub mod checkpoint;
pub mod diff_exr;
pub mod diff_png;
pub mod record;
pub mod scene;
pub mod scene_render;
pub mod set;
pub mod support;
pub mod sweep_grid;

/// Panics where an input makes the library break a promise.
pub type Body = fn(&[u8]);

/// Every target by its name, which is that of its corpus too.
#[allow(
    dead_code,
    reason = "the fuzzer runs one body; the test suite runs all"
)]
pub const TARGETS: [(&str, Body); 8] = [
    ("scene", scene::run),
    ("scene_render", scene_render::run),
    ("set", set::run),
    ("sweep_grid", sweep_grid::run),
    ("diff_png", diff_png::run),
    ("diff_exr", diff_exr::run),
    ("record", record::run),
    ("checkpoint", checkpoint::run),
];

/// The fuzzer's entry to a body. Its own hook ends the process at every panic, also at those of other
/// people's code that lampray catches and reads as errors; what nobody catches still ends it, and has been
/// told of by a line.
#[allow(unused_macros, reason = "used by the targets alone")]
macro_rules! target {
    ($name:ident) => {
        libfuzzer_sys::fuzz_target!(
            init: {
                std::panic::set_hook(Box::new(|panic| eprintln!("{panic}")));
            },
            |bytes: &[u8]| bodies::$name::run(bytes)
        );
    };
}
#[allow(unused_imports, reason = "used by the targets alone")]
pub(crate) use target;
