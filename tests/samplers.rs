//! Every sampler's draws against the density it states: chi-square on both devices, through the
//! calls that `lampray points` makes.
//!
//! Densities are written here from their definitions in f64; the renderer's own are compared with
//! them draw by draw. Seeds are fixed; the level is 0.01 for all tests of a device together.

mod support;

use glam::DVec3;
use lampray::cpu::Cpu;
use lampray::cpu::light::{LampHit, light_inverse_density};
use lampray::cpu::maths;
use lampray::cpu::scatter::scatter_density;
use lampray::device::Device;
use lampray::knobs::*;
use lampray::pack::{Basis, Draw, Lamp, Material, PointsJob, Strategy, words};
use std::f64::consts::{FRAC_PI_2, PI, SQRT_2, TAU};
use support::chance::{Fit, fit, sidak};

const LEVEL: f64 = 0.01;
const TWIN_DRAWS: usize = 1_000_000;
const GPU_DRAWS: usize = 200_000;
const POLAR: usize = 20;
const AROUND: usize = 32;

type Density = Box<dyn Fn(DVec3) -> f64 + Sync>;

/// A sampler and what is known of it.
struct Sampling {
    name: String,
    strategy: Strategy,
    job: PointsJob,
    /// Axis of the cells, and the polar angle that they reach to.
    axis: DVec3,
    limit: f64,
    /// Of the drawn unit vectors, by area of the unit sphere.
    density: Density,
    /// From that to the density by solid angle that the renderer states; 0 for what is not seen.
    stated: Density,
    /// Share of draws without a density: the ring that a clamp piles up.
    ring: f64,
    /// A density that is wrong in the way that this sampler invites.
    mutant: Density,
}

fn job() -> PointsJob {
    let [low, high] = words(0x1f2e_3d4c_5b6a_7988);
    PointsJob {
        seed: [low, high],
        // Draws pass from one high word to the next on their way.
        first: words((1 << 32) - 1000),
        ..PointsJob::default()
    }
}

fn narrow(v: DVec3) -> [f32; 3] {
    v.as_vec3().to_array()
}

fn packed_basis(z: DVec3) -> Basis {
    let (x, y) = z.any_orthonormal_pair();
    Basis {
        x: narrow(x),
        y: narrow(y),
        z: narrow(z),
        ..Basis::default()
    }
}

/// Where the lamp is seen from, in radii from its centre.
#[derive(Clone, Copy, Debug)]
enum Place {
    Far,
    Near,
    Inside,
}

impl Place {
    fn away(self) -> f64 {
        match self {
            Place::Far => 10.0,
            Place::Near => 1.05,
            Place::Inside => 0.4,
        }
    }
}

/// Area density of case 1 (both angles even), and of everything that is even by area.
fn surface_density(sampler: LightSampler, outward: DVec3, pole: DVec3) -> f64 {
    match sampler {
        LightSampler::UniformAngles => 1.0 / (TAU * PI * outward.cross(pole).length().max(1e-12)),
        _ => 1.0 / (4.0 * PI),
    }
}

/// Density of the cone's directions, carried over to the unit sphere around the lamp's centre: the
/// lamp has radius 1 and `to_receiver` leads from its centre.
fn cone_density(outward: DVec3, to_receiver: DVec3) -> f64 {
    let distance = to_receiver.length();
    let solid_angle = TAU * (1.0 - (1.0 - 1.0 / (distance * distance)).sqrt());
    by_solid_angle(outward, to_receiver).map_or(0.0, |ratio| ratio / solid_angle)
}

/// Solid angle over area at a point of the unit sphere; none where it faces away.
fn by_solid_angle(outward: DVec3, to_receiver: DVec3) -> Option<f64> {
    let to = to_receiver - outward;
    let cosine = outward.dot(to) / to.length();
    let inside = to_receiver.length() < 1.0;
    let seen = if inside { cosine.abs() } else { cosine };
    (seen > 0.0).then(|| seen / to.length_squared())
}

const RADIUS: f64 = 0.35;

