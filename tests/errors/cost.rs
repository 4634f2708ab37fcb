//! What an answer costs: time, and heap that an allocator counts.

use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::{Mutex, PoisonError};
use std::thread;
use std::time::{Duration, Instant};

use peak_alloc::PeakAlloc;

#[global_allocator]
static ALLOCATOR: PeakAlloc = PeakAlloc;

/// Bytes of heap that an answer may take. Other tests of this program that run meanwhile take a tenth of that.
pub const MEMORY: usize = 200 << 20;

/// A second or two on a machine that has nothing else to do; tests run beside each other, and this is to notice what has no end.
pub const PATIENCE: Duration = Duration::from_secs(20);

/// What an answer cost.
pub struct Cost {
    pub time: Duration,
    pub memory: usize,
}

/// Does some work, and says what it gave, or how it panicked, and what it cost.
pub fn measured<T>(work: impl FnOnce() -> T) -> (thread::Result<T>, Cost) {
    // Allocations are counted for all threads together: one measurement at a time.
    static TURN: Mutex<()> = Mutex::new(());
    let _turn = TURN.lock().unwrap_or_else(PoisonError::into_inner);
    let before = ALLOCATOR.current_usage();
    ALLOCATOR.reset_peak_usage();
    let start = Instant::now();
    let result = catch_unwind(AssertUnwindSafe(work));
    (result, Cost { time: start.elapsed(), memory: ALLOCATOR.peak_usage().saturating_sub(before) })
}
