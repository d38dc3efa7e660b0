//! Every kernel, with every strategy, without a GPU: joined, parsed, validated, and validated again
//! with its override constants put in.

mod support;

use lampray::knobs::*;
use lampray::pack::{LastRay, RUN_LENGTH, Strategy};
use lampray::shader::{self, Canary, Kernel, Probe, SceneArrays};
use naga::back::pipeline_constants::{PipelineConstantError, process_overrides};
use naga::valid::{Capabilities, ModuleInfo, ValidationFlags, Validator};
use std::collections::{BTreeMap, BTreeSet, HashSet};
use support::stream::Stream;

fn arrays(materials: usize, spheres: usize, boxes: usize, lamps: usize) -> SceneArrays {
    SceneArrays {
        materials,
        spheres,
        boxes,
        lamps,
        ..SceneArrays::default()
    }
}

/// The same with a tree over the bodies.
fn with_tree(arrays: SceneArrays) -> SceneArrays {
    SceneArrays {
        nodes: 1000,
        outside_spheres: 2,
        outside_boxes: 7,
        ..arrays
    }
}

/// The same with something that lamps are chosen by: as little as there can be, or as much.
fn with_choice(arrays: SceneArrays) -> SceneArrays {
    let choice = if arrays.lamps > 2 { 300_000 } else { 1 };
    SceneArrays { choice, ..arrays }
}

/// Array lengths: the smallest, all uniform, all storage, and each mixed with the others; the
/// same by a tree; and all of these with lamps that are chosen.
fn array_sets() -> Vec<SceneArrays> {
    let large = 100_000;
    let sets = [
        arrays(1, 1, 1, 1),
        arrays(4, 4, 8, 1),
        arrays(large, large, large, large),
        arrays(1, large, 1, 1),
        arrays(2, 2, large, 2),
        arrays(large, 2, 2, 2),
        arrays(2, large, 2, large),
    ];
    let all = sets.into_iter().chain(sets.map(with_tree));
    all.flat_map(|arrays| [arrays, with_choice(arrays)])
        .collect()
}

/// How many values each knob of a strategy has, in the order that [`spelled`] reads them.
const VALUES: [usize; KNOBS] = [2, 7, 2, 3, 2, 2, 2, 2, 5, 2, 2, 3, 2, 2, 2, 4, 2, 2, 2];
const KNOBS: usize = 19;

fn spelled(row: &[usize; KNOBS]) -> Strategy {
    Strategy {
        filter: Filter::ALL[row[0]],
        light_sampler: LightSampler::ALL[row[1]],
        light_weight: LightWeight::ALL[row[2]],
        light_strategy: LightStrategy::ALL[row[3]],
        light_direct: LightDirect::ALL[row[4]],
        pole_at_receiver: row[5] == 1,
        scatter_diffuse: ScatterDiffuse::ALL[row[6]],
        scatter_bound: ScatterBound::ALL[row[7]],
        interruption_rule: InterruptionRule::ALL[row[8]],
        interruption_weight: InterruptionWeight::ALL[row[9]],
        interruption_order: InterruptionOrder::ALL[row[10]],
        last_ray: LastRay::ALL[row[11]],
        rough_surfaces: row[12] == 1,
        glass_surfaces: row[13] == 1,
        lens: row[14] == 1,
        light_choice: LightChoice::ALL[row[15]],
        light_test: LightTest::ALL[row[16]],
        box_lamps: row[17] == 1,
        background_lamp: row[18] == 1,
        ..support::strategy()
    }
}

type Pair = (usize, usize, usize, usize);

fn pairs(row: &[usize; KNOBS]) -> Vec<Pair> {
    let places = (0..row.len()).flat_map(|a| (a + 1..row.len()).map(move |b| (a, b)));
    places.map(|(a, b)| (a, row[a], b, row[b])).collect()
}

fn all_pairs() -> HashSet<Pair> {
    let mut all = HashSet::new();
    for (a, &of_a) in VALUES.iter().enumerate() {
        for (b, &of_b) in VALUES.iter().enumerate().skip(a + 1) {
            all.extend((0..of_a).flat_map(|x| (0..of_b).map(move |y| (a, x, b, y))));
        }
    }
    all
}

/// Rows that hold every value of every knob together with every value of every other: whatever two
/// knobs interact, some row has that pair. Each row is the best of many drawn at random.
fn covering_rows() -> Vec<[usize; KNOBS]> {
    let mut left = all_pairs();
    let mut rows = Vec::new();
    let mut stream = Stream::new(1);
    while !left.is_empty() {
        let candidates: Vec<_> = (0..64)
            .map(|_| VALUES.map(|count| (stream.bits() % count as u64) as usize))
            .collect();
        let gain = |row: &&[usize; KNOBS]| pairs(row).iter().filter(|p| left.contains(p)).count();
        let best = *candidates.iter().max_by_key(gain).unwrap();
        for pair in pairs(&best) {
            left.remove(&pair);
        }
        rows.push(best);
    }
    rows
}

