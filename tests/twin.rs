//! Each library function on the GPU against its twin in Rust, and both against references in f64.
//!
//! A tolerance is written as a multiple of f32's rounding unit times what rounding grows with in
//! that function; the multiples are about twice the worst seen on lavapipe (Mesa 22.3.6), whose
//! division and square root are exact to half a unit and whose inverse square root, exponential and
//! logarithm are a few units off.

mod support;

#[path = "twin/cases.rs"]
mod cases;
#[path = "twin/efficiency.rs"]
mod efficiency;
#[path = "twin/gloss.rs"]
mod gloss;
#[path = "twin/inputs.rs"]
mod inputs;
#[path = "twin/reference.rs"]
mod reference;
#[path = "twin/sequence.rs"]
mod sequence;

use cases::Case;
use lampray::pack::ProbeOutput;

/// What came out, as one list of eight numbers.
fn lanes(output: &ProbeOutput) -> [f32; 8] {
    let ([a, b, c, d], [e, f, g, h]) = (output.a, output.b);
    [a, b, c, d, e, f, g, h]
}

/// How far `got` is from `wanted`, in tolerances; the worst of the eight lanes.
fn error(got: &[f32; 8], wanted: &[f32; 8], tolerance: &[f64; 8]) -> f64 {
    let lanes = got.iter().zip(wanted).zip(tolerance);
    let each = lanes.map(|((&got, &wanted), &tolerance)| {
        let apart = (f64::from(got) - f64::from(wanted)).abs();
        match (apart == 0.0, got.is_finite() && wanted.is_finite()) {
            (true, _) => 0.0,
            (_, false) if got.to_bits() == wanted.to_bits() => 0.0,
            (_, false) => f64::INFINITY,
            _ => apart / tolerance,
        }
    });
    each.fold(0.0, f64::max)
}

/// The inputs on which two sets of outputs differ, and the worst difference of the others.
fn differences(case: &Case, got: &[[f32; 8]], wanted: &[[f32; 8]]) -> (Vec<usize>, f64) {
    let (mut strays, mut worst) = (Vec::new(), 0.0);
    for (place, input) in case.inputs.iter().enumerate() {
        let tolerance = (case.tolerance)(input, &wanted[place]);
        let error = error(&got[place], &wanted[place], &tolerance);
        if error <= 1.0 {
            worst = f64::max(worst, error);
        } else {
            strays.push(place);
        }
    }
    (strays, worst)
}

fn check(case: &Case, got: &[[f32; 8]], wanted: &[[f32; 8]]) {
    let (strays, worst) = differences(case, got, wanted);
    println!(
        "{:<44} worst {worst:.2} tolerances, {} strays",
        case.name,
        strays.len()
    );
    let first = strays.first().map(|&place| {
        format!(
            "{:?}\ngot    {:?}\nwanted {:?}",
            case.inputs[place], got[place], wanted[place]
        )
    });
    let (name, count) = (&case.name, strays.len());
    assert!(
        count <= case.strays,
        "{name}: {count} strays, the first {}",
        first.unwrap()
    );
}

fn twin(case: &Case) -> Vec<[f32; 8]> {
    case.inputs.iter().map(|input| (case.twin)(input)).collect()
}

#[test]
fn every_function_is_its_twin_on_the_gpu() {
    let Some(mut gpu) = support::gpu("library functions against their twins") else {
        return;
    };
    for case in cases::all() {
        assert!(case.inputs.len() >= 4096, "{}", case.name);
        let outputs = gpu.probe(&case.strategy, case.probe, &case.inputs).unwrap();
        let got: Vec<_> = outputs.iter().map(lanes).collect();
        check(&case, &got, &twin(&case));
    }
}

#[test]
fn a_twin_that_is_off_is_caught() {
    for case in cases::all() {
        let wanted = twin(&case);
        // The sixth part of a thousandth is what a wrong digit in a polynomial would cost.
        let wrong: Vec<_> = wanted
            .iter()
            .map(|lanes| lanes.map(|x| x * 1.00017))
            .collect();
        let exact = case.inputs.iter().all(|input| {
            (case.tolerance)(input, &[1.0; 8])
                .iter()
                .all(|tolerance| *tolerance == 0.0)
        });
        let (strays, _) = differences(&case, &wrong, &wanted);
        assert!(
            exact || strays.len() > case.strays,
            "{} would not see it",
            case.name
        );
    }
}

/// Runs a check on the twin's outputs, and on the GPU's where there is one.
fn on_both(case: &Case, what: &str, check: impl Fn(&str, &[[f32; 8]])) {
    check("twin", &twin(case));
    if let Some(mut gpu) = support::gpu(what) {
        let outputs = gpu.probe(&case.strategy, case.probe, &case.inputs).unwrap();
        check("gpu", &outputs.iter().map(lanes).collect::<Vec<_>>());
    }
}
