//! `mesoscope tradeoff`: what accuracy costs, and what to choose.

use std::fs;
use std::io::IsTerminal as _;
use std::path::{Path, PathBuf};

use indicatif::ProgressBar;
use mesoscope::numbers::{prefixed, with_error};
use mesoscope::printable;
use mesoscope::tradeoff::{
    Choice, ChoiceState, Length, References, Request, Target, TradeoffError, TradeoffEvent, TradeoffOutcome,
    TradeoffRun, TradeoffSummary, error_in_words,
};

use super::report::{self, duration};
use super::table::aligned;
use super::{Failure, RunArguments, line, print, progress};

/// Run variants of a scene over the same time, and compare what they cost with how far they are off
#[derive(Debug, clap::Args)]
#[command(after_help = "\
Examples:
  mesoscope tradeoff dpd-fluid --vary time.step=0.02,0.04,0.06 --vary integrator.type=splitting,groot-warren
  mesoscope tradeoff dpd-fluid --vary time.step=0.02,0.04 --error 0.002
  mesoscope tradeoff jet-instability --vary time.step=0.01,0.02 --budget 10m
  mesoscope tradeoff dpd-fluid --vary time.step=0.02,0.04 --target configurational_temperature=1% --write new.json
  mesoscope tradeoff --resume dpd-fluid-tradeoff         go on with one that was interrupted

Every choice covers the same simulated time and is sampled at the same times; it has a directory of its own, that of an
ordinary run. What measures are compared with is given (--reference), or a law that the scene has to obey, or a finer
run: the scene with half the smallest time step, or as --finer says.")]
pub struct Arguments {
    /// A scene file, or the name of a built-in scene (see `mesoscope scenes`)
    #[arg(required_unless_present = "resume")]
    scene: Option<String>,

    /// A key of the scene and the values to try, as for `mesoscope sweep`; repeated, every combination is a choice
    #[arg(long, value_name = "PATH=VALUE,…", required_unless_present = "resume")]
    vary: Vec<String>,

    /// One more choice besides the combinations, with settings of its own; may be repeated
    #[arg(long, value_name = "PATH=VALUE,…")]
    also: Vec<String>,

    /// Change one value in all choices, as for `mesoscope run`; may be repeated
    #[arg(long, value_name = "PATH=VALUE")]
    set: Vec<String>,

    /// Make all runs so long that every mean has at most this relative standard error [default: as long as the scene]
    #[arg(long, value_name = "PART", value_parser = part)]
    error: Option<f64>,

    /// Time that all steps may take together, as in `30s`, `10m`, `2h`
    #[arg(long, value_name = "TIME", value_parser = time)]
    budget: Option<f64>,

    /// What a measure should be, as in `pressure=23.635` or `pressure=23.635+-0.005`; may be repeated
    #[arg(long, value_name = "MEASURE=VALUE")]
    reference: Vec<String>,

    /// Settings of the run that references are taken from [default: half the smallest time step]
    #[arg(long, value_name = "PATH=VALUE,…")]
    finer: Option<String>,

    /// Measures to compare: columns of the table of energies, `diffusion.diffusion_einstein` of an analysis; may be repeated
    /// [default: temperatures, pressure and energy, or the drift of the energy, and what analyses find]
    #[arg(long, value_name = "MEASURE,…", value_delimiter = ',')]
    measure: Vec<String>,

    /// The largest error of a measure, as in `pressure=1%` or `pressure=0.2`; may be repeated. The cheapest choice that
    /// meets all of them, with their uncertainties, is named
    #[arg(long, value_name = "MEASURE=ERROR")]
    target: Vec<String>,

    /// Write the scene of the choice that meets the targets
    #[arg(long, value_name = "NEW.json")]
    write: Option<PathBuf>,

    /// Run even if it takes more than eight hours
    #[arg(long)]
    yes: bool,

    /// Directory for all runs [default: the scene's name and `-tradeoff`, in the working directory]
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,

    /// Go on with the tradeoff in this directory
    #[arg(long, value_name = "DIR", conflicts_with_all =
        ["scene", "vary", "also", "set", "error", "budget", "reference", "finer", "measure", "target", "out", "force"])]
    resume: Option<PathBuf>,

    #[command(flatten)]
    how: RunArguments,
}

pub(super) fn part(text: &str) -> Result<f64, String> {
    let accepted = "accepted: a part of one, as in 0.002, or 0.2%";
    let (number, scale) = text.strip_suffix('%').map_or((text, 1.0), |number| (number, 0.01));
    let value = number.trim().parse::<f64>().ok().map(|value| scale * value);
    value.filter(|value| *value > 0.0 && *value < 1.0).ok_or_else(|| accepted.to_owned())
}

