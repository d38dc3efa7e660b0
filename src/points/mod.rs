//! The sampler under the microscope: draws by the renderer's own functions, as data or as a plot.

mod plot;

use crate::device::Device;
use crate::error::{Error, Result};
use crate::knobs::{Choice, Scatter, nearest, sections};
use crate::pack::{Draw, Packed, PointsJob, words};
use crate::place::Place;
use crate::scene::{Assignment, Scene};
use crate::wording::{counted, named};
use std::fmt::Write as _;
use std::path::{Path, PathBuf};

/// What to draw.
#[derive(Clone, Debug)]
pub enum Kind {
    /// Points of a lamp of radius 1 at the origin, for a receiver on the positive z axis.
    Light {
        /// From the lamp's centre, in lamp radii.
        distance: f64,
        /// Of the line to the lamp's centre against the receiver's normal, degrees.
        incidence: f64,
    },
    /// Directions off a surface whose normal is the z axis.
    Scatter {
        scatter: Scatter,
        /// Radians.
        spread: f64,
        /// GGX alpha.
        roughness: f64,
        /// Refractive index.
        index: f64,
        /// Whether the ray arrives from inside the body.
        inside: bool,
        /// Of the arriving ray against the normal, degrees.
        incidence: f64,
    },
}

/// A call of `lampray points`.
#[derive(Clone, Debug)]
pub struct Request {
    pub kind: Kind,
    pub count: u32,
    /// Sampling knobs and the seed.
    pub knobs: Vec<Assignment>,
}

/// The value of a `--scatter`.
///
/// # Errors
/// [`Error::Usage`] with the nearest name.
pub fn scatter(name: &str) -> Result<Scatter> {
    Scatter::from_name(name).ok_or_else(|| {
        let close = nearest(name, Scatter::NAMES.iter().copied());
        let close = close.map_or(String::new(), |close| format!("; did you mean {close}?"));
        Error::Usage(format!(
            "--scatter {name}: must be one of {}{close}",
            Scatter::NAMES.join(", ")
        ))
    })
}

/// Draws, with what they are called.
#[derive(Clone, Debug)]
pub struct Cloud {
    pub title: String,
    pub draws: Vec<Draw>,
    /// Whether these are directions off a surface.
    pub scattering: bool,
    /// Whether that is one of glass: then those that go below it are refracted, not lost.
    pub glass: bool,
}

/// A scene of one lamp and one surface, so that the knobs have something to be read from.
const SCENE: &str = "version = 1
[camera]
position = [0, 0, 0]
look_at = [0, 0, 1]
[image]
width = 1
height = 1
[materials.lamp]
emission = [1, 1, 1]
[[spheres]]
center = [0, 0, 0]
radius = 1
material = \"lamp\"
";

/// Draws on a device.
///
/// # Errors
/// [`Error::Knob`] for the request's knobs, and the device's own.
pub fn draw(device: &mut dyn Device, request: &Request) -> Result<Cloud> {
    let scene = scene_of(request)?;
    let packed = Packed::new(&scene);
    let job = job_of(&packed, request);
    let title = match &request.kind {
        Kind::Light { distance, .. } => {
            format!(
                "light.sampler = {}, receiver at {distance} radii",
                scene.settings.light.sampler
            )
        }
        Kind::Scatter {
            scatter,
            spread,
            roughness,
            index,
            inside,
            incidence,
        } => match scatter {
            Scatter::Diffuse => format!(
                "diffuse, scatter.diffuse = {}",
                scene.settings.scatter.diffuse
            ),
            Scatter::Directional => format!(
                "directional, spread {spread}, incidence {incidence} degrees, scatter.bound = {}",
                scene.settings.scatter.bound
            ),
            Scatter::Mirror => format!("mirror, incidence {incidence} degrees"),
            Scatter::Rough => {
                format!("rough, roughness {roughness}, incidence {incidence} degrees")
            }
            Scatter::Glass => {
                let side = if *inside { "inside" } else { "outside" };
                format!("glass, index {index}, incidence {incidence} degrees from {side}")
            }
        },
    };
    let draws = device.points(&packed.strategy, &job)?;
    Ok(Cloud {
        title,
        draws,
        scattering: job.scattering == 1,
        glass: matches!(
            request.kind,
            Kind::Scatter {
                scatter: Scatter::Glass,
                ..
            }
        ),
    })
}

