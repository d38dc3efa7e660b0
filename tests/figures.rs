//! What `lampray figures` shows: plots, pages, and the files of a folder.

#[path = "figures/awkward.rs"]
mod awkward;
#[path = "figures/document.rs"]
mod document;
#[path = "figures/pages.rs"]
mod pages;
#[path = "figures/places.rs"]
mod places;
#[path = "figures/sample.rs"]
mod sample;
#[path = "figures/sample_pictures.rs"]
mod sample_pictures;
#[path = "figures/sample_runs.rs"]
mod sample_runs;
#[path = "figures/written.rs"]
mod written;
