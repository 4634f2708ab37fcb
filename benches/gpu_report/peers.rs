//! Other programs that simulate the same fluid on the same card, where they are installed.

use std::process::{Command, Stdio};
use std::time::Instant;

use super::fluid::Fluid;
use super::lammps::{self, Lammps};

/// Arguments of LAMMPS that computes on a card.
const ON_A_CARD: [&str; 6] = ["-kokkos", "on", "gpus", "1", "-suffix", "kk"];

/// Particle-steps a second, or why there are none.
type Rate = Result<f64, String>;

/// Peers that are here, in words.
pub fn known() -> String {
    let lammps = Lammps::start_with(&ON_A_CARD).and_then(|mut lammps| lammps.version());
    let hoomd = hoomd(&["version"]);
    let words = |answer: Result<String, String>| answer.unwrap_or_else(|reason| format!("none ({reason})"));
    format!("LAMMPS with KOKKOS: {}; HOOMD-blue: {}", words(lammps), words(hoomd))
}

/// What the peers make of a fluid.
pub fn rates(fluid: &Fluid, time_step: f64, seconds: f64) -> Vec<(&'static str, Rate)> {
    vec![("LAMMPS, KOKKOS", of_lammps(fluid, time_step, seconds)), ("HOOMD-blue", of_hoomd(fluid, time_step, seconds))]
}

fn of_lammps(fluid: &Fluid, time_step: f64, seconds: f64) -> Rate {
    let words = |error: crate::Failure| error.to_string();
    let mut lammps = Lammps::start_with(&ON_A_CARD)?;
    lammps.fluid(&fluid.model, &fluid.state).map_err(words)?;
    let skin = lammps.tune(time_step, fluid.particles(), seconds).map_err(words)?;
    lammps.set_time(time_step, skin).map_err(words)?;
    let least = lammps::fewest_steps(time_step);
    let warm = lammps.run(least).map_err(words)? / least as f64;
    let steps = ((seconds / warm) as u64).max(least);
    let taken = lammps.run(steps).map_err(words)?;
    Ok((steps * fluid.particles() as u64) as f64 / taken)
}

/// HOOMD-blue starts from a lattice of its own, which 300 steps melt.
fn of_hoomd(fluid: &Fluid, time_step: f64, seconds: f64) -> Rate {
    let (count, edge) = (fluid.particles().to_string(), fluid.edge.to_string());
    let begun = Instant::now();
    let answer = hoomd(&["fluid", &count, &edge, &time_step.to_string(), &seconds.to_string()])?;
    let rate = answer.parse().map_err(|_| format!("HOOMD-blue answered `{answer}`"))?;
    eprintln!("  HOOMD-blue took {:.0} s", begun.elapsed().as_secs_f64());
    Ok(rate)
}

fn hoomd(arguments: &[&str]) -> Result<String, String> {
    let output = Command::new("python3")
        .arg(concat!(env!("CARGO_MANIFEST_DIR"), "/benches/gpu_report/hoomd_fluid.py"))
        .args(arguments)
        .stdin(Stdio::null())
        .stderr(Stdio::null())
        .output()
        .map_err(|error| format!("python3 does not start: {error}"))?;
    let answer = String::from_utf8_lossy(&output.stdout).trim().to_owned();
    if output.status.success() { Ok(answer) } else { Err(answer.replace("error: ", "")) }
}
