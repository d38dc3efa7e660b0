//! Findings, and what the report gets.

use super::coverage::USUAL;
use super::worlds::{Estimator, World, picture, region};
use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use half::f16;
use lampray::analysis::{Analysis, Kind, Question, Reference, Runs, image, picture_image};
use lampray::compare::verdict::Terms;
use lampray::report::data::{GroupData, ReportData};
use serde_json::Map;

const LARGE: World = World {
    size: 32,
    samples: 64,
    reference_samples: 65_536,
    ..USUAL
};

fn findings(analysis: &Analysis) -> String {
    analysis.findings().join("\n")
}

/// What comes before what.
fn ordered(text: &str, parts: &[&str]) {
    let places: Vec<_> = parts
        .iter()
        .map(|part| text.find(part).unwrap_or_else(|| panic!("{part}: {text}")))
        .collect();
    assert!(places.is_sorted(), "{text}");
}

#[test]
fn bias_first_then_cost_then_crossing() {
    let analysis = LARGE.sweep(1, [|_| {}, |_| {}]);
    ordered(
        &findings(&analysis),
        &[
            "second is biased: the whole picture is ",
            " too bright.",
            " first.",
            "at equal time",
            "second, whole picture: bias overtakes noise at ",
        ],
    );
}

/// A bias that a single sample's noise does not reach; of many only the first few are said.
#[test]
fn crossings_below_one_and_many_of_them() {
    let mut world = LARGE;
    world.estimators[1] = Estimator {
        bias: 0.5,
        deviation: 0.3,
        ..world.estimators[1]
    };
    let analysis = world.sweep(6, [|_| {}, |_| {}]);
    let text = findings(&analysis);
    let sentence = "second, whole picture: bias is larger than the noise of a single sample.";
    assert!(text.contains(sentence), "{text}");
    assert!(!text.contains("overtakes noise at 0"), "{text}");
    let second = analysis.groups[1].clone();
    let groups = std::iter::repeat_n(second, 7).collect();
    let many = Analysis::new(analysis.question, groups, None).expect("groups");
    let text = findings(&many);
    assert_eq!(text.matches("of a single sample").count(), 4, "{text}");
    assert!(text.contains("in 3 more of these places"), "{text}");
}

#[test]
fn which_is_better_and_by_how_much() {
    let mut world = LARGE;
    world.estimators[1] = Estimator {
        bias: 0.0,
        deviation: 0.5,
        ..world.estimators[0]
    };
    let text = findings(&world.sweep(2, [|_| {}, |_| {}]));
    ordered(
        &text,
        &["second has the least squared error at equal time: first has "],
    );
    assert!(!text.contains("biased"), "{text}");
    world.estimators.swap(0, 1);
    let text = findings(&world.sweep(3, [|_| {}, |_| {}]));
    ordered(
        &text,
        &["first has the least squared error at equal time; the next, second, has "],
    );
    world.estimators[0] = world.estimators[1];
    let text = findings(&world.sweep(4, [|_| {}, |_| {}]));
    ordered(
        &text,
        &["No group is shown to have less squared error at equal time than first"],
    );
}

#[test]
fn runs_that_are_one_run() {
    let question =
        Question::new([8, 8], Vec::new(), Vec::new(), Terms::default(), 1).expect("a question");
    let mut runs = Runs::new("copies", Map::new());
    for seed in 0..4 {
        let grey = (0..64)
            .map(|pixel| (1.0 + 0.1 * f64::from(pixel % 7), 1.0))
            .collect();
        runs.add(&picture(8, 16, seed, grey), 1.0).expect("a run");
    }
    let group = question.answer(runs, None).expect("a group");
    let analysis = Analysis::new(question, vec![group], None).expect("a group");
    let text = findings(&analysis);
    assert!(text.starts_with("copies: the runs vary 0 (95 %"), "{text}");
}

