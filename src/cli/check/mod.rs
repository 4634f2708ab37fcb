//! `mesoscope check`: what a scene requires.

mod files;
mod kernels;
mod predictions;
mod ranks;

use std::fmt::Write as _;

use mesoscope::engine::EngineError;
use mesoscope::families::{self, Checked};
use mesoscope::gpu::{GpuError, unseen_card};
use mesoscope::numbers::{bytes, counted, grouped};
use mesoscope::plan::{Hardware, Options, Part, Plan};
use mesoscope::printable;
use mesoscope::run::{self, ExpectedTime, RunError, Sizes};
use mesoscope::scene::{Integrator, PairRelaxation};

use super::table::labelled;
use super::{Failure, RanksArgument, SceneArguments, heading, print, print_exactly};

/// Check a scene: all mistakes at once, or else what to expect - time, files, errors, warnings - and with -v what it consists of
#[derive(Debug, clap::Args)]
#[command(after_help = "\
The time is an estimate: a few steps are run on the adapter and timed, of the scene itself if it is small, and pictures are counted. \
That takes about a quarter of a second, and the adapter has to start and compile the kernels first; without an adapter there is no \
estimate.

`accuracy` is what was measured of a scene of the same physics and is shipped with the program, `expected` what experience says of \
the errors of a step. With -v, `largest step` is the largest that theory and experience advise. `mesoscope stability SCENE` measures how far a \
scene of your own may go, `mesoscope tradeoff` how far off it is.

Exit code 0 means that the adapter (the one named, else the best) can run the scene, and that its first steps went well.

Examples:
  mesoscope check my-scene.json
  mesoscope check my-scene.json -v
  mesoscope check dpd-fluid --kernels
  mesoscope check dpd-fluid --shader scatter
  mesoscope check dpd-fluid --ranks 4
  mesoscope check dpd-fluid --set particles.0.number_density=4")]
pub struct Arguments {
    #[command(flatten)]
    scene: SceneArguments,

    #[command(flatten)]
    ranks: RanksArgument,

    /// Say more: what the scene consists of, how long its steps may be, when files are written
    #[arg(long, short, help_heading = heading::OUTPUT)]
    verbose: bool,

    /// The same, with kernels, buffers and their bytes
    #[arg(long, help_heading = heading::OUTPUT)]
    kernels: bool,

    /// Print the WGSL of a kernel, each part with its file and line, and nothing else
    #[arg(long, help_heading = heading::OUTPUT, value_name = "KERNEL")]
    shader: Option<String>,
}

