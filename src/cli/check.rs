use super::options::KnobOptions;
use super::{Output, Result, note, print};
use crate::knobs::{Choice, short};
use crate::scene::{Assignment, Finding, Scene};
use crate::wording::{counted, counted_as};
use clap::Args;
use serde_json::{Value, json};
use std::path::{Path, PathBuf};

/// Check a scene without rendering it
///
/// Prints what the scene holds. Errors, all of a file at once, and warnings of what is legal but
/// suspect go to stderr with line, column and remedy.
#[derive(Args)]
#[command(after_help = "Example:\n  lampray check scenes/cornell.toml --set render.preset=paper")]
pub(crate) struct Command {
    /// Scene file (TOML)
    scene: PathBuf,
    #[command(flatten)]
    knobs: KnobOptions,
}

impl Command {
    pub(crate) fn run(self, output: Output) -> Result<()> {
        let assignments = self.knobs.assignments()?;
        let scene = match load(&self.scene, &assignments) {
            Ok(scene) => scene,
            Err((error, findings)) => {
                if output.json {
                    print(&failed(&self.scene, &error, &findings))?;
                }
                return Err(error);
            }
        };
        let warnings = scene.warnings();
        if !output.quiet {
            for warning in &warnings {
                note(&warning.text);
            }
            for line in scene.notes() {
                note(&format!("note: {line}"));
            }
        }
        print(&if output.json {
            passed(&scene, &warnings)
        } else {
            summary(&scene, warnings.len())
        })
    }
}

/// The scene, or the error with its parts where it has some.
fn load(
    path: &Path,
    assignments: &[Assignment],
) -> std::result::Result<Scene, (crate::Error, Vec<Finding>)> {
    let text = Scene::read_text(path).map_err(|error| (error, Vec::new()))?;
    Scene::inspect(&path.to_string_lossy(), &text, assignments).map_err(|mistakes| {
        let findings = mistakes.findings.clone();
        (mistakes.into(), findings)
    })
}

fn failed(scene: &Path, error: &crate::Error, findings: &[Finding]) -> String {
    let errors: Vec<Value> = if findings.is_empty() {
        vec![json!({ "message": error.to_string() })]
    } else {
        findings.iter().map(Finding::to_json).collect()
    };
    let answer = json!({
        "scene": scene.to_string_lossy(),
        "ok": false,
        "errors": errors,
        "warnings": [],
        "notes": [],
    });
    format!("{answer:#}\n")
}

fn passed(scene: &Scene, warnings: &[Finding]) -> String {
    let warnings: Vec<_> = warnings.iter().map(Finding::to_json).collect();
    let answer = json!({
        "scene": scene.source.name,
        "ok": true,
        "errors": [],
        "warnings": warnings,
        "notes": scene.notes(),
        "width": scene.settings.image.width,
        "height": scene.settings.image.height,
        "samples": scene.settings.render.samples,
        "max_bounces": scene.settings.render.max_bounces,
        "materials": scene.materials.len(),
        "spheres": scene.spheres.len(),
        "boxes": scene.boxes.len(),
        "lamps": scene.lamps().count(),
        "preset": scene.settings.preset.name(),
        "biased": scene.biased(),
        "biases": scene.biases(),
        "knobs": scene.knobs,
    });
    format!("{answer:#}\n")
}

fn summary(scene: &Scene, warnings: usize) -> String {
    let settings = &scene.settings;
    let biased = match scene.biases().as_slice() {
        [] => "unbiased".into(),
        causes => format!("biased by {}", causes.join(", ")),
    };
    let warned = match warnings {
        0 => String::new(),
        count => format!(", {}", counted(count, "warning")),
    };
    format!(
        "{}: ok{warned}\n  picture  {} x {} pixels, {}, {}\n  scene    {}, {}, {}, {}\n  preset   {}, {biased}\n",
        short(&scene.source.name),
        settings.image.width,
        settings.image.height,
        counted_as(settings.render.samples, "path a pixel", "paths a pixel"),
        counted(settings.render.max_bounces, "bounce"),
        counted(scene.spheres.len(), "sphere"),
        counted_as(scene.boxes.len(), "box", "boxes"),
        counted(scene.lamps().count(), "lamp"),
        counted(scene.materials.len(), "material"),
        settings.preset,
    )
}
