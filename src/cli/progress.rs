//! The bar of progress on a terminal.

use indicatif::{ProgressBar, ProgressStyle};

/// A bar with this length; `template` says what stands around it.
pub fn bar(length: u64, template: &str) -> ProgressBar {
    let style = ProgressStyle::with_template(template).unwrap_or_else(|_| ProgressStyle::default_bar());
    ProgressBar::new(length).with_style(style.progress_chars("━╸ "))
}
