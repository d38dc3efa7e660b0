//! A sample's value never depends on how the work was split: crops, dispatches, sample ranges and
//! threads give the same picture bit for bit on one device.

mod support;

use lampray::cpu::Cpu;
use lampray::device::{Device, run_ranges};
use lampray::film::{Film, Stop};
use lampray::pack::{Packed, RUN_LENGTH, Rect, Tally};
use lampray::render::{Plan, Rendering, Task, go_on_by, render, whole};
use lampray::scene::{Assignment, Scene};
use std::ops::{ControlFlow, Range};

/// Every kind of body, surface and light, in an odd size.
const ROOM: &str = r#"
version = 1
[camera]
position = [0.0, 1.0, 3.4]
look_at = [0.0, 1.0, 0.0]
fov = 45.0
[image]
width = 23
height = 17
[render]
samples = 40
max_bounces = 5
seed = 77
[background]
emission = [0.1, 0.2, 0.3]
[materials.white]
albedo = [0.75, 0.7, 0.6]
[materials.gloss]
scatter = "directional"
spread = 0.3
albedo = [0.9, 0.8, 0.7]
[materials.mirror]
scatter = "mirror"
albedo = [0.9, 0.9, 0.9]
[materials.lamp]
emission = [30.0, 25.0, 20.0]
albedo = [0.2, 0.2, 0.2]
[materials.panel]
emission = [1.0, 2.0, 3.0]
albedo = [0.5, 0.5, 0.5]
[[spheres]]
center = [0.0, 1.7, 0.0]
radius = 0.15
material = "lamp"
[[spheres]]
center = [-0.5, 0.4, 0.0]
radius = 0.4
material = "mirror"
[[spheres]]
center = [0.5, 0.4, 0.2]
radius = 0.35
material = "gloss"
[[boxes]]
min = [-2.0, -0.1, -1.0]
max = [2.0, 0.0, 1.5]
material = "white"
[[boxes]]
min = [-0.2, 0.0, 0.5]
max = [0.2, 0.3, 0.9]
rotation = [0.0, 25.0, 5.0]
material = "panel"
"#;

const SAMPLES: Range<u64> = 0..40;

fn room(assignments: &[&str]) -> Scene {
    let assignments: Vec<_> = assignments
        .iter()
        .map(|text| Assignment::parse(text).unwrap())
        .collect();
    Scene::parse("room.toml", ROOM, &assignments).unwrap_or_else(|e| panic!("{e}"))
}

/// The scenes that are split: without and with a filter, rules and weights of the other kind; baked; with samples
/// that are cut into randomisations; and
/// by a tree, over enough small balls that there is one.
fn rooms() -> [Scene; 6] {
    let balls = balls(100, "gloss");
    let crowded = ROOM.to_string() + &balls;
    let by_tree = [Assignment::parse("render.kernel=bvh").unwrap()];
    let crowded = Scene::parse("crowded.toml", &crowded, &by_tree);
    [
        room(&[]),
        room(&["render.preset=montelight"]),
        room(&["render.kernel=baked"]),
        room(&["render.sequence=stratified"]),
        room(&["render.sequence=blue-noise", "render.kernel=baked"]),
        crowded.unwrap_or_else(|e| panic!("{e}")),
    ]
}

/// Small balls in rows along the room's floor.
fn balls(count: usize, material: &str) -> String {
    let ball = |i: usize| {
        let (x, z) = (0.3 * (i % 10) as f64 - 1.4, 0.2 * (i / 10) as f64 - 0.9);
        format!(
            "[[spheres]]\ncenter = [{x}, 0.06, {z}]\nradius = 0.05\nmaterial = \"{material}\"\n"
        )
    };
    (0..count).map(ball).collect()
}

fn rect(x0: u32, y0: u32, x1: u32, y1: u32) -> Rect {
    Rect { x0, y0, x1, y1 }
}

fn task(scene: &Scene) -> Task<'_> {
    Task {
        samples: SAMPLES,
        ..Task::new(scene)
    }
}

fn take(device: &mut dyn Device, task: &Task) -> Film {
    let mut watch = |_: &_| ControlFlow::Continue(());
    render(device, task, &mut watch).unwrap().film
}

fn take_by(device: &mut dyn Device, task: &Task, plan: Plan) -> Film {
    let mut watch = |_: &_| ControlFlow::Continue(());
    let mut rendering = Rendering::new(task);
    go_on_by(device, task, plan, &mut rendering, &mut watch).unwrap();
    rendering.film
}

/// All that a film has measured of a pixel, as bits.
fn bits(film: &Film, x: u32, y: u32) -> [u64; 13] {
    let region = film.region;
    let pixel = ((y - region.y0) * region.width() + (x - region.x0)) as usize;
    let parts = [
        film.mean(pixel),
        film.variance(pixel),
        film.sums[pixel],
        film.squares[pixel],
    ];
    let mut all = [0; 13];
    for (slot, value) in all.iter_mut().zip(parts.iter().flatten()) {
        *slot = value.to_bits();
    }
    all[12] = film.counts[pixel];
    all
}

