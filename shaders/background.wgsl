// The background as a light: directions by the cosine to the lit surface's normal. A matt surface then weighs them all
// the same, and half of what is drawn evenly over the hemisphere would be spent on what it hardly reflects.

// #import maths

// 1: shadow rays look for the background.
override BACKGROUND_LAMP: u32;

// The slot of its random numbers: no lamp's.
const BACKGROUND_SLOT: u32 = 0xffffffffu;

// Inverse density by solid angle of `sample_cosine`. Below the surface, where it draws none and light may yet be sent
// on, it is as large as if there were nothing to draw.
fn background_inverse_density(normal: vec3<f32>, direction: vec3<f32>) -> f32 {
    let up = dot(normal, direction);
    return select(1e30, PI / greater(up, 1e-30), up > 0.0);
}