fn time(text: &str) -> Result<f64, String> {
    let accepted = "accepted: seconds, minutes or hours, as in 30s, 10m, 2h";
    let units = [('s', 1.0), ('m', 60.0), ('h', 3600.0)];
    let unit = units.into_iter().find_map(|(letter, scale)| Some((text.strip_suffix(letter)?, scale)));
    let (number, scale) = unit.unwrap_or((text, 1.0));
    let value = number.trim().parse::<f64>().ok().map(|value| scale * value);
    value.filter(|value| value.is_finite() && *value > 0.0).ok_or_else(|| accepted.to_owned())
}

/// Runs the choices.
pub fn execute(arguments: &Arguments) -> Result<(), Failure> {
    let (run, directory) = if let Some(directory) = &arguments.resume {
        (TradeoffRun::resume(directory)?, directory.clone())
    } else {
        let request = request(arguments)?;
        let scene = arguments.scene.as_deref().unwrap_or_default();
        let directory = arguments.out.clone().unwrap_or_else(|| format!("{}-tradeoff", report::stem(scene)).into());
        (TradeoffRun::start(request, &directory, arguments.how.force), directory)
    };
    if let Some(path) = &arguments.write {
        check_place(path, run.request())?;
    }
    let run = run.unless_long(arguments.yes).until(&super::interruption::interrupt());
    let mut reporter = Reporter::new(run.request().title(), arguments.how.quiet);
    let executed = run.execute(&arguments.how.adapter.choice(), &mut |event| reporter.show(event));
    reporter.clear();
    let outcome = executed?;
    if !arguments.how.quiet {
        print(&results(&outcome, &printable::path(&directory)))?;
    }
    if let Some(path) = &arguments.write {
        write(&outcome.summary, path)?;
    }
    Ok(())
}

fn request(arguments: &Arguments) -> Result<Request, Failure> {
    let scene = arguments.scene.as_deref().unwrap_or_default();
    let mut mistakes = Vec::new();
    let references = References::parse(&arguments.reference).unwrap_or_else(|wrong| {
        mistakes.extend(wrong);
        References::default()
    });
    let mut targets = Vec::new();
    for argument in &arguments.target {
        match Target::parse(argument) {
            Ok(target) => targets.push(target),
            Err(message) => mistakes.push(format!("`--target {argument}`: {message}")),
        }
    }
    if !mistakes.is_empty() {
        return Err(TradeoffError::Arguments { mistakes }.into());
    }
    let length = Length { error: arguments.error, budget: arguments.budget };
    let request = Request::load(scene, &arguments.set, &arguments.vary, &arguments.also)?
        .with_length(length)
        .with_measures(&arguments.measure)?
        .with_references(references)?
        .with_targets(targets)?;
    Ok(match &arguments.finer {
        Some(finer) => request.with_finer(finer)?,
        None => request,
    })
}

/// Refuses a place for the new scene that could not be written to at the end.
fn check_place(path: &Path, request: &Request) -> Result<(), Failure> {
    let shown = printable::path(path);
    if !request.has_targets() {
        return Err(Failure::usage("`--write` needs a `--target` that says which choice to write".to_owned()));
    }
    if path.exists() {
        return Err(Failure::input_output(format!("`{shown}` exists already: choose another name for --write")));
    }
    let parent = path.parent().filter(|parent| !parent.as_os_str().is_empty()).unwrap_or(Path::new("."));
    if !parent.is_dir() {
        return Err(Failure::input_output(format!("`{shown}` cannot be written: its directory does not exist")));
    }
    Ok(())
}

/// Writes the scene of the choice that meets the targets.
fn write(summary: &TradeoffSummary, path: &Path) -> Result<(), Failure> {
    let Some(scene) = summary.chosen_scene()? else {
        return Err(Failure::usage(format!(
            "no choice meets the targets, so `{}` was not written",
            printable::path(path)
        )));
    };
    let wrong =
        |error: std::io::Error| Failure::input_output(format!("cannot write `{}`: {error}", printable::path(path)));
    // Never over a file that came to be there in the meantime.
    let mut file = fs::File::create_new(path).map_err(wrong)?;
    std::io::Write::write_all(&mut file, scene.as_bytes()).map_err(wrong)?;
    print(&format!("wrote {}\n", printable::path(path)))
}

/// Shows how far a tradeoff is: a bar on a terminal, else a line for every run.
struct Reporter {
    title: String,
    quiet: bool,
    bar: Option<ProgressBar>,
    runs: usize,
    ended: usize,
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