/// Knobs that draws depend on: tables whose values have a part in them.
const TABLES: [&str; 3] = ["light", "scatter", "render"];

/// Refuses values of a scene, which draws have none of.
fn refuse_scene(knobs: &[Assignment]) -> Result<()> {
    let table = |knob: &Assignment| knob.path.split('.').next().unwrap_or_default().to_owned();
    let of_scene = |knob: &&Assignment| {
        let known = sections().contains(&table(knob).as_str());
        known && !TABLES.contains(&table(knob).as_str())
    };
    match knobs.iter().find(of_scene) {
        None => Ok(()),
        Some(knob) => Err(Error::Knob(format!(
            "{}: draws have no scene, and {}.* changes nothing of them; set light.*, scatter.* and render.seed, and the surface by --scatter, --spread, --roughness, --index",
            knob.flag,
            table(knob)
        ))),
    }
}

/// The built-in scene with the request laid over it.
fn scene_of(request: &Request) -> Result<Scene> {
    refuse_scene(&request.knobs)?;
    let mut knobs = request.knobs.clone();
    if let Kind::Scatter {
        scatter,
        spread,
        roughness,
        index,
        ..
    } = &request.kind
    {
        let set = |key: &str, value: String, flag: &str| {
            let flag = format!("{flag} {value}");
            Assignment::new(format!("materials.lamp.{key}"), value, flag)
        };
        knobs.push(set("scatter", scatter.name().into(), "--scatter"));
        knobs.push(set("spread", format!("{spread:e}"), "--spread"));
        knobs.push(set("roughness", format!("{roughness:e}"), "--roughness"));
        knobs.push(set("index", format!("{index:e}"), "--index"));
    }
    Scene::parse("points", SCENE, &knobs)
}

fn job_of(packed: &Packed, request: &Request) -> PointsJob {
    let (distance, incidence, scattering, inside) = match request.kind {
        Kind::Light {
            distance,
            incidence,
        } => (distance, incidence, 0, distance < 1.0),
        Kind::Scatter {
            incidence, inside, ..
        } => (4.0, incidence, 1, inside),
    };
    let (sine, cosine) = incidence.to_radians().sin_cos();
    // The receiver stands on the z axis and looks down at the lamp.
    let normal = match scattering {
        0 => [sine as f32, 0.0, -cosine as f32],
        _ => [0.0, 0.0, 1.0],
    };
    PointsJob {
        lamp: packed.lamps[0],
        material: packed.materials[0],
        pole: packed.pole,
        receiver: [0.0, 0.0, distance as f32],
        inside: u32::from(inside),
        normal,
        count: request.count,
        incoming: [sine as f32, 0.0, -cosine as f32],
        scattering,
        seed: words(packed.seed),
        first: [0, 0],
    }
}

impl Cloud {
    /// Columns x, y, z, density and counts, one row a draw.
    pub fn to_csv(&self) -> String {
        let mut text = String::from("x,y,z,density,counts\n");
        for draw in &self.draws {
            let [x, y, z] = draw.point;
            let density = if draw.density > 0.0 {
                draw.density.to_string()
            } else {
                String::new()
            };
            // Writing into a string cannot fail.
            let _ = writeln!(text, "{x},{y},{z},{density},{}", draw.useful);
        }
        text
    }

    /// Number and share of draws that count.
    pub fn useful(&self) -> (usize, f64) {
        let useful = self.draws.iter().filter(|draw| draw.useful == 1).count();
        (useful, useful as f64 / self.draws.len() as f64)
    }

    /// Share of draws within 30 degrees of the z axis, on either side.
    pub fn near_poles(&self) -> f64 {
        let cosine = 30f32.to_radians().cos();
        let near = self
            .draws
            .iter()
            .filter(|draw| draw.point[2].abs() >= cosine)
            .count();
        near as f64 / self.draws.len() as f64
    }

