// The numbers of a path where the samples of a pixel are to fill their space more evenly than chance
// does. Still each is a function of (seed, pixel, sample, dimension) alone. The samples of a pixel are
// cut into randomisations of 2^RANDOMISATION_BITS; each is a point set of its own, made random anew, so
// that their means are independent. The four numbers of a dimension are two pairs, and each pair is a
// set of points of the unit square, in an order of its own.

// #import random

override SEQUENCE: u32;
// 4 to 24.
override RANDOMISATION_BITS: u32;

// Pixels along the side of a tile whose points are one set, as a power of two: 0 is each pixel by itself.
fn tile_bits() -> u32 {
    return select(0u, min(8u, (32u - RANDOMISATION_BITS) / 2u), SEQUENCE == SEQUENCE_BLUE_NOISE);
}

// Morton's order of a tile's pixels: the bits of x and y in turn, those of y first.
fn z_order(pixel: vec2<u32>) -> u32 {
    var v = pixel;
    v = (v | (v << vec2<u32>(4u))) & vec2<u32>(0x0f0fu);
    v = (v | (v << vec2<u32>(2u))) & vec2<u32>(0x3333u);
    v = (v | (v << vec2<u32>(1u))) & vec2<u32>(0x5555u);
    return v.x | (v.y << 1u);
}

// What one path draws its numbers from: a hash of what its set is made random by, and its index in the set.
fn sequence_key(seed: vec2<u32>, pixel: vec2<u32>, sample: vec2<u32>) -> vec4<u32> {
    if SEQUENCE == SEQUENCE_INDEPENDENT {
        return random_key(seed, pixel, sample);
    }
    let bits = RANDOMISATION_BITS;
    let randomisation = vec2<u32>((sample.x >> bits) | (sample.y << (32u - bits)), sample.y >> bits);
    let within = sample.x & ((1u << bits) - 1u);
    let tile = tile_bits();
    let place = z_order(pixel & vec2<u32>((1u << tile) - 1u));
    let key = pcg4d(random_key(seed, pixel >> vec2<u32>(tile), randomisation));
    return vec4<u32>(key.xyz, (place << bits) | within);
}

// A hash in which each bit depends on itself and on those below it: with the bits of a fraction from
// the top down, Owen's scrambling. After Laine and Karras, "Stratified Sampling for Stochastic
// Transparency" (2011), as Burley, "Practical Hash-based Owen Scrambling" (JCGT 2020), uses it, with the
// constants of Vegdahl, "Building a Better LK Hash" (2021).
fn laine_karras(bits: vec4<u32>, seed: vec4<u32>) -> vec4<u32> {
    var v = bits;
    v ^= v * 0x3d20adeau;
    v += seed;
    v *= (seed >> vec4<u32>(16u)) | vec4<u32>(1u);
    v ^= v * 0x05526c56u;
    v ^= v * 0x53a22864u;
    return v;
}

// Owen's scrambling of fractions whose bits are given in reverse, the first one lowest.
fn owen_scramble(reversed: vec4<u32>, seed: vec4<u32>) -> vec4<u32> {
    return reverseBits(laine_karras(reversed, seed));
}

// The second dimension of Sobol's sequence, its bits in reverse (the first's are the index itself):
// Pascal's triangle modulo 2, which is [1 1; 0 1] five times multiplied with itself by Kronecker's product.
fn second_dimension(index: vec2<u32>) -> vec2<u32> {
    var v = index;
    v ^= v >> vec2<u32>(16u);
    v ^= (v & vec2<u32>(0xff00ff00u)) >> vec2<u32>(8u);
    v ^= (v & vec2<u32>(0xf0f0f0f0u)) >> vec2<u32>(4u);
    v ^= (v & vec2<u32>(0xccccccccu)) >> vec2<u32>(2u);
    v ^= (v & vec2<u32>(0xaaaaaaaau)) >> vec2<u32>(1u);
    return v;
}

// The images of 0, 1, 2 and 3, two bits each, in the six orders that leave 0 where it is.
fn order_of_three(number: u32) -> u32 {
    return (select(0x786cd8e4u, 0x0000b49cu, number > 3u) >> (8u * (number & 3u))) & 0xffu;
}

// One of the 24 orders of four things, by a hash.
fn permuted_digit(digit: u32, hash: u32) -> u32 {
    let order = order_of_three((hash >> 8u) % 6u);
    return (order >> (2u * ((digit ^ hash) & 3u))) & 3u;
}

