//! The available adapters, and the choice of one.

use super::GpuError;

/// The adapter to use.
///
/// ```
/// use mesoscope::prelude::*;
///
/// assert_eq!(AdapterChoice::parse(Some("software")), AdapterChoice::Software);
/// assert_eq!(AdapterChoice::parse(None), AdapterChoice::Best);
/// ```
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub enum AdapterChoice {
    /// The best available: a discrete GPU before an integrated one before any other; software last.
    #[default]
    Best,
    /// One of those that are as good as the best, for a process that shares a machine with others: the one of this number, from 0, and
    /// from the first again beyond the last.
    Share(usize),
    /// A software adapter.
    Software,
    /// The adapter with this number in [`list_adapters`], or the first whose name contains this text, ignoring case.
    Named(String),
}

impl AdapterChoice {
    /// The choice of a user: `software`, a number or a part of a name; without one, the best.
    ///
    /// ```
    /// use mesoscope::gpu::AdapterChoice;
    ///
    /// assert_eq!(AdapterChoice::parse(None), AdapterChoice::Best);
    /// assert_eq!(AdapterChoice::parse(Some("software")), AdapterChoice::Software);
    /// assert_eq!(AdapterChoice::parse(Some("radeon")), AdapterChoice::Named("radeon".to_owned()));
    /// ```
    #[must_use]
    pub fn parse(text: Option<&str>) -> Self {
        match text {
            None | Some("best") => Self::Best,
            Some("software") => Self::Software,
            Some(name) => Self::Named(name.to_owned()),
        }
    }

    /// The choice of one of several ranks on a machine: each gets one of those that are as good as the best, if none is named.
    #[must_use]
    pub(crate) fn of_rank(&self, rank: usize) -> Self {
        match self {
            Self::Best => Self::Share(rank),
            chosen => chosen.clone(),
        }
    }
}

/// What an adapter is.
#[derive(Debug, Clone, Copy, PartialEq, Eq, strum::IntoStaticStr)]
#[strum(serialize_all = "lowercase")]
pub enum AdapterKind {
    /// A graphics card with memory of its own.
    Discrete,
    /// A graphics processor that shares the memory of the computer.
    Integrated,
    /// One that a virtual machine offers.
    Virtual,
    /// A driver that computes on the processor.
    Software,
    /// Something else.
    Other,
}

impl AdapterKind {
    fn of(info: &wgpu::AdapterInfo) -> Self {
        match info.device_type {
            wgpu::DeviceType::DiscreteGpu => Self::Discrete,
            wgpu::DeviceType::IntegratedGpu => Self::Integrated,
            wgpu::DeviceType::VirtualGpu => Self::Virtual,
            wgpu::DeviceType::Cpu => Self::Software,
            wgpu::DeviceType::Other => Self::Other,
        }
    }

    /// Its name, for people.
    ///
    /// ```
    /// assert_eq!(mesoscope::gpu::AdapterKind::Software.name(), "software");
    /// ```
    #[must_use]
    pub fn name(self) -> &'static str {
        self.into()
    }
}

/// An adapter in words.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct AdapterDescription {
    /// Its name.
    pub name: String,
    /// What it is.
    pub kind: AdapterKind,
    /// Vulkan, Metal or DX12.
    pub backend: String,
    /// The driver and its version.
    pub driver: String,
}

impl AdapterDescription {
    /// Its name, and of its driver what the name does not say.
    ///
    /// ```
    /// use mesoscope::gpu::{AdapterDescription, AdapterKind};
    ///
    /// let described = |name: &str, driver: &str| {
    ///     let [name, backend, driver] = [name, "Vulkan", driver].map(str::to_owned);
    ///     AdapterDescription { name, kind: AdapterKind::Other, backend, driver }.in_words()
    /// };
    /// let found = described("llvmpipe (LLVM 15.0.6, 256 bits)", "llvmpipe Mesa 22.3.6 (LLVM 15.0.6)");
    /// assert_eq!(found, "llvmpipe (LLVM 15.0.6, 256 bits), driver Mesa 22.3.6");
    /// assert_eq!(described("NVIDIA H100 PCIe", "NVIDIA 535.104.05"), "NVIDIA H100 PCIe, driver 535.104.05");
    /// assert_eq!(described("Apple M2", ""), "Apple M2");
    /// ```
    #[must_use]
    pub fn in_words(&self) -> String {
        let plain = |word: &str| word.trim_matches(|letter| "(),".contains(letter)).to_owned();
        let named: Vec<String> = self.name.split_whitespace().map(plain).collect();
        let further: Vec<&str> = self.driver.split_whitespace().filter(|word| !named.contains(&plain(word))).collect();
        if further.is_empty() { self.name.clone() } else { format!("{}, driver {}", self.name, further.join(" ")) }
    }

    pub(super) fn new(info: &wgpu::AdapterInfo) -> Self {
        Self {
            name: info.name.clone(),
            kind: AdapterKind::of(info),
            backend: format!("{:?}", info.backend),
            driver: format!("{} {}", info.driver, info.driver_info).trim().to_owned(),
        }
    }
}

