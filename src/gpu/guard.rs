//! A device whose every call is watched: errors are caught in scopes, panics of wgpu's own are read as a
//! lost device, and no wait is without an end.

use crate::error::{Error, Result};
use crate::panics::catch;
use bytemuck::Pod;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::sync::{Arc, Mutex};
use std::time::{Duration, Instant};

/// Waits are made of slices of this length, and each counts as one however long it lasted: a program that was
/// stopped for an hour has not waited for the device that long.
const SLICE: Duration = Duration::from_secs(1);

/// A device whose every call is watched.
#[derive(Debug)]
pub struct Guard {
    device: wgpu::Device,
    queue: wgpu::Queue,
    name: String,
    lost: Arc<AtomicBool>,
    /// An error that no scope caught: the device cannot be trusted from then on.
    uncaught: Arc<Mutex<Option<String>>>,
    /// Nanoseconds spent on copying results out of the device's memory.
    readback: AtomicU64,
}

impl Guard {
    pub(super) fn new(device: wgpu::Device, queue: wgpu::Queue, name: &str) -> Self {
        let lost = Arc::new(AtomicBool::new(false));
        let uncaught = Arc::new(Mutex::new(None));
        let flag = lost.clone();
        device.set_device_lost_callback(move |_, _| flag.store(true, Ordering::SeqCst));
        let slot = uncaught.clone();
        device.on_uncaptured_error(Arc::new(move |error: wgpu::Error| {
            if let Ok(mut slot) = slot.lock() {
                slot.get_or_insert_with(|| error.to_string());
            }
        }));
        Self {
            device,
            queue,
            name: name.into(),
            lost,
            uncaught,
            readback: AtomicU64::new(0),
        }
    }

    fn lost_error(&self, what: &str) -> Error {
        Error::DeviceLost(format!("the device {} was lost ({what})", self.name))
    }

    /// Runs a call that wgpu may panic in.
    fn caught<T>(&self, what: &str, call: impl FnOnce() -> T) -> Result<T> {
        let outcome = catch(call).map_err(|_| self.lost_error(what))?;
        if self.lost.load(Ordering::SeqCst) {
            return Err(self.lost_error(what));
        }
        Ok(outcome)
    }

    /// Creates things on the device; what wgpu finds wrong with them becomes an error.
    pub fn scoped<T>(&self, create: impl FnOnce(&wgpu::Device) -> T) -> Result<T> {
        self.caught("while preparing", || {
            let memory = self.device.push_error_scope(wgpu::ErrorFilter::OutOfMemory);
            let internal = self.device.push_error_scope(wgpu::ErrorFilter::Internal);
            let validation = self.device.push_error_scope(wgpu::ErrorFilter::Validation);
            let made = create(&self.device);
            let faults = [validation, internal].map(|scope| pollster::block_on(scope.pop()));
            let full = pollster::block_on(memory.pop());
            if full.is_some() {
                let text = format!(
                    "the device {} has too little memory for this scene",
                    self.name
                );
                return Err(Error::Device(text + "; use a smaller one, or --device cpu"));
            }
            match faults.into_iter().flatten().next() {
                Some(fault) => Err(Error::Internal(format!("on {}: {fault}", self.name))),
                None => Ok(made),
            }
        })?
    }

    pub(super) fn buffer(&self, size: u64, usage: wgpu::BufferUsages) -> Result<wgpu::Buffer> {
        let descriptor = wgpu::BufferDescriptor {
            label: None,
            size,
            usage,
            mapped_at_creation: false,
        };
        self.scoped(|device| device.create_buffer(&descriptor))
    }

    pub(super) fn filled(&self, bytes: &[u8], usage: wgpu::BufferUsages) -> Result<wgpu::Buffer> {
        let buffer = self.buffer(bytes.len() as u64, usage | wgpu::BufferUsages::COPY_DST)?;
        self.caught("while uploading", || {
            self.queue.write_buffer(&buffer, 0, bytes)
        })?;
        Ok(buffer)
    }

    pub(super) fn bind(
        &self,
        layout: &wgpu::BindGroupLayout,
        buffers: &[&wgpu::Buffer],
    ) -> Result<wgpu::BindGroup> {
        let entries: Vec<_> = buffers
            .iter()
            .enumerate()
            .map(|(binding, buffer)| wgpu::BindGroupEntry {
                binding: binding as u32,
                resource: buffer.as_entire_binding(),
            })
            .collect();
        let descriptor = wgpu::BindGroupDescriptor {
            label: None,
            layout,
            entries: &entries,
        };
        self.scoped(|device| device.create_bind_group(&descriptor))
    }

    /// Starts the work that the commands hold.
    pub(super) fn submit(&self, commands: wgpu::CommandBuffer) -> Result<wgpu::SubmissionIndex> {
        self.caught("while submitting", || self.queue.submit([commands]))
    }

    /// Makes the device unusable, as a driver that is reset does: for tests of what happens then.
    pub(super) fn destroy(&self) {
        self.device.destroy();
    }

    /// Waits until what was submitted is done, at most `patience`.
    fn wait(&self, submission: &wgpu::SubmissionIndex, patience: Duration) -> Result<()> {
        let slices = patience.as_secs_f64() / SLICE.as_secs_f64();
        let poll = || wgpu::PollType::Wait {
            submission_index: Some(submission.clone()),
            timeout: Some(SLICE),
        };
        for _ in 0..slices.ceil() as u64 {
            match self.caught("while waiting", || self.device.poll(poll()))? {
                Ok(_) => return self.trusted(),
                Err(wgpu::PollError::Timeout) => {}
                Err(error) => return Err(self.lost_error(&error.to_string())),
            }
        }
        Err(self.lost_error(&format!("no answer for {} s", patience.as_secs())))
    }

    /// Refuses a device on which something failed that no scope caught.
    fn trusted(&self) -> Result<()> {
        let uncaught = self.uncaught.lock();
        match uncaught.map(|slot| slot.clone()).unwrap_or_default() {
            Some(text) => Err(Error::Internal(format!("on {}: {text}", self.name))),
            None => Ok(()),
        }
    }

    /// Time spent so far on copying results out of the device's memory.
    pub(super) fn readback(&self) -> Duration {
        Duration::from_nanos(self.readback.load(Ordering::Relaxed))
    }

    /// Waits for what was submitted, at most `patience`, and reads a staging buffer that it has written.
    pub(super) fn read<T: Pod>(
        &self,
        staging: &wgpu::Buffer,
        bytes: u64,
        submission: &wgpu::SubmissionIndex,
        patience: Duration,
    ) -> Result<Vec<T>> {
        let mapped = Arc::new(AtomicBool::new(false));
        let flag = mapped.clone();
        self.caught("while mapping", || {
            staging.map_async(wgpu::MapMode::Read, 0..bytes, move |outcome| {
                flag.store(outcome.is_ok(), Ordering::SeqCst);
            });
        })?;
        self.wait(submission, patience)?;
        if !mapped.load(Ordering::SeqCst) {
            return Err(self.lost_error("its memory could not be read"));
        }
        let started = Instant::now();
        let items = self.caught("while reading", || {
            staging
                .get_mapped_range(0..bytes)
                .map(|view| bytemuck::pod_collect_to_vec(&view))
        })?;
        self.caught("while unmapping", || staging.unmap())?;
        let took = started.elapsed().as_nanos() as u64;
        self.readback.fetch_add(took, Ordering::Relaxed);
        items.map_err(|fault| Error::Internal(format!("on {}: {fault}", self.name)))
    }
}
