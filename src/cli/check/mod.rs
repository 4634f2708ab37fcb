//! `mesoscope check`: what a scene requires.

mod files;
mod kernels;
mod predictions;
mod ranks;

use std::fmt::Write as _;

use mesoscope::engine::EngineError;
use mesoscope::families::{self, Model};
use mesoscope::gpu::GpuError;
use mesoscope::numbers::{bytes, grouped};
use mesoscope::plan::{Hardware, Options, Plan};
use mesoscope::printable;
use mesoscope::run::{self, ExpectedTime, RunError, Sizes};
use mesoscope::scene::{Integrator, Scene};

use super::table::{aligned, dimensions};
use super::{AdapterArgument, Failure, RanksArgument, SceneArguments, print};

/// Check a scene: all mistakes at once, or else what it requires - memory, time, files, warnings
#[derive(Debug, clap::Args)]
#[command(after_help = "\
The time is an estimate: a few steps are run on the adapter and timed, of the scene itself if it is small. That takes about a
quarter of a second, and the adapter has to start and compile the kernels first; without an adapter there is no estimate.

`stable` and `reliable` are what theory and experience say of the time step, `accuracy` what was measured of a scene of the same
physics and is shipped with the program. `mesoscope stability SCENE` measures how far a scene of your own may go, `mesoscope
tradeoff` how far off it is.

Exit code 0 means that the adapter (the one named, else the best) can run the scene.

Examples:
  mesoscope check my-scene.json
  mesoscope check dpd-fluid --kernels
  mesoscope check dpd-fluid --shader scatter
  mesoscope check dpd-fluid --ranks 4
  mesoscope check dpd-fluid --set particles.0.number_density=4")]
pub struct Arguments {
    #[command(flatten)]
    scene: SceneArguments,

    #[command(flatten)]
    adapter: AdapterArgument,

    #[command(flatten)]
    ranks: RanksArgument,

    /// List kernels, buffers and their bytes too
    #[arg(long)]
    kernels: bool,

    /// Print the WGSL of a kernel, each part with its file and line, and nothing else
    #[arg(long, value_name = "KERNEL")]
    shader: Option<String>,
}

/// Checks the scene.
pub fn execute(arguments: &Arguments) -> Result<(), Failure> {
    let (scene, notices) = arguments.scene.load()?;
    let model = Model::new(&scene);
    let mut warnings: Vec<String> =
        notices.iter().chain(&families::warnings(&scene)).map(ToString::to_string).collect();
    warnings.extend(run::lettering(&scene));
    let division = arguments.ranks.division((&scene, &model), &arguments.adapter, None)?;
    let opened = match run::adapter_for(&scene, &arguments.adapter.choice()) {
        Err(error @ (RunError::Scene(_) | RunError::Gpu(GpuError::NoSuchAdapter { .. }))) => return Err(error.into()),
        opened => opened,
    };
    let hardware = opened.as_ref().map_or(Hardware::default(), Hardware::from);
    let plan = run::plan(&model, scene.time.equilibration, &scene.output, hardware, Options::default());
    if let Some(kernel) = &arguments.shader {
        return print(&kernels::shader(&plan, kernel)?);
    }
    let trial = opened.as_ref().ok().filter(|_| scene.time.steps > 0).map(|gpu| run::expected_time(&scene, gpu));
    let time = trial.as_ref().map(|trial| expected_time(&scene, trial));
    let adapter = match &opened {
        Ok(gpu) => gpu.description().name.clone(),
        Err(RunError::Gpu(GpuError::NoAdapter)) => "none found; this is the plan for any adapter".to_owned(),
        Err(_) => "none that can run it; this is the plan for any adapter".to_owned(),
    };
    let sizes = Sizes::of(&scene, &model, &plan);
    let mut rows = overview(&scene, &model, &plan, &adapter, time, &sizes);
    let step = trial.as_ref().and_then(|trial| Some(trial.as_ref().ok()?.step));
    rows.extend(division.into_iter().flat_map(|division| ranks::rows(&scene, &model, division, (step, hardware))));
    rows.extend(predictions::rows(&arguments.scene.as_argument(), (&scene, &model), &plan, hardware));
    let rows: Vec<Vec<String>> = rows.into_iter().map(|(name, value)| vec![name.to_owned(), value]).collect();
    let mut text = format!("{}\n{}", printable::name(&scene.title), aligned(&rows, "  "));
    text.push_str(&files::outputs(&scene, &model, &sizes));
    if arguments.kernels {
        kernels::kernels(&mut text, &plan)?;
    }
    for warning in &warnings {
        let _ = writeln!(text, "\nwarning: {warning}");
    }
    print(&text)?;
    opened?;
    match trial {
        // A run that becomes unstable is a matter of the scene, not of the adapter.
        Some(Err(error @ (RunError::Gpu(_) | RunError::Engine(EngineError::GaveUp { .. })))) => Err(error.into()),
        _ => Ok(()),
    }
}

