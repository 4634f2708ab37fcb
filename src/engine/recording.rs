//! Recording and submission of commands.

use super::pipeline::Stage;
use super::replicas::{Dispatch, Moment, Replica, Replicas, StepPhase};
use super::stored::Stored;
use crate::gpu::{Gpu, compute_pass};
use std::mem;
use std::ops::Range;
use std::sync::Arc;

/// Kernels of a batch, recorded and not yet submitted.
pub(super) struct Recording {
    gpu: Gpu,
    label: &'static str,
    encoder: wgpu::CommandEncoder,
    pass: Option<wgpu::ComputePass<'static>>,
    together: Option<Together>,
}

/// Kernels that a replica dispatches together with others.
struct Together {
    group: Arc<Replicas>,
    number: u32,
    moment: Moment,
    waiting: Vec<Dispatch>,
    /// True if the encoder has commands that come before them.
    follow: bool,
}

impl Recording {
    pub(super) fn new(gpu: &Gpu, label: &'static str) -> Self {
        Self { gpu: gpu.clone(), label, encoder: gpu.encoder(label), pass: None, together: None }
    }

    /// One whose kernels a replica dispatches together with others, if it is one of several.
    pub(super) fn of(gpu: &Gpu, replica: Option<&Replica>, label: &'static str) -> Self {
        let moment = Moment { step: 0, phase: StepPhase::Preparation, position: 0 };
        let together = replica.map(|Replica { group, number }| Together {
            group: Arc::clone(group),
            number: *number,
            moment,
            waiting: Vec::new(),
            follow: false,
        });
        Self { together, ..Self::new(gpu, label) }
    }

    /// Says to which phase of which step the kernels that follow belong.
    pub(super) fn begin(&mut self, step: u64, phase: StepPhase) {
        if let Some(together) = &mut self.together {
            together.moment = Moment { step, phase, position: 0 };
        }
    }

    /// Records a kernel; after one that takes long, submits what has been recorded. A system's watchdog times a whole submission.
    pub(super) fn dispatch(&mut self, stage: &Stage) {
        if let Some(Together { moment, waiting, .. }) = &mut self.together {
            waiting.push((*moment, stage.number));
            moment.position += 1;
            return;
        }
        self.dispatch_layers(stage, 1);
    }

    /// Records a kernel with some layers of workgroups, one for each of several systems.
    pub(super) fn dispatch_layers(&mut self, stage: &Stage, layers: u32) {
        let (encoder, label) = (&mut self.encoder, self.label);
        let pass = self.pass.get_or_insert_with(|| compute_pass(encoder, label).forget_lifetime());
        stage.dispatch(pass, layers);
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

    /// Records that bytes of an array are filled with zeros.
    pub(super) fn clear(&mut self, array: &Stored, range: Range<u64>) {
        self.dispatch_together();
        self.pass = None;
        array.clear(&mut self.encoder, range);
        if let Some(together) = &mut self.together {
            together.follow = true;
        }
    }

    /// Lets a replica dispatch what waits.
    fn dispatch_together(&mut self) {
        let Some(together) = &mut self.together else { return };
        if together.waiting.is_empty() {
            return;
        }
        if mem::take(&mut together.follow) {
            let before = mem::replace(&mut self.encoder, self.gpu.encoder(self.label));
            self.gpu.queue.submit([before.finish()]);
        }
        together.group.dispatch(together.number, mem::take(&mut together.waiting));
    }

    /// Submits the kernels that have not been submitted, if there are any.
    pub(super) fn submit(&mut self) {
        self.dispatch_together();
        if self.pass.is_some() {
            let full = self.take();
            self.gpu.queue.submit([full.finish()]);
        }
    }

    /// What has not been submitted, which the caller submits before more is recorded.
    pub(super) fn take(&mut self) -> wgpu::CommandEncoder {
        self.dispatch_together();
        self.pass = None;
        mem::replace(&mut self.encoder, self.gpu.encoder(self.label))
    }

    /// What has not been submitted.
    pub(super) fn finish(mut self) -> wgpu::CommandEncoder {
        self.dispatch_together();
        self.pass = None;
        self.encoder
    }
}
