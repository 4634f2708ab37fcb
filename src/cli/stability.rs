//! `mesoscope stability`: how far a scene may go.

use mesoscope::printable;
use mesoscope::stability::{Request, StabilityRun, StabilitySummary};
use mesoscope::study::{StudyError, StudyOutcome};
use mesoscope::tradeoff::References;

use super::table::aligned;
use super::{ComparisonArguments, Failure, StudyArguments, heading, print};

/// Map where a scene is right, biased or unstable, and locate the edges
#[derive(Debug, clap::Args)]
#[command(after_help = "\
Examples:
  mesoscope stability my-scene.json                      how far can I go with its time step?
  mesoscope stability dpd-fluid --vary temperature=0.5..2/3 --vary time.step=0.01..0.2/9
  mesoscope stability dpd-fluid --vary interactions.0.friction=1..100/5
  mesoscope stability polymer-melt --steps 2000 --tolerance 2%
  mesoscope stability --resume dpd-fluid-stability       go on with one that was interrupted

All runs cover the simulated time of the scene (--steps N shortens it), with 256 steps at least. They write no files of \
their own. Right is what a law says - the temperature of the bath, an energy that does not drift - or a --reference.")]
pub struct Arguments {
    /// A key of the scene with a range, `time.step=0.01..0.2/9` (nine values, equal ratios; `:linear` after it for equal
    /// differences), or with values; once for a row, twice for a map [default: time.step from a quarter to 16 times]
    #[arg(long, help_heading = heading::SCENE, value_name = "PATH=LOW..HIGH/POINTS", allow_hyphen_values = true, conflicts_with = "resume")]
    vary: Vec<String>,

    /// The largest error of what is right, as a part of one or in per cent
    #[arg(long, help_heading = heading::COMPARISON, value_name = "PART", value_parser = super::tradeoff::part, default_value = "5%",
        conflicts_with = "resume")]
    tolerance: f64,

    /// Measures to compare [default: both temperatures, or the drift of the energy, where a law says what they should be]
    #[arg(long, help_heading = heading::COMPARISON, value_name = "MEASURE,…", value_delimiter = ',', conflicts_with = "resume")]
    measure: Vec<String>,

    /// How often the distance of neighbours in a row is halved to locate an edge
    #[arg(long, help_heading = heading::RUNNING, value_name = "N", default_value_t = 3, value_parser = clap::value_parser!(u32).range(0..=20),
        conflicts_with = "resume")]
    bisections: u32,

    #[command(flatten)]
    comparison: ComparisonArguments,

    #[command(flatten)]
    study: StudyArguments,
}

/// Makes the map.
pub fn execute(arguments: &Arguments) -> Result<(), Failure> {
    let Arguments { comparison, study, .. } = arguments;
    let run: StabilityRun = study.study(|scene| {
        let references =
            References::parse(&comparison.reference).map_err(|mistakes| StudyError::Arguments { mistakes })?;
        Ok(Request::load(scene, &study.set, study.steps, &arguments.vary)?
            .with_tolerance(arguments.tolerance)?
            .with_bisections(arguments.bisections)
            .with_seeds(study.seeds.unwrap_or(1))?
            .with_measures(&arguments.measure, references)?)
    })?;
    let base = run.request().base();
    study.note(base.notices());
    let (title, directory) = (base.title.clone(), printable::path(run.directory()));
    let in_words = |runs| format!("{runs} runs, then the edges");
    let outcome = study.execute(run, &title, in_words, StabilityRun::execute)?;
    if study.how.quiet { Ok(()) } else { print(&results(&outcome, &directory)) }
}

/// The table at the end, and the files written.
fn results(outcome: &StudyOutcome<StabilitySummary>, directory: &str) -> String {
    let summary = &outcome.summary;
    let header = [
        "ROW".to_owned(),
        format!("{}: {} UP TO", summary.right_in_a_word().to_uppercase(), summary.key),
        "UNSTABLE FROM".to_owned(),
        "LAWS".to_owned(),
    ];
    let mut rows = vec![header.to_vec()];
    rows.extend(summary.in_words().into_iter().map(|words| words.to_vec()));
    let mut text = aligned(&rows, "  ");
    text.extend(summary.legend().map(|legend| format!("  {legend}\n")));
    text.extend(summary.findings().iter().map(|finding| format!("note: {finding}\n")));
    format!("{text}wrote {directory}/: {}\n", outcome.files.join(", "))
}