/// How long the run takes here, in words.
fn expected_time(scene: &Scene, trial: &Result<ExpectedTime, RunError>) -> String {
    let expected = match trial {
        Ok(expected) => expected,
        Err(error) => return format!("unknown: a trial of the first steps ended with: {error}"),
    };
    let basis = if expected.of_scene {
        format!("{} of its steps were timed", grouped(expected.steps))
    } else {
        "from its arithmetic and the speed of a small fluid".to_owned()
    };
    format!(
        "about {} for {} steps, within a factor of {} ({basis})",
        duration(expected.seconds),
        grouped(scene.time.steps),
        expected.factor
    )
}

/// A time in two units, or with two digits.
fn duration(seconds: f64) -> String {
    match seconds {
        ..10.0 => format!("{} s", two_digits(seconds)),
        10.0..100.0 => format!("{seconds:.0} s"),
        100.0..6000.0 => format!("{:.0} min", seconds / 60.0),
        6000.0..172_800.0 => format!("{:.0} h", seconds / 3600.0),
        172_800.0..63_072_000.0 => format!("{:.0} days", seconds / 86_400.0),
        _ => format!("{:.1e} years", seconds / 31_557_600.0),
    }
}

fn two_digits(value: f64) -> String {
    if value < 0.1 { format!("{value:.1e}") } else { format!("{value:.1}") }
}

/// The rows of the overview: names and what is to be said of them.
fn overview(
    scene: &Scene,
    model: &Model,
    plan: &Plan,
    adapter: &str,
    time: Option<String>,
    sizes: &Sizes,
) -> Vec<(&'static str, String)> {
    let lengths: Vec<String> = scene.space.lengths.iter().map(ToString::to_string).collect();
    let integrator = match scene.integrator {
        Integrator::GrootWarren { lambda } => format!("groot-warren, λ = {lambda}"),
        _ => scene.integrator.name().to_owned(),
    };
    let memory = match plan.particles {
        0 => bytes(plan.bytes()),
        count => format!("{}, {:.1} bytes a particle", bytes(plan.bytes()), plan.bytes() as f64 / count as f64),
    };
    let particles = model.particles_in_words();
    let cells =
        plan.cells[..lengths.len()].iter().map(|count| grouped((*count).into())).collect::<Vec<_>>().join(" × ");
    let dimensions = dimensions(lengths.len());
    let mut rows = vec![("particles", format!("{particles} in {dimensions}, box {}", lengths.join(" × ")))];
    rows.extend(model.composition(scene));
    rows.push(("memory", memory));
    rows.extend(time.map(|time| ("time", time)));
    rows.extend([
        ("files", format!("about {}", bytes(sizes.total()))),
        ("adapter", adapter.to_owned()),
        ("integrator", format!("{integrator}, time step {}, {} steps", scene.time.step, grouped(scene.time.steps))),
    ]);
    rows.extend(model.description(scene, plan, &cells));
    let operations = grouped(plan.operations_per_particle as u64);
    rows.push(("arithmetic", format!("about {operations} operations a particle and step")));
    rows
}

/// How often something is done.
fn interval(first: u64, every: u64) -> String {
    let every = if every == 1 { "every step".to_owned() } else { format!("every {} steps", grouped(every)) };
    if first == 0 { every } else { format!("{every} from step {}", grouped(first)) }
}
