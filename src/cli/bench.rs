use super::progress::Bar;
use super::signal::Watch;
use super::sweep::remark;
use super::sweep::words::spelled;
use super::{Output, print};
use crate::bench::{
    Against, Order, Report, Status, Step, Subject, benches, kernels, presets, room_text, run, table,
};
use crate::error::{Error, Result};
use crate::scene::Assignment;
use crate::shader::Library;
use clap::Args;
use std::ops::ControlFlow;
use std::path::PathBuf;

/// Measure rays and paths a second on this device, by scene and primitive count
///
/// Scenes are scenes/cornell.toml, which is in the program, and rooms like it of N small spheres, which are
/// the same on every machine. Devices, presets and kernels of one scene are measured in turns (A B C, then
/// C B A), by pictures of one size on each device; the first turn is thrown away, and the ratios printed
/// are medians of each turn's own ratio. Machines are shared and clocks move: believe ratios inside a run
/// rather than times.
///
/// Columns: Mrays/s and Msamples/s of tracing (shadow rays are rays, samples are paths); pack is from the
/// scene to flat buffers, trees included; compile is pipeline creation, upload and first dispatch on a
/// freshly opened device (drivers keep what they compiled: JSON has the first time of all as
/// first_compile); outside is the share of a render that is set-up, copying results back and adding them
/// up (no files are written); memory is what this process held at most (Linux). A scene that a device
/// cannot trace is said so.
#[derive(Args)]
#[command(after_help = "Examples:
  lampray bench                                          # a minute; several where scenes are slow
  lampray bench --quick --device all                     # every device here, and their ratios
  lampray bench --primitives cornell,1k,100k --preset reference,paper --device cpu
  lampray bench scenes/many-lamps.toml --set light.strategy=sample --seconds 3
  lampray bench --json > before.json                     # then, after a change:
  lampray bench --against before.json
  lampray bench --device cpu --device cpu --quick        # what noise does to ratios here
  lampray bench --print-room 1k > room.toml              # one of the rooms, for render")]
pub(crate) struct Command {
    /// Scene files to measure instead of the rooms
    #[arg(value_name = "SCENE")]
    scenes: Vec<PathBuf>,
    /// Rooms of so many spheres, and cornell
    /// [default: cornell,8,32,128,1k,10k,100k,1M; of --quick: cornell,8,128,1k]
    #[arg(long, value_name = "LIST", value_delimiter = ',')]
    primitives: Vec<String>,
    /// auto, cpu, gpu, software, a number or part of a name from `lampray devices`, or pci:ADDRESS;
    /// all for each that is here; may be given several times [default: auto]
    #[arg(long, value_name = "WHICH")]
    device: Vec<String>,
    /// Presets, or all [default: reference]
    #[arg(long, value_name = "LIST", value_delimiter = ',')]
    preset: Vec<String>,
    /// Kernels by the knob render.kernel, where this build has it, or all [default: the renderer's choice]
    #[arg(long, value_name = "LIST", value_delimiter = ',')]
    kernel: Vec<String>,
    /// Set a knob over what the scenes say; may be given many times
    #[arg(long = "set", value_name = "PATH=VALUE")]
    set: Vec<String>,
    /// Measurements of each row, beside the first [default: 5; of --quick: 3]
    #[arg(long, value_name = "K", value_parser = clap::value_parser!(u32).range(1..=1000))]
    repeats: Option<u32>,
    /// About how long each measurement takes [default: 1; of --quick: 0.2]
    #[arg(long, value_name = "S")]
    seconds: Option<f64>,
    /// Few scenes, short measurements
    #[arg(long)]
    quick: bool,
    /// What --json printed earlier: the shaders of that build are measured too, in turns with this
    /// one's and by this program's host; ratios of the times then and now are added, which are not paired
    #[arg(long, value_name = "FILE")]
    against: Option<PathBuf>,
    /// Print the room of N spheres as a scene file, and measure nothing
    #[arg(long, value_name = "N", conflicts_with_all = ["against", "json"])]
    print_room: Option<String>,
}

