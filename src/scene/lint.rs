//! What is legal but suspect.

use super::finding::{Finding, Snippet, render};
use super::load::without_mark;
use super::places::Places;
use super::solid::Solid;
use super::{Material, Scene};
use crate::knobs::{Scatter, find, short};
use codespan_reporting::diagnostic::Severity;
use glam::DVec3;
use std::borrow::Cow;

/// Pairs of a lamp and a shape that are compared at most, a few tenths of a second.
const MOST_PAIRS: usize = 20_000_000;
/// Warnings of one kind that are given one by one.
const MOST_ALIKE: usize = 10;
/// Rays that are sent from the camera to see whether the scene is closed.
const FEELERS: usize = 64;

impl Scene {
    /// What is legal but suspect, each with its place where the scene's text has one.
    pub fn warnings(&self) -> Vec<Finding> {
        let mut lint = Lint {
            scene: self,
            found: Vec::new(),
        };
        lint.lamps_inside();
        lint.camera_inside();
        lint.no_light();
        lint.unused();
        lint.closed();
        lint.survival();
        lint.idle_knobs();
        lint.one_sample();
        lint.shown()
    }

    /// Those of [`Scene::unbounded`] alone, a line each: they make a picture that never becomes sharp, and who renders
    /// it should know.
    pub fn unbounded_lines(&self) -> Vec<String> {
        self.lines_of(|lint| lint.survival())
    }

    /// Those of materials with values that another scattering has, a line each.
    pub fn idle_materials(&self) -> Vec<String> {
        self.lines_of(|lint| lint.idle_knobs())
    }

    /// What one part of the lint finds.
    fn lines_of(&self, part: fn(&mut Lint<'_>)) -> Vec<String> {
        let mut lint = Lint {
            scene: self,
            found: Vec::new(),
        };
        part(&mut lint);
        let name = short(&self.source.name);
        let line = |finding: Finding| {
            let place = finding
                .place
                .map(|(line, column)| format!("{name}:{line}:{column}"));
            let place = place.unwrap_or_else(|| name.clone());
            let note = finding.note.unwrap_or_default();
            format!("{place}: {}; {note}", finding.message)
        };
        lint.shown().into_iter().map(line).collect()
    }

    /// Whether light cannot leave: rays from the camera in 64 directions all meet a surface.
    pub(super) fn seems_closed(&self) -> bool {
        let spheres = self.spheres.iter().map(Solid::Sphere);
        let solids: Vec<_> = spheres.chain(self.boxes.iter().map(Solid::Box)).collect();
        let from = self.camera.position;
        let meets = |direction| solids.iter().any(|solid| solid.meets(from, direction));
        (0..FEELERS).map(spiral).all(meets)
    }
}

struct Lint<'a> {
    scene: &'a Scene,
    found: Vec<Warning>,
}

impl Lint<'_> {
    fn shown(self) -> Vec<Finding> {
        let Self { scene, found } = self;
        if found.is_empty() {
            return Vec::new();
        }
        let text = without_mark(&scene.source.text);
        let places = Places::of(text);
        let show = |warning: Warning| warning.show(&scene.source.name, text, &places);
        found.into_iter().map(show).collect()
    }
}

struct Warning {
    /// The table of the scene file that it is about.
    table: String,
    message: String,
    note: Option<Cow<'static, str>>,
}

impl Warning {
    fn show(self, name: &str, text: &str, places: &Places<'_>) -> Finding {
        let span = places.find(&self.table);
        let snippet = span.map(|span| Snippet::new(name, text, span));
        let text = render(
            Severity::Warning,
            snippet.as_ref(),
            &self.message,
            self.note.as_deref(),
        );
        Finding {
            place: snippet.map(|snippet| snippet.place()),
            flag: None,
            message: self.message,
            note: self.note.map(Cow::into_owned),
            text,
        }
    }
}

impl<'a> Lint<'a> {
    fn warn(&mut self, table: impl Into<String>, message: String, note: Option<&'static str>) {
        self.found.push(Warning {
            table: table.into(),
            message,
            note: note.map(Cow::from),
        });
    }

