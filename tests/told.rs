//! What the program says of settings that do nothing, of light that is lost, and of command lines that it refuses.

use lampray::Error;
use lampray::pack::Packed;
use lampray::scene::{Assignment, Scene};
use serde_json::Value;
use std::path::Path;
use std::process::{Command, Output};

const SCENE: &str = r#"version = 1
camera = { position = [0, 1, 3.4], look_at = [0, 1, 0] }
image = { width = 8, height = 8 }
render = { samples = 4, max_bounces = 4 }
[materials.white]
albedo = [0.7, 0.7, 0.7]
[materials.lamp]
emission = [20, 20, 20]
[[spheres]]
center = [0, 1.7, 0]
radius = 0.15
material = "lamp"
[[boxes]]
min = [-1, -0.1, -1]
max = [1, 0, 1]
material = "white"
"#;

fn parsed(sets: &[&str]) -> lampray::Result<Scene> {
    let assignments = sets.iter().map(|set| Assignment::parse(set));
    Scene::parse(
        "s.toml",
        SCENE,
        &assignments.collect::<lampray::Result<Vec<_>>>()?,
    )
}

fn lampray(
    folder: &Path,
    environment: &[(&str, &str)],
    arguments: &[&str],
) -> (i32, String, String) {
    std::fs::write(folder.join("s.toml"), SCENE).unwrap();
    let mut command = Command::new(env!("CARGO_BIN_EXE_lampray"));
    command.current_dir(folder).args(arguments);
    command.env_remove("LAMPRAY_TEST_LOSE_DEVICE");
    let Output {
        status,
        stdout,
        stderr,
    } = command.envs(environment.iter().copied()).output().unwrap();
    let [stdout, stderr] = [stdout, stderr].map(|text| String::from_utf8_lossy(&text).into_owned());
    (status.code().unwrap(), stdout, stderr)
}

/// Settings, and the words of the only note that they are worth; none for those that do something.
#[test]
fn settings_that_change_nothing_are_noted() {
    let cases: [(&[&str], &str); 23] = [
        (&[], ""),
        (
            &["light.pole=receiver"],
            "light.pole changes nothing here: light.sampler = cone",
        ),
        (
            &["light.pole=receiver", "light.sampler=gaussian"],
            "light.sampler = gaussian has no poles",
        ),
        (&["light.pole=receiver", "light.sampler=uniform-angles"], ""),
        (
            &["light.pole=receiver", "light.strategy=hit"],
            "light.pole changes nothing here: light.strategy = hit",
        ),
        (
            &["light.choice=tree"],
            "light.choice changes nothing here: there are no two lamps",
        ),
        (
            &[
                "light.choice=tree",
                "light.boxes=sample",
                "materials.white.emission=[1,1,1]",
            ],
            "",
        ),
        (
            &["light.boxes=sample"],
            "light.boxes changes nothing here: no box shines",
        ),
        (
            &["light.boxes=sample", "materials.white.emission=[1,1,1]"],
            "",
        ),
        (
            &[
                "light.boxes=sample",
                "materials.white.emission=[1,1,1]",
                "light.strategy=hit",
            ],
            "hit sends no shadow rays",
        ),
        (
            &["light.background=sample"],
            "light.background changes nothing here: the background is black",
        ),
        (
            &["light.background=sample", "background.emission=[1,1,1]"],
            "",
        ),
        (
            &["light.test=object", "light.strategy=hit"],
            "light.test changes nothing here",
        ),
        (&["light.test=object"], ""),
        (
            &["render.randomisations=16"],
            "render.randomisations changes nothing here",
        ),
        (&["scatter.diffuse=uniform"], ""),
        (
            &["interruption.split=2"],
            "interruption.split changes nothing here",
        ),
        (
            &["interruption.rule=none", "interruption.start=1"],
            "interruption.start changes nothing here",
        ),
        (
            &["interruption.rule=efficiency"],
            "set interruption.start=0",
        ),
        (&["interruption.start=8"], "no path comes to that hit"),
        (
            &[
                "render.samples=64",
                "render.sequence=sobol",
                "render.randomisations=64",
            ],
            "sets have 16 samples at least, so there are 4",
        ),
        (
            &[
                "render.samples=64",
                "render.sequence=sobol",
                "render.randomisations=4",
            ],
            "",
        ),
        (
            &[
                "interruption.rule=efficiency",
                "interruption.start=0",
                "interruption.split=2",
            ],
            "",
        ),
    ];
    for (sets, words) in cases {
        let notes = parsed(sets).unwrap().notes();
        let expected = usize::from(!words.is_empty());
        assert_eq!(notes.len(), expected, "{sets:?}: {notes:?}");
        assert!(
            notes.iter().all(|note| note.contains(words)),
            "{sets:?}: {notes:?}"
        );
    }
    for preset in ["montelight", "paper", "corrected", "reference"] {
        let notes = parsed(&[&format!("render.preset={preset}")])
            .unwrap()
            .notes();
        let of_scene = |note: &String| note.contains("no shape is directional");
        assert!(notes.iter().all(of_scene), "{preset}: {notes:?}");
    }
}

