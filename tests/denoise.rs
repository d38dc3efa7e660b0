//! Denoising: both devices make the same of it, it leaves alone what has no noise, keeps edges and energy, and comes
//! nearer to the truth; and who reads such a picture knows what it is.

mod support;

#[path = "denoise/better.rs"]
mod better;
#[path = "denoise/fragile.rs"]
mod fragile;
#[path = "denoise/hard.rs"]
mod hard;
#[path = "denoise/keeps.rs"]
mod keeps;
#[path = "denoise/program.rs"]
mod program;
#[path = "denoise/room.rs"]
mod room;
#[path = "denoise/shines.rs"]
mod shines;
#[path = "denoise/twin.rs"]
mod twin;