/// Number of pixels of `part` that are not the same in both films.
fn differing(a: &Film, b: &Film, part: Rect) -> usize {
    let rows = part.y0..part.y1;
    let pixels = rows.flat_map(|y| (part.x0..part.x1).map(move |x| (x, y)));
    pixels
        .filter(|&(x, y)| bits(a, x, y) != bits(b, x, y))
        .count()
}

/// Every dispatch size gives the same picture, down to one run of one pixel.
fn budgets_do_not_matter(device: &mut dyn Device) {
    for scene in rooms() {
        let task = task(&scene);
        let usual = take(device, &task);
        assert!(
            usual.picture_mean().iter().all(|&mean| mean > 0.01),
            "a black picture"
        );
        for budget in [1, 17, 500, 100_000] {
            let plan = Plan::with_budget(task.region, SAMPLES, budget);
            let film = take_by(device, &task, plan);
            assert_eq!(film, usual, "budget {budget}");
            assert_eq!(differing(&film, &usual, task.region), 0, "budget {budget}");
        }
    }
}

fn crops_do_not_matter(device: &mut dyn Device) {
    for scene in rooms() {
        let usual = take(device, &task(&scene));
        for region in [
            rect(0, 0, 1, 1),
            rect(22, 16, 23, 17),
            rect(3, 5, 20, 6),
            rect(9, 0, 18, 17),
        ] {
            let crop = take(
                device,
                &Task {
                    region,
                    ..task(&scene)
                },
            );
            assert_eq!(differing(&crop, &usual, region), 0, "{region:?}");
        }
    }
}

/// The tallies of a range, run by run.
fn trace(
    device: &mut dyn Device,
    region: Rect,
    first: u64,
    samples: u32,
) -> Vec<(u64, u32, Vec<Tally>)> {
    let tallies = device.trace(region, first, samples).unwrap();
    let runs = run_ranges(first, samples).zip(tallies.chunks(region.area()));
    runs.map(|((start, count), part)| (start, count, part.to_vec()))
        .collect()
}

/// Runs of a range are those of any longer range that holds them.
/// A render that was stopped leaves blocks on their way: they are none of the next one's.
fn what_was_stopped_does_not_matter(device: &mut dyn Device) {
    let scene = room(&[]);
    let task = task(&scene);
    let whole = take(device, &task);
    for blocks in [1, 3] {
        let mut seen = 0;
        let mut watch = |_: &Rendering| {
            seen += 1;
            if seen > blocks {
                ControlFlow::Break(Stop::Signal)
            } else {
                ControlFlow::Continue(())
            }
        };
        let stopped = render(device, &task, &mut watch).unwrap();
        assert!(!stopped.complete(), "there was more to do");
        assert!(take(device, &task) == whole, "after {blocks} blocks");
    }
}

fn ranges_do_not_matter(device: &mut dyn Device) {
    let scene = room(&[]);
    let region = rect(2, 3, 19, 14);
    device.load(&Packed::new(&scene)).unwrap();
    for base in [0, (1 << 32) - 32, (1 << 62) + 16] {
        let whole = trace(device, region, base, 64);
        for (skip, samples) in [(0, 16), (16, 16), (16, 48), (5, 43), (31, 18), (48, 1)] {
            let mut shared = 0;
            for run in trace(device, region, base + skip, samples) {
                let same = whole
                    .iter()
                    .find(|(start, count, _)| (*start, *count) == (run.0, run.1));
                if let Some(same) = same {
                    assert_eq!(same.2, run.2, "{base} + {skip}, run {}", run.0);
                    shared += 1;
                }
            }
            let expected = (skip + u64::from(samples)) / 16 - skip.div_ceil(16);
            assert_eq!(shared, expected, "{base} + {skip}: {samples}");
        }
    }
}

/// A run's mean from its samples taken one at a time, as the kernel adds them.
fn mean_of(samples: &[Tally]) -> [f32; 3] {
    std::array::from_fn(|channel| {
        let first = samples[0].mean[channel];
        let sum = samples
            .iter()
            .fold(0.0, |sum, one| sum + (one.mean[channel] - first));
        first + sum / samples.len() as f32
    })
}

/// A run is its samples: each taken by itself has the value that it has among the others.
fn samples_do_not_matter_to_each_other(device: &mut dyn Device) {
    let region = rect(5, 8, 14, 17);
    device.load(&Packed::new(&room(&[]))).unwrap();
    let run = &trace(device, region, 32, RUN_LENGTH)[0].2;
    let single: Vec<_> = (32..48)
        .map(|sample| trace(device, region, sample, 1)[0].2.clone())
        .collect();
    let mut different = 0;
    for pixel in 0..region.area() {
        let samples: Vec<_> = single.iter().map(|tallies| tallies[pixel]).collect();
        let (together, apart) = (
            run[pixel].mean.map(f32::to_bits),
            mean_of(&samples).map(f32::to_bits),
        );
        assert_eq!(together, apart, "pixel {pixel}");
        assert_eq!(
            run[pixel].rays,
            samples.iter().map(|one| one.rays).sum::<u32>()
        );
        different += usize::from(samples[0].mean != samples[1].mean);
    }
    assert!(
        different > region.area() / 3,
        "only {different} pixels have samples that differ"
    );
}

