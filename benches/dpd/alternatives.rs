//! The same fluid computed otherwise: species, noise, and what a plan is free to choose.

use mesoscope::engine::Engine;
use mesoscope::gpu::Gpu;
use mesoscope::plan::{Options, Traversal};
use mesoscope::scene;
use mesoscope::state::State;

use crate::Failure;
use crate::common::plan_of;
use crate::common::statistics::{grouped, ratios, spread};
use crate::common::timed::Run;
use crate::common::timing::Turns;
use crate::fluid::Fluid;

struct Alternative {
    name: &'static str,
    species: u16,
    /// Mass of all species but the first, whose mass is 1.
    mass: f64,
    noise: &'static str,
    options: fn() -> Options,
}

const UNIFORM: &str = "uniform";
const ALTERNATIVES: [Alternative; 6] = [
    Alternative { name: "two species", species: 2, mass: 1.0, noise: UNIFORM, options: Options::default },
    Alternative {
        name: "two species, masses 1 and 2",
        species: 2,
        mass: 2.0,
        noise: UNIFORM,
        options: Options::default,
    },
    Alternative { name: "eight species", species: 8, mass: 1.0, noise: UNIFORM, options: Options::default },
    Alternative { name: "Gaussian noise", species: 1, mass: 1.0, noise: "gaussian", options: Options::default },
    Alternative {
        name: "buffers where software adapters have textures",
        species: 1,
        mass: 1.0,
        noise: UNIFORM,
        options: || Options { serial_memory: Some(false), ..Options::default() },
    },
    Alternative {
        name: "one invocation a particle, without subgroups",
        species: 1,
        mass: 1.0,
        noise: UNIFORM,
        options: || Options { traversal: Some(Traversal::Rows), ..Options::default() },
    },
];

impl Alternative {
    fn run<'a>(&self, gpu: &'a Gpu, fluid: &Fluid, integrator: &str) -> Result<Run<'a>, Failure> {
        // The same particles under several names, in turns: where masses are equal they do the same, and every pair looks its
        // coefficients up.
        let names: Vec<String> = (0..self.species).map(|number| format!("fluid {number}")).collect();
        let density = 3.0 / f64::from(self.species);
        let groups: Vec<serde_json::Value> = (names.iter())
            .enumerate()
            .map(|(number, name)| {
                let mass = if number == 0 { 1.0 } else { self.mass };
                serde_json::json!({ "species": name, "number_density": density, "mass": mass })
            })
            .collect();
        let mut changes = crate::fluid::changes(fluid.edge, integrator, 0.04);
        changes.push(format!("particles={}", serde_json::Value::from(groups)));
        changes.push(format!(r#"noise={{"distribution":"{}"}}"#, self.noise));
        let scene = scene::load("dpd-fluid", &changes)?;
        let species = (0..self.species).cycle().take(fluid.particles()).map(Into::into).collect();
        let state = State { species, ..fluid.state.clone() };
        let plan = plan_of(&scene, gpu.into(), (self.options)());
        Run::new(Engine::new(gpu, plan, &state)?, fluid.particles())
    }
}

pub fn compare(gpu: &Gpu, fluid: &Fluid, integrators: &[&str], turns: Turns) -> Result<(), Failure> {
    println!(
        "\n### Alternatives\n\nTime of a step relative to the default's of the same integrator, in turns; {} particles, time step 0.04.\n",
        grouped(fluid.particles())
    );
    println!("| alternative | `{}` |", integrators.join("` | `"));
    println!("|:--|{}", "--:|".repeat(integrators.len()));
    for alternative in &ALTERNATIVES {
        let mut cells = vec![alternative.name.to_owned()];
        for integrator in integrators {
            let mut usual = fluid.run(gpu, integrator, 0.04)?;
            let rates = turns.rates(&mut [&mut usual, &mut alternative.run(gpu, fluid, integrator)?])?;
            cells.push(spread(&ratios(&rates[0], &rates[1]), 2));
        }
        println!("| {} |", cells.join(" | "));
    }
    Ok(())
}
