//! `mesoscope check`: what a scene requires.

mod files;
mod kernels;

use std::fmt::Write as _;

use mesoscope::engine::EngineError;
use mesoscope::families::{self, Model, NETWORK_VISCOSITY, ShallowWater};
use mesoscope::gpu::GpuError;
use mesoscope::numbers::{bytes, grouped, six_digits};
use mesoscope::plan::smoothing::iterations;
use mesoscope::plan::{self, Hardware, Layout, Options, Plan};
use mesoscope::printable;
use mesoscope::run::{self, ExpectedTime, RunError, Sizes};
use mesoscope::scene::{
    BathRate, BathScheme, Integrator, Interaction, LaplacianSymbol, MeshBath, Scene, SmoothingSolver, VoronoiForm,
};

use super::table::{aligned, dimensions};
use super::{AdapterArgument, Failure, SceneArguments, print};

/// Check a scene: all mistakes at once, or else what it requires - memory, time, files, warnings
#[derive(Debug, clap::Args)]
#[command(after_help = "\
The time is an estimate: a few steps are run on the adapter and timed, of the scene itself if it is small. That takes about a
quarter of a second, and the adapter has to start and compile the kernels first; without an adapter there is no estimate.

Exit code 0 means that the adapter (the one named, else the best) can run the scene.

Examples:
  mesoscope check my-scene.json
  mesoscope check dpd-fluid --kernels
  mesoscope check dpd-fluid --set particles.0.number_density=4")]
pub struct Arguments {
    #[command(flatten)]
    scene: SceneArguments,

    #[command(flatten)]
    adapter: AdapterArgument,

    /// List kernels, buffers and their bytes too
    #[arg(long)]
    kernels: bool,
}

