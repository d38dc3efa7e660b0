//! Long loops, and waiting for them. Mesa's software drivers used to leave all loops of a lane after
//! 65,535 iterations without a word. Where lampray knows of it its work comes in pieces; the
//! canary holds that it knows.

use super::ask::Ask;
use super::canaries::{Verdict, judge_rows, rows};
use crate::device::Limits;
use crate::error::Result;
use crate::shader::Canary;
use std::time::Instant;

/// Lanes that loop: they leave the last loop one after the other.
const LANES: u32 = 8;

/// Loops that every device must take, in three parts: short ones, a nested and a single long one. Outer,
/// inner and single iterations, and the seed.
fn inputs() -> [Vec<[u32; 4]>; 3] {
    let lanes = 0..LANES;
    let short = |lane| [200, 100, 30_000 - 997 * lane, lane];
    let nested = |lane| [1000, 1000, 0, lane];
    let single = |lane| [0, 0, 1_000_000 - 1009 * lane, lane];
    [
        lanes.clone().map(short).collect(),
        lanes.clone().map(nested).collect(),
        lanes.map(single).collect(),
    ]
}

/// What the generator gives after many steps, by squaring (Brown, "Random Number Generation with Arbitrary
/// Strides", 1994).
fn after(seed: u32, mut steps: u32) -> u32 {
    let (mut factor, mut term) = (1_664_525u32, 1_013_904_223u32);
    let mut state = seed;
    while steps > 0 {
        if steps & 1 == 1 {
            state = state.wrapping_mul(factor).wrapping_add(term);
        }
        term = term.wrapping_mul(factor.wrapping_add(1));
        factor = factor.wrapping_mul(factor);
        steps >>= 1;
    }
    state
}

fn expected([outer, inner, single, seed]: [u32; 4]) -> [u32; 4] {
    let nested = outer * inner;
    [after(seed, nested), nested, after(seed, single), single]
}

pub fn ask_loops(ask: &mut Ask) -> Result<Option<Vec<u32>>> {
    let mut words = Vec::new();
    for part in inputs() {
        match ask.canary(Canary::Loops, &part)? {
            Some(answers) => words.extend(answers),
            None => return Ok(None),
        }
    }
    Ok(Some(words))
}

pub fn judge_loops(words: &[u32], limits: Option<Limits>) -> Verdict {
    let [short, nested, single] = inputs();
    let (first, long) = words.split_at(words.len().min(4 * short.len()));
    let right = |input, answer| expected(input) == answer;
    judge_rows(first, &short, right, String::new())?;
    let inputs = [nested, single].concat();
    let all = judge_rows(long, &inputs, right, "go on for 10^6 iterations".into());
    let planned = limits.and_then(|limits| limits.loop_iterations);
    let stops = || rows(long).map(|[_, nested, _, single]| nested.max(single));
    match (all, planned, stops().min(), stops().max()) {
        (Ok(praise), ..) => Ok(praise),
        // Of nested loops only the inner one's iterations are counted here: the driver counts both.
        (Err(_), Some(planned), Some(first), Some(last)) if first >= planned => {
            Ok(format!("stop at {}, allowed for", thousands(last)))
        }
        (Err(fault), None, ..) => Err(format!("{fault}, which is not allowed for")),
        (Err(fault), Some(planned), ..) => Err(format!(
            "{fault}, and only stops after {} are allowed for",
            thousands(planned)
        )),
    }
}

/// 65,535.
fn thousands(number: u32) -> String {
    match number / 1000 {
        0 => number.to_string(),
        high => format!("{},{:03}", thousands(high), number % 1000),
    }
}

/// Lanes and iterations of the dispatch that is waited for.
const WAITED: (u32, u32) = (512, 40_000);

fn waited() -> Vec<[u32; 4]> {
    (0..WAITED.0).map(|lane| [0, 0, WAITED.1, lane]).collect()
}

/// With the milliseconds that it took after the answers.
pub fn ask_wait(ask: &mut Ask) -> Result<Option<Vec<u32>>> {
    let started = Instant::now();
    let mut answers = ask.canary(Canary::Loops, &waited())?;
    if let Some(words) = &mut answers {
        words.push(started.elapsed().as_millis() as u32);
    }
    Ok(answers)
}

pub fn judge_wait(words: &[u32], _: Option<Limits>) -> Verdict {
    let (took, answers) = words.split_last().ok_or("nothing")?;
    let praise = format!("{} lanes done after {took} ms", WAITED.0);
    let right = |input, answer| expected(input) == answer;
    judge_rows(answers, &waited(), right, praise)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn limits(loop_iterations: Option<u32>) -> Option<Limits> {
        Some(Limits {
            storage_binding: 1 << 27,
            buffer: 1 << 28,
            groups: 65_535,
            group_lanes: 1024,
            loop_iterations,
        })
    }

    /// What a device answers that leaves loops after so many iterations.
    fn answers(most: u32) -> Vec<u32> {
        let answer = |[outer, inner, single, seed]: [u32; 4]| {
            expected([(outer * inner).min(most), 1, single.min(most), seed])
        };
        inputs().concat().into_iter().flat_map(answer).collect()
    }

    #[test]
    fn strides_are_steps() {
        let mut state = 5;
        for steps in 0..100 {
            assert_eq!(after(5, steps), state);
            state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        }
    }

    #[test]
    fn a_stop_passes_only_where_it_is_allowed_for() {
        let (free, known) = (limits(None), limits(Some(65_000)));
        for limits in [free, known] {
            let verdict = judge_loops(&answers(u32::MAX), limits);
            assert_eq!(verdict, Ok("go on for 10^6 iterations".into()));
        }
        let stop = answers(65_535);
        assert_eq!(
            judge_loops(&stop, known),
            Ok("stop at 65,535, allowed for".into())
        );
        let fault = judge_loops(&stop, free).unwrap_err();
        assert!(fault.ends_with("not allowed for"), "{fault}");
        // Earlier than is allowed for, and so early that no plan is possible.
        assert!(judge_loops(&answers(60_000), known).is_err());
        assert!(judge_loops(&answers(10_000), known).is_err());
        assert!(judge_loops(&answers(999_999), free).is_err());
        // A wrong number in the short loops.
        let mut wrong = stop;
        wrong[0] ^= 1;
        assert!(judge_loops(&wrong, known).is_err());
        assert!(judge_loops(&[], known).is_err());
    }

    #[test]
    fn a_lane_that_was_not_waited_for_is_seen() {
        let mut words: Vec<u32> = waited().into_iter().flat_map(expected).collect();
        words.push(12);
        assert_eq!(
            judge_wait(&words, None),
            Ok("512 lanes done after 12 ms".into())
        );
        let last = words.len() - 5;
        words[last..last + 4].fill(0);
        assert!(judge_wait(&words, None).is_err());
    }

    #[test]
    fn numbers_are_grouped() {
        assert_eq!(thousands(65_535), "65,535");
        assert_eq!(thousands(7), "7");
        assert_eq!(thousands(1_000_005), "1,000,005");
    }
}
