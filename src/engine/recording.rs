//! Recording and submission of commands.

use super::pipeline::Stage;
use super::stored::Stored;
use crate::gpu::{Gpu, compute_pass};

/// Kernels of a batch, recorded and not yet submitted.
pub(super) struct Recording {
    gpu: Gpu,
    label: &'static str,
    encoder: wgpu::CommandEncoder,
    pass: Option<wgpu::ComputePass<'static>>,
}

impl Recording {
    pub(super) fn new(gpu: &Gpu, label: &'static str) -> Self {
        Self { gpu: gpu.clone(), label, encoder: gpu.encoder(label), pass: None }
    }

    /// Records a kernel; after one that takes long, submits what has been recorded. A system's watchdog times a whole submission.
    pub(super) fn dispatch(&mut self, stage: &Stage) {
        let (encoder, label) = (&mut self.encoder, self.label);
        let pass = self.pass.get_or_insert_with(|| compute_pass(encoder, label).forget_lifetime());
        stage.dispatch(pass);
        if stage.takes_long {
            self.submit();
        }
    }

    /// Records kernels, one after the other.
    pub(super) fn dispatch_all(&mut self, stages: &[Stage], kernels: &[usize]) {
        for &kernel in kernels {
            self.dispatch(&stages[kernel]);
        }
    }

    /// Records that an array is filled with zeros.
    pub(super) fn clear(&mut self, array: &Stored) {
        self.pass = None;
        array.clear(&mut self.encoder, 0..array.bytes());
    }

    /// Submits the kernels that have not been submitted, if there are any.
    pub(super) fn submit(&mut self) {
        if self.pass.is_some() {
            let full = self.take();
            self.gpu.queue.submit([full.finish()]);
        }
    }

    /// What has not been submitted, which the caller submits before more is recorded.
    pub(super) fn take(&mut self) -> wgpu::CommandEncoder {
        self.pass = None;
        std::mem::replace(&mut self.encoder, self.gpu.encoder(self.label))
    }

    /// What has not been submitted.
    pub(super) fn finish(mut self) -> wgpu::CommandEncoder {
        self.pass = None;
        self.encoder
    }
}
