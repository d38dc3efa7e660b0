//! The values that cross to a device: Rust's layout against what naga reads in the shaders, and
//! the tables of bindings against the shaders' own.

use lampray::gpu::{Binding, bindings, binds_scene, scene_bindings};
use lampray::knobs::Choice;
use lampray::pack::*;
use lampray::shader::{self, Kernel, SceneArrays};
use naga::{AddressSpace, StorageAccess, TypeInner};
use std::collections::{BTreeMap, BTreeSet};
use std::mem::offset_of;

/// What a field holds: scalars of one kind in lanes, or a struct.
#[derive(Clone, Debug, PartialEq, Eq)]
enum Holds {
    Lanes(naga::Scalar, u32),
    Struct(String),
}

trait Field {
    fn holds() -> Holds;
}

macro_rules! lanes {
    ($($type:ty = $scalar:ident x $count:literal),+ $(,)?) => {
        $(impl Field for $type {
            fn holds() -> Holds {
                Holds::Lanes(naga::Scalar::$scalar, $count)
            }
        })+
    };
}

lanes!(
    f32 = F32 x 1, [f32; 2] = F32 x 2, [f32; 3] = F32 x 3, [f32; 4] = F32 x 4,
    u32 = U32 x 1, [u32; 2] = U32 x 2,
);

macro_rules! structs {
    ($($type:ty = $name:literal),+ $(,)?) => {
        $(impl Field for $type {
            fn holds() -> Holds {
                Holds::Struct($name.into())
            }
        })+
    };
}

structs!(
    Camera = "Camera",
    Basis = "Basis",
    Lamp = "Lamp",
    Material = "Material",
    Sphere = "Sphere",
    Worth = "Worth",
    Cuboid = "Box",
    CanaryScene = "CanaryScene"
);

/// One field of a struct: where it stands and what it holds.
type Fields = BTreeMap<String, (usize, Holds)>;

#[derive(Clone, Debug, PartialEq, Eq)]
struct Layout {
    size: usize,
    fields: Fields,
}

fn holds_of<S, F: Field>(_: fn(&S) -> &F) -> Holds {
    F::holds()
}

/// A Rust struct's layout by its own names; padding is left out.
macro_rules! layout {
    ($type:ty { $($field:ident),+ $(,)? }) => {
        Layout {
            size: size_of::<$type>(),
            fields: BTreeMap::from([$((
                stringify!($field).to_string(),
                (offset_of!($type, $field), holds_of(|value: &$type| &value.$field)),
            )),+]),
        }
    };
}

