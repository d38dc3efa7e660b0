//! The changes that `benches/ablation` makes to the tracing kernel: each fits the text as it is and leaves
//! a kernel, and one that no longer fits is refused.

#[path = "../benches/ablation/edit.rs"]
mod edit;
#[path = "../benches/ablation/techniques.rs"]
#[allow(dead_code, reason = "the bench uses all of it")]
mod techniques;

use edit::{Edit, edited};
use lampray::pack::{Packed, Traversal};
use lampray::scene::Scene;
use lampray::shader::{self, Baked, Joined, Kernel, SceneArrays};
use std::collections::BTreeSet;
use techniques::{SAMPLES, TECHNIQUES};

/// The baked kernel of the room, and the text of the general one.
fn texts() -> (Joined, String) {
    let scene = Scene::load("scenes/cornell.toml".as_ref(), &[]).unwrap();
    let scene = Packed::by(&scene, Traversal::Baked);
    let arrays = SceneArrays::new(&scene);
    let baked = shader::baked_source(&Baked::new(&scene, arrays).unwrap());
    let general = shader::source(Kernel::Trace, arrays).unwrap();
    (baked.unwrap(), general.text)
}

#[test]
fn every_technique_can_be_taken_away() {
    let (shipping, general) = texts();
    for technique in TECHNIQUES {
        let name = technique.name;
        assert!(
            !technique.edits.is_empty() || technique.samples != SAMPLES,
            "{name}: nothing changes"
        );
        let text = edited(&shipping.text, &general, technique.edits);
        let mut joined = shipping.clone();
        joined.text = text.unwrap_or_else(|fault| panic!("{name}: {fault}"));
        let module = shader::parse(&joined);
        let checked = module.and_then(|module| shader::validate(&joined, &module));
        assert!(checked.is_ok(), "{name}: {}", checked.unwrap_err());
    }
    let names: BTreeSet<_> = TECHNIQUES.iter().map(|technique| technique.name).collect();
    assert_eq!(names.len(), TECHNIQUES.len());
}

#[test]
fn a_change_that_does_not_fit_is_refused() {
    let text = "\nfn a() {\n    x;\n    x;\n    y;\n}\n\nfn b() {\n}\n";
    let refusal = |edit: Edit| edited(text, text, &[edit]).unwrap_err();
    assert!(refusal(Edit::Text("z;", "y;")).contains("0 times"));
    assert!(refusal(Edit::Text("x;", "y;")).contains("2 times"));
    assert!(refusal(Edit::Text("y;", "y;")).contains("changes nothing"));
    assert!(refusal(Edit::Every("y;", "x;")).contains("several times"));
    assert!(refusal(Edit::Function("c", "")).contains("no function c"));
    assert!(refusal(Edit::General("a")).contains("changes nothing"));
    let fits = edited(
        text,
        "\nfn a() {\n}\n",
        &[Edit::General("a"), Edit::Function("b", "")],
    );
    assert_eq!(fits.unwrap(), "\nfn a() {\n}\n\n");
}
