//! The canaries: what each asks, what it expects, and who judges.

use super::ask::Ask;
use super::{floats, loops, memory, numbers, picture};
use crate::device::Limits;
use crate::error::Result;

/// What was found, as an error where it is not what was expected.
pub type Verdict = std::result::Result<String, String>;

/// One canary.
pub struct Canary {
    pub name: &'static str,
    pub expected: &'static str,
    /// The device's answer as plain words, or none where it says nothing of such a device.
    pub ask: fn(&mut Ask) -> Result<Option<Vec<u32>>>,
    pub judge: fn(&[u32], Option<Limits>) -> Verdict,
}

macro_rules! canaries {
    ($($name:literal, $expected:expr, $ask:path, $judge:path;)+) => {
        pub const CANARIES: &[Canary] = &[$(Canary {
            name: $name,
            expected: $expected,
            ask: $ask,
            judge: $judge,
        }),+];

        /// The canaries' names, in the order in which they are asked.
        pub const NAMES: &[&str] = &[$($name),+];
    };
}

canaries! {
    "integers", "as WGSL says: wrapping, x / 0 = x, x % 0 = 0, shifts",
        numbers::ask_integers, numbers::judge_integers;
    "random", "65,536 words as the CPU twin draws them", numbers::ask_random, numbers::judge_random;
    "conversion", "floats out of range become the nearest integer, 24 bits make a float exactly",
        numbers::ask_conversion, numbers::judge_conversion;
    "layout", "every member of every struct, bit for bit", memory::ask_layout, memory::judge_layout;
    "bounds", "reads past the end give 0 or data of the buffer, writes leave it alone",
        memory::ask_bounds, memory::judge_bounds;
    "buffers", "bindings of at least 128 MiB", memory::ask_buffers, memory::judge_buffers;
    "finite", "NaN and infinity told by their bits", floats::ask_finite, floats::judge_finite;
    "denormals", "kept or flushed to zero, and the smallest normal number kept",
        floats::ask_denormals, floats::judge_denormals;
    "floats", "division within 2.5 ULP, sqrt 4.5, inverseSqrt 2.5, sine and cosine of a turn within 8e-7",
        floats::ask_floats, floats::judge_floats;
    "loops", "10^6 iterations, nested and divergent; or a stop that is allowed for",
        loops::ask_loops, loops::judge_loops;
    "wait", "a dispatch of 2e7 iterations ends with all lanes done", loops::ask_wait, loops::judge_wait;
    "picture", "8x8 pixels of a sphere under an even sky, to 1e-5", picture::ask_picture, picture::judge_picture;
}

/// Words as rows of four.
pub fn rows(words: &[u32]) -> impl Iterator<Item = [u32; 4]> {
    words
        .chunks_exact(4)
        .map(|row| [row[0], row[1], row[2], row[3]])
}

/// Judges rows one by one against their inputs: the first that is wrong is shown.
pub fn judge_rows<I: Copy + std::fmt::Debug>(
    words: &[u32],
    inputs: &[I],
    right: impl Fn(I, [u32; 4]) -> bool,
    praise: String,
) -> Verdict {
    if words.len() != 4 * inputs.len() {
        return Err(format!("{} words for {} inputs", words.len(), inputs.len()));
    }
    let answers = inputs.iter().zip(rows(words));
    let mut wrong = answers.filter(|(input, answer)| !right(**input, *answer));
    match wrong.next() {
        None => Ok(praise),
        Some((input, answer)) => Err(format!(
            "{} of {} wrong: {input:x?} gives {answer:x?}",
            1 + wrong.count(),
            inputs.len()
        )),
    }
}
