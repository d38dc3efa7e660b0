//! Materials, spheres and boxes from a draft, each checked by itself.

use super::build::{Builder, stand_in};
use super::draft::Group;
use super::{Cuboid, Material, Sphere};
use crate::knobs::{SMALLEST, Value, choice, in_section, nearest, short};
use glam::DVec3;
use std::collections::HashMap;

impl Builder<'_, '_, '_> {
    /// A knob of a material, sphere or box.
    fn of(&mut self, group: &Group, section: &'static str, key: &str) -> Value {
        let entry = group.entry(key);
        if let Some(value) = entry.and_then(|entry| entry.value.clone()) {
            return value;
        }
        let Some(knob) = in_section(section).find(|knob| knob.key() == key) else {
            unreachable!("`{section}.*.{key}` is not in the table of knobs");
        };
        if entry.is_none() && knob.default().is_none() && self.whole {
            self.faults.add(group.origin.clone(), || {
                let path = format!("{section}.{}", group.name);
                let note = format!("it needs `{key}`: {}", knob.meaning);
                (format!("`{path}` has no `{key}`"), Some(note))
            });
        }
        stand_in(knob, self.preset)
    }

    pub(super) fn materials(&mut self) -> Vec<Material> {
        let draft = self.draft;
        let of = |group: &Group| Material {
            name: group.name.clone(),
            scatter: choice(&self.of(group, "materials", "scatter")),
            albedo: self.of(group, "materials", "albedo").triple(),
            spread: self.of(group, "materials", "spread").number(),
            roughness: self.of(group, "materials", "roughness").number(),
            index: self.of(group, "materials", "index").number(),
            survival: self.of(group, "materials", "survival").number(),
            emission: self.of(group, "materials", "emission").triple(),
        };
        draft.materials.iter().map(of).collect()
    }

    pub(super) fn spheres(&mut self, names: &HashMap<&str, usize>) -> Vec<Sphere> {
        let draft = self.draft;
        let of = |group: &Group| Sphere {
            center: self.of(group, "spheres", "center").triple(),
            radius: self.of(group, "spheres", "radius").number(),
            material: self.material(group, "spheres", names),
        };
        draft.spheres.iter().map(of).collect()
    }

    pub(super) fn boxes(&mut self, names: &HashMap<&str, usize>) -> Vec<Cuboid> {
        let draft = self.draft;
        let of = |group: &Group| {
            let cuboid = Cuboid {
                min: self.of(group, "boxes", "min").triple(),
                max: self.of(group, "boxes", "max").triple(),
                rotation: self.of(group, "boxes", "rotation").triple(),
                material: self.material(group, "boxes", names),
            };
            self.corners(group, &cuboid);
            cuboid
        };
        draft.boxes.iter().map(of).collect()
    }

    fn corners(&mut self, group: &Group, cuboid: &Cuboid) {
        let written = |key| group.entry(key).is_some_and(|entry| entry.value.is_some());
        if !written("min") || !written("max") {
            return;
        }
        let size: DVec3 = cuboid.max - cuboid.min;
        let Some(axis) = (0..3).find(|axis| size[*axis] < SMALLEST) else {
            return;
        };
        let origin = self.blame(&[group.origin("min"), group.origin("max")]);
        self.faults.add(origin, || {
            let (min, max) = (cuboid.min[axis], cuboid.max[axis]);
            let message = format!(
                "`boxes.{}` must have min < max; along {} min is {min} and max is {max}",
                group.name,
                ["x", "y", "z"][axis]
            );
            (message, Some("a flat box needs a little thickness".into()))
        });
    }

    /// The number of the group's material.
    fn material(
        &mut self,
        group: &Group,
        section: &'static str,
        names: &HashMap<&str, usize>,
    ) -> usize {
        let draft = self.draft;
        let value = self.of(group, section, "material");
        let name = value.text();
        if let Some(number) = names.get(name) {
            return *number;
        }
        let written = group
            .entry("material")
            .is_some_and(|entry| entry.value.is_some());
        if written && self.whole {
            self.faults.add(group.origin("material"), || {
                let known = || draft.materials.iter().map(|group| group.name.as_str());
                let note = match nearest(name, known()) {
                    Some(near) => format!("did you mean `{near}`?"),
                    None if names.is_empty() => {
                        format!("write a table [materials.{}]", short(name))
                    }
                    None => format!("the materials are {}", listed(known().collect())),
                };
                (format!("unknown material `{}`", short(name)), Some(note))
            });
        }
        0
    }
}

/// The first of some names, in order.
fn listed(mut names: Vec<&str>) -> String {
    const MOST: usize = 12;
    let more = names.len().saturating_sub(MOST);
    if more > 0 {
        // Only these have to be in order: a thousand mistakes would sort all materials a thousand times.
        names.select_nth_unstable(MOST);
        names.truncate(MOST);
    }
    names.sort_unstable();
    let shown: Vec<_> = names.iter().take(MOST).map(|name| short(name)).collect();
    let tail = if more > 0 {
        format!(" and {more} more")
    } else {
        String::new()
    };
    shown.join(", ") + &tail
}
