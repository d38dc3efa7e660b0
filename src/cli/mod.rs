//! The command line: one file a command, each a thin face over one library call.

mod check;
mod knobs;
mod merge;

use crate::error::{Error, Result};
use clap::{Args, Parser, Subcommand};
use std::process::ExitCode;

/// A headless path tracer for studying how light is sampled.
#[derive(Parser)]
#[command(name = "lampray", version, max_term_width = 100)]
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
    Check(check::Command),
    Knobs(knobs::Command),
    Merge(merge::Command),
}

/// Runs the program and says with which code it ends.
pub fn main() -> ExitCode {
    let line = Lampray::parse();
    let outcome = match line.command {
        Command::Check(command) => command.run(line.output),
        Command::Knobs(command) => command.run(line.output),
        Command::Merge(command) => command.run(line.output),
    };
    match outcome {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("lampray: {error}");
            ExitCode::from(code(&error))
        }
    }
}

/// The exit code of each kind of error, as the README lists them.
fn code(error: &Error) -> u8 {
    match error {
        Error::Knob(_) | Error::Usage(_) => 2,
        Error::Scene(_) | Error::Data { .. } => 65,
        Error::Input { .. } => 66,
        Error::Device(_) => 69,
        Error::Internal(_) => 70,
        Error::Create { .. } => 73,
        Error::Write { .. } => 74,
        Error::DeviceLost(_) => 75,
    }
}
