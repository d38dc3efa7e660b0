//! From `--device` to a device.

use super::memory::refuse_drivers;
use crate::cpu::{self, Cpu};
use crate::device::{Device, DeviceInfo, DeviceKind, DeviceRequest};
use crate::doctor;
use crate::error::{Error, Result};
use crate::gpu::{Adapters, Gpu, adapters};

/// How to get a software Vulkan driver, for messages.
pub const VULKAN_HINT: &str = "for Vulkan on the CPU install mesa-vulkan-drivers (openSUSE: libvulkan_lvp, Arch: vulkan-swrast)";

/// Every device of this machine, in the order of their numbers: graphics devices, hardware first,
/// then the CPU twin.
pub fn devices() -> Vec<DeviceInfo> {
    let found = refuse_drivers().ok().map(|()| adapters());
    let graphics = found.iter().flat_map(Adapters::infos);
    graphics.cloned().chain([cpu::info()]).collect()
}

/// A device and, where the user should know of it, one line on why it is this one.
pub struct Chosen {
    pub device: Box<dyn Device>,
    pub remark: Option<String>,
}

/// What a graphics device must pass before it is chosen.
type Entry = fn(&mut dyn Device) -> Result<()>;

/// Opens what was asked for; `require` refuses every other kind. A graphics device that this program has
/// not met under its driver is examined first ([`doctor::trust`]): where any device will do the next one is
/// taken in the place of one that fails, and the remark says so.
///
/// # Errors
/// [`Error::Device`] with what is there and what is missing, or with the canary that failed.
pub fn open(request: &DeviceRequest, require: Option<DeviceKind>) -> Result<Chosen> {
    open_after(request, require, doctor::trust)
}

/// [`open`] for who examines the device anyway.
///
/// # Errors
/// As [`open`].
pub fn open_unexamined(request: &DeviceRequest, require: Option<DeviceKind>) -> Result<Chosen> {
    open_after(request, require, |_| Ok(()))
}

fn open_gpu(found: &Adapters, index: usize, entry: Entry) -> Result<Box<dyn Device>> {
    let mut gpu = Gpu::open(found, index)?;
    entry(&mut gpu)?;
    Ok(Box::new(gpu))
}

fn open_after(
    request: &DeviceRequest,
    require: Option<DeviceKind>,
    entry: Entry,
) -> Result<Chosen> {
    if *request == DeviceRequest::Cpu {
        return finish(
            Chosen {
                device: Box::new(Cpu::new()),
                remark: None,
            },
            require,
        );
    }
    if let Err(error) = refuse_drivers() {
        return match (request, require) {
            (DeviceRequest::Auto, None | Some(DeviceKind::Cpu)) => Ok(Chosen {
                device: Box::new(Cpu::new()),
                remark: Some(format!("{error}; rendering with the built-in CPU renderer")),
            }),
            _ => Err(error),
        };
    }
    let found = adapters();
    let infos: Vec<_> = found.infos().cloned().collect();
    let chosen = match request {
        DeviceRequest::Auto => open_best(&found, &infos, require, entry)?,
        DeviceRequest::Index(index) if *index == infos.len() => Chosen {
            device: Box::new(Cpu::new()),
            remark: None,
        },
        _ => {
            let index = infos
                .iter()
                .enumerate()
                .position(|(index, info)| matches(request, index, info))
                .ok_or_else(|| missing(request, &infos))?;
            Chosen {
                device: open_gpu(&found, index, entry)?,
                remark: None,
            }
        }
    };
    finish(chosen, require)
}