#[test]
fn notes_are_told_by_check_and_render_but_not_quietly() {
    let folder = tempfile::tempdir().unwrap();
    let sets = [
        "s.toml",
        "--set",
        "light.pole=receiver",
        "--set",
        "materials.white.roughness=0.1",
    ];
    let run = |first: &[&str]| lampray(folder.path(), &[], &[first, &sets].concat());
    let render = ["render", "--device", "cpu", "-o", "s.png"];
    for quiet in [false, true] {
        let more: &[&str] = if quiet { &["-q"] } else { &[] };
        let (code, _, words) = run(&[&render, more].concat());
        assert_eq!(code, 0, "{words}");
        for note in [
            "note: light.pole changes nothing",
            "`roughness` is for rough surfaces alone",
        ] {
            assert_eq!(words.contains(note), !quiet, "{words}");
        }
    }
    let (_, answer, words) = run(&["check", "--json"]);
    assert!(
        words.contains("note: light.pole changes nothing"),
        "{words}"
    );
    let answer: Value = serde_json::from_str(&answer).unwrap();
    assert_eq!(answer["notes"].as_array().unwrap().len(), 1);
    assert_eq!(answer["warnings"].as_array().unwrap().len(), 1);
}

/// No weight makes up for paths that never go on; the rules that know no material's threshold lose none.
#[test]
fn a_threshold_of_zero_is_a_bias() {
    let rule = "interruption.rule=survival";
    let (zero, start) = ("materials.white.survival=0", "interruption.start=0");
    let cause = "materials.white.survival = 0";
    let cases: [(&[&str], &[&str]); 7] = [
        (&[rule, zero, start], &[cause]),
        (
            &[rule, zero, start, "interruption.weight=literal"],
            &["interruption.weight = literal"],
        ),
        (&[rule, zero, "interruption.start=4"], &[]),
        (&[zero, start], &[]),
        (&[rule, zero, start, "materials.white.albedo=[0,0,0]"], &[]),
        (&[rule, start, "materials.white.survival=1e-12"], &[]),
        (
            &[rule, zero, start, "render.clamp=1"],
            &["render.clamp", cause],
        ),
    ];
    for (sets, causes) in cases {
        let scene = parsed(sets).unwrap();
        assert_eq!(scene.biases(), causes, "{sets:?}");
        assert_eq!(scene.biased(), !causes.is_empty());
    }
    let folder = tempfile::tempdir().unwrap();
    let sets = ["s.toml", "--set", rule, "--set", zero, "--set", start];
    let (code, record, _) = lampray(
        folder.path(),
        &[],
        &[
            &["render", "--device", "cpu", "-o", "s.exr", "--json"],
            &sets[..],
        ]
        .concat(),
    );
    assert_eq!(code, 0);
    let record: Value = serde_json::from_str(&record).unwrap();
    assert_eq!(record["biased"], true);
    let (_, answer, _) = lampray(folder.path(), &[], &[&["check"], &sets[..]].concat());
    assert!(
        answer.contains("biased by materials.white.survival = 0"),
        "{answer}"
    );
}

/// Survivors are divided by the probability that they have: numbers are whole parts of 2^24, and of those below the
/// threshold there are as many as it says.
#[test]
fn a_threshold_is_one_that_the_numbers_can_have() {
    for survival in ["1e-12", "1e-9", "1e-7", "6e-8", "1e-5", "0.3", "0.75", "1"] {
        let set = format!("materials.white.survival={survival}");
        let packed = Packed::new(&parsed(&[&set]).unwrap());
        let found = f64::from(packed.materials[0].survival);
        let wanted: f64 = survival.parse().unwrap();
        let parts = found * f64::from(1 << 24);
        assert_eq!(parts, parts.round(), "{survival}");
        assert!(
            parts >= 1.0 && found >= f64::from(wanted as f32),
            "{survival}: {found}"
        );
        assert!(
            found - wanted <= 1.0 / f64::from(1 << 24),
            "{survival}: {found}"
        );
    }
    let none = Packed::new(&parsed(&["materials.white.survival=0"]).unwrap());
    assert_eq!(none.materials[0].survival, 0.0);
}

