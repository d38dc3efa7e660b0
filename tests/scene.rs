//! Scene files: what is read from them, and how what is wrong with them is said.

use lampray::Error;
use lampray::scene::{Assignment, MOST_BYTES, Scene};
use std::path::Path;

/// A scene with something of everything; tests break one line of it at a time.
const GOOD: &str = r#"version = 1
[camera]
position = [0.0, 1.0, 3.4]
look_at = [0, 1, 0]
up = [0.0, 1.0, 0.0]
fov = 45.0
[image]
width = 256
height = 128
[render]
samples = 64
seed = 18446744073709551615
[materials.white]
albedo = [0.75, 0.5, 0.25]
survival = 0.75
[materials.lamp]
emission = [10, 10.0, 10.0]
[[spheres]]
center = [0.0, 1.7, 0.0]
radius = 0.15
material = "lamp"
[[boxes]]
min = [-1.0, -0.1, -1.0]
max = [1.0, 0.0, 1.0]
rotation = [0.0, 18.0, 0.0]
material = "white"
"#;

fn parse(text: &str) -> lampray::Result<Scene> {
    Scene::parse("bad.toml", text, &[])
}

/// The page of errors of a scene that must be refused.
fn refused(text: &str) -> String {
    match parse(text) {
        Err(Error::Scene(page)) => page,
        Err(other) => panic!("another error than expected: {other}"),
        Ok(_) => panic!("the scene was accepted:\n{text}"),
    }
}

#[test]
fn a_good_scene_is_read_whole() {
    let scene = parse(GOOD).unwrap();
    assert_eq!(scene.camera.position.to_array(), [0.0, 1.0, 3.4]);
    assert_eq!(scene.camera.look_at.to_array(), [0.0, 1.0, 0.0]);
    assert_eq!(scene.settings.render.seed, u64::MAX);
    assert_eq!(scene.settings.image.height, 128);
    assert_eq!(scene.materials[0].name, "white");
    assert_eq!(scene.materials[0].albedo.to_array(), [0.75, 0.5, 0.25]);
    assert_eq!(scene.materials[1].emission.to_array(), [10.0; 3]);
    assert_eq!(scene.spheres[0].material, 1);
    assert_eq!(scene.boxes[0].rotation.y, 18.0);
    assert_eq!(scene.lamps().count(), 1);
    assert_eq!(scene.source.text, GOOD);
    assert!(scene.warnings().is_empty());
}

/// What to replace in the good scene, by what, where the error must point, and words it must hold.
type Case = (
    &'static str,
    &'static str,
    &'static str,
    &'static [&'static str],
);

