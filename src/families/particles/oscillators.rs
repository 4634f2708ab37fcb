//! What means are in equilibrium, exactly: those of linear systems with a bath on each coordinate, and those of what baths remember.
//!
//! A coordinate q with V = Kq²/2 and mass m, and a bath variable s coupled to it. The continuous motion has ⟨p²⟩ = m
//! kT, ⟨q²⟩ = kT/K and ⟨s²⟩ = kT λ. The schemes of Cotter and Reich, doi:10.1209/epl/i2003-00621-8, with B = λₑ dt²/m
//! and W = K dt²/m have ⟨p²⟩ = m kT, ⟨q²⟩ = (kT/K) (4 - B)/(4 - B - W) and ⟨s²⟩ = kT λₑ (4 - W)/(4 - B - W) at the
//! report, whatever e; ⟨qs⟩ = kT B/(4 - B - W), which the exact motion does not have, and ⟨qp⟩ = ⟨ps⟩ = 0. A split step A(½) B(½) O B(½) A(½) without memory has ⟨p²⟩ = m kT where O ends and ⟨q²⟩ = kT/K
//! where the step does, whatever the friction: both halves together and O leave the law where they meet as it is, of
//! independent p and q with ⟨q²⟩ = (kT/K) 4/(4 - W). Particles of one mass and one bath that springs without a length
//! join are such oscillators, too: their normal modes.

use super::{conservation, normal_modes};
use crate::document::Integrator;
use crate::families::{BathStep, ExactMean, Model, Particles, Species};

/// Means of columns of the table of energies that are known.
pub(super) fn means(model: &Model) -> Vec<ExactMean> {
    means_of_oscillators(model).unwrap_or_else(|| mean_bath_square(model).into_iter().collect())
}

/// Coordinates that move alike: how many, their stiffness, and their species.
#[derive(Debug, Clone, Copy)]
struct Coordinates {
    count: f64,
    stiffness: f64,
    species: usize,
}

/// All columns of a scene in which every coordinate, or every normal mode, is an oscillator with a bath.
fn means_of_oscillators(model: &Model) -> Option<Vec<ExactMean>> {
    let particles = model.particles();
    let bath = particles.position_bath.as_ref()?;
    let is_linear = particles.terms().iter().all(|term| term.is_linear());
    // Friction that sees a predicted velocity leaves another temperature.
    let predicts = matches!(model.particles().integrator, Integrator::GrootWarren { lambda } if lambda != 0.5);
    // A bath that never forgets has no noise either.
    let couples = bath.steps.iter().all(|step| step.coupling > 0.0 && (!bath.memory || step.persistence.abs() < 1.0));
    if !is_linear || predicts || !couples || bath.temperature <= 0.0 || model.mobile_particles() == 0 {
        return None;
    }
    let coordinates = coordinates(model, particles)?;
    let splits = particles.relaxes_particles();
    let (kt, square) = (bath.temperature, model.time_step.powi(2));
    let (mut count, mut curvature, mut gradient) = (0.0, 0.0, [0.0; 2]);
    // Sums over all coordinates, of the motion and of the scheme.
    let (mut potential, mut energy, mut squares, mut product) = ([0.0; 2], [0.0; 2], [0.0; 2], 0.0);
    for group in coordinates {
        let (step, mass) = (&bath.steps[group.species], model.species[group.species].mass);
        let (b, w) = (step.coupling * square / mass, group.stiffness * square / mass);
        let margin = if splits { 4.0 - w } else { 4.0 - b - w };
        let spread = if splits { 1.0 } else { (4.0 - b) / margin };
        if margin <= 0.0 {
            return None;
        }
        count += group.count;
        curvature += group.count * group.stiffness;
        let add = |sum: &mut [f64; 2], continuous: f64, discrete: f64| {
            sum[0] += group.count * continuous;
            sum[1] += group.count * continuous * discrete;
        };
        if group.stiffness > 0.0 {
            add(&mut potential, 0.5 * kt, spread);
            add(&mut gradient, kt * group.stiffness, spread);
        }
        if step.remembers() {
            let discrete = step.coupling / step.continuous_coupling * (4.0 - w) / margin;
            add(&mut energy, 0.5 * kt, discrete);
            add(&mut squares, kt * step.continuous_coupling, discrete);
            product += group.count * kt * b / margin;
        }
    }
    let kinetic = [0.5 * kt * count; 2];
    let sum = |one: [f64; 2], other: [f64; 2]| [one[0] + other[0], one[1] + other[1]];
    let part = |sums: [f64; 2], scale: f64| sums.map(|sum| sum / scale);
    let mut means = vec![
        ("kinetic_energy", kinetic),
        ("potential_energy", potential),
        ("total_energy", sum(kinetic, potential)),
        ("temperature", [kt; 2]),
        ("configurational_temperature", part(gradient, curvature)),
    ];
    if bath.memory {
        means.push(("bath_energy", energy));
        means.push(("extended_energy", sum(sum(kinetic, potential), energy)));
        means.push(("bath_square", part(squares, count)));
    }
    if particles.oscillates_in_memory() {
        means.push(("bath_times_momentum", [0.0; 2]));
        means.push(("bath_times_displacement", [0.0, product / count]));
        means.push(("momentum_times_displacement", [0.0; 2]));
    }
    let means = means.into_iter();
    Some(means.map(|(column, [continuous, found])| ExactMean { column, continuous, discrete: Some(found) }).collect())
}

