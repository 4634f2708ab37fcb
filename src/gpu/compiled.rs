//! Kernels that a device has compiled, kept for later engines: a sweep, a restart or a scan over seeds does not compile them
//! again.

use std::borrow::Cow;
use std::sync::Arc;

use super::device::Gpu;
use super::error::GpuError;
use super::kept::Kept;
use super::portions::Portions;
use super::replicas::Replicas;
use super::shader::{Binding, LinkedShader, link_once};
use crate::shaders::{Array, Choices, Constant, Entry};
use mesoscope_shader_modules::module_without_loop_counters;

/// The text of a kernel, the bits of the constants that it uses, and which of its arrays are in portions.
type Ingredients = (String, Vec<(Constant, u64)>, Vec<(Array, Portions)>);

/// Changes a linked module before a pipeline is made from it, given the features of the device.
pub type Rewriting = Arc<dyn Fn(&mut naga::Module, wgpu::Features) + Send + Sync>;

/// What a device has compiled.
pub(super) struct Compiled {
    rewriting: Option<Rewriting>,
    pipelines: Kept<Ingredients, CompiledKernel>,
}

/// A kernel that a device has compiled.
#[derive(Clone)]
pub(crate) struct CompiledKernel {
    pub pipeline: wgpu::ComputePipeline,
    /// The arrays that it binds.
    pub bindings: Arc<[Binding]>,
    /// Constants that were compiled into it.
    pub constants: Arc<[Constant]>,
    /// Constants that it loads from a buffer at [`LOADED_CONSTANTS`].
    pub loaded: Arc<[Constant]>,
}

/// Where constants of a kernel are.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum ConstantsIn {
    /// Compiled into it.
    #[default]
    Code,
    /// Real ones in a buffer, so that they can change between steps; others compiled into it.
    Buffer,
}

/// Where a kernel finds its constants and its arrays.
#[derive(Clone, Copy)]
pub(crate) struct Places<'a> {
    pub constants: ConstantsIn,
    /// Arrays that are in portions.
    pub portions_of: &'a dyn Fn(Array) -> Option<Portions>,
    /// Systems that have them side by side, if there are several.
    pub replicas: Option<&'a Replicas<'a>>,
}

impl Compiled {
    pub(super) fn new(rewriting: Option<Rewriting>) -> Self {
        Self { rewriting, pipelines: Kept::default() }
    }

    pub(super) fn rewriting(&self) -> Option<Rewriting> {
        self.rewriting.clone()
    }
}

impl Gpu {
    /// The pipeline of a kernel with the constants that it uses, and what it binds.
    ///
    /// # Errors
    /// [`GpuError`] if the kernel does not link or the device refuses it.
    pub(crate) fn compile(
        &self,
        name: &'static str,
        entry: Entry,
        choices: &Choices,
        constants: impl Iterator<Item = (Constant, f64)>,
        places: &Places<'_>,
    ) -> Result<CompiledKernel, GpuError> {
        let Places { constants: place, portions_of, replicas } = *places;
        let (text, linked) = link_once(name, entry, choices, place, replicas)?;
        let used = constants.filter(|(constant, _)| linked.constants.contains(constant));
        let constants: Vec<(Constant, f64)> = used.collect();
        let bits = constants.iter().map(|(constant, value)| (*constant, value.to_bits())).collect();
        let arrays = linked.bindings.iter().map(|binding| binding.array);
        let portions = arrays.filter_map(|array| Some((array, portions_of(array)?))).collect();
        self.compiled.pipelines.get_or_make((text, bits, portions), || {
            let divided = linked.specialized(&constants).divided(portions_of);
            let divided = divided.map_err(|undivided| GpuError::undivided(name, undivided))?;
            let LinkedShader { mut module, bindings, constants: used, loaded, counts_loops, .. } = divided;
            let constants: Vec<(&str, f64)> = (constants.iter())
                .filter(|(constant, _)| used.contains(constant))
                .map(|(constant, value)| (constant.name(), *value))
                .collect();
            if let Some(rewriting) = &self.compiled.rewriting {
                rewriting(&mut module, self.device.features());
            }
            let pipeline = self.scoped(&format!("making kernel `{name}`"), 0, || {
                let module = wgpu::ShaderModuleDescriptor {
                    label: Some(name),
                    source: wgpu::ShaderSource::Naga(Cow::Owned(module)),
                };
                let module = if counts_loops {
                    self.device.create_shader_module(module)
                } else {
                    module_without_loop_counters(&self.device, module)
                };
                self.device.create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
                    label: Some(name),
                    layout: None,
                    module: &module,
                    entry_point: Some(entry.name()),
                    compilation_options: wgpu::PipelineCompilationOptions {
                        constants: &constants,
                        // Every kernel writes workgroup memory before it reads it.
                        zero_initialize_workgroup_memory: false,
                    },
                    cache: None,
                })
            })?;
            let constants = linked.constants.as_slice().into();
            Ok(CompiledKernel { pipeline, bindings: bindings.into(), constants, loaded: loaded.into() })
        })
    }
}