// A pixel's place in its tile, the digits of Morton's order shuffled, each by those above it: so that
// each square of four, sixteen, ... pixels together has a well spread set of points, and their errors
// cancel as the eye blurs them. Ahmed and Wonka, "Screen-Space Blue-Noise Diffusion of Monte Carlo
// Sampling Error via Hierarchical Ordering of Pixels" (2020).
fn shuffled_tile(index: u32, seed: u32) -> u32 {
    var shuffled = index & ((1u << RANDOMISATION_BITS) - 1u);
    for (var digit = 0u; digit < tile_bits(); digit++) {
        let shift = RANDOMISATION_BITS + 2u * digit;
        let from_here = index >> shift;
        let hash = pcg4d(vec4<u32>(from_here >> 2u, digit, seed, 0u)).x;
        shuffled |= permuted_digit(from_here & 3u, hash) << shift;
    }
    return shuffled;
}

// Sobol's first two dimensions (Sobol 1967), of which each aligned 2^k samples have one point in every
// box of area 2^-k whose sides are powers of two; so have they after Owen's scrambling (1995) of index and values.
fn sobol_bits(index: vec2<u32>, shuffle: vec2<u32>, scramble: vec4<u32>) -> vec4<u32> {
    let order = owen_scramble(reverseBits(index).xyxy, shuffle.xyxy).xy;
    let second = second_dimension(order);
    return owen_scramble(vec4<u32>(order.x, second.x, order.y, second.y), scramble);
}

// Some order of the numbers below 2^bits: nested from below, then from above.
fn permuted(number: vec4<u32>, bits: vec4<u32>, low: vec4<u32>, high: vec4<u32>) -> vec4<u32> {
    let mask = (vec4<u32>(1u) << bits) - vec4<u32>(1u);
    let turned = reverseBits(laine_karras(number, low) & mask) >> (vec4<u32>(32u) - bits);
    return laine_karras(turned, high) & mask;
}

// Correlated multi-jittered points (Kensler 2013): one in each cell of a grid, each row and each column of the
// finer grid too.
fn stratified_bits(index: u32, seed: vec4<u32>) -> vec4<u32> {
    let bits = RANDOMISATION_BITS;
    let rows = bits / 2u;
    let columns = bits - rows;
    let place = permuted(vec4<u32>(index), vec4<u32>(bits), seed, seed.yzwx).xz;
    let column = place & vec2<u32>((1u << columns) - 1u);
    let row = place >> vec2<u32>(columns);
    let other = pcg4d(seed);
    let coarse = vec4<u32>(column.x, row.x, column.y, row.y);
    let widths = vec4<u32>(columns, rows, columns, rows);
    let fine = permuted(coarse.yxwz, widths.yxwz, other, pcg4d(other));
    let jitter = pcg4d(vec4<u32>(seed.xyz, index));
    return (((coarse << widths.yxwz) | fine) << vec4<u32>(32u - bits)) | (jitter >> vec4<u32>(bits));
}

// Four 32-bit numbers of a dimension, named as `random_bits` does.
fn sequence_bits(key: vec4<u32>, vertex: u32, slot: u32) -> vec4<u32> {
    if SEQUENCE == SEQUENCE_INDEPENDENT {
        return random_bits(key, vertex, slot);
    }
    let seed = pcg4d(vec4<u32>(key.x + vertex, key.y + slot, key.z, 0u));
    if SEQUENCE == SEQUENCE_STRATIFIED {
        return stratified_bits(key.w, seed);
    }
    // A second hash for the second pair alone: what draws two numbers does without.
    let more = pcg4d(seed);
    let shuffle = vec2<u32>(seed.x, more.x);
    let scramble = vec4<u32>(seed.yz, more.yz);
    if SEQUENCE == SEQUENCE_SOBOL {
        return sobol_bits(vec2<u32>(key.w), shuffle, scramble);
    }
    let index = vec2<u32>(shuffled_tile(key.w, seed.w), shuffled_tile(key.w, more.w));
    return sobol_bits(index, shuffle, scramble);
}

// Four numbers in [0, 1).
fn sequence_unit(key: vec4<u32>, vertex: u32, slot: u32) -> vec4<f32> {
    return vec4<f32>(sequence_bits(key, vertex, slot) >> vec4<u32>(8u)) * 5.9604645e-8;
}

// What branch `branch`, counted from 1, of a path that splits draws its numbers from: as `branch_key` has it, or
// another scrambling of the same set.
fn sequence_branch(key: vec4<u32>, vertex: u32, branch: u32) -> vec4<u32> {
    if SEQUENCE == SEQUENCE_INDEPENDENT {
        return branch_key(key, vertex, branch);
    }
    return vec4<u32>(branch_key(vec4<u32>(key.xyz, 0u), vertex, branch).xyz, key.w);
}
