//! Whether two kernels read and write the same buffers, byte for byte.

use naga::{AddressSpace, Handle, Module, Type, TypeInner};
use std::collections::BTreeMap;

/// Compares what two kernels bind, and whether every override constant of the first is one of the second.
///
/// # Errors
/// What differs, in words.
pub fn same_interface(one: &Module, other: &Module) -> Result<(), String> {
    let (ours, theirs) = (bound(one), bound(other));
    if ours.keys().ne(theirs.keys()) {
        return Err("it binds other buffers".into());
    }
    for (place, text) in &ours {
        if theirs[place] != *text {
            let (group, binding) = place;
            return Err(format!(
                "the buffer at group {group}, binding {binding} is laid out otherwise"
            ));
        }
    }
    let names = |module: &Module| -> Vec<String> {
        let all = module.overrides.iter();
        all.filter_map(|(_, constant)| constant.name.clone())
            .collect()
    };
    let known = names(other);
    match names(one).iter().find(|name| !known.contains(name)) {
        Some(name) => Err(format!("it asks for {name}, which nothing sets now")),
        None => Ok(()),
    }
}

/// What stands in each binding, spelled out.
fn bound(module: &Module) -> BTreeMap<(u32, u32), String> {
    let variables = module.global_variables.iter();
    variables
        .filter_map(|(_, variable)| {
            let place = variable.binding.as_ref()?;
            let space = match variable.space {
                AddressSpace::Uniform => "uniform",
                _ => "storage",
            };
            let text = format!("{space} {}", spelled(module, variable.ty));
            Some(((place.group, place.binding), text))
        })
        .collect()
}

/// A type with the places of its parts; names do not count.
fn spelled(module: &Module, ty: Handle<Type>) -> String {
    match &module.types[ty].inner {
        TypeInner::Struct { members, span } => {
            let members = members.iter();
            let parts: Vec<_> = members
                .map(|member| format!("{} {}", member.offset, spelled(module, member.ty)))
                .collect();
            format!("{{{}; {span}}}", parts.join(", "))
        }
        TypeInner::Array { base, size, stride } => {
            format!("[{}; {size:?}, {stride}]", spelled(module, *base))
        }
        inner => format!("{inner:?}"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn module(text: &str) -> Module {
        naga::front::wgsl::parse_str(text).unwrap()
    }

    const PLAIN: &str = "struct S { a: vec3<f32>, b: u32 }
        override X: u32;
        @group(0) @binding(0) var<storage> s: array<S>;
        @compute @workgroup_size(1) fn main() { _ = s[X].a; }";

    #[test]
    fn names_do_not_count_and_places_do() {
        let plain = module(PLAIN);
        let renamed = module(&PLAIN.replace("a: vec3", "c: vec3").replace("].a", "].c"));
        assert_eq!(same_interface(&renamed, &plain), Ok(()));
        for (from, to, fault) in [
            ("b: u32", "b: f32", "laid out otherwise"),
            ("b: u32", "_p: u32, b: u32", "laid out otherwise"),
            ("@binding(0)", "@binding(1)", "other buffers"),
            ("var<storage>", "var<storage, read_write>", ""),
            ("X", "Y", "asks for Y"),
        ] {
            let found = same_interface(&module(&PLAIN.replace(from, to)), &plain);
            match fault {
                "" => assert_eq!(found, Ok(())),
                fault => assert!(found.unwrap_err().contains(fault), "{to}"),
            }
        }
    }
}
