//! Samples where the error is: how `--target-error` shares them out.
//!
//! # The rule
//!
//! The picture is cut into tiles. *Scouts*, samples that are not in the picture, tell how noisy each tile is beside
//! the others: from them alone follows the *shape*, how many rungs of a ladder of numbers of samples each tile is
//! behind the one that gets the most ([`shape`]). The picture's own error, one number ([`crate::film::RelativeError`]),
//! tells the *scale*: all tiles climb the ladder together until it is at the target, exactly as even sampling does,
//! which is the shape without lags. So the target is kept wherever there are samples enough, and a bad shape costs
//! samples and nothing else.
//!
//! Every pixel gets the samples first after which even sampling looks. Then the error foresees how many rungs are to
//! go, as it falls with the root of the number of samples, and half of them are taken at once, at least one: steps
//! are large far from the target, where nobody needs to look, and single rungs near it. Before more than
//! [`TRUST`] samples go to a pixel for each of its scouts there are twice as many scouts, of all pixels, and a new
//! shape; no tile gives back what it has.
//!
//! # What that does to expectations
//!
//! Let X1, X2, ... be the samples of a pixel that the picture may take, S all scouts of all pixels, K the rungs that
//! the render climbed to, and n(S, K) the samples that the pixel gets. A sample is a function of its address alone,
//! and no scout shares an address with a sample of a picture: scouts have the indices from 2^63 on, which no range
//! of samples reaches. So the X are independent of S and have the expectation mu, whatever S is: given S, and were
//! the rungs fixed,
//!
//! E[(X1 + ... + Xn) / n] = E[ E[(X1 + ... + Xn) / n | S] ] = E[ n mu / n ] = mu.
//!
//! The shape never makes a pixel too dark or too bright, and ranges of samples stay disjoint from each other and from
//! the scouts, and add up by `merge`, weighted by counts.
//!
//! The rungs are not fixed: the picture's error ends the climb, as it ends even sampling, and where it is low by
//! chance, since rare bright paths were missed, the picture ends early. This one number is of all pixels together, so
//! that what one pixel met hardly moves it, and the bias that is left is of the kind that even sampling with a target
//! has, and perhaps a little more, where a few pixels of a tile that got too little decide. `tests/adaptive` measures
//! both beside the naive rule's, which ends each tile by the tile's own error: there a few pixels always decide, and
//! the tile ends too early just where it is too dark.
//!
//! # How it is run
//!
//! [`next`] hands out one piece of [`Work`] after another. Each follows from the sums so far, so that a checkpoint
//! has all that is needed.

mod rungs;
mod shape;
mod smooth;
mod work;

pub(super) use work::{Goals, Work};

use crate::film::{Film, SCOUTS, Scouts, Tiles};
use crate::pack::{RUN_LENGTH, Rect};
use std::ops::Range;

/// The rule's name in records.
pub const RULE: &str = "shape";

/// Scouts of each pixel in the first round: a run.
const FIRST_SCOUTS: u64 = RUN_LENGTH as u64;
/// Samples of the noisiest tile that a scout can speak for: beyond them there are twice as many scouts.
const TRUST: u64 = 64;
/// Where the target is foreseen to take fewer samples for each of the first scouts, there are none: they would cost
/// more than they save.
const WORTH: u64 = 20;

/// What a render wants with a target error.
#[derive(Clone, Debug)]
pub(super) struct Terms {
    /// The samples that a pixel may get.
    pub samples: Range<u64>,
    pub target: f64,
}

impl Terms {
    /// An adaptive render of which nothing is done.
    pub fn scouts(&self, region: Rect) -> Scouts {
        Scouts::new(region, self.on(0))
    }

    /// All samples of a pixel.
    fn all(&self) -> u64 {
        self.samples.end - self.samples.start
    }

    /// Samples of each pixel of a tile that is on a rung.
    fn on(&self, rung: u64) -> u64 {
        rungs::whole(&self.samples, rungs::at(rung))
    }

    /// The highest rung that a render can come to: the tile furthest behind has all samples.
    fn highest(&self) -> u64 {
        rungs::reach(0, self.all() as f64, self.all()) + shape::MOST_LAG
    }
}

/// The rest of the picture as far as it has climbed.
fn of_picture(terms: &Terms, film: &Film, scouts: &Scouts) -> Work {
    Work::new(
        film.region,
        terms.samples.clone(),
        film.counts.clone(),
        Goals::Tiles(Tiles::of(film.region), scouts.wanted.clone()),
        rungs::FIRST,
    )
}

