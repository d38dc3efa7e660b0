//! Which kernel traces a scene: decided by the scene and its knobs alone.

use crate::knobs::{Choice, RenderKernel, choice};
use crate::scene::Scene;

choice! {
    /// How rays find bodies.
    Traversal, "TRAVERSAL" {
        /// One body after the other.
        General = "general",
        /// By the tree of [`crate::bvh`].
        Bvh = "bvh",
    }
}

/// From this many bodies on `auto` takes the tree. By `benches/kernels.rs` the tree is as fast as loops
/// at 75 bodies on lavapipe 25.0.7, at 160 on 22.3.6 and at 490 on the twin, whose loops try four bodies
/// at a time. The choice may not depend on the device, and this is the middle.
const MANY: usize = 160;

impl Traversal {
    /// What `render.kernel` means for a scene.
    pub fn of(scene: &Scene) -> Self {
        let bodies = scene.spheres.len() + scene.boxes.len();
        match scene.settings.render.kernel {
            RenderKernel::Auto if bodies >= MANY => Self::Bvh,
            RenderKernel::Auto | RenderKernel::General => Self::General,
            RenderKernel::Bvh => Self::Bvh,
        }
    }
}
