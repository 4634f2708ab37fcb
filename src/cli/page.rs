//! `mesoscope report`: one page of runs and studies.

use std::io::Cursor;
use std::path::PathBuf;

use mesoscope::output::write_atomically;
use mesoscope::printable;
use mesoscope::report::{self, ReportError};

use super::{Failure, heading, print};

/// Make one page of runs and studies, with pictures inside, to send around
#[derive(Debug, clap::Args)]
#[command(after_help = "\
Examples:
  mesoscope report dpd-fluid
  mesoscope report first second dpd-fluid-sweep --out thesis.html
  mesoscope report dpd-fluid --png                       one sheet as a picture, report.png

The page needs no other file and no script: it opens in every browser, light or dark, and prints. What is missing or damaged in a directory is said in \
its place.")]
pub struct Arguments {
    /// Directories of runs, sweeps, tradeoffs and maps of stability
    #[arg(required = true, value_name = "DIR")]
    directories: Vec<PathBuf>,

    /// The page [default: report.html, or report.png]
    #[arg(long, help_heading = heading::OUTPUT, value_name = "FILE")]
    out: Option<PathBuf>,

    /// Write one sheet as a picture in place of the page, without the scenes
    #[arg(long, help_heading = heading::OUTPUT)]
    png: bool,

    /// Replace a page that is there
    #[arg(long, help_heading = heading::OUTPUT)]
    force: bool,
}

/// Writes the page.
pub fn execute(arguments: &Arguments) -> Result<(), Failure> {
    let is_picture = |path: &PathBuf| path.extension().is_some_and(|end| end.eq_ignore_ascii_case("png"));
    if let Some(out) = arguments.out.as_ref().filter(|out| is_picture(out) != arguments.png) {
        let (shown, accepted) =
            (printable::path(out), if arguments.png { "a name that ends in .png" } else { "--png beside it" });
        return Err(Failure::usage(format!("`--out {shown}`: accepted: {accepted}")));
    }
    let default = || PathBuf::from(if arguments.png { "report.png" } else { "report.html" });
    let out = arguments.out.clone().unwrap_or_else(default);
    let shown = printable::path(&out);
    if out.exists() && !arguments.force {
        let message = format!("`{shown}` exists; give another name with --out, or replace it with --force");
        return Err(Failure::input_output(message));
    }
    let refused = |error: ReportError| Failure::input_output(error.to_string());
    let bytes = if arguments.png {
        let sheet = report::sheet(&arguments.directories).map_err(refused)?;
        let mut bytes = Cursor::new(Vec::new());
        let wrong = |error: image::ImageError| Failure::input_output(format!("cannot write `{shown}`: {error}"));
        sheet.write_to(&mut bytes, image::ImageFormat::Png).map_err(wrong)?;
        bytes.into_inner()
    } else {
        report::page(&arguments.directories).map_err(refused)?.into_bytes()
    };
    write_atomically(&out, |writer| writer.write_all(&bytes))?;
    print(&format!("{shown}: {:.1} MB\n", bytes.len() as f64 / 1e6))
}
