//! Numbers small enough to be worked out by hand, in grey: all channels alike but for colour.

use super::worlds::{COLOUR, picture, region};
use lampray::analysis::{Analysis, Group, Question, Reference, Region, Runs};
use lampray::compare::verdict::Terms;
use lampray::film::Picture;
use lampray::report::data::ReportData;
use serde_json::Map;

/// Mean of the squares of the colours: what every squared figure is multiplied by.
fn colours() -> f64 {
    COLOUR.iter().map(|colour| colour * colour).sum::<f64>() / 3.0
}

fn close(found: f64, expected: f64) {
    let error = (found - expected).abs();
    assert!(
        error <= 2e-6 * expected.abs().max(1e-3),
        "{found} {expected}"
    );
}

fn reference() -> Reference {
    // Noise of the mean: 0.01 in both pixels.
    let picture = picture(2, 100, 99, vec![(1.0, 1.0), (2.0, 1.0)]);
    Reference::new("reference", picture).expect("it has noise")
}

/// Two runs of four samples: means 1.0 and 1.4, 2.0 and 2.8.
fn pictures() -> [Picture; 2] {
    [
        picture(2, 4, 1, vec![(1.0, 0.2), (2.0, 0.4)]),
        picture(2, 4, 2, vec![(1.4, 0.6), (2.8, 0.4)]),
    ]
}

fn question(reference: Option<Reference>, regions: Vec<Region>) -> Question {
    let references = reference.into_iter().collect();
    Question::new([2, 1], references, regions, Terms::default(), 1).expect("a question")
}

fn group(question: &Question, pictures: &[Picture]) -> Group {
    let mut runs = Runs::new("group", Map::new());
    for (picture, seconds) in pictures.iter().zip([1.0, 3.0]) {
        runs.add(picture, seconds).expect("a run");
    }
    let number = (!question.references().is_empty()).then_some(0);
    question.answer(runs, number).expect("a group")
}

#[test]
fn two_runs() {
    let question = question(Some(reference()), Vec::new());
    let group = group(&question, &pictures());
    let of = &group.regions[0];
    // Red, whose colour is 1.
    close(of.mean[0].value, (1.2 + 2.4) / 2.0);
    close(of.bias.expect("a reference")[0].value, (0.2 + 0.4) / 2.0);
    close(of.relative_bias.expect("a reference").value, 0.2);
    close(of.variance[0].value, 0.4);
    // Variance of each pixel's mean: 0.4 / 8 of the runs, 0.01 of the reference.
    let error = (2.0 * (0.05_f64 + 0.01)).sqrt() / 2.0;
    close(of.bias.expect("a reference")[0].error, error);
    let squares = 0.5 * (0.2_f64.powi(2) + 0.4_f64.powi(2));
    let bias_squared = squares - 0.05 - 0.01;
    close(of.energy.bias_squared().value, bias_squared * colours());
    close(of.energy.mse().value, (bias_squared + 0.1) * colours());
    close(of.energy.noise(), 0.1 * colours());
    // Spread over the runs: 0.08 and 0.32; stored variances say 0.1 in each.
    close(of.agreement.expect("two runs").value, 2.0);
    assert_eq!((group.runs, group.samples), (2, 4.0));
    close(group.seconds.value, 2.0);
    close(group.seconds.error, 1.0);
}

#[test]
fn maps() {
    let question = question(Some(reference()), Vec::new());
    let maps = group(&question, &pictures()).maps;
    close(f64::from(maps.mean[1][0]), 2.4);
    let bias = maps.bias.as_ref().expect("a reference");
    close(f64::from(bias[1][0]), 0.4);
    close(f64::from(maps.deviation[0][2]), 0.4_f64.sqrt() * COLOUR[2]);
}

/// An estimate of bias^2 may be below 0, and is left there.
#[test]
fn negative_bias_squared() {
    let question = question(Some(reference()), Vec::new());
    let same = picture(2, 4, 1, vec![(1.0, 0.2), (2.0, 0.4)]);
    let group = group(&question, &[same]);
    let found = group.regions[0].energy.bias_squared();
    close(found.value, -(0.075 + 0.01) * colours());
    assert!(!found.is_above_zero());
}

#[test]
fn regions_are_parts() {
    let right = region("right", [1, 0, 2, 1]);
    let question = question(Some(reference()), vec![right]);
    let group = group(&question, &pictures());
    close(group.regions[1].mean[0].value, 2.4);
    close(group.regions[1].bias.expect("a reference")[0].value, 0.4);
}

