//! How far many runs are: a bar on a terminal, and a line for every run.

use std::fmt::Display;
use std::time::Duration;

use indicatif::ProgressBar;
use mesoscope::numbers::prefixed;
use mesoscope::printable;
use mesoscope::run::Progress;
use mesoscope::study::{Kind, StudyEvent};

use super::print;
use super::progress::{bar, say};
use super::report::duration;

/// Parts of a run that a bar can show.
const PARTS: f64 = 1000.0;

/// Shows how far a study is.
pub struct Reporter {
    title: String,
    kind: &'static Kind,
    pub bar: ProgressBar,
    /// Runs under way, with their first steps.
    under_way: Vec<(String, u64, Option<Progress>)>,
    runs: usize,
    ended: usize,
}

impl Reporter {
    pub fn new(title: &str, kind: &'static Kind) -> Self {
        let title = printable::name(title).into_owned();
        Self { title, kind, bar: ProgressBar::hidden(), under_way: Vec::new(), runs: 0, ended: 0 }
    }

    pub fn show<E: Display, P: Display>(&mut self, event: &StudyEvent<'_, E, P>, in_words: &dyn Fn(usize) -> String) {
        match *event {
            StudyEvent::Started { adapter, runs, at_once, seconds } => {
                let estimate = self.kind.estimate;
                let time = seconds.map(|seconds| format!(", {estimate} {}", duration(seconds.ceil() as u64)));
                // A closed standard output will be noticed when the results are printed.
                let _ = print(&format!(
                    "{}: {}, {at_once} at a time, on {}{}\n",
                    self.title,
                    in_words(runs),
                    adapter.in_words(),
                    time.unwrap_or_default()
                ));
                self.runs = runs;
                self.bar = bar(0, 0, "{wide_bar} {percent:>3}%  {msg}");
            }
            StudyEvent::Begun { run, first_step } => self.under_way.push((run.to_owned(), first_step, None)),
            StudyEvent::Advanced { run, progress } => {
                if let Some(entry) = self.under_way.iter_mut().find(|(name, ..)| name == run) {
                    entry.2 = Some(progress);
                }
                self.advanced();
            }
            StudyEvent::Ended { run, ended } => {
                self.under_way.retain(|(name, ..)| name != run);
                self.ended += 1;
                say(&self.bar, &format!("{} of {}  {run}  {ended}", self.ended, self.runs));
                self.advanced();
            }
            StudyEvent::Phase { phase, runs } => {
                self.runs += runs;
                say(&self.bar, &phase.to_string());
                self.advanced();
            }
            StudyEvent::Finishing => self.bar.set_message("drawing"),
            _ => {}
        }
    }

    /// The bar counts runs, those under way by the part of their steps that is done.
    fn advanced(&self) {
        let progresses = || self.under_way.iter().filter_map(|(_, first, progress)| Some((*first, (*progress)?)));
        let parts = progresses().map(|(first, progress)| {
            let all = progress.last_step.saturating_sub(first).max(1);
            progress.step.saturating_sub(first) as f64 / all as f64
        });
        let (done, all) = (self.ended as f64 + parts.sum::<f64>(), self.runs.max(1) as f64);
        self.bar.set_length((PARTS * all) as u64);
        self.bar.set_position((PARTS * done) as u64);
        let names: Vec<&str> = self.under_way.iter().map(|(name, ..)| name.as_str()).collect();
        let mut words = vec![format!("{} of {}  {}", self.ended, self.runs, names.join(" "))];
        let rate: f64 = progresses().map(|(_, progress)| progress.particle_steps_per_second).sum();
        if rate > 0.0 {
            words.push(format!("{} particle-steps/s", prefixed(rate)));
        }
        // Runs still to come are taken to be as long as those so far.
        let remaining = Duration::try_from_secs_f64(self.bar.elapsed().as_secs_f64() * (all - done) / done).ok();
        if let Some(remaining) = remaining.filter(|_| done > 0.0) {
            words.push(format!("{} left", duration(remaining.as_secs())));
        }
        self.bar.set_message(words.join("  "));
    }
}