/// The coordinates of all that moves, alike ones together; none where there is no spring, or where modes are not known.
fn coordinates(model: &Model, particles: &Particles) -> Option<Vec<Coordinates>> {
    let dimension = model.units.dimension as f64;
    let tether = particles.tethers.map_or(0.0, |tethers| tethers.stiffness);
    let mobile = || model.species.iter().enumerate().filter(|(_, species)| !species.fixed && species.count > 0);
    let Some(bonds) = particles.bonds.as_ref() else {
        let alike = |(species, found): (usize, &Species)| Coordinates {
            count: found.count as f64 * dimension,
            stiffness: tether,
            species,
        };
        return (tether > 0.0).then(|| mobile().map(alike).collect());
    };
    let (species, of_all) = mobile().next()?;
    if model.species.iter().any(|other| other.count > 0 && other.name != of_all.name) {
        return None;
    }
    let modes = normal_modes::stiffnesses(bonds, of_all.count)?;
    let mode = |(stiffness, count): (f64, u64)| Coordinates {
        count: count as f64 * dimension,
        stiffness: tether + stiffness,
        species,
    };
    Some(modes.into_iter().map(mode).collect())
}

/// ⟨s²⟩ = kT λ of the continuous motion, whatever the forces: in equilibrium baths are independent of all coordinates.
fn mean_bath_square(model: &Model) -> Option<ExactMean> {
    let mut remembering = conservation::baths(model).into_iter().map(|(step, _)| step).filter(BathStep::remembers);
    let first = remembering.find(|step| step.coupling > 0.0)?;
    let forgets = |step: &BathStep| step.persistence < 1.0;
    let alike = forgets(&first) && remembering.all(|step| step.continuous_coupling == first.continuous_coupling);
    (alike && model.physics().has_thermostat(model)).then_some(ExactMean {
        column: "bath_square",
        continuous: model.temperature * first.continuous_coupling,
        discrete: None,
    })
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use crate::scene;

    fn found(changes: &[&str]) -> Vec<ExactMean> {
        let changes: Vec<String> = changes.iter().map(|change| (*change).to_owned()).collect();
        let model = scene::load("gle-oscillator", &changes).unwrap().model().clone();
        let means = model.physics().exact_means(&model);
        // Only what the table has.
        let columns = model.physics().columns(&model);
        let known = |mean: &ExactMean| columns.iter().any(|column| column.name == mean.column);
        assert!(means.iter().all(known), "{means:?}");
        means
    }

    /// K = λ = α = m = kT = 1 and dt = 1, worked out by hand: a = 1, e = 1/2 and λₑ = 2/3 of the scheme of Cotter and Reich.
    #[test]
    fn one_oscillator_worked_out_by_hand() {
        let means = found(&["time.step=1", "particles.0.count=1", "interactions.1.bath.scheme=cotter-reich"]);
        let of = |column: &str| means.iter().find(|mean| mean.column == column).unwrap();
        let (potential, square) = (of("potential_energy"), of("bath_square"));
        // (4 - 2/3)/(4 - 2/3 - 1) = 10/7, and 2/3 · 3/(7/3) = 6/7.
        assert!((potential.continuous - 1.5).abs() < 1e-12 && (potential.discrete.unwrap() - 15.0 / 7.0).abs() < 1e-12);
        assert!((square.continuous - 1.0).abs() < 1e-12 && (square.discrete.unwrap() - 6.0 / 7.0).abs() < 1e-12);
        assert!((of("bath_energy").discrete.unwrap() - 9.0 / 7.0).abs() < 1e-12);
        assert!((of("extended_energy").discrete.unwrap() - 1.5 - 15.0 / 7.0 - 9.0 / 7.0).abs() < 1e-12);
        assert!((of("configurational_temperature").discrete.unwrap() - 10.0 / 7.0).abs() < 1e-12);
        // (2/3)/(7/3), which the exact motion has not.
        let product = of("bath_times_displacement");
        assert!(product.continuous == 0.0 && (product.discrete.unwrap() - 2.0 / 7.0).abs() < 1e-12);
        for column in ["bath_times_momentum", "momentum_times_displacement"] {
            assert_eq!((of(column).continuous, of(column).discrete.unwrap()), (0.0, 0.0));
        }
        assert_eq!((of("temperature").continuous, of("temperature").discrete.unwrap()), (1.0, 1.0));
    }

    #[test]
    fn schemes_agree_in_the_limit_of_short_steps_and_nothing_is_said_of_other_scenes() {
        let white = r#"interactions.1.bath={"type":"white"}"#;
        for changes in [&["time.step=1e-4"][..], &["time.step=1e-4", white]] {
            for mean in found(changes) {
                let scale = if mean.continuous == 0.0 { 1.0 } else { mean.continuous };
                assert!(((mean.discrete.unwrap() - mean.continuous) / scale).abs() < 1e-3, "{mean:?}");
            }
        }
        assert!(found(&[white]).iter().all(|mean| mean.column != "bath_square"));
        let split = found(&["time.step=1.5", white, r#"integrator={"type":"splitting"}"#]);
        assert_eq!(split.len(), 5);
        for mean in split {
            assert_eq!(mean.discrete, Some(mean.continuous), "a split step errs in none: {mean:?}");
        }
        // Repulsion, no noise, no friction.
        for change in [
            r#"interactions=[{"type":"tether","stiffness":1},{"type":"langevin","friction":1},{"type":"dpd","repulsion":1}]"#,
            "temperature=0",
            "interactions.1.friction=0",
        ] {
            assert_eq!(found(&[change]), [], "{change}");
        }
        let fluid = scene::load("dpd-fluid", &[]).unwrap().model().clone();
        assert_eq!(fluid.physics().exact_means(&fluid), []);
    }

    #[test]
    fn what_baths_remember_is_known_whatever_the_forces() {
        let square = |value| [ExactMean { column: "bath_square", continuous: value, discrete: None }];
        let means = |scene: &str, changes: &[&str]| {
            let changes: Vec<String> = changes.iter().map(|change| (*change).to_owned()).collect();
            let model = scene::load(scene, &changes).unwrap().model().clone();
            model.physics().exact_means(&model)
        };
        assert_eq!(means("edpd-fluid", &["temperature=2"]), square(2.0 * 4.5 * 10.0));
        assert_eq!(means("gle-oscillator", &["interactions.0.stiffness=0"]), square(1.0));
        // At another temperature than the other bath; what never forgets.
        assert_eq!(means("gle-oscillator", &["interactions.0.stiffness=0", "interactions.1.bath.temperature=2"]), []);
        let held = r#"interactions.0={"type":"dpd","repulsion":25,"bath":{"type":"memory","rate":0,"coupling":3}}"#;
        assert_eq!(means("edpd-fluid", &[held]), []);
    }

    /// A pair joined by a spring of stiffness 1 has modes of stiffness 0 and 2.
    #[test]
    fn a_pair_on_a_spring_is_two_oscillators() {
        let bond = r#"interactions.0={"type":"bonds","potential":{"type":"harmonic","stiffness":1},"pairs":[[0,1]]}"#;
        let pair = found(&["particles.0.count=2", bond, "time.step=0.5"]);
        let tether = ["particles.0.count=1", "interactions.0.stiffness=2", "time.step=0.5"];
        let of = |means: &[ExactMean], column: &str| *means.iter().find(|mean| mean.column == column).unwrap();
        let tied = found(&tether);
        for column in ["potential_energy", "configurational_temperature"] {
            let [one, other] = [of(&pair, column), of(&tied, column)];
            assert!((one.discrete.unwrap() - other.discrete.unwrap()).abs() < 1e-12, "{column}");
        }
        // The other mode is free: B/4 alone stands in the way of ⟨s²⟩ = kT λₑ.
        let free = |means: &[ExactMean]| of(means, "bath_energy").discrete.unwrap();
        let step = model_step();
        let b = step.coupling * 0.25;
        let alone = 1.5 * step.coupling / step.continuous_coupling * 4.0 / (4.0 - b);
        assert!((free(&pair) - free(&tied) - alone).abs() < 1e-12);
    }

    fn model_step() -> BathStep {
        BathStep::with_memory(scene::BathScheme::Exponential, 1.0, 1.0, 0.5)
    }
}
