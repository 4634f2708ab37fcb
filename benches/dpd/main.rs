//! What a particle-step of the DPD fluid costs: compared with LAMMPS, by stage, in small runs, by integrator, with bonds, and
//! computed otherwise.
//!
//! `cargo bench --bench dpd` prints tables in Markdown and takes some minutes; `cargo bench --bench dpd -- --quick` is a
//! look that proves nothing. All that is compared is measured in turns within one run, and ratios are taken round by
//! round, so that a machine that slows down for a while slows both sides. LAMMPS is left out where it is not
//! installed (see `lammps.rs`). The adapter is the best, or the one that `MESOSCOPE_ADAPTER` names.

mod alternatives;
#[path = "../common/mod.rs"]
mod common;
mod fluid;
mod lammps;
mod melt;

use clap::Parser;
use mesoscope::gpu::Gpu;
use mesoscope::plan::{Hardware, Options};

use common::statistics::{grouped, ratios, spread};
use common::timing::{Timing, Turns};
use common::{Failure, Report};
use fluid::{Fluid, INTEGRATORS};
use lammps::Lammps;

const TIME_STEPS: [f64; 2] = [0.01, 0.04];
/// From here on a run of LAMMPS takes seconds: fewer rounds, and the skin found for the size before.
const LARGE: usize = 500_000;
/// The largest fluid below is the one that is computed otherwise.
const MANY: usize = 100_000;

/// Cost of the DPD fluid.
#[derive(Debug, Parser)]
struct Settings {
    /// Edges of the boxes; the largest is left out if it is to be quick
    #[arg(long, value_delimiter = ',', default_values_t = [10.0, 20.0, 40.0, 69.34])]
    edges: Vec<f64>,
    /// The melt of chains alone
    #[arg(long)]
    melt: bool,
    /// Leave LAMMPS out
    #[arg(long)]
    no_lammps: bool,
    #[command(flatten)]
    timing: Timing,
}

fn main() -> Result<(), Failure> {
    let mut settings: Settings = common::settings();
    let turns = settings.timing.or(7, 0.5);
    if settings.timing.quick {
        settings.edges.retain(|&edge| edge < 50.0);
    }
    let plan = |edge: &f64| {
        Ok(common::plan_of(&fluid::scene(*edge, "splitting", 0.04)?, Hardware::default(), Options::default()))
    };
    let gpu = common::open_for(settings.edges.iter().map(plan))?;
    let peer = if settings.no_lammps {
        Err("left out".to_owned())
    } else {
        Lammps::start().and_then(|mut lammps| lammps.version())
    };
    let words = peer.as_ref().map_or_else(|reason| format!("none ({reason})"), Clone::clone);
    let report = Report::begin("The DPD fluid: cost of a particle-step", &gpu, &format!("LAMMPS: {words}"));
    let fluids = settings.edges.iter().map(|&edge| Fluid::equilibrated(&gpu, edge)).collect::<Result<Vec<_>, _>>()?;
    if settings.melt {
        for fluid in &fluids {
            melt::compare(&gpu, fluid, peer.is_ok(), turns)?;
        }
        report.end();
        return Ok(());
    }
    let price = beside_lammps(&gpu, &fluids, peer.is_ok(), turns)?;
    price_of_accuracy(&price);
    by_stage(&gpu, &fluids, turns)?;
    by_size(&gpu, &fluids, turns.at_most(5))?;
    by_batch(&gpu, &fluids, turns.at_most(5).half())?;
    if let Some(fluid) = fluids.iter().rfind(|fluid| fluid.particles() < MANY) {
        melt::compare(&gpu, fluid, peer.is_ok(), turns)?;
        alternatives::compare(&gpu, fluid, &INTEGRATORS, turns)?;
    }
    println!("\n### Start-up\n\n{}", common::start_up::in_words(&gpu)?);
    report.end();
    Ok(())
}

/// Cost of a step of `splitting` in steps of `groot-warren`, round by round.
struct Price {
    particles: usize,
    time_step: f64,
    ratios: Vec<f64>,
}

fn beside_lammps(gpu: &Gpu, fluids: &[Fluid], peer: bool, turns: Turns) -> Result<Vec<Price>, Failure> {
    println!(
        "\n### Speed\n\nMillion particle-steps a second: median (least–most) of rounds in turns; × is the ratio in a round.\n"
    );
    println!("| particles | time step | integrator | mesoscope | LAMMPS | × LAMMPS | skin of LAMMPS |");
    println!("|--:|--:|:--|--:|--:|--:|--:|");
    let mut prices = Vec::new();
    let mut skins = [None; TIME_STEPS.len()];
    for fluid in fluids {
        let particles = fluid.particles();
        let rounds = if particles > LARGE { turns.rounds.min(3) } else { turns.rounds };
        let mut lammps = if peer { Some(Lammps::start()?) } else { None };
        if let Some(lammps) = &mut lammps {
            lammps.fluid(&fluid.model, &fluid.state)?;
        }
        for (time_step, tuned) in TIME_STEPS.into_iter().zip(&mut skins) {
            let mut runs = Vec::new();
            for integrator in INTEGRATORS {
                runs.push(fluid.run(gpu, integrator, time_step)?);
            }
            // Several times as many as between two neighbour lists.
            let mut lammps_steps = 0;
            if let Some(lammps) = &mut lammps {
                let skin = match *tuned {
                    Some(skin) if particles > LARGE => skin,
                    _ => lammps.tune(time_step, particles, turns.seconds)?,
                };
                *tuned = Some(skin);
                lammps.set_time(time_step, skin)?;
                let least = lammps::fewest_steps(time_step);
                let warm = lammps.run(least)? / least as f64;
                lammps_steps = ((turns.seconds / warm) as u64).max(least);
            }
            let mut ours = [Vec::new(), Vec::new()];
            let mut theirs = Vec::new();
            for _ in 0..rounds {
                ours[0].push(1e-6 * runs[0].rate(turns.seconds)?);
                if let Some(lammps) = &mut lammps {
                    let seconds = lammps.run(lammps_steps)?;
                    theirs.push(1e-6 * (lammps_steps * particles as u64) as f64 / seconds);
                }
                ours[1].push(1e-6 * runs[1].rate(turns.seconds)?);
            }
            for (integrator, ours) in INTEGRATORS.iter().zip(&ours) {
                println!(
                    "| {} | {time_step} | `{integrator}` | {} | {} | {} | {} |",
                    grouped(particles),
                    spread(ours, 2),
                    spread(&theirs, 2),
                    spread(&ratios(ours, &theirs), 2),
                    tuned.map_or_else(|| "–".to_owned(), |skin| skin.to_string()),
                );
            }
            prices.push(Price { particles, time_step, ratios: ratios(&ours[0], &ours[1]) });
        }
    }
    Ok(prices)
}