impl Command {
    pub(crate) fn run(self, output: Output) -> Result<()> {
        if let Some(text) = &self.print_room {
            return match Subject::parse(text)? {
                Subject::Room(spheres) => print(&room_text(spheres)?),
                _ => Err(Error::Usage(format!(
                    "--print-room {text}: give a number of spheres"
                ))),
            };
        }
        let signals = Watch::new();
        let before = self.against.as_deref().map(Report::read).transpose()?;
        let then = before.as_ref().and_then(|report| report.shaders.clone());
        let then = then.filter(|shaders| !shaders.is_own());
        let order = self.order(then)?;
        for device in &order.devices {
            if let Some(text) = &device.remark {
                remark(&format!("lampray: {text}"), output);
            }
        }
        let bar = Bar::new(output);
        let ran = run(&order, &mut |step| {
            bar.show(step.share, describe(step), step.left.map(spelled));
            match signals.stopped() {
                true => ControlFlow::Break(()),
                false => ControlFlow::Continue(()),
            }
        });
        bar.clear();
        let (mut report, outcome) = ran?;
        if let (Some(before), Some(file)) = (&before, &self.against) {
            report.against = Some(Against::new(&report, before, &file.to_string_lossy()));
        }
        print(&match output.json {
            true => report.to_json() + "\n",
            false => table(&report),
        })?;
        outcome?;
        something(&report)
    }

    /// `then`: other shaders, to be measured beside this program's.
    fn order(&self, then: Option<Library>) -> Result<Order> {
        let or = |given: &[String], default: &[&str]| match given {
            [] => default.iter().map(|name| String::from(*name)).collect(),
            given => given.to_vec(),
        };
        let set = self.set.iter().map(|text| Assignment::parse(text));
        Ok(Order {
            subjects: self.subjects()?,
            presets: presets(&or(&self.preset, &["reference"]))?,
            kernels: kernels(&self.kernel)?,
            then,
            assignments: set.collect::<Result<_>>()?,
            repeats: self.repeats.unwrap_or(if self.quick { 3 } else { 5 }),
            seconds: self.duration()?,
            devices: benches(&or(&self.device, &["auto"]))?,
        })
    }

    fn subjects(&self) -> Result<Vec<Subject>> {
        let default = match self.quick {
            true => "cornell,8,128,1k",
            false => "cornell,8,32,128,1k,10k,100k,1M",
        };
        let mut subjects: Vec<Subject> = Vec::new();
        for file in &self.scenes {
            subjects.push(Subject::read(file)?);
        }
        let rooms = match (self.primitives.as_slice(), self.scenes.as_slice()) {
            ([], []) => default.split(',').map(Subject::parse).collect(),
            (given, _) => given
                .iter()
                .map(|text| Subject::parse(text))
                .collect::<Result<Vec<_>>>(),
        };
        subjects.extend(rooms?);
        Ok(subjects)
    }

    fn duration(&self) -> Result<f64> {
        let seconds = self.seconds.unwrap_or(if self.quick { 0.2 } else { 1.0 });
        if seconds > 0.0 && seconds <= 3600.0 {
            return Ok(seconds);
        }
        Err(Error::Usage(format!(
            "--seconds {seconds}: give seconds above 0, at most 3600"
        )))
    }
}

/// Without device and preset: those change several times a turn, and not everybody has a bar.
fn describe(step: &Step) -> String {
    match step.turn {
        0 => format!("{}: finding how much work it is", step.scene),
        turn => format!("{}: turn {turn}/{}", step.scene, step.turns),
    }
}

/// A run that measured nothing because no device can is a failure.
fn something(report: &Report) -> Result<()> {
    let refused = |status| report.rows.iter().all(|row| row.status == status);
    match refused(Status::Refused) {
        true => Err(Error::Device(
            "none of these scenes can be traced by the device that was chosen; `lampray devices` lists others".into(),
        )),
        false => Ok(()),
    }
}
