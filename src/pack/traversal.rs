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
        /// One body after the other, by code that is printed for the scene; on the CPU twin by its loops.
        Baked = "baked",
    }
}

/// From this many bodies on `auto` takes the tree. By `benches/kernels.rs` the tree is as fast as loops
/// at 75 bodies on lavapipe 25.0.7, at 160 on 22.3.6 and at 490 on the twin, whose loops try four bodies
/// at a time. The choice may not depend on the device, and this is the middle.
const MANY: usize = 160;

/// Up to this many bodies `auto` bakes what is worth it. By `benches/kernels.rs` what is baked is faster
/// than loops and tree up to 250 bodies, but there takes seconds to compile.
const FEW: usize = 64;

/// Rays of a picture that pays for compiling its scene: each path counts as up to [`DEPTH`] of them. On
/// two cores lavapipe needs 0.2 s and 8 ms a body, where the general kernel may be in the driver's cache,
/// and then traces a path in 8 ns a body less: which comes to two to four million paths.
const WORTH_BAKING: u64 = 1 << 24;
const DEPTH: u64 = 4;

impl Traversal {
    /// What `render.kernel` means for a scene.
    pub fn of(scene: &Scene) -> Self {
        match Self::of_one_of_many(scene) {
            Self::General if is_worth_baking(scene) => Self::Baked,
            other => other,
        }
    }

    /// For a scene among others that differ in their values, each of which would be compiled anew:
    /// `auto` bakes none of them.
    pub fn of_one_of_many(scene: &Scene) -> Self {
        match scene.settings.render.kernel {
            RenderKernel::Auto if bodies(scene) >= MANY => Self::Bvh,
            RenderKernel::Auto | RenderKernel::General => Self::General,
            RenderKernel::Bvh => Self::Bvh,
            RenderKernel::Baked => Self::Baked,
        }
    }
}

fn bodies(scene: &Scene) -> usize {
    scene.spheres.len() + scene.boxes.len()
}

/// By what the knobs say of the whole picture: parts of it, in space or in samples, are traced alike.
fn is_worth_baking(scene: &Scene) -> bool {
    let (image, render) = (&scene.settings.image, &scene.settings.render);
    let pixels = u64::from(image.width) * u64::from(image.height);
    let depth = (u64::from(render.max_bounces) + 1).min(DEPTH);
    let rays = pixels.saturating_mul(render.samples).saturating_mul(depth);
    render.kernel == RenderKernel::Auto && bodies(scene) <= FEW && rays >= WORTH_BAKING
}
