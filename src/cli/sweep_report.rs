//! What a sweep prints for its user: a line at the start, progress, a table at the end.

use std::io::IsTerminal as _;
use std::time::Duration;

use indicatif::ProgressBar;
use mesoscope::families;
use mesoscope::numbers::prefixed;
use mesoscope::output::summary::Unequilibrated;
use mesoscope::printable;
use mesoscope::run::{Progress, printed_mean};
use mesoscope::sweep::{Sweep, SweepEvent, SweepOutcome, VariantState, VariantSummary};
use serde_json::{Map, Value};

use super::report::{duration, marked};
use super::table::aligned;
use super::{line, print, progress};

/// Columns of the table at the end, where a variant has them.
const SHOWN: [&str; 4] = ["total_energy", "temperature", "configurational_temperature", "pressure"];

/// Shows how far a sweep is: a bar on a terminal, otherwise a line for every variant.
pub struct Reporter {
    sweep: Sweep,
    bar: Option<ProgressBar>,
    /// First step, step and rate of every variant under way.
    under_way: Vec<(usize, u64, Option<Progress>)>,
    /// Steps of the variants that have ended.
    done: u64,
    ended: usize,
    waiting: usize,
}

/// Lines for the user; one that concerns several variants is written once.
#[derive(Default)]
struct Texts<'a>(Vec<(String, Vec<&'a str>)>);

impl<'a> Texts<'a> {
    fn add(&mut self, text: String, variant: &'a str) {
        match self.0.iter_mut().find(|(known, _)| *known == text) {
            Some((_, names)) => names.push(variant),
            None => self.0.push((text, vec![variant])),
        }
    }

    fn print(self, variants: usize) {
        for (text, names) in self.0 {
            let place = if names.len() == variants { String::new() } else { format!(" (`{}`)", names.join("`, `")) };
            line(&format!("{text}{place}"));
        }
    }
}

impl Reporter {
    pub fn new(sweep: Sweep) -> Self {
        Self { sweep, bar: None, under_way: Vec::new(), done: 0, ended: 0, waiting: 0 }
    }

    /// Warnings about the scenes.
    pub fn warn(&self) {
        let mut texts = Texts::default();
        for variant in self.sweep.variants() {
            for notice in &variant.notices {
                texts.add(format!("note: {notice}"), &variant.name);
            }
            for warning in families::warnings(&variant.scene) {
                texts.add(format!("warning: {warning}"), &variant.name);
            }
        }
        texts.print(self.sweep.variants().len());
    }

    /// What the runs themselves gave rise to; means that include the way to equilibrium are marked in the table.
    pub fn warn_of_results(&self, outcome: &SweepOutcome) {
        let mut texts = Texts::default();
        for (variant, summary) in self.sweep.variants().iter().zip(&outcome.summary.variants) {
            let of_scene = families::warnings(&variant.scene);
            let before = variant.notices.iter().chain(&of_scene).map(ToString::to_string);
            let known: Vec<String> = before.chain(summary.unequilibrated.as_ref().map(ToString::to_string)).collect();
            for warning in summary.warnings.iter().filter(|warning| !known.contains(warning)) {
                texts.add(format!("warning: {warning}"), &variant.name);
            }
        }
        texts.print(self.sweep.variants().len());
    }

    pub fn clear(&mut self) {
        if let Some(bar) = self.bar.take() {
            bar.finish_and_clear();
        }
    }

    pub fn show(&mut self, event: SweepEvent<'_>) {
        match event {
            SweepEvent::Started { adapter, waiting, jobs } => {
                let keys: Vec<&str> = self.sweep.variations().iter().map(|variation| variation.key.as_str()).collect();
                let all = self.sweep.variants().len();
                let count = if waiting == all {
                    format!("{all} variant{}", if all == 1 { "" } else { "s" })
                } else {
                    format!("{waiting} of {all} variants left")
                };
                let title = self.sweep.variants().first().map_or("", |variant| &variant.scene.title);
                let title = printable::name(title);
                let (name, driver) = (&adapter.name, &adapter.driver);
                // A closed standard output will be noticed when the results are printed.
                let _ = print(&format!(
                    "{title}: {count} of {}, {jobs} at a time, on {name} ({driver})\n",
                    keys.join(", ")
                ));
                self.waiting = waiting;
                if std::io::stderr().is_terminal() {
                    self.bar = Some(progress::bar(0, "{wide_bar} {percent:>3}%  {msg}"));
                }
            }
            SweepEvent::Begun { variant, first_step } => self.under_way.push((variant, first_step, None)),
            SweepEvent::Advanced { variant, progress } => {
                if let Some(entry) = self.under_way.iter_mut().find(|(number, ..)| *number == variant) {
                    entry.2 = Some(progress);
                }
                self.advanced();
            }
            SweepEvent::Ended { variant, summary } => self.ended(variant, summary),
            SweepEvent::Finishing => {
                if let Some(bar) = &self.bar {
                    bar.set_message("drawing plots");
                }
            }
            _ => {}
        }
    }

