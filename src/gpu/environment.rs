//! The environment variables of graphics drivers.

/// Restarts the process with the environment variables that Mesa's drivers need, where the user has not set them:
///
/// - `LP_NUM_THREADS`, the threads of the software adapter: two per core. The adapter divides the workgroups of a kernel among its
///   threads once, in equal parts. With one thread per core, all of them wait for the one whose core is shared with another process;
///   with two, the scheduler can balance them.
/// - `XDG_RUNTIME_DIR`, where a container or a batch job has none, or one that is not an absolute path: the layer that selects
///   devices looks for a display there, and without one it writes an error to standard error for every adapter.
///
/// Both must be set before the process has threads, so call this in the first line of `main`. On systems other than Linux, and where
/// the process cannot be restarted, it does nothing.
///
/// ```no_run
/// fn main() -> Result<(), Box<dyn std::error::Error>> {
///     mesoscope::gpu::prepare_environment();
///     let gpu = mesoscope::gpu::Gpu::open(&Default::default(), Default::default())?;
///     println!("{}", gpu.description().name);
///     Ok(())
/// }
/// ```
#[cfg(target_os = "linux")]
pub fn prepare_environment() {
    use std::os::unix::process::CommandExt as _;

    let cores = std::thread::available_parallelism().map_or(1, std::num::NonZero::get);
    let wanted = [("LP_NUM_THREADS", (2 * cores).to_string()), ("XDG_RUNTIME_DIR", "/nonexistent".to_owned())];
    let set = |variable: &str| match std::env::var_os(variable) {
        Some(path) if variable == "XDG_RUNTIME_DIR" => std::path::Path::new(&path).is_absolute(),
        found => found.is_some(),
    };
    let missing: Vec<_> = wanted.into_iter().filter(|(variable, _)| !set(variable)).collect();
    if !missing.is_empty()
        && let Ok(program) = std::env::current_exe()
    {
        // On success this does not return; otherwise a slower or noisier driver is no reason to fail.
        let _ = std::process::Command::new(program).args(std::env::args_os().skip(1)).envs(missing).exec();
    }
}

/// Nothing to do here.
#[cfg(not(target_os = "linux"))]
pub fn prepare_environment() {}