fn light(sampler: LightSampler, place: Place, pole_at_receiver: bool) -> Sampling {
    let to_receiver = place.away() * DVec3::new(0.36, -0.48, 0.8).normalize();
    let center = DVec3::new(0.7, 1.1, -0.4);
    let given = DVec3::new(-0.2, 0.9, 0.3).normalize();
    let pole = if pole_at_receiver {
        to_receiver.normalize()
    } else {
        given
    };
    let inside = matches!(place, Place::Inside);
    let by_cone = sampler == LightSampler::Cone && !inside;
    let density = move |outward: DVec3| match by_cone {
        true => cone_density(outward, to_receiver),
        false => surface_density(sampler, outward, pole),
    };
    let stated = move |outward: DVec3| {
        by_solid_angle(outward, to_receiver).map_or(0.0, |ratio| density(outward) / ratio)
    };
    // The other law of area; for the cone, a receiver that is a tenth of the way further off.
    let mutant = move |outward: DVec3| match sampler {
        LightSampler::UniformAngles => 1.0 / (4.0 * PI),
        LightSampler::Cone if !inside => cone_density(outward, 1.1 * to_receiver),
        _ => surface_density(LightSampler::UniformAngles, outward, pole),
    };
    let limit = if by_cone {
        (1.0 / to_receiver.length()).acos()
    } else {
        PI
    };
    Sampling {
        name: format!("{sampler} {place:?} receiver pole: {pole_at_receiver}"),
        strategy: Strategy {
            light_sampler: sampler,
            pole_at_receiver,
            ..support::strategy()
        },
        job: PointsJob {
            lamp: Lamp {
                center: narrow(center),
                radius: RADIUS as f32,
                emission: [1.0; 3],
                body: 1,
                weight_radius: RADIUS as f32,
                ..Lamp::default()
            },
            pole: packed_basis(given),
            receiver: narrow(center + RADIUS * to_receiver),
            inside: u32::from(inside),
            ..job()
        },
        axis: if by_cone {
            to_receiver.normalize()
        } else {
            pole
        },
        limit,
        density: Box::new(density),
        stated: Box::new(stated),
        ring: 0.0,
        mutant: Box::new(mutant),
    }
}

fn scatter_job(
    scatter: Scatter,
    spread: f64,
    mass: f64,
    normal: DVec3,
    incoming: DVec3,
) -> PointsJob {
    let scale = (2.0 / PI).sqrt() / (spread * mass * TAU);
    PointsJob {
        material: Material {
            albedo: [0.8; 3],
            scatter: scatter.index(),
            survival: 1.0,
            spread: spread as f32,
            lobe_mass: mass as f32,
            lobe_scale: scale as f32,
            ..Material::default()
        },
        normal: narrow(normal),
        incoming: narrow(incoming),
        scattering: 1,
        ..job()
    }
}

fn arrival() -> (DVec3, DVec3) {
    (
        DVec3::new(0.1, 0.7, -0.5).normalize(),
        DVec3::new(0.8, -0.5, 0.2).normalize(),
    )
}

/// Density by the cosine to the normal.
type Law = fn(f64) -> f64;

fn diffuse(law: ScatterDiffuse) -> Sampling {
    let (normal, incoming) = arrival();
    let even = |out: f64| if out >= 0.0 { 1.0 / TAU } else { 0.0 };
    let cosine = |out: f64| out.max(0.0) / PI;
    let (density, mutant): (Law, Law) = match law {
        ScatterDiffuse::Cosine => (cosine, |out| {
            if out >= 0.0 {
                0.95 * out / PI + 0.05 / TAU
            } else {
                0.0
            }
        }),
        ScatterDiffuse::Uniform => (even, cosine),
    };
    Sampling {
        name: format!("diffuse {law}"),
        strategy: Strategy {
            scatter_diffuse: law,
            ..support::strategy()
        },
        job: scatter_job(Scatter::Diffuse, 1.0, 1.0, normal, incoming),
        axis: normal,
        limit: FRAC_PI_2,
        density: Box::new(move |v| density(v.dot(normal))),
        stated: Box::new(move |v| density(v.dot(normal))),
        ring: 0.0,
        mutant: Box::new(move |v| mutant(v.dot(normal))),
    }
}

/// The half-normal law of the paper's directional scattering, by solid angle.
fn lobe(theta: f64, spread: f64, mass: f64) -> f64 {
    let law = (2.0 / PI).sqrt() / (spread * mass) * (-0.5 * (theta / spread).powi(2)).exp();
    if theta < FRAC_PI_2 {
        law / (TAU * theta.sin().max(1e-9))
    } else {
        0.0
    }
}

