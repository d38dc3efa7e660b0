//! Made-up pictures that look as renderings do, noise included.

use super::sample::chance;
use lampray::figures::Shown;

/// One ball on a floor: diffuse, with a highlight, or a mirror.
pub fn balls(kind: usize, size: u32, seed: u64, gain: f64, note: &str) -> Shown {
    shown(size, size, note, |x, y| {
        let (x, y) = (2.4 * x - 1.2, 2.4 * y - 1.2);
        let inside = 1.0 - x * x - y * y;
        let noise = 0.06
            * (chance(
                seed * 99_991 + ((x + 2.0) * 5e3) as u64 * 40_009 + ((y + 2.0) * 5e3) as u64,
            ) - 0.5);
        if inside < 0.0 {
            let floor = if y > 0.75 { 0.35 } else { 0.16 };
            return [floor + noise; 3].map(|light| light * 1.05);
        }
        let z = inside.sqrt();
        let facing = (0.5 * z - 0.6 * y - 0.4 * x).max(0.0);
        match kind {
            0 => [0.8, 0.5, 0.35].map(|colour| gain * colour * facing + noise),
            1 => {
                [0.7, 0.6, 0.3].map(|colour| 0.4 * gain * colour * facing + facing.powi(24) + noise)
            }
            _ => {
                let stripe = if (6.0 * (x / (z + 0.4))).sin() * (6.0 * (y / (z + 0.4))).sin() > 0.0
                {
                    0.75
                } else {
                    0.12
                };
                [stripe, stripe * 0.97, stripe * 0.9]
            }
        }
    })
}

/// A room with coloured walls, a ball, and its soft shadow.
pub fn noisy_room(size: u32, lamp: f64, gain: f64, noise: f64, note: &str) -> Shown {
    let seed = (gain * 1e4) as u64 + (lamp * 1e3) as u64;
    shown(size, size, note, |x, y| {
        let grain = chance(seed * 7919 + (x * 1e4) as u64 * 10_007 + (y * 1e4) as u64);
        let wall = if x < 0.18 {
            [0.6, 0.12, 0.1]
        } else if x > 0.82 {
            [0.12, 0.45, 0.14]
        } else {
            [0.55, 0.53, 0.5]
        };
        if (x - 0.5).hypot((y - 0.1) * 2.0) < lamp * 0.5 {
            return [1.0; 3];
        }
        let (dx, dy) = ((x - 0.5) / 0.2, (y - 0.62) / 0.2);
        let ball = 1.0 - dx * dx - dy * dy;
        let shadow = 1.0
            - 0.7
                * (-((x - 0.5) / (0.15 + lamp / 4.0)).powi(2) - ((y - 0.88) / 0.06).powi(2)).exp();
        let light = if ball > 0.0 {
            0.25 + 0.7 * (0.6 * ball.sqrt() - 0.7 * dy).max(0.0)
        } else {
            (1.2 - 0.6 * y) * shadow
        };
        let light = light * gain * (1.0 + noise * (grain * grain * 3.0 - 1.0));
        wall.map(|colour| colour * light)
    })
}

fn shown(width: u32, height: u32, note: &str, light: impl Fn(f64, f64) -> [f64; 3]) -> Shown {
    let mut rgb = Vec::with_capacity((width * height * 3) as usize);
    for row in 0..height {
        for column in 0..width {
            let at = |index: u32, side: u32| (f64::from(index) + 0.5) / f64::from(side);
            let pixel = light(at(column, width), at(row, height));
            rgb.extend(pixel.map(|value| (255.0 * value.clamp(0.0, 1.0).powf(1.0 / 2.2)) as u8));
        }
    }
    Shown {
        note: note.into(),
        width,
        height,
        rgb,
    }
}
