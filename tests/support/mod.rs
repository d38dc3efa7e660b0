//! What the tests share: one GPU a process, renders that are long enough, the gates they must pass,
//! chance, quadrature, and inputs.

#![allow(dead_code, unused_imports, reason = "each test file uses its own part")]

pub mod bench;
pub mod chance;
pub mod form;
pub mod gate;
pub mod quadrature;
pub mod same;
pub mod stream;

use lampray::gpu::{Gpu, adapters};
use lampray::knobs::*;
use lampray::pack::{LastRay, Strategy};
use std::io::Write;
use std::sync::{Mutex, MutexGuard, OnceLock, PoisonError};

/// The process's one GPU: software drivers leak memory with every device that is opened.
static GPU: OnceLock<Option<Mutex<Gpu>>> = OnceLock::new();

/// The first graphics device. Where there is none, a test that was told to need one fails, and any
/// other says that this half of it was not run.
pub fn gpu(what: &str) -> Option<MutexGuard<'static, Gpu>> {
    let found = GPU.get_or_init(|| {
        let all = adapters();
        let first = all.infos().next().is_some();
        first.then(|| Mutex::new(Gpu::open(&all, 0).expect("the first device opens")))
    });
    if found.is_none() {
        let required = std::env::var_os("LAMPRAY_REQUIRE_GPU").is_some_and(|value| value == "1");
        assert!(
            !required,
            "LAMPRAY_REQUIRE_GPU=1, and no graphics device was found"
        );
        // Not eprintln!, which the test harness swallows for tests that pass.
        let _ = writeln!(
            std::io::stderr(),
            "NOT RUN on a GPU: {what} (no graphics device was found)"
        );
    }
    // A test that failed while it held the device leaves the device itself in order.
    found
        .as_ref()
        .map(|gpu| gpu.lock().unwrap_or_else(PoisonError::into_inner))
}

/// The strategy of the preset `reference` for a scene without bodies.
pub fn strategy() -> Strategy {
    Strategy {
        filter: Filter::Box,
        light_sampler: LightSampler::Cone,
        light_weight: LightWeight::Pdf,
        light_test: LightTest::Point,
        light_strategy: LightStrategy::Mis,
        light_choice: LightChoice::All,
        light_direct: LightDirect::Bsdf,
        pole_at_receiver: false,
        box_lamps: false,
        background_lamp: false,
        scatter_diffuse: ScatterDiffuse::Cosine,
        scatter_bound: ScatterBound::Truncate,
        interruption_rule: InterruptionRule::Throughput,
        interruption_weight: InterruptionWeight::Compensated,
        interruption_order: InterruptionOrder::AfterDirect,
        interruption_split: 1,
        last_ray: LastRay::Always,
        rough_surfaces: false,
        glass_surfaces: false,
        lens: false,
        sequence: Sequence::Independent,
        randomisation_bits: 4,
        sphere_count: 0,
        box_count: 0,
        rotated_box_count: 0,
        lamp_count: 0,
        light_loops: 0,
        outside_sphere_count: 0,
        outside_box_count: 0,
        outside_rotated_count: 0,
    }
}
