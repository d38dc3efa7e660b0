//! What is measured, and in which order.

use super::device::Bench;
use super::subject::Subject;
use crate::error::{Error, Result};
use crate::knobs::{Choice, Kind, Preset, find, nearest};
use crate::scene::{Assignment, Scene};
use crate::shader::Library;
use serde::{Deserialize, Serialize};

/// The knob that chooses a kernel, in builds that have several.
const KERNEL: &str = "render.kernel";
/// Knobs that are this command's own to set.
const OWN: [&str; 6] = [
    "image.width",
    "image.height",
    "render.samples",
    "render.seed",
    "render.preset",
    KERNEL,
];

/// What is compared within a run.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Axis {
    Device,
    Preset,
    Kernel,
    Shaders,
}

impl Axis {
    pub const ALL: [Self; 4] = [Self::Device, Self::Preset, Self::Kernel, Self::Shaders];

    pub fn name(self) -> &'static str {
        match self {
            Self::Device => "device",
            Self::Preset => "preset",
            Self::Kernel => "kernel",
            Self::Shaders => "shaders",
        }
    }
}

/// One value of each axis, by its place in [`Order`]'s list.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Cell {
    pub device: usize,
    pub preset: usize,
    pub kernel: usize,
    pub shaders: usize,
}

impl Cell {
    pub fn place(self, axis: Axis) -> usize {
        match axis {
            Axis::Device => self.device,
            Axis::Preset => self.preset,
            Axis::Kernel => self.kernel,
            Axis::Shaders => self.shaders,
        }
    }

    /// The cell that this one is held against on an axis: with the axis's first value, if it is another.
    pub fn base(self, axis: Axis) -> Option<Self> {
        let mut base = self;
        match axis {
            Axis::Device => base.device = 0,
            Axis::Preset => base.preset = 0,
            Axis::Kernel => base.kernel = 0,
            Axis::Shaders => base.shaders = 0,
        }
        (base != self).then_some(base)
    }
}

/// Shaders to trace by.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Shaders {
    /// Those of an earlier build.
    Then,
    /// This program's.
    Now,
}

impl Shaders {
    pub fn name(self) -> &'static str {
        match self {
            Self::Then => "then",
            Self::Now => "now",
        }
    }
}

/// A whole benchmark.
#[derive(Clone, Debug)]
pub struct Order {
    pub subjects: Vec<Subject>,
    pub devices: Vec<Bench>,
    pub presets: Vec<Preset>,
    /// None leaves the choice to the renderer.
    pub kernels: Vec<Option<String>>,
    /// An earlier build's shaders, to be measured in turns with this program's.
    pub then: Option<Library>,
    /// Knobs over what each scene says.
    pub assignments: Vec<Assignment>,
    /// Measurements of each cell, beside the first, which is thrown away.
    pub repeats: u32,
    /// About how long each takes.
    pub seconds: f64,
}

impl Order {
    /// Every cell, the last axis fastest.
    pub fn cells(&self) -> Vec<Cell> {
        let mut cells = Vec::new();
        for device in 0..self.devices.len() {
            for preset in 0..self.presets.len() {
                for kernel in 0..self.kernels.len() {
                    let shaders = 0..self.shaders().len();
                    cells.extend(shaders.map(|shaders| Cell {
                        device,
                        preset,
                        kernel,
                        shaders,
                    }));
                }
            }
        }
        cells
    }

    /// The values of the axis of shaders.
    pub fn shaders(&self) -> &'static [Shaders] {
        match self.then {
            Some(_) => &[Shaders::Then, Shaders::Now],
            None => &[Shaders::Now],
        }
    }

    /// Whether an axis has more than one value.
    pub fn several(&self, axis: Axis) -> bool {
        let values = match axis {
            Axis::Device => self.devices.len(),
            Axis::Preset => self.presets.len(),
            Axis::Kernel => self.kernels.len(),
            Axis::Shaders => self.shaders().len(),
        };
        values > 1
    }

    /// How a cell's value is called.
    pub fn label(&self, cell: Cell, axis: Axis) -> Option<String> {
        match axis {
            Axis::Device => Some(self.devices[cell.device].label.clone()),
            Axis::Preset => Some(self.presets[cell.preset].to_string()),
            Axis::Kernel => self.kernels[cell.kernel].clone(),
            Axis::Shaders => Some(self.shaders()[cell.shaders].name().into()),
        }
    }

    /// A subject's scene as a cell wants it.
    ///
    /// # Errors
    /// Faults of the scene and of the assignments; [`Error::Usage`] for a knob that is not free.
    pub fn scene(&self, subject: &Subject, cell: Cell) -> Result<Scene> {
        let taken = |set: &&Assignment| OWN.contains(&set.path.as_str());
        if let Some(set) = self.assignments.iter().find(taken) {
            return Err(Error::Usage(format!(
                "{}: bench chooses {} itself; see --preset, --kernel and --seconds",
                set.flag, set.path
            )));
        }
        let preset = self.presets[cell.preset].to_string();
        let flag = format!("--preset {preset}");
        let mut assignments = vec![Assignment::new("render.preset", preset, flag)];
        if let Some(kernel) = &self.kernels[cell.kernel] {
            let flag = format!("--kernel {kernel}");
            assignments.push(Assignment::new(KERNEL, kernel, flag));
        }
        assignments.extend(self.assignments.iter().cloned());
        subject.scene(&assignments)
    }
}

