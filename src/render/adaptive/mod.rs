//! Samples where the error is: how `--target-error` shares them out.
//!
//! # The rule
//!
//! The picture is cut into tiles. *Scouts*, samples that are not in the picture, tell how noisy each tile is: 16
//! a pixel first, and where a tile turns out to need more than [`TRUST`] times its scouts, twice as many, until none
//! does. From the scouts alone follows how many samples each tile of the picture gets ([`allot`]); the picture
//! is the plain mean of these.
//!
//! # Why each pixel's expectation is the truth
//!
//! Let X1, X2, ... be the samples of a pixel that the picture may take, S all scouts of all pixels, and n(S) the
//! samples that the pixel gets. A sample is a function of its address alone, and no scout shares an address with
//! a sample of a picture: scouts have the indices from 2^63 on, which no range of samples reaches. So the X are
//! independent of S and have the expectation mu, whatever S is, and
//!
//! E[(X1 + ... + Xn) / n] = E[ E[(X1 + ... + Xn) / n | S] ] = E[ n mu / n ] = mu.
//!
//! The sample variance over n is, for the same reason, an estimate without bias of the mean's variance given S:
//! what the file says of its noise holds as it does for a number of samples that was fixed beforehand. Ranges of
//! samples stay disjoint from each other and from the scouts, and so add up by `merge`, weighted by counts, to a
//! picture without bias too.
//!
//! The naive rule, which goes on until a tile's own samples say that their error is small, has n depend on
//! the X: where by chance no rare bright path was met the error looks small, the tile ends, and stays too dark.
//! Two halves that steer each other do better, but over several rounds not quite: what half A met decides how
//! far B goes, and so what B meets, which decides how far A goes on. Here nothing comes back. The price is the
//! scouts: a thirty-second to a sixteenth of the samples of tiles that need many, a run a pixel at least.
//!
//! # How it is run
//!
//! [`next`] hands out one piece of [`Work`] after another: the fewest samples that any tile gets, so that
//! there is a picture early; rounds of scouts; the rest. Each follows from the sums so far, so that a
//! checkpoint has all that is needed.

mod allot;
mod rungs;
mod smooth;
mod work;

pub(super) use work::Work;

use crate::film::{Film, SCOUTS, Scouts, Tiles};
use crate::pack::{RUN_LENGTH, Rect};
use std::ops::Range;

/// The rule's name in records.
pub(super) const RULE: &str = "scouts";

/// Scouts of each pixel in the first round: a run.
const FIRST_SCOUTS: u64 = RUN_LENGTH as u64;
/// Samples that a scout can speak for. With 16 nothing is gained that is worth the scouts, with 48 more is given
/// than is needed: measured in the rooms that ship.
const TRUST: u64 = 32;

/// An adaptive render of which nothing is done.
pub(super) fn scouts(region: Rect) -> Scouts {
    Scouts::new(region, FIRST_SCOUTS)
}

/// What a render wants with a target error.
#[derive(Clone, Debug)]
pub(super) struct Terms {
    /// The samples that a pixel may get.
    pub samples: Range<u64>,
    pub target: f64,
}

impl Terms {
    /// Samples that every pixel gets.
    fn least(&self) -> u64 {
        rungs::whole(&self.samples, rungs::FIRST)
    }

    /// The rest of a picture where every pixel is to have `wanted`, by tiles.
    fn picture(&self, film: &Film, wanted: Vec<u64>) -> Work {
        Work::new(
            film.region,
            self.samples.clone(),
            film.counts.clone(),
            wanted,
            rungs::FIRST,
        )
    }
}

/// The rest of the scouts that were asked for.
fn of_scouts(scouts: &Scouts) -> Work {
    let film = &scouts.film;
    Work::new(
        film.region,
        SCOUTS..u64::MAX,
        film.counts.clone(),
        scouts.asked.clone(),
        // Nobody sees them on their way.
        u64::MAX,
    )
}

/// What is to be done next, where everything before is done; nothing where that was all.
pub(super) fn next(terms: &Terms, film: &Film, scouts: &mut Scouts) -> Option<Work> {
    let some = |work: Work| (!work.is_empty()).then_some(work);
    let tiles = Tiles::of(film.region).count();
    let least = || some(terms.picture(film, vec![terms.least(); tiles]));
    if scouts.wanted.is_empty() {
        let begun = least().or_else(|| some(of_scouts(scouts)));
        if begun.is_some() {
            return begun;
        }
        decide(terms, scouts);
        if scouts.wanted.is_empty() {
            return Some(of_scouts(scouts));
        }
    }
    some(terms.picture(film, scouts.wanted.clone()))
}

/// From scouts that are all there: more of them, or what the picture gets.
fn decide(terms: &Terms, scouts: &mut Scouts) {
    let all = terms.samples.end - terms.samples.start;
    let wanted = allot::allot(&scouts.film, terms.target, all);
    let short = |asked: u64, wanted: u64| asked.saturating_mul(TRUST) < wanted;
    let mut more = false;
    for (asked, wanted) in scouts.asked.iter_mut().zip(&wanted) {
        if short(*asked, *wanted) {
            *asked *= 2;
            more = true;
        }
    }
    if !more {
        let whole = |count| rungs::whole(&terms.samples, count);
        scouts.wanted = wanted.into_iter().map(whole).collect();
    }
}

/// Whether a render of these terms can have left such sums.
pub(super) fn is_possible(terms: &Terms, film: &Film, scouts: &Scouts) -> bool {
    let tiles = Tiles::of(film.region);
    let sizes = [
        scouts.asked.len(),
        if scouts.wanted.is_empty() {
            tiles.count()
        } else {
            scouts.wanted.len()
        },
    ];
    if scouts.film.region != film.region || sizes != [tiles.count(); 2] {
        return false;
    }
    let all = terms.samples.end - terms.samples.start;
    // Twice what can be asked for is not more than all samples, nor fewer than the first scouts.
    let asked = |count: &u64| {
        count.is_power_of_two() && (FIRST_SCOUTS..=FIRST_SCOUTS.max(all)).contains(count)
    };
    let wanted = |count: &u64| {
        (terms.least()..=all).contains(count) && rungs::whole(&terms.samples, *count) == *count
    };
    let least = vec![terms.least(); tiles.count()];
    let goals = if scouts.wanted.is_empty() {
        &least
    } else {
        &scouts.wanted
    };
    scouts.asked.iter().all(asked)
        && scouts.wanted.iter().all(wanted)
        && within(&terms.samples, tiles, film, goals)
        && within(&(SCOUTS..u64::MAX), tiles, &scouts.film, &scouts.asked)
}

/// Whether no pixel has more than its tile is to have, nor a part of a run.
fn within(samples: &Range<u64>, tiles: Tiles, film: &Film, goals: &[u64]) -> bool {
    let fits = |(pixel, count): (usize, &u64)| {
        *count <= goals[tiles.of_pixel(pixel)]
            && (*count == 0 || rungs::whole(samples, *count) == *count)
    };
    film.counts.iter().enumerate().all(fits)
}
