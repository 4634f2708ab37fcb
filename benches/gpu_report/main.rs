//! A report on a graphics card, for who has one: what the driver does to arithmetic, how far the shipped scenes are from their
//! reference, speeds by size and by kernel with their share of what memory allows, start-up, and peers beside it.
//!
//! `make gpu-report` writes one file of Markdown to paste. Each part is written as soon as it is measured, and a part that fails
//! says why and leaves the others alone. The adapter is the best, or the one that `MESOSCOPE_ADAPTER` names.

#[path = "../common/mod.rs"]
mod common;
#[allow(dead_code)]
#[path = "../hpm/flow.rs"]
mod flow;
#[allow(dead_code)]
#[path = "../dpd/fluid.rs"]
mod fluid;
#[allow(dead_code)]
#[path = "../dpd/lammps.rs"]
mod lammps;
mod peers;

use std::fmt::Write as _;
use std::path::PathBuf;

use clap::Parser;
use mesoscope::gpu::{AdapterKind, Gpu, Requirements};
use mesoscope::numbers::{bytes, six_digits};
use mesoscope::plan::{Hardware, Options, Plan, Traversal};
use mesoscope::scene::{self, Checked};
use mesoscope::self_test::{self, Verdict};

use common::statistics::{grouped, median, spread};
use common::timed::Run;
use common::timing::{Timing, Turns};
use common::{Failure, bandwidth, machine, plan_of, start_up};
use flow::{Flow, Size, Start};
use fluid::{Fluid, INTEGRATORS};

/// Edges of the boxes of the fluid, from 3 000 to 10⁸ particles.
const EDGES: [f64; 6] = [10.0, 20.0, 40.0, 69.34, 149.38, 321.83];
const TIME_STEPS: [f64; 2] = [0.01, 0.04];
/// Nodes of the meshes of water along an axis, with 16 particles a cell.
const MESHES: [u32; 4] = [64, 256, 1024, 4096];
/// Steps after which shipped scenes are compared with their reference.
const COMPARED: u64 = 10;
/// Particles of the largest scene whose reference takes less than seconds.
const FEW: u64 = 70_000;

/// A report on a graphics card.
#[derive(Debug, Parser)]
struct Settings {
    /// The file of the report
    #[arg(long, default_value = "gpu-report.md")]
    out: PathBuf,
    /// The most particles of a scene [default: 200 000 on a software adapter, else as many as fit]
    #[arg(long)]
    most: Option<u64>,
    #[command(flatten)]
    timing: Timing,
}

fn main() -> Result<(), Failure> {
    let settings: Settings = common::settings();
    let gpu = common::open(Requirements::default())?;
    let is_software = gpu.description().kind == AdapterKind::Software;
    let most = settings.most.unwrap_or(if is_software { 200_000 } else { u64::MAX });
    let mut report = Report { gpu, most, turns: settings.timing.or(5, 0.4), text: String::new(), out: settings.out };
    report.text.push_str("# mesoscope on a graphics card\n\n");
    let described = machine::describe(report.gpu.description(), &peers::known());
    writeln!(report.text, "{described}\n- one binding holds {}", bytes(report.gpu.largest_binding()))?;
    report.part("Self-test", Report::self_test)?;
    report.part("Shipped scenes and their reference", Report::shipped_scenes)?;
    report.part("Memory", Report::memory)?;
    report.part("The standard fluid", Report::fluids)?;
    report.part("Shallow water", Report::water)?;
    report.part("Memory of pairs, Voronoi cells, bonds", Report::others)?;
    report.part("Time by kernel", Report::kernels)?;
    report.part("Start-up", Report::start_up)?;
    report.part("Peers", Report::peers)?;
    eprintln!("wrote {}: paste it into an issue, or send it", report.out.display());
    Ok(())
}

/// A report under way.
struct Report {
    gpu: Gpu,
    most: u64,
    turns: Turns,
    text: String,
    out: PathBuf,
}

impl Report {
    /// Adds a part, and writes what there is.
    fn part(&mut self, title: &str, measure: fn(&mut Self) -> Result<(), Failure>) -> Result<(), Failure> {
        eprintln!("{title} ...");
        write!(self.text, "\n## {title}\n\n")?;
        if let Err(failure) = measure(self) {
            writeln!(self.text, "\n**Failed**: {failure}")?;
        }
        std::fs::write(&self.out, &self.text)?;
        Ok(())
    }

    fn row(&mut self, cells: &[String]) {
        self.text.extend(["| ", &cells.join(" | "), " |\n"]);
    }

    fn self_test(&mut self) -> Result<(), Failure> {
        self.text.push_str("| check | | found |\n|:--|:--|:--|\n");
        let mut rows = Vec::new();
        self_test::run(&self.gpu, &mut |finding| {
            let verdict = match finding.verdict {
                Verdict::Passed => "passed",
                Verdict::Failed => "**failed**",
                Verdict::Noted => "noted",
            };
            rows.push([finding.check, verdict.to_owned(), finding.found]);
        })?;
        for row in &rows {
            self.row(row);
        }
        Ok(())
    }

