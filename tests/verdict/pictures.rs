//! Pictures to be compared, small and on the twin.

use lampray::compare::kinship;
use lampray::compare::verdict::{Relation, Side, Sides, Terms, Verdict, judge};
use lampray::cpu::Cpu;
use lampray::device::Device;
use lampray::film::Picture;
use lampray::pack::Rect;
use lampray::render::{self, Task};
use lampray::scene::{Assignment, Scene};
use std::ops::ControlFlow;
use std::time::{SystemTime, UNIX_EPOCH};

/// A scene that ships, with knobs.
#[derive(Clone, Copy, Debug)]
pub struct Setting {
    pub scene: &'static str,
    pub sets: &'static [&'static str],
}

impl Setting {
    pub fn render(self, size: u32, samples: u64, seed: u64) -> Picture {
        let own = [
            format!("image.width={size}"),
            format!("image.height={size}"),
            format!("render.samples={samples}"),
            format!("render.seed={seed}"),
        ];
        let sets = self.sets.iter().map(|set| set.to_string()).chain(own);
        let assignments: Vec<_> = sets
            .map(|set| Assignment::parse(&set).unwrap_or_else(|error| panic!("{error}")))
            .collect();
        let path = format!("{}/scenes/{}.toml", env!("CARGO_MANIFEST_DIR"), self.scene);
        let scene =
            Scene::load(path.as_ref(), &assignments).unwrap_or_else(|error| panic!("{error}"));
        let mut twin = Cpu::new();
        let task = Task::new(&scene);
        let rendering = render::render(&mut twin, &task, &mut |_| ControlFlow::Continue(()));
        let rendering = rendering.unwrap_or_else(|error| panic!("{error}"));
        render::picture(&task, twin.info(), &rendering, &[])
    }
}

/// The first of the seeds of a test.
pub fn first_seed(usual: u64) -> u64 {
    if std::env::var_os("LAMPRAY_FRESH_SEEDS").is_none() {
        return usual;
    }
    let now = SystemTime::now()
        .duration_since(UNIX_EPOCH)
        .unwrap_or_default();
    now.as_nanos() as u64
}

fn side(picture: &Picture) -> Side<'_> {
    Side {
        mean: &picture.mean,
        variance: &picture.variance,
        samples: &picture.samples,
        run: picture
            .record
            .randomisation
            .map_or(1.0, |length| length as f64),
    }
}

fn whole(picture: &Picture) -> Rect {
    Rect {
        x0: 0,
        y0: 0,
        x1: picture.width,
        y1: picture.height,
    }
}

/// The verdict on two pictures that share no samples.
pub fn compare(reference: &Picture, test: &Picture, terms: Terms) -> Verdict {
    judge_as(reference, test, false, terms)
}

/// The verdict on two pictures of the same random numbers.
pub fn compare_paired(reference: &Picture, test: &Picture, terms: Terms) -> Verdict {
    judge_as(reference, test, true, terms)
}

/// As `diff` does it with the records of both.
fn judge_as(reference: &Picture, test: &Picture, paired: bool, terms: Terms) -> Verdict {
    let relation = Relation {
        paired,
        ..kinship(&reference.record, &test.record).relation()
    };
    let (first, second) = (side(reference), side(test));
    judge(
        &Sides::new(first, second, whole(reference), relation),
        terms,
    )
}
