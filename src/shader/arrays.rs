//! The scene's arrays as the shaders see them: which there are, how long they are, and in which kind of
//! buffer each lies.

use crate::bvh;
use crate::pack::{self, Packed, Traversal};

/// Uniform buffers of this many bytes work on every device; larger scenes go into storage buffers.
const UNIFORM_BYTES: usize = 16 * 1024;

/// Stands for the array where no lamp is chosen.
const NO_CHOICE: &str = "fn choice_at(index: u32) -> vec4<u32> {\n    return vec4<u32>(0u);\n}\n";

/// For scenes of which nobody asks it: the function is there, and is never called.
const NO_WORTHS: &str =
    "fn worth_at(index: u32) -> Worth {\n    return Worth(vec3<f32>(0.0), vec3<f32>(0.0));\n}\n";

/// Lengths of the scene's arrays on the device, which the shader's declarations depend on.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub struct SceneArrays {
    pub materials: usize,
    pub spheres: usize,
    pub boxes: usize,
    pub lamps: usize,
    /// 0 where no rule asks what the rays that leave a body are worth.
    pub worths: usize,
    /// Entries of the tree; 0 where rays find bodies without one.
    pub nodes: usize,
    /// Bodies outside the tree.
    pub outside_spheres: usize,
    pub outside_boxes: usize,
    /// Entries of what a lamp is chosen by; 0 where each has its own shadow ray.
    pub choice: usize,
}

/// One array of the scene: the name of its accessor, its WGSL element type, its length, and the
/// bytes of an element.
#[derive(Clone, Copy, Debug)]
pub struct SceneArray {
    pub name: &'static str,
    pub element: &'static str,
    pub length: usize,
    pub stride: usize,
}

impl SceneArray {
    fn new<T>(name: &'static str, element: &'static str, length: usize) -> Self {
        Self {
            name,
            element,
            length,
            stride: size_of::<T>(),
        }
    }

    pub fn bytes(&self) -> usize {
        self.length * self.stride
    }

    /// The function that reads an element from where the array lies.
    fn accessor(&self, place: &str) -> String {
        let Self { name, element, .. } = self;
        format!("fn {name}(index: u32) -> {element} {{\n    return {place}[index];\n}}\n")
    }
}

fn bytes(arrays: &[SceneArray]) -> usize {
    arrays.iter().map(SceneArray::bytes).sum()
}

impl SceneArrays {
    /// The lengths that hold a scene. Small ones grow in powers of two, so that scenes of nearly one
    /// size share a shader; none is empty, since WGSL has no empty arrays.
    pub fn new(packed: &Packed) -> Self {
        let lengths = |room: fn(usize) -> usize| {
            let (nodes, spheres, boxes) = match &packed.hierarchy {
                Some(all) => (
                    all.tree.nodes.len(),
                    room(all.spheres.len()),
                    room(all.boxes.len()),
                ),
                None => (0, 0, 0),
            };
            Self {
                materials: room(packed.materials.len()),
                spheres: room(packed.spheres.len()),
                boxes: room(packed.boxes.len()),
                lamps: room(packed.lamps.len()),
                worths: packed.worths.len(),
                nodes,
                outside_spheres: spheres,
                outside_boxes: boxes,
                choice: packed.choice.entries.len(),
            }
        };
        let rounded = lengths(|count| count.max(1).next_power_of_two());
        if rounded.storage().is_empty() {
            rounded
        } else {
            lengths(|count| count.max(1))
        }
    }

    /// How rays find bodies in a scene of these arrays.
    pub fn traversal(&self) -> Traversal {
        match self.nodes {
            0 => Traversal::General,
            _ => Traversal::Bvh,
        }
    }