#[test]
fn the_report_is_filled() {
    let analysis = LARGE.sweep(5, [|_| {}, |_| {}]);
    let mut data = ReportData::default();
    data.images
        .push(picture_image("other", &picture(1, 4, 0, vec![(1.0, 1.0)])));
    analysis.fill(&mut data);
    assert_eq!(data.images.len(), 1 + 1 + 2 * 3);
    assert_eq!(data.references[0].image, Some(1));
    assert_eq!(data.regions[0].rect, [0, 0, 32, 32]);
    assert_eq!(data.notes, Vec::<String>::new());
    let second = &data.groups[1];
    assert_eq!(second.reference, Some(0));
    assert_eq!((second.runs, second.samples), (4, 64));
    let bias = &data.images[second.bias_image.expect("a reference")];
    assert_eq!(
        (bias.kind.as_str(), bias.name.as_str()),
        ("bias", "second, bias")
    );
    let figures = &second.regions[0];
    assert_eq!(figures.verdict.as_deref(), Some("different"));
    assert!(
        figures
            .bias
            .is_some_and(|bias| bias.low < 0.1 && 0.1 < bias.high)
    );
    assert!(figures.mse.is_some() && figures.relmse.is_some() && figures.crossing.is_some());
    assert_eq!(data.findings, analysis.findings());
}

/// Two hundred groups of large pictures: the means of all are there, smaller, and the page says so.
#[test]
fn a_page_is_never_too_large() {
    let grey: Vec<_> = (0..512 * 512)
        .map(|pixel| (1.0 + 0.1 * f64::from(pixel % 7), 1.0))
        .collect();
    let reference = Reference::new("reference", picture(512, 64, 99, grey.clone()));
    let references = vec![reference.expect("it has noise")];
    let question = Question::new([512, 512], references, Vec::new(), Terms::default(), 200);
    let question = question.expect("a question");
    let mut runs = Runs::new("a group", Map::new());
    runs.add(&picture(512, 16, 1, grey), 1.0).expect("a run");
    let group = question.answer(runs, Some(0)).expect("a group");
    let analysis = Analysis::new(question, vec![group; 200], None).expect("groups");
    let mut data = ReportData::default();
    analysis.fill(&mut data);
    let shown = |of: fn(&GroupData) -> Option<usize>| {
        let shown = data.groups.iter().map(of);
        shown.take_while(Option::is_some).count()
    };
    assert_eq!(shown(|group| group.mean_image), 200);
    let mean = &data.images[data.groups[199].mean_image.expect("a mean")];
    assert_eq!((mean.width, mean.height), (64, 64));
    assert!(data.notes.join("\n").contains("mean of 8 x 8 pixels"));
    assert_eq!(shown(|group| group.bias_image), 200);
    let deviations = shown(|group| group.deviation_image);
    assert!((1..=200).contains(&deviations), "{deviations}");
    let page = lampray::report::page(&data).expect("a page");
    assert!(page.len() < 30_000_000, "{} bytes", page.len());
    assert!(page.len() > 10_000_000, "{} bytes", page.len());
}

/// Little-endian halves, red first; what is too large becomes the largest that there is.
#[test]
fn images_are_halves() {
    let image = image(
        "x",
        Kind::Bias,
        [1, 2],
        &[[0.5, -2.0, 1e9], [0.0, -1e9, 1.0]],
    );
    let bytes = STANDARD.decode(&image.half).expect("base64");
    let values: Vec<f32> = bytes
        .chunks_exact(2)
        .map(|pair| f16::from_le_bytes([pair[0], pair[1]]).to_f32())
        .collect();
    assert_eq!(values, [0.5, -2.0, 65504.0, 0.0, -65504.0, 1.0]);
    assert_eq!(
        (image.width, image.height, image.kind.as_str()),
        (1, 2, "bias")
    );
}

#[test]
fn an_unknown_baseline() {
    let question =
        Question::new([1, 1], Vec::new(), Vec::new(), Terms::default(), 1).expect("a question");
    let error = Analysis::new(question, Vec::new(), Some("cone"));
    assert!(error.is_err());
    let part = region("corner", [0, 0, 1, 1]);
    let question =
        Question::new([1, 1], Vec::new(), vec![part], Terms::default(), 1).expect("a question");
    assert_eq!(question.regions().len(), 2);
}
