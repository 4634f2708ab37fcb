//! One page of runs and studies, to send around: what was simulated, on what, what came out, and how to repeat it.
//!
//! [`page`] reads directories that commands have left and gives a page of HTML that needs nothing else: pictures are inside, and no script is. What is
//! missing or damaged in a directory is said in its place, with what is there.
//!
//! ```
//! use mesoscope::gpu::AdapterChoice;
//! use mesoscope::run::Run;
//!
//! # let place = tempfile::tempdir()?;
//! # let directory = place.path().join("fluid");
//! let small = ["space.box=[4,4,4]", "time.equilibration=0", "time.steps=40", "output={}"].map(str::to_owned);
//! let scene = mesoscope::scene::load("dpd-fluid", &small)?;
//! Run::start(scene, &directory).execute(&AdapterChoice::Best, &mut |_| {})?;
//! let page = mesoscope::report::page(&[directory])?;
//! assert!(page.starts_with("<!DOCTYPE html>") && page.contains("data:image/png;base64,"));
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod entry;
mod run;
mod sheet;
mod study;

use crate::plot::PlotError;
use crate::printable;
use entry::Entry;
use image::RgbImage;
use minijinja::{AutoEscape, Environment, context};
use std::path::{Path, PathBuf};

/// Why there is no page.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum ReportError {
    /// A directory in which no command has left anything.
    #[error(
        "there is nothing to report in `{}`: {reason}; accepted: the directory of a run, a sweep, a tradeoff or a map of stability",
        printable::path(path)
    )]
    Nothing {
        /// The directory.
        path: PathBuf,
        /// The reason, from what was found.
        reason: &'static str,
    },
    /// The sheet cannot be drawn.
    #[error("the sheet cannot be drawn: {0}")]
    Sheet(#[from] PlotError),
    /// The template is wrong, which is a mistake of the program.
    #[error("the page cannot be made: {0}")]
    Template(#[from] minijinja::Error),
}

/// The page of some directories, in their order.
///
/// # Errors
/// [`ReportError::Nothing`] names the first directory without anything to report.
pub fn page(directories: &[PathBuf]) -> Result<String, ReportError> {
    let entries = entries(directories)?;
    let mut environment = Environment::new();
    environment.set_auto_escape_callback(|_| AutoEscape::Html);
    environment.add_template("page", include_str!("../../assets/report/page.html"))?;
    let title = entries.iter().map(|entry| entry.title.as_str()).collect::<Vec<_>>().join(" · ");
    let version = env!("CARGO_PKG_VERSION");
    Ok(environment.get_template("page")?.render(context! { title, version, entries })?)
}

/// The same on one sheet, as a picture: without the scenes, and without a device.
///
/// # Errors
/// [`ReportError::Nothing`] names the first directory without anything to report; [`ReportError::Sheet`].
pub fn sheet(directories: &[PathBuf]) -> Result<RgbImage, ReportError> {
    sheet::sheet(&entries(directories)?)
}

fn entries(directories: &[PathBuf]) -> Result<Vec<Entry>, ReportError> {
    directories.iter().map(|directory| entry(directory)).collect()
}

fn entry(directory: &Path) -> Result<Entry, ReportError> {
    let nothing = |reason| ReportError::Nothing { path: directory.to_path_buf(), reason };
    if !directory.is_dir() {
        return Err(nothing("there is no such directory"));
    }
    match study::entry(directory) {
        Some(entry) => Ok(entry),
        None => run::entry(directory).ok_or_else(|| nothing("none of the files in it is one of a run or a study")),
    }
}
