//! What a run conserves exactly, what it does not, and why, in words for its summary.

use crate::families::{BathStep, Model, Voronoi};
use crate::scene::{Integrator, NoiseProcess};

/// What some models keep to the last bit: sums of integers, which every report tells.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum KeptQuantity {
    /// Of Voronoi cells that exchange it, or might.
    Mass,
    /// Of shallow water, on the nodes.
    MeshMass,
    /// Of particles or cells.
    Momentum,
    /// Of Voronoi cells that keep account of it.
    Energy,
}

impl KeptQuantity {
    /// Its name in a summary.
    pub(super) fn name(self) -> &'static str {
        match self {
            Self::Mass => "mass",
            Self::MeshMass => "mass on the mesh",
            Self::Momentum => "total momentum",
            Self::Energy => "total energy",
        }
    }
}

/// What a model keeps to the last bit.
pub(super) fn kept(model: &Model) -> Vec<KeptQuantity> {
    use KeptQuantity::{Energy, Mass, MeshMass, Momentum};
    match (model.voronoi(), model.shallow_water()) {
        (Some(cells), _) if cells.keeps_energy() => vec![Mass, Momentum, Energy],
        (Some(_), _) => vec![Mass, Momentum],
        (None, Some(_)) => vec![MeshMass],
        (None, None) if model.conserves_momentum() => vec![Momentum],
        (None, None) => Vec::new(),
    }
}

/// What a run conserves, to the last bit or to rounding where that is said, but for what was seen to be lost.
pub(super) fn conserved(model: &Model, lost: &[KeptQuantity]) -> Vec<String> {
    let mut conserved = Vec::new();
    if model.voronoi().is_none() && model.shallow_water().is_none() {
        // Nothing changes the mass of a particle.
        conserved.push("mass".to_owned());
    }
    let left = kept(model).into_iter().filter(|quantity| !lost.contains(quantity));
    conserved.extend(left.map(|quantity| format!("{}, to the last bit", quantity.name())));
    let loops = model.shallow_water().is_some_and(|water| water.closed_loops().next().is_some());
    if loops && model.integrator == (Integrator::Gyro {}) {
        conserved.push("the circulation of material loops, to rounding".to_owned());
    }
    conserved
}

/// What a run does not conserve, with the reasons, and what was seen to change that was to be kept.
pub(super) fn not_conserved(model: &Model, changed: &[(KeptQuantity, String)]) -> Vec<String> {
    let mut lost = Vec::new();
    if !kept(model).contains(&KeptQuantity::Energy) {
        lost.push(format!("total energy: {}", fate_of_energy(model)));
        let reasons = fate_of_momentum(model);
        if !reasons.is_empty() {
            lost.push(format!("total momentum: {}", reasons.join("; ")));
        }
    }
    lost.extend(changed.iter().map(|(quantity, change)| format!("{}: {change}", quantity.name())));
    lost
}

const INTEGRATED: &str = "only as well as the time step integrates the forces";

fn fate_of_energy(model: &Model) -> String {
    if let Some(water) = model.shallow_water() {
        return match water.bath {
            Some(_) => "exchanged with the bath on the mesh, which also slows a uniform flow down".to_owned(),
            None => INTEGRATED.to_owned(),
        };
    }
    if let Some(cells) = model.voronoi() {
        return fate_of_energy_in_cells(model, cells).to_owned();
    }
    let baths = baths(model);
    let dissipates = |step: &BathStep| step.coupling > 0.0 && step.persistence.abs() < 1.0;
    let thermal = baths.iter().any(|(step, temperature)| dissipates(step) && *temperature > 0.0);
    let athermal = baths.iter().any(|(step, temperature)| dissipates(step) && *temperature == 0.0);
    let lent = baths.iter().any(|(step, _)| step.coupling > 0.0 && step.remembers());
    let mut ways = Vec::new();
    if model.coloured_noise().is_some_and(|noise| noise.strength > 0.0) {
        ways.push("put in by the coloured noise");
    }
    if thermal {
        ways.push("exchanged with the heat bath");
    }
    if athermal {
        ways.push("taken away by friction");
    }
    if ways.is_empty() {
        return if lent {
            format!("lent to the variables of baths that never forget; together with theirs {INTEGRATED}")
        } else {
            INTEGRATED.to_owned()
        };
    }
    ways.join(", ")
}

/// What becomes of the kinetic energy of cells at one temperature, and of their free energy.
fn fate_of_energy_in_cells(model: &Model, cells: &Voronoi) -> &'static str {
    match (cells.viscosity > 0.0, model.temperature > 0.0) {
        (true, true) => "exchanged with the fluid inside the cells, which is at the temperature of the scene",
        (true, false) => "taken away by friction",
        (false, _) if cells.exchanges_mass() => "exchanging mass is no motion in a potential",
        (false, _) => INTEGRATED,
    }
}

/// The steps of all baths of particles, pairs and bonds, with their temperatures.
fn baths(model: &Model) -> Vec<(BathStep, f64)> {
    let mut baths = Vec::new();
    let species = model.species.len();
    if let Some(force) = model.pair_force() {
        let steps = (0..species * species).map(|pair| force.bath_step(pair / species, pair % species, model.time_step));
        baths.extend(steps.map(|step| (step, force.temperature)));
    }
    if let Some(bath) = model.position_bath() {
        baths.extend(bath.steps.iter().map(|step| (*step, bath.temperature)));
    }
    if let Some(bonds) = model.bonds() {
        baths.extend(bonds.kinds.iter().filter_map(|kind| Some((kind.bath?, kind.temperature))));
    }
    baths
}