/// Checks the scene.
pub fn execute(arguments: &Arguments) -> Result<(), Failure> {
    let scene = arguments.ranks.load(&arguments.scene, None)?;
    let mut warnings: Vec<String> =
        scene.notices().iter().chain(&families::warnings(&scene)).map(ToString::to_string).collect();
    warnings.extend(run::lettering(&scene));
    let division = arguments.ranks.division(&scene, None)?;
    warnings.extend(arguments.ranks.warning(division, None));
    let opened = match run::adapter_for_rank(&scene, division, &arguments.ranks.adapter.choice()) {
        Err(error @ (RunError::Scene(_) | RunError::Gpu(GpuError::NoSuchAdapter { .. }))) => return Err(error.into()),
        opened => opened,
    };
    warnings
        .extend(opened.as_ref().ok().and_then(|gpu| unseen_card(gpu.description(), &arguments.ranks.adapter.choice())));
    let hardware = opened.as_ref().map_or(Hardware::default(), Hardware::from);
    let plan_of = |options| run::plan(&scene, hardware, options);
    let plan = plan_of(Options { part: division.map(|division| Part { division, rank: 0 }), ..Options::default() });
    if let Some(kernel) = &arguments.shader {
        return print_exactly(&kernels::shader(&plan, kernel)?);
    }
    let trial = opened.as_ref().ok().filter(|_| scene.time.steps > 0).map(|gpu| run::expected_time(&scene, gpu));
    let adapter = match &opened {
        Ok(gpu) => gpu.description().in_words(),
        Err(RunError::Gpu(GpuError::NoAdapter)) => "no adapter found; this is the plan for any".to_owned(),
        Err(_) => "no adapter that can run it; this is the plan for any".to_owned(),
    };
    // The files are those of all ranks.
    let whole = division.map(|_| plan_of(Options::default()));
    let sizes = Sizes::of(&scene, whole.as_ref().unwrap_or(&plan));
    let time = time(&scene, trial.as_ref());
    let one = if division.is_some() { " of one rank" } else { "" };
    // Means and analyses are of the last stage.
    let measured = scene.at_end();
    let accuracy = predictions::accuracy(&arguments.scene.as_argument(), &measured);
    let of_stage = if scene.stages.is_empty() { "" } else { "; of the last stage" };
    let mut rows = vec![
        ("time", format!("{time}{one}, on {adapter}")),
        ("files", format!("about {}", bytes(sizes.total()))),
        ("memory", memory(&plan)),
        ("accuracy", format!("{accuracy}{of_stage}")),
    ];
    let estimates = measured.model().estimates();
    if !estimates.is_empty() {
        rows.push(("expected", format!("{}{of_stage}", estimates.join(", "))));
    }
    rows.extend(scene.composition());
    let verbose = arguments.verbose || arguments.kernels;
    if verbose {
        rows.extend(overview(&scene, &plan, trial.as_ref()));
    }
    let step = trial.as_ref().and_then(|trial| Some(trial.as_ref().ok()?.step));
    rows.extend(division.into_iter().flat_map(|division| ranks::rows(&scene, division, (step, hardware))));
    if verbose {
        rows.extend(predictions::rows(&arguments.scene.as_argument(), &measured, &plan, hardware));
    }
    let mut text = format!("{}\n{}", printable::name(&scene.title), labelled(rows, "  "));
    if verbose {
        text.push_str(&files::outputs(&scene, &sizes));
    } else {
        text.push_str("  -v says what the scene consists of, how long its steps may be, and when files are written\n");
    }
    if arguments.kernels {
        kernels::kernels(&mut text, &plan)?;
    }
    for warning in &warnings {
        let _ = writeln!(text, "\nwarning: {warning}");
    }
    print(&text)?;
    opened?;
    match trial {
        Some(Err(
            error @ (RunError::Gpu(_) | RunError::UnstableTrial(_) | RunError::Engine(EngineError::GaveUp { .. })),
        )) => Err(error.into()),
        Some(Ok(ExpectedTime { unstable: Some(unstable), .. })) => Err(RunError::UnstableTrial(unstable).into()),
        _ => Ok(()),
    }
}

/// The memory that a run takes, in words.
fn memory(plan: &Plan) -> String {
    let each = match (plan.particles, &plan.part) {
        (0, _) => String::new(),
        (_, Some(_)) => ", for a rank".to_owned(),
        (count, None) => format!(", {:.1} bytes a particle", plan.bytes() as f64 / count as f64),
    };
    let [device, host] = [plan.bytes(), plan.host_bytes()].map(bytes);
    format!("{device} in the memory of an adapter{each}; at least {host} in that of this machine")
}

/// The trial of the first steps, if there was one.
type Tried<'t> = Option<&'t Result<ExpectedTime, RunError>>;

/// How long the run takes here, in words.
fn time(scene: &Checked, trial: Tried<'_>) -> String {
    let what = format!("{} steps of {} particles", grouped(scene.time.steps), grouped(scene.model().particle_count()));
    match trial {
        None => format!("{what}; how long they take is not known"),
        Some(Err(_)) => format!("{what}; how long they take is not known, for the first ones failed"),
        Some(Ok(ExpectedTime { seconds, drawing, factor, .. })) => format!(
            "about {} for {what}, and {} for pictures, within a factor of {factor}",
            duration(*seconds),
            duration(*drawing)
        ),
    }
}

