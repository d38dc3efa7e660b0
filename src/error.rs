//! Everything that can go wrong, each with its remedy. The command line maps these to exit codes.

use crate::wording::{counted, named};
use std::io;
use std::path::PathBuf;

pub type Result<T> = std::result::Result<T, Error>;

#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// The scene file breaks the rules; the text holds every fault with its place (exit 65).
    #[error("{0}")]
    Scene(String),
    /// A `--set` or its short form names no knob, or a value that the knob cannot take (exit 2).
    #[error("{0}")]
    Knob(String),
    /// Arguments that contradict each other (exit 2).
    #[error("{0}")]
    Usage(String),
    /// An input that is not there or cannot be opened (exit 66).
    #[error("cannot read {}: {source}", named(path))]
    Input { path: PathBuf, source: io::Error },
    /// An input that is there but is not what it should be (exit 65).
    #[error("{}: {reason}", named(path))]
    Data { path: PathBuf, reason: String },
    /// A render that this machine has too little memory for (exit 65).
    #[error("{0}")]
    TooLarge(String),
    /// A render that was stopped before there was anything to write (exit 75: the same command may do better with
    /// more time, and goes on where there is a checkpoint).
    #[error("{0}")]
    Unfinished(String),
    /// No device of the kind that was asked for (exit 69).
    #[error("{0}")]
    Device(String),
    /// The device was lost or did not answer in time; the same call may succeed later (exit 75).
    #[error("{0}; the same command may succeed later, or choose another with --device")]
    DeviceLost(String),
    /// An output that cannot be created; said before anything is rendered (exit 73).
    #[error("cannot create {}: {source}", named(path))]
    Create { path: PathBuf, source: io::Error },
    /// An output that broke off; the old file, if any, is untouched (exit 74).
    #[error(
        "cannot write {}: {source}; the file that was there before, if any, is untouched",
        named(path)
    )]
    Write { path: PathBuf, source: io::Error },
    /// An output that broke off and is no file: a device, a pipe or standard output (exit 74).
    #[error("cannot write to {}: {source}", named(path))]
    Stream { path: PathBuf, source: io::Error },
    /// Runs of a sweep that failed; the ledger holds each with its reason (exit 75:
    /// the same command tries them again).
    #[error("{} failed: runs.jsonl says why; the same command tries again", counted(*.0, "run"))]
    Runs(usize),
    /// References of a sweep that failed, with all runs done (exit 75).
    #[error("{} failed: report.html says why; the same command tries again", counted(*.0, "reference"))]
    References(usize),
    /// A fault of lampray itself (exit 70).
    #[error(
        "internal error: {0}. This is a fault of lampray: please report it with the command and the scene"
    )]
    Internal(String),
}