fn rank(info: &wgpu::AdapterInfo) -> u32 {
    match info.device_type {
        wgpu::DeviceType::DiscreteGpu => 0,
        wgpu::DeviceType::IntegratedGpu => 1,
        wgpu::DeviceType::VirtualGpu => 2,
        wgpu::DeviceType::Other => 3,
        wgpu::DeviceType::Cpu => 4,
    }
}

fn adapters() -> Vec<wgpu::Adapter> {
    let mut descriptor = wgpu::InstanceDescriptor::new_without_display_handle();
    // A layer that is installed is loaded if `WGPU_VALIDATION` asks for it, by builds for debugging too: that of Debian 12 crashes where
    // threads open devices. Indirect sizes are zero or those of the plan, which have been checked: checking them each time would cost
    // as much as the kernels that are skipped.
    descriptor.flags = wgpu::InstanceFlags::empty().with_env();
    descriptor.flags.remove(wgpu::InstanceFlags::VALIDATION_INDIRECT_CALL);
    let instance = wgpu::Instance::new(descriptor);
    let mut adapters = pollster::block_on(instance.enumerate_adapters(wgpu::Backends::PRIMARY));
    adapters.sort_by_key(|adapter| rank(&adapter.get_info()));
    adapters
}

/// All adapters, the best first.
#[must_use]
pub fn list_adapters() -> Vec<AdapterDescription> {
    adapters().iter().map(|adapter| AdapterDescription::new(&adapter.get_info())).collect()
}

/// The place of an adapter among those of the kind of the first. One that two backends offer is counted once.
fn share<K: PartialEq>(kinds: &[K], number: usize) -> Option<usize> {
    let alike: Vec<usize> = (0..kinds.len()).filter(|place| kinds[*place] == kinds[0]).collect();
    alike.get(number.checked_rem(alike.len())?).copied()
}

/// What makes adapters alike, in their order.
fn kinds(adapters: &[wgpu::Adapter]) -> Vec<(u32, wgpu::Backend)> {
    adapters.iter().map(wgpu::Adapter::get_info).map(|info| (rank(&info), info.backend)).collect()
}

/// Number of adapters that the ranks on this machine get by turns: those that are as good as the best, or the one that is chosen.
///
/// ```
/// use mesoscope::gpu::{AdapterChoice, adapters_by_turns};
///
/// assert_eq!(adapters_by_turns(&AdapterChoice::Software), 1);
/// assert!(adapters_by_turns(&AdapterChoice::Best) >= 1);
/// ```
#[must_use]
pub fn adapters_by_turns(choice: &AdapterChoice) -> u32 {
    match choice {
        AdapterChoice::Best | AdapterChoice::Share(_) => {
            let kinds = kinds(&adapters());
            (kinds.iter().filter(|kind| Some(*kind) == kinds.first()).count() as u32).max(1)
        }
        AdapterChoice::Software | AdapterChoice::Named(_) => 1,
    }
}

pub(super) fn choose(choice: &AdapterChoice) -> Result<wgpu::Adapter, GpuError> {
    let adapters = adapters();
    if adapters.is_empty() {
        return Err(GpuError::NoAdapter);
    }
    let names: Vec<String> = adapters.iter().map(|adapter| adapter.get_info().name).collect();
    let position = match choice {
        AdapterChoice::Best => Some(0),
        AdapterChoice::Share(number) => share(&kinds(&adapters), *number),
        AdapterChoice::Software => {
            adapters.iter().position(|adapter| adapter.get_info().device_type == wgpu::DeviceType::Cpu)
        }
        AdapterChoice::Named(name) => match name.parse::<usize>() {
            Ok(number) => (number < adapters.len()).then_some(number),
            Err(_) if name.is_empty() => None,
            Err(_) => names.iter().position(|known| known.to_lowercase().contains(&name.to_lowercase())),
        },
    };
    position.and_then(|position| adapters.into_iter().nth(position)).ok_or_else(|| GpuError::NoSuchAdapter {
        wanted: match choice {
            AdapterChoice::Named(name) => name.clone(),
            _ => "software".to_owned(),
        },
        available: names
            .iter()
            .enumerate()
            .map(|(number, name)| format!("{number}: {name}"))
            .collect::<Vec<_>>()
            .join(", "),
    })
}

#[cfg(test)]
mod tests {
    use super::share;

    #[test]
    fn processes_of_a_machine_share_the_adapters_of_the_best_kind() {
        let kinds = [(0, "vulkan"), (0, "vulkan"), (0, "dx12"), (0, "vulkan"), (4, "vulkan")];
        let found: Vec<_> = (0..5).map(|number| share(&kinds, number)).collect();
        assert_eq!(found, [0, 1, 3, 0, 1].map(Some));
        assert_eq!(share(&[0], 7), Some(0));
        assert_eq!(share::<u8>(&[], 0), None);
    }
}
