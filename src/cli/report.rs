//! What a run prints for its user: a line at the start, progress, a table at the end.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

use indicatif::ProgressBar;
use mesoscope::families::{self, Model, PictureKind};
use mesoscope::numbers::{counted, counted_in_groups, grouped, prefixed};
use mesoscope::output::summary::Unequilibrated;
use mesoscope::printable;
use mesoscope::quantity::{Quantity, Unit};
use mesoscope::ranks::Processes;
use mesoscope::run::{self, Event, Outcome, Progress, Run};

use super::event_lines::{EventLines, Form};
use super::progress::{Patience, bar, say};
use super::table::{aligned, labelled};
use super::{Failure, RanksArgument, line, print};

/// Executes a run on its ranks and reports on it, with warnings of what they cost before; without a form, errors only.
pub fn execute(
    simulation: Run,
    processes: Option<&dyn Processes>,
    ranks: &RanksArgument,
    directory: &str,
    form: Option<Form>,
) -> Result<(), Failure> {
    let copies = processes.map(Processes::count);
    let division = ranks.division(simulation.scene(), copies)?;
    let warning = ranks.warning(division, copies);
    let simulation = simulation.on_ranks(division);
    let simulation = if ranks.mixed { simulation.mixed() } else { simulation };
    let choice = &ranks.adapter.choice_of_copy();
    // Other processes wait for word of this one; a run that goes on has its checkpoint.
    let begun = Arc::new(AtomicBool::new(processes.is_some() || simulation.first_step() > 0));
    let simulation = simulation.until(&super::interruption::interrupt(&begun));
    let note_begin = |event: &Event<'_>| {
        if matches!(event, Event::Started { .. }) {
            begun.store(true, Ordering::Relaxed);
        }
    };
    let Some(form) = form else {
        simulation.execute_among(processes, choice, &mut |event| note_begin(&event))?;
        return Ok(());
    };
    let scene = simulation.scene().clone();
    let mut known = simulation.notices().to_vec();
    let of_scene: Vec<String> = families::warnings(&scene).iter().map(ToString::to_string).collect();
    if form == Form::Json {
        let mut lines = EventLines::default();
        warning.iter().chain(&known).chain(&of_scene).for_each(|warning| EventLines::warn(warning));
        let outcome = simulation.execute_among(processes, choice, &mut |event| {
            note_begin(&event);
            lines.show(&event);
        })?;
        EventLines::finish(&outcome);
        return print(&results(&outcome, scene.model(), directory));
    }
    let mut reporter = Reporter::new(&simulation);
    let warned = |warning: &String| format!("warning: {warning}");
    let notes = known.iter().map(|notice| format!("note: {notice}"));
    warning.iter().map(warned).chain(notes).chain(of_scene.iter().map(warned)).for_each(|text| line(&text));
    known.extend(of_scene);
    let result = simulation.execute_among(processes, choice, &mut |event| {
        note_begin(&event);
        reporter.show(event);
    });
    reporter.bar.finish_and_clear();
    let outcome = result?;
    known.append(&mut reporter.told);
    for warning in outcome.summary.warnings.iter().filter(|warning| !known.contains(warning)) {
        line(&format!("warning: {warning}"));
    }
    print(&results(&outcome, scene.model(), directory))
}

/// The name of a scene or of its file, without directories and extension.
pub fn stem(scene: &str) -> &str {
    std::path::Path::new(scene).file_stem().and_then(|stem| stem.to_str()).unwrap_or("run")
}

/// Silence that needs no word.
const PATIENCE: Duration = Duration::from_secs(1);

/// A short run needs no lines of progress.
const BETWEEN_LINES: Duration = Duration::from_secs(1);

struct Reporter {
    /// Whether its pictures are fields: what flows has no temperature to speak of.
    flows: bool,
    /// Its title and its particles.
    headline: String,
    /// What they are, and what acts on them, where a file or molecules say it.
    composition: String,
    bar: ProgressBar,
    /// Tenths of the run already reported on lines of their own, and when the last was.
    reported: u64,
    reported_at: Instant,
    first_step: u64,
    /// Word of a driver that compiles for long.
    compiling: Option<Patience>,
    /// Warnings that came on the way.
    told: Vec<String>,
}