    /// One line for people.
    pub fn summary(&self) -> String {
        format!(
            "{}: {}, {}, {}",
            self.title,
            counted(self.draws.len() as u64, "draw"),
            self.share(),
            self.rest(" degrees")
        )
    }

    /// The share of the draws that count, in words.
    fn share(&self) -> String {
        let share = 100.0 * self.useful().1;
        match (self.glass, self.scattering) {
            (true, _) => format!("{share:.1} % are reflected"),
            (false, true) => format!("{share:.1} % leave the surface"),
            (false, false) => format!("{share:.1} % face the receiver"),
        }
    }

    /// What else is to be said of them: where glass refracts to, which is one direction; of others, how many are near
    /// the axis.
    fn rest(&self, degrees: &str) -> String {
        if !self.glass {
            let near = 100.0 * self.near_poles();
            return format!("{near:.1} % within 30{degrees} of the z axis");
        }
        let refracted = self.draws.iter().filter(|draw| draw.useful == 0);
        let count = refracted.clone().count();
        let share = 100.0 * count as f64 / self.draws.len() as f64;
        let angle = |draw: &Draw| draw.point[2].abs().min(1.0).acos().to_degrees();
        match refracted.map(angle).next() {
            Some(angle) => format!(
                "{share:.1} % refracted, to {angle:.1}{degrees} from the axis behind the surface"
            ),
            None => "none refracted".into(),
        }
    }

    /// The summary as JSON, with the draws where no file holds them.
    pub fn to_json(&self, output: &Option<PathBuf>) -> String {
        let (useful, share) = self.useful();
        let mut json = serde_json::json!({
            "title": self.title,
            "count": self.draws.len(),
            "useful": useful,
            "useful_share": share,
            "near_poles_share": self.near_poles(),
            "output": output.as_ref().map(|path| path.to_string_lossy()),
        });
        if output.is_none() {
            let points: Vec<_> = self.draws.iter().map(|draw| draw.point).collect();
            json["points"] = serde_json::json!(points);
        }
        json.to_string()
    }
}

/// The form of a file of draws.
#[derive(Clone, Copy, Debug)]
pub enum Form {
    Csv,
    Png,
    Svg,
}

/// Where draws go.
#[derive(Debug)]
pub enum Sink {
    /// Back to the caller, as CSV.
    Stdout,
    File(Place, Form),
}

impl Sink {
    /// Checks that the output can be written, before anything is drawn.
    ///
    /// # Errors
    /// [`Error::Usage`] for any other extension than csv, png and svg, [`Error::Create`].
    pub fn prepare(path: Option<&Path>) -> Result<Self> {
        let Some(path) = path else {
            return Ok(Self::Stdout);
        };
        let extension = path
            .extension()
            .and_then(|text| text.to_str())
            .unwrap_or_default();
        let form = match extension.to_ascii_lowercase().as_str() {
            "csv" => Form::Csv,
            "png" => Form::Png,
            "svg" => Form::Svg,
            _ => {
                let path = named(path);
                return Err(Error::Usage(format!(
                    "output {path} must end in .csv, .png or .svg"
                )));
            }
        };
        Ok(Self::File(Place::prepare(path)?, form))
    }

    /// Writes the draws; without a file, returns them as CSV.
    ///
    /// # Errors
    /// [`Error::Write`].
    pub fn write(self, cloud: &Cloud) -> Result<Option<String>> {
        let (place, bytes) = match self {
            Self::Stdout => return Ok(Some(cloud.to_csv())),
            Self::File(place, Form::Csv) => (place, cloud.to_csv().into_bytes()),
            Self::File(place, Form::Svg) => (place, plot::svg(cloud).into_bytes()),
            Self::File(place, Form::Png) => (place, plot::png(cloud)?),
        };
        place.write(|sink| sink.write_all(&bytes))?;
        Ok(None)
    }
}
