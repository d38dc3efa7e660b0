//! The table of knobs, presets, `--set`, and the record of every knob.

use lampray::Error;
use lampray::knobs::{Choice, Kind, LightSource, LightStrategy, Pole, Preset, Settings, Value};
use lampray::knobs::{KNOBS, knob_json, markdown, page, schema, table};
use lampray::scene::{Assignment, Scene};

const SCENE: &str = r#"version = 1
[camera]
position = [0.1, 1.0, 3.4]
look_at = [0.0, 1.0, 0.0]
[render]
samples = 16
[materials.white]
[materials."two words"]
emission = [0.1, 0.30000000000000004, 1e-7]
[[spheres]]
center = [0.0, 1.7, 0.0]
radius = 0.15
material = "two words"
[[boxes]]
min = [-1.0, -0.1, -1.0]
max = [1.0, 0.0, 1.0]
material = "white"
"#;

fn with(text: &str, sets: &[&str]) -> lampray::Result<Scene> {
    let assignments: lampray::Result<Vec<_>> =
        sets.iter().map(|set| Assignment::parse(set)).collect();
    Scene::parse("scene.toml", text, &assignments?)
}

fn set(sets: &[&str]) -> Scene {
    with(SCENE, sets).unwrap()
}

/// The message of a command line that must be refused.
fn refused(sets: &[&str]) -> String {
    match with(SCENE, sets) {
        Err(Error::Knob(message)) => message,
        Err(other) => panic!("another error than expected: {other}"),
        Ok(_) => panic!("{sets:?} was accepted"),
    }
}

/// The presets as they are promised: montelight, paper, corrected, reference.
#[rustfmt::skip]
const PRESETS: &[(&str, [&str; 4])] = &[
    ("light.sampler", ["uniform-angles", "uniform-angles", "inverse-cosine", "cone"]),
    ("light.weight", ["solid-angle", "solid-angle", "pdf", "pdf"]),
    ("light.weight_radius", ["1.5", "null", "null", "null"]),
    ("light.strategy", ["sample", "sample", "mis", "mis"]),
    ("light.choice", ["all", "all", "all", "all"]),
    ("light.direct", ["lambert", "lambert", "bsdf", "bsdf"]),
    ("scatter.diffuse", ["cosine", "cosine", "cosine", "cosine"]),
    ("scatter.bound", ["clamp", "clamp", "truncate", "truncate"]),
    ("interruption.rule", ["albedo", "survival", "survival", "throughput"]),
    ("interruption.weight", ["literal", "literal", "compensated", "compensated"]),
    ("interruption.start", ["5", "0", "0", "4"]),
    ("interruption.order", ["before-direct", "after-direct", "after-direct", "after-direct"]),
    ("render.clamp", ["1.0", "null", "null", "null"]),
    ("image.filter", ["tent", "tent", "box", "box"]),
    ("image.encoding", ["gamma22", "gamma22", "srgb", "srgb"]),
];

#[test]
fn presets_are_what_is_promised() {
    let names = ["montelight", "paper", "corrected", "reference"];
    for (column, name) in names.into_iter().enumerate() {
        let scene = set(&[&format!("render.preset={name}")]);
        for (path, values) in PRESETS {
            let value = &scene.knobs[*path];
            let shown = value.as_str().map_or(value.to_string(), String::from);
            assert_eq!(shown, values[column], "{path} under {name}");
        }
        assert_eq!(scene.settings.biased(), column < 2, "{name}");
        let settings = Settings::of(Preset::from_name(name).unwrap());
        assert_eq!(settings.light, scene.settings.light);
        assert_eq!(settings.interruption, scene.settings.interruption);
    }
    let in_presets = KNOBS.iter().filter(|knob| knob.in_presets()).count();
    assert_eq!(in_presets, PRESETS.len());
    let reference = Settings::of(Preset::Reference);
    assert_eq!(set(&[]).settings.light, reference.light);
}

#[test]
fn every_default_is_a_value_its_knob_takes() {
    for knob in KNOBS {
        for preset in Preset::ALL {
            match (knob.value(*preset), knob.kind) {
                (Some(Value::Text(name)), Kind::Choice(names)) => {
                    assert!(names.contains(&name.as_ref()), "{}", knob.path);
                }
                (Some(Value::Integer(value)), Kind::Integer { least, most }) => {
                    assert!((least..=most).contains(value), "{}", knob.path);
                }
                (Some(value), Kind::Number(range) | Kind::OptionalNumber(range)) => {
                    let fits = value.optional().is_none_or(|x| range.check(x).is_ok());
                    assert!(fits, "{}", knob.path);
                }
                (Some(Value::Triple(parts)), Kind::Triple(range)) => {
                    assert!(parts.iter().all(|part| range.check(*part).is_ok()));
                }
                (Some(Value::Triple(_)), Kind::Pole) | (None, _) => {}
                (Some(value), kind) => panic!("{}: {value} is no {kind:?}", knob.path),
            }
        }
    }
}