/// The basis of the estimate of time.
fn basis(trial: Tried<'_>) -> Option<String> {
    Some(match trial? {
        Err(error) => format!("a trial of the first steps ended with: {error}"),
        Ok(expected) if expected.of_scene => format!("{} steps of the scene were timed", grouped(expected.steps)),
        Ok(_) => "from the arithmetic of the scene and the speed of a small fluid".to_owned(),
    })
}

/// A time in two units, or with two digits.
fn duration(seconds: f64) -> String {
    match seconds {
        ..0.1 => format!("{seconds:.1e} s"),
        0.1..10.0 => format!("{seconds:.1} s"),
        10.0..100.0 => format!("{seconds:.0} s"),
        100.0..6000.0 => format!("{:.0} min", seconds / 60.0),
        6000.0..172_800.0 => format!("{:.0} h", seconds / 3600.0),
        172_800.0..63_072_000.0 => format!("{:.0} days", seconds / 86_400.0),
        _ => format!("{:.1e} years", seconds / 31_557_600.0),
    }
}

/// The rows of the overview: names and what is to be said of them.
fn overview(scene: &Checked, plan: &Plan, trial: Tried<'_>) -> Vec<(&'static str, String)> {
    let lengths: Vec<String> = scene.space.lengths.iter().map(ToString::to_string).collect();
    let integrator = match scene.system.particle_integrator() {
        Some(Integrator::GrootWarren { lambda }) => format!("groot-warren, λ = {lambda}"),
        Some(Integrator::Splitting { relaxation: Some(PairRelaxation::MeanField) }) => {
            "splitting, one stage".to_owned()
        }
        Some(Integrator::Splitting { relaxation: Some(PairRelaxation::TwoStages) }) => {
            "splitting, two stages".to_owned()
        }
        _ => scene.system.integrator_name().to_owned(),
    };
    let particles = scene.model().particles_in_words();
    let cells =
        plan.cells[..lengths.len()].iter().map(|count| grouped((*count).into())).collect::<Vec<_>>().join(" × ");
    let dimensions = counted(lengths.len() as u64, "dimension");
    let mut rows = vec![("particles", format!("{particles} in {dimensions}, box {}", lengths.join(" × ")))];
    rows.extend(basis(trial).map(|basis| ("estimate", basis)));
    let (step, steps) = (scene.time.step, grouped(scene.time.steps));
    rows.push(("integrator", format!("{integrator}, time step {step}, {steps} steps")));
    rows.extend(stages(scene).map(|stages| ("stages", stages)));
    rows.extend(families::start_in_words(scene).map(|start| ("start", start)));
    rows.extend(scene.description(plan, &cells));
    let operations = grouped(plan.operations_per_particle as u64);
    rows.push(("arithmetic", format!("about {operations} operations a particle and step")));
    rows
}

/// The stages of a run with what changes where each begins, if it has some.
fn stages(scene: &Checked) -> Option<String> {
    let described = scene.stages.iter().map(|stage| {
        let ramps = stage.ramp.iter().map(|(key, ends)| format!("{key} along {ends}"));
        let set = stage.set.iter().map(|(key, value)| format!("{key} = {value}"));
        let push_off = stage.push_off.map(|force| format!("bonds that pull by {force} at most"));
        let changes: Vec<String> = set.chain(ramps).chain(push_off).collect();
        let steps = format!("{} steps", grouped(stage.steps));
        if changes.is_empty() { steps } else { format!("{steps} with {}", changes.join(", ")) }
    });
    Some(described.collect::<Vec<_>>().join("; ")).filter(|text| !text.is_empty())
}

/// How often something is done.
fn interval(first: u64, every: u64) -> String {
    let every = if every == 1 { "every step".to_owned() } else { format!("every {} steps", grouped(every)) };
    if first == 0 { every } else { format!("{every} from step {}", grouped(first)) }
}
