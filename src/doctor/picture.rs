//! A tiny picture whose every pixel is known: a sphere under an even sky reflects albedo times sky,
//! whatever direction its light comes from (the white furnace). What shows both is in between.

use super::ask::Ask;
use super::canaries::Verdict;
use crate::device::Limits;
use crate::error::Result;
use crate::pack::Rect;
use crate::scene::Scene;

const SIDE: u32 = 8;
const SAMPLES: u32 = 4;
const SKY: [f64; 3] = [1.0, 2.0, 4.0];
const ALBEDO: [f64; 3] = [0.5, 0.25, 0.75];
const DISTANCE: f64 = 4.0;
/// Largest relative error of a pixel.
const TOLERANCE: f64 = 1e-5;
/// Words of a pixel: radiance, rays, and samples that are not finite.
const WORDS: usize = 5;

/// The sphere of radius 1 is seen from the origin along -z, under a field of 40 degrees.
pub fn furnace() -> Result<Scene> {
    let text = format!(
        "version = 1\n\
        camera = {{ position = [0.0, 0.0, 0.0], look_at = [0.0, 0.0, -1.0], fov = 40.0 }}\n\
        image = {{ width = {SIDE}, height = {SIDE} }}\n\
        render = {{ max_bounces = 2 }}\n\
        interruption = {{ rule = \"none\" }}\n\
        background = {{ emission = {SKY:?} }}\n\
        materials.matt = {{ albedo = {ALBEDO:?} }}\n\
        spheres = [{{ center = [0.0, 0.0, -{DISTANCE:.1}], radius = 1.0, material = \"matt\" }}]\n"
    );
    Scene::parse("furnace", &text, &[])
}

pub fn whole() -> Rect {
    Rect {
        x0: 0,
        y0: 0,
        x1: SIDE,
        y1: SIDE,
    }
}

pub fn ask_picture(ask: &mut Ask) -> Result<Option<Vec<u32>>> {
    let tallies = ask.furnace(SAMPLES)?;
    let words = tallies.iter().flat_map(|tally| {
        let [r, g, b] = tally.mean.map(f32::to_bits);
        [r, g, b, tally.rays, tally.non_finite]
    });
    Ok(Some(words.collect()))
}

/// What a pixel shows.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Shows {
    Sphere,
    Sky,
    Both,
}

fn shows(pixel: usize) -> Shows {
    let side = SIDE as usize;
    let reach = 20f64.to_radians().tan();
    // The sphere's outline on the plane at distance 1, and the pixel's nearest and farthest points there.
    let outline = 1.0 / (DISTANCE * DISTANCE - 1.0).sqrt();
    let ends = |place: usize| {
        let edge = |at: usize| (2.0 * at as f64 / side as f64 - 1.0).abs() * reach;
        let (a, b) = (edge(place), edge(place + 1));
        (a.min(b), a.max(b))
    };
    let ((near_x, far_x), (near_y, far_y)) = (ends(pixel % side), ends(pixel / side));
    if far_x.hypot(far_y) < 0.999 * outline {
        Shows::Sphere
    } else if near_x.hypot(near_y) > 1.001 * outline {
        Shows::Sky
    } else {
        Shows::Both
    }
}

/// The pixel's error as a share of what it should be, in its worst channel; none where its counts are wrong.
fn error(pixel: usize, words: &[u32]) -> Option<f64> {
    let [r, g, b, rays, non_finite] = *words else {
        return None;
    };
    let shows = shows(pixel);
    let counted = match shows {
        Shows::Sky => rays == SAMPLES,
        Shows::Sphere => rays == 2 * SAMPLES,
        Shows::Both => (SAMPLES..=2 * SAMPLES).contains(&rays),
    };
    if !counted || non_finite != 0 {
        return None;
    }
    let share = f64::from(rays - SAMPLES) / f64::from(SAMPLES);
    let channel = |(channel, bits): (usize, u32)| {
        let (sky, sphere) = (SKY[channel], ALBEDO[channel] * SKY[channel]);
        let wanted = sky + (sphere - sky) * share;
        (f64::from(f32::from_bits(bits)) / wanted - 1.0).abs()
    };
    let errors = [r, g, b].into_iter().enumerate().map(channel);
    // NaN is within nothing.
    let within = |error: f64| error <= TOLERANCE;
    match errors.clone().find(|error| !within(*error)) {
        Some(wrong) => Some(wrong),
        None => errors.reduce(f64::max),
    }
}

pub fn judge_picture(words: &[u32], _: Option<Limits>) -> Verdict {
    let pixels = SIDE as usize * SIDE as usize;
    if words.len() != WORDS * pixels {
        return Err(format!("{} words", words.len()));
    }
    let errors: Vec<_> = words
        .chunks(WORDS)
        .enumerate()
        .map(|(pixel, words)| error(pixel, words))
        .collect();
    let right = |error: &Option<f64>| error.is_some_and(|error| error <= TOLERANCE);
    match errors.iter().position(|error| !right(error)) {
        None => {
            let worst = errors.into_iter().flatten().fold(0.0, f64::max);
            Ok(format!("{pixels} pixels, off by {worst:.0e} at most"))
        }
        Some(first) => Err(format!(
            "{} of {pixels} pixels wrong, the first {},{}: {:?}",
            errors.iter().filter(|error| !right(error)).count(),
            first % SIDE as usize,
            first / SIDE as usize,
            [0, 1, 2].map(|c| f32::from_bits(words[WORDS * first + c])),
        )),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cpu::Cpu;

    #[test]
    fn pixels_show_sphere_sky_and_both() {
        let all: Vec<_> = (0..64).map(shows).collect();
        let count = |what| all.iter().filter(|shows| **shows == what).count();
        // Pixels are 0.091 wide and the outline is at 0.258: by hand 16 within it, 28 beyond, 20 across.
        let counts = [Shows::Sphere, Shows::Sky, Shows::Both].map(count);
        assert_eq!(counts.iter().sum::<usize>(), 64);
        assert_eq!(all[0], Shows::Sky);
        assert_eq!(all[27], Shows::Sphere);
        assert!(counts.iter().all(|count| *count >= 12), "{counts:?}");
    }

    #[test]
    fn a_wrong_pixel_is_seen() {
        let mut twin = Cpu::new();
        let mut ask = Ask::new(&mut twin).unwrap();
        let right = ask_picture(&mut ask).unwrap().unwrap();
        judge_picture(&right, None).unwrap();
        for place in 0..right.len() {
            let mut wrong = right.clone();
            wrong[place] = match place % WORDS {
                3 => right[place] + SAMPLES,
                4 => 1,
                _ => (f32::from_bits(right[place]) * 1.0001).to_bits(),
            };
            assert!(judge_picture(&wrong, None).is_err(), "word {place}");
        }
        let mut wrong = right;
        wrong[0] = f32::NAN.to_bits();
        assert!(judge_picture(&wrong, None).is_err());
        assert!(judge_picture(&[], None).is_err());
    }
}