#[test]
fn command_line_beats_scene_beats_preset_beats_default() {
    let preset = "[render]\npreset = \"montelight\"";
    let text = SCENE.replace("[render]", preset) + "[light]\nsampler = \"gaussian\"\n";
    let scene = with(&text, &[]).unwrap();
    assert_eq!(scene.settings.render.clamp, Some(1.0));
    assert_eq!(scene.settings.light.sampler.name(), "gaussian");
    assert_eq!(scene.settings.render.samples, 16);
    assert_eq!(scene.settings.render.max_bounces, 8);
    let sets = [
        "light.sampler=cone",
        "light.sampler=inverse-cosine",
        "render.clamp=off",
    ];
    let scene = with(&text, &sets).unwrap();
    assert_eq!(scene.settings.light.sampler.name(), "inverse-cosine");
    assert_eq!(scene.settings.render.clamp, None);
    let scene = with(&text, &["render.preset=paper"]).unwrap();
    assert_eq!(scene.settings.light.sampler.name(), "gaussian");
    assert_eq!(scene.settings.interruption.start, 0);
}

#[test]
fn set_reaches_every_kind_of_knob() {
    let scene = set(&[
        "spheres.0.radius=2",
        "boxes.0.rotation=[0, 45, 0]",
        "materials.two words.albedo=[0.1, 0.2, 0.3]",
        "spheres.0.material=white",
        "boxes.0.material=\"two words\"",
        "render.seed=18446744073709551615",
        "light.pole=receiver",
        "light.weight_radius=absent",
        "camera.up=[1, 1, 0]",
    ]);
    assert_eq!(scene.spheres[0].radius, 2.0);
    assert_eq!(scene.boxes[0].rotation.y, 45.0);
    assert_eq!(scene.materials[1].albedo.z, 0.3);
    assert_eq!((scene.spheres[0].material, scene.boxes[0].material), (0, 1));
    assert_eq!(scene.knobs["render.seed"], u64::MAX);
    assert_eq!(scene.settings.light.pole, Pole::Receiver);
    let shapes: Vec<_> = scene.knobs.keys().filter(|p| p.contains(".0.")).collect();
    let expected = [
        "spheres.0.radius",
        "boxes.0.rotation",
        "spheres.0.material",
        "boxes.0.material",
    ];
    assert_eq!(shapes, expected);
    // Each alone would put min above max: what counts is what both give together.
    let moved = set(&["boxes.0.min=[-1, 4, -1]", "boxes.0.max=[1, 5, 1]"]);
    assert_eq!(moved.boxes[0].min.y, 4.0);
}

#[test]
fn bad_assignments_are_refused_with_the_remedy() {
    #[rustfmt::skip]
    let cases = [
        ("light.sampler=coen", "did you mean `cone`?"),
        ("lihgt.sampler=cone", "did you mean `light.sampler`?"),
        ("render.sampler=cone", "did you mean"),
        ("materials.white.albdo=1", "did you mean `materials.white.albedo`?"),
        ("materials.whte.albedo=[1, 1, 1]", "did you mean `white`?"),
        ("spheres.1.radius=1", "number 0"),
        ("spheres.x.radius=1", "number 0"),
        ("spheres.0.radius=-1", "must be > 0, not -1"),
        ("spheres.0.material=whit", "did you mean `white`?"),
        ("boxes.0.min=[2, 0, 0]", "min < max"),
        ("camera.look_at=[0.1, 1.0, 3.4]", "must differ"),
        ("camera.up=[0.1, 0, 3.4]", "parallel"),
        ("image.width=40000", "1 to 32768"),
        ("render.samples=1.5", "whole number"),
        ("render.samples=many", "must be a whole number"),
        ("render.samples=", "has no value"),
        ("render.samples", "PATH=VALUE"),
        ("camera.fov=nan", "finite"),
        ("version=1", "there is no knob `version`"),
        ("", "PATH=VALUE"),
    ];
    for (text, words) in cases {
        let message = refused(&[text]);
        assert!(message.contains(words), "{text}: no {words:?} in {message}");
        assert!(message.contains(&format!("--set {text}")), "{message}");
    }
    let message = refused(&["image.width=0", "render.samples=0"]);
    assert_eq!(message.lines().count(), 2, "{message}");
}