/// Every struct that crosses, by its name in WGSL.
fn rust_layouts() -> BTreeMap<&'static str, Layout> {
    BTreeMap::from([
        (
            "Camera",
            layout!(Camera {
                forward,
                aperture,
                right,
                focus,
                down,
                pixel
            }),
        ),
        ("Basis", layout!(Basis { x, y, z })),
        (
            "Sphere",
            layout!(Sphere {
                center,
                radius,
                material,
                lamp,
                body
            }),
        ),
        (
            "Box",
            layout!(Cuboid {
                center,
                material,
                half_size,
                id,
                body,
                axis_x,
                axis_y,
                lamp,
                axis_z
            }),
        ),
        (
            "Material",
            layout!(Material {
                albedo,
                scatter,
                emission,
                survival,
                spread,
                lobe_mass,
                lobe_scale,
                shape
            }),
        ),
        (
            "Lamp",
            layout!(Lamp {
                center,
                radius,
                emission,
                body,
                weight_radius,
                shape
            }),
        ),
        ("Worth", layout!(Worth { split, keep })),
        (
            "Job",
            layout!(Job {
                camera,
                pole,
                background,
                clamp,
                corner,
                size,
                seed,
                first_sample,
                samples,
                max_bounces,
                interruption_start,
                steps,
            }),
        ),
        (
            "FeatureJob",
            layout!(FeatureJob {
                camera,
                corner,
                size,
                iterations
            }),
        ),
        (
            "GuideJob",
            layout!(GuideJob {
                camera,
                corner,
                size,
                fineness,
                mirrors,
                iterations
            }),
        ),
        (
            "Guide",
            layout!(Guide {
                normal,
                distance,
                position,
                id,
                tint,
                mirrors
            }),
        ),
        (
            "DenoiseJob",
            layout!(DenoiseJob {
                corner,
                size,
                window,
                step,
                only_variance,
                light,
                normal,
                depth
            }),
        ),
        (
            "Site",
            layout!(Site {
                normal,
                footprint,
                position,
                spread,
                kind
            }),
        ),
        ("Estimate", layout!(Estimate { light, variance })),
        (
            "PointsJob",
            layout!(PointsJob {
                lamp,
                material,
                pole,
                receiver,
                inside,
                normal,
                count,
                incoming,
                scattering,
                seed,
                first,
            }),
        ),
        (
            "Draw",
            layout!(Draw {
                point,
                density,
                useful
            }),
        ),
        ("ProbeJob", layout!(ProbeJob { function, count })),
        (
            "CanaryScene",
            layout!(CanaryScene {
                material,
                lamp,
                sphere,
                body
            }),
        ),
        (
            "CanaryJob",
            layout!(CanaryJob {
                camera,
                pole,
                scene,
                background,
                clamp,
                corner,
                seed,
                canary,
                count
            }),
        ),
        ("Input", layout!(ProbeInput { a, b, c, d })),
        ("Output", layout!(ProbeOutput { a, b })),
        (
            "Tally",
            layout!(Tally {
                mean,
                rays,
                squares,
                non_finite
            }),
        ),
        (
            "Feature",
            layout!(Feature {
                normal,
                depth,
                albedo,
                id
            }),
        ),
    ])
}

fn arrays(length: usize) -> SceneArrays {
    SceneArrays {
        materials: length,
        spheres: length,
        boxes: length,
        lamps: length,
        worths: length,
        ..SceneArrays::default()
    }
}

/// The same with a tree over the bodies.
fn with_tree(length: usize) -> SceneArrays {
    SceneArrays {
        nodes: 2 * length,
        outside_spheres: length.min(16),
        outside_boxes: length.min(16),
        ..arrays(length)
    }
}

fn module(kernel: Kernel, arrays: SceneArrays) -> naga::Module {
    let joined = shader::source(kernel, arrays).unwrap();
    shader::parse(&joined).unwrap_or_else(|e| panic!("{e}"))
}

fn holds(module: &naga::Module, kind: &naga::Type) -> Holds {
    match kind.inner {
        TypeInner::Scalar(scalar) => Holds::Lanes(scalar, 1),
        TypeInner::Vector { size, scalar } => Holds::Lanes(scalar, size as u32),
        TypeInner::Struct { .. } => Holds::Struct(kind.name.clone().unwrap()),
        _ => panic!("{kind:?} in a buffer of {:?}", module.entry_points[0].name),
    }
}

/// A WGSL struct's layout; padding is left out.
fn wgsl_layout(module: &naga::Module, kind: &naga::Type) -> Layout {
    let TypeInner::Struct { members, span } = &kind.inner else {
        panic!("{kind:?} is no struct");
    };
    let mut fields = Fields::new();
    for member in members {
        let name = member.name.clone().unwrap();
        if !name.starts_with("_pad") {
            let held = holds(module, &module.types[member.ty]);
            fields.insert(name, (member.offset as usize, held));
        }
    }
    Layout {
        size: *span as usize,
        fields,
    }
}

/// The struct that the host prints for scenes that fit a uniform buffer.
const SCENE: &str = "SceneData";

