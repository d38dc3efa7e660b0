//! What is known of each pixel without noise: means of the guides of the rays through it.

use super::Watch;
use super::hands::Hands;
use crate::error::Result;
use crate::film::Picture;
use crate::knobs::{Choice, Scatter};
use crate::pack::{Guide, Material, Packed, Rect, Site};
use crate::render::Task;
use glam::{Vec3, Vec4};

/// Rays through a pixel, each way: an edge that crosses it is known to a ninth of it.
const FINENESS: u32 = 3;
/// Pixels of a block, each way: some hundred thousand rays, a fraction of a dispatch's half second.
const BLOCK: [u32; 2] = [256, 48];
/// Below this an albedo is black: what is divided by it would be anything.
const BLACK: f32 = 1e-3;
/// Guides are most of the rays, passes over so few pixels are short.
const SHARE: f64 = 0.3;

/// Sites and shades of a picture, row by row.
pub(super) struct Lit {
    pub sites: Vec<Site>,
    /// What the light was multiplied by on its last way to the eye: albedo and mirrors.
    pub shades: Vec<[f32; 3]>,
}

/// None where `watch` stopped it.
pub(super) fn sites(
    hands: &mut Hands,
    task: &Task,
    picture: &Picture,
    watch: &mut Watch,
) -> Result<Option<Lit>> {
    let region = task.region;
    let mut lit = Lit {
        sites: vec![Site::default(); region.area()],
        shades: vec![[1.0; 3]; region.area()],
    };
    let looks = Looks::new(&hands.packed);
    for y0 in (region.y0..region.y1).step_by(BLOCK[1] as usize) {
        for x0 in (region.x0..region.x1).step_by(BLOCK[0] as usize) {
            let (x1, y1) = (x0 + BLOCK[0], y0 + BLOCK[1]);
            let (x1, y1) = (x1.min(region.x1), y1.min(region.y1));
            let rect = Rect { x0, y0, x1, y1 };
            let guides = hands.ask(|device| device.guides(rect, FINENESS))?;
            lit.fill(&looks, region, rect, &guides, picture);
        }
        let share = f64::from(y0 - region.y0) / f64::from(region.height());
        if watch(SHARE * share).is_break() {
            return Ok(None);
        }
    }
    Ok(Some(lit))
}

impl Lit {
    /// The pixels of `rect`, whose guides come lattice row by lattice row.
    fn fill(
        &mut self,
        looks: &Looks,
        region: Rect,
        rect: Rect,
        guides: &[Guide],
        picture: &Picture,
    ) {
        let fineness = FINENESS as usize;
        let lanes = rect.width() as usize * fineness;
        for index in 0..rect.area() {
            let pixel = rect.pixel(index);
            let (x, y) = (pixel.x0 - rect.x0, pixel.y0 - rect.y0);
            let corner = (y as usize * lanes + x as usize) * fineness;
            let rows = (0..fineness).map(|row| corner + row * lanes);
            let own = rows.flat_map(|start| &guides[start..start + fineness]);
            let column = (pixel.x0 - region.x0) as usize;
            let place = (pixel.y0 - region.y0) as usize * region.width() as usize + column;
            let valid = picture.mean[place].iter().all(|value| value.is_finite());
            (self.sites[place], self.shades[place]) = looks.mean(own, valid);
        }
    }
}

/// How the scene's bodies look, by their place in the scene file.
struct Looks {
    materials: Vec<Material>,
    /// Width of a pixel at distance 1.
    width: f32,
}

impl Looks {
    fn new(scene: &Packed) -> Self {
        let spheres = scene.spheres.iter().map(|sphere| sphere.material);
        let mut boxes: Vec<_> = scene.boxes.iter().map(|body| (body.id, body.material)).collect();
        boxes.sort_unstable();
        let numbers = spheres.chain(boxes.into_iter().map(|(_, material)| material));
        let camera = &scene.camera;
        Self {
            materials: numbers.map(|number| scene.materials[number as usize]).collect(),
            width: Vec3::from(camera.down).length() * camera.pixel[1],
        }
    }

    /// The means of a pixel's guides, and its shade.
    fn mean<'a>(&self, guides: impl Iterator<Item = &'a Guide>, valid: bool) -> (Site, [f32; 3]) {
        let (mut normal, mut position, mut shade) = (Vec3::ZERO, Vec3::ZERO, Vec3::ZERO);
        let (mut kind, mut distance) = (Vec4::ZERO, 0.0);
        for guide in guides {
            normal += Vec3::from(guide.normal);
            position += Vec3::from(guide.position);
            distance += guide.distance;
            let (own_shade, own_kind) = self.look(guide);
            shade += own_shade;
            kind += own_kind;
        }
        let share = 1.0 / (FINENESS * FINENESS) as f32;
        let site = Site {
            normal: (normal * share).to_array(),
            footprint: distance * share * self.width,
            position: (position * share).to_array(),
            valid: if valid { 1.0 } else { 0.0 },
            kind: (kind * share).to_array(),
        };
        (site, (shade * share).to_array())
    }

    /// What one ray's light was multiplied by, and what kind of surface it found.
    fn look(&self, guide: &Guide) -> (Vec3, Vec4) {
        let mirrors = Vec4::X * guide.mirrors as f32;
        let tint = Vec3::from(guide.tint);
        let bare = |shade: Vec3| (shade.max(Vec3::splat(BLACK)), dark(shade));
        let material = match guide.id.checked_sub(1) {
            Some(body) => &self.materials[body as usize],
            None => {
                let (shade, dark) = bare(tint);
                return (shade, mirrors + Vec4::Y + dark);
            }
        };
        // What emits shows its own light beside what it reflects.
        if material.emission != [0.0; 3] {
            let (shade, dark) = bare(tint);
            return (shade, mirrors + Vec4::Y + dark);
        }
        let (shade, dark) = bare(tint * Vec3::from(material.albedo));
        let satin = material.scatter != Scatter::Diffuse.index();
        (shade, mirrors + dark + if satin { Vec4::Z } else { Vec4::ZERO })
    }
}

/// The share of channels in which a surface is black.
fn dark(shade: Vec3) -> Vec4 {
    let black = shade.to_array().iter().filter(|value| **value < BLACK).count();
    Vec4::W * (black as f32 / 3.0)
}
