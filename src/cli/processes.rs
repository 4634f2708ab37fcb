//! The copies of the program that a launcher of MPI has started, which share a run as its ranks.

use mesoscope::ranks::Processes;

#[cfg(feature = "mpi")]
use super::launcher;
use super::{AdapterArgument, Failure};

/// What the first of several copies does with them, or a copy that is alone without.
type Work<'w> = &'w dyn Fn(Option<&dyn Processes>) -> Result<(), Failure>;

/// Does the work of the first copy, or what the first tells this one. A copy that is alone does the work alone.
#[cfg(feature = "mpi")]
pub fn share(adapter: &AdapterArgument, work: Work<'_>) -> Result<(), Failure> {
    use std::sync::Arc;
    use std::sync::atomic::AtomicBool;
    use std::time::Duration;

    use mesoscope::ranks::mpi::{World, abort};
    use mesoscope::run;

    if !launcher::is_copy() {
        return work(None);
    }
    let patience = std::env::var("MESOSCOPE_PATIENCE").ok().and_then(|seconds| seconds.parse().ok());
    let alarm = |reason: &str| super::line(&format!("error: {reason}"));
    let world = World::join(patience.map(Duration::from_secs), alarm).map_err(Failure::no_adapter)?;
    let show = std::panic::take_hook();
    std::panic::set_hook(Box::new(move |panic| {
        // The others would wait for this one until they lose their patience.
        show(panic);
        abort(101);
    }));
    let rank = world.rank();
    panic_if_asked(rank);
    if rank > 0 {
        // Requests to stop are for the first.
        let _ = super::interruption::interrupt(&Arc::new(AtomicBool::new(true)));
        return Ok(run::follow(&world, rank, &adapter.choice_of_copy())?);
    }
    let done = work(Some(&world));
    run::dismiss(&world)?;
    done
}

/// What the test of the hook asks for.
#[cfg(all(feature = "mpi", debug_assertions))]
fn panic_if_asked(rank: u32) {
    let asked = std::env::var("MESOSCOPE_TEST_PANIC").is_ok_and(|asked| asked == rank.to_string());
    assert!(!asked, "asked to panic");
}

#[cfg(all(feature = "mpi", not(debug_assertions)))]
fn panic_if_asked(_: u32) {}

/// The same of a program that was built without MPI: copies have been refused.
#[cfg(not(feature = "mpi"))]
pub fn share(_: &AdapterArgument, work: Work<'_>) -> Result<(), Failure> {
    work(None)
}