    /// The adapter, opened with room for a plan, and the plan for it; the reason in words if there is no room.
    fn open_for(&self, scene: &Checked) -> Result<(Gpu, Plan), String> {
        let particles = scene.model().particle_count();
        if particles > self.most {
            return Err("not measured: --most".to_owned());
        }
        let plan = plan_of(scene, Hardware::from(&self.gpu), Options::default());
        let (largest_buffer, storage_buffers) = (plan.largest_buffer(), plan.storage_buffers);
        let requirements = Requirements { largest_buffer, storage_buffers, ..Requirements::default() };
        let gpu = self.gpu.reopen(requirements).map_err(|error| error.to_string())?;
        Ok((gpu, plan))
    }

    fn shipped_scenes(&mut self) -> Result<(), Failure> {
        writeln!(
            self.text,
            "The largest difference from the reference in double precision, as a part of the largest change since the start.\n\n\
             | scene | particles | after a step | after {COMPARED} |\n|:--|--:|--:|--:|"
        )?;
        for builtin in scene::builtin() {
            let scene = scene::load(builtin.name, &[])?;
            let particles = scene.model().particle_count();
            let found = if particles > FEW {
                Err("large".to_owned())
            } else {
                self.open_for(&scene).and_then(|(gpu, _)| self_test::distances_from_reference(&gpu, &scene, COMPARED))
            };
            let [first, last] = found.map_or_else(
                |reason| [reason, String::new()],
                |distances| distances.map(|distance| format!("{distance:.0e}")),
            );
            self.row(&[format!("`{}`", builtin.name), grouped(particles as usize), first, last]);
        }
        Ok(())
    }

    fn memory(&mut self) -> Result<(), Failure> {
        let rates = bandwidth::of_copies(&self.gpu, self.turns.rounds)?;
        writeln!(self.text, "Copies from buffer to buffer read and write {} GB/s.", spread(&rates, 1))?;
        self.text.push_str(
            "\nThe floor of a step below is the time in which every dispatch passes once over every array that it binds, at this rate.\n",
        );
        Ok(())
    }

    /// A row of a scene: rates in millions, and the share of the floor.
    fn speed(&mut self, before: &[String], scene: &Checked, run: impl Fn(&Gpu) -> Result<Vec<f64>, Failure>) {
        let particles = scene.model().particle_count();
        eprintln!("  {} {} particles", before.join(" "), grouped(particles as usize));
        let measured = self.open_for(scene).and_then(|(gpu, plan)| {
            let rates = run(&gpu).map_err(|error| error.to_string())?;
            let bandwidth = bandwidth::of_copies(&gpu, 3).map_err(|error| error.to_string())?;
            let floor = plan.bytes_bound_in_a_step() as f64 / (1e9 * median(&bandwidth));
            Ok((rates, floor))
        });
        let mut cells = before.to_vec();
        cells.push(grouped(particles as usize));
        match measured {
            Ok((rates, floor)) => {
                let millions: Vec<f64> = rates.iter().map(|rate| 1e-6 * rate).collect();
                let share = floor * median(&rates) / particles as f64;
                cells.extend([spread(&millions, 1), format!("{:.0} %", 100.0 * share)]);
            }
            Err(reason) => cells.extend([reason, String::new()]),
        }
        self.row(&cells);
    }

    fn fluids(&mut self) -> Result<(), Failure> {
        self.text.push_str(
            "| time step | integrator | pairs | particles | million particle-steps/s | of the floor |\n|--:|:--|:--|--:|--:|--:|\n",
        );
        // What a card is to decide: docs/hardware.md.
        let ways: &[(&str, Option<Traversal>)] = if Hardware::from(&self.gpu).takes_eights() {
            &[("in eights", None)]
        } else {
            &[("by rows", Some(Traversal::Rows)), ("from a queue", Some(Traversal::Queue))]
        };
        let turns = self.turns;
        for edge in EDGES {
            for time_step in TIME_STEPS {
                for integrator in INTEGRATORS {
                    let scene = fluid::scene(edge, integrator, time_step)?;
                    for &(way, traversal) in ways {
                        let options = Options { traversal, ..Options::default() };
                        self.speed(
                            &[time_step.to_string(), format!("`{integrator}`"), way.to_owned()],
                            &scene,
                            |gpu| {
                                let fluid = Fluid::equilibrated(gpu, edge)?;
                                rates(turns, fluid.run_with(gpu, integrator, time_step, options)?)
                            },
                        );
                    }
                }
            }
        }
        Ok(())
    }

    fn water(&mut self) -> Result<(), Failure> {
        self.text.push_str("| mesh | particles | million particle-steps/s | of the floor |\n|--:|--:|--:|--:|\n");
        let turns = self.turns;
        for mesh in MESHES {
            let size = Size::filled(mesh, 16);
            let scene = flow::scene(size, 1_000_000_000, &[])?;
            self.speed(&[format!("{mesh}²")], &scene, |gpu| {
                let flow = Flow::new(size)?;
                rates(turns, flow.run(gpu, &[], Options::default(), Start::Even)?)
            });
        }
        Ok(())
    }