    fn ended(&mut self, variant: usize, summary: &VariantSummary) {
        if let Some(place) = self.under_way.iter().position(|(number, ..)| *number == variant) {
            let (_, first, progress) = self.under_way.remove(place);
            self.done += progress.map_or(0, |progress| progress.step.saturating_sub(first));
        }
        self.ended += 1;
        let what = match summary.state {
            VariantState::Failed => {
                let message = summary.failure.as_deref().unwrap_or_default();
                format!("failed: {}", message.lines().next().unwrap_or_default())
            }
            _ => format!("finished in {:.2} s", summary.wall_seconds),
        };
        let text = format!("{} of {}  {}  {what}", self.ended, self.waiting, summary.name);
        match &self.bar {
            Some(bar) => bar.suspend(|| line(&text)),
            None => line(&text),
        }
        self.advanced();
    }

    /// The bar counts the steps of all variants together.
    fn advanced(&self) {
        let Some(bar) = &self.bar else { return };
        let progresses = || self.under_way.iter().filter_map(|(_, first, progress)| Some((*first, (*progress)?)));
        let steps: u64 = progresses().map(|(first, progress)| progress.step.saturating_sub(first)).sum();
        let left: u64 = progresses().map(|(_, progress)| progress.last_step.saturating_sub(progress.step)).sum();
        let to_come = self.waiting.saturating_sub(self.ended + self.under_way.len()) as u64;
        // Variants still to come are taken to be as long as those so far.
        let so_far = (self.ended + self.under_way.len()).max(1) as u64;
        let done = self.done + steps;
        let rest = left + to_come * (done + left) / so_far;
        bar.set_length((done + rest).max(1));
        bar.set_position(done);
        let rate: f64 = progresses().map(|(_, progress)| progress.particle_steps_per_second).sum();
        let names: Vec<&str> =
            self.under_way.iter().map(|(number, ..)| self.sweep.variants()[*number].name.as_str()).collect();
        let elapsed = bar.elapsed().as_secs_f64();
        let remaining = Duration::try_from_secs_f64(elapsed * rest as f64 / done as f64).ok();
        let mut parts = vec![format!("{} of {}  {}", self.ended, self.waiting, names.join(" "))];
        if rate > 0.0 {
            parts.push(format!("{} particle-steps/s", prefixed(rate)));
        }
        if let Some(remaining) = remaining.filter(|_| done > 0) {
            parts.push(format!("{} left", duration(remaining.as_secs())));
        }
        bar.set_message(parts.join("  "));
    }
}

/// The table at the end and the files written.
pub fn results(outcome: &SweepOutcome, directory: &str) -> String {
    let variants = &outcome.summary.variants;
    let columns: Vec<&str> = SHOWN
        .into_iter()
        .filter(|name| variants.iter().any(|v| v.means.get(*name).and_then(printed_mean).is_some()))
        .collect();
    let mut header = vec!["VARIANT".to_owned()];
    header.extend(columns.iter().map(|name| name.replace('_', " ").to_uppercase()));
    header.push("TIME".to_owned());
    let mut rows = vec![header];
    let shown = |means: &Map<String, Value>, name: &str, spoilt| {
        means.get(name).and_then(printed_mean).map_or_else(String::new, |mean| marked(mean, spoilt))
    };
    for variant in variants {
        let mut row = vec![variant.name.clone()];
        if variant.state == VariantState::Finished {
            let spoilt = |name: &str| variant.unequilibrated.as_ref().is_some_and(|found| found.includes(name));
            row.extend(columns.iter().map(|name| shown(&variant.means, name, spoilt(name))));
            row.push(format!("{:.2} s", variant.wall_seconds));
        } else {
            row.push(variant.state.name().to_owned());
        }
        rows.push(row);
    }
    let averages = &outcome.summary.averages;
    if let Some(average) = averages.first() {
        rows.push(Vec::new());
        let mut header = vec![format!("MEAN OF {} SEEDS", average.seeds)];
        header.extend(columns.iter().map(|_| String::new()));
        rows.push(header);
        for average in averages {
            let mut row = vec![average.label.clone()];
            let spoilt = |name: &str| average.unequilibrated.iter().any(|known| known == name);
            row.extend(columns.iter().map(|name| shown(&average.means, name, spoilt(name))));
            rows.push(row);
        }
    }
    let mut note = String::new();
    if rows.iter().flatten().any(|cell| cell.trim_end_matches(" †").ends_with('*')) {
        note.push_str("  * from few samples: the error may be larger\n");
    }
    if rows.iter().flatten().any(|cell| cell.ends_with('†')) {
        let found = variants.iter().filter_map(|variant| variant.unequilibrated.clone());
        let all = found.reduce(Unequilibrated::and);
        let arguments = all.map_or_else(String::new, |all| format!(": try {}", all.arguments()));
        note = format!("{note}  † not yet in equilibrium{arguments}\n");
    }
    format!("{}{note}wrote {}/: {}\n", aligned(&rows, "  "), printable::name(directory), outcome.files.join(", "))
}
