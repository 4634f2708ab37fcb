//! The available adapters, and the choice of one.

use super::GpuError;

/// Which adapter to use.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub enum AdapterChoice {
    /// The best available: a discrete GPU before an integrated one before any other; software last.
    #[default]
    Best,
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
}

/// The description of an adapter.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct AdapterDescription {
    /// Its name.
    pub name: String,
    /// Discrete, integrated, virtual, software or other.
    pub kind: &'static str,
    /// Vulkan, Metal or DX12.
    pub backend: String,
    /// The driver and its version.
    pub driver: String,
}

impl AdapterDescription {
    pub(super) fn new(info: &wgpu::AdapterInfo) -> Self {
        let kind = match info.device_type {
            wgpu::DeviceType::DiscreteGpu => "discrete",
            wgpu::DeviceType::IntegratedGpu => "integrated",
            wgpu::DeviceType::VirtualGpu => "virtual",
            wgpu::DeviceType::Cpu => "software",
            wgpu::DeviceType::Other => "other",
        };
        Self {
            name: info.name.clone(),
            kind,
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
    // Indirect sizes are zero or those of the plan, which have been checked: checking them each time would cost as much as the
    // kernels that are skipped.
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

pub(super) fn choose(choice: &AdapterChoice) -> Result<wgpu::Adapter, GpuError> {
    let adapters = adapters();
    if adapters.is_empty() {
        return Err(GpuError::NoAdapter);
    }
    let names: Vec<String> = adapters.iter().map(|adapter| adapter.get_info().name).collect();
    let position = match choice {
        AdapterChoice::Best => Some(0),
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
