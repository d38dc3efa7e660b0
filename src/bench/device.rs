//! The devices that are measured.

use crate::device::{Device, DeviceInfo, DeviceKind, DeviceRequest};
use crate::error::Result;
use crate::render;

/// A device, as it was asked for, so that each measurement can open it anew.
#[derive(Clone, Debug)]
pub struct Bench {
    /// Short, and of this run's devices it alone has it.
    pub label: String,
    pub request: DeviceRequest,
    pub info: DeviceInfo,
    /// Why it is this one, where nobody asked for it by name.
    pub remark: Option<String>,
}

impl Bench {
    fn new(request: DeviceRequest) -> Result<Self> {
        let chosen = render::open(&request, None)?;
        let info = chosen.device.info().clone();
        Ok(Self {
            label: label(&info),
            request,
            info,
            remark: chosen.remark,
        })
    }

    /// # Errors
    /// As [`render::open`].
    pub fn open(&self) -> Result<Box<dyn Device>> {
        Ok(render::open(&self.request, None)?.device)
    }
}

/// The devices of these names, as `--device` takes them; `all` is each that is here and opens. A
/// device may come twice: the ratio of a device to itself shows what the machine's noise does.
///
/// # Errors
/// As [`render::open`].
pub fn benches(names: &[String]) -> Result<Vec<Bench>> {
    let mut found = Vec::new();
    for name in names {
        if name == "all" {
            let each = 0..render::devices().len();
            found.extend(each.filter_map(|index| Bench::new(DeviceRequest::Index(index)).ok()));
        } else {
            found.push(Bench::new(name.parse()?)?);
        }
    }
    tell_apart(&mut found);
    Ok(found)
}

/// The name without what stands in brackets after it.
fn label(info: &DeviceInfo) -> String {
    match info.kind {
        DeviceKind::Cpu => "cpu".into(),
        _ => info.name.split(" (").next().unwrap_or_default().into(),
    }
}

/// Numbers those that share a label.
fn tell_apart(benches: &mut [Bench]) {
    let labels: Vec<String> = benches.iter().map(|bench| bench.label.clone()).collect();
    for (index, bench) in benches.iter_mut().enumerate() {
        let before = labels[..index]
            .iter()
            .filter(|label| **label == bench.label);
        let number = before.count() + 1;
        if number > 1 {
            bench.label += &format!(" #{number}");
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn devices_that_come_twice_are_told_apart() {
        let names = ["cpu".to_string(), "cpu".to_string()];
        let labels: Vec<String> = benches(&names)
            .unwrap()
            .into_iter()
            .map(|bench| bench.label)
            .collect();
        assert_eq!(labels, ["cpu", "cpu #2"]);
        assert!(benches(&["no such device".into()]).is_err());
    }

    #[test]
    fn all_ends_with_the_cpu_twin() {
        let all = benches(&["all".into()]).unwrap();
        assert_eq!(all.last().unwrap().info.kind, DeviceKind::Cpu);
    }
}
