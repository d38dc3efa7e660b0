use super::{Output, Result, print};
use crate::device::DeviceKind;
use crate::render::{VULKAN_HINT, devices, word};
use clap::Args;

/// List what could render here
#[derive(Args)]
#[command(
    after_help = "Example:\n  lampray devices\n  lampray render scenes/cornell.toml --device 0"
)]
pub(crate) struct Command {}

impl Command {
    pub(crate) fn run(self, output: Output) -> Result<()> {
        let list = devices();
        if output.json {
            let rows: Vec<_> = list
                .iter()
                .enumerate()
                .map(|(index, info)| serde_json::json!({ "index": index, "device": device_value(index, info), "info": info }))
                .collect();
            return print(&format!("{:#}\n", serde_json::Value::Array(rows)));
        }
        let mut text = String::from("--device    kind      name\n");
        for (index, info) in list.iter().enumerate() {
            let value = device_value(index, info);
            text += &format!("{value:<11} {:<9} {}", word(info.kind), info.name);
            if info.kind != DeviceKind::Cpu {
                text += &format!(" ({}, {})", info.backend, info.driver);
            }
            if !info.pci.is_empty() {
                text += &format!(" pci:{}", info.pci);
            }
            text.push('\n');
        }
        if list.len() == 1 {
            text += &format!("\nNo Vulkan device was found. {}.\n", capital(VULKAN_HINT));
        }
        print(&text)
    }
}

/// What `--device` takes for it: its number, or `cpu`.
fn device_value(index: usize, info: &crate::device::DeviceInfo) -> String {
    if info.kind == DeviceKind::Cpu {
        "cpu".into()
    } else {
        index.to_string()
    }
}

fn capital(text: &str) -> String {
    text[..1].to_uppercase() + &text[1..]
}
