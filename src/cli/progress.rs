//! The bar of progress on a terminal, and lines above it.

use std::io::IsTerminal as _;

use indicatif::{ProgressBar, ProgressStyle};

use super::line;

/// A bar of this length at a position, hidden where standard error is no terminal; `template` says what stands around
/// it.
pub fn bar(position: u64, length: u64, template: &str) -> ProgressBar {
    if !std::io::stderr().is_terminal() {
        return ProgressBar::hidden();
    }
    let style = ProgressStyle::with_template(template).unwrap_or_else(|_| ProgressStyle::default_bar());
    ProgressBar::new(length).with_style(style.progress_chars("━╸ ")).with_position(position)
}

/// Prints a line above a bar.
pub fn say(bar: &ProgressBar, text: &str) {
    bar.suspend(|| line(text));
}
