//! What is printed, written and drawn of a run.

mod gates;
mod html_pages;
mod metrics_file;
mod pictures;
mod sweep_pictures;
mod terminal;