    /// Every shape with the table it stands in.
    fn shapes(&self) -> impl Iterator<Item = (String, Solid<'a>)> + use<'a> {
        let spheres = self.scene.spheres.iter().enumerate();
        let boxes = self.scene.boxes.iter().enumerate();
        let spheres = spheres.map(|(number, s)| (format!("spheres.{number}"), Solid::Sphere(s)));
        let boxes = boxes.map(|(number, b)| (format!("boxes.{number}"), Solid::Box(b)));
        spheres.chain(boxes)
    }

    fn material(&self, solid: &Solid<'_>) -> &'a Material {
        &self.scene.materials[solid.material()]
    }

    /// Lamps that a box or another sphere holds or cuts.
    fn lamps_inside(&mut self) {
        let lamps: Vec<_> = self.scene.lamps().collect();
        let solids: Vec<_> = self.shapes().map(|(_, solid)| solid).collect();
        let most = MOST_PAIRS / solids.len().max(1);
        let spheres = self.scene.spheres.len();
        let mut alike = 0;
        for (number, lamp) in lamps.into_iter().take(most.max(1)) {
            for (other, solid) in solids.iter().enumerate() {
                let distance = solid.distance(lamp.center);
                let itself = other == number;
                if itself || distance >= lamp.radius || alike >= MOST_ALIKE {
                    continue;
                }
                let name = match other.checked_sub(spheres) {
                    Some(number) => format!("boxes.{number}"),
                    None => format!("spheres.{other}"),
                };
                let glass = self.material(solid).scatter == Scatter::Glass;
                let (how, note) = if glass && distance <= -lamp.radius {
                    (
                        "stands inside glass,",
                        "shadow rays do not go through glass: its light outside comes by hits alone",
                    )
                } else if distance <= -lamp.radius {
                    ("stands inside", "its light stays in there")
                } else if matches!(solid, Solid::Box(_)) {
                    (
                        "is partly inside",
                        "the part inside is sampled but lights nothing outside",
                    )
                } else {
                    // Spheres that touch or overlap are often meant: a lamp in a socket.
                    continue;
                };
                let table = format!("spheres.{number}");
                self.warn(
                    &table,
                    format!("the light `{table}` {how} `{name}`"),
                    Some(note),
                );
                alike += 1;
            }
        }
    }

    fn camera_inside(&mut self) {
        let position = self.scene.camera.position;
        let inside: Vec<_> = self
            .shapes()
            .filter(|(_, solid)| solid.distance(position) < 0.0)
            .map(|(name, _)| name)
            .take(MOST_ALIKE)
            .collect();
        for name in inside {
            let note = "it sees the inner side; nothing is wrong if that is meant";
            self.warn(
                "camera",
                format!("the camera stands inside `{name}`"),
                Some(note),
            );
        }
    }

    fn no_light(&mut self) {
        let scene = self.scene;
        let shines = scene.background.max_element() > 0.0
            || self
                .shapes()
                .any(|(_, solid)| self.material(&solid).emits());
        if !shines {
            let note = "give a sphere a material with `emission`, or set `background.emission`";
            let message = "there is no light: the picture will be black".into();
            self.warn("version", message, Some(note));
        }
    }

    /// Which materials a shape has.
    fn used(&self) -> Vec<bool> {
        self.scene.used_materials()
    }

    /// The materials that shapes have and that fit, with their tables.
    fn used_materials(&self, fits: impl Fn(&Material) -> bool) -> Vec<(String, &'a Material)> {
        let used = self.used();
        let materials = self.scene.materials.iter().zip(used);
        materials
            .filter(|(material, used)| *used && fits(material))
            .map(|(material, _)| (format!("materials.{}", material.name), material))
            .collect()
    }

    fn unused(&mut self) {
        let materials = self.scene.materials.iter().zip(self.used());
        let unused = materials.filter(|(_, used)| !used);
        for (material, _) in unused.take(MOST_ALIKE) {
            let message = format!("no shape has the material `{}`", short(&material.name));
            self.warn(format!("materials.{}", material.name), message, None);
        }
    }

    /// A channel that surfaces reflect wholly, in a scene that light cannot leave: it never fades,
    /// so that the picture depends on `max_bounces`.
    fn closed(&mut self) {
        let perfect = self.used_materials(|material| material.albedo.max_element() >= 1.0);
        if perfect.is_empty() || !self.scene.seems_closed() {
            return;
        }
        for (table, material) in perfect.into_iter().take(MOST_ALIKE) {
            let message = format!(
                "`{}` reflects all light (albedo 1) and the scene seems closed",
                short(&material.name)
            );
            let note = "no ray from the camera leaves it, so light fades at other surfaces only and the picture may depend on `render.max_bounces`";
            self.warn(table, message, Some(note));
        }
    }

    /// Thresholds under which compensated survival has no finite variance, or loses light.
    fn survival(&mut self) {
        for material in self.scene.unbounded() {
            let name = short(&self.scene.materials[material.number].name);
            let (message, note) = material.words(&name, self.scene);
            self.found.push(Warning {
                table: format!("materials.{}", self.scene.materials[material.number].name),
                message,
                note: Some(note.into()),
            });
        }
    }

    /// Knobs that another scattering than the material's has.
    fn idle_knobs(&mut self) {
        let idle = |material: &Material| -> Option<(&'static str, Scatter)> {
            let knobs = [
                ("materials.*.spread", material.spread, Scatter::Directional),
                ("materials.*.roughness", material.roughness, Scatter::Rough),
                ("materials.*.index", material.index, Scatter::Glass),
            ];
            let set = |(path, value, scatter): (&'static str, f64, Scatter)| {
                let usual = find(path)?.knob.default()?.number();
                (material.scatter != scatter && value != usual).then_some((path, scatter))
            };
            knobs.into_iter().find_map(set)
        };
        let materials = self.scene.materials.iter();
        let found = materials.filter_map(|material| Some((material, idle(material)?)));
        for (material, (path, scatter)) in found.take(MOST_ALIKE) {
            let key = path.rsplit('.').next().unwrap_or(path);
            let (name, own) = (short(&material.name), material.scatter);
            let message = format!("`{name}` is {own}, and `{key}` is for {scatter} surfaces alone");
            let table = format!("materials.{}", material.name);
            self.warn(table, message, Some("it changes nothing here"));
        }
    }

    fn one_sample(&mut self) {
        if self.scene.settings.render.samples == 1 {
            let note = "standard errors need at least 2";
            self.warn(
                "render",
                "one path a pixel tells nothing of the noise".into(),
                Some(note),
            );
        }
    }
}

/// One of `FEELERS` directions spread over the sphere along a spiral of golden angles.
fn spiral(number: usize) -> DVec3 {
    let golden = std::f64::consts::PI * (3.0 - 5.0_f64.sqrt());
    let height = 1.0 - (2 * number + 1) as f64 / FEELERS as f64;
    let radius = (1.0 - height * height).sqrt();
    let (sine, cosine) = (golden * number as f64).sin_cos();
    DVec3::new(radius * cosine, height, radius * sine)
}
