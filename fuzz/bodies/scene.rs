//! A scene file.

use super::support;
use lampray::scene::Scene;

pub fn run(bytes: &[u8]) {
    let Ok(text) = std::str::from_utf8(bytes) else {
        return;
    };
    match Scene::parse("fuzz.toml", text, &[]) {
        Ok(scene) => {
            support::taken(&scene);
            for warning in scene.warnings() {
                assert!(!warning.message.is_empty());
            }
        }
        Err(error) => support::refusal(&error),
    }
}
