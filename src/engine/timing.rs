//! Where the time of a step goes: real steps in which every kernel is timed separately.

use std::time::Instant;

use super::{Engine, EngineError, readback};
use crate::gpu::compute_pass;

/// Time spent in one kernel of a step.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct StageTime {
    /// Name of the kernel.
    pub name: &'static str,
    /// Median over the timed steps, in seconds.
    pub seconds: f64,
}

/// How a device measures time.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum StageClock {
    /// The device writes down when each kernel begins and ends.
    Timestamps,
    /// The host submits each kernel alone, waits, and subtracts what an empty submission takes.
    Submissions,
}

impl Engine<'_> {
    /// The best clock of the device.
    #[must_use]
    pub fn stage_clock(&self) -> StageClock {
        if self.gpu.device.features().contains(wgpu::Features::TIMESTAMP_QUERY) {
            StageClock::Timestamps
        } else {
            StageClock::Submissions
        }
    }

    /// Advances by `steps` and times each kernel separately, in the order of a step. Steps that take a sample or sort the memory are
    /// executed but not timed; if there are no others, nothing is returned.
    ///
    /// The steps give the same results as [`Self::advance`], to the bit. The sum over the kernels does not include the cost of submitting a
    /// batch. With [`StageClock::Submissions`] it is only as accurate as the time of an empty submission is constant.
    ///
    /// ```
    /// # use mesoscope::engine::Engine;
    /// # use mesoscope::gpu::{AdapterChoice, Gpu, Requirements};
    /// # use mesoscope::plan::{Hardware, Options};
    /// # use mesoscope::run::plan;
    /// # use mesoscope::scene;
    /// # let small = ["space.box=[3,3,3]", "output={}"].map(str::to_owned);
    /// # let scene = scene::load("dpd-fluid", &small)?;
    /// # let start = mesoscope::families::initial_state(&scene);
    /// # let gpu = Gpu::open(&AdapterChoice::Best, Requirements::default())?;
    /// # let plan = plan(&scene, Hardware::from(&gpu), Options::default());
    /// let mut engine = Engine::new(&gpu, plan, &start)?;
    /// let stages = engine.time_stages(5, engine.stage_clock())?;
    /// for stage in &stages {
    ///     println!("{}: {:.1} µs", stage.name, 1e6 * stage.seconds);
    /// }
    /// let plan = engine.plan();
    /// assert_eq!(stages.len(), plan.sort.len() + plan.before_report.len() + plan.advance.len());
    /// assert_eq!(engine.step(), 5);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// [`EngineError`] if the device failed, the run became unstable, or the current step has been reported already.
    pub fn time_stages(&mut self, steps: u64, clock: StageClock) -> Result<Vec<StageTime>, EngineError> {
        self.check_advanced()?;
        let kernels = [self.plan.sort.as_slice(), &self.plan.before_report, &self.plan.advance].concat();
        let mut times = vec![Vec::new(); kernels.len()];
        for _ in 0..steps {
            let samples = self.plan.samplers.iter().any(|sampler| sampler.due(self.step));
            // A dispatch of a replica is one of others, too.
            if self.replica.is_some() || self.step == u64::MAX || self.tidies() || samples {
                self.advance(1, 1)?;
                continue;
            }
            self.wait_all()?;
            let step = match clock {
                StageClock::Timestamps => self.time_by_device(&kernels)?,
                StageClock::Submissions => self.time_by_host(&kernels)?,
            };
            self.step += 1;
            for (all, seconds) in times.iter_mut().zip(step) {
                all.push(seconds);
            }
        }
        if times.iter().all(Vec::is_empty) {
            return Ok(Vec::new());
        }
        Ok(kernels
            .iter()
            .zip(times)
            .map(|(&kernel, times)| StageTime { name: self.plan.kernels[kernel].name, seconds: median(times) })
            .collect())
    }

    /// One step with a pass for each kernel and a timestamp on both sides of it; in seconds.
    fn time_by_device(&mut self, kernels: &[usize]) -> Result<Vec<f64>, EngineError> {
        let device = &self.gpu.device;
        let count = 2 * kernels.len() as u32;
        let bytes = u64::from(count) * 8;
        let (queries, ticks) = self.gpu.scoped("creating timestamps", bytes, || {
            let queries = device.create_query_set(&wgpu::QuerySetDescriptor {
                label: Some("stages"),
                ty: wgpu::QueryType::Timestamp,
                count,
            });
            let ticks = device.create_buffer(&wgpu::BufferDescriptor {
                label: Some("timestamps"),
                size: bytes,
                usage: wgpu::BufferUsages::QUERY_RESOLVE | wgpu::BufferUsages::COPY_SRC,
                mapped_at_creation: false,
            });
            (queries, ticks)
        })?;
        let mut encoder = self.gpu.encoder("timed step");
        for (place, &kernel) in (0..).zip(kernels) {
            let mut pass = encoder.begin_compute_pass(&wgpu::ComputePassDescriptor {
                label: Some(self.plan.kernels[kernel].name),
                timestamp_writes: Some(wgpu::ComputePassTimestampWrites {
                    query_set: &queries,
                    beginning_of_pass_write_index: Some(2 * place),
                    end_of_pass_write_index: Some(2 * place + 1),
                }),
            });
            self.stages[kernel].dispatch(&mut pass, 1);
        }
        encoder.resolve_query_set(&queries, 0..count, &ticks, 0);
        self.submit(encoder)?;
        self.wait_all()?;
        let bytes = readback::read(&self.gpu, bytes, |encoder, staging| {
            encoder.copy_buffer_to_buffer(&ticks, 0, staging, 0, bytes);
        })?;
        let ticks: Vec<u64> = bytes.chunks_exact(8).map(bytemuck::pod_read_unaligned).collect();
        let period = f64::from(self.gpu.queue.get_timestamp_period()) * 1e-9;
        Ok(ticks.chunks_exact(2).map(|pair| pair[1].saturating_sub(pair[0]) as f64 * period).collect())
    }

    /// One step with a submission for each kernel, less the time of an empty one; in seconds.
    fn time_by_host(&mut self, kernels: &[usize]) -> Result<Vec<f64>, EngineError> {
        let mut times = Vec::with_capacity(kernels.len());
        for &kernel in kernels {
            // An empty submission after every kernel: what one costs drifts with the load of the host.
            let empty = self.time_alone(None)?;
            times.push((self.time_alone(Some(kernel))? - empty).max(0.0));
        }
        // The readback of an ordinary submission finds out whether the step failed.
        let encoder = self.gpu.encoder("after a timed step");
        self.submit(encoder)?;
        self.wait_all()?;
        Ok(times)
    }

    fn time_alone(&self, kernel: Option<usize>) -> Result<f64, EngineError> {
        let mut encoder = self.gpu.encoder("kernel alone");
        {
            let mut pass = compute_pass(&mut encoder, "kernel alone");
            if let Some(kernel) = kernel {
                self.stages[kernel].dispatch(&mut pass, 1);
            }
        }
        let commands = encoder.finish();
        let begun = Instant::now();
        let submission = self.gpu.queue.submit([commands]);
        self.gpu.wait_for(submission)?;
        Ok(begun.elapsed().as_secs_f64())
    }
}

fn median(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    let middle = values.len() / 2;
    if values.len().is_multiple_of(2) { 0.5 * (values[middle - 1] + values[middle]) } else { values[middle] }
}