fn module(kernel: Kernel, arrays: SceneArrays) -> (naga::Module, ModuleInfo) {
    let joined = shader::source(kernel, arrays).unwrap();
    let module = shader::parse(&joined).unwrap_or_else(|e| panic!("{e}"));
    shader::validate(&joined, &module).unwrap_or_else(|e| panic!("{e}"));
    let mut validator = Validator::new(ValidationFlags::all(), Capabilities::empty());
    let info = validator.validate(&module).unwrap();
    (module, info)
}

/// The constants that the pipeline gives: those of the strategy that the kernel declares.
fn constants(module: &naga::Module, strategy: &Strategy) -> naga::back::PipelineConstants {
    let declared = names(module);
    let all = strategy.overrides().into_iter();
    all.filter(|(name, _)| declared.contains(*name))
        .map(|(name, value)| (name.to_string(), f64::from(value)))
        .collect()
}

fn names(module: &naga::Module) -> BTreeSet<String> {
    let named = module.overrides.iter();
    named
        .filter_map(|(_, constant)| constant.name.clone())
        .collect()
}

/// Puts a strategy's constants into a module and validates what comes of it.
fn resolve(
    module: &naga::Module,
    info: &ModuleInfo,
    constants: &naga::back::PipelineConstants,
) -> Result<naga::Module, Box<PipelineConstantError>> {
    let entry = Some((naga::ShaderStage::Compute, "main"));
    let (resolved, _) = process_overrides(module, info, entry, constants)?;
    let mut validator = Validator::new(ValidationFlags::all(), Capabilities::empty());
    validator.validate(&resolved).unwrap();
    Ok(resolved.into_owned())
}

fn mentions_overrides(module: &naga::Module) -> bool {
    let in_functions = module.functions.iter().map(|(_, function)| function);
    let in_entry = module.entry_points.iter().map(|entry| &entry.function);
    let bodies = in_functions.chain(in_entry).map(|body| &body.expressions);
    bodies.chain([&module.global_expressions]).any(|arena| {
        arena
            .iter()
            .any(|(_, expression)| matches!(expression, naga::Expression::Override(_)))
    })
}

#[test]
fn the_covering_set_has_every_pair_of_values() {
    let rows = covering_rows();
    let covered: HashSet<_> = rows.iter().flat_map(pairs).collect();
    assert_eq!(covered, all_pairs());
    // And would lack some without any one of the last rows, so that it is no idle list.
    let fewer: HashSet<_> = rows[..rows.len() - 1].iter().flat_map(pairs).collect();
    assert_ne!(fewer, all_pairs());
}

#[test]
fn every_kernel_is_valid_with_every_strategy() {
    let rows = covering_rows();
    let by_loops = arrays(4, 4, 8, 1);
    let kernels = Kernel::ALL.iter().map(|kernel| (*kernel, by_loops));
    for (kernel, arrays) in kernels.chain([
        (Kernel::Trace, with_tree(by_loops)),
        (Kernel::Trace, with_choice(by_loops)),
    ]) {
        let (module, info) = module(kernel, arrays);
        for row in &rows {
            let strategy = Strategy {
                sphere_count: 3,
                box_count: 5,
                rotated_box_count: 2,
                lamp_count: 1,
                outside_sphere_count: 1,
                outside_box_count: 3,
                outside_rotated_count: 2,
                ..spelled(row)
            };
            let resolved = resolve(&module, &info, &constants(&module, &strategy));
            let resolved = resolved.unwrap_or_else(|e| panic!("{kernel} {strategy:?}: {e}"));
            assert!(!mentions_overrides(&resolved), "{kernel} keeps overrides");
            // A filter is the same for every strategy.
            assert_eq!(mentions_overrides(&module), kernel != Kernel::Denoise);
        }
    }
}

#[test]
fn every_kernel_is_valid_with_every_kind_of_scene_array() {
    for &kernel in Kernel::ALL {
        for arrays in array_sets() {
            let (module, info) = module(kernel, arrays);
            for counts in [
                [0, 0, 0, 0],
                [1, 0, 0, 1],
                [0, 1, 0, 0],
                [0, 0, 1, 0],
                [7, 5, 3, 2],
            ] {
                let [sphere_count, box_count, rotated_box_count, lamp_count] = counts;
                let strategy = Strategy {
                    sphere_count,
                    box_count,
                    rotated_box_count,
                    lamp_count,
                    outside_sphere_count: sphere_count.min(2),
                    outside_box_count: box_count,
                    outside_rotated_count: rotated_box_count.min(2),
                    ..support::strategy()
                };
                let resolved = resolve(&module, &info, &constants(&module, &strategy));
                resolved.unwrap_or_else(|e| panic!("{kernel} {arrays:?} {counts:?}: {e}"));
            }
        }
    }
}

