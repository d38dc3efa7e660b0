//! Names beside what they name, where they touch nothing else.

use super::canvas::{Anchor, Frame, LINE, TEXT, text_frame};
use super::measure::text_width;

/// Moves places apart until each has `LINE` to itself, within `low` and `high`, each as little as
/// is needed: places that push each other move together. None where there is no room for all.
pub(super) fn spread(wanted: &[f64], low: f64, high: f64) -> Option<Vec<f64>> {
    if wanted.len() as f64 * LINE > high - low + LINE {
        return None;
    }
    let mut order: Vec<usize> = (0..wanted.len()).collect();
    order.sort_by(|&a, &b| wanted[a].total_cmp(&wanted[b]));
    // Runs of places that touch: sum of where each would have its first one, and how many.
    let mut runs: Vec<(f64, usize)> = Vec::new();
    for &index in &order {
        runs.push((wanted[index], 1));
        while let [.., (above, many), (below, more)] = runs[..] {
            let start = first(above, many, low, high);
            if start + LINE * many as f64 <= first(below, more, low, high) {
                break;
            }
            runs.truncate(runs.len() - 2);
            let shifted = below - LINE * (many * more) as f64;
            runs.push((above + shifted, many + more));
        }
    }
    let mut places = vec![0.0; wanted.len()];
    let mut order = order.into_iter();
    for (sum, many) in runs {
        for (step, index) in order.by_ref().take(many).enumerate() {
            places[index] = first(sum, many, low, high) + LINE * step as f64;
        }
    }
    Some(places)
}

/// Where a run begins: the mean of what its members want, inside the ends.
fn first(sum: f64, many: usize, low: f64, high: f64) -> f64 {
    let last_start = (high - LINE * (many - 1) as f64).max(low);
    (sum / many as f64).clamp(low, last_start)
}

/// A level's name, found a place.
#[derive(Clone, Copy, Debug)]
pub(super) struct Placed {
    pub at: [f64; 2],
    pub anchor: Anchor,
}

impl std::fmt::Debug for Anchor {
    fn fmt(&self, formatter: &mut std::fmt::Formatter) -> std::fmt::Result {
        formatter.write_str(match self {
            Anchor::Start => "start",
            Anchor::Middle => "middle",
            Anchor::End => "end",
        })
    }
}

/// Places the names of levels along them, clear of each other and, best, of the data. None where
/// one finds no place.
pub(super) fn along_levels(
    levels: &[(&str, f64)],
    frame: &Frame,
    data: &[[f64; 2]],
) -> Option<Vec<Placed>> {
    let mut taken: Vec<Frame> = Vec::new();
    let mut placed = Vec::with_capacity(levels.len());
    for &(name, y) in levels {
        if text_width(name, TEXT, false) > frame.width() - 8.0 {
            return None;
        }
        let others = levels.iter().filter(|level| level.1 != y);
        let lines: Vec<f64> = others.map(|level| level.1).collect();
        let (place, filled) = best_along(name, y, frame, data, &taken, &lines)?;
        taken.push(filled);
        placed.push(place);
    }
    Some(placed)
}

fn best_along(
    name: &str,
    y: f64,
    frame: &Frame,
    data: &[[f64; 2]],
    taken: &[Frame],
    lines: &[f64],
) -> Option<(Placed, Frame)> {
    // So much of the data may be hidden at most, and so near may it come unpunished.
    const MOST_HIDDEN: usize = 3;
    const CLEAR: f64 = 3.0;
    // From the right, where the eye looks for names, to the left.
    const PLACES: usize = 12;
    let width = text_width(name, TEXT, false);
    let room = frame.width() - width - 8.0;
    let candidates = (0..=PLACES).flat_map(|step| {
        let x = frame.left + 4.0 + room * (1.0 - step as f64 / PLACES as f64);
        [-4.0, 13.0].map(|shift| ([x, y + shift], Anchor::Start))
    });
    candidates
        .filter_map(|(at, anchor)| {
            let filled = text_frame(at, anchor, name, TEXT);
            let inside = filled.top >= frame.top - 2.0 && filled.bottom <= frame.bottom;
            let crossed = lines.iter().any(|&y| y > filled.top && y < filled.bottom);
            let free = !taken.iter().any(|other| other.meets(&filled));
            let near = filled.grown(CLEAR);
            let hidden = data.iter().filter(|&&point| near.holds(point)).count();
            (inside && free && !crossed && hidden <= MOST_HIDDEN).then_some((
                hidden,
                Placed { at, anchor },
                filled,
            ))
        })
        .min_by_key(|&(hidden, _, _)| hidden)
        .map(|(_, place, filled)| (place, filled))
}
