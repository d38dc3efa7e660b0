//! The loop that feeds a device with blocks and adds up what comes back.

mod adaptive;
mod choose;
mod endure;
mod feed;
mod look;
mod memory;
mod pace;
mod picture;
mod plan;
mod rendering;

pub use adaptive::RULE as ADAPTIVE_RULE;
pub use choose::{Chosen, VULKAN_HINT, devices, open, open_unexamined, word};
pub use endure::{Spares, endure};
pub use memory::{memory_estimate, refuse_too_large};
pub use picture::{picture, record, scene_hash};
pub use plan::Plan;
pub use rendering::Rendering;

use crate::cpu::pilot::Pilot;
use crate::device::Device;
use crate::error::{Error, Result};
use crate::film::{Film, SCOUTS, Stop};
use crate::knobs::{InterruptionRule, Sequence};
use crate::pack::{Packed, Rect, Traversal};
use crate::scene::Scene;
use adaptive::{Goals, Work};
use feed::{Fed, Supply, feed};
use std::ops::{ControlFlow, Range};
use std::sync::OnceLock;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{Receiver, RecvTimeoutError, Sender, channel, sync_channel};
use std::thread;
use std::time::Duration;

/// How often somebody who watches a render is asked at least.
const TICK: Duration = Duration::from_millis(100);

/// What is to be rendered of a scene.
#[derive(Clone, Debug)]
pub struct Task<'a> {
    pub scene: &'a Scene,
    /// The part of the image, in its own pixels.
    pub region: Rect,
    /// Which samples of each pixel.
    pub samples: Range<u64>,
    /// Whether first-hit features are wanted too.
    pub features: bool,
    /// Whether its picture is denoised, which takes memory.
    pub denoised: bool,
    /// How rays find bodies.
    pub traversal: Traversal,
    /// The error, relative to the mean, at which the render may stop before its last sample: see
    /// [`crate::film::Film::relative_error`].
    pub target_error: Option<f64>,
    /// Whether the samples go where the error is, in the place of evenly over the picture; only beside a target
    /// error.
    pub adaptive: bool,
    /// How many samples each pixel of the region gets, row by row, where that is known: those of a picture that was
    /// stopped and is rendered again. Without a target error, and none more than there are.
    pub counts: Option<Vec<u64>>,
    /// What [`Task::pilot`] found, once somebody has asked.
    pub pilot: OnceLock<Pilot>,
}

impl<'a> Task<'a> {
    /// The whole image with all of its samples.
    pub fn new(scene: &'a Scene) -> Self {
        Self {
            scene,
            region: whole(scene),
            samples: 0..scene.settings.render.samples,
            features: false,
            denoised: false,
            traversal: Traversal::of(scene),
            target_error: None,
            adaptive: false,
            counts: None,
            pilot: OnceLock::new(),
        }
    }

    /// [`Task::new`] for one of many scenes whose values differ: nothing is compiled for this one alone
    /// unless its knobs ask for it.
    pub fn one_of_many(scene: &'a Scene) -> Self {
        Self {
            traversal: Traversal::of_one_of_many(scene),
            ..Self::new(scene)
        }
    }
}