#[test]
fn a_path_that_names_no_value_is_told_which_there_are() {
    let cases = [
        (
            "materials.nope.albedo=[1,1,1]",
            "it has `white`, `lamp`; write new ones into the scene file",
        ),
        ("materials.whit.albedo=[1,1,1]", "did you mean `white`?"),
        (
            "materials.white=1",
            "`materials.white` is a table: set its values one by one, `materials.white.scatter`",
        ),
        (
            "background=[1,1,1]",
            "`background` is a table: set its values one by one, `background.emission`",
        ),
        ("spheres.radius=1", "did you mean `spheres.*.radius`"),
        ("sweep.seeds=3", "a sweep's own arguments"),
    ];
    for (set, words) in cases {
        let Err(Error::Knob(message)) = parsed(&[set]) else {
            panic!("{set} was taken");
        };
        assert!(message.contains(words), "{set}: {message}");
    }
}

#[test]
fn what_cannot_be_meant_is_refused_with_a_remedy() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    let cpu = ["--device", "cpu"];
    let cases: [(&[&str], &str); 6] = [
        (
            &["render", "s.toml", "--json", "-o", "/dev/stdout"],
            "standard output, where --json prints",
        ),
        (
            &["render", "s.toml", "--json", "-o", "/dev/fd/1"],
            "standard output, where --json prints",
        ),
        (
            &["render", "s.toml", "-o", "a.exr", "--checkpoint", "-"],
            "a file of that name is ./-",
        ),
        (
            &["points", "light", "--set", "materials.white.albedo=[1,1,1]"],
            "draws have no scene",
        ),
        (
            &["points", "light", "--set", "camera.fov=30"],
            "draws have no scene",
        ),
        (
            &["points", "light", "--set", "image.width=3"],
            "draws have no scene",
        ),
    ];
    for (arguments, remedy) in cases {
        let (code, stdout, words) = lampray(at, &[], &[arguments, &cpu].concat());
        assert_eq!(code, 2, "{arguments:?}: {words}");
        assert!(words.contains(remedy), "{arguments:?}: {words}");
        assert_eq!(stdout, "");
    }
    let (code, stdout, words) = lampray(
        at,
        &[],
        &[&["render", "s.toml", "-o", "/dev/stdout"], &cpu[..]].concat(),
    );
    assert_eq!(code, 0, "{words}");
    assert!(stdout.contains("PNG"));
    let left = std::fs::read_dir(at).unwrap().count();
    assert_eq!(left, 1, "nothing but the scene is there");
}

/// Where the time goes before the first block there are no sums; where some pixels have samples, they are kept.
#[test]
fn time_that_is_up_before_a_picture_leaves_what_has_been_traced() {
    let folder = tempfile::tempdir().unwrap();
    let render = |time: &str| {
        let arguments = [
            "render",
            "s.toml",
            "-o",
            "a.exr",
            "--checkpoint",
            "sums",
            "--device",
            "cpu",
        ];
        lampray(
            folder.path(),
            &[],
            &[&arguments[..], &["--time", time]].concat(),
        )
    };
    let (code, _, words) = render("1e-9");
    assert_eq!(code, 75, "{words}");
    assert!(
        words.contains("nothing is traced yet") && words.contains("no sums to keep"),
        "{words}"
    );
    assert!(!words.contains("--resume"), "{words}");
    let left = std::fs::read_dir(folder.path()).unwrap().count();
    assert_eq!(left, 1, "nothing but the scene is there");
}

#[test]
fn a_doctor_without_a_device_answers_in_json() {
    let folder = tempfile::tempdir().unwrap();
    let nowhere = [
        ("VK_DRIVER_FILES", "/nonexistent"),
        ("VK_ICD_FILENAMES", "/nonexistent"),
    ];
    let arguments = ["doctor", "--json", "--device", "software"];
    let (code, answer, words) = lampray(folder.path(), &nowhere, &arguments);
    assert_eq!(code, 69, "{words}");
    let answer: Value = serde_json::from_str(&answer).unwrap();
    assert_eq!(answer["ok"], false);
    assert!(
        answer["error"]
            .as_str()
            .unwrap()
            .contains("software Vulkan device")
    );
}

#[test]
fn names_of_files_keep_to_their_line() {
    let folder = tempfile::tempdir().unwrap();
    for name in [
        "\u{1b}[31mred\nlampray: all is well.exr",
        "none\u{9b}2J.toml",
    ] {
        for arguments in [
            vec!["render", name],
            vec!["check", name],
            vec!["merge", name, "b.exr", "-o", "c.exr"],
            vec!["rerun", name, "-o", "c.exr"],
            vec!["diff", name, "b.exr"],
            vec![
                "render",
                "s.toml",
                "-o",
                name,
                "--checkpoint",
                name,
                "--device",
                "cpu",
            ],
        ] {
            let (_, stdout, words) = lampray(folder.path(), &[], &arguments);
            let all = stdout + &words;
            let lines = all
                .lines()
                .filter(|line| line.starts_with("lampray: all is well"));
            assert_eq!(lines.count(), 0, "{arguments:?}: {all:?}");
            assert!(
                !all.contains(['\u{1b}', '\u{9b}']),
                "{arguments:?}: {all:?}"
            );
        }
    }
}
