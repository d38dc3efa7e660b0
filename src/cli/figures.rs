use super::options::DeviceOptions;
use super::progress::Bar;
use super::signal::Watch;
use super::sweep::remark;
use super::sweep::words::{describe, spelled};
use super::{Output, print};
use crate::error::{Error, Result};
use crate::figures::{self, About, Data, Effort, Figure, NUMBERS, files};
use crate::reproduce::{Order, Outcome, reproduce};
use crate::wording::{counted, named, were_there};
use clap::Args;
use serde_json::json;
use std::ops::ControlFlow;
use std::path::PathBuf;
use std::time::Instant;

/// Measure the paper's figures 5 to 9, as published and corrected
///
/// Renders the sweeps that they are made of, as far as they are not there yet, then draws them: index.html (one
/// file, works offline), claims.md, every plot as SVG, pictures as PNG, the numbers as CSV and
/// figures.json. DIR/data keeps the sweeps, each with its own runs.jsonl, table.csv and report.html.
/// --quick takes about a minute on two quiet cores, all of it under ten.
#[derive(Args)]
#[command(after_help = "Examples:
  lampray figures --quick
  lampray figures -o paper --only 7,8
  lampray figures -o paper --draw-only     # draws again what was rendered before")]
pub(crate) struct Command {
    /// The folder; made where it is not there
    #[arg(short, long = "output", value_name = "DIR", default_value = "figures")]
    output: PathBuf,
    /// Small pictures and few seeds: every claim is told, with wider intervals
    #[arg(long, conflicts_with = "draw_only")]
    quick: bool,
    /// Render some of the figures 5 to 9; those that are there already stay on the page
    #[arg(long, conflicts_with = "draw_only", value_name = "N,...", value_delimiter = ',', value_parser = clap::value_parser!(u32).range(5..=9))]
    only: Vec<u32>,
    /// Draw all that was rendered into the folder before, and render nothing
    #[arg(long)]
    draw_only: bool,
    #[command(flatten)]
    device: DeviceOptions,
}

impl Command {
    pub(crate) fn run(self, output: Output) -> Result<()> {
        let started = Instant::now();
        let numbers = self.numbers();
        let effort = if self.quick {
            Effort::Quick
        } else {
            Effort::Full
        };
        let order = Order {
            folder: &self.output,
            effort,
            figures: &numbers,
        };
        let outcome = match self.draw_only {
            true => Outcome::default(),
            false => self.render(order, output)?,
        };
        for fault in &outcome.damaged {
            remark(&format!("lampray: {fault}; the run is made again"), output);
        }
        if outcome.stopped {
            remark(
                "lampray: stopped early; the same command goes on with it",
                output,
            );
            return Ok(());
        }
        if outcome.failed > 0 {
            return Err(Error::Runs(outcome.failed));
        }
        let data = Data::read(&self.output)?;
        for number in &data.old {
            remark(
                &format!(
                    "lampray: figure {number} was rendered by another version and is left out; without --only it is rendered again"
                ),
                output,
            );
        }
        let drawn = data
            .made
            .0
            .keys()
            .map(|number| figures::figure(&data, *number));
        let drawn: Vec<Figure> = drawn.collect::<Result<_>>()?;
        let about = About::new(&data, &self.output);
        let files = files::write(&self.output, &drawn, &about)?;
        self.conclude(&drawn, &files, outcome, started, output)
    }

    /// Each once, in order.
    fn numbers(&self) -> Vec<u32> {
        let wanted = |number: &u32| self.only.is_empty() || self.only.contains(number);
        NUMBERS.into_iter().filter(wanted).collect()
    }

    fn render(&self, order: Order, output: Output) -> Result<Outcome> {
        let signals = Watch::new();
        let bar = Bar::new(output);
        let mut open = || {
            let chosen = self.device.open()?;
            if let Some(text) = &chosen.remark {
                remark(&format!("lampray: {text}"), output);
            }
            Ok(chosen.device)
        };
        let outcome = reproduce(order, &mut open, &mut |study, progress| {
            let words = format!("{} {}", study.name, describe(&progress));
            bar.show(progress.share, words, progress.left.map(spelled));
            match signals.stopped() {
                true => ControlFlow::Break(()),
                false => ControlFlow::Continue(()),
            }
        });
        bar.clear();
        outcome
    }

    fn conclude(
        &self,
        drawn: &[Figure],
        files: &[String],
        outcome: Outcome,
        started: Instant,
        output: Output,
    ) -> Result<()> {
        if output.json {
            let told = json!({
                "folder": self.output, "made": outcome.made, "found": outcome.found,
                "figures": drawn, "files": files,
            });
            return print(&format!("{told}\n"));
        }
        for figure in drawn {
            let text = format!(
                "Figure {}: {}. {}",
                figure.number,
                figure.verdict.holds.words(),
                figure.verdict.text
            );
            print(&format!("{text}\n"))?;
        }
        let page = self.output.join("index.html");
        remark(
            &format!(
                "{}: {} made, {}; {:.0} s in all",
                named(&page),
                counted(outcome.made, "run"),
                were_there(outcome.found),
                started.elapsed().as_secs_f64()
            ),
            output,
        );
        Ok(())
    }
}