impl Reporter {
    fn new(simulation: &Run) -> Self {
        let (model, scene) = (simulation.scene().model(), simulation.scene());
        let particles = counted_in_groups(model.particle_count(), "particle");
        let dimensions = counted(scene.space.lengths.len() as u64, "dimension");
        let title = printable::name(&scene.title);
        Self {
            flows: model.picture() == PictureKind::Fields,
            headline: format!("{title}: {particles} in {dimensions}"),
            composition: labelled(scene.composition(), "  "),
            bar: ProgressBar::hidden(),
            reported: 0,
            reported_at: Instant::now(),
            first_step: 0,
            compiling: None,
            told: Vec::new(),
        }
    }

    fn show(&mut self, event: Event<'_>) {
        // Whatever comes next, kernels are compiled.
        self.compiling = None;
        match event {
            Event::Compiling { kernels } => {
                let words = format!("compiling {} and loading particles", counted(kernels as u64, "kernel"));
                self.compiling = Some(Patience::new(PATIENCE, move |elapsed| {
                    line(&format!("{words}: {} so far", duration(elapsed.as_secs())));
                }));
            }
            Event::Started { adapter, first_step, last_step } => {
                let begin = if first_step > 0 { format!(", from step {}", grouped(first_step)) } else { String::new() };
                let (headline, composition) = (&self.headline, &self.composition);
                // A closed standard output will be noticed when the results are printed.
                let _ = print(&format!("{headline}{begin}, on {}\n{composition}", adapter.in_words()));
                self.first_step = first_step;
                self.bar = bar(first_step, last_step, "step {pos}/{len} {wide_bar} {percent:>3}%  {msg}");
            }
            Event::Advanced(progress) => self.advanced(&progress),
            Event::Repeating { from, reason, with } => {
                say(&self.bar, &format!("note: {reason}; continuing from step {} with {with}", grouped(from)));
            }
            Event::Stage { number, of } => say(&self.bar, &format!("stage {} of {of}", number + 1)),
            Event::Warned { warning } => {
                say(&self.bar, &format!("warning: {warning}"));
                self.told.push(warning.to_owned());
            }
            Event::Finishing => self.bar.set_message("writing results"),
            _ => {}
        }
    }

    fn advanced(&mut self, progress: &Progress) {
        if !self.bar.is_hidden() {
            self.bar.set_position(progress.step);
            self.bar.set_message(describe(progress, self.flows));
            return;
        }
        let steps = (progress.last_step - self.first_step).max(1);
        let tenth = 10 * (progress.step - self.first_step) / steps;
        if tenth > self.reported && progress.step < progress.last_step && self.reported_at.elapsed() > BETWEEN_LINES {
            self.reported = tenth;
            self.reported_at = Instant::now();
            let percent = 100 * progress.step / progress.last_step.max(1);
            let (step, last) = (grouped(progress.step), grouped(progress.last_step));
            line(&format!("step {step} of {last} ({percent} %)  {}", describe(progress, self.flows)));
        }
    }
}

fn describe(progress: &Progress, flows: bool) -> String {
    let mut parts = Vec::new();
    if progress.particle_steps_per_second > 0.0 {
        parts.push(format!("{} particle-steps/s", prefixed(progress.particle_steps_per_second)));
    }
    if let Some(temperature) = progress.temperature.filter(|_| !flows) {
        parts.push(format!("kT {temperature:.3}"));
    }
    if let Some(remaining) = progress.remaining {
        parts.push(format!("{} left", duration(remaining.as_secs())));
    }
    parts.join("  ")
}

/// A time for people.
pub fn duration(seconds: u64) -> String {
    match seconds {
        0..60 => format!("{seconds} s"),
        60..3600 => format!("{} min {:02} s", seconds / 60, seconds % 60),
        _ => format!("{} h {:02} min", seconds / 3600, seconds / 60 % 60),
    }
}

