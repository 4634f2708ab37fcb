//! Kernels that a device has compiled, kept for later engines: a sweep, a restart or a scan over seeds does not compile them
//! again.

use std::borrow::Cow;
use std::collections::HashMap;
use std::hash::Hash;
use std::sync::{Arc, Mutex};

use super::device::Gpu;
use super::error::GpuError;
use super::shader::{Binding, LinkedShader, validate};
use crate::shaders::{Choices, Constant, Entry, linked_text};

/// As many as some ten engines have. When that is exceeded all are dropped; engines in use keep theirs.
const MOST_KEPT: usize = 256;

/// Values by their keys.
struct Kept<K, V>(Mutex<HashMap<K, V>>);

impl<K: Eq + Hash, V: Clone> Kept<K, V> {
    /// The stored value, or the result of `make`, which is stored unless it is an error. Two threads that ask for the same value at
    /// once both make it.
    fn get_or_make(&self, key: K, make: impl FnOnce() -> Result<V, GpuError>) -> Result<V, GpuError> {
        if let Some(kept) = self.0.lock().ok().and_then(|kept| kept.get(&key).cloned()) {
            return Ok(kept);
        }
        let made = make()?;
        if let Ok(mut kept) = self.0.lock() {
            if kept.len() >= MOST_KEPT {
                kept.clear();
            }
            kept.insert(key, made.clone());
        }
        Ok(made)
    }
}

impl<K, V> Default for Kept<K, V> {
    fn default() -> Self {
        Self(Mutex::default())
    }
}

/// The text of a kernel, and the bits of the constants that it uses.
type Ingredients = (String, Vec<(Constant, u64)>);

/// Changes a linked module before a pipeline is made from it, given the features of the device.
pub type Rewriting = Arc<dyn Fn(&mut naga::Module, wgpu::Features) + Send + Sync>;

/// What a device has compiled.
pub(super) struct Compiled {
    rewriting: Option<Rewriting>,
    linked: Kept<String, Arc<LinkedShader>>,
    pipelines: Kept<Ingredients, (wgpu::ComputePipeline, Arc<[Binding]>)>,
}

impl Compiled {
    pub(super) fn new(rewriting: Option<Rewriting>) -> Self {
        Self { rewriting, linked: Kept::default(), pipelines: Kept::default() }
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
    ) -> Result<(wgpu::ComputePipeline, Arc<[Binding]>), GpuError> {
        let linked = linked_text(entry, choices).map_err(|unlinked| GpuError::unlinked(name, unlinked))?;
        let text = linked.text.clone();
        let make = || Ok(Arc::new(validate(name, entry.name(), &linked)?));
        let linked = self.compiled.linked.get_or_make(text.clone(), make)?;
        let used = constants.filter(|(constant, _)| linked.constants.contains(constant));
        let constants: Vec<(Constant, f64)> = used.collect();
        let bits = constants.iter().map(|(constant, value)| (*constant, value.to_bits())).collect();
        self.compiled.pipelines.get_or_make((text, bits), || {
            let LinkedShader { mut module, bindings, constants: used, .. } = linked.specialized(&constants);
            let constants: Vec<(&str, f64)> = (constants.iter())
                .filter(|(constant, _)| used.contains(constant))
                .map(|(constant, value)| (constant.name(), *value))
                .collect();
            if let Some(rewriting) = &self.compiled.rewriting {
                rewriting(&mut module, self.device.features());
            }
            let pipeline = self.scoped(&format!("making kernel `{name}`"), 0, || {
                let module = self.device.create_shader_module(wgpu::ShaderModuleDescriptor {
                    label: Some(name),
                    source: wgpu::ShaderSource::Naga(Cow::Owned(module)),
                });
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
            Ok((pipeline, bindings.into()))
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_are_made_once_and_errors_each_time() {
        let kept = Kept::<usize, usize>::default();
        let failure = || Err(GpuError::NoSuchAdapter { wanted: String::new(), available: String::new() });
        assert!(kept.get_or_make(3, failure).is_err());
        assert_eq!(kept.get_or_make(3, || Ok(9)).ok(), Some(9));
        assert_eq!(kept.get_or_make(3, failure).ok(), Some(9));
        for key in 0..3 * MOST_KEPT {
            assert_eq!(kept.get_or_make(key, || Ok(key * key)).ok(), Some(key * key));
            assert!(kept.0.lock().is_ok_and(|kept| kept.len() <= MOST_KEPT));
        }
    }
}
