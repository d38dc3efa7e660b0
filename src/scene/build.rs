//! From a draft to a scene: presets and defaults fill what nobody wrote, and the parts are checked
//! against each other.

use super::draft::{Draft, Group};
use super::faults::{Faults, Origin};
use super::{Camera, Scene, Source};
use crate::knobs::randomisation::SHORTEST;
use crate::knobs::{
    Interruption, InterruptionRule, InterruptionWeight, KNOBS, Knob, Preset, RenderKernel,
    SMALLEST, Sequence, Settings, Value, choice, find, in_section,
};
use glam::DVec3;
use std::collections::HashMap;

/// Pixels of a picture.
const MOST_PIXELS: u64 = 1 << 28;

/// Bodies that `render.kernel = "baked"` takes: compilers need 8 ms for each of few, and 20 for each of so many.
pub const MOST_BAKED: usize = 256;

/// The scene, or None if there are faults.
pub(crate) fn build(
    source: Source,
    draft: &Draft,
    whole: bool,
    faults: &mut Faults<'_>,
) -> Option<Scene> {
    let mut builder = Builder {
        draft,
        preset: preset(draft),
        // What seems to be missing may be in the part that is not TOML.
        whole,
        faults,
    };
    let strategy = builder.strategy();
    let lambert = builder.lambert();
    let settings = Settings::gather(builder.preset, |path| match (path, &strategy) {
        ("light.strategy", Some(implied)) => implied.clone(),
        ("light.boxes" | "light.background", _) if lambert => Value::Text("hit".into()),
        _ => builder.single(path),
    });
    builder.picture(&settings);
    builder.sequence(&settings);
    let camera = builder.camera();
    let background = builder.single("background.emission").triple();
    let materials = builder.materials();
    let names: HashMap<_, _> = materials
        .iter()
        .enumerate()
        .map(|(number, material)| (material.name.as_str(), number))
        .collect();
    let spheres = builder.spheres(&names);
    let boxes = builder.boxes(&names);
    builder.efficiency(&settings);
    builder.kernel(&settings, spheres.len() + boxes.len());
    let knobs = builder.record(strategy.as_ref(), lambert);
    faults.is_empty().then_some(Scene {
        source,
        camera,
        background,
        materials,
        spheres,
        boxes,
        settings,
        knobs,
        sweep: draft.sweep.clone(),
    })
}

/// The preset that the rest starts from.
fn preset(draft: &Draft) -> Preset {
    let written = draft.singles.by_path("render.preset");
    written
        .and_then(|entry| entry.value.as_ref())
        .map_or(Preset::Reference, choice)
}

pub(super) struct Builder<'d, 'f, 'a> {
    pub(super) draft: &'d Draft,
    pub(super) preset: Preset,
    pub(super) whole: bool,
    pub(super) faults: &'f mut Faults<'a>,
}

/// A stand-in for a value that is missing or was refused; the fault has been noted.
pub(super) fn stand_in(knob: &Knob, preset: Preset) -> Value {
    use crate::knobs::Kind;
    knob.value(preset).cloned().unwrap_or(match knob.kind {
        Kind::Triple(_) => Value::Triple([0.0; 3]),
        Kind::Material => Value::Text("".into()),
        _ => Value::Number(1.0),
    })
}

/// A vector's direction, if it is long enough to have one: squares of shorter ones vanish even in f64.
fn direction(vector: DVec3) -> Option<DVec3> {
    (vector.abs().max_element() >= SMALLEST).then(|| vector.normalize())
}

