//! Colours of plots, for light and for dark paper: those of the reports.

use std::fmt::Write as _;

/// The class of every plot; all rules are below it, so they touch nothing else on a page.
pub(super) const CLASS: &str = "lampray-plot";

/// What carries the data, by index; the colour-blind can tell them apart.
const SERIES: [Pair; 8] = [
    Pair("#0067a5", "#4fa9e6"),
    Pair("#c8540a", "#f08a45"),
    Pair("#00805c", "#3cc79c"),
    Pair("#a84a86", "#e39ac5"),
    Pair("#8a6a00", "#e2c453"),
    Pair("#2f93c9", "#9bd6fa"),
    Pair("#4c515a", "#b6bdc7"),
    Pair("#7b3f22", "#cf9470"),
];

const PAPER: Pair = Pair("#fcfbf9", "#14161a");
const INK: Pair = Pair("#1c1e22", "#e7e8ea");
const MUTED: Pair = Pair("#5b616b", "#a0a7b1");
const RULE: Pair = Pair("#e4e1db", "#2d333a");
const STRONG: Pair = Pair("#8d8a84", "#6a727d");

/// The paper's red, green and blue.
const HUES: [(&str, Pair); 3] = [
    ("red", Pair("#c22f22", "#ff7a6b")),
    ("green", Pair("#14803c", "#58cf7f")),
    ("blue", Pair("#1f5cc4", "#7aa7ff")),
];

/// A colour on light and on dark paper.
#[derive(Clone, Copy)]
struct Pair(&'static str, &'static str);

/// What never changes with the paper.
const SHAPES: &str = "\
.lampray-plot{max-width:100%;height:auto;font-family:Helvetica,Arial,\"Liberation Sans\",sans-serif;font-variant-numeric:tabular-nums}

.lampray-plot .title{font-weight:600}
.lampray-plot .halo{stroke-width:4;stroke-linejoin:round;paint-order:stroke}
.lampray-plot .mark-name{font-style:italic}
.lampray-plot line,.lampray-plot path{fill:none}
.lampray-plot .rule{stroke-width:1}
.lampray-plot .spine{stroke-width:1}
.lampray-plot .mark{stroke-width:1;stroke-dasharray:2 3}
.lampray-plot .joined{stroke-width:1.5;opacity:.5;stroke-linejoin:round}
.lampray-plot .curve{stroke-width:2;stroke-linejoin:round}
.lampray-plot .predicted{stroke-width:1.6;stroke-dasharray:5 3.5;stroke-linejoin:round}
.lampray-plot .error{stroke-width:1.4}
.lampray-plot .band{stroke:none;opacity:.18}
.lampray-plot .dot{stroke-width:1.2}
.lampray-plot .leader{stroke-width:1;opacity:.6}
.lampray-plot .expected{stroke-width:1.4}
.lampray-plot .minor{stroke-width:1;opacity:.55}
.lampray-plot .light{opacity:.07}
.lampray-plot .outline{fill:none;stroke-width:1}
.lampray-plot .pole-inside{stroke-width:1;stroke-dasharray:2 4;opacity:.7}
.lampray-plot .front,.lampray-plot .middle,.lampray-plot .back{stroke-linecap:round}
.lampray-plot .front{stroke-width:3.6}
.lampray-plot .middle{stroke-width:3.1;opacity:.85}
.lampray-plot .back{stroke-width:2.5;opacity:.24}
.lampray-plot .far{stroke-width:1;opacity:.45}
.lampray-plot .near{stroke-width:1;opacity:.8}
.lampray-plot .cap-far{stroke-width:1.2;opacity:.45;stroke-dasharray:3 3}
.lampray-plot .cap-near{stroke-width:1.5}
.lampray-plot .pole{stroke-width:1.4}
";

/// Rules for a document of its own: the reader's system chooses the paper.
pub(super) fn alone() -> String {
    let rules = |dark| rules(|Pair(light, other)| String::from(if dark { other } else { light }));
    format!(
        "{SHAPES}{}@media (prefers-color-scheme:dark){{\n{}}}\n",
        rules(false),
        rules(true)
    )
}

/// Rules for a page that has chosen its paper with `color-scheme`.
pub(super) fn in_page() -> String {
    let both = |Pair(light, dark)| format!("light-dark({light},{dark})");
    format!("{SHAPES}{}", rules(both))
}

fn rules(of: impl Fn(Pair) -> String) -> String {
    let mut rules = String::new();
    let mut rule = |selector: &str, property: &str, pair: Pair| {
        // Writing to a string cannot fail.
        let _ = writeln!(rules, ".{CLASS} {selector}{{{property}:{}}}", of(pair));
    };
    rule(".paper", "fill", PAPER);
    rule(".ball", "fill", Pair("#eae6de", "#1c2025"));
    rule(".light", "fill", Pair("#ffffff", "#5d6975"));
    rule(".outline", "stroke", STRONG);
    rule(".ink", "fill", INK);
    rule(".muted", "fill", MUTED);
    rule(".halo", "stroke", PAPER);
    rule(".dot", "stroke", PAPER);
    rule(".rule", "stroke", RULE);
    rule(".spine", "stroke", STRONG);
    rule(".minor", "stroke", STRONG);
    rule(".mark", "stroke", MUTED);
    for side in ["far", "near"] {
        rule(&format!(".{side}"), "stroke", Pair("#bdb8ae", "#4a535d"));
        rule(
            &format!(".cap-{side}"),
            "stroke",
            Pair("#6d6a64", "#a9b1bb"),
        );
    }
    rule(".pole", "stroke", INK);
    for class in [".pole-inside", ".expected", ".error-ink"] {
        rule(class, "stroke", INK);
    }
    for (index, pair) in SERIES.into_iter().enumerate() {
        rule(&format!(".s{index}"), "stroke", pair);
        rule(&format!(".f{index}"), "fill", pair);
        rule(&format!(".d{index}"), "stroke", DEEP[index]);
        rule(&format!(".t{index}"), "fill", DEEP[index]);
        rule(&format!(".b{index}"), "fill", PALE[index]);
    }
    for (name, pair) in HUES {
        rule(&format!(".{name}"), "stroke", pair);
    }
    rules
}

/// What theory says of a series: its colour nearer to the ink, so that dashes show on the line.
const DEEP: [Pair; 8] = [
    Pair("#00365a", "#9bd0f4"),
    Pair("#6b2a00", "#f8c09b"),
    Pair("#004633", "#95e2c9"),
    Pair("#5c2247", "#f2cbe3"),
    Pair("#4a3800", "#f0df9f"),
    Pair("#125275", "#cdeafd"),
    Pair("#24272c", "#e3e6ea"),
    Pair("#42200f", "#e4bfa8"),
];

/// Areas are larger than lines, and need less colour.
const PALE: [Pair; 8] = [
    Pair("#5497c1", "#3f84b3"),
    Pair("#dc8b58", "#bb6d39"),
    Pair("#54a78e", "#31a07e"),
    Pair("#c684ae", "#b17a9b"),
    Pair("#b29b54", "#b09a45"),
    Pair("#73b5da", "#78a6c3"),
    Pair("#85888e", "#8d939b"),
    Pair("#a97f6b", "#9f7459"),
];

/// The palette's entry for a series: it begins again where it ends.
pub(super) fn colour(index: usize) -> usize {
    index % SERIES.len()
}
