//! A comparison in words, for people.

use crate::compare::verdict::{Estimate, Outcome, Pixels, Spot, Verdict, quantile};
use crate::compare::{Comparison, Described, Figure, Judgement, Kinship, Metric};
use crate::wording::{counted, named, signed};
use std::fmt::Write as _;
use std::path::Path;

/// Knobs that differ and are named.
const MOST_KNOBS: usize = 8;
const CHANNELS: [&str; 3] = ["red", "green", "blue"];

/// The whole report. Writing into a string cannot fail, so nothing is lost by not asking.
pub(super) fn report(comparison: &Comparison, reference: &Path, test: &Path) -> String {
    let mut text = String::new();
    describe(&mut text, "A", reference, &comparison.reference);
    describe(&mut text, "B", test, &comparison.test);
    if let Some(kinship) = &comparison.kinship {
        relate(&mut text, kinship);
    }
    for warning in &comparison.warnings {
        let _ = writeln!(text, "note: {warning}");
    }
    let finite = comparison.non_finite;
    if finite.first.is_some() {
        let _ = writeln!(
            text,
            "not finite: {} of A, {} of B; {} unlike",
            counted(finite.reference, "pixel"),
            finite.test,
            finite.apart
        );
    }
    if comparison.identical {
        let _ = writeln!(text, "every pixel is identical");
    }
    for figure in &comparison.figures {
        let _ = writeln!(
            text,
            "  {:<9}{:<12} {}",
            figure.metric.title(),
            value_of(figure),
            figure.settings
        );
    }
    if !comparison.worst_tiles.is_empty() {
        let _ = writeln!(text, "worst 32x32 tiles, linear light:");
    }
    for tile in &comparison.worst_tiles {
        let r = tile.rect;
        let _ = writeln!(
            text,
            "  x {:>5}..{:<5} y {:>5}..{:<5} RMSE {:<11} mean B - A {:+.3e}",
            r.x0,
            r.x1,
            r.y0,
            r.y1,
            short(tile.rmse),
            tile.difference
        );
    }
    for gate in &comparison.gates {
        judge(&mut text, gate);
    }
    if let Some(verdict) = &comparison.verdict {
        conclude(&mut text, verdict, comparison.verdict_decides);
    } else if let Some(reason) = comparison
        .no_verdict
        .as_ref()
        .filter(|_| !comparison.identical)
    {
        let _ = writeln!(text, "no verdict: {reason}");
    }
    text
}

fn describe(text: &mut String, name: &str, path: &Path, image: &Described) {
    let _ = write!(
        text,
        "{name}  {}: {}, {} x {}",
        named(path),
        image.format,
        image.width,
        image.height
    );
    if let Some(samples) = image.samples {
        let most = image.most_samples.map(|most| format!(" to {most}"));
        let samples = match most {
            Some(most) => format!("{samples}{most} samples"),
            None => counted(samples, "sample"),
        };
        let _ = write!(text, ", {samples}");
    }
    if let Some(seed) = image.seed {
        let _ = write!(text, ", seed {seed}");
    }
    if let Some(device) = &image.device {
        let _ = write!(text, ", {device}");
    }
    if !image.left_aside.is_empty() {
        let _ = write!(text, "; left aside: {}", image.left_aside.join(", "));
    }
    text.push('\n');
}

fn relate(text: &mut String, kinship: &Kinship) {
    for difference in kinship.knobs.iter().take(MOST_KNOBS) {
        let _ = writeln!(
            text,
            "knob {}: {} -> {}",
            difference.knob,
            shown(&difference.reference),
            shown(&difference.test)
        );
    }
    if kinship.knobs.len() > MOST_KNOBS {
        let more = kinship.knobs.len() - MOST_KNOBS;
        let _ = writeln!(text, "and {more} more knobs, which --json lists");
    }
    for other in &kinship.others {
        let _ = writeln!(text, "{other}");
    }
    if kinship.mixed {
        let _ = writeln!(
            text,
            "warning: more differs than one knob, so the difference is not that knob's alone"
        );
    }
}

/// A record names spheres and boxes only where `--set` changed them.
fn shown(value: &serde_json::Value) -> String {
    match value {
        serde_json::Value::Null => "as the scene has it".into(),
        value => value.to_string(),
    }
}

/// Four digits, or as they are.
fn short(value: f64) -> String {
    let size = value.abs();
    if size == 0.0 || !value.is_finite() {
        format!("{value}")
    } else if (1e-3..1e5).contains(&size) {
        let digits = (3 - size.log10().floor() as i32).clamp(0, 6) as usize;
        format!("{value:.digits$}")
    } else {
        format!("{value:.3e}")
    }
}

fn value_of(figure: &Figure) -> String {
    let unit = if figure.metric == Metric::Psnr {
        " dB"
    } else {
        ""
    };
    short(figure.value) + unit
}

fn judge(text: &mut String, gate: &Judgement) {
    let state = if gate.passes { "passes" } else { "FAILS" };
    let sign = if gate.metric.rises() { ">=" } else { "<=" };
    let _ = match gate.pixels {
        None => writeln!(
            text,
            "{state}: {} {}, wanted {sign} {}",
            gate.metric,
            short(gate.value),
            gate.limit
        ),
        Some([failing, allowed]) => writeln!(
            text,
            "{state}: {} is over {} in {}, {allowed} allowed",
            gate.metric,
            gate.limit,
            counted(failing, "pixel")
        ),
    };
    if let Some(passing) = gate.passing {
        let flag = if gate.metric.rises() {
            "--min"
        } else {
            "--max"
        };
        let _ = writeln!(text, "  {flag} {passing} would pass");
    }
    if !gate.curve.is_empty() {
        let _ = writeln!(text, "  pixels beyond each limit of {}:", gate.metric);
    }
    for step in &gate.curve {
        let _ = writeln!(
            text,
            "  {:>10}  {:>10}  {:>8.4} %",
            step.limit,
            step.failing,
            100.0 * step.share
        );
    }
}

