//! The pictures of `fixtures/flip/images.py`, from the same integer formulas.

use lampray::compare::{Lines, Map};

/// A picture of f32 values.
#[derive(Clone)]
pub struct Picture {
    pub width: u32,
    pub height: u32,
    pub pixels: Vec<[f32; 3]>,
}

impl Lines for Picture {
    fn width(&self) -> u32 {
        self.width
    }

    fn height(&self) -> u32 {
        self.height
    }

    fn line(&self, y: u32, out: &mut [[f32; 3]]) {
        let width = self.width as usize;
        out.copy_from_slice(&self.pixels[y as usize * width..][..width]);
    }
}

impl Picture {
    pub fn filled(width: u32, height: u32, value: f32) -> Picture {
        let pixels = vec![[value; 3]; (width * height) as usize];
        Picture {
            width,
            height,
            pixels,
        }
    }
}

/// A pair, and the sums of the whole numbers that it is made from.
pub struct Pair {
    pub reference: Picture,
    pub test: Picture,
    pub sums: [i64; 2],
}

/// What a formula gives for x, y and channel: the whole numbers of reference and test.
type Formula = fn([i64; 2], i64, i64, i64) -> [i64; 2];

/// A pair of 8 bits by its name, in values of 0..1.
pub fn bytes(name: &str, width: u32, height: u32) -> Pair {
    let formula: Formula = match name {
        "noisy" => |_, x, y, c| {
            let a = ramp(x, y, c);
            [a, (a + noise(x, y, c, 1) / 2 - 64).clamp(0, 255)]
        },
        "grains" => |_, x, y, c| [noise(x, y, c, 2), noise(x, y, c, 3)],
        "edge" => {
            |[width, _], x, _, _| [width, width + 4].map(|edge| if 2 * x < edge { 30 } else { 200 })
        }
        "colours" => |_, x, y, c| {
            let even = (x / 10 + y / 10) % 2 == 0;
            let a = if even == (c == 0) { 220 } else { 35 };
            [a, if even == (c == 1) { 215 } else { 40 }]
        },
        "slight" => |_, x, y, c| {
            let a = (ramp(x, y, c) / 2 + noise(x, y, c, 4) / 16).clamp(0, 255);
            [a, (a + (x + y) % 3 - 1).clamp(0, 255)]
        },
        _ => panic!("no pair {name}"),
    };
    pair(width, height, formula, |whole| whole as f32 / 255.0)
}

/// A pair in linear light by its name.
pub fn light(name: &str, width: u32, height: u32) -> Pair {
    let (formula, shift): (Formula, i32) = match name {
        "mild" => (|_, x, y, c| uneven(noise(x, y, 0, 5) + 1, x, y, c), 6),
        "range" => (
            |[width, _], x, y, c| uneven((256 + noise(x, y, c, 5)) << (x * 20 / width), x, y, c),
            20,
        ),
        "black" => (
            |_, x, y, c| {
                let lit = (x / 8 + y / 8) % 3 == 0;
                uneven(if lit { 64 + noise(x, y, c, 5) } else { 0 }, x, y, c)
            },
            6,
        ),
        "lamp" => (
            |[width, _], x, y, c| {
                let lamp = (2 * x - width).abs() < 8 && y < 4;
                uneven(if lamp { 1 << 20 } else { 10 + x + y + 5 * c }, x, y, c)
            },
            8,
        ),
        _ => panic!("no pair {name}"),
    };
    let unit = f64::from(shift + 9).exp2();
    pair(width, height, formula, |whole| (whole as f64 / unit) as f32)
}

fn pair(width: u32, height: u32, formula: Formula, scale: impl Fn(i64) -> f32) -> Pair {
    let size = [i64::from(width), i64::from(height)];
    let mut sums = [0; 2];
    let mut pixels = [Vec::new(), Vec::new()];
    for (y, x) in (0..size[1]).flat_map(|y| (0..size[0]).map(move |x| (y, x))) {
        let wholes = [0, 1, 2].map(|c| formula(size, x, y, c));
        for which in 0..2 {
            sums[which] += wholes.iter().map(|whole| whole[which]).sum::<i64>();
            pixels[which].push(wholes.map(|whole| scale(whole[which])));
        }
    }
    let [reference, test] = pixels.map(|pixels| Picture {
        width,
        height,
        pixels,
    });
    Pair {
        reference,
        test,
        sums,
    }
}

fn ramp(x: i64, y: i64, c: i64) -> i64 {
    (3 * x + 2 * y + 40 * c) % 256
}

/// A value and one up to 25 % off, both 512 times.
fn uneven(value: i64, x: i64, y: i64, c: i64) -> [i64; 2] {
    [512 * value, (384 + noise(x, y, c, 6)) * value]
}

/// A byte from a pixel's address.
fn noise(x: i64, y: i64, c: i64, seed: i64) -> i64 {
    let factors = [374_761_393_u32, 668_265_263, 2_246_822_519, 3_266_489_917];
    let parts = [x, y, c, seed].into_iter().zip(factors);
    let sum = parts.fold(0_u32, |sum, (part, factor)| {
        sum.wrapping_add((part as u32).wrapping_mul(factor))
    });
    let mixed = (sum ^ (sum >> 13)).wrapping_mul(1_274_126_177);
    i64::from((mixed ^ (mixed >> 16)) >> 24)
}

/// Asserts that a map has the values that a fixture lists as `[index, value]`.
pub fn assert_pixels(map: &Map, listed: &serde_json::Value, tolerance: f64, name: &str) {
    for pixel in listed.as_array().unwrap() {
        let index = pixel[0].as_u64().unwrap() as usize;
        let (ours, theirs) = (f64::from(map.values[index]), pixel[1].as_f64().unwrap());
        assert!(
            (ours - theirs).abs() <= tolerance,
            "{name}, pixel {index}: {ours} and not {theirs}"
        );
    }
}
