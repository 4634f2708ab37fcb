//! The bar of progress on a terminal, and lines above it.

use std::io::IsTerminal as _;

use indicatif::{ProgressBar, ProgressStyle};

use super::line;

/// A bar, once it has begun and if standard error is a terminal.
#[derive(Default)]
pub struct Bar(pub Option<ProgressBar>);

impl Bar {
    /// Begins a bar of this length at a position; `template` says what stands around it.
    pub fn begin(&mut self, position: u64, length: u64, template: &str) {
        if std::io::stderr().is_terminal() {
            let style = ProgressStyle::with_template(template).unwrap_or_else(|_| ProgressStyle::default_bar());
            let bar = ProgressBar::new(length).with_style(style.progress_chars("━╸ "));
            self.0 = Some(bar.with_position(position));
        }
    }

    /// Prints a line above the bar.
    pub fn say(&self, text: &str) {
        match &self.0 {
            Some(bar) => bar.suspend(|| line(text)),
            None => line(text),
        }
    }

    /// Says beside the bar what is being done.
    pub fn announce(&self, message: &'static str) {
        if let Some(bar) = &self.0 {
            bar.set_message(message);
        }
    }

    /// Takes the bar away.
    pub fn clear(&mut self) {
        if let Some(bar) = self.0.take() {
            bar.finish_and_clear();
        }
    }
}
