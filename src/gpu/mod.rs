//! The GPU: adapters, one device at a time, pipelines for each strategy, dispatches. No call of
//! wgpu's may panic its way to a user: errors are caught in scopes, and what wgpu panics on itself
//! is caught here and read as a lost device.

#[forbid(unsafe_code)]
mod adapter;
#[forbid(unsafe_code)]
mod cache;
#[forbid(unsafe_code)]
mod canary;
#[forbid(unsafe_code)]
mod denoise;
#[forbid(unsafe_code)]
mod device;
// Handing a driver what it compiled before is unsafe in wgpu.
mod disk_cache;
#[forbid(unsafe_code)]
mod fault;
#[forbid(unsafe_code)]
mod flight;
#[forbid(unsafe_code)]
mod guard;
#[forbid(unsafe_code)]
mod pieces;
#[forbid(unsafe_code)]
mod pipeline;
#[forbid(unsafe_code)]
mod trace;

pub use adapter::{Adapters, adapters};
pub use device::Gpu;
pub use pipeline::{Binding, bindings, binds_scene, scene_bindings};
