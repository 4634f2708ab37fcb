//! The bar of progress on a terminal, and lines above it.

use std::io::IsTerminal as _;
use std::sync::mpsc::{RecvTimeoutError, Sender, channel};
use std::thread::JoinHandle;
use std::time::{Duration, Instant};

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

/// Says something while work goes on that has no steps: after a while, and again whenever as long as before has passed.
pub struct Patience {
    end: Option<Sender<()>>,
    thread: Option<JoinHandle<()>>,
}

impl Patience {
    /// Waits so long before the first word, which is given the time since.
    pub fn new(first: Duration, say: impl Fn(Duration) + Send + 'static) -> Self {
        let (end, ended) = channel();
        let begun = Instant::now();
        let wait = move || {
            let mut next = first;
            while ended.recv_timeout(next.saturating_sub(begun.elapsed())) == Err(RecvTimeoutError::Timeout) {
                say(begun.elapsed());
                next *= 2;
            }
        };
        // Without another thread there is only silence.
        let thread = std::thread::Builder::new().name("patience".to_owned()).spawn(wait).ok();
        Self { end: Some(end), thread }
    }
}

impl Drop for Patience {
    fn drop(&mut self) {
        self.end = None;
        if let Some(thread) = self.thread.take() {
            let _ = thread.join();
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::sync::Arc;
    use std::sync::atomic::{AtomicU32, Ordering};

    #[test]
    fn patience_ends_after_a_while_and_is_silent_before() {
        let said_within = |first: Duration, work: Duration| {
            let said = Arc::new(AtomicU32::new(0));
            let count = Arc::clone(&said);
            let patience = Patience::new(first, move |_| {
                count.fetch_add(1, Ordering::Relaxed);
            });
            std::thread::sleep(work);
            drop(patience);
            said.load(Ordering::Relaxed)
        };
        assert_eq!(said_within(Duration::from_mins(1), Duration::from_millis(5)), 0);
        // After 10, 20, 40 and more milliseconds.
        assert!((1..8).contains(&said_within(Duration::from_millis(10), Duration::from_millis(100))));
    }
}
