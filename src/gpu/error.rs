//! What can go wrong between the program and the adapter.

use super::portions::Undivided;
use crate::shaders::Unlinked;

/// A failure of the graphics layer.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum GpuError {
    /// No adapter at all.
    #[error("no usable graphics adapter was found\n{}", install_hint())]
    NoAdapter,
    /// No adapter by that name or number.
    #[error("no adapter matches `{wanted}`; adapters here: {available}")]
    NoSuchAdapter {
        /// What was asked for.
        wanted: String,
        /// The available adapters.
        available: String,
    },
    /// The adapter cannot do what the scene needs.
    #[error("adapter `{adapter}` allows at most {allowed} {quantity}, but this scene needs {needed}")]
    TooSmall {
        /// Name of the adapter.
        adapter: String,
        /// The name of the limit.
        quantity: &'static str,
        /// What the adapter allows.
        allowed: u64,
        /// What the scene needs.
        needed: u64,
    },
    /// The environment requests plans that are unknown.
    #[error(
        "MESOSCOPE_PLAN is `{found}`; accepted: `gpu`, for the plans that every GPU gets, `gpu-queue`, for the same with a queue of pairs, or no such variable"
    )]
    Plan {
        /// The value of the variable.
        found: String,
    },
    /// The device could not be opened.
    #[error("adapter `{adapter}` could not be opened: {reason}")]
    Open {
        /// Name of the adapter.
        adapter: String,
        /// The driver's message.
        reason: String,
    },
    /// A shader does not compile.
    #[error("shader `{kernel}` is not valid: {place}: {reason}")]
    Shader {
        /// Name of the kernel.
        kernel: String,
        /// File and line, where known.
        place: String,
        /// The compiler's message.
        reason: String,
    },
    /// The device ran out of memory.
    #[error(
        "adapter `{adapter}` ran out of memory while {doing} ({bytes} bytes); use fewer particles or another adapter"
    )]
    OutOfMemory {
        /// Name of the adapter.
        adapter: String,
        /// What was being done.
        doing: String,
        /// How many bytes it needed.
        bytes: u64,
    },
    /// The device was lost or did not answer.
    #[error("adapter `{adapter}` stopped answering: {reason}")]
    Lost {
        /// Name of the adapter.
        adapter: String,
        /// The driver's message.
        reason: String,
    },
    /// A call was refused by validation: a defect of this program.
    #[error("the graphics layer refused a call while {doing}: {reason} (a defect of mesoscope; please report it)")]
    Refused {
        /// What was being done.
        doing: String,
        /// The validation message.
        reason: String,
    },
}

fn install_hint() -> String {
    hidden_drivers().unwrap_or_else(|| driver_hint().to_owned())
}

/// The variable of the environment, if there is one, by which Vulkan's loader looks at no other drivers, with the remedy.
pub(super) fn hidden_drivers() -> Option<String> {
    let narrowed =
        ["VK_DRIVER_FILES", "VK_ICD_FILENAMES"].into_iter().find_map(|name| Some((name, std::env::var(name).ok()?)));
    let (name, value) = narrowed.filter(|_| cfg!(target_os = "linux"))?;
    Some(format!(
        "the variable {name} hides all Vulkan drivers but `{value}`: unset it, or let it name a driver that is there"
    ))
}

fn driver_hint() -> &'static str {
    if cfg!(target_os = "linux") {
        "install a Vulkan driver; without a GPU the software driver serves: \
         apt-get install mesa-vulkan-drivers libvulkan1 (Debian, Ubuntu), dnf install mesa-vulkan-drivers vulkan-loader (Fedora), \
         pacman -S vulkan-swrast vulkan-icd-loader (Arch)"
    } else if cfg!(target_os = "windows") {
        "install your graphics card's driver; DirectX 12 or Vulkan is needed"
    } else {
        "Metal (macOS 10.13 or later) is needed"
    }
}

impl GpuError {
    /// A kernel that cannot do with a part of an array.
    pub(super) fn undivided(kernel: &str, undivided: Undivided) -> Self {
        Self::Refused { doing: format!("making kernel `{kernel}`"), reason: undivided.to_string() }
    }

    /// A kernel that does not link.
    #[must_use]
    pub fn unlinked(kernel: &str, unlinked: Unlinked) -> Self {
        Self::Shader {
            kernel: kernel.to_owned(),
            place: format!("shaders/{}", unlinked.place),
            reason: unlinked.reason,
        }
    }
}