fn directional(bound: ScatterBound, spread: f64) -> Sampling {
    let (normal, incoming) = arrival();
    let mirror = incoming - 2.0 * normal.dot(incoming) * normal;
    let below = libm::erf(FRAC_PI_2 / (SQRT_2 * spread));
    let mass = if bound == ScatterBound::Truncate {
        below
    } else {
        1.0
    };
    let density = move |v: DVec3| lobe(v.angle_between(mirror), spread, mass);
    let mutant = move |v: DVec3| lobe(v.angle_between(mirror), 1.02 * spread, mass);
    Sampling {
        name: format!("directional {bound} {spread}"),
        strategy: Strategy {
            scatter_bound: bound,
            ..support::strategy()
        },
        job: scatter_job(Scatter::Directional, spread, mass, normal, incoming),
        axis: mirror,
        limit: FRAC_PI_2.min(5.0 * spread),
        density: Box::new(density),
        stated: Box::new(density),
        ring: if bound == ScatterBound::Clamp {
            1.0 - below
        } else {
            0.0
        },
        mutant: Box::new(mutant),
    }
}

fn samplings() -> Vec<Sampling> {
    let mut all = Vec::new();
    for &sampler in LightSampler::ALL {
        for place in [Place::Far, Place::Near, Place::Inside] {
            all.extend([false, true].map(|pole| light(sampler, place, pole)));
        }
    }
    all.extend(ScatterDiffuse::ALL.iter().map(|&law| diffuse(law)));
    for &bound in ScatterBound::ALL {
        all.extend([0.05, 0.3, 1.0].map(|spread| directional(bound, spread)));
    }
    all
}

/// A place on the unit sphere as (polar angle, azimuth) about the axis.
fn angles(v: DVec3, axes: (DVec3, DVec3, DVec3)) -> (f64, f64) {
    let (x, y, z) = (v.dot(axes.0), v.dot(axes.1), v.dot(axes.2));
    let around = y.atan2(x);
    (
        x.hypot(y).atan2(z),
        if around < 0.0 { around + TAU } else { around },
    )
}

fn axes(z: DVec3) -> (DVec3, DVec3, DVec3) {
    let (x, y) = z.any_orthonormal_pair();
    (x, y, z)
}

/// Share of the draws that each cell should have, by midpoints; then the rest beyond the limit.
fn shares(of: &Sampling, density: &Density) -> Vec<f64> {
    const FINE: usize = 12;
    let (x, y, z) = axes(of.axis);
    let (high, wide) = (
        of.limit / (POLAR * FINE) as f64,
        TAU / (AROUND * FINE) as f64,
    );
    let mut shares = vec![0.0; POLAR * AROUND];
    for i in 0..POLAR * FINE {
        let (sine, cosine) = ((i as f64 + 0.5) * high).sin_cos();
        for j in 0..AROUND * FINE {
            let (up, along) = ((j as f64 + 0.5) * wide).sin_cos();
            let v = sine * (along * x + up * y) + cosine * z;
            shares[i / FINE * AROUND + j / FINE] += density(v) * sine * high * wide;
        }
    }
    let rest = 1.0 - of.ring - shares.iter().sum::<f64>();
    shares.push(rest.max(0.0));
    shares.push(of.ring);
    shares
}

/// Draws in each cell, beyond the limit, and on the ring.
fn counts(of: &Sampling, draws: &[Draw]) -> Vec<f64> {
    let axes = axes(of.axis);
    let mut counts = vec![0.0; POLAR * AROUND + 2];
    for draw in draws {
        let (polar, around) = angles(wide(draw), axes);
        let (row, column) = (
            polar / of.limit * POLAR as f64,
            around / TAU * AROUND as f64,
        );
        // A rounding error beyond the limit is not beyond it.
        let within = polar < of.limit * (1.0 + 1e-5);
        let ring = of.ring > 0.0 && draw.density == 0.0;
        let cell = match (ring, within) {
            (true, _) => POLAR * AROUND + 1,
            (false, false) => POLAR * AROUND,
            _ => (row as usize).min(POLAR - 1) * AROUND + (column as usize).min(AROUND - 1),
        };
        counts[cell] += 1.0;
    }
    counts
}

fn wide(draw: &Draw) -> DVec3 {
    DVec3::from_array(draw.point.map(f64::from))
}

fn test(of: &Sampling, density: &Density, draws: &[Draw]) -> Fit {
    let expected: Vec<_> = shares(of, density)
        .iter()
        .map(|p| p * draws.len() as f64)
        .collect();
    fit(&counts(of, draws), &expected)
}

