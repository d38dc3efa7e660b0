//! Times of FLIP, SSIM and MS-SSIM at 1920x1080.
//!
//! `cargo bench --bench flip` prints medians of nine runs. With `-- --serve` it answers each line of
//! its input, `ldr`, `hdr`, `ssim` or `ms-ssim`, with the seconds of one run and the mean, for
//! `flip_against_nvidia.py`, which times the same pictures in NVIDIA's tool.

use lampray::compare::flip::{self, DEFAULT_PPD, Exposures};
use lampray::compare::{Lines, similarity};
use std::io::BufRead;
use std::time::Instant;

const WIDTH: u32 = 1920;
const HEIGHT: u32 = 1080;
const METRICS: [&str; 4] = ["ldr", "hdr", "ssim", "ms-ssim"];
const RUNS: usize = 9;

struct Picture(Vec<[f32; 3]>);

impl Lines for Picture {
    fn width(&self) -> u32 {
        WIDTH
    }

    fn height(&self) -> u32 {
        HEIGHT
    }

    fn line(&self, y: u32, out: &mut [[f32; 3]]) {
        let width = WIDTH as usize;
        out.copy_from_slice(&self.0[y as usize * width..][..width]);
    }
}

/// A ramp of bytes, and the same with up to `noise` added.
fn picture(noise: u32) -> Picture {
    let value = |x: u32, y: u32, c: u32| {
        let grain = (x * 73 + y * 151 + c * 199 + x * y % 251) % 256;
        let ramp = (x / 9 + y / 12 + 40 * c) % 256;
        (ramp * (256 - noise) + grain * noise) as f32 / 65536.0
    };
    let rows = (0..HEIGHT).flat_map(|y| (0..WIDTH).map(move |x| (x, y)));
    Picture(
        rows.map(|(x, y)| [0, 1, 2].map(|c| value(x, y, c)))
            .collect(),
    )
}

/// One run: seconds and the mean.
fn run(metric: &str, reference: &Picture, test: &Picture) -> (f64, f64) {
    let start = Instant::now();
    let mean = match metric {
        "ldr" => flip::ldr(reference, test, DEFAULT_PPD).unwrap().mean(),
        "hdr" => {
            let exposures = Exposures::of(reference);
            flip::hdr(reference, test, DEFAULT_PPD, exposures)
                .unwrap()
                .mean()
        }
        "ssim" => similarity::ssim(reference, test).unwrap().0,
        "ms-ssim" => similarity::ms_ssim(reference, test).unwrap(),
        _ => panic!("no metric {metric}"),
    };
    (start.elapsed().as_secs_f64(), mean)
}

fn main() {
    let (reference, test) = (picture(16), picture(64));
    if std::env::args().any(|argument| argument == "--serve") {
        for line in std::io::stdin().lock().lines() {
            let (seconds, mean) = run(line.unwrap().trim(), &reference, &test);
            println!("{seconds} {mean}");
        }
        return;
    }
    for metric in METRICS {
        let mut seconds: Vec<f64> = (0..RUNS)
            .map(|_| run(metric, &reference, &test).0)
            .collect();
        seconds.sort_by(f64::total_cmp);
        println!("{metric}: {:.1} ms", 1e3 * seconds[RUNS / 2]);
    }
}
