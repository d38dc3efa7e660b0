//! The printed text: valid, of straight lines, with the functions of the traversal it stands in for; and
//! refused in words where a scene is too large.

use crate::crowds::{KINDS, crowd_by};
use lampray::pack::Packed;
use lampray::scene::{Assignment, MOST_BAKED, Scene};
use lampray::shader::{self, Baked, Kernel, SceneArrays};
use std::collections::BTreeSet;
use std::process::Command;

fn crowd(kind: &str, count: usize) -> Packed {
    let [_, baked] = crowd_by(["general", "baked"], kind, count, 51);
    Packed::new(&baked)
}

fn printed(packed: &Packed) -> Baked {
    Baked::new(packed, SceneArrays::new(packed)).unwrap()
}

#[test]
fn what_is_printed_is_valid() {
    for kind in KINDS {
        for count in [2, 16, 100] {
            let joined = shader::baked_source(&printed(&crowd(kind, count))).unwrap();
            let module = shader::parse(&joined);
            let checked = module.and_then(|module| shader::validate(&joined, &module));
            assert!(checked.is_ok(), "{kind}, {count}: {}", checked.unwrap_err());
        }
    }
}

#[test]
fn it_is_straight_down_and_has_no_gathers() {
    let text = printed(&crowd("soup", 40)).text;
    for word in ["for ", "while ", "loop ", "if ", "[index]"] {
        assert!(!text.contains(word), "{word}");
    }
    // One call a body for each of both functions.
    assert_eq!(text.matches("nearer(").count(), 41);
    assert_eq!(text.matches("blocks(").count(), 41);
    assert_eq!(text.matches("target_body !=").count(), 41);
}

/// The functions that a kernel may call have the same names and types by every traversal.
#[test]
fn it_has_the_functions_of_the_loops() {
    let packed = crowd("soup", 12);
    let called = [
        "nearest_hit",
        "occluded",
        "allow",
        "cut_short",
        "material_at",
        "sphere_at",
        "box_at",
        "lamp_at",
    ];
    let of = |joined: &shader::Joined| -> BTreeSet<String> {
        let lines = joined
            .text
            .lines()
            .filter_map(|line| line.strip_prefix("fn "));
        let wanted = |line: &&str| {
            called
                .iter()
                .any(|name| line.starts_with(&format!("{name}(")))
        };
        lines.filter(wanted).map(String::from).collect()
    };
    let general = shader::source(Kernel::Trace, SceneArrays::new(&packed)).unwrap();
    let baked = shader::baked_source(&printed(&packed)).unwrap();
    assert_eq!(of(&general).len(), called.len());
    assert_eq!(of(&general).len(), of(&baked).len());
    for line in of(&general) {
        let same = |other: &String| other.trim_end_matches(" {}") == line.trim_end_matches(" {}");
        assert!(of(&baked).iter().any(same), "{line}");
    }
}

#[test]
fn scenes_that_differ_in_one_number_are_other_texts() {
    let mut scene = crowd("soup", 12);
    let first = printed(&scene);
    assert_eq!(first, printed(&scene));
    scene.spheres[3].radius = scene.spheres[3].radius.next_up();
    assert_ne!(first.hash, printed(&scene).hash);
}

fn text(bodies: usize, render: &str) -> String {
    let head = format!(
        "version = 1\ncamera = {{ position = [0, 0, 0], look_at = [0, 0, -1], fov = 60 }}\n{render}[materials]\ngrey = {{ albedo = [0.5, 0.5, 0.5] }}\n"
    );
    let body = |z: usize| {
        format!("[[spheres]]\ncenter = [0, 0, -{z}]\nradius = 0.2\nmaterial = \"grey\"\n")
    };
    head + &(1..=bodies).map(body).collect::<String>()
}

#[test]
fn too_many_bodies_are_refused_where_it_is_forced() {
    let forced = [Assignment::parse("render.kernel=baked").unwrap()];
    let parse = |bodies: usize| Scene::parse("crowd.toml", &text(bodies, ""), &forced);
    let largest = Packed::new(&parse(MOST_BAKED).unwrap());
    assert!(Baked::new(&largest, SceneArrays::new(&largest)).is_ok());
    let refusal = parse(MOST_BAKED + 1).unwrap_err().to_string();
    assert!(
        refusal.contains("256 bodies, and the scene has 257"),
        "{refusal}"
    );
    // A scene that was made past its text is refused by the printer.
    let mut larger = largest;
    larger.spheres.push(larger.spheres[0]);
    let refusal = Baked::new(&larger, SceneArrays::new(&larger)).unwrap_err();
    assert!(
        refusal.to_string().contains("the scene has 257"),
        "{refusal}"
    );
}

#[test]
fn the_program_says_so_too() {
    let folder = tempfile::tempdir().unwrap();
    let code = |name: &str, text: &str, arguments: &[&str]| {
        let path = folder.path().join(name);
        std::fs::write(&path, text).unwrap();
        let mut command = Command::new(env!("CARGO_BIN_EXE_lampray"));
        let output = command
            .arg("check")
            .arg(path)
            .args(arguments)
            .output()
            .unwrap();
        let said = String::from_utf8_lossy(&output.stderr).into_owned()
            + &String::from_utf8_lossy(&output.stdout);
        assert!(said.contains("takes up to 256 bodies"), "{said}");
        output.status.code()
    };
    let written = text(257, "render = { kernel = \"baked\" }\n");
    assert_eq!(code("written.toml", &written, &[]), Some(65));
    let set = ["--set", "render.kernel=baked"];
    assert_eq!(code("set.toml", &text(257, ""), &set), Some(2));
}
