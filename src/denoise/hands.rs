//! The device that denoises, and the CPU twin in its place where it is lost.

use crate::cpu::Cpu;
use crate::device::{Device, DeviceKind};
use crate::error::{Error, Result};
use crate::pack::Packed;
use crate::render::Spares;

/// A device with the scene on it.
pub(super) struct Hands<'a> {
    device: &'a mut Box<dyn Device>,
    pub packed: Packed,
    spares: Spares<'a>,
}

impl<'a> Hands<'a> {
    pub fn new(
        device: &'a mut Box<dyn Device>,
        packed: Packed,
        spares: Spares<'a>,
    ) -> Result<Self> {
        let mut hands = Self {
            device,
            packed: packed.clone(),
            spares,
        };
        hands.ask(|device| device.load(&packed))?;
        Ok(hands)
    }

    /// Calls the device; where it fails, and any other will do, the CPU twin from then on.
    pub fn ask<T>(&mut self, call: impl Fn(&mut dyn Device) -> Result<T>) -> Result<T> {
        let twin_is_left = self.spares.any && self.device.info().kind != DeviceKind::Cpu;
        match call(self.device.as_mut()) {
            Err(Error::DeviceLost(reason) | Error::Device(reason)) if twin_is_left => {
                let text = format!("{reason}; denoising with the built-in CPU renderer");
                (self.spares.tell)(&text);
                *self.device = Box::new(Cpu::new());
                self.device.load(&self.packed)?;
                call(self.device.as_mut())
            }
            answer => answer,
        }
    }
}
