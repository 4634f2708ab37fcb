//! Signals that ask to stop: an interrupt from the keyboard, the end of a job's time or a warning before it, or a terminal that is
//! closed.

use std::io;
use std::sync::Arc;
use std::sync::atomic::AtomicBool;

use mesoscope::run::Interrupt;
use signal_hook::consts::{SIGINT, SIGTERM};
use signal_hook::flag;

use super::failure::INTERRUPTED;

/// What the first signal asks: to save a checkpoint and stop.
///
/// A second interrupt from the keyboard ends the process at once, and so does any signal that comes a second or more after
/// the first. Those that come sooner are the same request: `timeout` and some batch systems send theirs twice, to the process
/// and to its group.
///
/// Until `begun` there is nothing to save: the first signal ends the process at once, whatever it is doing.
pub fn interrupt(begun: &Arc<AtomicBool>) -> Interrupt {
    let interrupt = Interrupt::default();
    let again = Arc::new(AtomicBool::new(false));
    // Without its handler a signal ends the process at once, and the last checkpoint is left.
    for signal in requests() {
        let _ = flag::register(signal, interrupt.flag());
    }
    let _ = end_at_second(SIGINT, &again);
    #[cfg(unix)]
    let _ = timely::end(&requests(), begun);
    #[cfg(not(unix))]
    let _ = (end_at_second(SIGTERM, &Arc::default()), begun);
    interrupt
}

fn end_at_second(signal: i32, first: &Arc<AtomicBool>) -> io::Result<()> {
    // In this order: a signal does the second when the first has not ended the process.
    flag::register_conditional_shutdown(signal, INTERRUPTED.into(), Arc::clone(first))?;
    flag::register(signal, Arc::clone(first))?;
    Ok(())
}

fn requests() -> Vec<i32> {
    // Batch systems warn with one of the user's signals, which launchers of MPI pass on where they take SIGTERM for themselves.
    #[cfg(unix)]
    let others = [signal_hook::consts::SIGUSR1, signal_hook::consts::SIGUSR2]
        .into_iter()
        .chain((!hangup::is_ignored()).then_some(signal_hook::consts::SIGHUP));
    #[cfg(not(unix))]
    let others = [];
    [SIGINT, SIGTERM].into_iter().chain(others).collect()
}

#[cfg(unix)]
mod timely {
    use std::io;
    use std::sync::Arc;
    use std::sync::atomic::{AtomicBool, Ordering};
    use std::thread;
    use std::time::{Duration, Instant};

    use mesoscope::run::RunError;
    use signal_hook::iterator::Signals;
    use signal_hook::low_level;

    use crate::cli::failure::INTERRUPTED;
    use crate::cli::line;

    /// Signals within this time of the first say the same.
    const SAME_REQUEST: Duration = Duration::from_secs(1);

    /// Ends the process at a signal that comes before there is something to save, or late after the first.
    pub fn end(signals: &[i32], begun: &Arc<AtomicBool>) -> io::Result<()> {
        let mut signals = Signals::new(signals)?;
        let begun = Arc::clone(begun);
        thread::Builder::new().name("signals".to_owned()).spawn(move || {
            let mut first = None;
            for _ in &mut signals {
                if !begun.load(Ordering::Relaxed) {
                    line(&RunError::NotBegun.to_string());
                    low_level::exit(INTERRUPTED.into());
                }
                let first: &mut Instant = first.get_or_insert_with(Instant::now);
                if first.elapsed() >= SAME_REQUEST {
                    // Nothing is tidied up: what is on the disk is good at any time.
                    low_level::exit(INTERRUPTED.into());
                }
            }
        })?;
        Ok(())
    }
}

#[cfg(unix)]
mod hangup {
    use std::process::{Command, Stdio};

    use signal_hook::consts::SIGHUP;

    /// Whether the program was started to keep running when its terminal is closed, as by `nohup`.
    pub fn is_ignored() -> bool {
        listed().or_else(tried).unwrap_or(false)
    }

    /// What Linux says of this process.
    pub(super) fn listed() -> Option<bool> {
        let status = std::fs::read_to_string("/proc/self/status").ok()?;
        let mask = status.lines().find_map(|line| line.strip_prefix("SigIgn:"))?;
        let mask = u64::from_str_radix(mask.trim(), 16).ok()?;
        Some(mask >> (SIGHUP - 1) & 1 == 1)
    }

    /// What becomes of a child, which ignores what this process ignores.
    pub(super) fn tried() -> Option<bool> {
        let mut shell = Command::new("sh");
        shell.args(["-c", "kill -HUP $$"]).stdin(Stdio::null()).stdout(Stdio::null()).stderr(Stdio::null());
        Some(shell.status().ok()?.success())
    }
}

#[cfg(all(test, target_os = "linux"))]
mod tests {
    use super::hangup;

    #[test]
    fn a_child_ignores_what_its_parent_does() {
        assert!(hangup::listed().is_some());
        assert_eq!(hangup::tried(), hangup::listed());
    }
}
