//! Each limit of the scene file at its end and one above, which is refused before there is memory for it.

use super::program::{Case, Ended, scene};

/// Checks the scene with an address space of a gigabyte.
fn check(text: &str, more: &[&str]) -> Ended {
    let case = Case::new(text);
    #[cfg(unix)]
    return case.run_within(1 << 30, &[&["check", "s.toml"], more].concat());
    #[cfg(not(unix))]
    return case.run(&[&["check", "s.toml"], more].concat());
}

fn taken(text: &str) {
    let ended = check(text, &[]);
    assert_eq!(ended.code, 0, "{ended:?}");
}

fn refused(text: &str, reason: &str) {
    let ended = check(text, &[]);
    assert_eq!(ended.code, 65, "{ended:?}");
    let said = ended.said + &ended.printed;
    assert!(said.contains(reason), "{said}");
    assert!(said.len() < 100_000, "{} bytes", said.len());
}

fn empty(more: &str) -> String {
    scene([0.0; 3], more)
}

#[test]
fn size_of_the_file() {
    let filled = |bytes: usize| {
        let text = empty("#");
        let rest = bytes - text.len();
        text + &"x".repeat(rest)
    };
    taken(&filled(16 << 20));
    refused(&filled((16 << 20) + 1), "16 MiB");
    // No end at all, and no size that it tells.
    #[cfg(target_os = "linux")]
    {
        let case = Case::new("");
        let ended = case.run_within(1 << 30, &["check", "/dev/zero"]);
        assert_eq!(ended.code, 65, "{ended:?}");
        assert!(ended.said.contains("16 MiB"), "{ended:?}");
    }
}

#[test]
fn number_of_bodies() {
    let crowd = |spheres: usize, boxes: usize| {
        let list = |count: usize| "{},".repeat(count);
        format!(
            "version = 1\nspheres = [{}]\nboxes = [{}]\n",
            list(spheres),
            list(boxes)
        )
    };
    // Each body takes 38 bytes at least, so that 16 MiB of them are fewer: here all of their keys are missing.
    let most = 1 << 20;
    refused(&crowd(most, 0), "`spheres.0` has no `center`");
    refused(&crowd(most + 1, 0), "more than 1048576 spheres and boxes");
    refused(&crowd(4, most - 3), "more than 1048576 spheres and boxes");
    let body = "{center=[0,0,0],radius=1,material=\"grey\"},";
    let bodies = body.repeat(200_000);
    taken(&format!(
        "version = 1\nspheres = [{bodies}]\n{}",
        empty("").replace("version = 1\n", "")
    ));
}

#[test]
fn number_of_materials_and_their_names() {
    let many = |count: usize| {
        let one = |number: usize| format!("[materials.m{number}]\n");
        empty(&(0..count).map(one).collect::<String>())
    };
    // Two are there already.
    taken(&many((1 << 16) - 2));
    refused(&many((1 << 16) - 1), "more than 65536 materials");
    let named = |length: usize| empty(&format!("[materials.{}]\n", "n".repeat(length)));
    taken(&named(256));
    refused(&named(257), "at most 256 characters");
    refused(&named(15 << 20), "at most 256 characters");
}

#[test]
fn sides_and_pixels() {
    let sized =
        |width: u32, height: u32| empty(&format!("[image]\nwidth = {width}\nheight = {height}\n"));
    taken(&sized(32768, 8192));
    taken(&sized(8192, 32768));
    refused(&sized(32768, 8193), "2^28");
    refused(&sized(32769, 1), "1 to 32768");
    refused(&sized(1, 32769), "1 to 32768");
    refused(&sized(0, 1), "1 to 32768");
}

#[test]
fn numbers() {
    let render = |knob: &str, value: &str| empty(&format!("[render]\n{knob} = {value}\n"));
    taken(&render("samples", "2147483647"));
    refused(&render("samples", "2147483648"), "1 to 2147483647");
    refused(&render("samples", "0"), "1 to 2147483647");
    taken(&render("seed", "18446744073709551615"));
    refused(&render("seed", "18446744073709551616"), "0 to");
    taken(&render("clamp", "1e12"));
    refused(&render("clamp", "1.0001e12"), "at most 1e12");
    refused(
        &render("clamp", &format!("1{}", "0".repeat(1 << 20))),
        "too large",
    );
}

/// A direction needs a length that can be squared.
#[test]
fn directions() {
    let up = |length: &str| {
        empty("").replace(
            "[materials.grey]",
            &format!("up = [0, {length}, 0]\n[materials.grey]"),
        )
    };
    for length in ["1e-12", "1", "1e12"] {
        taken(&up(length));
    }
    for length in ["9e-13", "1e-160", "1e-320", "0"] {
        refused(&up(length), "`camera.up` must be a direction");
    }
    let view = |ahead: &str| {
        empty("").replace(
            "look_at = [0.0, 0.0, -1.0]",
            &format!("look_at = [0.0, 0.0, {ahead}]"),
        )
    };
    taken(&view("-1e-12"));
    for ahead in ["-9e-13", "-1e-160", "0"] {
        refused(&view(ahead), "must differ from");
    }
}

#[test]
fn regions_of_a_sweep() {
    let regions = |count: usize, name: &str| {
        let one = |number: usize| format!("{name}{number} = [0, 0, 1, 1]\n");
        let all: String = (0..count).map(one).collect();
        empty(&format!("[sweep.regions]\n{all}"))
    };
    taken(&regions(256, "r"));
    refused(&regions(257, "r"), "more than 256 regions");
    taken(&regions(1, &"r".repeat(255)));
    refused(&regions(1, &"r".repeat(256)), "at most 256 characters");
}

/// Sixteen mebibytes of whatever costs a parser most are refused, too, and soon.
#[test]
fn files_that_are_made_to_cost() {
    let most = 16 << 20;
    let nested = format!("x = [{}]\n", "[],".repeat((most - 8) / 3));
    let tables = format!("x = [{}]\n", "{},".repeat((most - 8) / 3));
    let dotted = format!("{}y = 1\n", "x.".repeat((most - 8) / 2));
    let twice = "[materials.a]\n".repeat(most / 14);
    let keys: String = (0..1_000_000)
        .map(|number| format!("a{number}=1\n"))
        .collect();
    let escapes = format!("x = \"{}\"\n", "\\\\".repeat((most - 8) / 2));
    let strangers: String = (0..60_000)
        .map(|number| format!("[materials.m{number}]\n"))
        .collect();
    let strangers = empty(&(strangers + &"[[spheres]]\nmaterial = \"m\"\n".repeat(200_000)));
    for text in [nested, tables, dotted, twice, keys, escapes, strangers] {
        assert!(text.len() <= most);
        let case = Case::new(&text);
        let ended = case.run(&["check", "s.toml"]);
        assert_eq!(ended.code, 65, "{:.200}", ended.said);
        assert!((ended.said + &ended.printed).len() < 100_000);
    }
}
