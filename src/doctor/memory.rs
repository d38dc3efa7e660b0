//! Memory: structs as both sides lay them out, accesses past the end, and room.

use super::ask::Ask;
use super::canaries::{Verdict, judge_rows};
use crate::device::Limits;
use crate::error::Result;
use crate::pack::{CanaryJob, CanaryScene, Vec3};
use crate::shader::Canary;

/// Words that are different everywhere and, as floats, ordinary numbers: no device changes their bits.
fn known<const WORDS: usize>(first: u32) -> [u32; WORDS] {
    std::array::from_fn(|place| {
        let number = first + place as u32;
        0x3f80_0000 | (number.wrapping_mul(0x9e37) & 0x007f_ffff)
    })
}

/// A job whose every word is known.
pub fn known_job() -> CanaryJob {
    bytemuck::cast(known::<{ size_of::<CanaryJob>() / 4 }>(1))
}

/// Two scenes whose every word is known: the second shows the distance between them.
pub fn known_scenes() -> Vec<CanaryScene> {
    const WORDS: usize = size_of::<CanaryScene>() / 4;
    [1001, 2001]
        .map(|first| bytemuck::cast(known::<WORDS>(first)))
        .to_vec()
}

fn bits(v: Vec3, last: u32) -> [u32; 4] {
    [v[0].to_bits(), v[1].to_bits(), v[2].to_bits(), last]
}

/// The members in the order in which the kernel tells them.
fn scene_rows(scene: &CanaryScene) -> [[u32; 4]; 13] {
    let CanaryScene {
        material,
        lamp,
        sphere,
        body,
    } = scene;
    let lobe = [material.spread, material.lobe_mass, material.lobe_scale];
    [
        bits(material.albedo, material.scatter),
        bits(material.emission, material.survival.to_bits()),
        bits(lobe, material.shape.to_bits()),
        bits(lamp.center, lamp.radius.to_bits()),
        bits(lamp.emission, lamp.body),
        [lamp.weight_radius.to_bits(), 0, 0, 0],
        bits(sphere.center, sphere.radius.to_bits()),
        [sphere.material, sphere.lamp, sphere.body, 0],
        bits(body.center, body.material),
        bits(body.half_size, body.id),
        bits(body.axis_x, body.body),
        bits(body.axis_y, 0),
        bits(body.axis_z, 0),
    ]
}

fn job_rows(job: &CanaryJob) -> [[u32; 4]; 9] {
    let [width, height] = job.camera.pixel;
    [
        bits(job.camera.forward, job.camera.aperture.to_bits()),
        bits(job.camera.right, job.camera.focus.to_bits()),
        bits(job.camera.down, 0),
        [width.to_bits(), height.to_bits(), 0, 0],
        bits(job.pole.x, 0),
        bits(job.pole.y, 0),
        bits(job.pole.z, 0),
        bits(job.background, job.clamp.to_bits()),
        [job.corner[0], job.corner[1], job.seed[0], job.seed[1]],
    ]
}

/// Place and row of what the kernel is asked for, with the right answer.
fn layout_rows() -> Vec<([u32; 2], [u32; 4])> {
    let job = known_job();
    let place = |place: u32, rows: &[[u32; 4]]| {
        let number = 0..rows.len() as u32;
        let asked = number.map(move |row| [place, row]);
        asked.zip(rows.to_vec()).collect::<Vec<_>>()
    };
    let mut all = place(0, &job_rows(&job));
    all.extend(place(1, &scene_rows(&job.scene)));
    for (scene, number) in known_scenes().iter().zip(2..) {
        all.extend(place(number, &scene_rows(scene)));
    }
    all
}

pub fn ask_layout(ask: &mut Ask) -> Result<Option<Vec<u32>>> {
    let rows = layout_rows();
    let inputs: Vec<_> = rows.iter().map(|([x, y], _)| [*x, *y, 0, 0]).collect();
    ask.canary(Canary::Layout, &inputs)
}

