//! How large the files of a run will be, before it begins.

use super::analyses::{AskedAnalysis, asked_analyses};
use crate::families::{Checked, PictureKind};
use crate::output::bytes_per_particle;
use crate::plan::Plan;
use crate::plot::snapshot_size;
use crate::scene::Stage;

/// Bytes of a number in a table, with its comma: most have sixteen or seventeen digits.
const NUMBER: u64 = 19;
/// Bytes that a checkpoint keeps of a row of the table of energies: sums for the configurational temperature.
const ROW_KEPT: u64 = 16;
/// Bytes of a pixel in pictures, as they are compressed: measured, from .04 to .15 in plots, to .7 in crowds of discs.
const PLOT_PIXEL: f64 = 0.1;
const PICTURE_PIXEL: f64 = 0.5;

/// Bytes that a run will write, file by file.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Sizes {
    /// `energies.csv`.
    pub energies: u64,
    /// Tables of analyses, as far as they are not small.
    pub tables: u64,
    /// The checkpoint; while one is replaced there are two.
    pub checkpoint: u64,
    /// The trajectory.
    pub trajectory: u64,
    /// Plots, snapshots and fields with their arrays.
    pub pictures: u64,
    /// Pictures and arrays with numbers.
    pub numbered: u64,
    /// Pixels of all pictures.
    pub pixels: f64,
}

impl Sizes {
    /// The sizes for a scene, its model and a plan of it; estimates, but for trajectories and checkpoints within a few per cent.
    ///
    /// ```
    /// use mesoscope::run::Sizes;
    /// use mesoscope::plan::{Hardware, Options};
    /// use mesoscope::run::plan;
    ///
    /// let sizes = |set: &str| {
    ///     let scene = mesoscope::scene::load("dpd-fluid", &[set.to_owned()])?;
    ///     let plan = plan(&scene, Hardware::default(), Options::default());
    ///     Ok::<_, mesoscope::scene::SceneError>(Sizes::of(&scene, &plan))
    /// };
    /// assert_eq!(sizes("seed=1")?.trajectory, 0);
    /// let long = sizes(r#"output.trajectory={"every":1}"#)?;
    /// // A frame a step and one at the end, of 24 000 particles.
    /// assert!(long.trajectory > 2000 * 24_000 * 24 && long.total() > long.trajectory);
    /// # Ok::<(), mesoscope::scene::SceneError>(())
    /// ```
    #[must_use]
    pub fn of(scene: &Checked, plan: &Plan) -> Self {
        let model = scene.model();
        let output = &scene.output;
        let times = |every: u64| scene.time.steps.checked_div(every).map_or(0, |times| times.saturating_add(1));
        let columns = super::quantities(model).len() as u64 + 2;
        let (mut rows, mut trajectory, mut analyses) = (0_u64, 0_u64, Vec::new());
        for (stage, Stage { steps, .. }) in scene.of_stages().iter().zip(scene.stages_of_run()) {
            let times = |every: u64| steps.checked_div(every).map_or(0, |times| times.saturating_add(1));
            rows = rows.saturating_add(times(stage.output.energies.every));
            analyses.extend(asked_analyses(stage));
            let Some(asked) = &stage.output.trajectory else { continue };
            let shown =
                model.species.iter().filter(|known| asked.species.is_empty() || asked.species.contains(&known.name));
            let particles: u64 = shown.map(|species| species.count).sum();
            let frame = bytes_per_particle(asked.format).saturating_mul(particles).saturating_add(300);
            trajectory = trajectory.saturating_add(times(asked.every).saturating_mul(frame));
        }
        let plot_pixels = f64::from(output.plot.width) * f64::from(output.plot.height());
        let plot = (PLOT_PIXEL * plot_pixels) as u64;
        let (picture, pictures, numbered, pixels) = match model.picture() {
            PictureKind::Fields => {
                let fields = output.fields.clone().unwrap_or_default();
                let count = fields.quantities.len() as u64;
                let field = PICTURE_PIXEL * plot_pixels;
                let numbered = count.saturating_mul(times(fields.every));
                (field as u64 + 8 * model.physics().nodes() + 128, count, numbered, plot_pixels)
            }
            _ if model.units.dimension == 1 || output.snapshot.is_off => (0, 0, 0, 0.0),
            PictureKind::Particles | PictureKind::Cells => {
                let [width, height] =
                    snapshot_size(&output.snapshot, model.units.dimension as u32, model.edges_with_layers());
                ((PICTURE_PIXEL * width * height) as u64, 1, times(output.snapshot.every), width * height)
            }
        };
        let plots = 1 + analyses.iter().map(|asked| asked.tables.len() as u64).sum::<u64>();
        let sum = |bytes: &dyn Fn(&AskedAnalysis) -> u64| analyses.iter().map(bytes).fold(0, u64::saturating_add);
        Self {
            energies: rows.saturating_mul(NUMBER * columns),
            tables: sum(&|asked| asked.numbers.saturating_mul(NUMBER)),
            checkpoint: [rows.saturating_mul(ROW_KEPT), sum(&|asked| asked.kept_bytes)]
                .into_iter()
                .fold(checkpoint(plan), u64::saturating_add),
            trajectory,
            pictures: picture.saturating_mul(pictures).saturating_add(plot.saturating_mul(plots)),
            numbered: picture.saturating_mul(numbered),
            pixels: plots as f64 * plot_pixels + pictures.saturating_add(numbered) as f64 * pixels,
        }
    }

    /// Bytes of all files at the end.
    #[must_use]
    pub fn total(&self) -> u64 {
        [self.energies, self.tables, self.checkpoint, self.trajectory, self.pictures, self.numbered]
            .into_iter()
            .fold(0, u64::saturating_add)
    }
}

/// Bytes of a checkpoint: the state, open windows, and the scene.
fn checkpoint(plan: &Plan) -> u64 {
    const SCENE: u64 = 4096;
    let windows = plan.samplers.iter().filter_map(|sampler| sampler.window);
    let windows = windows.map(|window| {
        plan.buffers.iter().find(|buffer| buffer.array == window.buffer).map_or(0, |buffer| buffer.bytes)
    });
    windows.fold(plan.state_bytes().saturating_add(SCENE), u64::saturating_add)
}