/// Runs of 1 and 3 seconds against themselves with three times the time.
#[test]
fn noise_alone_without_a_reference() {
    let question = question(None, Vec::new());
    let first = group(&question, &pictures());
    let mut slow = first.clone();
    slow.name = "slow".into();
    slow.seconds = slow.seconds.times(3.0);
    let analysis = Analysis::new(question, vec![first, slow], None).expect("two groups");
    let against = analysis.against[1][0];
    close(against.equal_time.expect("noise").value, 3.0);
    // Two pixels say too little to exclude that no time is enough.
    assert_eq!(against.equal_error, None);
    assert_eq!((against.crossing, against.efficiency), (None, None));
    assert_eq!(analysis.groups[1].regions[0].bias, None);
}

/// A group's bias is by its own reference, and it has no ratio to a group of another one.
#[test]
fn each_group_has_its_reference() {
    let brighter = picture(2, 100, 98, vec![(2.0, 1.0), (3.0, 1.0)]);
    let other = Reference::new("brighter", brighter).expect("it has noise");
    let references = vec![reference(), other];
    let question = Question::new([2, 1], references, Vec::new(), Terms::default(), 4);
    let question = question.expect("a question");
    let answered = |name: &str, number| {
        let mut runs = Runs::new(name, Map::new());
        for (picture, seconds) in pictures().iter().zip([1.0, 3.0]) {
            runs.add(picture, seconds).expect("a run");
        }
        question.answer(runs, number)
    };
    let named = [("a", Some(0)), ("b", Some(1)), ("c", None), ("d", Some(0))];
    let groups = named.map(|(name, number)| answered(name, number).expect("a group"));
    let bias = |group: &Group| group.regions[0].bias.map(|bias| bias[0].value);
    close(bias(&groups[0]).expect("a reference"), 0.3);
    close(bias(&groups[1]).expect("a reference"), -0.7);
    assert_eq!(bias(&groups[2]), None);
    assert!(answered("e", Some(2)).is_err());
    let analysis = Analysis::new(question.clone(), groups.to_vec(), None).expect("groups");
    let ratios = analysis.against.iter().map(|against| against[0].equal_time);
    let there: Vec<bool> = ratios.map(|ratio| ratio.is_some()).collect();
    assert_eq!(there, [true, false, false, true]);
    let mut data = ReportData::default();
    analysis.fill(&mut data);
    let numbers: Vec<_> = data.groups.iter().map(|group| group.reference).collect();
    assert_eq!(numbers, [Some(0), Some(1), None, Some(0)]);
    assert_eq!(data.references.len(), 2);
    let notes = data.notes.join("\n");
    assert!(notes.contains("2 of 4 groups have no ratios"), "{notes}");
}

#[test]
fn what_cannot_be_analysed() {
    let mut runs = Runs::new("group", Map::new());
    let [first, second] = pictures();
    runs.add(&first, 1.0).expect("a run");
    let mut refused = |picture: &Picture, seconds, reason: &str| {
        let error = runs.add(picture, seconds).expect_err(reason).to_string();
        assert!(error.contains(reason), "{error}");
    };
    refused(&first, 1.0, "same samples");
    refused(&second, f64::NAN, "seconds");
    refused(&picture(1, 4, 3, vec![(1.0, 1.0)]), 1.0, "several sizes");
    refused(&picture(2, 1, 3, vec![(1.0, 0.0); 2]), 1.0, "two samples");
    refused(&picture(2, 4, 3, vec![(f64::NAN, 0.0); 2]), 1.0, "finite");
    // The reference of the runs' own seed.
    let own = Reference::new("reference", second).expect("it has noise");
    let question = question(Some(own), Vec::new());
    let mut runs = Runs::new("group", Map::new());
    runs.add(&pictures()[1], 1.0).expect("a run");
    let error = question
        .answer(runs, Some(0))
        .expect_err("shared")
        .to_string();
    assert!(error.contains("a seed of its own"), "{error}");
    let outside = vec![region("far", [0, 0, 3, 1])];
    let error = Question::new([2, 1], Vec::new(), outside, Terms::default(), 1);
    assert!(
        error
            .expect_err("outside")
            .to_string()
            .contains("region far")
    );
}
