//! The run itself: scene after scene, and in each scene turn after turn through the cells.

use super::effort::{Effort, one_size};
use super::measure::{Measured, calibrate, measure};
use super::order::{Axis, Cell, Order, Shaders, turn};
use super::report::{Gathered, Report, Status};
use super::subject::Subject;
use crate::error::{Error, Result};
use std::ops::ControlFlow;
use std::time::{Duration, Instant};

/// What is in hand.
#[derive(Clone, Debug)]
pub struct Step {
    pub scene: String,
    /// Device, preset and, where one was asked for, kernel.
    pub labels: Vec<String>,
    /// 0 is the turn that does not count.
    pub turn: u32,
    pub turns: u32,
    /// How much of the whole run is done, 0 to 1.
    pub share: f64,
    /// About how long the rest takes; none while that cannot be told.
    pub left: Option<Duration>,
}

/// Runs a benchmark; `watch` is called between dispatches and may stop it.
///
/// What was measured comes back even where a device was lost on the way, with that error beside it.
///
/// # Errors
/// Faults of scenes and knobs, before anything is measured.
pub fn run(
    order: &Order,
    watch: &mut dyn FnMut(&Step) -> ControlFlow<()>,
) -> Result<(Report, Result<()>)> {
    let primitives = primitives(order)?;
    let cells = order.cells();
    let mut runner = Runner {
        order,
        watch,
        started: Instant::now(),
        done: 0,
        all: order.subjects.len() * cells.len() * (order.repeats as usize + 1),
        stopped: false,
    };
    let mut report = Report::new(order);
    let mut outcome = Ok(());
    for (subject, primitives) in order.subjects.iter().zip(primitives) {
        let (found, trouble) = runner.subject(subject, &cells);
        report.add(order, subject, primitives, &found);
        outcome = outcome.and(trouble);
    }
    report.complete = !runner.stopped;
    Ok((report, outcome))
}

/// Of every subject, having built each scene that is going to be measured: faults are to be known first.
fn primitives(order: &Order) -> Result<Vec<usize>> {
    let mut counts = Vec::new();
    for subject in &order.subjects {
        let mut count = 0;
        for cell in order.cells().into_iter().filter(|cell| cell.device == 0) {
            let scene = order.scene(subject, cell)?;
            count = scene.spheres.len() + scene.boxes.len();
        }
        counts.push(count);
    }
    Ok(counts)
}

struct Runner<'a> {
    order: &'a Order,
    watch: &'a mut dyn FnMut(&Step) -> ControlFlow<()>,
    started: Instant,
    /// Measurements done, and all there are.
    done: usize,
    all: usize,
    stopped: bool,
}

impl Runner<'_> {
    fn subject(&mut self, subject: &Subject, cells: &[Cell]) -> (Vec<Gathered>, Result<()>) {
        let mut found: Vec<Gathered> = cells.iter().map(|cell| empty(*cell)).collect();
        let mut efforts: Vec<Option<Effort>> = vec![None; cells.len()];
        let places: Vec<usize> = (0..cells.len()).collect();
        let mut outcome = Ok(());
        for number in 0..=self.order.repeats {
            for place in turn(&places, number) {
                let taken = match (&found[place].trouble, self.stopped) {
                    (None, false) => self.one(subject, cells[place], number, &mut efforts[place]),
                    _ => Ok(None),
                };
                self.done += 1;
                match taken {
                    Ok(Some(measured)) if number == 0 => found[place].first_compile = measured.load,
                    Ok(measured) if number > 0 => found[place].turns.push(measured),
                    Ok(_) => {}
                    Err(error) => {
                        found[place].trouble = Some((status(&error), error.to_string()));
                        if !matches!(error, Error::Device(_)) {
                            outcome = outcome.and(Err(error));
                        }
                    }
                }
            }
            if number == 0 {
                self.compare_like_with_like(cells, &mut efforts);
            }
        }
        (found, outcome)
    }

    /// One size of picture for all that is measured on one device.
    fn compare_like_with_like(&self, cells: &[Cell], efforts: &mut [Option<Effort>]) {
        for device in 0..self.order.devices.len() {
            let cells = cells.iter().zip(efforts.iter_mut());
            let mine = cells.filter(|(cell, _)| cell.device == device);
            one_size(mine.filter_map(|(_, effort)| effort.as_mut()));
        }
    }

    /// One measurement of a cell on a device of its own: the first finds how much work it is.
    fn one(
        &mut self,
        subject: &Subject,
        cell: Cell,
        number: u32,
        effort: &mut Option<Effort>,
    ) -> Result<Option<Measured>> {
        let mut scene = self.order.scene(subject, cell)?;
        let mut device = self.order.devices[cell.device].open()?;
        if let (Some(then), Shaders::Then) = (&self.order.then, self.order.shaders()[cell.shaders])
        {
            device.use_shaders(then)?;
        }
        let mut step = self.step(subject, cell, number);
        let (done, all) = (self.done as f64, self.all as f64);
        let (watch, stopped) = (&mut self.watch, &mut self.stopped);
        let mut tell = |share: f64| {
            step.share = (done + share) / all;
            let flow = watch(&step);
            *stopped |= flow.is_break();
            flow
        };
        if tell(0.0).is_break() {
            return Ok(None);
        }
        match *effort {
            Some(effort) => measure(device.as_mut(), &mut scene, effort, &mut tell),
            None => {
                let wanted = self.order.seconds;
                let found = calibrate(device.as_mut(), &mut scene, wanted, &mut |_| tell(0.0))?;
                *effort = found.map(|(effort, _)| effort);
                Ok(found.map(|(_, first)| first))
            }
        }
    }

    fn step(&self, subject: &Subject, cell: Cell, number: u32) -> Step {
        let labels = Axis::ALL.into_iter();
        let share = self.done as f64 / self.all as f64;
        let elapsed = self.started.elapsed().as_secs_f64();
        let left = elapsed / share * (1.0 - share);
        Step {
            scene: subject.name(),
            labels: labels
                .filter_map(|axis| self.order.label(cell, axis))
                .collect(),
            turn: number,
            turns: self.order.repeats,
            share,
            left: (self.done >= 4).then(|| Duration::from_secs_f64(left)),
        }
    }
}

fn empty(cell: Cell) -> Gathered {
    Gathered {
        cell,
        first_compile: 0.0,
        turns: Vec::new(),
        trouble: None,
    }
}

fn status(error: &Error) -> Status {
    match error {
        Error::Device(_) => Status::Refused,
        _ => Status::Failed,
    }
}