impl Builder<'_, '_, '_> {
    /// A knob that there is one of.
    fn single(&self, path: &str) -> Value {
        let Some(target) = find(path) else {
            unreachable!("`{path}` is not in the table of knobs");
        };
        let written = self.draft.singles.by_path(path);
        written
            .and_then(|entry| entry.value.clone())
            .unwrap_or_else(|| stand_in(target.knob, self.preset))
    }

    /// Where a single knob's value comes from; for a preset's value, where the preset was chosen.
    fn origin(&self, path: &str) -> Origin {
        let singles = &self.draft.singles;
        if let Some(entry) = singles.by_path(path) {
            return entry.origin.clone();
        }
        let by_preset = find(path).is_some_and(|target| target.knob.in_presets());
        match singles.by_path("render.preset") {
            Some(entry) if by_preset => entry.origin.clone(),
            _ => Origin::Default,
        }
    }

    /// The origin to blame when several values do not fit: the command line spoke last, and of what
    /// stands in the file the first of the list.
    pub(super) fn blame(&self, origins: &[Origin]) -> Origin {
        let flag = origins.iter().rev().find(|o| matches!(o, Origin::Flag(_)));
        let file = || origins.iter().find(|o| matches!(o, Origin::File(_)));
        flag.or_else(file).cloned().unwrap_or(Origin::Default)
    }

    /// `sample` where Lambert light or the solid-angle weight implies it; asked for otherwise, it
    /// is a fault.
    fn strategy(&mut self) -> Option<Value> {
        let implying = [("light.direct", "lambert"), ("light.weight", "solid-angle")];
        let (path, value) = implying
            .into_iter()
            .find(|(path, value)| self.single(path).text() == *value)?;
        let asked = self.single("light.strategy");
        if asked.text() != "sample" && self.draft.singles.by_path("light.strategy").is_some() {
            let origin = self.blame(&[self.origin("light.strategy"), self.origin(path)]);
            self.faults.add(origin, || {
                let message = format!(
                    "`light.strategy` cannot be `{asked}` beside `{path} = \"{value}\"`, which samples the lamps only"
                );
                let note = format!(
                    "leave out `light.strategy` or set it to `sample`; or set `{path}` to `{}`",
                    if path == "light.direct" { "bsdf" } else { "pdf" }
                );
                (message, Some(note))
            });
        }
        Some(Value::Text("sample".into()))
    }

    /// Whether there are samples for two randomisations: of one nobody knows how far off it is.
    fn sequence(&mut self, settings: &Settings) {
        let (sequence, least) = (settings.render.sequence, 2 * SHORTEST);
        if sequence == Sequence::Independent || settings.render.samples >= least {
            return;
        }
        let origin = self.blame(&[
            self.origin("render.sequence"),
            self.origin("render.samples"),
        ]);
        self.faults.add(origin, || {
            let message = format!(
                "`render.sequence = \"{sequence}\"` takes {least} samples a pixel or more: two point sets of {SHORTEST}, for an error that can be told"
            );
            let note = format!("raise `render.samples` to {least}, or set `render.sequence` to `independent`");
            (message, Some(note))
        });
    }

    /// Whether direct light is Lambert's: what is no spherical lamp is then left to what the camera sees, and asked
    /// for otherwise it is a fault.
    fn lambert(&mut self) -> bool {
        if self.single("light.direct").text() != "lambert" {
            return false;
        }
        for path in ["light.boxes", "light.background"] {
            let written = self.draft.singles.by_path(path).is_some();
            if written && self.single(path).text() == "sample" {
                let origin = self.blame(&[self.origin(path), self.origin("light.direct")]);
                self.faults.add(origin, || {
                    let message = format!(
                        "`{path}` cannot be `sample` beside `light.direct = \"lambert\"`, which lights by the spherical lamps alone"
                    );
                    let note = format!("leave out `{path}` or set it to `hit`; or set `light.direct` to `bsdf`");
                    (message, Some(note))
                });
            }
        }
        true
    }

    fn picture(&mut self, settings: &Settings) {
        let (width, height) = (settings.image.width, settings.image.height);
        if u64::from(width) * u64::from(height) > MOST_PIXELS {
            let origin = self.blame(&[self.origin("image.width"), self.origin("image.height")]);
            self.faults.add(origin, || {
                let message = format!("a picture of {width} x {height} pixels is too large");
                (
                    message,
                    Some("it may have 2^28 (268435456) pixels at most".into()),
                )
            });
        }
    }

    /// Paths that are thinned out and split by what they cost must be made up for: literal ones would lose or gain
    /// light by a pilot's chance.
    fn efficiency(&mut self, settings: &Settings) {
        let Interruption { rule, weight, .. } = settings.interruption;
        if rule == InterruptionRule::Efficiency && weight == InterruptionWeight::Literal {
            let origins = ["interruption.weight", "interruption.rule"];
            let origin = self.blame(&origins.map(|path| self.origin(path)));
            self.faults.add(origin, || {
                let message = "`interruption.rule` cannot be `efficiency` beside `interruption.weight = \"literal\"`";
                let note = "set `interruption.weight` to `compensated`, or choose another rule";
                (message.into(), Some(note.into()))
            });
        }
    }

    /// A distance in focus says nothing of a pinhole: one that nobody gave an aperture was meant to be a lens.
    fn lens(&mut self) {
        let focus = self.single("camera.focus").optional().is_some();
        if focus && self.draft.singles.by_path("camera.aperture").is_none() {
            let origin = self.origin("camera.focus");
            self.faults.add(origin, || {
                let message = "`camera.focus` is set, and `camera.aperture` is not".into();
                let note = "a pinhole is in focus everywhere; set `camera.aperture` to the radius of the lens, or to 0";
                (message, Some(note.into()))
            });
        }
    }

    /// Whether the kernel that was asked for takes the bodies.
    fn kernel(&mut self, settings: &Settings, bodies: usize) {
        if settings.render.kernel == RenderKernel::Baked && bodies > MOST_BAKED {
            let origin = self.origin("render.kernel");
            self.faults.add(origin, || {
                let message = format!(
                    "`render.kernel = \"baked\"` takes up to {MOST_BAKED} bodies, and the scene has {bodies}"
                );
                (message, Some("set it to `auto` or `bvh`".into()))
            });
        }
    }

    fn camera(&mut self) -> Camera {
        let singles = &self.draft.singles;
        let mut complete = true;
        for knob in in_section("camera").filter(|knob| knob.default().is_none()) {
            match singles.by_path(knob.path) {
                Some(entry) => complete &= entry.value.is_some(),
                None => {
                    complete = false;
                    self.missing_camera(knob);
                }
            }
        }
        self.lens();
        let camera = Camera {
            position: self.single("camera.position").triple(),
            look_at: self.single("camera.look_at").triple(),
            up: self.single("camera.up").triple(),
            fov: self.single("camera.fov").number(),
            aperture: self.single("camera.aperture").number(),
            focus: self.single("camera.focus").optional(),
        };
        if complete {
            self.view(&camera);
        }
        camera
    }

    fn missing_camera(&mut self, knob: &'static Knob) {
        if !self.whole {
            return;
        }
        let header = self
            .draft
            .headers
            .iter()
            .find(|(name, _)| *name == "camera");
        let origin = header.map_or(Origin::File(0..0), |(_, origin)| origin.clone());
        self.faults.add(origin, || {
            let note = format!("[camera] needs `{}`: {}", knob.key(), knob.meaning);
            (format!("`{}` is missing", knob.path), Some(note))
        });
    }

    /// Whether the camera's three vectors span a picture.
    fn view(&mut self, camera: &Camera) {
        let looks = [
            self.origin("camera.look_at"),
            self.origin("camera.position"),
        ];
        let Some(view) = direction(camera.look_at - camera.position) else {
            let origin = self.blame(&looks);
            self.faults.add(origin, || {
                (
                    "`camera.look_at` must differ from `camera.position`".into(),
                    None,
                )
            });
            return;
        };
        let Some(up) = direction(camera.up) else {
            let origin = self.blame(&[self.origin("camera.up")]);
            self.faults.add(origin, || {
                (
                    "`camera.up` must be a direction: its length must not be zero".into(),
                    None,
                )
            });
            return;
        };
        // Below a few times 1e-7 32-bit floats cannot tell the two apart.
        if view.cross(up).length() < 1e-6 {
            let [look_at, position] = looks;
            let origin = self.blame(&[self.origin("camera.up"), look_at, position]);
            self.faults.add(origin, || {
                let note = "choose an `up` that is not along the line from `position` to `look_at`";
                (
                    "`camera.up` is parallel to the view".into(),
                    Some(note.into()),
                )
            });
        }
    }

    /// Every knob's value by its path, as records carry them.
    fn record(
        &self,
        strategy: Option<&Value>,
        lambert: bool,
    ) -> serde_json::Map<String, serde_json::Value> {
        let mut record = serde_json::Map::new();
        for knob in KNOBS.iter().filter(|knob| !knob.repeats()) {
            let value = match (knob.path, strategy) {
                ("light.strategy", Some(implied)) => implied.to_json(),
                ("light.boxes" | "light.background", _) if lambert => "hit".into(),
                (path, _) => self.single(path).to_json(),
            };
            record.insert(knob.path.into(), value);
        }
        let value = |group: &Group, knob: &'static Knob| {
            let written = group
                .entry(knob.key())
                .and_then(|entry| entry.value.clone());
            let value = written.unwrap_or_else(|| stand_in(knob, self.preset));
            value.to_json()
        };
        for group in &self.draft.materials {
            for knob in in_section("materials") {
                let path = format!("materials.{}.{}", group.name, knob.key());
                record.insert(path, value(group, knob));
            }
        }
        for path in &self.draft.set_shapes {
            let Some(target) = find(path) else { continue };
            let list = match target.knob.section() {
                "spheres" => &self.draft.spheres,
                _ => &self.draft.boxes,
            };
            let number = target.item.and_then(|item| item.parse::<usize>().ok());
            if let Some(group) = number.and_then(|number| list.get(number)) {
                record.insert(path.clone(), value(group, target.knob));
            }
        }
        record
    }
}