    fn small(&self) -> Vec<SceneArray> {
        let all = [
            SceneArray::new::<pack::Material>("material_at", "Material", self.materials),
            SceneArray::new::<pack::Cuboid>("box_at", "Box", self.boxes),
            SceneArray::new::<pack::Lamp>("lamp_at", "Lamp", self.lamps),
            SceneArray::new::<pack::ChoiceEntry>("choice_at", "vec4<u32>", self.choice),
            SceneArray::new::<pack::Worth>("worth_at", "Worth", self.worths),
        ];
        all.into_iter().filter(|array| array.length > 0).collect()
    }

    fn spheres(&self) -> SceneArray {
        SceneArray::new::<pack::Sphere>("sphere_at", "Sphere", self.spheres)
    }

    fn outside(&self) -> [SceneArray; 2] {
        [
            SceneArray::new::<pack::Sphere>("outside_sphere_at", "Sphere", self.outside_spheres),
            SceneArray::new::<pack::Cuboid>("outside_box_at", "Box", self.outside_boxes),
        ]
    }

    /// The arrays in a uniform buffer, in their order. It is one buffer and not several because lavapipe
    /// 22.3 writes past a table of its own for a kernel's fourth uniform buffer, and crashes.
    ///
    /// Without a tree they are all or none. With one, nodes and spheres are many; bodies outside the
    /// tree are few, and every ray tries them.
    pub fn uniform(&self) -> Vec<SceneArray> {
        let (small, outside) = (self.small(), self.outside());
        let by_tree = self.nodes > 0;
        let whole = match by_tree {
            false => [&small[..], &[self.spheres()]].concat(),
            true => [&outside[..], &small].concat(),
        };
        match by_tree {
            _ if bytes(&whole) <= UNIFORM_BYTES => {
                let held = whole.into_iter().filter(|array| array.length > 0);
                held.collect()
            }
            false => Vec::new(),
            true => outside.to_vec(),
        }
    }

    /// The arrays in storage buffers of their own, in the order of their bindings.
    pub fn storage(&self) -> Vec<SceneArray> {
        let uniform = self.uniform();
        let tree = [
            SceneArray::new::<bvh::Encoded>("node_at", "vec4<u32>", self.nodes),
            SceneArray::new::<u32>("node_body_at", "u32", self.nodes),
        ];
        let all = [&self.small()[..], &[self.spheres()], &tree].concat();
        let elsewhere = |array: &SceneArray| uniform.iter().any(|other| other.name == array.name);
        let left = all.into_iter().filter(|array| !elsewhere(array));
        left.filter(|array| array.length > 0).collect()
    }

    /// Bind group 0 and the functions that read it: `sphere_at(i)` and the like.
    pub(super) fn declarations(&self) -> String {
        self.declarations_but(&[])
    }

    /// Without the functions called `elsewhere`, which another text has.
    pub(super) fn declarations_but(&self, elsewhere: &[&str]) -> String {
        let (uniform, storage) = (self.uniform(), self.storage());
        let is_here = |array: &SceneArray| !elsewhere.contains(&array.name);
        let mut text = String::new();
        if !uniform.is_empty() {
            let member = |array: &SceneArray| {
                let SceneArray {
                    name,
                    element,
                    length,
                    ..
                } = array;
                format!("    {name}_: array<{element}, {length}>,\n")
            };
            let members: String = uniform.iter().map(member).collect();
            text += &format!(
                "struct SceneData {{\n{members}}}\n@group(0) @binding(0) var<uniform> scene_data: SceneData;\n"
            );
            let read = |array: &SceneArray| array.accessor(&format!("scene_data.{}_", array.name));
            let here = uniform.iter().filter(|array| is_here(array));
            text.extend(here.map(read));
        }
        if self.worths == 0 {
            text += NO_WORTHS;
        }
        let first = usize::from(!uniform.is_empty());
        for (binding, array) in (first..).zip(&storage) {
            let SceneArray { name, element, .. } = array;
            text += &format!(
                "@group(0) @binding({binding}) var<storage, read> {name}_: array<{element}>;\n"
            );
            if is_here(array) {
                text += &array.accessor(&format!("{name}_"));
            }
        }
        if self.choice == 0 {
            text += NO_CHOICE;
        }
        text
    }
}
