//! Twin of `shaders/guides.wgsl`: what the denoiser knows of a pixel without noise.

use super::camera::{camera_direction, sample_film};
use super::ray::{Ray, offset_origin};
use super::scatter::mirror_direction;
use super::scene::{Traversal, surface_at};
use crate::knobs::{Choice, Scatter};
use crate::pack::{Guide, GuideJob, Material, Packed};
use glam::{Vec2, Vec3};

fn follows(material: &Material) -> bool {
    material.scatter == Scatter::Mirror.index() && material.emission == [0.0; 3]
}

/// The end of a ray's way through the mirrors.
fn guide_at(scene: &Packed, bodies: &impl Traversal, job: &GuideJob, film: Vec2) -> Guide {
    let mut guide = Guide::default();
    let mut ray = Ray {
        origin: Vec3::ZERO,
        direction: camera_direction(&job.camera, film),
        source: 0,
        inside: false,
    };
    let mut tint = Vec3::ONE;
    let mut way = 0.0;
    for mirrors in 0..=job.mirrors {
        let hit = bodies.nearest_hit(&ray);
        if hit.body == 0 {
            return Guide {
                tint: tint.to_array(),
                mirrors,
                ..Guide::default()
            };
        }
        let surface = surface_at(scene, hit, &ray);
        way += hit.distance;
        guide = Guide {
            normal: surface.normal.to_array(),
            distance: way,
            position: surface.point.to_array(),
            id: surface.id,
            tint: tint.to_array(),
            mirrors,
        };
        let material = &scene.materials[surface.material as usize];
        if !follows(material) {
            break;
        }
        tint *= Vec3::from(material.albedo);
        ray = Ray {
            origin: offset_origin(surface.point, surface.normal),
            direction: mirror_direction(surface.normal, ray.direction),
            source: surface.body,
            inside: surface.inside,
        };
    }
    guide
}

/// Where in its pixel a ray starts: no two in one column or one row, so that edges along them are known as well
/// as others (Kensler 2013, section 2, without the jitter).
fn place_of(fineness: u32, cell: [u32; 2]) -> Vec2 {
    let at = Vec2::new(cell[0] as f32, cell[1] as f32);
    let fineness = fineness as f32;
    (at + (Vec2::new(at.y, at.x) + 0.5) / fineness) / fineness
}

/// The guide of one lane of a job.
pub fn guide(
    scene: &Packed,
    bodies: &impl Traversal,
    job: &GuideJob,
    [column, row]: [u32; 2],
) -> Guide {
    let fineness = job.fineness;
    let pixel = [
        job.corner[0] + column / fineness,
        job.corner[1] + row / fineness,
    ];
    let place = place_of(fineness, [column % fineness, row % fineness]);
    let film = sample_film(scene.strategy.filter, pixel, place);
    guide_at(scene, bodies, job, film)
}