#[rustfmt::skip]
const CASES: &[Case] = &[
    // Keys.
    ("[camera]", "camra = 1\n[camera]", "2:1", &["unknown key `camra`", "did you mean `camera`?"]),
    ("fov = 45.0", "fow = 45.0", "6:1", &["unknown key `fow` in `camera`", "did you mean `fov`?"]),
    ("survival", "survivel", "15:1", &["`materials.white`", "did you mean `survival`?"]),
    ("radius =", "raduis =", "20:1", &["did you mean `radius`?", "`spheres.0` has no `radius`"]),
    ("samples = 64", "sampler = \"cone\"", "11:1", &["did you mean `samples`, or the knob `light.sampler`?"]),
    ("samples = 64", "samples = 64\nsamples = 65", "12:1", &["duplicate key"]),
    // Version.
    ("version = 1\n", "\n", "1:1", &["no version", "version = 1"]),
    ("version = 1", "version = 2", "1:11", &["`version` must be 1"]),
    ("version = 1", "version = \"1\"", "1:11", &["`version` must be 1"]),
    // Types.
    ("width = 256", "width = 256.0", "8:9", &["`image.width` must be a whole number"]),
    ("width = 256", "width = \"256\"", "8:9", &["must be a whole number, not text"]),
    ("fov = 45.0", "fov = true", "6:7", &["must be a number, not a boolean"]),
    ("[0, 1, 0]", "[0, 1]", "4:11", &["must be three numbers, not 2"]),
    ("[0, 1, 0]", "[0, 1, [0]]", "4:18", &["must be a number, not a list"]),
    ("[0, 1, 0]", "7", "4:11", &["three numbers in square brackets"]),
    ("material = \"lamp\"", "material = 1", "21:12", &["a material's name in quotes"]),
    ("[[spheres]]", "[spheres]", "18:1", &["write [[spheres]]"]),
    ("[materials.lamp]", "[materials]\nlamp = 3\n[materials.x]", "17:8", &["`materials.lamp` must be a table"]),
    // Numbers that are not finite or do not fit.
    ("[0, 1, 0]", "[0, nan, 0]", "4:15", &["`camera.look_at` must be a finite number, not nan"]),
    ("[0, 1, 0]", "[-inf, 1, 0]", "4:12", &["finite"]),
    ("[0, 1, 0]", "[1e999, 1, 0]", "4:12", &["1e999 is too large"]),
    ("[0, 1, 0]", "[1e31, 1, 0]", "4:12", &["at most 1e12"]),
    ("= 18446744073709551615", "= 18446744073709551616", "12:8", &["`render.seed` must be 0 to"]),
    ("= 18446744073709551615", "= -1", "12:8", &["`render.seed` must be 0 to"]),
    // Ranges.
    ("radius = 0.15", "radius = 0", "20:10", &["`spheres.0.radius` must be > 0, not 0"]),
    ("radius = 0.15", "radius = -1.5", "20:10", &["must be > 0, not -1.5"]),
    ("radius = 0.15", "radius = 1e-40", "20:10", &["at least 1e-12"]),
    ("0.5, 0.25]", "1.5, 0.25]", "14:17", &["`materials.white.albedo` must be 0 to 1, not 1.5"]),
    ("0.5, 0.25]", "0.5, -0.25]", "14:22", &["must be 0 to 1"]),
    ("survival = 0.75", "survival = 1.01", "15:12", &["`materials.white.survival` must be 0 to 1"]),
    ("[10, 10.0, 10.0]", "[10, -1, 10.0]", "17:17", &["`materials.lamp.emission` must be >= 0, not -1"]),
    ("survival = 0.75", "spread = 0.0", "15:10", &["must be > 0"]),
    ("survival = 0.75", "roughness = 1.5", "15:13", &["`materials.white.roughness` must be 0 to 1, not 1.5"]),
    ("survival = 0.75", "index = 0.9", "15:9", &["`materials.white.index` must be 1 to 4, not 0.9"]),
    ("survival = 0.75", "ruffness = 0.1", "15:1", &["did you mean `roughness`?"]),
    ("fov = 45.0", "aperture = -0.1", "6:12", &["`camera.aperture` must be >= 0, not -0.1"]),
    ("fov = 45.0", "focus = 0", "6:9", &["`camera.focus` must be > 0, not 0"]),
    ("fov = 45.0", "focus = \"near\"", "6:9", &["number"]),
    ("fov = 45.0", "focus = 2", "6:9", &["`camera.focus` is set, and `camera.aperture` is not"]),
    ("fov = 45.0", "fov = 0", "6:7", &["`camera.fov` must be > 0 and < 180, not 0"]),
    ("fov = 45.0", "fov = 180.0", "6:7", &["> 0 and < 180"]),
    ("fov = 45.0", "fov = 179.999999999999", "6:7", &["> 0 and < 180"]),
    ("width = 256", "width = 0", "8:9", &["1 to 32768"]),
    ("width = 256", "width = 32769", "8:9", &["1 to 32768"]),
    ("width = 256\nheight = 128", "width = 32768\nheight = 8193", "8:9", &["32768 x 8193", "2^28"]),
    ("samples = 64", "samples = 0", "11:11", &["1 to 2147483647"]),
    // Choices and names.
    ("survival = 0.75", "scatter = \"difuse\"", "15:11", &["must be one of diffuse, directional, mirror, rough, glass", "did you mean `diffuse`?"]),
    ("material = \"lamp\"", "material = \"lamb\"", "21:12", &["unknown material `lamb`", "did you mean `lamp`?"]),
    ("material = \"white\"", "material = \"zz\"", "26:12", &["the materials are lamp, white"]),
    ("[materials.white]", "[materials.\"a=b\"]", "13:12", &["a material's name must not hold"]),
    ("[image]", "[light]\npole = \"recevier\"\n[image]", "8:8", &["did you mean `receiver`?"]),
    ("[image]", "[light]\npole = [0, 0, 0]\n[image]", "8:8", &["length must not be zero"]),
    // Parts that do not fit each other.
    ("min = [-1.0, -0.1, -1.0]", "min = [-1.0, 0.0, -1.0]", "23:7", &["min < max", "along y"]),
    ("look_at = [0, 1, 0]", "look_at = [0, 1, 3.4]", "4:11", &["must differ from `camera.position`"]),
    ("up = [0.0, 1.0, 0.0]", "up = [0.0, 0.0, -2.0]", "5:6", &["parallel to the view"]),
    ("up = [0.0, 1.0, 0.0]", "up = [0.0, 0.0, 0.0]", "5:6", &["length must not be zero"]),
    // What is missing.
    ("position = [0.0, 1.0, 3.4]\n", "", "2:1", &["`camera.position` is missing"]),
    ("radius = 0.15\n", "", "18:1", &["`spheres.0` has no `radius`"]),
    ("material = \"white\"\n", "", "22:1", &["`boxes.0` has no `material`"]),
    // What is not TOML.
    ("width = 256", "width = ", "8:9", &["not TOML"]),
    ("fov = 45.0", "fov = 45.0.0", "6:11", &["not TOML"]),
    ("[image]", "[image", "7:7", &["not TOML"]),
];

