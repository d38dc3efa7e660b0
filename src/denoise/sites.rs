//! What is known of each pixel without noise: means of the guides of the rays through it.

use super::hands::Hands;
use super::light::BLACK;
use super::passes::widths;
use super::{GUIDES, Watch};
use crate::cpu::denoise::site_distance;
use crate::cpu::maths::lesser;
use crate::error::Result;
use crate::film::Denoising;
use crate::knobs::{Choice, Scatter};
use crate::pack::{DenoiseJob, Guide, Material, Packed, Rect, Site};
use crate::render::Task;
use glam::{Vec3, Vec4};

/// Rays through a pixel, each way: an edge that crosses it is known to a sixteenth of it.
const FINENESS: u32 = 4;
/// Pixels of a block, each way: some two hundred thousand rays, a fraction of a dispatch's half second.
const BLOCK: [u32; 2] = [256, 48];
/// The largest spread: beyond, a pixel that the background shows through would be like everything.
const WIDEST: f32 = 30.0;
/// Added to the share of what emits where any of it reaches the eye: however wide a pixel's spread, nothing is left of
/// the weight of one that sees none, (8 - 1)^2 KIND / (1 + WIDEST) being above FARTHEST. What shines may be millions of
/// times as bright as what is beside it: the least share of its light there would be seen.
const SHINES: f32 = 8.0;

/// Sites of a picture and what is seen at them, row by row.
pub(super) struct Lit {
    pub sites: Vec<Site>,
    /// Shares of light that come from there to the eye, by albedo and mirrors.
    pub reflected: Vec<[f32; 3]>,
    /// Radiance that comes from there to the eye because it shines.
    pub shining: Vec<[f32; 3]>,
}

/// None where `watch` stopped it.
pub(super) fn sites(
    hands: &mut Hands,
    task: &Task,
    by: Denoising,
    watch: &mut Watch,
) -> Result<Option<Lit>> {
    let region = task.region;
    let mut lit = Lit {
        sites: vec![Site::default(); region.area()],
        reflected: vec![[1.0; 3]; region.area()],
        shining: vec![[0.0; 3]; region.area()],
    };
    let looks = Looks::new(&hands.packed, widths(by));
    for y0 in (region.y0..region.y1).step_by(BLOCK[1] as usize) {
        for x0 in (region.x0..region.x1).step_by(BLOCK[0] as usize) {
            let (x1, y1) = (x0 + BLOCK[0], y0 + BLOCK[1]);
            let (x1, y1) = (x1.min(region.x1), y1.min(region.y1));
            let rect = Rect { x0, y0, x1, y1 };
            let guides = hands.ask(|device| device.guides(rect, FINENESS))?;
            lit.fill(&looks, region, rect, &guides);
        }
        let share = f64::from(y0 - region.y0) / f64::from(region.height());
        if watch(GUIDES * share).is_break() {
            return Ok(None);
        }
    }
    Ok(Some(lit))
}

impl Lit {
    /// The pixels of `rect`, whose guides come lattice row by lattice row.
    fn fill(&mut self, looks: &Looks, region: Rect, rect: Rect, guides: &[Guide]) {
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
            let (site, reflected, shining) = looks.mean(own);
            self.sites[place] = site;
            self.reflected[place] = reflected.to_array();
            self.shining[place] = shining.to_array();
        }
    }
}

/// How the scene's bodies look, by their place in the scene file.
struct Looks {
    materials: Vec<Material>,
    background: Vec3,
    /// Width of a pixel at distance 1.
    width: f32,
    /// How distances between sites are measured.
    job: DenoiseJob,
}

impl Looks {
    fn new(scene: &Packed, job: DenoiseJob) -> Self {
        let spheres = scene.spheres.iter().map(|sphere| sphere.material);
        let mut boxes: Vec<_> = scene
            .boxes
            .iter()
            .map(|body| (body.id, body.material))
            .collect();
        boxes.sort_unstable();
        let numbers = spheres.chain(boxes.into_iter().map(|(_, material)| material));
        let camera = &scene.camera;
        Self {
            materials: numbers
                .map(|number| scene.materials[number as usize])
                .collect(),
            background: scene.background.into(),
            width: Vec3::from(camera.down).length() * camera.pixel[1],
            job,
        }
    }

    /// The site of a pixel, and what it reflects and how it shines: means over its guides.
    fn mean<'a>(&self, guides: impl Iterator<Item = &'a Guide>) -> (Site, Vec3, Vec3) {
        let seen: Vec<_> = guides.map(|guide| self.look(guide)).collect();
        let share = 1.0 / seen.len() as f32;
        let mut mean = Site::default();
        let (mut reflected, mut shining) = (Vec3::ZERO, Vec3::ZERO);
        for (site, own_reflected, own_shining) in &seen {
            reflected += *own_reflected * share;
            shining += *own_shining * share;
            mean.normal = (Vec3::from(mean.normal) + share * Vec3::from(site.normal)).to_array();
            mean.position =
                (Vec3::from(mean.position) + share * Vec3::from(site.position)).to_array();
            mean.footprint += share * site.footprint;
            mean.kind = (Vec4::from(mean.kind) + share * Vec4::from(site.kind)).to_array();
        }
        let apart = |(site, ..): &(Site, Vec3, Vec3)| site_distance(&self.job, site, &mean);
        mean.spread = lesser(seen.iter().map(apart).sum::<f32>() * share, WIDEST);
        if shining != Vec3::ZERO {
            mean.kind[1] += SHINES;
        }
        (mean, reflected, shining)
    }

    /// The site of one ray, what it reflects and how it shines.
    fn look(&self, guide: &Guide) -> (Site, Vec3, Vec3) {
        let material = guide
            .id
            .checked_sub(1)
            .map(|body| &self.materials[body as usize]);
        // What shines is divided by its emission: how much of a pixel a lamp fills is known better than its paths
        // could say.
        let (albedo, emission) = match material {
            None => (Vec3::ZERO, self.background),
            Some(material) => (material.albedo.into(), material.emission.into()),
        };
        let tint = Vec3::from(guide.tint);
        let (reflected, shining) = (albedo * tint, emission * tint);
        let emits = material.is_none_or(|material| material.emission != [0.0; 3]);
        let matt = material.is_some_and(|material| material.scatter == Scatter::Diffuse.index());
        let dark = |channel: &usize| reflected[*channel] < BLACK && shining[*channel] == 0.0;
        let black = (0..3).filter(dark).count();
        let share = |yes: bool| if yes { 1.0 } else { 0.0 };
        let site = Site {
            normal: guide.normal,
            footprint: guide.distance * self.width,
            position: guide.position,
            spread: 0.0,
            kind: [
                guide.mirrors as f32,
                share(emits),
                share(!emits && !matt),
                black as f32 / 3.0,
            ],
        };
        let least = if emits { 0.0 } else { BLACK };
        (site, reflected.max(Vec3::splat(least)), shining)
    }
}
