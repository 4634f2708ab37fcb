//! Asking runs to stop before their end.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

/// Asks the runs that were given it, or a clone of it, to save a checkpoint and stop.
///
/// ```
/// use mesoscope::gpu::AdapterChoice;
/// use mesoscope::run::{Event, Interrupt, RunError, Run};
///
/// # let directory = tempfile::tempdir()?;
/// # let results = directory.path().join("results");
/// let small = ["space.box=[4,4,4]", "time.equilibration=0", "time.steps=4000", "output={}"].map(str::to_owned);
/// let scene = mesoscope::scene::load("dpd-fluid", &small)?;
/// let interrupt = Interrupt::default();
/// let run = Run::start(scene, &results).until(&interrupt);
/// let stopped = run.execute(&AdapterChoice::Best, &mut |event: Event<'_>| {
///     if matches!(event, Event::Advanced(_)) {
///         interrupt.ask();
///     }
/// });
/// let Err(RunError::Interrupted { checkpoint_step, .. }) = stopped else { panic!("{stopped:?}") };
///
/// // Nothing that was computed is lost.
/// let rest = Run::resume(&results, None)?;
/// assert!(checkpoint_step > 0 && rest.first_step() == checkpoint_step);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug, Clone, Default)]
pub struct Interrupt(Arc<AtomicBool>);

impl Interrupt {
    /// Asks them, from any thread.
    pub fn ask(&self) {
        self.0.store(true, Ordering::Relaxed);
    }

    /// What asks them once it is true, for handlers of signals.
    #[must_use]
    pub fn flag(&self) -> Arc<AtomicBool> {
        Arc::clone(&self.0)
    }

    /// Whether they have been asked.
    #[must_use]
    pub(crate) fn is_asked(&self) -> bool {
        self.0.load(Ordering::Relaxed)
    }
}
