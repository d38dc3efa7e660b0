//! SSIM and MS-SSIM: how alike two pictures are in brightness, contrast and structure.
//!
//! - SSIM: Wang et al., "Image quality assessment: from error visibility to structural similarity",
//!   IEEE Transactions on Image Processing 13(4), 2004.
//! - MS-SSIM: Wang et al., "Multiscale structural similarity for image quality assessment", Asilomar
//!   Conference on Signals, Systems and Computers, 2003.
//!
//! Both look at the luma of what a screen shows, 0.2126 R' + 0.7152 G' + 0.0722 B' of the sRGB encoded
//! values, clipped to 0..1; what is not a finite number counts as 0. With means μ, variances σ² and
//! the covariance under a Gaussian window of 11 by 11 pixels and σ 1.5, weights summing to 1,
//!
//! ```text
//! SSIM = l · cs,  l = (2 μa μb + C1) / (μa² + μb² + C1),  cs = (2 σab + C2) / (σa² + σb² + C2)
//! ```
//!
//! with C1 = 0.01² and C2 = 0.03². 1 is alike, 0 has nothing in common, below 0 is inverted.
//!
//! Written here, for the one library that has both, `iqa`, gives no map, takes whole pictures, slides
//! a window that is not separated over them on one thread, and brings `tracing`.

use super::{Lines, Map};
use rayon::prelude::*;

/// Side of the window, pixels.
pub const WINDOW: u32 = 11;
/// The shorter side that MS-SSIM asks for, pixels: the window fits into the coarsest of five scales.
pub const SHORTEST: u32 = WINDOW << 4;

const REACH: usize = WINDOW as usize / 2;
const SIGMA: f64 = 1.5;
const C1: f64 = 0.01 * 0.01;
const C2: f64 = 0.03 * 0.03;

/// How much the scales count, from the finest (Wang 2003, section 3.2).
const SCALES: [f64; 5] = [0.0448, 0.2856, 0.3001, 0.2363, 0.1333];

/// Lines that a thread works on at a time.
const STRIP: usize = 32;

/// SSIM's mean over all windows that lie in the picture, and its map. The map is as large as the
/// picture: windows that reach beyond see it mirrored, and are not in the mean. `None` if a side is
/// below [`WINDOW`]. The pictures must be equal in size.
pub fn ssim(reference: &dyn Lines, test: &dyn Lines) -> Option<(f64, Map)> {
    if shorter(reference) < WINDOW {
        return None;
    }
    let (width, height) = (reference.width(), reference.height());
    let (scores, values) = compare(&Plane::of(reference), &Plane::of(test));
    Some((
        scores.ssim,
        Map {
            width,
            height,
            values,
        },
    ))
}

/// MS-SSIM, 0..1: the means of cs at four scales and of SSIM at the fifth, each to the power of its
/// weight and all multiplied. A mean below 0 has no such power and counts as 0. From scale to scale
/// pixels are averaged two by two; of an odd side the last counts twice. `None` if the shorter side is
/// below [`SHORTEST`], for fewer scales are another measure. The pictures must be equal in size.
pub fn ms_ssim(reference: &dyn Lines, test: &dyn Lines) -> Option<f64> {
    if shorter(reference) < SHORTEST {
        return None;
    }
    let mut planes = [Plane::of(reference), Plane::of(test)];
    let mut product = 1.0;
    for (scale, weight) in SCALES.into_iter().enumerate() {
        let scores = compare(&planes[0], &planes[1]).0;
        let last = scale + 1 == SCALES.len();
        let mean = if last { scores.ssim } else { scores.cs };
        product *= libm::pow(mean.max(0.0), weight);
        if !last {
            planes = [planes[0].halved(), planes[1].halved()];
        }
    }
    Some(product)
}

fn shorter(picture: &dyn Lines) -> u32 {
    picture.width().min(picture.height())
}

/// Luma of a picture, at one scale.
struct Plane {
    width: usize,
    height: usize,
    values: Vec<f32>,
}

impl Plane {
    fn of(picture: &dyn Lines) -> Plane {
        let (width, height) = (picture.width() as usize, picture.height() as usize);
        let mut values = vec![0.0; width * height];
        let lines = values.par_chunks_mut(width).enumerate();
        lines.for_each_init(
            || vec![[0.0; 3]; width],
            |line, (y, out)| {
                picture.line(y as u32, line);
                out.iter_mut()
                    .zip(line)
                    .for_each(|(out, pixel)| *out = luma(*pixel));
            },
        );
        Plane {
            width,
            height,
            values,
        }
    }

    fn line(&self, y: usize) -> &[f32] {
        &self.values[y * self.width..][..self.width]
    }

    /// The next coarser scale.
    fn halved(&self) -> Plane {
        let (width, height) = (self.width.div_ceil(2), self.height.div_ceil(2));
        let mut values = Vec::with_capacity(width * height);
        for y in 0..height {
            let lines = [2 * y, (2 * y + 1).min(self.height - 1)].map(|y| self.line(y));
            values.extend((0..width).map(|x| {
                let columns = [2 * x, (2 * x + 1).min(self.width - 1)];
                let sums = columns.map(|x| lines[0][x] + lines[1][x]);
                0.25 * (sums[0] + sums[1])
            }));
        }
        Plane {
            width,
            height,
            values,
        }
    }
}