/// `decides` is false where limits decide.
fn conclude(text: &mut String, verdict: &Verdict, decides: bool) {
    let alpha = verdict.terms.alpha;
    let outcome = match verdict.outcome {
        Outcome::Same => "same expected image",
        Outcome::Different => "different",
        Outcome::NotEnoughSamples => "not enough samples to tell",
    };
    let how = match verdict.paired {
        true => "; paired, both are of the same random numbers",
        false => "",
    };
    let aside = if decides {
        ""
    } else {
        ", beside the limits, which decide"
    };
    let _ = writeln!(
        text,
        "verdict{aside}: {outcome} (chance of a false alarm {alpha}{how})"
    );
    match verdict.outcome {
        Outcome::Same => agreement(text, verdict),
        Outcome::Different => differences(text, verdict),
        Outcome::NotEnoughSamples => shortage(text, verdict),
    }
}

/// What the samples exclude.
fn agreement(text: &mut String, verdict: &Verdict) {
    let _ = writeln!(
        text,
        "  the means of the pictures agree to within {} (wanted: {})",
        percent(verdict.supported_margin),
        percent(verdict.terms.margin)
    );
    if let Some(tiles) = &verdict.tiles {
        let [half, most] = tiles.margins;
        let _ = writeln!(
            text,
            "  half of the tiles of {0} x {0} agree to within {1}, 99 % of them to within {2}; more samples would see finer",
            tiles.side,
            percent(half),
            percent(most)
        );
    }
}

/// Two digits, more where the number has them before its point.
fn percent(share: f64) -> String {
    let value = 100.0 * share;
    if !value.is_finite() || value == 0.0 {
        return format!("{value} %");
    }
    let unit = 10f64.powi((1 - value.abs().log10().floor() as i32).max(0));
    format!("{} %", (value * unit).round() / unit)
}

/// Difference with half the width of the interval that holds the truth with probability 1 - alpha;
/// the same in percent of the reference.
fn spelled(estimate: &Estimate, alpha: f64) -> String {
    let half_width = quantile(1.0 - 0.5 * alpha) * estimate.error;
    let (x, y) = (estimate.difference, half_width);
    if estimate.reference == 0.0 {
        return format!("{x:+.3e} ± {y:.1e} (the reference is black)");
    }
    let relative = |value: f64| 100.0 * value / estimate.reference.abs();
    format!(
        "{x:+.3e} ± {y:.1e} ({} ± {:.3} % of A)",
        signed(relative(x), 3),
        relative(y)
    )
}

fn differences(text: &mut String, verdict: &Verdict) {
    let alpha = verdict.terms.alpha;
    let apart = |mean: &&Estimate| verdict.pooled_fails && mean.difference != 0.0;
    for (channel, mean) in verdict
        .pooled
        .iter()
        .enumerate()
        .filter(|(_, mean)| apart(mean))
    {
        let _ = writeln!(
            text,
            "  mean of the picture, {:<5} {}",
            CHANNELS[channel],
            spelled(mean, alpha)
        );
    }
    if let Some(tiles) = verdict.tiles.as_ref().filter(|tiles| tiles.failing > 0) {
        let _ = writeln!(
            text,
            "  {} of {} of {} x {}; most clearly {}",
            tiles.failing,
            counted(tiles.count, "tile"),
            tiles.side,
            tiles.side,
            place(&tiles.worst, alpha)
        );
    }
    if let Some(pixels) = verdict.pixels.as_ref() {
        failing_pixels(text, pixels, alpha);
    }
    let _ = writeln!(text, "  B - A, ± the {} interval", percent(1.0 - alpha));
}

/// The tests of the third layer that failed.
fn failing_pixels(text: &mut String, pixels: &Pixels, alpha: f64) {
    if let (true, Some([x, y])) = (pixels.cluster_fails, pixels.cluster_at) {
        let _ = writeln!(
            text,
            "  a cluster of {} beyond {} standard errors at {x},{y}; by chance once in {:.1e} pictures",
            counted(pixels.largest_cluster, "pixel"),
            pixels.far,
            1.0 / pixels.cluster_p
        );
    }
    if pixels.single_fails {
        let _ = writeln!(text, "  a single pixel: {}", place(&pixels.worst, alpha));
    }
}

fn place(spot: &Spot, alpha: f64) -> String {
    let r = spot.rect;
    format!(
        "{} at x {}..{}, y {}..{}: {}",
        CHANNELS[spot.channel.min(2)],
        r.x0,
        r.x1,
        r.y0,
        r.y1,
        spelled(&spot.estimate, alpha)
    )
}

fn shortage(text: &mut String, verdict: &Verdict) {
    let _ = writeln!(
        text,
        "  no difference found, but one of {} of the mean could have been missed; so far the means agree to within {}",
        percent(verdict.terms.margin),
        percent(verdict.supported_margin)
    );
    let Some(needed) = &verdict.needed else {
        return;
    };
    let _ = write!(
        text,
        "  about {} samples a pixel are needed in B and {} in A",
        needed.test, needed.reference
    );
    let _ = match needed.test_alone {
        Some(test) => writeln!(text, "; or {test} in B alone"),
        None => writeln!(text),
    };
}