/// The column of the part of the pressure that is not of friction and noise.
const CONSERVATIVE_PRESSURE: &str = "pressure_conservative";

fn results(outcome: &Outcome, model: &Model, directory: &str) -> String {
    let summary = &outcome.summary;
    let mut rows = Vec::new();
    let flows = model.picture() == PictureKind::Fields;
    // What flows has no temperature to speak of.
    let columns: Vec<&str> = if flows {
        Quantity::columns_shown_in(Unit::Energy).collect()
    } else {
        let pressures = Quantity::columns_shown_in(Unit::Pressure).rev();
        Quantity::columns_shown_in(Unit::Temperature).chain(pressures).collect()
    };
    for column in columns {
        let is_conservative_part = column == CONSERVATIVE_PRESSURE;
        // Friction and noise have no part in the pressure where nothing flows, and widen its error.
        if is_conservative_part && model.is_driven() {
            continue;
        }
        let label = if is_conservative_part { "pressure, conservative part" } else { &column.replace('_', " ") };
        if let Some(value) = summary.means.get(column).and_then(run::printed_estimate) {
            let spoilt = summary.unequilibrated.as_ref().is_some_and(|found| found.includes(column));
            rows.push(vec![label.to_owned(), marked(value, spoilt)]);
        }
    }
    for (number, stage) in (1..).zip(&summary.stages) {
        let results = run::printed_results(&stage.results).into_iter();
        rows.extend(results.map(|(label, value)| vec![format!("stage {number}: {label}"), value]));
    }
    rows.extend(run::printed_results(&summary.results).into_iter().map(|(label, value)| vec![label, value]));
    if summary.particle_steps_per_second > 0.0 {
        let rate = prefixed(summary.particle_steps_per_second);
        rows.push(vec!["speed".to_owned(), format!("{rate} particle-steps/s, {:.2} s", summary.wall_seconds)]);
    }
    let note = marks(&rows, summary.unequilibrated.as_ref());
    let mut files: Vec<String> = outcome.files.iter().map(|name| (*name).to_owned()).collect();
    if outcome.snapshots > 0 {
        let (noun, of) = if flows { ("numbered frame", " of each field") } else { ("numbered snapshot", "") };
        files.push(counted(outcome.snapshots, noun) + of);
    }
    files.extend(summary.stages.iter().filter_map(|stage| Some(format!("{}/", stage.directory.as_ref()?))));
    // Particles that exchange momentum in pairs lead one to expect that it is conserved.
    let mut unkept = summary.not_conserved.iter().filter(|_| !flows);
    let reasons = unkept.find_map(|entry| entry.strip_prefix("total momentum: "));
    let momentum =
        reasons.map_or_else(String::new, |reasons| format!("  total momentum is not conserved: {reasons}\n"));
    format!("{}{note}{momentum}wrote {}/: {}\n", aligned(&rows, "  "), printable::name(directory), files.join(", "))
}

/// The meaning of the marks of means in a table, as far as it has them.
pub fn marks(rows: &[Vec<String>], unequilibrated: Option<&Unequilibrated>) -> String {
    // The first cell of a row is a label, which a user may have written.
    let means = || rows.iter().flat_map(|row| row.iter().skip(1));
    let has = |mark: char| means().any(|cell| cell.ends_with(mark) || cell.contains(&format!("{mark} ")));
    let mut notes = String::new();
    if has('*') {
        notes.push_str(
            "  * from few samples: the error may be larger; more steps tell, or independent runs (--seeds 10)\n",
        );
    }
    if has('†') {
        let advice = unequilibrated.map_or_else(String::new, |found| format!(": try {}", found.arguments()));
        notes = format!("{notes}  † not yet in equilibrium{advice}\n");
    }
    notes
}

/// A mean, with a mark if it includes the way to equilibrium.
pub fn marked(mean: String, unequilibrated: bool) -> String {
    if unequilibrated { format!("{mean} †") } else { mean }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn times_are_short() {
        assert_eq!(duration(7), "7 s");
        assert_eq!(duration(67), "1 min 07 s");
        assert_eq!(duration(7267), "2 h 01 min");
    }
}