/// The best there is: a GPU, else a software driver, else the CPU twin. A driver that refuses is
/// passed over, and the remark says so.
fn open_best(
    found: &Adapters,
    infos: &[DeviceInfo],
    require: Option<DeviceKind>,
    entry: Entry,
) -> Result<Chosen> {
    let mut refused = Vec::new();
    for (index, info) in infos.iter().enumerate() {
        if require.is_some_and(|kind| kind != info.kind) {
            continue;
        }
        match open_gpu(found, index, entry) {
            Ok(device) => {
                let remark = passed_over(&refused, info);
                return Ok(Chosen { device, remark });
            }
            Err(error @ Error::Usage(_)) => return Err(error),
            Err(error) => refused.push(error.to_string()),
        }
    }
    if let Some(kind) = require.filter(|kind| *kind != DeviceKind::Cpu) {
        return Err(match refused.is_empty() {
            true => missing_kind(kind, infos),
            false => Error::Device(refused.join("; ")),
        });
    }
    let mut remark =
        format!("no Vulkan device: rendering with the built-in CPU renderer ({VULKAN_HINT})");
    if !refused.is_empty() {
        remark = format!(
            "{}; rendering with the built-in CPU renderer",
            refused.join("; ")
        );
    }
    Ok(Chosen {
        device: Box::new(Cpu::new()),
        remark: Some(remark),
    })
}

/// What is to be said of a graphics device that was taken when others refused.
fn passed_over(refused: &[String], info: &DeviceInfo) -> Option<String> {
    match (refused, info.kind) {
        ([], DeviceKind::Software) => Some(format!(
            "no GPU: rendering on software Vulkan, {}",
            info.name
        )),
        ([], _) => None,
        (refused, _) => Some(format!(
            "{}; rendering on {}",
            refused.join("; "),
            info.name
        )),
    }
}

fn finish(chosen: Chosen, require: Option<DeviceKind>) -> Result<Chosen> {
    let info = chosen.device.info();
    match require {
        Some(kind) if kind != info.kind => Err(Error::Device(format!(
            "--require {} is not met: the device chosen is {} ({})",
            word(kind),
            info.name,
            word(info.kind)
        ))),
        _ => Ok(chosen),
    }
}

fn matches(request: &DeviceRequest, index: usize, info: &DeviceInfo) -> bool {
    match request {
        DeviceRequest::Hardware => info.kind == DeviceKind::Hardware,
        DeviceRequest::Software => info.kind == DeviceKind::Software,
        DeviceRequest::Index(wanted) => *wanted == index,
        DeviceRequest::Name(name) => info.name.to_lowercase().contains(&name.to_lowercase()),
        DeviceRequest::Pci(address) => info.pci == *address,
        DeviceRequest::Auto | DeviceRequest::Cpu => false,
    }
}

/// `hardware`, `software` or `cpu`.
pub fn word(kind: DeviceKind) -> &'static str {
    match kind {
        DeviceKind::Hardware => "hardware",
        DeviceKind::Software => "software",
        DeviceKind::Cpu => "cpu",
    }
}

fn there(infos: &[DeviceInfo]) -> String {
    let graphics = infos
        .iter()
        .enumerate()
        .map(|(index, info)| format!("{index} {}", info.name));
    let all: Vec<_> = graphics
        .chain([format!("{} {}", infos.len(), cpu::info().name)])
        .collect();
    format!("there are: {}", all.join(", "))
}

fn missing(request: &DeviceRequest, infos: &[DeviceInfo]) -> Error {
    match request {
        DeviceRequest::Hardware => missing_kind(DeviceKind::Hardware, infos),
        DeviceRequest::Software => missing_kind(DeviceKind::Software, infos),
        DeviceRequest::Index(index) => {
            Error::Device(format!("there is no device {index}; {}", there(infos)))
        }
        DeviceRequest::Name(name) => Error::Device(format!(
            "no device has \"{name}\" in its name; {}",
            there(infos)
        )),
        DeviceRequest::Pci(address) => Error::Device(format!(
            "no device has the PCI address {address}; {}",
            there(infos)
        )),
        DeviceRequest::Auto | DeviceRequest::Cpu => Error::Internal("no device was chosen".into()),
    }
}

fn missing_kind(kind: DeviceKind, infos: &[DeviceInfo]) -> Error {
    let remedy = match kind {
        DeviceKind::Hardware => {
            "install the GPU's Vulkan driver, or leave the choice to --device auto"
        }
        _ => VULKAN_HINT,
    };
    Error::Device(format!(
        "there is no {} Vulkan device; {}; {remedy}",
        word(kind),
        there(infos)
    ))
}
