//! Assignments of the command line, one a line, over a scene that has one of everything.

use super::support;
use lampray::Error;
use lampray::scene::{Assignment, Scene};

const SCENE: &str = r#"version = 1
[camera]
position = [0.0, 1.0, 3.4]
look_at = [0, 1, 0]
[materials.white]
albedo = [0.75, 0.5, 0.25]
[materials.lamp]
emission = [10, 10.0, 10.0]
[[spheres]]
center = [0.0, 1.7, 0.0]
radius = 0.15
material = "lamp"
[[boxes]]
min = [-1.0, -0.1, -1.0]
max = [1.0, 0.0, 1.0]
material = "white"
"#;

pub fn run(bytes: &[u8]) {
    let Ok(text) = std::str::from_utf8(bytes) else {
        return;
    };
    let assignments: Result<Vec<_>, Error> = text.lines().map(Assignment::parse).collect();
    let outcome = assignments.and_then(|all| Scene::parse("fuzz.toml", SCENE, &all));
    match outcome {
        Ok(scene) => support::taken(&scene),
        Err(error) => {
            support::refusal(&error);
            assert!(matches!(error, Error::Knob(_)), "{error}");
        }
    }
}