fn price_of_accuracy(prices: &[Price]) {
    println!(
        "\n### Price of accuracy\n\nCost of a step of `splitting` in steps of `groot-warren`, from the rounds above.\n"
    );
    println!("| particles | time step | cost |");
    println!("|--:|--:|--:|");
    for price in prices {
        println!("| {} | {} | {} |", grouped(price.particles), price.time_step, spread(&price.ratios, 3));
    }
    let all: Vec<f64> = prices.iter().flat_map(|price| price.ratios.iter().copied()).collect();
    println!("| all | all | {} |", spread(&all, 3));
}

fn by_stage(gpu: &Gpu, fluids: &[Fluid], turns: Turns) -> Result<(), Failure> {
    println!("\n### Where the time of a step goes");
    for fluid in fluids {
        for integrator in INTEGRATORS {
            let mut run = fluid.run(gpu, integrator, 0.04)?;
            let particles = fluid.particles();
            let (how, stages, step) = run.stages(turns.seconds)?;
            let sum: f64 = stages.iter().map(|stage| stage.seconds).sum();
            println!("\n{} particles, `{integrator}`, time step 0.04; {how}.\n", grouped(particles));
            println!("| kernel | µs a step | ns a particle | share |");
            println!("|:--|--:|--:|--:|");
            let row = |name: &str, seconds: f64| {
                let nanoseconds = 1e9 * seconds / particles as f64;
                println!("| {name} | {:.0} | {nanoseconds:.2} | {:.1} % |", 1e6 * seconds, 100.0 * seconds / sum);
            };
            for stage in &stages {
                row(stage.name, stage.seconds);
            }
            row("sum", sum);
            row("step of a batch", step);
        }
    }
    Ok(())
}

fn by_size(gpu: &Gpu, fluids: &[Fluid], turns: Turns) -> Result<(), Failure> {
    let Some(reference) = fluids.iter().rposition(|fluid| fluid.particles() < LARGE) else { return Ok(()) };
    let named = grouped(fluids[reference].particles());
    println!(
        "\n### Cost by size\n\nCost of a particle-step relative to that at {named} particles in the same round; time step 0.04.\n"
    );
    println!("| particles | `groot-warren` | `splitting` |");
    println!("|--:|--:|--:|");
    let mut costs = vec![[Vec::new(), Vec::new()]; fluids.len()];
    for (place, integrator) in INTEGRATORS.into_iter().enumerate() {
        let mut runs = Vec::new();
        for fluid in fluids {
            runs.push(fluid.run(gpu, integrator, 0.04)?);
        }
        let rates = turns.rates(&mut runs.iter_mut().collect::<Vec<_>>())?;
        for (costs, rates) in costs.iter_mut().zip(rates) {
            costs[place] = rates.into_iter().map(f64::recip).collect();
        }
    }
    for (fluid, both) in fluids.iter().zip(&costs) {
        let relative = |place: usize| spread(&ratios(&both[place], &costs[reference][place]), 3);
        println!("| {} | {} | {} |", grouped(fluid.particles()), relative(0), relative(1));
    }
    Ok(())
}

fn by_batch(gpu: &Gpu, fluids: &[Fluid], turns: Turns) -> Result<(), Failure> {
    const BATCHES: [u64; 5] = [1, 4, 16, 64, 256];
    let Some(fluid) = fluids.iter().min_by_key(|fluid| fluid.particles()) else { return Ok(()) };
    println!(
        "\n### Steps a submission\n\nMillion particle-steps a second of {} particles, `splitting`, time step 0.04.\n",
        grouped(fluid.particles())
    );
    println!("| steps a submission | speed |");
    println!("|--:|--:|");
    let mut run = fluid.run(gpu, "splitting", 0.04)?;
    let mut rates = BATCHES.map(|_| Vec::new());
    for _ in 0..turns.rounds {
        for (rates, batch) in rates.iter_mut().zip(BATCHES) {
            rates.push(1e-6 * run.rate_batched(turns.seconds, batch)?);
        }
    }
    for (rates, batch) in rates.iter().zip(BATCHES) {
        println!("| {batch} | {} |", spread(rates, 2));
    }
    Ok(())
}