#[test]
fn every_rejection_has_place_reason_and_remedy() {
    for (old, new, place, words) in CASES {
        assert!(GOOD.contains(old), "the good scene has no {old:?}");
        let page = refused(&GOOD.replacen(old, new, 1));
        let place = format!("bad.toml:{place}\n");
        assert!(page.contains(&place), "{new:?}: no {place:?} in\n{page}");
        for word in *words {
            assert!(page.contains(word), "{new:?}: no {word:?} in\n{page}");
        }
        assert!(page.contains('^'), "no caret in\n{page}");
    }
}

#[test]
fn all_errors_of_a_file_are_said_at_once_in_its_order() {
    let broken = GOOD
        .replace("45.0", "450")
        .replace("radius = 0.15", "radius = -1")
        .replace("boxes]]", "boxes]]\nmin = 3")
        .replace("samples = 64", "samples = 64 64");
    let page = refused(&broken);
    let at = |text: &str| {
        page.find(text)
            .unwrap_or_else(|| panic!("no {text} in\n{page}"))
    };
    let places = [
        "bad.toml:6:7",
        "bad.toml:11:11",
        "bad.toml:20:10",
        "bad.toml:23:7",
    ];
    assert!(places.map(at).is_sorted(), "{page}");
    assert!(page.ends_with("5 errors in bad.toml"), "{page}");
}

#[test]
fn many_errors_and_long_lines_stay_readable() {
    let many = format!("{GOOD}{}", "[[spheres]]\nradius = -1\n".repeat(10_000));
    let page = refused(&many);
    assert!(page.len() < 30_000, "{} bytes", page.len());
    assert!(page.contains("and 29950 more"), "{page}");
    let wide = format!("version = 1\n{} = 1\n", "k".repeat(1 << 20));
    assert!(refused(&wide).len() < 3000);
    let far = format!("version = 1\nx = [{}oops]\n", "\"ä\", ".repeat(1000));
    let page = refused(&far);
    assert!(page.contains("bad.toml:2:5006\n"), "{page}");
    assert!(page.len() < 3000, "{page}");
    let page = refused("version = 1\n\u{1b}[31m = 1\n");
    assert!(!page.contains('\u{1b}'), "{page}");
}