#[test]
fn constants_that_are_missing_or_unknown_or_unfit_are_refused() {
    let (module, info) = module(Kernel::Trace, arrays(1, 1, 1, 1));
    let whole = constants(&module, &support::strategy());
    let mut missing = whole.clone();
    missing.remove("LIGHT_SAMPLER");
    let mut unknown = whole.clone();
    unknown.insert("LIGHT_SAMPLERS".into(), 0.0);
    let mut negative = whole.clone();
    negative.insert("LIGHT_SAMPLER".into(), -1.0);
    for constants in [missing, unknown, negative] {
        assert!(resolve(&module, &info, &constants).is_err());
    }
}

#[test]
fn strategies_and_shaders_name_the_same_overrides() {
    let mut declared = BTreeSet::new();
    let smallest = arrays(1, 1, 1, 1);
    let kernels = Kernel::ALL.iter().map(|kernel| (*kernel, smallest));
    for (kernel, arrays) in kernels.chain([(Kernel::Trace, with_tree(smallest))]) {
        let (module, _) = module(kernel, arrays);
        for (_, constant) in module.overrides.iter() {
            let name = constant.name.clone().unwrap();
            let kind = &module.types[constant.ty].inner;
            let u32_kind = naga::TypeInner::Scalar(naga::Scalar::U32);
            assert_eq!(*kind, u32_kind, "{kernel}: {name}");
            assert!(constant.init.is_none(), "{kernel}: {name} has a default");
            assert!(constant.id.is_none(), "{kernel}: {name} has a number");
            declared.insert(name);
        }
    }
    let given = support::strategy().overrides();
    let given: BTreeSet<_> = given.iter().map(|(name, _)| name.to_string()).collect();
    assert_eq!(declared, given);
}

/// Name and value of every u32 constant that the shaders see.
fn shader_constants() -> BTreeMap<String, u32> {
    let (module, _) = module(Kernel::Probe, arrays(1, 1, 1, 1));
    let mut all = BTreeMap::new();
    for (_, constant) in module.constants.iter() {
        let value = &module.global_expressions[constant.init];
        if let (Some(name), naga::Expression::Literal(naga::Literal::U32(value))) =
            (&constant.name, value)
        {
            all.insert(name.clone(), *value);
        }
    }
    all
}

/// The constants of one Rust enum, spelled without the code that prints them for the shaders.
fn expected<C: Choice + std::fmt::Display>(prefix: &str) -> Vec<(String, u32)> {
    let spelled = |(place, value): (usize, &C)| {
        assert_eq!(value.index() as usize, place, "{value}");
        let name = value.to_string().replace('-', "_").to_ascii_uppercase();
        (format!("{prefix}_{name}"), place as u32)
    };
    C::ALL.iter().enumerate().map(spelled).collect()
}

#[test]
fn enums_have_the_same_numbers_on_both_sides() {
    let lists = [
        expected::<Scatter>("SURFACE"),
        expected::<Filter>("FILTER"),
        expected::<LightSampler>("LIGHT_SAMPLER"),
        expected::<LightWeight>("LIGHT_WEIGHT"),
        expected::<LightTest>("LIGHT_TEST"),
        expected::<LightStrategy>("LIGHT_STRATEGY"),
        expected::<LightChoice>("LIGHT_CHOICE"),
        expected::<LightDirect>("LIGHT_DIRECT"),
        expected::<ScatterDiffuse>("SCATTER_DIFFUSE"),
        expected::<ScatterBound>("SCATTER_BOUND"),
        expected::<InterruptionRule>("INTERRUPTION_RULE"),
        expected::<InterruptionWeight>("INTERRUPTION_WEIGHT"),
        expected::<InterruptionOrder>("INTERRUPTION_ORDER"),
        expected::<LastRay>("LAST_RAY"),
        expected::<Sequence>("SEQUENCE"),
        expected::<Probe>("PROBE"),
        expected::<Canary>("CANARY"),
        vec![("RUN_LENGTH".to_string(), RUN_LENGTH)],
    ];
    let mut wanted: BTreeMap<_, _> = lists.into_iter().flatten().collect();
    let printed = || {
        let mut all = shader_constants();
        // The light tree's own.
        all.retain(|name, _| !["LEAF", "LEAST_SHARE", "WHOLE_SHARE"].contains(&name.as_str()));
        all
    };
    assert_eq!(printed(), wanted);
    // One number wrong would show.
    wanted.insert("LIGHT_SAMPLER_CONE".into(), 2);
    assert_ne!(printed(), wanted);
}

/// Eight storage buffers are what every WebGPU device has for a stage, and one uniform buffer is what
/// lavapipe 22.3 bears beside the job's.
#[test]
fn no_kernel_binds_more_than_devices_have() {
    for arrays in array_sets() {
        let (module, _) = module(Kernel::Trace, arrays);
        let count = |wanted: fn(&naga::AddressSpace) -> bool| {
            let all = module.global_variables.iter();
            all.filter(|(_, global)| wanted(&global.space)).count()
        };
        let storage = count(|space| matches!(space, naga::AddressSpace::Storage { .. }));
        let uniform = count(|space| *space == naga::AddressSpace::Uniform);
        assert!(
            storage <= 8 && uniform <= 2,
            "{arrays:?}: {storage}, {uniform}"
        );
    }
}
