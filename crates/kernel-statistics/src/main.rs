//! Compiles compute kernels with a Vulkan driver and prints what the driver says of them: registers, spills, instructions.
//!
//! Usage: `kernel-statistics FILE.spv...`, each with one entry point and storage buffers in set 0. The first line names device and driver; then
//! each line holds a file and its statistics, `name=value` with tabs between, in the order of the driver. With `RADV_FORCE_FAMILY` Mesa's driver of
//! AMD cards compiles for a card that is not there ("null hardware"): it has neither memory nor a queue, so nothing is allocated or run here.

use std::ffi::{CStr, CString};
use std::process::ExitCode;
use std::time::Instant;

use ash::vk;

/// Storage buffers of the set that every kernel is compiled with; more than any kernel binds.
const BINDINGS: u32 = 64;

/// Anything that ends the program with a message.
type Failure = Box<dyn std::error::Error>;

fn main() -> ExitCode {
    let files: Vec<String> = std::env::args().skip(1).collect();
    match Compiler::new().and_then(|compiler| files.iter().try_for_each(|file| compiler.describe(file))) {
        Ok(()) => ExitCode::SUCCESS,
        Err(failure) => {
            eprintln!("error: {failure}");
            ExitCode::FAILURE
        }
    }
}

/// A device that compiles.
struct Compiler {
    // Holds the library of the loader, without which no function of the others can be called.
    _entry: ash::Entry,
    device: ash::Device,
    statistics: ash::khr::pipeline_executable_properties::Device,
    layout: vk::PipelineLayout,
}

impl Compiler {
    /// Opens the first device of the driver that the environment names, with the features that wgpu requests of it where they change code.
    fn new() -> Result<Self, Failure> {
        // SAFETY: every structure lives until the call that reads it has returned, every handle until the process ends, and each command is used
        // with the version and the extensions that it is part of.
        unsafe {
            let entry = ash::Entry::load()?;
            let application = vk::ApplicationInfo::default().api_version(vk::API_VERSION_1_3);
            let instance =
                entry.create_instance(&vk::InstanceCreateInfo::default().application_info(&application), None)?;
            let physical = *instance.enumerate_physical_devices()?.first().ok_or("there is no device")?;
            let mut driver = vk::PhysicalDeviceDriverProperties::default();
            let mut properties = vk::PhysicalDeviceProperties2::default().push_next(&mut driver);
            instance.get_physical_device_properties2(physical, &mut properties);
            let name = text(properties.properties.device_name_as_c_str());
            println!("{name}\t{}", text(driver.driver_info_as_c_str()));

            let mut statistics =
                vk::PhysicalDevicePipelineExecutablePropertiesFeaturesKHR::default().pipeline_executable_info(true);
            let mut robustness = vk::PhysicalDeviceRobustness2FeaturesEXT::default().robust_buffer_access2(true);
            let mut dots = vk::PhysicalDeviceVulkan13Features::default().shader_integer_dot_product(true);
            let mut features = vk::PhysicalDeviceFeatures2::default()
                .features(vk::PhysicalDeviceFeatures { robust_buffer_access: vk::TRUE, ..Default::default() })
                .push_next(&mut statistics)
                .push_next(&mut robustness)
                .push_next(&mut dots);
            let extensions =
                [ash::khr::pipeline_executable_properties::NAME, ash::ext::robustness2::NAME].map(CStr::as_ptr);
            let queues = [vk::DeviceQueueCreateInfo::default().queue_priorities(&[1.0])];
            let device = instance.create_device(
                physical,
                &vk::DeviceCreateInfo::default()
                    .queue_create_infos(&queues)
                    .enabled_extension_names(&extensions)
                    .push_next(&mut features),
                None,
            )?;
            let statistics = ash::khr::pipeline_executable_properties::Device::new(&instance, &device);

            let binding = |number| {
                vk::DescriptorSetLayoutBinding::default()
                    .binding(number)
                    .descriptor_type(vk::DescriptorType::STORAGE_BUFFER)
                    .descriptor_count(1)
                    .stage_flags(vk::ShaderStageFlags::COMPUTE)
            };
            let bindings: Vec<_> = (0..BINDINGS).map(binding).collect();
            let set = vk::DescriptorSetLayoutCreateInfo::default().bindings(&bindings);
            let sets = [device.create_descriptor_set_layout(&set, None)?];
            let layout =
                device.create_pipeline_layout(&vk::PipelineLayoutCreateInfo::default().set_layouts(&sets), None)?;
            Ok(Self { _entry: entry, device, statistics, layout })
        }
    }

    /// Compiles the kernel of a file and prints its line.
    fn describe(&self, file: &str) -> Result<(), Failure> {
        let words = ash::util::read_spv(&mut std::fs::File::open(file)?)?;
        let entry = entry_point(&words).ok_or_else(|| format!("{file} has no entry point"))?;
        // SAFETY: as above; the words are those of a module that naga has validated.
        unsafe {
            let module = self.device.create_shader_module(&vk::ShaderModuleCreateInfo::default().code(&words), None)?;
            let stage = vk::PipelineShaderStageCreateInfo::default()
                .stage(vk::ShaderStageFlags::COMPUTE)
                .module(module)
                .name(&entry);
            let pipeline = vk::ComputePipelineCreateInfo::default()
                .flags(vk::PipelineCreateFlags::CAPTURE_STATISTICS_KHR)
                .stage(stage)
                .layout(self.layout);
            let begun = Instant::now();
            let pipelines = self
                .device
                .create_compute_pipelines(vk::PipelineCache::null(), &[pipeline], None)
                .map_err(|(_, result)| format!("{file}: {result}"))?;
            let milliseconds = 1e3 * begun.elapsed().as_secs_f64();
            let executable = vk::PipelineExecutableInfoKHR::default().pipeline(pipelines[0]);
            let found = self.statistics.get_pipeline_executable_statistics(&executable)?;
            let numbers = found.iter().map(|statistic| {
                let name = text(statistic.name_as_c_str());
                // Those of every compute pipeline of Mesa are whole numbers.
                let number = if statistic.format == vk::PipelineExecutableStatisticFormatKHR::UINT64 {
                    statistic.value.u64.to_string()
                } else {
                    "?".to_owned()
                };
                format!("\t{name}={number}")
            });
            println!("{file}\tmilliseconds={milliseconds:.1}{}", numbers.collect::<String>());
            self.device.destroy_pipeline(pipelines[0], None);
            self.device.destroy_shader_module(module, None);
        }
        Ok(())
    }
}

/// A text of the driver.
fn text(bytes: Result<&CStr, std::ffi::FromBytesUntilNulError>) -> String {
    bytes.map_or_else(|_| "?".to_owned(), |text| text.to_string_lossy().into_owned())
}

/// The name of the first entry point of a module of SPIR-V: of instruction 15 the words from the fourth.
fn entry_point(words: &[u32]) -> Option<CString> {
    const ENTRY_POINT: u32 = 15;
    let mut rest = words.get(5..)?;
    while let [first, ..] = rest {
        let length = (first >> 16) as usize;
        if first & 0xffff == ENTRY_POINT {
            let bytes: Vec<u8> = rest.get(3..length)?.iter().flat_map(|word| word.to_le_bytes()).collect();
            return CString::new(bytes.split(|byte| *byte == 0).next()?).ok();
        }
        rest = rest.get(length.max(1)..)?;
    }
    None
}