/// The draws are unit vectors, count where they should, and state the density they have.
fn check_draws(device: &str, of: &Sampling, draws: &[Draw]) {
    let mut off = 0;
    for draw in draws {
        let v = wide(draw);
        assert!(
            (v.length() - 1.0).abs() < 1e-5,
            "{device} {}: {draw:?}",
            of.name
        );
        if of.job.scattering == 1 {
            let up = v.dot(DVec3::from_array(of.job.normal.map(f64::from)));
            assert!(
                up.abs() < 1e-5 || (up > 0.0) == (draw.useful == 1),
                "{device}: {draw:?}"
            );
        } else {
            assert_eq!(
                draw.useful == 1,
                draw.density > 0.0,
                "{device} {}: {draw:?}",
                of.name
            );
        }
        if of.ring > 0.0 && draw.density == 0.0 {
            continue;
        }
        let wanted = (of.stated)(v);
        let close = (f64::from(draw.density) / wanted - 1.0).abs() < 0.01;
        off += usize::from(!close && draw.density.max(wanted as f32) > 1e-6);
    }
    // Only where the density is steep within f32's rounding of a direction: at the lobe's middle,
    // at the pole, at the rim. A wrong factor shows in every draw.
    assert!(
        off * 200 <= draws.len(),
        "{device} {}: {off} densities are off",
        of.name
    );
}

fn gate(device: &mut dyn Device, name: &str, draws: usize) {
    let all = samplings();
    let level = sidak(LEVEL, all.len());
    for of in &all {
        let job = PointsJob {
            count: draws as u32,
            ..of.job
        };
        let drawn = device.points(&of.strategy, &job).unwrap();
        assert_eq!(drawn.len(), draws);
        check_draws(name, of, &drawn);
        let right = test(of, &of.density, &drawn);
        assert!(
            right.p >= level,
            "{name} {}: {right:?} at level {level:.1e}",
            of.name
        );
        let wrong = test(of, &of.mutant, &drawn);
        assert!(
            wrong.p < level,
            "{name} {}: the wrong density passes: {wrong:?}",
            of.name
        );
    }
}

#[test]
fn the_twin_draws_by_its_densities() {
    gate(&mut Cpu::new(), "twin", TWIN_DRAWS);
}

#[test]
fn the_gpu_draws_by_its_densities() {
    if let Some(mut gpu) = support::gpu("chi-square tests of the samplers") {
        gate(&mut *gpu, "gpu", GPU_DRAWS);
    }
}

#[test]
fn references_integrate_to_one() {
    for of in samplings() {
        let shares = shares(&of, &of.density);
        let sum: f64 = shares[..POLAR * AROUND].iter().sum();
        let cut = shares[POLAR * AROUND];
        let (lobe, tail) = (of.job.scattering == 1, libm::erfc(5.0 / SQRT_2));
        assert!((sum + of.ring - 1.0).abs() < 1e-3, "{}: {sum}", of.name);
        assert!(
            cut <= if lobe { 1e-3 + tail } else { 1e-3 },
            "{}: {cut}",
            of.name
        );
    }
}

/// Integral over the sphere, about an axis that need not be the density's own.
fn integral(axis: DVec3, limit: f64, density: impl Fn(DVec3) -> f64) -> f64 {
    const STEPS: usize = 600;
    let (x, y, z) = axes(axis);
    let (high, wide) = (limit / STEPS as f64, TAU / STEPS as f64);
    let mut sum = 0.0;
    for i in 0..STEPS {
        let (sine, cosine) = ((i as f64 + 0.5) * high).sin_cos();
        for j in 0..STEPS {
            let (up, along) = ((j as f64 + 0.5) * wide).sin_cos();
            sum += density(sine * (along * x + up * y) + cosine * z) * sine;
        }
    }
    sum * high * wide
}

/// The renderer's own density of what it scatters, over all directions.
fn scattered_mass(of: &Sampling) -> f64 {
    let (job, [normal, incoming]) = (&of.job, [of.job.normal, of.job.incoming].map(Into::into));
    integral(of.axis, of.limit, |v| {
        scatter_density(&of.strategy, &job.material, normal, incoming, v.as_vec3()).into()
    })
}