fn luma(pixel: [f32; 3]) -> f32 {
    let shown = |value: f32| {
        if value.is_finite() {
            value.clamp(0.0, 1.0)
        } else {
            0.0
        }
    };
    let [r, g, b] = pixel.map(|value| f64::from(shown(value)));
    (0.2126 * r + 0.7152 * g + 0.0722 * b) as f32
}

/// Means over the windows that lie in the picture.
struct Scores {
    ssim: f64,
    cs: f64,
}

/// The scores of two planes, and SSIM of every pixel.
fn compare(a: &Plane, b: &Plane) -> (Scores, Vec<f32>) {
    let mut map = vec![0.0; a.values.len()];
    let strips = map.par_chunks_mut(STRIP * a.width).enumerate();
    let sums: Vec<[f64; 2]> = strips
        .flat_map_iter(|(strip, out)| compare_strip(a, b, strip * STRIP, out))
        .collect();
    // Line by line, so that the sum does not depend on the threads.
    let windows = ((a.width - 2 * REACH) * (a.height - 2 * REACH)) as f64;
    let sum = |which: usize| sums.iter().map(|line| line[which]).sum::<f64>();
    let scores = Scores {
        ssim: sum(0) / windows,
        cs: sum(1) / windows,
    };
    (scores, map)
}

/// Fills SSIM of the lines from `first` on; gives the sums of SSIM and of cs over those windows of
/// each line that lie in the picture.
fn compare_strip(a: &Plane, b: &Plane, first: usize, out: &mut [f32]) -> Vec<[f64; 2]> {
    let (width, height) = (a.width, a.height);
    let weights = window();
    let lines = out.len() / width;
    let across: Vec<Products> = (first..first + lines + 2 * REACH)
        .map(|y| mirrored(y, height))
        .map(|y| Products::of(a.line(y), b.line(y)).blurred(&weights))
        .collect();
    let mut sums = vec![[0.0; 2]; lines];
    let mut moments = Products::zero(width);
    for (y, out) in out.chunks_mut(width).enumerate() {
        moments.fill(0.0);
        for (line, weight) in across[y..].iter().zip(weights) {
            moments.add(line, weight);
        }
        let inside = (REACH..height - REACH).contains(&(first + y));
        for (x, out) in out.iter_mut().enumerate() {
            let [l, cs] = moments.terms(x);
            *out = (l * cs) as f32;
            if inside && (REACH..width - REACH).contains(&x) {
                sums[y][0] += l * cs;
                sums[y][1] += cs;
            }
        }
    }
    sums
}

/// a, b, a² + b² and 2ab along a line: all that the two terms need, and to the last bit alike for
/// equal pictures. In f64, for variances are small differences of them.
struct Products([Vec<f64>; 4]);

impl Products {
    fn zero(width: usize) -> Products {
        Products(std::array::from_fn(|_| vec![0.0; width]))
    }

    /// Mirrored by [`REACH`] at both ends.
    fn of(a: &[f32], b: &[f32]) -> Products {
        let mut all = Products::zero(a.len() + 2 * REACH);
        for i in 0..a.len() + 2 * REACH {
            let x = mirrored(i, a.len());
            let (a, b) = (f64::from(a[x]), f64::from(b[x]));
            let values = [a, b, a * a + b * b, 2.0 * a * b];
            all.0
                .iter_mut()
                .zip(values)
                .for_each(|(line, value)| line[i] = value);
        }
        all
    }

    fn blurred(&self, weights: &[f64; WINDOW as usize]) -> Products {
        let mut all = Products::zero(self.0[0].len() - 2 * REACH);
        for (out, line) in all.0.iter_mut().zip(&self.0) {
            for (shift, &weight) in weights.iter().enumerate() {
                add(out, &line[shift..], weight);
            }
        }
        all
    }

    fn fill(&mut self, value: f64) {
        self.0.iter_mut().for_each(|line| line.fill(value));
    }

    fn add(&mut self, other: &Products, weight: f64) {
        self.0
            .iter_mut()
            .zip(&other.0)
            .for_each(|(out, line)| add(out, line, weight));
    }

    /// l and cs, of moments.
    fn terms(&self, x: usize) -> [f64; 2] {
        let [a, b, squares, product] = [0, 1, 2, 3].map(|i| self.0[i][x]);
        let (mean_squares, mean_product) = (a * a + b * b, 2.0 * a * b);
        let l = (mean_product + C1) / (mean_squares + C1);
        let cs = (product - mean_product + C2) / (squares - mean_squares + C2);
        [l, cs]
    }
}

fn add(out: &mut [f64], line: &[f64], weight: f64) {
    out.iter_mut()
        .zip(line)
        .for_each(|(out, value)| *out += weight * value);
}

/// The window along one axis; the window is its product with itself.
fn window() -> [f64; WINDOW as usize] {
    let weights: [f64; WINDOW as usize] = std::array::from_fn(|i| {
        let x = (i as f64 - REACH as f64) / SIGMA;
        libm::exp(-0.5 * x * x)
    });
    let sum: f64 = weights.iter().sum();
    weights.map(|weight| weight / sum)
}

/// The line or column that stands at `index - REACH` where the picture is mirrored at its edges, the
/// edge pixels doubled.
fn mirrored(index: usize, size: usize) -> usize {
    let position = index as isize - REACH as isize;
    let size = size as isize;
    let inner = if position < 0 {
        -1 - position
    } else {
        position
    };
    (if inner < size {
        inner
    } else {
        2 * size - 1 - inner
    }) as usize
}
