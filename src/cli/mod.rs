//! The command line: one file a command, each a thin face over one library call.

mod bench;
mod check;
mod denoise;
mod devices;
mod diff;
mod doctor;
mod figures;
mod keep;
mod knobs;
mod merge;
mod options;
mod points;
mod progress;
mod render;
mod rerun;
mod run;
mod signal;
mod sweep;

use crate::error::{Error, Result};
use clap::{Args, Parser, Subcommand};
use std::io::{self, IsTerminal, Write};
use std::panic;
use std::process::ExitCode;

/// A headless path tracer for studying how light is sampled.
#[derive(Parser)]
#[command(
    name = "lampray",
    version,
    max_term_width = 100,
    after_help = "Example:\n  lampray render scenes/cornell.toml     writes cornell.png and cornell.exr"
)]
struct Lampray {
    #[command(subcommand)]
    command: Command,
    #[command(flatten)]
    output: Output,
}

/// What every command takes.
#[derive(Args, Clone, Copy)]
pub(crate) struct Output {
    /// Print JSON, and nothing else, on stdout
    #[arg(long, global = true)]
    json: bool,
    /// Say nothing on stderr but errors
    #[arg(short, long, global = true)]
    quiet: bool,
}

#[derive(Subcommand)]
enum Command {
    Render(render::Command),
    Check(check::Command),
    Knobs(knobs::Command),
    Devices(devices::Command),
    Doctor(doctor::Command),
    Points(points::Command),
    Rerun(rerun::Command),
    Merge(merge::Command),
    Diff(Box<diff::Command>),
    Sweep(Box<sweep::Command>),
    Figures(figures::Command),
    Bench(bench::Command),
}

/// Runs the program and says with which code it ends.
pub fn main() -> ExitCode {
    panic::set_hook(Box::new(report_panic));
    signal::survive_file_limits();
    let line = Lampray::parse();
    let diff = matches!(line.command, Command::Diff(_));
    let outcome = panic::catch_unwind(move || run(line));
    match outcome {
        Ok(Ok(code)) => code,
        Ok(Err(error)) => {
            match &error {
                // It is text of many lines already, each mistake with its place.
                Error::Scene(page) => note(page),
                other => note(&format!("lampray: {other}")),
            }
            let trouble = diff.then(|| diff::trouble(&error)).flatten();
            ExitCode::from(trouble.unwrap_or(code(&error)))
        }
        // The hook has said what there is to say.
        Err(_) => ExitCode::from(INTERNAL),
    }
}

fn run(line: Lampray) -> Result<ExitCode> {
    match line.command {
        Command::Diff(command) => return command.run(line.output).map(ExitCode::from),
        Command::Render(command) => command.run(line.output),
        Command::Check(command) => command.run(line.output),
        Command::Knobs(command) => command.run(line.output),
        Command::Devices(command) => command.run(line.output),
        Command::Doctor(command) => command.run(line.output),
        Command::Points(command) => command.run(line.output),
        Command::Rerun(command) => command.run(line.output),
        Command::Merge(command) => command.run(line.output),
        Command::Sweep(command) => command.run(line.output),
        Command::Figures(command) => command.run(line.output),
        Command::Bench(command) => command.run(line.output),
    }?;
    Ok(signal::exit_code())
}

/// One line instead of Rust's own. A panic that is caught and becomes an error is not reported.
fn report_panic(panic: &panic::PanicHookInfo) {
    if crate::panics::catching() {
        return;
    }
    let place = panic
        .location()
        .map_or(String::new(), |place| format!(" at {place}"));
    let payload = panic.payload();
    let text = payload.downcast_ref::<&str>().copied();
    let text = text.or(payload.downcast_ref::<String>().map(String::as_str));
    let cause = text.unwrap_or("unknown cause");
    note(&format!(
        "lampray: {}",
        Error::Internal(format!("{cause}{place}"))
    ));
}

/// Exit code of a fault of lampray's own.
const INTERNAL: u8 = 70;

/// Puts data on stdout. A reader that has gone, such as `head`, is no error.
pub(crate) fn print(text: &str) -> Result<()> {
    let mut stdout = io::stdout().lock();
    let shown = match stdout.is_terminal() {
        true => plain(text),
        false => text.into(),
    };
    let written = stdout
        .write_all(shown.as_bytes())
        .and_then(|()| stdout.flush());
    match written {
        Err(error) if error.kind() != io::ErrorKind::BrokenPipe => Err(Error::Stream {
            path: "standard output".into(),
            source: error,
        }),
        _ => Ok(()),
    }
}

/// Says something on stderr, if anybody listens there.
pub(crate) fn note(text: &str) {
    let _ = writeln!(io::stderr(), "{}", plain(text.trim_end()));
}

/// Text for a terminal: names in files and of drivers may hold codes that move its cursor, or worse.
pub(crate) fn plain(text: &str) -> String {
    let code = |c: char| c.is_control() && !matches!(c, '\n' | '\t');
    text.replace(code, "\u{fffd}")
}

/// The exit code of each kind of error, as the README lists them.
fn code(error: &Error) -> u8 {
    match error {
        Error::Knob(_) | Error::Usage(_) => 2,
        Error::Scene(_) | Error::Data { .. } | Error::TooLarge(_) => 65,
        Error::Input { .. } => 66,
        Error::Device(_) => 69,
        Error::Internal(_) => INTERNAL,
        Error::Create { .. } => 73,
        Error::Write { .. } | Error::Stream { .. } => 74,
        Error::DeviceLost(_) | Error::Unfinished(_) | Error::Runs(_) | Error::References(_) => 75,
    }
}
