//! The environment that graphics drivers look into.

/// Begins the process again with what Mesa's drivers should find in their environment, where the user has not set it:
///
/// - `LP_NUM_THREADS`, the threads of the software adapter: two for each core. It deals the workgroups of a kernel out to
///   its threads once, in equal parts; with a thread a core all others wait for the one whose core is shared with
///   something else, while of two a core the scheduler makes the best.
/// - `XDG_RUNTIME_DIR`, where a container or a batch job has none, or one that is no absolute path: the layer that selects
///   devices looks for a display there, and without one writes an error to standard error for every adapter.
///
/// Both have to be there before the process has threads, so this is for the first line of `main`. On systems other than
/// Linux, and where the process cannot begin again, it does nothing.
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
