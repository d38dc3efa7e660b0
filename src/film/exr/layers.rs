//! Which channels of a part are the picture.

use super::channels::{MEAN, SAMPLES, VARIANCE};
use super::part::Part;
use crate::knobs::short;

/// Luminance alone.
const GREY: &str = "Y";

/// The channels of the picture, by their names.
pub(super) struct Choice {
    pub rgb: [String; 3],
    /// Whether the file says how noisy the picture is.
    pub noise: bool,
    /// For people, where it is not plain R, G and B.
    pub layer: Option<String>,
    /// Whether the picture has an alpha of its own.
    pub alpha: bool,
    /// The names of all other channels.
    pub others: Vec<String>,
}

impl Choice {
    /// `None` where no channels make a picture.
    pub(super) fn of(part: &Part) -> Option<Choice> {
        let (prefix, rgb, layer) = if MEAN.iter().all(|name| part.has(name)) {
            (String::new(), MEAN.map(String::from), None)
        } else if let Some(layer) = best_layer(part) {
            let rgb = MEAN.map(|name| format!("{layer}.{name}"));
            (format!("{layer}."), rgb, Some(format!("layer {layer}")))
        } else if part.has(GREY) {
            (
                String::new(),
                [GREY; 3].map(String::from),
                Some("grey".into()),
            )
        } else {
            return None;
        };
        let noise = prefix.is_empty() && VARIANCE.iter().chain([&SAMPLES]).all(|n| part.has(n));
        let alpha = format!("{prefix}A");
        let used = |name: &String| {
            let noise = noise && (VARIANCE.contains(&name.as_str()) || name == SAMPLES);
            noise || rgb.contains(name) || *name == alpha
        };
        let names = part.channels.iter().map(|channel| &channel.name);
        let others = names.filter(|name| !used(name)).cloned().collect();
        Some(Choice {
            noise,
            layer,
            alpha: part.has(&alpha),
            others,
            rgb,
        })
    }
}

/// The name of Blender's finished picture, or else the first by name.
fn best_layer(part: &Part) -> Option<&str> {
    let names = part.channels.iter().map(|channel| channel.name.as_str());
    let layers = names.filter_map(|name| name.strip_suffix(".R"));
    let whole = |layer: &&str| {
        let mut names = MEAN.iter().map(|name| format!("{layer}.{name}"));
        names.all(|name| part.has(&name)) && VARIANCE[0] != format!("{layer}.R")
    };
    let combined = |layer: &str| layer.rsplit('.').next() == Some("Combined");
    layers
        .filter(whole)
        .min_by_key(|layer| (!combined(layer), *layer))
}

/// "channels a, b and 4 more"; `None` for no name. Names may be long, or hold codes for a terminal.
pub(super) fn listed(what: &str, names: &[String]) -> Option<String> {
    let first: Vec<String> = names.iter().take(2).map(|name| short(name)).collect();
    let more = names.len().saturating_sub(2);
    let text = match first.as_slice() {
        [] => return None,
        [one] => format!("{what} {one}"),
        [one, other, ..] if more == 0 => format!("{what}s {one} and {other}"),
        [one, other, ..] => format!("{what}s {one}, {other} and {more} more"),
    };
    Some(text)
}
