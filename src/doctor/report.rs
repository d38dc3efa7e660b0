//! An examination as text.

use super::{Examination, Finding};
use crate::device::{DeviceKind, Limits};
use std::fmt::Write;

/// The device, its limits, and a line a canary.
pub fn table(examination: &Examination) -> String {
    let info = &examination.device;
    let mut text = format!("device    {}\n", info.name);
    let kind = match info.kind {
        DeviceKind::Hardware => "hardware",
        DeviceKind::Software => "software",
        DeviceKind::Cpu => "cpu",
    };
    let pci = match info.pci.as_str() {
        "" => String::new(),
        pci => format!(", pci:{pci}"),
    };
    text += &format!("kind      {kind}{pci}\n");
    text += &format!("driver    {} ({})\n", info.driver, info.backend);
    if let Some(limits) = &examination.limits {
        text += &format!("limits    {}\n", spelled(limits));
    }
    text.push_str("\ncanary      result  found\n");
    text.extend(examination.canaries.iter().map(line));
    let failed = examination
        .canaries
        .iter()
        .filter(|finding| !finding.ok)
        .count();
    let asked = examination
        .canaries
        .iter()
        .filter(|finding| finding.applies)
        .count();
    text.push('\n');
    text += &match failed {
        0 => format!("{asked} canaries, all as expected\n"),
        failed => {
            format!("{failed} of {asked} canaries FAILED: pictures of this device would be wrong\n")
        }
    };
    text
}

fn line(finding: &Finding) -> String {
    let Finding {
        name,
        ok,
        applies,
        expected,
        found,
    } = finding;
    let result = match (applies, ok) {
        (false, _) => "-",
        (true, true) => "ok",
        (true, false) => "FAILED",
    };
    let mut line = format!("{name:<11} {result:<7} {found}\n");
    if !ok {
        // Writing to a string cannot fail.
        let _ = writeln!(line, "{:<19} expected: {expected}", "");
    }
    line
}

fn spelled(limits: &Limits) -> String {
    let loops = match limits.loop_iterations {
        Some(most) => format!(", at most {most} loop iterations planned"),
        None => String::new(),
    };
    format!(
        "{} MiB a binding, {} MiB a buffer, {} groups along an axis, {} lanes a group{loops}",
        limits.storage_binding >> 20,
        limits.buffer >> 20,
        limits.groups,
        limits.group_lanes
    )
}