/// The structs that a kernel's bindings hold, nested ones too, and the stride of those in arrays.
fn bound_structs(module: &naga::Module) -> Vec<(&naga::Type, Option<u32>)> {
    let mut found = Vec::new();
    let globals = module.global_variables.iter();
    let bound = globals.filter(|(_, global)| global.binding.is_some());
    let mut open: Vec<_> = bound.map(|(_, global)| (global.ty, None)).collect();
    while let Some((handle, stride)) = open.pop() {
        let kind = &module.types[handle];
        match &kind.inner {
            TypeInner::Array { base, stride, .. } => open.push((*base, Some(*stride))),
            TypeInner::Struct { members, .. } => {
                // Arrays one after the other, with a test of their own.
                if kind.name.as_deref() != Some(SCENE) {
                    found.push((kind, stride));
                }
                open.extend(members.iter().map(|member| (member.ty, None)));
            }
            _ => {}
        }
    }
    found
}

#[test]
fn structs_are_laid_out_alike() {
    let rust = rust_layouts();
    let mut seen = BTreeSet::new();
    for &kernel in Kernel::ALL {
        for arrays in [arrays(1), arrays(100_000), with_tree(1), with_tree(100_000)] {
            let module = module(kernel, arrays);
            for (kind, stride) in bound_structs(&module) {
                let name = kind.name.clone().unwrap();
                let layout = rust.get(name.as_str());
                let layout = layout.unwrap_or_else(|| panic!("{name} is not in the test's table"));
                assert_eq!(*layout, wgsl_layout(&module, kind), "{kernel}: {name}");
                if let Some(stride) = stride {
                    assert_eq!(layout.size, stride as usize, "{kernel}: array of {name}");
                }
                seen.insert(name);
            }
        }
    }
    let listed: BTreeSet<_> = rust.keys().map(ToString::to_string).collect();
    assert_eq!(seen, listed, "the table lists structs that no kernel binds");
}

/// Where the host puts each array of a scene that is one uniform buffer: one after the other.
fn packed_offsets(arrays: SceneArrays) -> Vec<(usize, usize)> {
    let mut next = 0;
    let place = |array: &shader::SceneArray| {
        let start = next;
        next += array.length * array.stride;
        (start, array.length)
    };
    arrays.uniform().iter().map(place).collect()
}

/// Offset and length of each array of the printed struct.
fn printed_offsets(module: &naga::Module) -> Vec<(usize, usize)> {
    let mut types = module.types.iter().map(|(_, kind)| kind);
    let scene = types.find(|kind| kind.name.as_deref() == Some(SCENE));
    let TypeInner::Struct { members, .. } = &scene.unwrap().inner else {
        panic!("{SCENE} is no struct");
    };
    let place = |member: &naga::StructMember| match module.types[member.ty].inner {
        TypeInner::Array {
            size: naga::ArraySize::Constant(length),
            ..
        } => (member.offset as usize, length.get() as usize),
        ref other => panic!("{other:?} in {SCENE}"),
    };
    members.iter().map(place).collect()
}

#[test]
fn a_scene_in_one_buffer_lies_as_it_is_uploaded() {
    for lengths in [[1, 1, 1, 1], [2, 4, 8, 1], [16, 1, 2, 4], [8, 64, 32, 8]] {
        let [materials, spheres, boxes, lamps] = lengths;
        let arrays = SceneArrays {
            materials,
            spheres,
            boxes,
            lamps,
            worths: spheres + boxes,
            ..SceneArrays::default()
        };
        let with_tree = SceneArrays {
            nodes: 100,
            outside_spheres: lamps,
            outside_boxes: materials,
            ..arrays
        };
        let with_choice = SceneArrays {
            choice: 4 * lamps,
            ..arrays
        };
        for arrays in [arrays, with_tree, with_choice] {
            for kernel in [Kernel::Trace, Kernel::Features] {
                let printed = printed_offsets(&module(kernel, arrays));
                assert_eq!(printed, packed_offsets(arrays), "{kernel} {lengths:?}");
            }
        }
        let swapped = SceneArrays {
            boxes: boxes + 1,
            spheres: spheres + 1,
            ..arrays
        };
        let printed = printed_offsets(&module(Kernel::Trace, swapped));
        assert_ne!(printed, packed_offsets(arrays));
    }
}

