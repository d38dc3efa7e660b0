use super::{Output, Result};
use clap::Args;

#[derive(Args)]
pub(crate) struct Command {}

impl Command {
    pub(crate) fn run(self, _output: Output) -> Result<()> {
        Ok(())
    }
}
