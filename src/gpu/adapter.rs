//! Which graphics devices there are.

use crate::device::{DeviceInfo, DeviceKind};

/// The graphics devices of this machine, hardware first; their order is stable.
#[derive(Debug)]
pub struct Adapters {
    list: Vec<(wgpu::Adapter, DeviceInfo)>,
}

/// Asks every driver of this machine for its devices.
pub fn adapters() -> Adapters {
    let backends = wgpu::Backends::VULKAN | wgpu::Backends::METAL | wgpu::Backends::DX12;
    let mut descriptor = wgpu::InstanceDescriptor::new_without_display_handle();
    descriptor.backends = backends;
    descriptor.flags = wgpu::InstanceFlags::empty();
    let instance = wgpu::Instance::new(descriptor);
    let found = pollster::block_on(instance.enumerate_adapters(backends));
    let mut list: Vec<_> = found
        .into_iter()
        .map(|adapter| {
            let info = describe(&adapter.get_info());
            (adapter, info)
        })
        .collect();
    list.sort_by(|(_, a), (_, b)| (a.kind, &a.pci, &a.name).cmp(&(b.kind, &b.pci, &b.name)));
    Adapters { list }
}

impl Adapters {
    pub fn infos(&self) -> impl Iterator<Item = &DeviceInfo> {
        self.list.iter().map(|(_, info)| info)
    }

    /// The adapter at a place of [`Adapters::infos`].
    pub(super) fn get(&self, index: usize) -> Option<&(wgpu::Adapter, DeviceInfo)> {
        self.list.get(index)
    }
}

fn describe(info: &wgpu::AdapterInfo) -> DeviceInfo {
    let kind = match info.device_type {
        wgpu::DeviceType::Cpu => DeviceKind::Software,
        _ => DeviceKind::Hardware,
    };
    DeviceInfo {
        kind,
        name: info.name.clone(),
        driver: format!("{} {}", info.driver, info.driver_info)
            .trim()
            .to_string(),
        backend: info.backend.to_str().to_string(),
        pci: info.device_pci_bus_id.to_lowercase(),
    }
}
