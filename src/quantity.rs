//! The quantities of the table of energies, each with all that is said of it wherever it is shown.

/// A quantity of the table of energies.
///
/// ```
/// use mesoscope::quantity::{Quantity, Unit};
///
/// let pressure = Quantity::of_column("pressure_conservative").expect("a column of the table");
/// assert_eq!((pressure.symbol, pressure.unit), ("p_C", Unit::Pressure));
/// // A vector has a column for each axis, and walls have columns for each side.
/// assert_eq!(Quantity::of_column("momentum_x"), Quantity::of_column("momentum_z"));
/// assert_eq!(Quantity::of_column("wall_y_upper_momentum_x").map(|found| found.name), Some("wall_momentum"));
/// assert_eq!(Quantity::of_column("colour"), None);
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Quantity {
    /// The name of its column; that of a vector, without the axis.
    pub name: &'static str,
    /// Its symbol in formulas.
    pub symbol: &'static str,
    /// Its unit.
    pub unit: Unit,
    /// Its definition.
    pub meaning: &'static str,
    /// Its look in the panel of its unit in the chart of energies, if it is there.
    pub look: Option<Look>,
    /// True if studies report and assess it by default.
    pub is_usual: bool,
    /// True if it fluctuates about a constant in equilibrium; false if it is conserved, wanders or counts.
    pub settles: bool,
}

/// The look of a quantity among others of its unit.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Look {
    /// Its name in the legend.
    pub legend: &'static str,
    /// The number of its ink: quantities of motion have the first, those of the configuration the second, in every panel.
    pub ink: usize,
}

/// The unit of a quantity.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Unit {
    /// Units of energy, of a temperature kT.
    Temperature,
    /// Units of energy.
    Energy,
    /// Units of energy over those of volume, which is an area in two dimensions.
    Pressure,
    /// Units of a pressure times those of length.
    Tension,
    /// Units of a pressure times those of time.
    Viscosity,
    /// One over the unit of volume.
    Density,
    /// Another unit, in words.
    Other(&'static str),
}

impl Unit {
    /// The unit in words; that of a pressure depends on the dimension of the box, where that is known.
    ///
    /// ```
    /// use mesoscope::quantity::Unit;
    /// assert_eq!(Unit::Pressure.in_words(Some(2)), "energy units/length unit²");
    /// assert_eq!(Unit::Pressure.in_words(None), "energy units/volume");
    /// ```
    #[must_use]
    pub const fn in_words(self, dimension: Option<usize>) -> &'static str {
        match (self, dimension) {
            (Self::Temperature | Self::Energy, _) | (Self::Tension, Some(1)) => "energy units",
            (Self::Pressure, None) => "energy units/volume",
            (Self::Pressure, Some(1)) | (Self::Tension, Some(2)) => "energy units/length unit",
            (Self::Pressure, Some(2)) | (Self::Tension, Some(_)) => "energy units/length unit²",
            (Self::Pressure, Some(_)) => "energy units/length unit³",
            (Self::Tension, None) => "energy units/volume × length units",
            (Self::Viscosity, None) => "energy units/volume × time units",
            (Self::Viscosity, Some(1)) => "mass units × length units/time unit",
            (Self::Viscosity, Some(2)) => "mass units/time unit",
            (Self::Viscosity, Some(_)) => "mass units/(length unit × time unit)",
            (Self::Density, None) => "1/volume",
            (Self::Density, Some(1)) => "1/length unit",
            (Self::Density, Some(2)) => "1/length unit²",
            (Self::Density, Some(_)) => "1/length unit³",
            (Self::Other(words), _) => words,
        }
    }
}

use Unit::{Energy, Other, Pressure, Temperature};

const MOMENTUM: Unit = Other("mass units × length units/time unit");
pub(crate) const VELOCITY: Unit = Other("length units/time unit");
pub(crate) const NUMBER: Unit = Other("number");
pub(crate) const TIME: Unit = Other("time units");
pub(crate) const RATE: Unit = Other("1/time unit");
const WORK: Unit = Other("energy units");
const BATH: Unit = Other("square of its unit");
const FORCE_MOMENTUM: Unit = Other("force units × momentum units");
const ACTION: Unit = Other("momentum units × length units");

