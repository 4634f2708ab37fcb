//! `mesoscope stability`: how far a scene may go.

use std::io::IsTerminal as _;
use std::path::PathBuf;

use indicatif::ProgressBar;
use mesoscope::numbers::short;
use mesoscope::printable;
use mesoscope::stability::{Cell, Request, StabilityError, StabilityEvent, StabilityOutcome, StabilityRun, Verdict};
use mesoscope::tradeoff::{References, error_in_words};

use super::report::{self, duration};
use super::table::aligned;
use super::{Failure, RunArguments, line, print, progress};

/// Map where a scene is right, biased or unstable, and locate the edges
#[derive(Debug, clap::Args)]
#[command(after_help = "\
Examples:
  mesoscope stability my-scene.json                      how far can I go with its time step?
  mesoscope stability dpd-fluid --vary temperature=0.5..2/3 --vary time.step=0.01..0.2/9
  mesoscope stability dpd-fluid --vary interactions.0.friction=1..100/5
  mesoscope stability polymer-melt --set time.steps=2000 --tolerance 2%
  mesoscope stability --resume dpd-fluid-stability       go on with one that was interrupted

All runs cover the simulated time of the scene (--set time.steps=N shortens it), with 256 steps at least. They write no files of
their own. Right is what a law says - the temperature of the bath, an energy that does not drift - or a --reference.")]
pub struct Arguments {
    /// A scene file, or the name of a built-in scene (see `mesoscope scenes`)
    #[arg(required_unless_present = "resume")]
    scene: Option<String>,

    /// A key of the scene with a range, `time.step=0.01..0.2/9` (nine values, equal ratios; `:linear` after it for equal
    /// differences), or with values; once for a row, twice for a map [default: time.step from a quarter to 16 times]
    #[arg(long, value_name = "PATH=LOW..HIGH/POINTS", allow_hyphen_values = true)]
    vary: Vec<String>,

    /// Change one value in all runs, as for `mesoscope run`; may be repeated
    #[arg(long, value_name = "PATH=VALUE")]
    set: Vec<String>,

    /// The largest error of what is right, as a part of one or in per cent
    #[arg(long, value_name = "PART", value_parser = super::tradeoff::part, default_value = "5%")]
    tolerance: f64,

    /// What a measure should be, as in `pressure=23.635` or `pressure=23.635+-0.005`; may be repeated
    #[arg(long, value_name = "MEASURE=VALUE")]
    reference: Vec<String>,

    /// Measures to compare [default: both temperatures, or the drift of the energy, where a law says what they should be]
    #[arg(long, value_name = "MEASURE,…", value_delimiter = ',')]
    measure: Vec<String>,

    /// How often the distance of neighbours in a row is halved to locate an edge
    #[arg(long, value_name = "N", default_value_t = 3, value_parser = clap::value_parser!(u32).range(0..=20))]
    bisections: u32,

    /// Runs at once [default: 2 of a small scene on a software adapter, else 1]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..))]
    jobs: Option<u16>,

    /// Run even if it takes more than eight hours
    #[arg(long)]
    yes: bool,

    /// Directory for the map [default: the scene's name and `-stability`, in the working directory]
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,

    /// Go on with the map in this directory
    #[arg(long, value_name = "DIR", conflicts_with_all =
        ["scene", "vary", "set", "tolerance", "reference", "measure", "bisections", "out", "force"])]
    resume: Option<PathBuf>,

    #[command(flatten)]
    how: RunArguments,
}

/// Makes the map.
pub fn execute(arguments: &Arguments) -> Result<(), Failure> {
    let (run, directory) = if let Some(directory) = &arguments.resume {
        (StabilityRun::resume(directory)?, directory.clone())
    } else {
        let scene = arguments.scene.as_deref().unwrap_or_default();
        let references =
            References::parse(&arguments.reference).map_err(|mistakes| StabilityError::Arguments { mistakes })?;
        let request = Request::load(scene, &arguments.set, &arguments.vary)?
            .with_tolerance(arguments.tolerance)?
            .with_bisections(arguments.bisections)
            .with_measures(&arguments.measure, references)?;
        let directory = arguments.out.clone().unwrap_or_else(|| format!("{}-stability", report::stem(scene)).into());
        (StabilityRun::start(request, &directory, arguments.how.force), directory)
    };
    let run = run.unless_long(arguments.yes).until(&super::interruption::interrupt());
    let mut reporter = Reporter::new(run.request().title(), arguments.how.quiet);
    let jobs = arguments.jobs.map(usize::from);
    let executed = run.execute(&arguments.how.adapter.choice(), jobs, &mut |event| reporter.show(event));
    reporter.clear();
    let outcome = executed?;
    if arguments.how.quiet { Ok(()) } else { print(&results(&outcome, &printable::path(&directory))) }
}

