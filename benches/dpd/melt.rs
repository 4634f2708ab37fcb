//! A melt of chains: the price of bonds, and the same melt in LAMMPS.

use mesoscope::gpu::Gpu;
use mesoscope::plan::Options;
use mesoscope::scene::{self, Checked};
use mesoscope::state::State;

use crate::common::statistics::{grouped, ratios, spread};
use crate::common::timed::Run;
use crate::common::timing::Turns;
use crate::fluid::{self, Fluid, INTEGRATORS};
use crate::lammps::{self, Lammps};
use crate::{Failure, TIME_STEPS};

/// Particles of a chain, and the stiffness of its springs: those of Groot and Madden, doi:10.1063/1.476300.
const BEADS: u64 = 10;
const STIFFNESS: f64 = 4.0;
/// Steps of 0.04 from random walks to the melt.
const EQUILIBRATION: u64 = 400;

/// Melts as large as a fluid.
fn scene(edge: f64, chains: u64, integrator: &str, time_step: f64) -> Result<Checked, Failure> {
    let mut changes = fluid::changes(edge, integrator, time_step);
    changes.push(format!(
        r#"particles=[{{"species":"A","count":{},"chain":{{"beads":{BEADS},"spacing":0.9}}}}]"#,
        chains * BEADS
    ));
    changes.push(format!(
        r#"interactions=[{{"type":"dpd","repulsion":25,"friction":4.5}},
            {{"type":"bonds","potential":{{"type":"harmonic","stiffness":{STIFFNESS}}}}}]"#
    ));
    Ok(scene::load("dpd-fluid", &changes)?)
}

/// Compares a melt with the fluid of as many particles, and with LAMMPS.
pub fn compare(gpu: &Gpu, fluid: &Fluid, peer: bool, turns: Turns) -> Result<(), Failure> {
    let chains = fluid.particles() as u64 / BEADS;
    let particles = (chains * BEADS) as usize;
    let start = scene(fluid.edge, chains, "groot-warren", 0.04)?;
    let model = start.model();
    let mut engine = fluid::engine(gpu, &start, &mesoscope::families::initial_state(&start), Options::default())?;
    engine.advance(EQUILIBRATION, 16)?;
    let state = State { step: 0, ..engine.state()? };
    let mut lammps = if peer { Some(Lammps::start()?) } else { None };
    if let Some(lammps) = &mut lammps {
        lammps.melt(model, &state, BEADS, STIFFNESS)?;
    }
    println!(
        "\n### A melt of chains of {BEADS}\n\n{} particles. Million particle-steps a second; × is the ratio in a round.\n",
        grouped(particles)
    );
    println!("| time step | integrator | melt | cost, simple fluid = 1 | LAMMPS | × LAMMPS | skin of LAMMPS |");
    println!("|--:|:--|--:|--:|--:|--:|--:|");
    for time_step in TIME_STEPS {
        let (mut skin, mut steps) = (None, 0);
        if let Some(lammps) = &mut lammps {
            let tuned = lammps.tune(time_step, particles, turns.seconds)?;
            lammps.set_time(time_step, tuned)?;
            let least = lammps::fewest_steps(time_step);
            steps = ((turns.seconds / (lammps.run(least)? / least as f64)) as u64).max(least);
            skin = Some(tuned);
        }
        for integrator in INTEGRATORS {
            let mut simple = fluid.run(gpu, integrator, time_step)?;
            let melt = scene(fluid.edge, chains, integrator, time_step)?;
            let mut bonded = Run::new(fluid::engine(gpu, &melt, &state, Options::default())?, particles)?;
            let (mut ours, mut without, mut theirs) = (Vec::new(), Vec::new(), Vec::new());
            for _ in 0..turns.rounds {
                ours.push(1e-6 * bonded.rate(turns.seconds)?);
                without.push(1e-6 * simple.rate(turns.seconds)?);
                if let Some(lammps) = &mut lammps {
                    theirs.push(1e-6 * (steps * particles as u64) as f64 / lammps.run(steps)?);
                }
            }
            println!(
                "| {time_step} | `{integrator}` | {} | {} | {} | {} | {} |",
                spread(&ours, 2),
                spread(&ratios(&without, &ours), 2),
                spread(&theirs, 2),
                spread(&ratios(&ours, &theirs), 2),
                skin.map_or_else(|| "–".to_owned(), |skin| skin.to_string()),
            );
        }
    }
    Ok(())
}
