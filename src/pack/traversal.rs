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

/// From this many bodies on a tree is faster.
const MANY: usize = 48;

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
