//! A small scene, and films of it.

use lampray::cpu::Cpu;
use lampray::device::{Block, Device, DeviceInfo, DeviceKind, Limits, Traced};
use lampray::film::Film;
use lampray::pack::{
    CanaryJob, CanaryScene, DenoiseJob, Draw, Estimate, Feature, Guide, Packed, PointsJob, Rect,
    Site, Strategy,
};
use lampray::render::{Plan, Rendering, Task, go_on_by, render};
use lampray::scene::{Assignment, Scene};
use lampray::{Error, Result};
use std::ops::ControlFlow;

const ROOM: &str = r#"
version = 1
[camera]
position = [0.0, 1.0, 3.4]
look_at = [0.0, 1.0, 0.0]
[image]
width = 7
height = 5
[render]
samples = 100
max_bounces = 3
[background]
emission = [0.1, 0.2, 0.3]
[materials.white]
[materials.lamp]
emission = [30.0, 25.0, 20.0]
[[spheres]]
center = [0.0, 1.7, 0.0]
radius = 0.15
material = "lamp"
[[boxes]]
min = [-2.0, -0.1, -1.0]
max = [2.0, 0.0, 1.5]
material = "white"
"#;

pub fn room(assignments: &[&str]) -> Scene {
    let parsed = assignments.iter().map(|text| Assignment::parse(text));
    let parsed: Vec<_> = parsed.collect::<Result<_>>().expect("knobs");
    Scene::parse("room.toml", ROOM, &parsed).unwrap_or_else(|error| panic!("{error}"))
}

/// The film of a task that nothing disturbs.
pub fn undisturbed(task: &Task) -> Film {
    let mut watch = |_: &_| ControlFlow::Continue(());
    let rendering = render(&mut Cpu::new(), task, &mut watch);
    rendering.expect("a rendering").film
}

/// What a task has after some blocks of at most `budget` samples.
pub fn after(task: &Task, budget: u64, blocks: usize) -> Rendering {
    let mut rendering = Rendering::new(task);
    let mut plan = Plan::with_budget(task.region, task.samples.clone(), budget);
    if task.target_error.is_some() {
        plan = plan.with_looks();
    }
    let (mut paths, mut left) = (0, blocks);
    let mut watch = |rendering: &Rendering| {
        left -= usize::from(rendering.film.paths > paths && left > 0);
        paths = rendering.film.paths;
        match left {
            0 => ControlFlow::Break(lampray::film::Stop::Signal),
            _ => ControlFlow::Continue(()),
        }
    };
    go_on_by(&mut Cpu::new(), task, plan, &mut rendering, &mut watch).expect("some blocks");
    rendering
}

/// A device that traces as the CPU twin does and is lost when it is told to be.
pub struct Fragile {
    twin: Cpu,
    info: DeviceInfo,
    /// Blocks until it is lost.
    left: usize,
    fault: fn() -> Error,
}

impl Fragile {
    pub fn boxed(left: usize, fault: fn() -> Error) -> Box<dyn Device> {
        let info = DeviceInfo {
            kind: DeviceKind::Hardware,
            name: "fragile".into(),
            ..lampray::cpu::info()
        };
        Box::new(Self {
            twin: Cpu::new(),
            info,
            left,
            fault,
        })
    }
}

pub fn lost() -> Error {
    Error::DeviceLost("the device fragile was lost (on purpose)".into())
}

impl Device for Fragile {
    fn info(&self) -> &DeviceInfo {
        &self.info
    }

    fn load(&mut self, scene: &Packed) -> Result<()> {
        self.twin.load(scene)
    }

    fn start(&mut self, block: Block) -> Result<()> {
        self.twin.start(block)
    }

    fn finish(&mut self) -> Result<Traced> {
        self.left = self.left.checked_sub(1).ok_or_else(self.fault)?;
        self.twin.finish()
    }

    fn features(&mut self, rect: Rect) -> Result<Vec<Feature>> {
        self.twin.features(rect)
    }

    fn guides(&mut self, rect: Rect, fineness: u32) -> Result<Vec<Guide>> {
        self.twin.guides(rect, fineness)
    }

    fn denoise(
        &mut self,
        job: &DenoiseJob,
        sites: &[Site],
        estimates: &[Estimate],
    ) -> Result<Vec<Estimate>> {
        self.twin.denoise(job, sites, estimates)
    }

    fn points(&mut self, strategy: &Strategy, job: &PointsJob) -> Result<Vec<Draw>> {
        self.twin.points(strategy, job)
    }

    fn limits(&self) -> Result<Option<Limits>> {
        self.twin.limits()
    }

    fn canary(
        &mut self,
        strategy: &Strategy,
        job: &CanaryJob,
        scenes: &[CanaryScene],
        inputs: &[[u32; 4]],
    ) -> Result<Option<Vec<[u32; 4]>>> {
        self.twin.canary(strategy, job, scenes, inputs)
    }
}
