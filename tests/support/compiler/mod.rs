//! Another compiler, played by rewriting modules before pipelines are made of them: what WGSL leaves to drivers, and lavapipe
//! does in one way only. See [`mesoscope::gpu::Gpu::open_rewriting`].

mod contraction;
mod flattening;
mod functions;
mod fusion;
pub mod kernel;
mod operands;
mod rewriting;

use std::sync::Arc;

use mesoscope::gpu::Gpu;

use crate::support;

pub use contraction::Contraction;
pub use functions::{Deviation, Functions};
pub use fusion::can_contract;

/// What a compiler does to arithmetic, after it has put all functions into the kernel where that can be.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Compiler {
    /// Leaves arithmetic as it is.
    Plain,
    /// Contracts products and sums.
    Contracting(Contraction),
    /// Has functions that err as much as they may.
    Erring(Functions, Deviation),
}

impl Compiler {
    /// The module as this compiler understands it.
    pub fn rewrite(self, module: &mut naga::Module, features: wgpu::Features) {
        flattening::flatten(module);
        match self {
            Self::Plain => {}
            Self::Contracting(contraction) => {
                // A fused multiplication and addition need not be one on the device, see `can_contract`: in double precision it is.
                contraction::contract(module, contraction, features.contains(wgpu::Features::SHADER_F64));
            }
            Self::Erring(which, deviation) => functions::perturb(module, which, deviation),
        }
    }

    /// The adapter of the tests with this compiler.
    pub fn gpu(self) -> Gpu {
        let rewriting = Arc::new(move |module: &mut naga::Module, features| self.rewrite(module, features));
        Gpu::open_rewriting(&crate::support::adapter(), crate::support::requirements(), rewriting).expect("an adapter")
    }
}
