//! What one lamp of many is chosen by, as `shaders/choice.wgsl` reads it.

use super::{Cuboid, Lamp, alias, light_tree};
use crate::knobs::{Light, LightChoice, LightStrategy};
use std::f64::consts::PI;

/// Four words of the device: a slot of the alias table, or a third of a pair of the light tree.
pub type ChoiceEntry = [u32; 4];

/// What a lamp is chosen by.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Choices {
    /// Nothing where every lamp has its own shadow ray, or none has.
    pub entries: Vec<ChoiceEntry>,
    /// Iterations of the loops over lamps that one step of a path may take, each loop's last look at its
    /// condition among them.
    pub loops: u32,
}

impl Choices {
    pub(super) fn new(light: &Light, lamps: &[Lamp], boxes: &[Cuboid]) -> Self {
        let power = |lamp: &Lamp| power(lamp, boxes);
        let unread = light.strategy == LightStrategy::Hit || lamps.is_empty();
        let table = |entries| Self { entries, loops: 1 };
        match light.choice {
            LightChoice::All => Self {
                entries: Vec::new(),
                loops: lamps.len() as u32,
            },
            _ if unread => Self::default(),
            LightChoice::Uniform => table(alias::table(&vec![1.0; lamps.len()])),
            LightChoice::Power => table(alias::table(&lamps.iter().map(power).collect::<Vec<_>>())),
            LightChoice::Tree => {
                let groups: Vec<_> = lamps.iter().map(|lamp| group(lamp, power(lamp))).collect();
                let (entries, depth) = light_tree::build(&groups);
                // One walk for the lamp of the shadow ray, one for a lamp that the ray itself found.
                let loops = 2 * (depth + 1);
                Self { entries, loops }
            }
        }
    }
}

/// What a lamp sends out, pi times area times radiance, in its brightest channel: so that no channel
/// of one that has colour is left to chance.
fn power(lamp: &Lamp, boxes: &[Cuboid]) -> f64 {
    let brightest = lamp.emission.into_iter().fold(0.0, f32::max);
    PI * area(lamp, boxes) * f64::from(brightest)
}

fn area(lamp: &Lamp, boxes: &[Cuboid]) -> f64 {
    match lamp.shape {
        0 => 4.0 * PI * f64::from(lamp.radius).powi(2),
        number => {
            let [x, y, z] = boxes[number as usize - 1].half_size.map(f64::from);
            8.0 * (x * y + y * z + z * x)
        }
    }
}

/// The sphere around a lamp.
fn group(lamp: &Lamp, power: f64) -> light_tree::Group {
    light_tree::Group {
        center: lamp.center.map(f64::from).into(),
        radius: f64::from(lamp.radius),
        power,
    }
}
