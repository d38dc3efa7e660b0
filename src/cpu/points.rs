//! Twin of `shaders/points.wgsl`: draws by the light and scatter samplers.

use super::light::{drawn_height, lamp_cone, light_pole, sample_light, sample_surface};
use super::maths::{Basis, greater};
use super::scatter::sample_scatter;
use super::sequence::{sequence_key, sequence_unit};
use crate::knobs::LightSampler;
use crate::pack::{Draw, PointsJob, Strategy};
use glam::{Vec2, Vec3, Vec4};

fn draw_light(strategy: &Strategy, job: &PointsJob, u: Vec4) -> Draw {
    let pole = Basis {
        x: job.pole.x.into(),
        y: job.pole.y.into(),
        z: job.pole.z.into(),
    };
    let receiver = Vec3::from(job.receiver);
    let inside = job.inside == 1;
    let normal = job.normal.into();
    let light = sample_light(strategy, &job.lamp, pole, receiver, normal, inside, u);
    let cone = lamp_cone(&job.lamp, receiver);
    let by_cone = strategy.light_sampler == LightSampler::Cone && cone.open && !inside;
    let outward = if by_cone || strategy.light_sampler == LightSampler::ProjectedCap {
        (receiver + light.distance * light.direction - Vec3::from(job.lamp.center)).normalize()
    } else {
        let height = drawn_height(strategy, &job.lamp, cone, inside);
        sample_surface(strategy, light_pole(strategy, pole, cone), height, u)
    };
    let seen = light.inverse_density > 0.0;
    let density = if seen {
        1.0 / greater(light.inverse_density, 1e-30)
    } else {
        0.0
    };
    Draw {
        point: outward.to_array(),
        density,
        useful: u32::from(seen),
        ..Draw::default()
    }
}

fn draw_scatter(strategy: &Strategy, job: &PointsJob, u: Vec4) -> Draw {
    let normal = Vec3::from(job.normal);
    let incoming = Vec3::from(job.incoming);
    let scattered = sample_scatter(
        strategy,
        &job.material,
        normal,
        incoming,
        job.inside == 1,
        Vec2::new(u.x, u.y),
    );
    let useful = u32::from(scattered.direction.dot(normal) > 0.0);
    Draw {
        point: scattered.direction.to_array(),
        density: scattered.density,
        useful,
        ..Draw::default()
    }
}

/// Draw number `lane` of a job.
pub fn draw(strategy: &Strategy, job: &PointsJob, lane: u32) -> Draw {
    let (low, carry) = job.first[0].overflowing_add(lane);
    let number = [low, job.first[1] + u32::from(carry)];
    let key = sequence_key(strategy, job.seed, [0, 0], number);
    let u = Vec4::from(sequence_unit(strategy, key, 1, 1));
    if job.scattering == 1 {
        draw_scatter(strategy, job, u)
    } else {
        draw_light(strategy, job, u)
    }
}
