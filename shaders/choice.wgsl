// Which lamp a hit's shadow ray goes to, where it goes to one alone, and how probable that was.
//
// This library reads a binding of group 0: `choice_at`, whose entries src/pack/choice lays out. For
// `uniform` and `power` they are an alias table (Walker 1977), one slot an entry: threshold, the other lamp,
// probability of the slot's own lamp. For `tree` they are three entries a pair, then the lamps' paths.

// #import maths
// #import sequence
// #import scene
// #import light_tree

override LIGHT_CHOICE: u32;

struct Chosen {
    lamp: u32,
    inverse_probability: f32,
}

// There is one lamp at least; without any, nothing of this is asked.
fn last_lamp() -> u32 {
    return max(LAMP_COUNT, 1u) - 1u;
}

// The slots are a power of two, so that the top bits of a word tell one without preference; a second
// word is held against its threshold.
fn chosen_by_table(bits: vec4<u32>) -> Chosen {
    let places = 32u - countLeadingZeros(last_lamp());
    let slot = (bits.x >> 1u) >> (31u - places);
    let entry = choice_at(slot);
    let lamp = select(entry.y, slot, bits.y < entry.x);
    return Chosen(lamp, 1.0 / bitcast<f32>(choice_at(lamp).z));
}

fn light_pair_at(place: u32) -> LightPair {
    let last = choice_at(3u * place + 2u);
    return LightPair(
        bitcast<vec4<f32>>(choice_at(3u * place)),
        bitcast<vec4<f32>>(choice_at(3u * place + 1u)),
        bitcast<vec2<f32>>(last.xy),
        last.zw,
    );
}

// Where a walk begins: at the first pair, or with a single lamp at its end.
fn light_root() -> u32 {
    return select(0u, LEAF, last_lamp() == 0u);
}

// What is left of a probability after one more pair: a share of WHOLE_SHARE parts.
fn taken(probability: f32, share: u32, second: bool) -> f32 {
    return probability * (f32(select(share, WHOLE_SHARE - share, second)) * (1.0 / f32(WHOLE_SHARE)));
}

// From the first pair down. Each pair has a number of its own: one that is stretched from pair to pair
// would run out of bits.
fn chosen_by_tree(random: vec4<u32>, point: vec3<f32>, normal: vec3<f32>) -> Chosen {
    var bits = random;
    var link = light_root();
    var probability = 1.0;
    var level = 0u;
    while (link & LEAF) == 0u {
        let pair = light_pair_at(link);
        let share = first_share(pair, point, normal);
        let second = (bits.x >> 8u) >= share;
        probability = taken(probability, share, second);
        link = select(pair.link.x, pair.link.y, second);
        level += 1u;
        bits = bits.yzwx;
        if (level & 3u) == 0u {
            bits = pcg4d(bits);
        }
    }
    return Chosen(link & ~LEAF, 1.0 / greater(probability, 1e-30));
}

// One of the lamps, of which there must be some, for a point of a surface with this normal.
fn choose_lamp(key: vec4<u32>, vertex: u32, point: vec3<f32>, normal: vec3<f32>) -> Chosen {
    let bits = sequence_bits(key, vertex, 2u);
    if LIGHT_CHOICE == LIGHT_CHOICE_TREE {
        return chosen_by_tree(bits, point, normal);
    }
    return chosen_by_table(bits);
}

// The same walk along the path to one lamp: a bit a pair, the first pair's lowest.
fn tree_probability(lamp: u32, point: vec3<f32>, normal: vec3<f32>) -> f32 {
    let paths = choice_at(3u * last_lamp() + lamp / 4u);
    var path = paths[lamp & 3u];
    var link = light_root();
    var probability = 1.0;
    while (link & LEAF) == 0u {
        let pair = light_pair_at(link);
        let second = (path & 1u) == 1u;
        probability = taken(probability, first_share(pair, point, normal), second);
        link = select(pair.link.x, pair.link.y, second);
        path >>= 1u;
    }
    return probability;
}

// The probability with which `choose_lamp` gives this lamp; 1 where every lamp has its own shadow ray.
fn choice_probability(lamp: u32, point: vec3<f32>, normal: vec3<f32>) -> f32 {
    if LIGHT_CHOICE == LIGHT_CHOICE_ALL {
        return 1.0;
    }
    if LIGHT_CHOICE == LIGHT_CHOICE_TREE {
        return tree_probability(lamp, point, normal);
    }
    return bitcast<f32>(choice_at(lamp).z);
}
