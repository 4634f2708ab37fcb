//! Signals that ask to stop: an interrupt from the keyboard, or the end of a job's time.

use std::io;

use mesoscope::run::Interrupt;
use signal_hook::consts::{SIGINT, SIGTERM};
use signal_hook::flag;

use super::failure::INTERRUPTED;

/// What the first signal asks; the second ends the process at once.
pub fn interrupt() -> Interrupt {
    let interrupt = Interrupt::default();
    for signal in [SIGINT, SIGTERM] {
        // Without its handler a signal ends the process at once, and the last checkpoint is left.
        let _ = handle(signal, &interrupt);
    }
    interrupt
}

fn handle(signal: i32, interrupt: &Interrupt) -> io::Result<()> {
    // In this order: a signal does the second when the first has not ended the process.
    flag::register_conditional_shutdown(signal, INTERRUPTED.into(), interrupt.flag())?;
    flag::register(signal, interrupt.flag())?;
    Ok(())
}
