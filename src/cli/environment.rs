//! The environment that graphics drivers look into.

/// Begins again with `XDG_RUNTIME_DIR` set where it is not, as in a container or a batch job: Mesa's device selection
/// layer looks for a Wayland display there, and writes an error to standard error for every adapter if there is no
/// such variable. It has to be set before the program starts: setting it later is not safe beside other threads.
#[cfg(target_os = "linux")]
pub fn quieten_drivers() {
    use std::os::unix::process::CommandExt as _;

    const VARIABLE: &str = "XDG_RUNTIME_DIR";
    if std::env::var_os(VARIABLE).is_none()
        && let Ok(program) = std::env::current_exe()
    {
        // On success this does not return; otherwise a little noise is no reason to fail.
        let _ =
            std::process::Command::new(program).args(std::env::args_os().skip(1)).env(VARIABLE, "/nonexistent").exec();
    }
}

/// Nothing to do here.
#[cfg(not(target_os = "linux"))]
pub fn quieten_drivers() {}
