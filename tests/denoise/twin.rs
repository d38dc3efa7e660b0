//! The kernels on the GPU against their twins.

use crate::room::{rendered, shipped, shipped_with};
use crate::support::gpu;
use crate::support::stream::Stream;
use lampray::cpu::Cpu;
use lampray::device::Device;
use lampray::pack::{DenoiseJob, Estimate, Guide, Packed, Rect, Site};
use lampray::render::{Task, whole};

const WINDOW: [u32; 2] = [37, 29];

fn between(stream: &mut Stream, low: f64, high: f64) -> f32 {
    stream.between(low, high) as f32
}

/// Surfaces and light that differ a little from pixel to pixel, some of them by much, some not finite.
fn inputs(stream: &mut Stream) -> (Vec<Site>, Vec<Estimate>) {
    let site = |stream: &mut Stream| {
        let mut kind = [0.0; 4];
        kind[(stream.bits() % 4) as usize] = (stream.bits() % 8 / 7) as f32;
        Site {
            normal: [between(stream, -0.2, 0.2), 0.0, between(stream, 0.9, 1.0)],
            footprint: between(stream, 0.01, 0.02),
            position: [0.0, 0.0, between(stream, 3.0, 3.03)],
            spread: [0.0, 0.0, 1.5, -1.0][(stream.bits() % 13 / 4) as usize],
            kind,
        }
    };
    let estimate = |stream: &mut Stream| Estimate {
        light: std::array::from_fn(|_| between(stream, 0.0, 2.0)),
        variance: stream.scale(1e-3, 1.0) as f32,
    };
    let count = (WINDOW[0] * WINDOW[1]) as usize;
    (0..count).map(|_| (site(stream), estimate(stream))).unzip()
}

/// Sums of 25 products round to some units; an exponent of at most 40 is itself off by units in its last place, and
/// moves its weight by as many times 40.
const TOLERANCE: f32 = 40.0 * 25.0 * f32::EPSILON;

#[test]
fn a_pass_is_the_same_on_both_devices() {
    let Some(mut gpu) = gpu("the denoise kernel") else {
        return;
    };
    let scene = shipped("cornell", 8, 8, 1);
    gpu.load(&Packed::new(&scene)).unwrap();
    let mut stream = Stream::new(3);
    for (step, only_variance) in [(1, 0), (1, 1), (2, 1), (4, 0), (16, 0)] {
        let (sites, estimates) = inputs(&mut stream);
        let job = DenoiseJob {
            corner: [3, 2],
            size: [WINDOW[0] - 5, WINDOW[1] - 3],
            window: WINDOW,
            step,
            only_variance,
            light: 0.2,
            normal: 10.0,
            depth: 1.0,
            _pad0: 0,
        };
        let [got, wanted] = [
            gpu.denoise(&job, &sites, &estimates).unwrap(),
            Cpu::new().denoise(&job, &sites, &estimates).unwrap(),
        ];
        assert_eq!(got.len(), (job.size[0] * job.size[1]) as usize);
        let values = |all: &[Estimate]| -> Vec<f32> { bytemuck::cast_slice(all).to_vec() };
        let mut changed = 0;
        for (got, wanted) in values(&got).iter().zip(values(&wanted)) {
            assert!((got - wanted).abs() <= TOLERANCE, "{step}: {got} {wanted}");
            changed += usize::from(wanted != 0.0);
        }
        assert!(changed > 1000, "the inputs say little: {changed}");
    }
}

#[test]
fn guides_are_the_same_on_both_devices() {
    let Some(mut gpu) = gpu("the guides kernel") else {
        return;
    };
    for kernel in ["general", "bvh", "baked"] {
        for filter in ["box", "tent"] {
            let knobs = [
                format!("render.kernel={kernel}"),
                format!("image.filter={filter}"),
            ];
            let scene = shipped_with("cornell", 48, 40, 1, &knobs);
            let packed = Packed::new(&scene);
            let rect = Rect {
                x0: 5,
                y0: 3,
                ..whole(&scene)
            };
            let mut twin = Cpu::new();
            let [got, wanted] = [&mut *gpu as &mut dyn Device, &mut twin].map(|device| {
                device.load(&packed).unwrap();
                device.guides(rect, 3).unwrap()
            });
            check(&got, &wanted);
            assert_eq!(got.len(), 9 * rect.area());
            assert!(
                wanted
                    .iter()
                    .any(|guide| guide.mirrors == 1 && guide.id != 0)
            );
            assert!(
                wanted
                    .iter()
                    .any(|guide| guide.mirrors == 1 && guide.id == 0)
            );
        }
    }
}

/// Rays that graze an edge may find either side of it.
fn check(got: &[Guide], wanted: &[Guide]) {
    let mut strays = 0;
    for (got, wanted) in got.iter().zip(wanted) {
        if (got.id, got.mirrors) != (wanted.id, wanted.mirrors) {
            strays += 1;
            continue;
        }
        let apart =
            |a: [f32; 3], b: [f32; 3]| (0..3).map(|i| (a[i] - b[i]).abs()).fold(0.0, f32::max);
        assert!(
            apart(got.position, wanted.position) < 2e-4,
            "{got:?} {wanted:?}"
        );
        assert!(
            apart(got.normal, wanted.normal) < 2e-4,
            "{got:?} {wanted:?}"
        );
        assert!(apart(got.tint, wanted.tint) < 1e-6, "{got:?} {wanted:?}");
        assert!(
            (got.distance - wanted.distance).abs() < 2e-4,
            "{got:?} {wanted:?}"
        );
    }
    assert!(
        strays * 1000 <= wanted.len(),
        "{strays} of {}",
        wanted.len()
    );
}

#[test]
fn a_denoised_picture_is_the_same_on_both_devices() {
    let all = lampray::gpu::adapters();
    if gpu("a denoised picture").is_none() {
        return;
    }
    let scene = shipped("cornell", 64, 64, 8);
    let task = Task::new(&scene);
    let picture = rendered(&task);
    let mut device: Box<dyn Device> = Box::new(lampray::gpu::Gpu::open(&all, 0).unwrap());
    let got = crate::room::denoised_by(&mut device, &task, &picture, false).unwrap();
    let wanted = crate::room::denoised(&task, &picture);
    let (mut squares, mut sum) = (0.0, 0.0);
    for (got, wanted) in got.mean.iter().flatten().zip(wanted.mean.iter().flatten()) {
        squares += f64::from(got - wanted).powi(2);
        sum += f64::from(*wanted);
    }
    let count = wanted.mean.len() as f64 * 3.0;
    // A guide on the other side of an edge moves the shade of its pixel by a sixteenth.
    let apart = (squares / count).sqrt() / (sum / count);
    assert!(apart < 1e-3, "{apart}");
}
