//! Charges and their mesh, in words for `check`.

use super::{Electrostatics, direct, expected_error};
use crate::families::Model;
use crate::numbers::{grouped, three_digits};
use std::f64::consts::PI;

/// The Bjerrum length, the length of Debye, and the mesh with its error, in words for `check`.
pub(crate) fn description(electrostatics: &Electrostatics, model: &Model) -> Vec<(&'static str, String)> {
    let lengths = model.units.lengths;
    let volume = lengths.iter().product::<f64>();
    let error = expected_error(electrostatics, lengths, electrostatics.squares());
    let [x, y, z] = electrostatics.mesh;
    let spacings = [0, 1, 2].map(|axis| three_digits(lengths[axis] / f64::from(electrostatics.mesh[axis])));
    let screening = electrostatics.screening(model.temperature, volume);
    let charges = format!(
        "{} particles with a charge, Γ {}, Debye length {}, κσ {}",
        grouped(electrostatics.charged.count()),
        three_digits(4.0 * PI * electrostatics.strength / model.temperature),
        three_digits(1.0 / screening),
        three_digits(screening * electrostatics.cloud.width())
    );
    let of_force = format!(
        "expected rms error of a force on a unit charge {}, for charges at random places",
        three_digits(error.absolute)
    );
    if let Some(largest) = electrostatics.largest_wave {
        let count = direct::waves(largest, lengths).len() as u64;
        let waves =
            format!("{} up to a wave number of {}, each by itself; {of_force}", grouped(count), three_digits(largest));
        return vec![("charges", charges), ("charge waves", waves)];
    }
    let mesh = format!(
        "{x} × {y} × {z} nodes {} apart, splines of {} points; {of_force}",
        spacings.join(", "),
        electrostatics.order
    );
    vec![("charges", charges), ("charge mesh", mesh)]
}
