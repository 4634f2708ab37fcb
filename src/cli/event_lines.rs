//! Lines of JSON on standard error that say how far a run is, for programs that read them.

use std::time::{Duration, Instant};

use mesoscope::run::{Event, Outcome};
use serde_json::{Value, json};

use super::print::write_error;

/// How a run says how far it is.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, clap::ValueEnum)]
pub enum Form {
    /// A bar, or lines where standard error is no terminal
    #[default]
    Words,
    /// A line of JSON for each event, at most one a second for steps
    Json,
}

/// The arguments of `run` and `resume` about what is written and told.
#[derive(Debug, clap::Args)]
pub struct WritingArguments {
    /// Write numbers only; `mesoscope plot DIR` draws the pictures of the end
    #[arg(long, help_heading = super::heading::OUTPUT)]
    pub no_pictures: bool,

    /// How progress is reported on standard error
    #[arg(long, help_heading = super::heading::OUTPUT, value_name = "FORM", value_enum, default_value_t, conflicts_with = "quiet")]
    pub progress: Form,
}

/// Between two lines about steps.
const PAUSE: Duration = Duration::from_secs(1);

/// The lines of a run.
#[derive(Debug, Default)]
pub struct EventLines {
    /// When the last line about steps was written.
    advanced: Option<Instant>,
}

impl EventLines {
    /// A warning, or a note.
    pub fn warn(warning: &str) {
        write(&json!({"event": "warned", "warning": warning}));
    }

    /// An event of the run.
    pub fn show(&mut self, event: &Event<'_>) {
        match event {
            Event::Started { adapter, first_step, last_step } => {
                let adapter = adapter.in_words();
                write(
                    &json!({"event": "started", "adapter": adapter, "first_step": first_step, "last_step": last_step}),
                );
            }
            Event::Compiling { kernels } => write(&json!({"event": "compiling", "kernels": kernels})),
            Event::Warned { warning } => Self::warn(warning),
            Event::Advanced(progress) => {
                let is_last = progress.step == progress.last_step;
                if !is_last && self.advanced.is_some_and(|advanced| advanced.elapsed() < PAUSE) {
                    return;
                }
                self.advanced = Some(Instant::now());
                write(&json!({
                    "event": "advanced",
                    "step": progress.step,
                    "last_step": progress.last_step,
                    "particle_steps_per_second": progress.particle_steps_per_second,
                    "seconds_left": progress.remaining.map(|remaining| remaining.as_secs_f64()),
                    "temperature": progress.temperature,
                }));
            }
            Event::Repeating { from, reason, with } => {
                write(&json!({"event": "repeating", "from_step": from, "reason": reason, "with": with}));
            }
            Event::Stage { number, of } => write(&json!({"event": "stage", "number": number + 1, "of": of})),
            Event::Finishing => write(&json!({"event": "finishing"})),
            _ => {}
        }
    }

    /// The end of the run.
    pub fn finish(outcome: &Outcome) {
        write(&json!({"event": "finished", "files": outcome.files, "snapshots": outcome.snapshots}));
    }
}

fn write(line: &Value) {
    write_error(&line.to_string());
}
