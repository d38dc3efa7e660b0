//! How much a measurement traces, so that it takes about the time that was asked for.

use crate::pack::RUN_LENGTH;
use crate::scene::Scene;

/// Size of the picture and samples of each pixel. A smaller picture shows the same view, but how fast a
/// device is depends a little on its size: what is compared on one device gets pictures of one size.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Effort {
    pub width: u32,
    pub height: u32,
    pub samples: u64,
}

/// Pixels that the longer side of the smallest picture has.
const LEAST: u32 = 16;
/// From one try to the next the work grows at most by this factor: small tries leave a large device
/// idle, and say little.
const GROWTH: f64 = 16.0;

impl Effort {
    /// So many paths, or a few more or less, of a picture of this size: whole runs of its samples where there
    /// are enough of them, a smaller picture where not.
    pub fn new(size: [u32; 2], paths: f64) -> Self {
        let run = u64::from(RUN_LENGTH);
        let full = f64::from(size[0]) * f64::from(size[1]);
        let runs = (paths / full / run as f64).floor();
        if runs >= 1.0 {
            return Self {
                width: size[0],
                height: size[1],
                samples: runs as u64 * run,
            };
        }
        let longer = size[0].max(size[1]);
        let least = f64::from(LEAST.min(longer)) / f64::from(longer);
        let scale = (paths / full / run as f64).sqrt().clamp(least, 1.0);
        let [width, height] =
            size.map(|side| ((f64::from(side) * scale).round() as u32).clamp(1, side));
        let pixels = f64::from(width) * f64::from(height);
        Self {
            width,
            height,
            samples: ((paths / pixels).round() as u64).clamp(1, run),
        }
    }

    /// The least there is.
    pub fn least(size: [u32; 2]) -> Self {
        Self::new(size, 0.0)
    }

    pub fn paths(self) -> f64 {
        f64::from(self.width) * f64::from(self.height) * self.samples as f64
    }

    /// About as many paths of a picture of another size.
    pub fn resized(self, size: [u32; 2]) -> Self {
        let run = u64::from(RUN_LENGTH);
        let samples = self.paths() / (f64::from(size[0]) * f64::from(size[1]));
        let samples = match samples as u64 / run {
            0 => (samples.round() as u64).max(1),
            runs => runs * run,
        };
        Self {
            width: size[0],
            height: size[1],
            samples,
        }
    }

    /// What to try after this took `took` seconds: the second is whether it is to be the last.
    pub fn next(self, size: [u32; 2], took: f64, wanted: f64) -> (Self, bool) {
        let took = took.max(1e-6);
        let near = took >= 0.25 * wanted;
        let factor = match near {
            true => wanted / took,
            false => (0.5 * wanted / took).clamp(2.0, GROWTH),
        };
        (Self::new(size, self.paths() * factor), near)
    }

    /// Makes it what a scene is rendered at.
    pub fn apply(self, scene: &mut Scene) {
        scene.settings.image.width = self.width;
        scene.settings.image.height = self.height;
        scene.settings.render.samples = self.samples;
    }
}

/// Gives all of them the smallest picture among them, and each about as many paths as it had.
pub fn one_size<'a>(efforts: impl IntoIterator<Item = &'a mut Effort>) {
    let efforts: Vec<&mut Effort> = efforts.into_iter().collect();
    let sizes = efforts.iter().map(|effort| [effort.width, effort.height]);
    let Some(smallest) = sizes.min_by_key(|[width, height]| u64::from(*width) * u64::from(*height))
    else {
        return;
    };
    for effort in efforts {
        *effort = effort.resized(smallest);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const SIZE: [u32; 2] = [256, 128];

    #[test]
    fn paths_are_about_what_was_asked_for() {
        for paths in [128.0, 1e3, 1e4, 1e5, 1e6, 1e7, 1e9] {
            let effort = Effort::new(SIZE, paths);
            let ratio = effort.paths() / paths;
            assert!((0.5..1.5).contains(&ratio), "{paths}: {effort:?}");
            assert!(effort.width <= 256 && effort.height <= 128);
        }
    }

    #[test]
    fn little_work_is_a_small_picture_of_the_same_shape() {
        assert_eq!(
            Effort::least(SIZE),
            Effort {
                width: 16,
                height: 8,
                samples: 1
            }
        );
        assert_eq!(
            Effort::least([3, 2]),
            Effort {
                width: 3,
                height: 2,
                samples: 1
            }
        );
        let more = Effort::new(SIZE, 16.0 * 64.0 * 32.0);
        assert_eq!(
            more,
            Effort {
                width: 64,
                height: 32,
                samples: 16
            }
        );
        let full = Effort::new(SIZE, 256.0 * 128.0 * 100.0);
        assert_eq!(
            full,
            Effort {
                width: 256,
                height: 128,
                samples: 96
            }
        );
    }

    #[test]
    fn what_is_compared_has_pictures_of_one_size() {
        let mut efforts = [1e4, 1e6, 1e8].map(|paths| Effort::new(SIZE, paths));
        let before = efforts;
        one_size(&mut efforts);
        for (now, before) in efforts.iter().zip(before) {
            assert_eq!((now.width, now.height), first_size(&efforts));
            let ratio = now.paths() / before.paths();
            assert!((0.5..1.5).contains(&ratio), "{now:?}");
        }
        assert_eq!(efforts[0], before[0], "the smallest stays");
        one_size([]);
    }

    fn first_size(efforts: &[Effort]) -> (u32, u32) {
        (efforts[0].width, efforts[0].height)
    }

    /// A device of any speed is found in a few tries, and then takes about the time wanted.
    #[test]
    fn tries_end_near_the_time_wanted() {
        for paths_a_second in [1e2, 1e4, 1e6, 1e8, 1e10] {
            let time = |effort: Effort| 1e-4 + effort.paths() / paths_a_second;
            let (mut effort, mut last, mut tries) = (Effort::least(SIZE), false, 0);
            while !last {
                (effort, last) = effort.next(SIZE, time(effort), 1.0);
                tries += 1;
                assert!(tries < 12, "{paths_a_second}: {effort:?}");
            }
            let took = time(effort);
            assert!((0.5..1.6).contains(&took), "{paths_a_second}: {took}");
        }
    }
}
