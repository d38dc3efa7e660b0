//! The paper's half-normal lobe beside rough mirrors of microfacets: how many of the drawn directions fall
//! below the surface and are lost.
//!
//!     cargo run --release --example gloss [DRAWS]
//!
//! Each row pairs a spread sigma with the roughness alpha whose reflections, seen along the normal, are as
//! far from the mirror direction in the median: alpha = tan(m / 2) where m is the median of the half-normal
//! law cut at a right angle, since half of the facets lean by less than atan(alpha) (Trowbridge and Reitz).
//! The draws are those of `lampray points scatter`, by the CPU twin. Caps that are not cut at their rim would
//! draw all that is above the surface, too, and so the share (1 + b) / 2 of it (Eto and Tokuyoshi 2023).
//! What facets hide of the rest is light that one reflection loses, with any sampler.

use lampray::cpu::Cpu;
use lampray::cpu::rough::{rough_arrival, rough_share};
use lampray::knobs::Scatter;
use lampray::points::{Cloud, Kind, Request, draw};
use std::f64::consts::{FRAC_PI_2, SQRT_2};

const SPREADS: [f64; 5] = [0.1, 0.2, 0.3, 0.5, 1.0];
const ANGLES: [f64; 5] = [30.0, 45.0, 60.0, 75.0, 85.0];

/// The median of |N(0, sigma)| below a right angle, by bisection.
fn median(sigma: f64) -> f64 {
    let below = |angle: f64| libm::erf(angle / (SQRT_2 * sigma));
    let half = 0.5 * below(FRAC_PI_2);
    let (mut low, mut high) = (0.0, FRAC_PI_2);
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if below(middle) < half {
            low = middle;
        } else {
            high = middle;
        }
    }
    low
}

fn cloud(
    scatter: Scatter,
    spread: f64,
    roughness: f64,
    incidence: f64,
    count: u32,
) -> lampray::Result<Cloud> {
    let kind = Kind::Scatter {
        scatter,
        spread,
        roughness,
        index: 1.5,
        inside: false,
        incidence,
    };
    let request = Request {
        kind,
        count,
        knobs: Vec::new(),
    };
    draw(&mut Cpu::new(), &request)
}

/// Of a rough mirror's draws: the share below the surface, that without the cap's cut, and the share of
/// light that facets hide from each other.
fn facets(alpha: f64, degrees: f64, count: u32) -> lampray::Result<[f64; 3]> {
    let drawn = cloud(Scatter::Rough, 0.3, alpha, degrees, count)?;
    let (sine, cosine) = degrees.to_radians().sin_cos();
    let arrival = rough_arrival(alpha as f32, cosine as f32, sine as f32);
    let (_, above) = drawn.useful();
    let share = |z: f32| f64::from(rough_share(alpha as f32, arrival, z));
    let kept: f64 = drawn.draws.iter().map(|one| share(one.point[2])).sum();
    let bound = f64::from(arrival.bound) * cosine / (alpha * sine).hypot(cosine);
    let whole = 0.5 * (1.0 + bound) * above;
    Ok([1.0 - above, 1.0 - whole, 1.0 - kept / f64::from(count)])
}

fn main() -> lampray::Result<()> {
    let given = std::env::args().nth(1).map(|text| text.parse());
    let Ok(count) = given.unwrap_or(Ok(1_000_000u32)) else {
        return Err(lampray::Error::Usage(
            "DRAWS must be a number of draws".into(),
        ));
    };
    println!(
        "| sigma | alpha | drawn by | {} |",
        ANGLES.map(|angle| format!("{angle} degrees")).join(" | ")
    );
    println!("|---|---|---|{}", "---|".repeat(ANGLES.len()));
    for sigma in SPREADS {
        let alpha = (0.5 * median(sigma)).tan();
        let mut rows = [const { Vec::new() }; 4];
        for degrees in ANGLES {
            let (_, above) = cloud(Scatter::Directional, sigma, alpha, degrees, count)?.useful();
            let [cut, whole, hidden] = facets(alpha, degrees, count)?;
            for (row, share) in rows.iter_mut().zip([1.0 - above, whole, cut, hidden]) {
                row.push(format!("{share:.4}"));
            }
        }
        let names = [
            "half-normal lobe",
            "facets, whole caps",
            "facets, cut caps",
            "hidden by facets",
        ];
        for (name, row) in names.iter().zip(rows) {
            println!("| {sigma} | {alpha:.3} | {name} | {} |", row.join(" | "));
        }
    }
    println!(
        "\nShares of {count} draws; standard errors at most {:.4}.",
        0.5 / f64::from(count).sqrt()
    );
    Ok(())
}