fn fate_of_momentum(model: &Model) -> Vec<&'static str> {
    if model.shallow_water().is_some() {
        return vec!["the mesh is fixed in space, and a rotation turns it"];
    }
    let mut reasons = Vec::new();
    match model.coloured_noise().map(|noise| noise.process) {
        None => {}
        Some(NoiseProcess::Literal) => reasons.push(
            "the coloured noise pushes every particle by itself, with a mean force that is not zero, so that the centre \
             of mass is driven",
        ),
        Some(_) => reasons
            .push("the coloured noise pushes every particle by itself, so that the velocity of the centre of mass wanders"),
    }
    if model.position_bath().is_some() {
        reasons.push("friction and noise act on every particle by itself");
    }
    if model.tether().is_some() {
        reasons.push("every particle is tied to a point fixed in space");
    }
    if model.has_fixed_particles() {
        reasons.push("fixed particles take up what others give them");
    }
    if model.coloured_noise().is_some() && model.measures_about_centre_of_mass() {
        reasons.push("temperatures are about the velocity of the centre of mass");
    }
    reasons
}

#[cfg(test)]
mod tests {
    #![allow(clippy::expect_used)]
    use super::*;
    use crate::scene;

    fn model(particles: &str, interactions: &str) -> Model {
        let text = format!(
            r#"{{"title": "test", "space": {{"box": [5, 5, 5]}}, "time": {{"step": 0.01, "steps": 1}}, "temperature": 1,
            "particles": [{{"species": "A", "count": 10}} {particles}], "interactions": [{interactions}]}}"#
        );
        Model::new(&scene::parse("test", &text, &[]).expect("a scene"))
    }

    #[test]
    fn voronoi_cells_keep_mass_and_momentum_and_with_their_energies_those_too() {
        let fate = |interaction: &str, temperature: f64| {
            let text = format!(
                r#"{{"title": "test", "space": {{"box": [5, 5]}}, "time": {{"step": 0.01, "steps": 1}},
                "temperature": {temperature}, "particles": [{{"species": "A", "count": 10}}],
                "interactions": [{{"type": "voronoi", {interaction}}}]}}"#
            );
            let model = Model::new(&scene::parse("test", &text, &[]).expect("a scene"));
            (conserved(&model, &[]), not_conserved(&model, &[]))
        };
        let kept = ["mass, to the last bit", "total momentum, to the last bit", "total energy, to the last bit"];
        assert_eq!(fate(r#""energy": {}"#, 1.0), (kept.map(str::to_owned).to_vec(), Vec::new()));
        for (interaction, temperature, energy) in [
            (r#""viscosity": 1"#, 1.0, "exchanged with the fluid"),
            (r#""viscosity": 1"#, 0.0, "taken away by friction"),
            (r#""viscosity": 0"#, 1.0, INTEGRATED),
            (r#""viscosity": 0, "form": "paper""#, 1.0, "exchanging mass"),
        ] {
            let (found, lost) = fate(interaction, temperature);
            assert_eq!(found, kept[..2]);
            assert_eq!(lost.len(), 1);
            assert!(lost[0].starts_with("total energy: ") && lost[0].contains(energy), "{lost:?}");
        }
    }

    #[test]
    fn every_reason_is_told_and_none_that_is_not() {
        let cases = [
            ("", "", INTEGRATED, ""),
            ("", r#"{"type": "dpd", "friction": 1}"#, "exchanged with the heat bath", ""),
            (
                "",
                r#"{"type": "dpd", "friction": 1, "bath": {"type": "white", "temperature": 0}}"#,
                "taken away by friction",
                "",
            ),
            (
                "",
                r#"{"type": "dpd", "bath": {"type": "memory", "rate": 0, "coupling": 2}}"#,
                "lent to the variables of baths",
                "",
            ),
            ("", r#"{"type": "dpd", "friction": 1, "bath": {"type": "memory", "rate": 3}}"#, "exchanged", ""),
            ("", r#"{"type": "langevin", "friction": 1}"#, "exchanged", "friction and noise act on every particle"),
            ("", r#"{"type": "tether", "stiffness": 1}"#, INTEGRATED, "every particle is tied"),
            (r#", {"species": "B", "count": 2, "fixed": true}"#, "", INTEGRATED, "fixed particles take up"),
            (
                "",
                r#"{"type": "coloured-noise", "strength": 1, "time": 0.1}"#,
                "put in by the coloured noise",
                "wanders; temperatures are about the velocity of the centre of mass",
            ),
            (
                "",
                r#"{"type": "dpd", "friction": 1, "bath": {"type": "white", "temperature": 0}},
                {"type": "coloured-noise", "strength": 1, "time": 0.1}, {"type": "tether", "stiffness": 1}"#,
                "put in by the coloured noise, taken away by friction",
                "wanders; every particle is tied to a point fixed in space",
            ),
        ];
        for (particles, interactions, energy, momentum) in cases {
            let model = model(particles, interactions);
            let lost = not_conserved(&model, &[]);
            assert!(lost[0].contains(energy), "{interactions}: {lost:?}");
            match momentum {
                "" => {
                    assert_eq!(lost.len(), 1, "{interactions}: {lost:?}");
                    assert_eq!(conserved(&model, &[]), ["mass", "total momentum, to the last bit"]);
                }
                reason => {
                    assert!(lost[1].starts_with("total momentum: ") && lost[1].contains(reason), "{lost:?}");
                    assert_eq!(conserved(&model, &[]), ["mass"]);
                }
            }
        }
    }
}
