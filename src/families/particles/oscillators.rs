//! Independent oscillators with a bath on each coordinate: what their means are in equilibrium, exactly.
//!
//! A coordinate q with V = Kq²/2 and mass m, and a bath variable s coupled to it. The continuous motion has ⟨p²⟩ = m kT, ⟨q²⟩ = kT/K and
//! ⟨s²⟩ = kT λ. The schemes of Cotter and Reich, doi:10.1209/epl/i2003-00621-8, with B = λₑ dt²/m and W = K dt²/m have
//! ⟨p²⟩ = m kT, ⟨q²⟩ = (kT/K) (4 - B)/(4 - B - W) and ⟨s²⟩ = kT λₑ (4 - W)/(4 - B - W) at the report, whatever e.

use crate::families::{ExactMean, Model};

/// Means of the columns of the table of energies; none of other scenes than these.
pub(super) fn means(model: &Model) -> Vec<ExactMean> {
    let (Some(stiffness), Some(bath)) = (model.particles().tether, model.particles().position_bath.as_ref()) else {
        return Vec::new();
    };
    let is_alone = model.particles().pair_force.is_none()
        && model.particles().bonds.is_none()
        && model.particles().angles.is_none()
        && model.particles().coloured_noise.is_none();
    let couples = bath.steps.iter().all(|step| step.coupling > 0.0);
    if !is_alone || !couples || stiffness <= 0.0 || bath.temperature <= 0.0 || model.mobile_particles() == 0 {
        return Vec::new();
    }
    let (kt, dimension, square) = (bath.temperature, model.units.dimension as f64, model.time_step.powi(2));
    // Of all coordinates: their number, and sums over them of what a coordinate has of each.
    let mut count = 0.0;
    let (mut potential, mut energy, mut squares) = ([0.0; 2], [0.0; 2], [0.0; 2]);
    for (species, step) in model.species.iter().zip(&bath.steps).filter(|(species, _)| !species.fixed) {
        let coordinates = species.count as f64 * dimension;
        let (b, w) = (step.coupling * square / species.mass, stiffness * square / species.mass);
        let margin = 4.0 - b - w;
        if margin <= 0.0 && coordinates > 0.0 {
            return Vec::new();
        }
        count += coordinates;
        let add = |sum: &mut [f64; 2], continuous: f64, discrete: f64| {
            sum[0] += coordinates * continuous;
            sum[1] += coordinates * continuous * discrete;
        };
        add(&mut potential, 0.5 * kt, (4.0 - b) / margin);
        if step.remembers() {
            let discrete = step.coupling / step.continuous_coupling * (4.0 - w) / margin;
            add(&mut energy, 0.5 * kt, discrete);
            add(&mut squares, kt * step.continuous_coupling, discrete);
        }
    }
    let kinetic = [0.5 * kt * count; 2];
    let sum = |terms: &[[f64; 2]]| [0, 1].map(|kind| terms.iter().map(|term| term[kind]).sum::<f64>());
    let part = |sums: [f64; 2], scale: f64| sums.map(|sum| sum / scale);
    let mut means = vec![
        ("kinetic_energy", kinetic),
        ("potential_energy", potential),
        ("total_energy", sum(&[kinetic, potential])),
        ("temperature", [kt; 2]),
        ("configurational_temperature", part(potential, 0.5 * count)),
    ];
    if bath.memory {
        means.push(("bath_energy", energy));
        means.push(("extended_energy", sum(&[kinetic, potential, energy])));
        means.push(("bath_square", part(squares, count)));
    }
    let means = means.into_iter();
    means.map(|(column, [continuous, discrete])| ExactMean { column, continuous, discrete }).collect()
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use crate::scene;

    fn found(changes: &[&str]) -> Vec<ExactMean> {
        let changes: Vec<String> = changes.iter().map(|change| (*change).to_owned()).collect();
        let model = Model::new(&scene::load("gle-oscillator", &changes).unwrap());
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
        assert!((potential.continuous - 1.5).abs() < 1e-12 && (potential.discrete - 15.0 / 7.0).abs() < 1e-12);
        assert!((square.continuous - 1.0).abs() < 1e-12 && (square.discrete - 6.0 / 7.0).abs() < 1e-12);
        assert!((of("bath_energy").discrete - 9.0 / 7.0).abs() < 1e-12);
        assert!((of("extended_energy").discrete - 1.5 - 15.0 / 7.0 - 9.0 / 7.0).abs() < 1e-12);
        assert!((of("configurational_temperature").discrete - 10.0 / 7.0).abs() < 1e-12);
        assert_eq!((of("temperature").continuous, of("temperature").discrete), (1.0, 1.0));
    }

    #[test]
    fn schemes_agree_in_the_limit_of_short_steps_and_nothing_is_said_of_other_scenes() {
        let white = r#"interactions.1.bath={"type":"white"}"#;
        for changes in [&["time.step=1e-4"][..], &["time.step=1e-4", white]] {
            for mean in found(changes) {
                assert!((mean.discrete / mean.continuous - 1.0).abs() < 1e-3, "{mean:?}");
            }
        }
        assert!(found(&[white]).iter().all(|mean| mean.column != "bath_square"));
        // A tied pair, no noise, no friction, no spring.
        for change in [
            r#"interactions=[{"type":"tether","stiffness":1},{"type":"langevin","friction":1},{"type":"dpd","repulsion":1}]"#,
            "temperature=0",
            "interactions.1.friction=0",
            "interactions.0.stiffness=0",
        ] {
            assert_eq!(found(&[change]), [], "{change}");
        }
        let fluid = Model::new(&scene::load("dpd-fluid", &[]).unwrap());
        assert_eq!(fluid.physics().exact_means(&fluid), []);
    }
}
