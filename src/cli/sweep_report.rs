//! What a sweep tells its user: a line at the start, progress, a table at the end.

use std::io::IsTerminal as _;
use std::time::Duration;

use indicatif::{ProgressBar, ProgressStyle};
use mesoscope::printable;
use mesoscope::run::Progress;
use mesoscope::scene;
use mesoscope::sweep::{Sweep, SweepEvent, SweepOutcome, VariantState, VariantSummary};

use super::report::{duration, mean};
use super::table::{aligned, prefixed};
use super::{line, print};

/// Columns of the table at the end, where a variant has them.
const SHOWN: [&str; 4] = ["total_energy", "temperature", "configurational_temperature", "pressure"];

/// Tells how far a sweep is: a bar on a terminal, otherwise a line for every variant.
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

impl Reporter {
    pub fn new(sweep: Sweep) -> Self {
        Self { sweep, bar: None, under_way: Vec::new(), done: 0, ended: 0, waiting: 0 }
    }

    /// Warnings about the scenes; one that all variants share is said once.
    pub fn warn(&self) {
        let variants = self.sweep.variants();
        let mut known: Vec<(String, Vec<&str>)> = Vec::new();
        for variant in variants {
            let notices = variant.notices.iter().map(|notice| format!("note: {notice}"));
            let warnings = scene::warnings(&variant.scene);
            for text in notices.chain(warnings.iter().map(|warning| format!("warning: {warning}"))) {
                match known.iter_mut().find(|(other, _)| *other == text) {
                    Some((_, names)) => names.push(&variant.name),
                    None => known.push((text, vec![&variant.name])),
                }
            }
        }
        for (text, names) in known {
            let place =
                if names.len() == variants.len() { String::new() } else { format!(" (`{}`)", names.join("`, `")) };
            line(&format!("{text}{place}"));
        }
    }

    pub fn clear(&mut self) {
        if let Some(bar) = self.bar.take() {
            bar.finish_and_clear();
        }
    }

    pub fn tell(&mut self, event: SweepEvent<'_>) {
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
                    let bar = ProgressBar::new(0);
                    let style = ProgressStyle::with_template("{wide_bar} {percent:>3}%  {msg}");
                    bar.set_style(style.unwrap_or_else(|_| ProgressStyle::default_bar()).progress_chars("━╸ "));
                    self.bar = Some(bar);
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
    let columns: Vec<&str> =
        SHOWN.into_iter().filter(|name| variants.iter().any(|v| mean(&v.means, name).is_some())).collect();
    let mut header = vec!["VARIANT".to_owned()];
    header.extend(columns.iter().map(|name| name.replace('_', " ").to_uppercase()));
    header.push("TIME".to_owned());
    let mut rows = vec![header];
    for variant in variants {
        let mut row = vec![variant.name.clone()];
        if variant.state == VariantState::Finished {
            row.extend(columns.iter().map(|name| mean(&variant.means, name).unwrap_or_default()));
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
            row.extend(columns.iter().map(|name| mean(&average.means, name).unwrap_or_default()));
            rows.push(row);
        }
    }
    let unsettled = rows.iter().flatten().any(|cell| cell.ends_with('*'));
    let note = if unsettled { "  * from few samples: the error may be larger\n" } else { "" };
    format!("{}{note}wrote {}/: {}\n", aligned(&rows, "  "), printable::name(directory), outcome.files.join(", "))
}
