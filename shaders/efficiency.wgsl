// How many rays should leave a hit so that the whole picture gains most for its cost: efficiency-aware
// Russian roulette and splitting (Rath, Grittmann, Herholz, Weier and Slusallek 2022, "EARS"). What the rays
// that left each body brought in a pilot is the body's worth.

// #import maths

// Of the rays that leave a body, for each unit of squared throughput and channel: their variance (split) and
// their second moment (keep) over their cost, both times the whole picture's cost over its variance.
struct Worth {
    split: vec3<f32>,
    keep: vec3<f32>,
}

// Below this no path is thinned out, so that what the pilot never saw is not lost: as in the paper's program.
const LEAST_CONTINUATIONS: f32 = 0.05;

// The number of rays that should leave a hit: above 1 by what more of them would even out, at most `most`;
// below 1 by what one of them brings; 1 where the two disagree.
fn wanted_continuations(worth: Worth, throughput: vec3<f32>, most: f32) -> f32 {
    let squared = throughput * throughput;
    let split = sqrt(dot(squared, worth.split));
    let keep = sqrt(dot(squared, worth.keep));
    return lesser(greater(split, greater(lesser(keep, 1.0), LEAST_CONTINUATIONS)), most);
}

// A whole number with that expectation, for a number of at least 1 and u in [0, 1).
fn count_continuations(wanted: f32, u: f32) -> u32 {
    let least = floor(wanted);
    return u32(least) + select(0u, 1u, u < wanted - least);
}