/// The rest of the scouts that were asked for.
fn of_scouts(scouts: &Scouts) -> Work {
    let film = &scouts.film;
    Work::new(
        film.region,
        SCOUTS..u64::MAX,
        film.counts.clone(),
        Goals::Tiles(
            Tiles::of(film.region),
            vec![scouts.asked; scouts.wanted.len()],
        ),
        // Nobody sees them on their way.
        u64::MAX,
    )
}

/// What is to be done next, where everything before is done; nothing where that was all.
pub(super) fn next(terms: &Terms, film: &Film, scouts: &mut Scouts) -> Option<Work> {
    let some = |work: Work| (!work.is_empty()).then_some(work);
    let begun = some(of_picture(terms, film, scouts)).or_else(|| some(of_scouts(scouts)));
    if begun.is_some() {
        return begun;
    }
    loop {
        climb(terms, film, scouts)?;
        // More scouts may say that tiles have enough for a rung, or more.
        let work = some(of_scouts(scouts)).or_else(|| some(of_picture(terms, film, scouts)));
        if work.is_some() {
            return work;
        }
    }
}

/// From a picture and scouts that are all there: asks for more scouts, or for more of the picture. Nothing where the
/// target is reached, or every tile has all samples.
fn climb(terms: &Terms, film: &Film, scouts: &mut Scouts) -> Option<()> {
    let all = terms.all();
    if scouts.wanted.iter().all(|wanted| *wanted == all) {
        return None;
    }
    let error = film.relative_error();
    if error.reaches(terms.target) {
        return None;
    }
    let last = foreseen(scouts.rung, error.beside(terms.target), all);
    let rung = scouts.rung + (last - scouts.rung).div_ceil(2).max(1);
    let asked = scouts_for(scouts.asked, rungs::at(last), rungs::at(rung));
    // A single tile has none to share with.
    if asked > scouts.asked && scouts.wanted.len() > 1 {
        scouts.asked = asked;
        return Some(());
    }
    scouts.rung = rung;
    let lags = match scouts.asked {
        0 => vec![0; scouts.wanted.len()],
        _ => shape::lags(&scouts.film),
    };
    for (wanted, lag) in scouts.wanted.iter_mut().zip(lags) {
        *wanted = terms.on(rung.saturating_sub(lag)).max(*wanted);
    }
    Some(())
}

/// The rung on which an error that is `excess` times the target on a rung is foreseen to be at it.
fn foreseen(rung: u64, excess: f64, all: u64) -> u64 {
    rungs::reach(rung, rungs::at(rung) as f64 * excess * excess, all)
}

/// Scouts of each pixel that are enough for a next rung, where the last is foreseen to be another; never fewer than
/// there are.
fn scouts_for(asked: u64, last: u64, next: u64) -> u64 {
    let mut enough = match asked {
        0 if last < WORTH * FIRST_SCOUTS => return 0,
        0 => FIRST_SCOUTS,
        asked => asked,
    };
    while enough.saturating_mul(TRUST) < next {
        enough *= 2;
    }
    enough
}

/// Whether a render of these terms can have left such sums.
pub(super) fn is_possible(terms: &Terms, film: &Film, scouts: &Scouts) -> bool {
    let tiles = Tiles::of(film.region);
    let of_one = scouts.film.region == film.region && scouts.wanted.len() == tiles.count();
    if !of_one || scouts.rung > terms.highest() {
        return false;
    }
    // Each doubling of the scouts was for a rung that there is.
    let most = scouts_for(FIRST_SCOUTS, 0, rungs::at(terms.highest()));
    let asked = scouts.asked == 0
        || scouts.asked.is_power_of_two() && (FIRST_SCOUTS..=most).contains(&scouts.asked);
    let lag = if scouts.asked == 0 {
        0
    } else {
        shape::MOST_LAG
    };
    let lowest = terms.on(scouts.rung.saturating_sub(lag));
    let wanted = lowest..=terms.on(scouts.rung);
    let wanted =
        |count: &u64| wanted.contains(count) && rungs::whole(&terms.samples, *count) == *count;
    let [picture, scouting] = [of_picture(terms, film, scouts), of_scouts(scouts)];
    asked
        && scouts.wanted.iter().all(wanted)
        && picture.is_possible()
        && scouting.is_possible()
        // One of the two is done before the other goes on.
        && (picture.is_empty() || scouting.is_empty())
        && (scouts.rung == 0 || film.counts.iter().all(|count| *count >= terms.on(0)))
}
