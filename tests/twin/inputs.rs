//! Inputs of each function: drawn at random, after every edge that the function has.

use crate::support::stream::Stream;
use lampray::pack::ProbeInput;

/// Inputs a case.
const COUNT: usize = 8192;

/// The largest number that the generator gives.
pub const LAST: f32 = 1.0 - 1.0 / 16_777_216.0;

pub fn many(seed: u64, mut draw: impl FnMut(usize, &mut Stream) -> ProbeInput) -> Vec<ProbeInput> {
    let mut stream = Stream::new(seed);
    (0..COUNT).map(|place| draw(place, &mut stream)).collect()
}

/// One of the edges for the first inputs, then even in [low, high].
pub fn edged(place: usize, edges: &[f32], stream: &mut Stream, low: f64, high: f64) -> f32 {
    let drawn = stream.between(low, high) as f32;
    edges.get(place).copied().unwrap_or(drawn)
}

/// A random number as the generator gives them, each edge with each other in its turn.
pub fn unit(place: usize, turn: usize, stream: &mut Stream) -> f32 {
    let edges = [0.0, 1.0 / 16_777_216.0, 0.25, 0.5, 0.75, LAST];
    let drawn = (stream.bits() >> 40) as f32 / 16_777_216.0;
    let digit = place / edges.len().pow(turn as u32) % edges.len();
    if place < edges.len().pow(4) {
        edges[digit]
    } else {
        drawn
    }
}

/// Axes, diagonals and vectors close to the lower pole first, then even over the sphere.
pub fn direction(place: usize, stream: &mut Stream) -> [f32; 3] {
    const EDGES: [[f64; 3]; 12] = [
        [0.0, 0.0, 1.0],
        [0.0, 0.0, -1.0],
        [1.0, 0.0, 0.0],
        [-1.0, 0.0, 0.0],
        [0.0, 1.0, 0.0],
        [0.0, -1.0, 0.0],
        [1e-4, 0.0, -1.0],
        [1e-3, -1e-3, -1.0],
        [1.0, 0.0, 1e-7],
        [1.0, 0.0, -1e-7],
        [1.0, 1.0, 1.0],
        [-1.0, -1.0, -1.0],
    ];
    let v = stream.direction();
    let v = EDGES.get(place).copied().unwrap_or(v);
    let size = v.iter().map(|x| x * x).sum::<f64>().sqrt();
    v.map(|x| (x / size) as f32)
}

pub fn four(v: [f32; 3], w: f32) -> [f32; 4] {
    [v[0], v[1], v[2], w]
}

/// A sphere of any size, an origin up to 1e5 radii away (one in eight inside), and a direction:
/// at the sphere, past its edge, or anywhere.
pub fn sphere_and_ray(place: usize, stream: &mut Stream) -> ProbeInput {
    let radius = stream.scale(1e-3, 1e3);
    let away = match place % 8 {
        0 => radius * stream.between(0.0, 0.999),
        _ => radius * stream.scale(1.001, 1e5),
    };
    let toward = stream.direction();
    let center = stream.direction().map(|x| x * radius);
    let origin: [f64; 3] = std::array::from_fn(|i| center[i] - away * toward[i]);
    let rim = stream.direction();
    let aim: [f64; 3] = match place % 3 {
        0 => rim,
        _ => std::array::from_fn(|i| center[i] + 1.2 * radius * rim[i] - origin[i]),
    };
    let size = aim.iter().map(|x| x * x).sum::<f64>().sqrt();
    ProbeInput {
        a: four(center.map(|x| x as f32), radius as f32),
        b: four(origin.map(|x| x as f32), 0.0),
        c: four(aim.map(|x| (x / size) as f32), 0.0),
        ..ProbeInput::default()
    }
}

/// A box around the origin, a ray's start in or out of it, and a direction, some along the axes.
pub fn box_and_ray(place: usize, stream: &mut Stream) -> ProbeInput {
    let scale = stream.scale(1e-3, 1e3);
    let half = [0; 3].map(|_| (scale * stream.scale(0.01, 1.0)) as f32);
    let reach = if place.is_multiple_of(4) { 0.99 } else { 20.0 };
    let origin = half.map(|h| (f64::from(h) * stream.between(-reach, reach)) as f32);
    let inner = half.map(|h| f64::from(h) * stream.between(-1.2, 1.2));
    let aim: [f64; 3] = std::array::from_fn(|i| inner[i] - f64::from(origin[i]));
    let size = aim.iter().map(|x| x * x).sum::<f64>().sqrt();
    let aimed = aim.map(|x| (x / size) as f32);
    let chosen = if place < 12 || place % 16 == 1 {
        direction(place % 12, stream)
    } else {
        aimed
    };
    ProbeInput {
        a: four(half, 0.0),
        b: four(origin, 0.0),
        c: four(chosen, 0.0),
        ..ProbeInput::default()
    }
}

/// A unit normal and a unit direction that arrives from its side.
pub fn arrival(place: usize, stream: &mut Stream) -> ([f32; 3], [f32; 3]) {
    let normal = direction(place, stream);
    let any = direction(place / 12, stream);
    let along: f32 = normal.iter().zip(any).map(|(n, a)| n * a).sum();
    let incoming = if along > 0.0 { any.map(|x| -x) } else { any };
    (normal, incoming)
}

/// A lamp and an origin: outside from near to far, inside, or on it.
pub fn lamp_and_origin(place: usize, stream: &mut Stream) -> (ProbeInput, bool) {
    let radius = stream.scale(1e-2, 1e2);
    let inside = place.is_multiple_of(4);
    let away = match place % 4 {
        0 => stream.between(0.0, 0.999),
        1 => stream.between(1.00001, 1.01),
        2 => stream.between(1.01, 4.0),
        _ => stream.scale(4.0, 1e4),
    };
    let toward = direction(place / 4, stream);
    let center = stream.direction().map(|x| (x * radius) as f32);
    let origin = std::array::from_fn(|i| {
        (f64::from(center[i]) - radius * away * f64::from(toward[i])) as f32
    });
    let input = ProbeInput {
        a: four(center, radius as f32),
        b: four(origin, (radius * 1.5) as f32),
        d: [f32::from(u8::from(inside)), 0.0, 0.0, 0.0],
        ..ProbeInput::default()
    };
    (input, inside)
}
