#![no_main]
#[path = "../bodies/mod.rs"]
mod bodies;
bodies::target!(scene_render);
