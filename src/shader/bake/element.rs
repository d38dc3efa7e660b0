//! The elements of the scene's arrays as WGSL expressions.

use crate::pack::{Cuboid, Lamp, Material, Sphere, Vec3};

/// A struct that the shaders have too.
pub trait Element {
    /// Its name in WGSL.
    const NAME: &'static str;

    /// Its members as expressions, in the order of the WGSL struct.
    fn members(&self) -> Vec<String>;
}

/// The shortest decimal that is read back as the very same number; -0 is one of them.
pub fn number(value: f32) -> String {
    format!("{value:?}f")
}

pub fn vector(v: Vec3) -> String {
    format!("vec3<f32>({})", v.map(number).join(", "))
}

fn whole(value: u32) -> String {
    format!("{value}u")
}

impl Element for Sphere {
    const NAME: &'static str = "Sphere";

    fn members(&self) -> Vec<String> {
        let whole = [self.material, self.lamp, self.body, self._pad0].map(whole);
        [vector(self.center), number(self.radius)]
            .into_iter()
            .chain(whole)
            .collect()
    }
}

impl Element for Cuboid {
    const NAME: &'static str = "Box";

    fn members(&self) -> Vec<String> {
        vec![
            vector(self.center),
            whole(self.material),
            vector(self.half_size),
            whole(self.id),
            vector(self.axis_x),
            whole(self.body),
            vector(self.axis_y),
            whole(self.lamp),
            vector(self.axis_z),
            whole(self._pad1),
        ]
    }
}

impl Element for Material {
    const NAME: &'static str = "Material";

    fn members(&self) -> Vec<String> {
        vec![
            vector(self.albedo),
            whole(self.scatter),
            vector(self.emission),
            number(self.survival),
            number(self.spread),
            number(self.lobe_mass),
            number(self.lobe_scale),
            number(self.shape),
        ]
    }
}

impl Element for Lamp {
    const NAME: &'static str = "Lamp";

    fn members(&self) -> Vec<String> {
        vec![
            vector(self.center),
            number(self.radius),
            vector(self.emission),
            whole(self.body),
            number(self.weight_radius),
            whole(self.shape),
            whole(self._pad0),
            whole(self._pad1),
        ]
    }
}

/// One element as a constructor.
pub fn constructed<T: Element>(item: &T) -> String {
    format!("{}({})", T::NAME, item.members().join(", "))
}

/// A function that picks one of `items`, of which there must be some: each member by selects on the
/// bits of the index. Of an index past the last it makes another element.
pub fn accessor<T: Element>(name: &str, items: &[T]) -> String {
    let rows: Vec<_> = items.iter().map(T::members).collect();
    let column = |member: usize| rows.iter().map(|row| row[member].as_str()).collect();
    let trees = (0..rows[0].len()).map(|member| {
        let column: Vec<_> = column(member);
        format!("        {},\n", picked(&column))
    });
    format!(
        "fn {name}(index: u32) -> {element} {{\n    return {element}(\n{trees}    );\n}}\n",
        element = T::NAME,
        trees = trees.collect::<String>()
    )
}

/// The expression among `choices` that has the number `index`. What is the same for all is no choice.
fn picked(choices: &[&str]) -> String {
    if choices.iter().all(|choice| *choice == choices[0]) {
        return choices[0].into();
    }
    // The highest bit of the largest index: it is set in the upper part alone.
    let bit = choices.len().next_power_of_two() / 2;
    let (low, high) = choices.split_at(bit);
    // A shorter upper part is no matter: its own bits are those of the index.
    format!(
        "select({}, {}, (index & {bit}u) != 0u)",
        picked(low),
        picked(high)
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    /// What the expression is for an index.
    fn evaluated(text: &str, index: usize) -> String {
        let Some(inner) = text
            .strip_prefix("select(")
            .and_then(|t| t.strip_suffix(" != 0u)"))
        else {
            return text.into();
        };
        let (choices, bit) = inner.rsplit_once(", (index & ").unwrap();
        let bit: usize = bit.strip_suffix("u)").unwrap().parse().unwrap();
        let mut depth = 0;
        let comma = choices.bytes().position(|byte| {
            depth += i32::from(byte == b'(') - i32::from(byte == b')');
            byte == b',' && depth == 0
        });
        let (low, high) = choices.split_at(comma.unwrap());
        let chosen = if index & bit == 0 { low } else { &high[2..] };
        evaluated(chosen, index)
    }

    #[test]
    fn every_index_picks_its_own() {
        for count in 1..=70 {
            let names: Vec<_> = (0..count).map(|index| format!("x{}", index / 3)).collect();
            let text = picked(&names.iter().map(String::as_str).collect::<Vec<_>>());
            for (index, name) in names.iter().enumerate() {
                assert_eq!(evaluated(&text, index), *name, "{index} of {count}: {text}");
            }
        }
    }

    #[test]
    fn numbers_are_read_back_as_they_were() {
        for value in [
            0.0,
            -0.0,
            1e-6,
            1e5,
            0.1,
            f32::MAX,
            f32::MIN_POSITIVE,
            1e-45,
            -1e-40,
            16777217.0,
        ] {
            let text = format!("const x: f32 = {};", number(value));
            let module = naga::front::wgsl::parse_str(&text).unwrap();
            let (_, constant) = module.constants.iter().next().unwrap();
            let read = &module.global_expressions[constant.init];
            let naga::Expression::Literal(naga::Literal::F32(read)) = read else {
                panic!("{text}: {read:?}");
            };
            assert_eq!(read.to_bits(), value.to_bits(), "{text}");
        }
    }
}
