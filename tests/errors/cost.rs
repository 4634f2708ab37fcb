//! What an answer costs: time, and heap that an allocator counts.

use std::panic::{AssertUnwindSafe, catch_unwind};
use std::process::Command;
use std::sync::{Mutex, PoisonError};
use std::thread;
use std::time::{Duration, Instant};

use mesoscope::engine::Engine;
use mesoscope::gpu::{AdapterChoice, Gpu, Requirements};
use mesoscope::plan::{Hardware, Options};
use mesoscope::{families, run, scene};
use peak_alloc::PeakAlloc;

#[global_allocator]
static ALLOCATOR: PeakAlloc = PeakAlloc;

/// Bytes of heap that an answer may take, with what other tests of this program take meanwhile: a tenth of that, rarely a quarter.
pub const MEMORY: usize = 256 << 20;

/// A second or two on a machine that has nothing else to do; tests run beside each other, and this is to notice what has no end.
pub const PATIENCE: Duration = Duration::from_secs(20);

/// What an answer cost.
pub struct Cost {
    pub time: Duration,
    pub memory: usize,
}

/// Particles pass to the adapter and back in stretches: a state takes hardly more memory than itself, as `check` says.
#[test]
fn a_state_takes_as_much_memory_as_expected() {
    // In a process of its own: what other tests allocate meanwhile is as much.
    const ALONE: &str = "MESOSCOPE_MEASURED_ALONE";
    if std::env::var_os(ALONE).is_none() {
        let this = ["--exact", "cost::a_state_takes_as_much_memory_as_expected", "--nocapture"];
        let output = Command::new(std::env::current_exe().unwrap()).args(this).env(ALONE, "1").output().unwrap();
        let said = String::from_utf8_lossy(&output.stderr);
        assert!(output.status.success() && String::from_utf8_lossy(&output.stdout).contains("1 passed"), "{said}");
        return;
    }
    let peak = |edge: u32| {
        let set = [format!("space.box=[{edge},50,40]"), r#"output={"energies":{"every":2}}"#.to_owned()];
        let scene = scene::load("dpd-fluid", &set).unwrap();
        let plan = run::plan(&scene, Hardware::default(), Options::default());
        let requirements =
            Requirements { portable: true, largest_buffer: plan.largest_buffer(), ..Requirements::default() };
        let gpu = Gpu::open(&AdapterChoice::Best, requirements).unwrap();
        let expected = plan.host_bytes();
        let (state, cost) = measured(|| {
            let start = families::initial_state(&scene);
            let mut engine = Engine::new(&gpu, plan, &start).unwrap();
            drop(start);
            engine.advance(1, 1).unwrap();
            engine.state().unwrap()
        });
        assert_eq!(state.unwrap().len() as u64, scene.model().particle_count());
        [cost.memory as f64, expected as f64]
    };
    let [small, large] = [30, 90].map(peak);
    let [found, expected] = [large[0] - small[0], large[1] - small[1]];
    assert!(found > expected / 2.0 && found < 1.15 * expected, "{found} bytes more, where {expected} are expected");
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