/// [`Sphere`] with two fields of one size in the wrong order.
#[repr(C)]
struct Swapped {
    center: Vec3,
    radius: f32,
    lamp: u32,
    material: u32,
    body: u32,
    _pad0: u32,
}

/// [`Sphere`] with a field of the right size and the wrong kind.
#[repr(C)]
struct Retyped {
    center: Vec3,
    radius: u32,
    material: u32,
    lamp: u32,
    body: u32,
    _pad0: u32,
}

/// [`Sphere`] without its padding.
#[repr(C)]
struct Short {
    center: Vec3,
    radius: f32,
    material: u32,
    lamp: u32,
    body: u32,
}

#[test]
fn a_wrong_layout_is_caught() {
    let module = module(Kernel::Trace, arrays(1));
    let structs = bound_structs(&module);
    let sphere = structs
        .iter()
        .find(|(kind, _)| kind.name.as_deref() == Some("Sphere"));
    let right = wgsl_layout(&module, sphere.unwrap().0);
    assert_eq!(
        layout!(Sphere {
            center,
            radius,
            material,
            lamp,
            body
        }),
        right
    );
    assert_ne!(
        layout!(Swapped {
            center,
            radius,
            material,
            lamp,
            body
        }),
        right
    );
    assert_ne!(
        layout!(Retyped {
            center,
            radius,
            material,
            lamp,
            body
        }),
        right
    );
    assert_ne!(
        layout!(Short {
            center,
            radius,
            material,
            lamp,
            body
        }),
        right
    );
    assert_ne!(
        layout!(Sphere {
            center,
            radius,
            material
        }),
        right
    );
}

fn binding_kind(space: AddressSpace) -> Binding {
    match space {
        AddressSpace::Uniform => Binding::Uniform,
        AddressSpace::Storage { access } if access == StorageAccess::LOAD => Binding::Read,
        AddressSpace::Storage { access }
            if access == StorageAccess::LOAD | StorageAccess::STORE =>
        {
            Binding::Write
        }
        other => panic!("{other:?} is bound to nothing that the pipelines know"),
    }
}

/// Group, number and kind of each of a kernel's bindings.
fn declared(module: &naga::Module) -> BTreeMap<(u32, u32), Binding> {
    let mut all = BTreeMap::new();
    for (_, global) in module.global_variables.iter() {
        if let Some(place) = &global.binding {
            let kind = binding_kind(global.space);
            assert!(all.insert((place.group, place.binding), kind).is_none());
        }
    }
    all
}

/// The same from the tables that the pipelines are made by.
fn tabled(kernel: Kernel, arrays: SceneArrays) -> BTreeMap<(u32, u32), Binding> {
    let scene = binds_scene(kernel).then(|| scene_bindings(arrays));
    let scene = scene.unwrap_or_default().into_iter().zip(0..);
    let pass = bindings(kernel).iter().copied().zip(0..);
    let scene = scene.map(|(kind, number)| ((0, number), kind));
    scene
        .chain(pass.map(|(kind, number)| ((1, number), kind)))
        .collect()
}

#[test]
fn bindings_match_the_tables() {
    let mixed = SceneArrays {
        spheres: 100_000,
        lamps: 100_000,
        ..arrays(2)
    };
    for &kernel in Kernel::ALL {
        for arrays in [
            arrays(1),
            arrays(100_000),
            mixed,
            with_tree(1),
            with_tree(100_000),
        ] {
            let shader = declared(&module(kernel, arrays));
            assert_eq!(shader, tabled(kernel, arrays), "{kernel} {arrays:?}");
        }
    }
    let trace = declared(&module(Kernel::Trace, arrays(1)));
    assert_ne!(trace, tabled(Kernel::Trace, mixed));
    assert_ne!(trace, tabled(Kernel::Points, arrays(1)));
}