pub fn judge_layout(words: &[u32], _: Option<Limits>) -> Verdict {
    let rows = layout_rows();
    let praise = format!(
        "{} rows of members, in uniform and storage buffers",
        rows.len()
    );
    judge_rows(words, &rows, |(_, right), answer| right == answer, praise)
}

/// Lanes that reach past the end. The last one's own place is left out: a device may move what is out of
/// range to the end of the buffer.
const REACHING: u32 = 65;

fn bounds_inputs() -> Vec<[u32; 4]> {
    (0..REACHING).map(|lane| [0xa000_0000 + lane; 4]).collect()
}

pub fn ask_bounds(ask: &mut Ask) -> Result<Option<Vec<u32>>> {
    ask.canary(Canary::Bounds, &bounds_inputs())
}

pub fn judge_bounds(words: &[u32], _: Option<Limits>) -> Verdict {
    let mut inputs = bounds_inputs();
    inputs.pop();
    let answers = &words[..words.len().min(4 * inputs.len())];
    let inside = |word: &u32| *word == 0 || (0xa000_0000..0xa000_0000 + REACHING).contains(word);
    let right = |[own, ..]: [u32; 4], [found, reads @ ..]: [u32; 4]| {
        found == own && reads.iter().all(inside)
    };
    let zero = answers.chunks(4).all(|row| row[1..] == [0; 3]);
    let read = if zero { "0" } else { "data of the buffer" };
    let praise = format!("reads give {read}, the rest is intact");
    judge_rows(answers, &inputs, right, praise)
}

/// The largest binding that is planned for, and what every WebGPU device has.
const BINDING: u64 = 128 << 20;

pub fn ask_buffers(ask: &mut Ask) -> Result<Option<Vec<u32>>> {
    let size = ask.limits.map(|limits| limits.storage_binding);
    Ok(size.map(|size| vec![(size >> 32) as u32, size as u32]))
}

pub fn judge_buffers(words: &[u32], _: Option<Limits>) -> Verdict {
    let size = words
        .iter()
        .fold(0, |size, word| size << 32 | u64::from(*word));
    let found = format!("{} MiB", size >> 20);
    if size >= BINDING {
        Ok(found)
    } else {
        Err(found)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::HashSet;

    #[test]
    fn every_known_word_is_another() {
        let job: [u32; size_of::<CanaryJob>() / 4] = bytemuck::cast(known_job());
        let scenes = known_scenes();
        let words = job.iter().chain(bytemuck::cast_slice(&scenes));
        let all: HashSet<_> = words.clone().collect();
        assert_eq!(all.len(), words.count());
    }

    #[test]
    fn one_member_in_the_wrong_place_is_seen() {
        let right: Vec<u32> = layout_rows().into_iter().flat_map(|row| row.1).collect();
        assert!(judge_layout(&right, None).is_ok());
        for place in 0..right.len() - 1 {
            let mut wrong = right.clone();
            wrong.swap(place, place + 1);
            assert!(
                wrong == right || judge_layout(&wrong, None).is_err(),
                "{place}"
            );
        }
        assert!(judge_layout(&right[4..], None).is_err());
    }

    #[test]
    fn data_that_was_written_over_is_seen() {
        let right: Vec<u32> = bounds_inputs()
            .into_iter()
            .flat_map(|[own, ..]| [own, 0, 0xa000_0001, 0])
            .collect();
        assert!(judge_bounds(&right, None).is_ok());
        let mut moved = right.clone();
        let last = moved.len() - 4;
        moved[last..].fill(0xdead_beef);
        assert!(judge_bounds(&moved, None).is_ok());
        for place in [0, 4, 7, last - 4] {
            let mut wrong = right.clone();
            wrong[place] = 0xdead_beef;
            assert!(judge_bounds(&wrong, None).is_err(), "word {place}");
        }
    }

    #[test]
    fn room_is_judged() {
        assert_eq!(judge_buffers(&[0, 128 << 20], None), Ok("128 MiB".into()));
        assert_eq!(judge_buffers(&[1, 0], None), Ok("4096 MiB".into()));
        assert_eq!(
            judge_buffers(&[0, (128 << 20) - 1], None),
            Err("127 MiB".into())
        );
    }
}
