// Stateless random numbers: each is a function of (seed, pixel, sample, dimension) alone, so
// crops, sample ranges, tiles and resumed renders draw the same ones.
// The hash is pcg4d: Jarzynski and Olano, "Hash Functions for GPU Rendering" (JCGT 2020).

fn pcg4d(input: vec4<u32>) -> vec4<u32> {
    var v = input * 1664525u + 1013904223u;
    v.x += v.y * v.w;
    v.y += v.z * v.x;
    v.z += v.x * v.y;
    v.w += v.y * v.z;
    v ^= v >> vec4<u32>(16u);
    v.x += v.y * v.w;
    v.y += v.z * v.x;
    v.z += v.x * v.y;
    v.w += v.y * v.z;
    return v;
}

// What one path draws its numbers from. `pixel` is (x, y) in the whole image, each below 2^16;
// seed and sample are 64 bits as (low, high). pcg4d is a bijection, so no two addresses of one
// seed share a key.
fn random_key(seed: vec2<u32>, pixel: vec2<u32>, sample: vec2<u32>) -> vec4<u32> {
    let place = pcg4d(vec4<u32>(pixel.x | (pixel.y << 16u), sample.x, sample.y, seed.x));
    return vec4<u32>(place.xyz, place.w ^ seed.y);
}

// Four 32-bit numbers. A dimension is a pair: `vertex` is 0 for the camera and k + 1 for hit k;
// `slot` is 0 for scattering and interruption and i + 1 for lamp i; where one lamp is drawn, 1 is for the
// point on it and 2 for the choice.
fn random_bits(key: vec4<u32>, vertex: u32, slot: u32) -> vec4<u32> {
    return pcg4d(key + vec4<u32>(vertex, slot, 0u, 0u));
}

// Four numbers in [0, 1): the top 24 bits, so that none rounds up to 1.
fn random_unit(key: vec4<u32>, vertex: u32, slot: u32) -> vec4<f32> {
    return vec4<f32>(random_bits(key, vertex, slot) >> vec4<u32>(8u)) * 5.9604645e-8;
}

// What branch `branch`, counted from 1, of a path that splits draws its numbers from; the path goes on with its
// own key as branch 0. No draw's dimension has a third part, so that branches share no number with draws.
fn branch_key(key: vec4<u32>, vertex: u32, branch: u32) -> vec4<u32> {
    return pcg4d(key + vec4<u32>(vertex, 0u, branch, 0u));
}