impl Task<'_> {
    /// What the pilot of the rule `efficiency` finds, for the picture as a whole; none by any other rule. It is
    /// traced when somebody first asks, by the CPU twin whatever the device.
    pub fn pilot(&self) -> Option<&Pilot> {
        let (image, interruption) = (
            &self.scene.settings.image,
            &self.scene.settings.interruption,
        );
        let trace = || {
            let packed = Packed::by(self.scene, self.traversal);
            Pilot::new(&packed, [image.width, image.height])
        };
        (interruption.rule == InterruptionRule::Efficiency).then(|| self.pilot.get_or_init(trace))
    }

    /// The scene as devices take it.
    pub fn packed(&self) -> Packed {
        let mut packed = Packed::by(self.scene, self.traversal);
        if let Some(pilot) = self.pilot() {
            packed.worths.clone_from(&pilot.worths);
        }
        packed
    }

    /// Paths of all of it.
    pub fn paths(&self) -> u64 {
        if let Some(counts) = &self.counts {
            return counts.iter().copied().fold(0, u64::saturating_add);
        }
        let samples = self.samples.end - self.samples.start;
        (self.region.area() as u64).saturating_mul(samples)
    }

    /// A film for it, without samples.
    fn film(&self) -> Film {
        let render = &self.scene.settings.render;
        let shared = render.sequence == Sequence::BlueNoise;
        match render.randomisation() {
            None => Film::new(self.region),
            Some(length) => Film::of_randomisations(self.region, length, shared),
        }
    }

    /// Refuses a range that begins inside a randomisation: what is left of that is not spread as the whole is, and
    /// whoever has the other part would count it twice.
    ///
    /// # Errors
    /// [`Error::Usage`] with the nearest range that begins where one does.
    pub fn refuse_cut(&self) -> Result<()> {
        let render = &self.scene.settings.render;
        let Range { start, end } = self.samples;
        let length = render.randomisation().unwrap_or(1);
        let before = start - start % length;
        if before == start {
            return Ok(());
        }
        Err(Error::Usage(format!(
            "samples {start}..{end} begin inside a randomisation: with render.sequence = {} and {} samples planned it is {length} samples long; give --sample-range {before}..{end}",
            render.sequence, render.samples
        )))
    }

    /// Refuses samples where the error is that are not independent: their errors are known by whole
    /// randomisations, not by tiles.
    ///
    /// # Errors
    /// [`Error::Usage`] with both ways out.
    pub fn refuse_adaptive(&self) -> Result<()> {
        let render = &self.scene.settings.render;
        if self.terms().is_none() || render.sequence == Sequence::Independent {
            return Ok(());
        }
        Err(Error::Usage(format!(
            "--target-error shares out samples, which must be independent for that: render.sequence is {}; add --even, or set render.sequence=independent",
            render.sequence
        )))
    }

    /// What adaptive sampling goes by, where it is wanted.
    fn terms(&self) -> Option<adaptive::Terms> {
        let target = self.target_error.filter(|_| self.adaptive)?;
        Some(adaptive::Terms {
            samples: self.samples.clone(),
            target,
        })
    }

    /// What is left of it where each pixel's samples are known.
    fn counted(&self, film: &Film) -> Option<Work> {
        let counts = self.counts.clone()?;
        let taken = film.counts.clone();
        Some(Work::new(
            self.region,
            self.samples.clone(),
            taken,
            Goals::Pixels(counts),
            look::FIRST,
        ))
    }

    /// What is left of it where a film has some. Of an adaptive render, and where pixels' samples are known, it is the
    /// pace alone: the work comes piece by piece.
    ///
    /// # Errors
    /// [`Error::Internal`] for a film that this task cannot have left so; [`Error::Usage`] for samples that decide
    /// on their own number.
    fn rest(&self, rendering: &Rendering) -> Result<Plan> {
        self.refuse_cut()?;
        let film = &rendering.film;
        let samples = self.samples.clone();
        let stray = || Error::Internal("the film is of another render".into());
        if film.region != self.region {
            return Err(stray());
        }
        if let Some(counts) = &self.counts {
            let fits = counts.len() == film.counts.len() && self.target_error.is_none();
            let work = self.counted(film).filter(|work| fits && work.is_possible());
            return work
                .map(|_| Plan::new(self.region, samples))
                .ok_or_else(stray);
        }
        match (self.terms(), &rendering.scouts) {
            (Some(_), _) if samples.end > SCOUTS => Err(Error::Usage(
                "adaptive sampling decides by samples from 2^63 on: end the range of samples below, or sample evenly".into(),
            )),
            (Some(terms), Some(scouts)) => adaptive::is_possible(&terms, film, scouts)
                .then(|| Plan::new(self.region, samples))
                .ok_or_else(stray),
            (None, None) => {
                let plan = Plan::resume(self.region, samples, &film.counts).ok_or_else(stray)?;
                Ok(match self.target_error {
                    Some(_) => plan.with_looks(),
                    None => plan,
                })
            }
            _ => Err(stray()),
        }
    }
}