    fn others(&mut self) -> Result<(), Failure> {
        self.text.push_str("| scene | particles | million particle-steps/s | of the floor |\n|:--|--:|--:|--:|\n");
        let turns = self.turns;
        for (words, scene) in other_scenes()? {
            self.speed(&[words], &scene, |gpu| rates(turns, Run::of_scene(gpu, &scene, Options::default(), 10)?));
        }
        Ok(())
    }

    fn kernels(&mut self) -> Result<(), Failure> {
        let mut scenes = Vec::new();
        for edge in [20.0, 69.34] {
            for integrator in INTEGRATORS {
                scenes.push((format!("fluid, `{integrator}`"), fluid::scene(edge, integrator, 0.04)?));
            }
        }
        scenes.push(("shallow water, 256²".to_owned(), flow::scene(Size::filled(256, 16), 1_000_000_000, &[])?));
        scenes.extend(other_scenes()?);
        for (words, scene) in scenes {
            let particles = scene.model().particle_count() as usize;
            let Ok((gpu, _)) = self.open_for(&scene) else { continue };
            eprintln!("  {words}, {} particles", grouped(particles));
            let mut run = Run::of_scene(&gpu, &scene, Options::default(), 20)?;
            let (how, stages, step) = run.stages(self.turns.seconds)?;
            writeln!(self.text, "\n{words}, {} particles; {how}.\n", grouped(particles))?;
            self.text.push_str("| kernel | µs a step | share |\n|:--|--:|--:|\n");
            let sum: f64 = stages.iter().map(|stage| stage.seconds).sum();
            for stage in &stages {
                let share = format!("{:.1} %", 100.0 * stage.seconds / sum);
                self.row(&[stage.name.to_owned(), six_digits(1e6 * stage.seconds), share]);
            }
            self.row(&["step of a batch".to_owned(), six_digits(1e6 * step), String::new()]);
        }
        Ok(())
    }

    fn start_up(&mut self) -> Result<(), Failure> {
        let words = start_up::in_words(&self.gpu)?;
        self.text.push_str(&words);
        Ok(())
    }

    fn peers(&mut self) -> Result<(), Failure> {
        self.text.push_str(
            "The standard fluid from the same particles, million particle-steps/s.\n\n| peer | particles | time step | rate |\n|:--|--:|--:|--:|\n",
        );
        for edge in EDGES.into_iter().take(4) {
            let scene = fluid::scene(edge, "groot-warren", 0.04)?;
            let Ok((gpu, _)) = self.open_for(&scene) else { continue };
            let fluid = Fluid::equilibrated(&gpu, edge)?;
            for time_step in TIME_STEPS {
                for (peer, rate) in peers::rates(&fluid, time_step, self.turns.seconds) {
                    let rate = rate.map_or_else(|reason| reason, |rate| format!("{:.1}", 1e-6 * rate));
                    self.row(&[peer.to_owned(), grouped(fluid.particles()), time_step.to_string(), rate]);
                }
            }
        }
        Ok(())
    }
}

/// Particle-steps a second, round by round.
fn rates(turns: Turns, mut run: Run<'_>) -> Result<Vec<f64>, Failure> {
    Ok(turns.rates(&mut [&mut run])?.swap_remove(0))
}

/// Shipped scenes of other kinds, as they are and larger.
fn other_scenes() -> Result<Vec<(String, Checked)>, Failure> {
    let quiet = r#"output={"energies":{"every":1000000000}}"#.to_owned();
    let scene = |name: &str, more: &[&str]| {
        let more = more.iter().map(|change| (*change).to_owned());
        let changes: Vec<String> = more.chain([quiet.clone(), "time.steps=1000000000".to_owned()]).collect();
        Ok::<_, Failure>((format!("`{name}`"), scene::load(name, &changes)?))
    };
    let splitting = r#"integrator={"type":"splitting"}"#;
    let cells = |edge: u32| [format!("space.box=[{edge},{edge}]"), format!("particles.0.count={}", edge * edge)];
    let mut scenes = Vec::new();
    for edge in ["space.box=[20,20,20]", "space.box=[70,70,70]"] {
        scenes.push(scene("edpd-fluid", &[edge])?);
    }
    for edge in [70, 300, 1000] {
        let [space, count] = cells(edge);
        let form = r#"interactions.0={"type":"voronoi","viscosity":1}"#;
        scenes.push(scene("voronoi-dpd", &[&space, &count, form, splitting, "time.step=0.002"])?);
    }
    for (edge, count) in [("space.box=[10,10,10]", 1000), ("space.box=[50,50,50]", 125_000)] {
        let counts: Vec<String> = (0..3).map(|group| format!("particles.{group}.count={count}")).collect();
        let [a, b, c] = [0, 1, 2].map(|group| counts[group].as_str());
        scenes.push(scene("polymer-melt", &[edge, a, b, c])?);
    }
    Ok(scenes)
}
