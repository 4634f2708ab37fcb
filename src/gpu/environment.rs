//! The environment variables of graphics drivers.

use super::GpuError;

/// Plans that the environment requests.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum RequestedPlans {
    /// Those that suit the adapter.
    Suitable,
    /// Those that every GPU gets, on software adapters too.
    Portable,
    /// The same, but the lanes of a workgroup share a queue of pairs.
    PortableWithQueue,
}

impl RequestedPlans {
    /// Reads `MESOSCOPE_PLAN`.
    pub(super) fn from_environment() -> Result<Self, GpuError> {
        match std::env::var_os("MESOSCOPE_PLAN") {
            None => Ok(Self::Suitable),
            Some(value) if value == "gpu" => Ok(Self::Portable),
            Some(value) if value == "gpu-queue" => Ok(Self::PortableWithQueue),
            Some(value) => Err(GpuError::Plan { found: value.to_string_lossy().into_owned() }),
        }
    }
}

/// The environment variables that Mesa's drivers need and that are not set, for one of so many processes that share a machine:
///
/// - `LP_NUM_THREADS`, the threads of the software adapter: two for each core of its share. The adapter divides the workgroups of a kernel
///   among its threads once, in equal parts. With one thread per core, all of them wait for the one whose core is shared with another
///   process; with two, the scheduler can balance them.
/// - `XDG_RUNTIME_DIR`, where a container or a batch job has none, or one that is not an absolute path: the layer that selects
///   devices looks for a display there, and without one it writes an error to standard error for every adapter.
///
/// Drivers read them when they load, and a process with threads cannot set them: whoever starts it has to. The program starts itself again with
/// them. On systems other than Linux there are none.
///
/// ```
/// let missing = mesoscope::gpu::driver_environment(1);
/// assert!(missing.iter().all(|(name, _)| ["LP_NUM_THREADS", "XDG_RUNTIME_DIR"].contains(name)));
/// ```
#[must_use]
#[cfg(target_os = "linux")]
pub fn driver_environment(processes: usize) -> Vec<(&'static str, String)> {
    let own = std::thread::available_parallelism().map_or(1, std::num::NonZero::get);
    let threads = 2 * cores_of_one(own, machine::cores(), processes);
    let wanted = [("LP_NUM_THREADS", threads.to_string()), ("XDG_RUNTIME_DIR", "/nonexistent".to_owned())];
    let set = |variable: &str| match std::env::var_os(variable) {
        Some(path) if variable == "XDG_RUNTIME_DIR" => std::path::Path::new(&path).is_absolute(),
        found => found.is_some(),
    };
    wanted.into_iter().filter(|(variable, _)| !set(variable)).collect()
}

/// None here.
#[must_use]
#[cfg(not(target_os = "linux"))]
pub fn driver_environment(_: usize) -> Vec<(&'static str, String)> {
    Vec::new()
}

/// The cores that one of several processes of a machine should take: those that it may run on, or fewer where all may run on the same.
#[cfg(target_os = "linux")]
fn cores_of_one(own: usize, machine: Option<usize>, processes: usize) -> usize {
    let share = machine.unwrap_or(own) / processes.max(1);
    share.clamp(1, own.max(1))
}

#[cfg(target_os = "linux")]
mod machine {
    /// The cores of the machine, whichever of them this process may run on.
    pub(super) fn cores() -> Option<usize> {
        number(&std::fs::read_to_string("/sys/devices/system/cpu/online").ok()?)
    }

    /// The number of entries of a list like `0-3,8-11`.
    pub(super) fn number(list: &str) -> Option<usize> {
        list.trim().split(',').try_fold(0, |sum, part| {
            let (first, last) = part.split_once('-').unwrap_or((part, part));
            let [first, last]: [usize; 2] = [first.parse().ok()?, last.parse().ok()?];
            Some(sum + last.checked_sub(first)? + 1)
        })
    }
}

#[cfg(all(test, target_os = "linux"))]
mod tests {
    use super::{cores_of_one, machine};

    #[test]
    fn processes_share_the_cores_of_a_machine() {
        assert_eq!(cores_of_one(8, Some(8), 1), 8);
        assert_eq!(cores_of_one(8, Some(8), 3), 2);
        assert_eq!(cores_of_one(2, Some(2), 5), 1);
        // A launcher that binds copies has shared the cores out already.
        assert_eq!(cores_of_one(2, Some(8), 4), 2);
        assert_eq!(cores_of_one(4, None, 2), 2);
        assert_eq!(["0", "0-3", "0-3,8-11"].map(machine::number), [Some(1), Some(4), Some(8)]);
        assert_eq!(["", "3-0", "x"].map(machine::number), [None; 3]);
        assert!(machine::cores().is_none_or(|cores| cores > 0));
    }
}
