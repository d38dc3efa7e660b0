use super::options::refuse_mixed;
use super::{Output, Result};
use crate::error::Error;
use crate::film::{Record, Target, merge, name_outputs};
use crate::wording::{all_named, counted_as};
use clap::Args;
use std::io::{self, Write};
use std::path::{Path, PathBuf};

/// Add EXR pictures that hold different samples of one render
///
/// Refuses pictures whose scene, shaders, size, crop or knobs differ, but for render.samples, and
/// samples that are in two of them. The result does not depend on the order of the inputs.
#[derive(Args)]
#[command(after_help = "Example:
  lampray render scene.toml --sample-range 0..64 -o a.exr
  lampray render scene.toml --sample-range 64..128 -o b.exr
  lampray merge a.exr b.exr -o c.exr -o c.png")]
pub(crate) struct Command {
    /// EXR files that lampray wrote, two or more
    #[arg(required = true, num_args = 1.., value_name = "EXR")]
    inputs: Vec<PathBuf>,
    /// Where to write the sum; .png or .exr, may be given several times
    #[arg(short, long = "output", required = true, value_name = "FILE")]
    outputs: Vec<PathBuf>,
    /// Merge pictures from different devices too
    #[arg(long)]
    allow_mixed: bool,
}

impl Command {
    pub(crate) fn run(self, output: Output) -> Result<()> {
        if self.inputs.len() < 2 {
            return Err(Error::Usage("merge needs at least two pictures".into()));
        }
        refuse_mixed(&self.outputs, output)?;
        let targets = Target::prepare_all(&self.outputs)?;
        let mut picture = merge(&self.inputs, self.allow_mixed)?;
        name_outputs(&mut picture.record, &targets);
        for target in targets {
            target.write(&picture)?;
        }
        if !output.quiet {
            report(&picture.record, self.inputs.len());
        }
        if output.json {
            print(&picture.record)?;
        }
        Ok(())
    }
}

/// One line for people. Nobody may be reading it, which is no fault.
fn report(record: &Record, inputs: usize) {
    let [first, end] = record.sample_range;
    let gaps = if record.sample_ranges.is_empty() {
        ""
    } else {
        ", with gaps"
    };
    let _ = writeln!(
        io::stderr(),
        "merged {inputs} pictures: {} ({first}..{end}{gaps}), written to {}",
        counted_as(record.samples, "sample a pixel", "samples a pixel"),
        all_named(&record.outputs)
    );
}

fn print(record: &Record) -> Result<()> {
    let mut stdout = io::stdout().lock();
    match writeln!(stdout, "{}", record.to_json()).and_then(|()| stdout.flush()) {
        // The reader has seen enough.
        Err(error) if error.kind() == io::ErrorKind::BrokenPipe => Ok(()),
        Err(source) => Err(Error::Write {
            path: Path::new("standard output").into(),
            source,
        }),
        Ok(()) => Ok(()),
    }
}