/// Shows how far a map is: a bar on a terminal, else a line for every run.
struct Reporter {
    title: String,
    quiet: bool,
    bar: Option<ProgressBar>,
    runs: u64,
    ended: u64,
}

impl Reporter {
    fn new(title: &str, quiet: bool) -> Self {
        Self { title: printable::name(title).into_owned(), quiet, bar: None, runs: 0, ended: 0 }
    }

    fn clear(&mut self) {
        if let Some(bar) = self.bar.take() {
            bar.finish_and_clear();
        }
    }

    fn say(&self, text: &str) {
        match &self.bar {
            Some(bar) => bar.suspend(|| line(text)),
            None => line(text),
        }
    }

    fn expect(&mut self, more: usize) {
        self.runs += more as u64;
        if let Some(bar) = &self.bar {
            bar.set_length(self.runs.max(1));
        }
    }

    fn show(&mut self, event: StabilityEvent<'_>) {
        if self.quiet {
            return;
        }
        match event {
            StabilityEvent::Started { adapter, waiting, jobs, seconds } => {
                let expected = seconds
                    .map_or_else(String::new, |seconds| format!(", at most {}", duration(seconds.ceil() as u64)));
                let at_once = if jobs > 1 { format!(", {jobs} at once") } else { String::new() };
                // A closed standard output will be noticed when the results are printed.
                let _ = print(&format!(
                    "{}: {waiting} runs on {}{at_once}{expected}, then the edges\n",
                    self.title, adapter.name
                ));
                if std::io::stderr().is_terminal() {
                    self.bar = Some(progress::bar(0, "{wide_bar} {pos} of {len} runs"));
                }
                self.expect(waiting);
            }
            StabilityEvent::Ended { row, cell } => {
                self.ended += 1;
                match &self.bar {
                    Some(bar) => bar.set_position(self.ended),
                    None => self.say(&format!("{} of {}  {}", self.ended, self.runs, in_words(row, cell))),
                }
            }
            StabilityEvent::Bisecting { scenes } => {
                self.expect(scenes);
                self.say(&format!("{scenes} more to locate edges"));
            }
            _ => {}
        }
    }
}

/// What became of a scene.
fn in_words(row: &str, cell: &Cell) -> String {
    let row = if row.is_empty() { String::new() } else { format!("{row}, ") };
    let what = match cell.verdict {
        Verdict::Right | Verdict::Biased if cell.reason.is_none() => {
            let errors = cell
                .errors
                .iter()
                .map(|error| format!("{} {}", error.measure.replace('_', " "), error_in_words(error)));
            errors.collect::<Vec<_>>().join(", ")
        }
        _ => cell.reason.as_deref().and_then(|reason| reason.lines().next()).unwrap_or_default().to_owned(),
    };
    let end = if what.is_empty() { String::new() } else { format!(": {what}") };
    format!("{row}{}  {}{end}", short(cell.value), cell.verdict.name())
}

/// The table at the end, and the files written.
fn results(outcome: &StabilityOutcome, directory: &str) -> String {
    let summary = &outcome.summary;
    let header =
        ["ROW".to_owned(), format!("RIGHT: {} UP TO", summary.key), "UNSTABLE FROM".to_owned(), "LAWS".to_owned()];
    let mut rows = vec![header.to_vec()];
    rows.extend(summary.in_words().into_iter().map(|words| words.to_vec()));
    let mut text = aligned(&rows, "  ");
    text.extend(summary.findings().iter().map(|finding| format!("note: {finding}\n")));
    format!("{text}wrote {directory}/: {}\n", outcome.files.join(", "))
}

impl From<StabilityError> for Failure {
    fn from(error: StabilityError) -> Self {
        match error {
            StabilityError::Scene(error) => error.into(),
            StabilityError::Gpu(error) => error.into(),
            StabilityError::Interrupted { .. } => Self::interrupted(error.to_string()),
            StabilityError::Arguments { .. } | StabilityError::Long { .. } => Self::usage(error.to_string()),
            StabilityError::Run { ref source, .. } => Self::of_run(source, error.to_string()),
            StabilityError::Output(mesoscope::output::OutputError::ResultExists { .. }) => Self::input_output(format!(
                "{error}\nhint: `mesoscope stability --resume DIR` goes on with an interrupted one"
            )),
            _ => Self::input_output(error.to_string()),
        }
    }
}