/// All quantities, those most asked for first.
pub(crate) const QUANTITIES: [Quantity; 31] = [
    settling("temperature", "kT", Temperature, "⟨mv²⟩ of a degree of freedom").looks("kinetic", 0).assessed(),
    settling("internal_temperature", "kT_i", Temperature, "mean temperature inside cells")
        .looks("internal", 5)
        .assessed(),
    settling("configurational_temperature", "kT_C", Temperature, "|∇U|²/∇²U").looks("configurational", 1).assessed(),
    settling("pressure", "p", Pressure, "by kinetic energy and all virials; of cells, by their gas")
        .looks("total", 2)
        .assessed(),
    settling("kinetic_energy", "K", Energy, "kinetic energy of all particles").looks("kinetic", 0),
    settling("potential_energy", "U", Energy, "potential energy; free energy of cells")
        .looks("potential", 1)
        .assessed(),
    settling("electrostatic_energy", "U_q", Energy, "the part of the potential energy that charges have together")
        .assessed(),
    settling("pressure_conservative", "p_C", Pressure, "without friction and noise").looks("conservative part", 1),
    quantity("internal_energy", "E_i", Energy, "internal energy of all cells").looks("internal", 5),
    quantity("total_energy", "E", Energy, "K + U; of cells with an energy of their own, K + E_i").looks("total", 2),
    quantity("bath_energy", "E_b", Energy, "energy of the variables of baths with memory").looks("bath", 3),
    quantity("extended_energy", "E + E_b", Energy, "total energy and that of baths").looks("total with bath", 4),
    settling("bath_square", "⟨h²⟩", BATH, "mean square of the variables h of baths"),
    settling("bath_times_momentum", "⟨hp⟩", FORCE_MOMENTUM, "mean over all coordinates of oscillators in baths"),
    settling("bath_times_displacement", "⟨hx⟩", WORK, "mean over all coordinates of oscillators in baths"),
    settling("momentum_times_displacement", "⟨px⟩", ACTION, "mean over all coordinates of oscillators in baths"),
    quantity("step", "n", NUMBER, "steps since the start of the run"),
    quantity("time", "t", TIME, "time since the start of the run"),
    quantity("momentum", "P", MOMENTUM, "total momentum"),
    quantity("center_of_mass_velocity", "V", VELOCITY, "velocity of the centre of mass"),
    quantity("body_force_momentum", "P_f", MOMENTUM, "impulse of body forces since the start"),
    quantity("body_force_work", "W_f", WORK, "work of body forces since the start"),
    quantity("wall_momentum", "P_w", MOMENTUM, "momentum that a wall has absorbed since the start"),
    quantity("wall_work", "W_w", WORK, "work that moving walls have done on particles since the start"),
    quantity("shear_momentum", "P_s", MOMENTUM, "momentum that sheared boundaries have taken from what crossed them"),
    quantity("mass", "M", Other("mass units"), "mass of all cells"),
    quantity("volume_error", "ΔV/V", Other("part of the volume"), "volume of all cells over that of the box, less 1"),
    quantity("mean_neighbours", "z", NUMBER, "mean number of neighbours of a cell, 6 in every tessellation"),
    quantity("limited_exchanges", "n_l", NUMBER, "exchanges between cells that a limit has cut since the start"),
    quantity("solver_iterations", "n_s", NUMBER, "iterations in which the friction of cells was solved for"),
    quantity("solver_residual", "r", Other("part of the right side"), "residual of the friction of cells"),
];

/// A quantity that no chart of energies shows.
pub(crate) const fn quantity(name: &'static str, symbol: &'static str, unit: Unit, meaning: &'static str) -> Quantity {
    Quantity { name, symbol, unit, meaning, look: None, is_usual: false, settles: false }
}

const fn settling(name: &'static str, symbol: &'static str, unit: Unit, meaning: &'static str) -> Quantity {
    Quantity { settles: true, ..quantity(name, symbol, unit, meaning) }
}

impl Quantity {
    const fn looks(self, legend: &'static str, ink: usize) -> Self {
        Self { look: Some(Look { legend, ink }), ..self }
    }

    const fn assessed(self) -> Self {
        Self { is_usual: true, ..self }
    }

    /// Its name with symbol and unit, for an axis or a bar of colours.
    pub(crate) fn label(&self, dimension: usize) -> String {
        let mut letters = self.meaning.chars();
        let first = letters.next().map(|letter| letter.to_uppercase().to_string()).unwrap_or_default();
        format!("{first}{} {} ({})", letters.as_str(), self.symbol, self.unit.in_words(Some(dimension)))
    }

    /// The quantity of a column, if it is one of the table of energies.
    #[must_use]
    pub fn of_column(column: &str) -> Option<&'static Self> {
        let of_vector = column.rsplit_once('_').filter(|(_, axis)| ["x", "y", "z"].contains(axis));
        let name = of_vector.map_or(column, |(name, _)| name);
        let of_wall = name.starts_with("wall_") && name.ends_with("_momentum");
        QUANTITIES.iter().find(|known| known.name == if of_wall { "wall_momentum" } else { name })
    }

    /// The quantities that a chart shows in the panel of a unit, in their order, with their look.
    pub(crate) fn shown_in(unit: Unit) -> impl DoubleEndedIterator<Item = (&'static Self, Look)> {
        QUANTITIES.iter().filter(move |quantity| quantity.unit == unit).filter_map(|shown| Some((shown, shown.look?)))
    }

    /// The names of the columns that a chart shows in the panel of a unit, in their order.
    #[must_use]
    pub fn columns_shown_in(unit: Unit) -> impl DoubleEndedIterator<Item = &'static str> {
        Self::shown_in(unit).map(|(shown, _)| shown.name)
    }

    /// The quantities that say most of matter in equilibrium: means with a look of their own, no parts of others.
    pub fn usual() -> impl Iterator<Item = &'static Self> {
        QUANTITIES.iter().filter(|quantity| quantity.is_usual)
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    use crate::scene;

    #[test]
    fn every_column_has_its_quantity() {
        let scenes = scene::builtin().iter().map(|known| scene::load(known.name, &[]));
        let mut met = std::collections::BTreeSet::from(["step"]);
        for scene in scenes {
            let scene = scene.unwrap();
            for column in scene.model().physics().columns(scene.model()) {
                let quantity = Quantity::of_column(column.name).map(|quantity| quantity.name);
                assert!(quantity.is_some(), "{}", column.name);
                met.extend(quantity);
            }
        }
        let unmet: Vec<&str> =
            QUANTITIES.map(|quantity| quantity.name).into_iter().filter(|name| !met.contains(name)).collect();
        assert!(unmet.is_empty(), "no scene has {unmet:?}");
    }

    #[test]
    fn quantities_of_a_panel_are_told_apart() {
        for (place, one) in QUANTITIES.iter().enumerate() {
            for other in QUANTITIES[..place].iter().filter(|other| other.unit == one.unit) {
                let (Some(look), Some(known)) = (one.look, other.look) else { continue };
                assert!(look.legend != known.legend && look.ink != known.ink, "{} and {}", one.name, other.name);
            }
        }
    }
}