/// A comparison that cannot fail proves nothing: other seeds and other samples give other pictures.
fn other_samples_differ(device: &mut dyn Device) {
    let scene = room(&[]);
    let usual = take(device, &task(&scene));
    // All that show a body; the background looks the same to any sample.
    let most = usual.region.area() / 5;
    for seed in ["render.seed=78", "render.seed=4294967373"] {
        let other = room(&[seed]);
        let film = take(device, &task(&other));
        let count = differing(&film, &usual, usual.region);
        assert!(count >= most, "{seed}: only {count} pixels differ");
    }
    let later = take(
        device,
        &Task {
            samples: 40..80,
            ..task(&scene)
        },
    );
    assert!(differing(&later, &usual, usual.region) >= most);
}

/// Mesa's software drivers leave every loop after 65,535 iterations: long paths, many samples and
/// many bodies must not lose samples to that.
fn long_work_is_done(device: &mut dyn Device) {
    const HALL: &str = r#"
version = 1
[camera]
position = [0.0, 0.0, 0.0]
look_at = [0.0, 0.0, -1.0]
fov = 50.0
[image]
width = 4
height = 3
[render]
samples = 8
max_bounces = 8
[interruption]
rule = "none"
[materials.white]
albedo = [1.0, 1.0, 1.0]
[[spheres]]
center = [0.0, 0.0, 0.0]
radius = 1.0
material = "white"
"#;
    let bodies: String = (0..60)
        .map(|i| {
            format!("[[spheres]]\ncenter = [{i}.0, 9.0, 9.0]\nradius = 0.1\nmaterial = \"white\"\n")
        })
        .collect();
    for (extra, bounces) in [("", 10_000), (bodies.as_str(), 400)] {
        let limit = Assignment::parse(&format!("render.max_bounces={bounces}")).unwrap();
        let scene = Scene::parse("hall.toml", &(HALL.to_string() + extra), &[limit]).unwrap();
        let film = take(device, &Task::new(&scene));
        // No path ends before its time, and none finds light.
        assert_eq!(film.rays, 4 * 3 * 8 * (bounces + 1));
        assert_eq!(film.paths, 4 * 3 * 8);
    }
}

fn all(device: &mut dyn Device) {
    budgets_do_not_matter(device);
    crops_do_not_matter(device);
    what_was_stopped_does_not_matter(device);
    ranges_do_not_matter(device);
    samples_do_not_matter_to_each_other(device);
    other_samples_differ(device);
    long_work_is_done(device);
}

#[test]
fn splits_do_not_matter_to_the_twin() {
    all(&mut Cpu::new());
}

#[test]
fn splits_do_not_matter_to_the_gpu() {
    if let Some(mut gpu) = support::gpu("pictures from split work, bit for bit") {
        all(&mut *gpu);
    }
}

#[test]
fn threads_do_not_matter_to_the_twin() {
    for scene in rooms() {
        let films = [1, 2, 5].map(|threads| {
            let pool = rayon::ThreadPoolBuilder::new()
                .num_threads(threads)
                .build()
                .unwrap();
            pool.install(|| take(&mut Cpu::new(), &task(&scene)))
        });
        assert_eq!(films[0].region, whole(&scene));
        assert_eq!(films[0], films[1]);
        assert_eq!(films[0], films[2]);
    }
}

#[test]
fn a_second_load_of_a_scene_changes_nothing() {
    let rooms = rooms();
    let check = |device: &mut dyn Device| {
        let before = rooms.each_ref().map(|room| take(device, &task(room)));
        for (room, film) in rooms.iter().zip(&before) {
            assert_eq!(take(device, &task(room)), *film);
        }
    };
    check(&mut Cpu::new());
    if let Some(mut gpu) = support::gpu("one scene after another") {
        check(&mut *gpu);
    }
}

/// A range may begin where a randomisation does, and nowhere else; too few samples for two of them are refused.
#[test]
fn randomisations_that_cannot_be_are_refused() {
    let scene = room(&["render.sequence=sobol", "render.samples=256"]);
    let from = |start: u64| Task {
        samples: start..start + 64,
        ..Task::new(&scene)
    };
    let go = |task: &Task| {
        let mut watch = |_: &_| ControlFlow::Continue(());
        render(&mut Cpu::new(), task, &mut watch).map(|rendering| rendering.film.paths)
    };
    for start in [0, 32, 512] {
        assert_eq!(go(&from(start)).unwrap(), 64 * 23 * 17);
    }
    let error = go(&from(48)).unwrap_err().to_string();
    assert!(
        error.contains("begin inside a randomisation") && error.contains("--sample-range 32..112"),
        "{error}"
    );
    let few = ["render.sequence=sobol", "render.samples=31"].map(Assignment::parse);
    let few: Vec<_> = few.into_iter().collect::<Result<_, _>>().unwrap();
    let error = Scene::parse("room.toml", ROOM, &few).unwrap_err();
    let error = error.to_string();
    assert!(
        error.contains("32 samples a pixel or more") && error.contains("independent"),
        "{error}"
    );
}
