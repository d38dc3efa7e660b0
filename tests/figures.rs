//! What `lampray figures` shows: plots, pages, and the files of a folder.

#[path = "figures/sample.rs"]
mod sample;
#[path = "figures/sample_pictures.rs"]
mod sample_pictures;
#[path = "figures/written.rs"]
mod written;
