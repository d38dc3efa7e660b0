//! Twin of `shaders/random.wgsl`: stateless random numbers, equal to the GPU's bit for bit.

/// Jarzynski and Olano, "Hash Functions for GPU Rendering" (JCGT 2020).
pub fn pcg4d(input: [u32; 4]) -> [u32; 4] {
    let [mut x, mut y, mut z, mut w] =
        input.map(|v| v.wrapping_mul(1_664_525).wrapping_add(1_013_904_223));
    x = x.wrapping_add(y.wrapping_mul(w));
    y = y.wrapping_add(z.wrapping_mul(x));
    z = z.wrapping_add(x.wrapping_mul(y));
    w = w.wrapping_add(y.wrapping_mul(z));
    [x, y, z, w] = [x ^ x >> 16, y ^ y >> 16, z ^ z >> 16, w ^ w >> 16];
    x = x.wrapping_add(y.wrapping_mul(w));
    y = y.wrapping_add(z.wrapping_mul(x));
    z = z.wrapping_add(x.wrapping_mul(y));
    w = w.wrapping_add(y.wrapping_mul(z));
    [x, y, z, w]
}

/// What one path draws its numbers from. Pixel (x, y) in the whole image; seed and sample as (low, high).
pub fn random_key(seed: [u32; 2], pixel: [u32; 2], sample: [u32; 2]) -> [u32; 4] {
    let [x, y, z, w] = pcg4d([pixel[0] | pixel[1] << 16, sample[0], sample[1], seed[0]]);
    [x, y, z, w ^ seed[1]]
}

/// Four 32-bit numbers of a dimension: `vertex` is 0 for the camera and k + 1 for hit k; `slot` is
/// 0 for scattering and interruption and i + 1 for lamp i.
pub fn random_bits(key: [u32; 4], vertex: u32, slot: u32) -> [u32; 4] {
    pcg4d([
        key[0].wrapping_add(vertex),
        key[1].wrapping_add(slot),
        key[2],
        key[3],
    ])
}

/// Four numbers in [0, 1).
pub fn random_unit(key: [u32; 4], vertex: u32, slot: u32) -> [f32; 4] {
    random_bits(key, vertex, slot).map(|bits| (bits >> 8) as f32 * 5.960_464_5e-8)
}

/// What branch `branch`, counted from 1, of a path that splits draws its numbers from; the path goes on with
/// its own key as branch 0. No draw's dimension has a third part, so that branches share no number with draws.
pub fn branch_key(key: [u32; 4], vertex: u32, branch: u32) -> [u32; 4] {
    pcg4d([
        key[0].wrapping_add(vertex),
        key[1],
        key[2].wrapping_add(branch),
        key[3],
    ])
}
