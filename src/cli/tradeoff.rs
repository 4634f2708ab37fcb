//! `mesoscope tradeoff`: what accuracy costs, and what to choose.

use std::fs;
use std::path::{Path, PathBuf};

use mesoscope::printable;
use mesoscope::study::{StudyError, StudyOutcome};
use mesoscope::tradeoff::{Length, References, Request, Target, TradeoffRun, TradeoffSummary};

use super::table::aligned;
use super::{ComparisonArguments, Failure, StudyArguments, VariantArguments, heading, print};

/// Run variants of a scene over the same time, and compare what they cost with how far they are off
#[derive(Debug, clap::Args)]
#[command(after_help = "\
Examples:
  mesoscope tradeoff dpd-fluid --vary time.step=0.02,0.04,0.06 --vary integrator.type=splitting,groot-warren
  mesoscope tradeoff dpd-fluid --vary time.step=0.02,0.04 --steps 500       a first look
  mesoscope tradeoff dpd-fluid --vary time.step=0.02,0.04 --error 0.002
  mesoscope tradeoff jet-instability --vary time.step=0.01,0.02 --budget 10m
  mesoscope tradeoff dpd-fluid --vary time.step=0.02,0.04 --target configurational_temperature=1% --write new.json
  mesoscope tradeoff --resume dpd-fluid-tradeoff         go on with one that was interrupted

Every choice covers the same simulated time and is sampled at the same times; it has a directory of its own, that of an \
ordinary run. What measures are compared with is given (--reference), or a law that the scene has to obey, or a finer \
run: the scene with half the smallest time step, or as --finer says.")]
pub struct Arguments {
    #[command(flatten)]
    variants: VariantArguments,

    /// Make all runs so long that every mean has at most this relative standard error [default: as long as the scene]
    #[arg(long, help_heading = heading::RUNNING, value_name = "PART", value_parser = part, conflicts_with = "resume")]
    error: Option<f64>,

    /// Time that all steps may take together, as in `30s`, `10m`, `2h`
    #[arg(long, help_heading = heading::RUNNING, value_name = "TIME", value_parser = time, conflicts_with = "resume")]
    budget: Option<f64>,

    /// Settings of the run that references are taken from [default: half the smallest time step]
    #[arg(long, help_heading = heading::COMPARISON, value_name = "PATH=VALUE,…", conflicts_with = "resume")]
    finer: Option<String>,

    /// Settings of a still finer run beside those of --finer: what it changes says how far that one is off
    #[arg(long, help_heading = heading::COMPARISON, value_name = "PATH=VALUE,…", conflicts_with = "resume")]
    still_finer: Option<String>,

    /// Measures to compare: columns of the table of energies, `diffusion.diffusion_einstein` of an analysis; may be repeated
    /// [default: temperatures, pressure and energy, or the drift of the energy, and what analyses find]
    #[arg(long, help_heading = heading::COMPARISON, value_name = "MEASURE,…", value_delimiter = ',', conflicts_with = "resume")]
    measure: Vec<String>,

    /// The largest error of a measure, as in `pressure=1%` or `pressure=0.2`; may be repeated. The cheapest choice that
    /// meets all of them, with their uncertainties, is named
    #[arg(long, help_heading = heading::COMPARISON, value_name = "MEASURE=ERROR", conflicts_with = "resume")]
    target: Vec<String>,

    /// Write the scene of the choice that meets the targets
    #[arg(long, help_heading = heading::OUTPUT, value_name = "NEW.json")]
    write: Option<PathBuf>,

    #[command(flatten)]
    comparison: ComparisonArguments,

    #[command(flatten)]
    study: StudyArguments,
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
    let study = &arguments.study;
    let run: TradeoffRun = study.study(|scene| request(scene, arguments))?;
    if let Some(path) = &arguments.write {
        check_place(path, run.request())?;
    }
    let base = run.request().base();
    study.note(base.notices());
    let (title, directory) = (base.title.clone(), printable::path(run.directory()));
    let outcome = study.execute(run, &title, |runs| format!("{runs} runs"), TradeoffRun::execute)?;
    if !study.how.quiet {
        print(&results(&outcome, &directory))?;
    }
    if let Some(path) = &arguments.write {
        write(&outcome.summary, path)?;
    }
    // Nobody said that it may take so long.
    outcome.summary.wanted.map_or(Ok(()), |wanted| {
        let goes_on = format!("pass --yes to run them: `mesoscope tradeoff --resume {directory} --yes` goes on");
        Err(Failure::usage(format!("{wanted}: {goes_on}; the tables of what has run are written")))
    })
}

fn request(scene: &str, arguments: &Arguments) -> Result<Request, Failure> {
    let mut mistakes = Vec::new();
    let references = References::parse(&arguments.comparison.reference).unwrap_or_else(|wrong| {
        mistakes.extend(wrong);
        References::default()
    });
    let mut note = |argument: &String, message| mistakes.push(format!("`--target {argument}`: {message}"));
    let target = |argument: &String| Target::parse(argument).map_err(|message| note(argument, message)).ok();
    let targets: Vec<Target> = arguments.target.iter().filter_map(target).collect();
    if !mistakes.is_empty() {
        return Err(StudyError::Arguments { mistakes }.into());
    }
    let length = Length { error: arguments.error, budget: arguments.budget };
    let VariantArguments { vary, also } = &arguments.variants;
    Ok(Request::load(scene, &arguments.study.set, arguments.study.steps, vary, also)?
        .with_length(length)
        .with_measures(&arguments.measure)?
        .with_references(references)?
        .with_targets(targets)?
        .with_seeds(arguments.study.seeds.unwrap_or(1))?
        .with_finer(arguments.finer.as_deref(), arguments.still_finer.as_deref())?)
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
    let shown = printable::path(path);
    let Some(scene) = summary.chosen_scene()? else {
        return Err(Failure::usage(format!("no choice is known to meet the targets, so `{shown}` was not written")));
    };
    let wrong = |error: std::io::Error| Failure::input_output(format!("cannot write `{shown}`: {error}"));
    // Never over a file that came to be there in the meantime.
    let mut file = fs::File::create_new(path).map_err(wrong)?;
    std::io::Write::write_all(&mut file, scene.as_bytes()).map_err(wrong)?;
    print(&format!("wrote {shown}\n"))
}

/// The table at the end, what to choose, and the files written.
fn results(outcome: &StudyOutcome<TradeoffSummary>, directory: &str) -> String {
    let summary = &outcome.summary;
    let mut rows = summary.errors_in_words();
    rows[..1].iter_mut().flatten().for_each(|name| *name = name.to_uppercase());
    let mut text = aligned(&rows, "  ");
    text.push_str("  errors against the references in tradeoff.md; * on the Pareto front of cost and error\n");
    text.extend(summary.legend().map(|legend| format!("  {legend}\n")));
    text.extend(summary.short_of_errors().map(|short| format!("{short}\n")));
    text.extend(summary.notes().iter().map(|note| format!("note: {note}\n")));
    text.push_str(&summary.advice());
    format!("{text}wrote {directory}/: {}\n", outcome.files.join(", "))
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