/// A scene's name may come out of an image.
#[test]
fn names_of_scenes_hold_no_codes_for_a_terminal() {
    let Err(Error::Scene(page)) = Scene::parse("\u{1b}[2J.toml", "version = 2\n", &[]) else {
        panic!("version 2 was read");
    };
    assert!(page.contains("[2J.toml:1:11"), "{page}");
    assert!(!page.contains('\u{1b}'), "{page:?}");
}

/// The record of a picture may set every knob of sixty thousand materials; each is found at once.
#[test]
fn a_hundred_thousand_assignments_are_laid_over_a_scene() {
    let names: String = (0..60_000)
        .map(|number| format!("[materials.m{number}]\n"))
        .collect();
    let text = format!("{GOOD}{names}");
    let set = |number: usize| {
        let path = format!("materials.m{}.survival", number % 60_000);
        Assignment::new(path, "0.5", "--set")
    };
    let all: Vec<_> = (0..120_000).map(set).collect();
    let scene = Scene::parse("s.toml", &text, &all).unwrap();
    assert!(scene.materials[2..].iter().all(|one| one.survival == 0.5));
    let mut radii: Vec<_> = (0..100_000)
        .map(|number| Assignment::new("spheres.0.radius", format!("{}", number + 1), "--set"))
        .collect();
    radii.push(Assignment::new("boxes.0.rotation", "[0, 1, 0]", "--set"));
    let scene = Scene::parse("s.toml", GOOD, &radii).unwrap();
    assert_eq!(scene.spheres[0].radius, 100_000.0);
    assert_eq!(scene.knobs["spheres.0.radius"], 100_000.0);
    assert_eq!(scene.knobs["boxes.0.rotation"][1], 1.0);
}

#[test]
fn what_is_no_scene_at_all_is_refused() {
    assert!(refused("").contains("bad.toml:1:1\n"));
    assert!(refused("").contains("no version"));
    let deep = "[{a=".repeat(100_000);
    assert!(refused(&format!("version = 1\nx = {deep}")).contains("not TOML"));
    let dotted = vec!["a"; 100_000].join(".");
    assert!(refused(&format!("{dotted}=1")).contains("not TOML"));
    let header = |depth: usize| format!("[{}]\n", vec!["a"; depth + 1].join("."));
    refused(&(0..1500).map(header).collect::<String>());
    let large = format!("{GOOD}{}", "#".repeat(17 << 20));
    assert!(refused(&large).contains("16 MiB"));
    let crowd = format!("version = 1\nspheres = [{}]\n", "{},".repeat((1 << 20) + 1));
    let page = refused(&crowd);
    assert!(page.contains("more than 1048576"), "{page}");
}

#[test]
fn files_that_cannot_be_scenes_say_why() {
    let folder = tempfile::tempdir().unwrap();
    let load = |path: &Path| Scene::load(path, &[]);
    let file = |name: &str, bytes: &[u8]| {
        let path = folder.path().join(name);
        std::fs::write(&path, bytes).unwrap();
        path
    };
    let missing = load(&folder.path().join("none.toml"));
    assert!(matches!(missing, Err(Error::Input { .. })));
    let Err(error @ Error::Input { .. }) = load(folder.path()) else {
        panic!("a directory was read");
    };
    assert!(error.to_string().contains("directory"));
    let Err(Error::Data { reason, .. }) = load(&file("binary", b"version\xff\xfe")) else {
        panic!("a binary file was read");
    };
    assert!(reason.contains("byte 7"), "{reason}");
    let large = vec![b'#'; MOST_BYTES as usize + 1];
    let Err(Error::Data { reason, .. }) = load(&file("large", &large)) else {
        panic!("a large file was read");
    };
    assert!(reason.contains("16 MiB"), "{reason}");
    assert!(load(&file("good.toml", GOOD.as_bytes())).is_ok());
}

