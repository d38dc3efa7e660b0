//! Ratios to an earlier run's times, which are worth less than those inside one: where the earlier run's shaders
//! still fit, they are measured again, in turns with this program's ([`super::Axis::Shaders`]).

use super::order::Shaders;
use super::report::{Report, Row};
use serde::{Deserialize, Serialize};

/// A run beside an earlier one.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Against {
    /// Where the earlier run was read from.
    pub file: String,
    /// Whether both were made on machines that call themselves the same.
    pub same_machine: bool,
    /// Whether both ran the same shaders.
    pub same_shaders: bool,
    pub comparisons: Vec<Comparison>,
    /// Rows that were measured and have no counterpart there.
    pub unmatched: usize,
}

/// A row beside the one of the same scene, preset and kernel.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Comparison {
    pub scene: String,
    pub device: String,
    pub preset: String,
    pub kernel: Option<String>,
    /// The earlier row's device.
    pub to: String,
    pub same_device: bool,
    /// Median to median of rays a second. The turns were not paired.
    pub mrays: f64,
    /// What the ratio would be if each run were at its worse or better quartile.
    pub quartiles: [f64; 2],
}

impl Against {
    pub fn new(now: &Report, then: &Report, file: &str) -> Self {
        let measured = || {
            let rows = now.rows.iter();
            rows.filter(|row| row.figures.is_some() && is_of_its_own(row))
        };
        let comparisons: Vec<_> = measured()
            .filter_map(|row| compared(row, counterpart(row, then)?))
            .collect();
        Self {
            file: file.into(),
            same_machine: now.machine == then.machine,
            same_shaders: now.shader_hash == then.shader_hash,
            unmatched: measured().count() - comparisons.len(),
            comparisons,
        }
    }
}

/// Whether a row was traced by the shaders of the program that measured it.
fn is_of_its_own(row: &Row) -> bool {
    row.shaders.as_deref() != Some(Shaders::Then.name())
}

/// The earlier row of the same device, or, where that run had but one device, of that.
fn counterpart<'a>(row: &Row, then: &'a Report) -> Option<&'a Row> {
    let alike = |other: &&Row| {
        other.figures.is_some()
            && is_of_its_own(other)
            && (&other.scene, other.primitives) == (&row.scene, row.primitives)
            && (&other.preset, &other.kernel) == (&row.preset, &row.kernel)
    };
    let mut rows = then.rows.iter().filter(alike);
    let same = rows
        .clone()
        .find(|other| other.device_info.is_like(&row.device_info));
    same.or_else(|| match (rows.next(), rows.next()) {
        (Some(only), None) => Some(only),
        _ => None,
    })
}

fn compared(now: &Row, then: &Row) -> Option<Comparison> {
    let (new, old) = (&now.figures.as_ref()?.mrays, &then.figures.as_ref()?.mrays);
    Some(Comparison {
        scene: now.scene.clone(),
        device: now.device.clone(),
        preset: now.preset.clone(),
        kernel: now.kernel.clone(),
        to: then.device.clone(),
        same_device: now.device_info.is_like(&then.device_info),
        mrays: new.median / old.median,
        quartiles: [
            new.quartiles[0] / old.quartiles[1],
            new.quartiles[1] / old.quartiles[0],
        ],
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bench::{Order, Subject, benches, run};
    use crate::knobs::Preset;
    use std::ops::ControlFlow;

    fn report(devices: &[&str]) -> Report {
        let names: Vec<String> = devices.iter().map(|name| (*name).into()).collect();
        let order = Order {
            subjects: vec![Subject::Room(1), Subject::Room(2)],
            devices: benches(&names).unwrap(),
            presets: vec![Preset::Reference],
            kernels: vec![None],
            then: None,
            assignments: Vec::new(),
            repeats: 1,
            seconds: 1e-4,
        };
        let (report, outcome) = run(&order, &mut |_| ControlFlow::Continue(())).unwrap();
        outcome.unwrap();
        report
    }

    #[test]
    fn rows_find_their_counterparts() {
        let report = report(&["cpu"]);
        let own = Against::new(&report, &report, "x.json");
        assert_eq!((own.comparisons.len(), own.unmatched), (2, 0));
        assert!(own.same_machine && own.same_shaders);
        for one in &own.comparisons {
            assert_eq!((one.mrays, one.same_device), (1.0, true));
        }
    }

    #[test]
    fn another_device_is_said_and_other_scenes_are_counted() {
        let now = report(&["cpu"]);
        let mut then = now.clone();
        then.rows.remove(0);
        then.rows[0].device_info.driver = "another".into();
        then.machine.threads += 1;
        let against = Against::new(&now, &then, "x.json");
        assert_eq!((against.comparisons.len(), against.unmatched), (1, 1));
        assert!(!against.same_machine && !against.comparisons[0].same_device);
        let mut two = then.clone();
        two.rows.push(two.rows[0].clone());
        let against = Against::new(&now, &two, "x.json");
        assert_eq!(
            against.comparisons.len(),
            0,
            "which of the two is meant cannot be told"
        );
    }
}