/// All pixels of a scene's image.
pub fn whole(scene: &Scene) -> Rect {
    let image = &scene.settings.image;
    Rect {
        x0: 0,
        y0: 0,
        x1: image.width,
        y1: image.height,
    }
}

/// Who watches a render: asked after each block and several times a second, and may stop it.
pub type Watch<'a> = dyn FnMut(&Rendering) -> ControlFlow<Stop> + 'a;

/// Renders a task from its first sample on.
///
/// # Errors
/// Those of the device's calls; nothing is returned of a block that failed.
pub fn render(device: &mut dyn Device, task: &Task, watch: &mut Watch) -> Result<Rendering> {
    let mut rendering = Rendering::new(task);
    go_on(device, task, &mut rendering, watch)?;
    Ok(rendering)
}

/// Renders what is left of a task, to its end or until it is stopped.
///
/// # Errors
/// Those of the device's calls. The rendering then holds every block before the one that failed, and another
/// device can go on with it.
pub fn go_on(
    device: &mut dyn Device,
    task: &Task,
    rendering: &mut Rendering,
    watch: &mut Watch,
) -> Result<()> {
    let plan = task.rest(rendering)?;
    go_on_by(device, task, plan, rendering, watch)
}

/// [`go_on`] by a plan of one's own; an adaptive render has the plan's pace alone.
///
/// The device is fed by a thread of its own, which makes all calls to it; blocks are added up here meanwhile.
///
/// # Errors
/// As [`go_on`].
pub fn go_on_by(
    device: &mut dyn Device,
    task: &Task,
    plan: Plan,
    rendering: &mut Rendering,
    watch: &mut Watch,
) -> Result<()> {
    rendering.begin(device.info());
    let enough = AtomicBool::new(false);
    thread::scope(|scope| {
        let (send, receive) = sync_channel(1);
        let (more, works) = channel();
        let wants_features = task.features && rendering.features.is_none();
        let supply = match task.terms().is_some() || task.counts.is_some() {
            true => Supply::Works(plan.pace(), works),
            false => Supply::Plan(plan),
        };
        let feeder = scope.spawn({
            let enough = &enough;
            move || feed(device, task, wants_features, supply, send, enough)
        });
        let stopped = gather(task, rendering, watch, receive, more);
        enough.store(true, Ordering::SeqCst);
        let fed = feeder
            .join()
            .unwrap_or_else(|panic| std::panic::resume_unwind(panic));
        // Who was told to stop need not have come to a good end.
        if stopped { Ok(()) } else { fed }
    })
}

/// Adds up what the device made, until there is no more or somebody says stop; whether somebody did.
fn gather(
    task: &Task,
    rendering: &mut Rendering,
    watch: &mut Watch,
    receive: Receiver<Fed>,
    more: Sender<Work>,
) -> bool {
    loop {
        let (mut looks, mut spent) = (false, false);
        match receive.recv_timeout(TICK) {
            Ok(Fed::Spent) => spent = true,
            Ok(fed) => looks = rendering.add(fed),
            Err(RecvTimeoutError::Timeout) => {}
            Err(RecvTimeoutError::Disconnected) => return false,
        }
        let good = || looks && rendering.reached(task);
        let flow = if good() {
            ControlFlow::Break(Stop::TargetError)
        } else {
            watch(rendering)
        };
        if let ControlFlow::Break(stop) = flow {
            rendering.stopped = (!rendering.complete()).then_some(stop);
            return true;
        }
        if spent {
            let Some(work) = rendering.next_work(task) else {
                rendering.stopped = (!rendering.complete()).then_some(Stop::TargetError);
                return true;
            };
            // Who no longer listens has failed, and says so when it is joined.
            let _ = more.send(work);
        }
    }
}