/// The cells of a turn: there and back again, so that a drift of the machine falls on all alike.
pub fn turn<T: Copy>(cells: &[T], number: u32) -> Vec<T> {
    let forth = cells.iter().copied();
    match number % 2 {
        0 => forth.collect(),
        _ => forth.rev().collect(),
    }
}

/// The presets of these names, each once; `all` is all of them.
///
/// # Errors
/// [`Error::Usage`] with the nearest name.
pub fn presets(names: &[String]) -> Result<Vec<Preset>> {
    let chosen = choose("--preset", names, Preset::NAMES)?;
    Ok(chosen
        .iter()
        .filter_map(|name| Preset::from_name(name))
        .collect())
}

/// The kernels of these names as the table of knobs has them; without names, the renderer's own choice.
///
/// # Errors
/// [`Error::Usage`] with the nearest name, or where there is but one kernel.
pub fn kernels(names: &[String]) -> Result<Vec<Option<String>>> {
    if names.is_empty() {
        return Ok(vec![None]);
    }
    let Some(Kind::Choice(known)) = find(KERNEL).map(|target| target.knob.kind) else {
        return Err(Error::Usage(
            "--kernel: this build has one kernel and no knob render.kernel to choose by".into(),
        ));
    };
    Ok(choose("--kernel", names, known)?
        .into_iter()
        .map(Some)
        .collect())
}

fn choose(flag: &str, names: &[String], known: &[&str]) -> Result<Vec<String>> {
    let mut chosen: Vec<String> = Vec::new();
    for name in names {
        let found: Vec<&str> = match name.as_str() {
            "all" => known.to_vec(),
            other => known
                .iter()
                .copied()
                .filter(|known| *known == other)
                .collect(),
        };
        if found.is_empty() {
            let near = nearest(name, known.iter().copied());
            let near = near.map_or(String::new(), |near| format!("; did you mean {near}?"));
            return Err(Error::Usage(format!(
                "{flag} {name}: there are {}, all{near}",
                known.join(", ")
            )));
        }
        for name in found {
            if !chosen.iter().any(|other| other == name) {
                chosen.push(name.into());
            }
        }
    }
    Ok(chosen)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn names(text: &str) -> Vec<String> {
        text.split_whitespace().map(String::from).collect()
    }

    #[test]
    fn turns_go_there_and_back() {
        let order: Vec<u32> = (0..3).flat_map(|number| turn(&[1, 2, 3], number)).collect();
        assert_eq!(order, [1, 2, 3, 3, 2, 1, 1, 2, 3]);
        assert!(turn::<u32>(&[], 1).is_empty());
    }

    #[test]
    fn a_cell_is_held_against_the_first_value_of_one_axis() {
        let cell = Cell {
            device: 1,
            preset: 0,
            kernel: 2,
            shaders: 0,
        };
        let base = cell.base(Axis::Device).unwrap();
        assert_eq!((base.device, base.preset, base.kernel), (0, 0, 2));
        assert_eq!(cell.base(Axis::Preset), None);
        assert_eq!(cell.base(Axis::Kernel).unwrap().kernel, 0);
    }

    #[test]
    fn presets_come_once_each() {
        let two = presets(&names("paper reference paper")).unwrap();
        assert_eq!(two, [Preset::Paper, Preset::Reference]);
        assert_eq!(presets(&names("all")).unwrap().len(), 4);
        let error = presets(&names("papr")).unwrap_err().to_string();
        assert!(error.contains("did you mean paper?"), "{error}");
    }

    #[test]
    fn kernels_are_those_of_the_table_of_knobs() {
        assert_eq!(kernels(&[]).unwrap(), [None]);
        match find(KERNEL).map(|target| target.knob.kind) {
            Some(Kind::Choice(known)) => {
                let all = kernels(&names("all")).unwrap();
                assert_eq!(all.len(), known.len());
                assert!(kernels(&names("nonesuch")).is_err());
            }
            _ => assert!(kernels(&names("all")).is_err()),
        }
    }
}