/// Checks the scene.
pub fn execute(arguments: &Arguments) -> Result<(), Failure> {
    let (scene, notices) = arguments.scene.load()?;
    let model = Model::new(&scene);
    let mut warnings: Vec<String> =
        notices.iter().chain(&families::warnings(&scene)).map(ToString::to_string).collect();
    warnings.extend(run::lettering(&scene));
    let opened = match run::adapter_for(&scene, &arguments.adapter.choice()) {
        Err(error @ (RunError::Scene(_) | RunError::Gpu(GpuError::NoSuchAdapter { .. }))) => return Err(error.into()),
        opened => opened,
    };
    let hardware = opened.as_ref().map_or(Hardware::default(), Hardware::from);
    let plan = plan::plan(&model, scene.time.equilibration, &scene.output, hardware, Options::default());
    let trial = opened.as_ref().ok().filter(|_| scene.time.steps > 0).map(|gpu| run::expected_time(&scene, gpu));
    let time = trial.as_ref().map(|trial| expected_time(&scene, trial));
    let adapter = match &opened {
        Ok(gpu) => gpu.description().name.clone(),
        Err(RunError::Gpu(GpuError::NoAdapter)) => "none here; the plan is the one for any adapter".to_owned(),
        Err(_) => "none that could run it; the plan is the one for any adapter".to_owned(),
    };
    let sizes = Sizes::of(&scene, &model, &plan);
    let mut text = overview(&scene, &model, &plan, &adapter, time, &sizes);
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
        format!("{} steps of it were timed", grouped(expected.steps))
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

fn overview(scene: &Scene, model: &Model, plan: &Plan, adapter: &str, time: Option<String>, sizes: &Sizes) -> String {
    let lengths: Vec<String> = scene.space.lengths.iter().map(ToString::to_string).collect();
    let integrator = match scene.integrator {
        Integrator::GrootWarren { lambda } => format!("groot-warren, λ = {lambda}"),
        _ => scene.integrator.name().to_owned(),
    };
    let memory = match plan.particles {
        0 => bytes(plan.bytes()),
        count => format!("{}, {:.1} bytes a particle", bytes(plan.bytes()), plan.bytes() as f64 / count as f64),
    };
    let particles = match model.shallow_water() {
        Some(water) if water.carriers < plan.particles => {
            let noun = if plan.particles - water.carriers == 1 { "tracer" } else { "tracers" };
            format!("{} of water and {} {noun},", grouped(water.carriers), grouped(plan.particles - water.carriers))
        }
        _ => grouped(plan.particles),
    };
    let cells =
        plan.cells[..lengths.len()].iter().map(|count| grouped((*count).into())).collect::<Vec<_>>().join(" × ");
    let dimensions = dimensions(lengths.len());
    let mut rows =
        vec![("particles", format!("{particles} in {dimensions}, box {}", lengths.join(" × "))), ("memory", memory)];
    rows.extend(time.map(|time| ("time", time)));
    rows.extend([
        ("files", format!("about {}", bytes(sizes.total()))),
        ("adapter", adapter.to_owned()),
        ("integrator", format!("{integrator}, time step {}, {} steps", scene.time.step, grouped(scene.time.steps))),
    ]);
    if let (Some(water), [Interaction::ShallowWater(asked)]) = (model.shallow_water(), scene.interactions.as_slice()) {
        rows.extend(mesh(scene, water, asked.bath.as_ref(), plan, &cells));
    } else {
        let bins = if model.voronoi().is_some() { "search grid" } else { "cells" };
        rows.push((bins, cells));
        rows.extend(list(model, plan));
        rows.extend(fluid_of_cells(model));
    }
    let operations = grouped(plan.operations_per_particle as u64);
    rows.push(("arithmetic", format!("about {operations} operations a particle and step")));
    let rows: Vec<Vec<String>> = rows.into_iter().map(|(name, value)| vec![name.to_owned(), value]).collect();
    format!("{}\n{}", printable::name(&scene.title), aligned(&rows, "  "))
}

/// The list of neighbours and what its pairs take.
fn list(model: &Model, plan: &Plan) -> Option<(&'static str, String)> {
    let (Layout::Coupled { listed: Some(listed), .. }, Some(force)) = (plan.layout, model.pair_force()) else {
        return None;
    };
    let noun = if listed.capacity == 1 { "pair" } else { "pairs" };
    let each = if listed.memory {
        "12 bytes a pair (neighbour 4, memory 8), twice while the list is rebuilt"
    } else {
        "4 bytes a pair"
    };
    let text = format!(
        "within {} of each other (cutoff {}, margin {}), capacity for {} {noun} a particle owns; {each}",
        six_digits(force.cutoff + force.skin),
        six_digits(force.cutoff),
        six_digits(force.skin),
        listed.capacity
    );
    Some(("list", text))
}

/// What a scene says of Voronoi cells.
fn fluid_of_cells(model: &Model) -> Vec<(&'static str, String)> {
    let Some(cells) = model.voronoi() else { return Vec::new() };
    let form = match cells.form {
        VoronoiForm::Gradient => "gradient: constant masses, pressures that follow from a free energy",
        VoronoiForm::Consistent => "consistent: cells exchange mass as their faces turn",
        VoronoiForm::Paper => "paper: cells exchange mass at half the rate that the geometry asks for",
    };
    let mass: f64 = model.species.iter().map(|species| species.mass * species.count as f64).sum();
    let molecules = mass / model.particle_count().max(1) as f64 / cells.molecular_mass;
    let energy = match cells.conductivity {
        Some(conductivity) => format!("kept account of in every cell, heat conductivity {}", six_digits(conductivity)),
        None => "all cells at the temperature of the scene".to_owned(),
    };
    let mut rows = vec![
        ("form", form.to_owned()),
        ("fluid", format!("ideal gas, {} molecules a cell", six_digits(molecules))),
        ("energy", energy),
    ];
    if cells.viscosity > 0.0 {
        let network = NETWORK_VISCOSITY * cells.viscosity;
        let text = format!(
            "{} of friction at faces, about {} of the network of cells; what cells carry by moving comes on top",
            six_digits(cells.viscosity),
            six_digits(network)
        );
        rows.push(("viscosity", text));
        if model.integrator == (Integrator::Splitting {}) {
            let solver = cells.solver;
            let text = format!(
                "conjugate gradients, at most {} iterations, tolerance {}",
                solver.iterations, solver.tolerance
            );
            rows.push(("solver", text));
        }
    }
    rows
}

/// What a scene of shallow water does on its mesh.
fn mesh(
    scene: &Scene,
    water: &ShallowWater,
    bath: Option<&MeshBath>,
    plan: &Plan,
    nodes: &str,
) -> Vec<(&'static str, String)> {
    let lengths = [scene.space.lengths[0], scene.space.lengths[1]];
    let per_node = water.carriers as f64 / water.nodes() as f64;
    let order = water.spline_order;
    let smoothing = &water.smoothing;
    let solver = match smoothing.solver {
        SmoothingSolver::Fft { symbol: LaplacianSymbol::FivePoint } => "fft, five-point".to_owned(),
        SmoothingSolver::Fft { symbol: LaplacianSymbol::Spectral } => "fft, spectral".to_owned(),
        SmoothingSolver::Chebyshev { tolerance } => {
            let count = iterations(water, lengths, tolerance);
            format!("chebyshev, tolerance {tolerance}, {count} iterations")
        }
    };
    let cells = [0, 1].map(|axis| smoothing.length * f64::from(water.mesh[axis]) / lengths[axis]);
    let smoothing = if smoothing.length == 0.0 {
        "none".to_owned()
    } else {
        let (length, power) = (smoothing.length, smoothing.power);
        let length = if length < 1e-3 { format!("{length:.3e}") } else { format!("{length:.4}") };
        format!("{solver}, length {length} ({:.2} × {:.2} cells), power {power}", cells[0], cells[1])
    };
    let storage = match plan.layout {
        Layout::Water { bins: Some(bins), .. } => format!("a bin of {} particles for every cell", bins.capacity),
        _ => "sorted by cell in every step".to_owned(),
    };
    let mut rows = vec![
        ("mesh", format!("{nodes} nodes, splines of order {order}, {per_node:.1} particles a node")),
        ("storage", storage),
        ("smoothing", smoothing),
    ];
    match bath {
        Some(MeshBath::White {}) => rows.push(("bath", "white".to_owned())),
        Some(MeshBath::Memory { epsilon, scheme, rate }) => {
            let scheme = match scheme {
                BathScheme::CotterReich => "cotter-reich",
                BathScheme::Symmetric => "symmetric",
                BathScheme::Exponential => "exponential",
            };
            let rate = if *rate == BathRate::Printed { ", rate as printed" } else { "" };
            rows.push(("bath", format!("memory, epsilon {epsilon}, {scheme}{rate}")));
        }
        None => {}
    }
    let share = water.stability(&scene.integrator, lengths, scene.time.step);
    let clean = water.clean_share();
    rows.push((
        "stability",
        format!(
            "the stiffest wave takes p = {} of the limit of water spread evenly; at random places up to {} is stable",
            six_digits(share),
            if clean < 0.01 { six_digits(clean) } else { format!("{clean:.2}") }
        ),
    ));
    rows
}

/// How often something is done.
fn interval(first: u64, every: u64) -> String {
    let every = if every == 1 { "every step".to_owned() } else { format!("every {} steps", grouped(every)) };
    if first == 0 { every } else { format!("{every} from step {}", grouped(first)) }
}
