//! The GPU: adapters, one device at a time, pipelines for each strategy, dispatches. No call of
//! wgpu's may panic its way to a user: errors are caught in scopes, and what wgpu panics on itself
//! is caught here and read as a lost device.

mod adapter;
mod cache;
mod device;
mod fault;
mod flight;
mod guard;
mod pieces;
mod pipeline;
mod trace;

pub use adapter::{Adapters, adapters};
pub use device::Gpu;
pub use pipeline::{Binding, bindings, binds_scene, scene_bindings};
