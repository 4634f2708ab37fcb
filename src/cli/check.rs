//! `mesoscope check`: what a scene requires.

use std::fmt::Write as _;

use mesoscope::engine::EngineError;
use mesoscope::families::{self, Model, NETWORK_VISCOSITY, ShallowWater};
use mesoscope::gpu::{self, GpuError};
use mesoscope::numbers::{bytes, grouped, six_digits};
use mesoscope::output::files;
use mesoscope::plan::smoothing::iterations;
use mesoscope::plan::{self, Hardware, Layout, Options, Plan, TIDYING};
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
    text.push_str(&outputs(&scene, &model, &sizes));
    if arguments.kernels {
        kernels(&mut text, &plan)?;
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

/// All kernels, stage by stage, and the buffers.
fn kernels(text: &mut String, plan: &Plan) -> Result<(), Failure> {
    let tidying = format!("Every {TIDYING} steps: put them in order in memory too");
    let stages = [
        ("Once, before the first step", &plan.prepare),
        ("Every step: order the particles by cell", &plan.sort),
        (tidying.as_str(), &plan.tidy),
        ("Every step: before anything is measured", &plan.before_report),
        ("Every step without a measurement", &plan.advance),
        ("Every step with a measurement: measure", &plan.report),
        ("Every step with a measurement: finish it", &plan.finish_report),
    ];
    let shared = Shared::of(plan)?;
    if !shared.modules.is_empty() {
        text.push_str("\nShared by all kernels that see particles\n");
    }
    wrapped(text, "modules", shared.modules.iter().map(|module| (*module).to_owned()));
    wrapped(text, "constants", shared.constants.iter().filter_map(|name| constant(&plan.constants, name)));
    let mut described = Vec::new();
    for (heading, kernels) in stages {
        section(text, heading, plan, kernels, &shared, &mut described)?;
    }
    for sampler in &plan.samplers {
        let heading = format!("{}: {}", sampler.id.name(), interval(sampler.first, sampler.every));
        section(text, &heading, plan, &sampler.kernels, &shared, &mut described)?;
    }
    buffers(text, plan);
    Ok(())
}

fn interval(first: u64, every: u64) -> String {
    let every = if every == 1 { "every step".to_owned() } else { format!("every {} steps", grouped(every)) };
    if first == 0 { every } else { format!("{every} from step {}", grouped(first)) }
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

fn constant(constants: &[(&'static str, f64)], name: &str) -> Option<String> {
    let (name, value) = constants.iter().find(|(known, _)| *known == name)?;
    Some(format!("{name} = {}", six_digits(*value)))
}

/// What all kernels that see particles have in common, so that it need not be said of each.
struct Shared {
    modules: Vec<&'static str>,
    constants: Vec<String>,
}

impl Shared {
    fn of(plan: &Plan) -> Result<Self, Failure> {
        let mut shared: Option<Self> = None;
        for kernel in plan
            .kernels
            .iter()
            .filter(|kernel| kernel.modules.iter().any(|module| module.starts_with("common/particle")))
        {
            let constants = gpu::link(kernel.name, &kernel.modules)?.overrides;
            // A constant that a kernel sets for itself is not shared.
            let own = |name: &String| kernel.constants.iter().any(|(known, _)| known == name);
            match &mut shared {
                None => {
                    let constants = constants.into_iter().filter(|name| !own(name)).collect();
                    shared = Some(Self { modules: kernel.modules.clone(), constants });
                }
                Some(shared) => {
                    shared.modules.retain(|module| kernel.modules.contains(module));
                    shared.constants.retain(|name| constants.contains(name) && !own(name));
                }
            }
        }
        Ok(shared.unwrap_or(Self { modules: Vec::new(), constants: Vec::new() }))
    }

    /// Whether a kernel with these modules is one of those.
    fn among(&self, modules: &[&'static str]) -> bool {
        self.modules.iter().all(|module| modules.contains(module))
    }
}

/// Kernels under a heading; one that has been described before is only named.
fn section(
    text: &mut String,
    heading: &str,
    plan: &Plan,
    kernels: &[usize],
    shared: &Shared,
    described: &mut Vec<usize>,
) -> Result<(), Failure> {
    if kernels.is_empty() {
        return Ok(());
    }
    let _ = writeln!(text, "\n{heading}");
    for (place, &index) in kernels.iter().enumerate() {
        if kernels[..place].contains(&index) {
            continue;
        }
        let kernel = &plan.kernels[index];
        let noun = if kernel.workgroups == 1 { "workgroup" } else { "workgroups" };
        let times = match kernels.iter().filter(|other| **other == index).count() {
            1 => String::new(),
            count => format!(", {count} times"),
        };
        let _ = writeln!(text, "  {}, {} {noun}{times}", kernel.name, grouped(kernel.workgroups.into()));
        if described.contains(&index) {
            continue;
        }
        described.push(index);
        let linked = gpu::link(kernel.name, &kernel.modules)?;
        let own = |name: &&&'static str| !shared.among(&kernel.modules) || !shared.modules.contains(name);
        wrapped(text, "modules", kernel.modules.iter().filter(own).map(|module| (*module).to_owned()));
        // A kernel's own constants come before those of the plan, as in the engine.
        let constants = [&kernel.constants[..], &plan.constants].concat();
        let own =
            linked.overrides.iter().filter(|name| !shared.among(&kernel.modules) || !shared.constants.contains(*name));
        wrapped(text, "constants", own.filter_map(|name| constant(&constants, name)));
        let buffer = |variable: &str| {
            let renamed = kernel.renamed.iter().find(|(name, _)| *name == variable);
            renamed.map_or(variable, |(_, buffer)| buffer).to_owned()
        };
        wrapped(text, "buffers", linked.bindings.iter().map(|binding| buffer(&binding.name)));
    }
    Ok(())
}

/// A label and a list, broken into lines of at most 110 characters.
fn wrapped(text: &mut String, label: &str, items: impl Iterator<Item = String>) {
    let mut line = format!("      {label:<9} ");
    let indent = line.len();
    let mut items = items.peekable();
    if items.peek().is_none() {
        return;
    }
    while let Some(item) = items.next() {
        if line.chars().count() > indent && line.chars().count() + item.chars().count() > 109 {
            let _ = writeln!(text, "{}", line.trim_end());
            line = " ".repeat(indent);
        }
        line.push_str(&item);
        if items.peek().is_some() {
            line.push_str(", ");
        }
    }
    let _ = writeln!(text, "{line}");
}

fn buffers(text: &mut String, plan: &Plan) {
    let rows: Vec<Vec<String>> = plan
        .buffers
        .iter()
        .map(|buffer| (buffer.name, buffer.bytes, buffer.purpose))
        .chain(plan.textures.iter().map(|texture| (texture.name, texture.bytes(), texture.purpose)))
        .map(|(name, size, purpose)| vec![name.to_owned(), bytes(size), purpose.to_owned()])
        .collect();
    let title = if plan.textures.is_empty() { "Buffers" } else { "Buffers and textures" };
    let _ = write!(text, "\n{title}\n{}", aligned(&rows, "  "));
}

fn outputs(scene: &Scene, model: &Model, sizes: &Sizes) -> String {
    let output = &scene.output;
    let mut rows = vec![
        (files::ENERGIES.to_owned(), sized(&format!("a row {}", interval(0, output.energies.every)), sizes.energies)),
        (format!("{}, {}", files::ENERGIES_PLOT, files::SUMMARY), "at the end".to_owned()),
        (
            files::CHECKPOINT.to_owned(),
            sized(&format!("{} and at the end", interval(0, output.checkpoint.every)), sizes.checkpoint),
        ),
    ];
    if model.shallow_water().is_some() {
        let fields = output.fields.clone().unwrap_or_default();
        for quantity in fields.quantities {
            let stem = quantity.stem();
            rows.push((format!("{stem}.png, {stem}.npy"), "at the end".to_owned()));
            if fields.every > 0 {
                rows.push((format!("{stem}-….png, {stem}-….npy"), interval(0, fields.every)));
            }
        }
    } else if model.units.dimension > 1 {
        rows.push((files::SNAPSHOT.to_owned(), "at the end".to_owned()));
        if output.snapshot.every > 0 {
            rows.push(("snapshot-….png".to_owned(), sized(&interval(0, output.snapshot.every), sizes.numbered)));
        }
    }
    if let Some(trajectory) = &output.trajectory {
        let name = files::trajectory(trajectory.format);
        rows.push((name.to_owned(), sized(&format!("a frame {}", interval(0, trajectory.every)), sizes.trajectory)));
    }
    rows.extend(analyses(scene, model));
    let rows: Vec<Vec<String>> = rows.into_iter().map(|(name, when)| vec![name, when]).collect();
    format!("\nFiles\n{}", aligned(&rows, "  "))
}

/// When a file is written and how long it becomes.
fn sized(when: &str, size: u64) -> String {
    format!("{when}, about {}", bytes(size))
}

/// Files of the analyses, which are written at the end.
fn analyses(scene: &Scene, model: &Model) -> Vec<(String, String)> {
    let mut rows = Vec::new();
    for asked in run::asked_analyses(scene, model) {
        let sampled = format!("sampled {}", interval(asked.first, asked.every));
        let when = asked.detail.map_or(sampled.clone(), |detail| format!("{detail}, {sampled}"));
        rows.extend(asked.id.tables().iter().map(|names| (format!("{}, {}", names.file, names.plot), when.clone())));
    }
    rows
}
