//! A scene as WGSL: its bodies as straight-line code with its numbers in it, which takes the place of
//! `loops.wgsl` in the tracing kernel. `shaders/baked.wgsl` has what is the same for every scene.

mod element;

use super::SceneArrays;
use crate::error::{Error, Result};
use crate::pack::Packed;
use crate::scene::MOST_BAKED;
use element::{Element, accessor, constructed, number, vector};

/// Arrays of more elements are read from where they lie: a tree of selects takes one for each element and
/// number.
const LONGEST_TREE: usize = 64;

/// The part of a tracing kernel that is printed for one scene.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Baked {
    pub text: String,
    /// Of the text: what a pipeline is known by.
    pub hash: [u8; 32],
}

impl Baked {
    /// For a scene whose arrays these are.
    ///
    /// # Errors
    /// [`Error::Device`] for more bodies than compilers are asked to take.
    pub fn new(scene: &Packed, arrays: SceneArrays) -> Result<Self> {
        let bodies = scene.spheres.len() + scene.boxes.len();
        if bodies > MOST_BAKED {
            return Err(Error::Device(format!(
                "the kernel `baked` takes up to {MOST_BAKED} bodies, and the scene has {bodies}; use --set render.kernel=auto"
            )));
        }
        let text = [reading(scene, arrays), nearest_hit(scene), occluded(scene)].concat();
        Ok(Self {
            hash: *blake3::hash(text.as_bytes()).as_bytes(),
            text,
        })
    }
}

/// The bindings, and the functions that read the scene: trees of selects, which need no gathers.
fn reading(scene: &Packed, arrays: SceneArrays) -> String {
    let trees = [
        ("material_at", tree("material_at", &scene.materials)),
        ("sphere_at", tree("sphere_at", &scene.spheres)),
        ("box_at", tree("box_at", &scene.boxes)),
        ("lamp_at", tree("lamp_at", &scene.lamps)),
    ];
    let trees = trees
        .iter()
        .filter_map(|(name, text)| Some((*name, text.as_ref()?)));
    let (names, texts): (Vec<_>, Vec<_>) = trees.unzip();
    let texts: String = texts.into_iter().map(String::as_str).collect();
    arrays.declarations_but(&names) + &texts
}

/// None where an array is read from its buffer.
fn tree<T: Element>(name: &str, items: &[T]) -> Option<String> {
    (1..=LONGEST_TREE)
        .contains(&items.len())
        .then(|| accessor(name, items))
}

/// Each body, by its number, with the call that says how far a ray is from it: in the order of the
/// general traversal, by whose rule the first of equally near bodies is met.
fn distances(scene: &Packed) -> Vec<(u32, String)> {
    let spheres = scene.spheres.iter().map(|sphere| {
        let (center, radius, body) = (vector(sphere.center), number(sphere.radius), sphere.body);
        let call = format!("to_sphere({center}, {radius}, ray, {body}u)");
        (body, call)
    });
    let (straight, rotated) = scene.boxes.split_at(scene.strategy.box_count as usize);
    let straight = straight.iter().map(|shape| {
        let (center, half, body) = (vector(shape.center), vector(shape.half_size), shape.body);
        let call = format!("to_box({center}, {half}, inverse, ray, {body}u)");
        (body, call)
    });
    let rotated = rotated.iter().map(|shape| {
        let call = format!("to_rotated_box({}, ray)", constructed(shape));
        (shape.body, call)
    });
    spheres.chain(straight).chain(rotated).collect()
}

const INVERSE: &str = "    let inverse = safe_inverse(ray.direction);\n";

fn nearest_hit(scene: &Packed) -> String {
    let line = |(body, distance)| format!("    best = nearer(best, {distance}, {body}u);\n");
    let lines: String = distances(scene).into_iter().map(line).collect();
    format!(
        "fn nearest_hit(ray: Ray) -> Hit {{\n{INVERSE}    var best = Hit(3e38, 0u);\n{lines}    return found(best);\n}}\n"
    )
}

fn occluded(scene: &Packed) -> String {
    let line = |(body, distance)| {
        format!("    blocked |= blocks({distance}, reach) & (target_body != {body}u);\n")
    };
    let lines: String = distances(scene).into_iter().map(line).collect();
    format!(
        "fn occluded(ray: Ray, reach: f32, target_body: u32) -> bool {{\n{INVERSE}    var blocked = false;\n{lines}    return blocked;\n}}\n"
    )
}