    fn show(&mut self, event: TradeoffEvent<'_>) {
        if self.quiet {
            return;
        }
        match event {
            TradeoffEvent::Started { adapter, runs, seconds } => {
                self.runs = runs;
                let expected = duration(seconds.ceil() as u64);
                let text = format!("{}: {runs} runs on {}, about {expected} at first\n", self.title, adapter.name);
                // A closed standard output will be noticed when the results are printed.
                let _ = print(&text);
                if std::io::stderr().is_terminal() {
                    self.bar = Some(progress::bar(0, "{wide_bar} {percent:>3}%  {msg}"));
                }
            }
            TradeoffEvent::Advanced { name, progress } => {
                if let Some(bar) = &self.bar {
                    bar.set_length(progress.last_step.max(1));
                    bar.set_position(progress.step);
                    let rate = prefixed(progress.particle_steps_per_second);
                    bar.set_message(format!("{} of {}  {name}  {rate} particle-steps/s", self.ended + 1, self.runs));
                }
            }
            TradeoffEvent::Ended { choice } => {
                self.ended += 1;
                let what = match (choice.state, &choice.failure) {
                    (ChoiceState::Unstable, Some(failure)) => format!("unstable: {failure}"),
                    _ => format!("{} steps", choice.steps),
                };
                self.say(&format!("{} of {}  {}  {what}", self.ended, self.runs, choice.name));
            }
            TradeoffEvent::Extended { factor, worst } => {
                self.ended = 0;
                let why = worst.map_or_else(String::new, |worst| {
                    format!("the largest standard error is {} %: ", with_error(100.0 * worst, None))
                });
                self.say(&format!("{why}means are taken over {factor:.1} times the time"));
            }
            TradeoffEvent::Timing => self.say("timing steps in turns"),
            TradeoffEvent::Finishing => {
                if let Some(bar) = &self.bar {
                    bar.set_message("drawing");
                }
            }
            _ => {}
        }
    }
}

/// The table at the end, what to choose, and the files written.
fn results(outcome: &TradeoffOutcome, directory: &str) -> String {
    let summary = &outcome.summary;
    let mut header = vec!["CHOICE".to_owned(), "S A UNIT OF TIME".to_owned()];
    header.extend(summary.measures.iter().map(|measure| measure.replace('_', " ").to_uppercase()));
    let mut rows = vec![header];
    for choice in &summary.choices {
        let mut row = vec![choice.label.clone()];
        if choice.state == ChoiceState::Unstable {
            row.push("unstable".to_owned());
        } else {
            row.push(choice.cost.map_or_else(String::new, |cost| with_error(cost.seconds_per_time, None)));
            row.extend(summary.measures.iter().map(|measure| cell(choice, measure)));
        }
        rows.push(row);
    }
    let mut text = aligned(&rows, "  ");
    text.push_str("  errors against the references in tradeoff.md; * on the Pareto front of cost and error\n");
    if summary.is_short {
        text.push_str(
            "the runs ended before all errors were as small as asked for: a larger --budget makes them longer\n",
        );
    }
    text.extend(summary.notes().iter().map(|note| format!("note: {note}\n")));
    text.push_str(&summary.advice());
    format!("{text}wrote {directory}/: {}\n", outcome.files.join(", "))
}

fn cell(choice: &Choice, measure: &str) -> String {
    choice.error(measure).map_or_else(String::new, |error| {
        let mark = if error.on_front { " *" } else { "" };
        format!("{}{mark}", error_in_words(error))
    })
}

impl From<TradeoffError> for Failure {
    fn from(error: TradeoffError) -> Self {
        match error {
            TradeoffError::Sweep(error) => error.into(),
            TradeoffError::Gpu(error) => error.into(),
            TradeoffError::Interrupted { .. } => Self::interrupted(error.to_string()),
            TradeoffError::Arguments { .. } | TradeoffError::Variant { .. } | TradeoffError::Long { .. } => {
                Self::usage(error.to_string())
            }
            TradeoffError::Run { ref source, .. } => Self::of_run(source, error.to_string()),
            TradeoffError::Output(mesoscope::output::OutputError::ResultExists { .. }) => Self::input_output(format!(
                "{error}\nhint: `mesoscope tradeoff --resume DIR` goes on with an interrupted one"
            )),
            _ => Self::input_output(error.to_string()),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::{part, time};

    #[test]
    fn parts_and_times_are_read() {
        assert_eq!((part("0.002"), part("0.5%")), (Ok(0.002), Ok(0.005)));
        assert_eq!((time("30"), time("10m"), time("0.5h")), (Ok(30.0), Ok(600.0), Ok(1800.0)));
        for wrong in ["", "0", "-1", "2", "x", "nan"] {
            assert!(part(wrong).is_err(), "{wrong}");
        }
        for wrong in ["", "0s", "-1m", "m", "inf", "1d", "10mm"] {
            assert!(time(wrong).is_err(), "{wrong}");
        }
    }
}