#[test]
fn byte_order_mark_and_windows_line_ends_are_fine() {
    let windows = format!("\u{feff}{}", GOOD.replace('\n', "\r\n"));
    let scene = parse(&windows).unwrap();
    assert_eq!(scene.knobs, parse(GOOD).unwrap().knobs);
    let page = refused(&windows.replace("45.0", "450"));
    assert!(page.contains("bad.toml:6:7\n"), "{page}");
    assert!(!page.contains(['\r', '\u{fffd}']), "{page}");
    let page = refused(&windows.replace("version = 1", "version = 2"));
    assert!(page.contains("bad.toml:1:11\n"), "{page}");
}

/// A fixed sequence of pseudo-random numbers (Steele, Lea and Flood 2014, SplitMix64).
fn mixed(state: &mut u64) -> usize {
    *state = state.wrapping_add(0x9e37_79b9_7f4a_7c15);
    let mut bits = *state;
    bits = (bits ^ (bits >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    bits = (bits ^ (bits >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    (bits ^ (bits >> 31)) as usize
}

#[test]
fn mutated_scenes_never_panic_and_accepted_ones_are_sound() {
    let alphabet = b"\n[]{}\"'=.,-+ #0123456789einfax_\\\t\r\x00\x7f";
    let mut state = 1;
    for _ in 0..20_000 {
        let mut bytes = GOOD.as_bytes().to_vec();
        for _ in 0..1 + mixed(&mut state) % 4 {
            let at = mixed(&mut state) % bytes.len();
            let new = alphabet[mixed(&mut state) % alphabet.len()];
            match mixed(&mut state) % 4 {
                0 => bytes[at] = new,
                1 => bytes.insert(at, new),
                2 => drop(bytes.remove(at)),
                _ => drop(bytes.drain(at..(at + 9).min(bytes.len()))),
            }
        }
        let text = String::from_utf8(bytes).unwrap();
        match parse(&text) {
            Ok(scene) => {
                assert!(scene.spheres.iter().all(|sphere| sphere.radius > 0.0));
                assert!(scene.boxes.iter().all(|b| b.min.cmplt(b.max).all()));
                scene.warnings();
            }
            Err(error) => assert!(error.to_string().contains("bad.toml:"), "{error}"),
        }
    }
}

#[test]
fn a_hundred_thousand_spheres_are_read_quickly() {
    let sphere =
        |n| format!("[[spheres]]\ncenter = [{n}.5, 0, 1]\nradius = 0.1\nmaterial = \"white\"\n");
    let more: String = (0..100_000).map(sphere).collect();
    let start = std::time::Instant::now();
    let scene = parse(&format!("{GOOD}{more}")).unwrap();
    assert_eq!(scene.spheres.len(), 100_001);
    // A third of a second on an idle machine; the rest is for a busy one.
    assert!(start.elapsed().as_secs_f64() < 3.0, "{:?}", start.elapsed());
    let shapes = |path: &String| path.starts_with("spheres");
    assert!(!scene.knobs.keys().any(shapes));
}

#[test]
fn what_is_suspect_is_warned_of_with_its_place() {
    let room = "[[boxes]]\nmin = [-5, -5, -5]\nmax = [5, 5, 5]\nmaterial = \"white\"\n";
    let rule = "[interruption]\nrule = \"survival\"\n[image]";
    let change = |old, new| GOOD.replace(old, new);
    #[rustfmt::skip]
    let cases = [
        (format!("{GOOD}{room}"), 18, "the light `spheres.0` stands inside `boxes.1`"),
        (format!("{GOOD}{room}"), 2, "the camera stands inside `boxes.1`"),
        (change("1.7, 0.0]", "0.1, 0.0]"), 18, "is partly inside `boxes.0`"),
        (change("[0.0, 1.7, 0.0]", "[0.0, 1.0, 3.4]"), 2, "inside `spheres.0`"),
        (change("[10, 10.0, 10.0]", "[0, 0, 0]"), 1, "there is no light"),
        (change("0.75, 0.5", "1, 0.5") + room, 13, "reflects all light"),
        (change("material = \"lamp\"", "material = \"white\""), 16, "no shape has the material `lamp`"),
        (change("[image]", rule).replace("survival = 0.75", "survival = 0.5"), 15, "not above the square"),
        (change("samples = 64", "samples = 1"), 10, "one path a pixel"),
        (change("survival = 0.75", "roughness = 0.1"), 13, "`white` is diffuse, and `roughness` is for rough surfaces alone"),
        (change("survival = 0.75", "scatter = \"rough\"\nspread = 0.1"), 13, "`spread` is for directional surfaces alone"),
        (change("survival = 0.75", "scatter = \"mirror\"\nindex = 2"), 13, "`index` is for glass surfaces alone"),
        (change("survival = 0.75", "scatter = \"glass\"") + room, 18, "stands inside glass, `boxes.1`"),
    ];
    for (text, line, words) in cases {
        let warnings = parse(&text).unwrap().warnings();
        let found = warnings.iter().find(|found| found.message.contains(words));
        let found = found.unwrap_or_else(|| panic!("no {words:?} in {warnings:#?}"));
        assert_eq!(found.place.map(|(line, _)| line), Some(line), "{found}");
        let place = format!("bad.toml:{line}:");
        assert!(found.text.contains(&place), "{found}");
    }
}

#[test]
fn errors_of_the_command_line_name_the_flag() {
    let assignments = [Assignment::new("image.width", "0", "--width 0")];
    let Err(Error::Knob(page)) = Scene::parse("bad.toml", GOOD, &assignments) else {
        panic!("a width of 0 was taken");
    };
    let expected = "--width 0: `image.width` must be 1 to 32768, not 0";
    assert_eq!(page, expected);
}

/// By rho^2 / t, by the rule that it holds for, and by the hits that are tested.
#[test]
fn thresholds_that_leave_the_variance_without_a_bound_are_told_with_numbers() {
    let rule = "[interruption]\nrule = \"survival\"\n[image]";
    let told = |change: &dyn Fn(String) -> String| {
        let scene = parse(&change(GOOD.replace("[image]", rule))).unwrap();
        (scene.unbounded(), scene.unbounded_lines())
    };
    let low = |text: String| text.replace("survival = 0.75", "survival = 0.5");
    let (found, lines) = told(&low);
    let [one] = found.as_slice() else {
        panic!("{found:?}");
    };
    assert_eq!((one.survival, one.albedo, one.tests), (0.5, 0.75, 4));
    assert!((one.growth() - 1.125).abs() < 1e-12);
    for words in [
        "bad.toml:15:1: `white`",
        "0.5625",
        "1.1250",
        "4 hits by up to 1.602e0",
        "set `survival` above 0.5625",
    ] {
        assert!(lines[0].contains(words), "{words}: {lines:?}");
    }
    let none: [&dyn Fn(String) -> String; 4] = [
        &|text| text,
        &|text| {
            low(text).replace(
                "rule = \"survival\"",
                "rule = \"survival\"\nweight = \"literal\"",
            )
        },
        &|text| low(text).replace("rule = \"survival\"", "rule = \"survival\"\nstart = 8"),
        &|text| low(text).replace("rule = \"survival\"", "rule = \"albedo\""),
    ];
    for change in none {
        assert!(told(change).0.is_empty());
    }
    // At the square itself every hit adds as much as the one before.
    let (equal, _) = told(&|text| text.replace("survival = 0.75", "survival = 0.5625"));
    assert_eq!(equal[0].growth(), 1.0);
}