#[test]
fn lambert_and_solid_angle_imply_sampling() {
    for cause in ["light.direct=lambert", "light.weight=solid-angle"] {
        let scene = set(&[cause]);
        assert_eq!(scene.settings.light.strategy, LightStrategy::Sample);
        assert_eq!(scene.knobs["light.strategy"], "sample");
        assert!(scene.settings.biased());
        set(&[cause, "light.strategy=sample"]);
        let message = refused(&[cause, "light.strategy=mis"]);
        let words = "`light.strategy` cannot be `mis`";
        assert!(message.contains(words), "{message}");
    }
    assert!(refused(&["render.preset=paper", "light.strategy=hit"]).contains("sample"));
    let asked = format!("{SCENE}[light]\nstrategy = \"hit\"\n");
    let Err(Error::Knob(_)) = with(&asked, &["render.preset=paper"]) else {
        panic!("the command line is at fault");
    };
    let Err(Error::Scene(page)) = with(&format!("{asked}direct = \"lambert\"\n"), &[]) else {
        panic!("the scene is at fault");
    };
    assert!(page.contains("scene.toml:19:12\n"), "{page}");
    assert!(page.contains("bsdf"), "{page}");
}

#[test]
fn lambert_leaves_boxes_and_background_alone() {
    let scene = set(&["light.direct=lambert"]);
    assert_eq!(scene.settings.light.boxes, LightSource::Hit);
    assert_eq!(scene.knobs["light.boxes"], "hit");
    assert_eq!(
        set(&["light.boxes=sample"]).settings.light.boxes,
        LightSource::Sample
    );
    for path in ["light.boxes", "light.background"] {
        set(&["light.direct=lambert", &format!("{path}=hit")]);
        let message = refused(&["light.direct=lambert", &format!("{path}=sample")]);
        assert!(
            message.contains(&format!("`{path}` cannot be `sample`")),
            "{message}"
        );
        assert!(message.contains("bsdf"), "{message}");
    }
}

#[test]
fn a_record_of_every_knob_gives_the_same_scene_again() {
    #[rustfmt::skip]
    let lists: [&[&str]; 4] = [
        &[],
        &["render.preset=montelight", "spheres.0.radius=0.1", "camera.fov=33.333333333333336"],
        &["light.direct=lambert", "light.pole=receiver", "boxes.0.material=two words"],
        &["render.clamp=0.1", "render.seed=18446744073709551615", "camera.position=[7e10, 1e-9, -0.0]"],
    ];
    for sets in lists {
        let first = set(sets);
        let text = serde_json::to_string(&first.knobs).unwrap();
        let record: serde_json::Map<_, _> = serde_json::from_str(&text).unwrap();
        let replayed = record
            .iter()
            .map(|(path, value)| Assignment::from_record(path, value));
        let assignments: Vec<_> = replayed.collect();
        let second = Scene::parse("scene.toml", SCENE, &assignments).unwrap();
        assert_eq!(first.camera, second.camera);
        assert_eq!(first.background, second.background);
        assert_eq!(first.materials, second.materials);
        assert_eq!(first.spheres, second.spheres);
        assert_eq!(first.boxes, second.boxes);
        assert_eq!(first.settings, second.settings);
        assert_eq!(first.knobs, second.knobs);
    }
}

#[test]
fn records_hold_every_knob_but_those_of_shapes() {
    let scene = set(&[]);
    for knob in KNOBS.iter().filter(|knob| !knob.repeats()) {
        assert!(scene.knobs.contains_key(knob.path), "{}", knob.path);
    }
    for knob in KNOBS.iter().filter(|knob| knob.section() == "materials") {
        let path = knob.path.replace('*', "two words");
        assert!(scene.knobs.contains_key(&path), "{path}");
    }
    assert_eq!(scene.knobs["render.clamp"], serde_json::Value::Null);
    let shapes = |path: &String| path.starts_with("spheres") || path.starts_with("boxes");
    assert!(!scene.knobs.keys().any(shapes));
}

#[test]
fn schema_names_every_knob_and_allows_nothing_else() {
    let schema: serde_json::Value = serde_json::from_str(&schema().to_string()).unwrap();
    let draft = "https://json-schema.org/draft/2020-12/schema";
    assert_eq!(schema["$schema"], draft);
    assert_eq!(schema["additionalProperties"], false);
    for knob in KNOBS {
        let section = &schema["properties"][knob.section()];
        let object = match knob.section() {
            "materials" => &section["additionalProperties"],
            "spheres" | "boxes" => &section["items"],
            _ => section,
        };
        assert_eq!(object["additionalProperties"], false, "{}", knob.path);
        let property = &object["properties"][knob.key()];
        assert!(property["description"].is_string(), "{}", knob.path);
        let required = object["required"].as_array();
        let required = required.is_some_and(|list| list.iter().any(|key| key == knob.key()));
        assert_eq!(required, knob.default().is_none(), "{}", knob.path);
    }
}

#[test]
fn pages_name_every_knob_within_their_width() {
    let knobs: Vec<_> = KNOBS.iter().collect();
    let text = table(&knobs, 100);
    let fits = |line: &str| line.chars().count() <= 100;
    assert!(text.lines().all(fits), "{text}");
    let markdown = markdown();
    for knob in KNOBS {
        assert!(text.contains(knob.path) && markdown.contains(knob.path));
        assert!(page(knob).contains(knob.meaning));
        assert_eq!(knob_json(knob)["path"], knob.path);
    }
}