/// The same for light: over the lamp's points, since every direction to it leads to one.
fn light_mass(of: &Sampling) -> f64 {
    let [x, y, z] = [of.job.pole.x, of.job.pole.y, of.job.pole.z].map(Into::into);
    let (lamp, origin) = (&of.job.lamp, glam::Vec3::from(of.job.receiver));
    let to_receiver = (origin - glam::Vec3::from(lamp.center)).as_dvec3() / RADIUS;
    integral(of.axis, of.limit, |outward| {
        let point = glam::Vec3::from(lamp.center) + lamp.radius * outward.as_vec3();
        let distance = point.distance(origin);
        let hit = LampHit {
            inside: of.job.inside == 1,
            direction: (point - origin) / distance,
            distance,
            outward: outward.as_vec3(),
        };
        let pole = maths::Basis { x, y, z };
        let inverse = light_inverse_density(&of.strategy, lamp, pole, origin, hit);
        let area = by_solid_angle(outward, to_receiver).unwrap_or(0.0);
        if inverse > 0.0 {
            area / f64::from(inverse)
        } else {
            0.0
        }
    })
}

#[test]
fn the_renderers_densities_integrate_to_one() {
    for of in samplings() {
        if of.job.scattering == 1 {
            let sum = scattered_mass(&of) + of.ring;
            assert!((sum - 1.0).abs() < 1e-3, "{}: {sum}", of.name);
            continue;
        }
        let to_receiver = DVec3::from_array(of.job.receiver.map(f64::from))
            - DVec3::from_array(of.job.lamp.center.map(f64::from));
        // From outside only the points that face the receiver have a density.
        let seen = integral(of.axis, of.limit, |v| {
            by_solid_angle(v, to_receiver / RADIUS).map_or(0.0, |_| (of.density)(v))
        });
        let sum = light_mass(&of);
        assert!((sum - seen).abs() < 1e-3, "{}: {sum}, not {seen}", of.name);
        let all = of.job.inside == 1 || of.strategy.light_sampler == LightSampler::Cone;
        assert!(!all || (sum - 1.0).abs() < 1e-3, "{}: {sum}", of.name);
    }
}

#[test]
fn a_density_that_is_off_by_a_hundredth_does_not_integrate_to_one() {
    let of = diffuse(ScatterDiffuse::Cosine);
    let wrong = 1.01 * scattered_mass(&of);
    assert!((wrong - 1.0).abs() > 1e-3);
}

/// Share of the points within 30 degrees of either pole, and the largest distance between the
/// distribution of the polar angle and that of points even by area (Kolmogorov and Smirnov).
fn crowding(device: &mut dyn Device, sampler: LightSampler, count: usize) -> (f64, f64) {
    let of = light(sampler, Place::Far, false);
    let job = PointsJob {
        count: count as u32,
        ..of.job
    };
    let draws = device.points(&of.strategy, &job).unwrap();
    let mut heights: Vec<_> = draws.iter().map(|draw| wide(draw).dot(of.axis)).collect();
    heights.sort_by(f64::total_cmp);
    let near = heights
        .iter()
        .filter(|z| z.abs() > (PI / 6.0).cos())
        .count();
    let apart = heights.iter().enumerate().map(|(place, z)| {
        let even = 0.5 * (1.0 + z);
        let (below, at) = (
            place as f64 / count as f64,
            (place + 1) as f64 / count as f64,
        );
        (below - even).abs().max((at - even).abs())
    });
    (near as f64 / count as f64, apart.fold(0.0, f64::max))
}

fn check_crowding(device: &mut dyn Device, count: usize) {
    // Four standard errors of a share, and of an empirical distribution at one place.
    let margin = 4.0 * 0.5 / (count as f64).sqrt();
    let even = 1.0 - (PI / 6.0).cos();
    for (sampler, share, distance) in [
        (LightSampler::UniformAngles, 1.0 / 3.0, 0.1053),
        (LightSampler::InverseCosine, even, 0.0),
        (LightSampler::Gaussian, even, 0.0),
    ] {
        let (near, apart) = crowding(device, sampler, count);
        println!("{sampler}: {near:.4} within 30 degrees of a pole, distance {apart:.4}");
        assert!((near - share).abs() < margin, "{sampler}: {near}");
        assert!((apart - distance).abs() < margin, "{sampler}: {apart}");
    }
}

#[test]
fn points_crowd_at_the_poles_as_the_paper_says() {
    check_crowding(&mut Cpu::new(), TWIN_DRAWS);
    if let Some(mut gpu) = support::gpu("how points crowd at the poles") {
        check_crowding(&mut *gpu, GPU_DRAWS);
    }
}
