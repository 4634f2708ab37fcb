//! The quantities in tables and results of analyses, with units and definitions.

use crate::quantity::{
    NUMBER, Quantity, RATE, TIME, Unit,
    Unit::{Density, Energy, Other, Pressure, Temperature, Tension, Viscosity},
    VELOCITY, quantity,
};
use crate::scene::{AnalysisId, CorrelatedQuantity, CountedQuantity};
use serde_json::{Map, Value, json};

const LENGTH: Unit = Other("length units");
const AREA: Unit = Other("length units²");
const WAVE_NUMBER: Unit = Other("1/length unit");
const VELOCITY_SQUARED: Unit = Other("length units²/time unit²");
const DIFFUSIVITY: Unit = Other("length units²/time unit");
const VELOCITIES: [Unit; 3] = [VELOCITY, VELOCITY_SQUARED, Other("length units⁴/time unit⁴")];
const ACCELERATIONS: [Unit; 3] =
    [Other("length units/time unit²"), Other("length units²/time unit⁴"), Other("length units⁴/time unit⁸")];
const SQUARED_RATE: Unit = Other("1/time unit²");
const INVERSE: Unit = Other("1 over the unit of the quantity");

const LAG: Quantity = quantity("time", "t", TIME, "lag");
const SINCE_START: Quantity = quantity("time", "t", TIME, "time since the start of the run");

/// The quantities of an analysis. One without a name is every column that no other names.
pub(super) fn of(id: AnalysisId) -> &'static [Quantity] {
    match id {
        AnalysisId::RadialDistribution => RADIAL_DISTRIBUTION,
        AnalysisId::StructureFactor => STRUCTURE_FACTOR,
        AnalysisId::Diffusion => DIFFUSION,
        AnalysisId::ChainSizes => CHAIN_SIZES,
        AnalysisId::Clusters => CLUSTERS,
        AnalysisId::Viscosity => VISCOSITY,
        AnalysisId::Autocorrelation(quantity) => match quantity {
            CorrelatedQuantity::Velocity => const { &autocorrelations(VELOCITY_SQUARED) },
            CorrelatedQuantity::Force => const { &autocorrelations(Other("energy units²/length unit²")) },
        },
        AnalysisId::Histogram(quantity) => match quantity {
            CountedQuantity::Velocity => const { &histogram("velocity", "v", VELOCITIES) },
            CountedQuantity::Speed => const { &histogram("speed", "|v|", VELOCITIES) },
            CountedQuantity::Acceleration => const { &histogram("acceleration", "a", ACCELERATIONS) },
        },
        AnalysisId::Circulation => CIRCULATION,
        AnalysisId::Chain => CHAIN,
        AnalysisId::Neighbours => NEIGHBOURS,
        AnalysisId::ShearWave => SHEAR_WAVE,
        AnalysisId::Spectra => SPECTRA,
        AnalysisId::Profiles => PROFILES,
        AnalysisId::Stress => STRESS,
    }
}

const RADIAL_DISTRIBUTION: &[Quantity] = &[
    quantity("distance", "r", LENGTH, "middle of the bin"),
    quantity("radial_distribution", "g", NUMBER, "pairs over those of particles that are spread evenly"),
    quantity("pairs", "N", NUMBER, "pairs counted in all samples"),
    quantity("peak_distance", "r_p", LENGTH, "distance of the maximum"),
    quantity("peak_height", "g(r_p)", NUMBER, "height of the maximum"),
];

const STRUCTURE_FACTOR: &[Quantity] = &[
    quantity("wave_number", "q", WAVE_NUMBER, "mean magnitude of the wave vectors of the bin"),
    quantity(
        "structure_factor",
        "S",
        NUMBER,
        "⟨ρ_a ρ_b*⟩/√(N_a N_b), 1 for pairs of an ideal gas within a species and 0 between two",
    ),
    quantity(
        "charge_structure_factor",
        "S_ZZ",
        NUMBER,
        "⟨ρ_Z ρ_Z*⟩/Σq², ρ_Z(q) = Σ q e^(-iq·r) of the charges, 1 for charges at random places",
    ),
    quantity("vectors", "n", NUMBER, "wave vectors of the bin, of every two that point against each other one"),
    quantity("peak_wave_number", "q_p", WAVE_NUMBER, "wave number of the maximum"),
    quantity("peak_height", "S(q_p)", NUMBER, "height of the maximum"),
];

const DIFFUSION: &[Quantity] = &[
    LAG,
    quantity("mean_squared_displacement", "⟨Δr²⟩", AREA, "mean over particles and windows"),
    quantity("velocity_autocorrelation", "⟨v(0)·v(t)⟩", VELOCITY_SQUARED, "mean over particles and windows"),
    quantity("diffusion_einstein", "D", DIFFUSIVITY, "slope of the mean squared displacement over twice the dimension"),
    quantity("diffusion_green_kubo", "D", DIFFUSIVITY, "integral of the velocity autocorrelation over the dimension"),
];

const CHAIN_SIZES: &[Quantity] = &[
    SINCE_START,
    quantity("end_to_end_squared", "⟨R²⟩", AREA, "mean over chains of the squared distance of the ends"),
    quantity("radius_of_gyration_squared", "⟨R_g²⟩", AREA, "mean over chains, beads counting alike"),
];

const CLUSTERS: &[Quantity] = &[
    SINCE_START,
    quantity(
        "clusters",
        "n_c",
        NUMBER,
        "clusters of at least the least size; in the table of sizes, of this size on average",
    ),
    quantity("mean_size", "⟨s⟩", NUMBER, "mean number of particles of a cluster"),
    quantity("weighted_size", "⟨s²⟩/⟨s⟩", NUMBER, "mean over their particles of the size of the cluster"),
    quantity("largest_size", "s_m", NUMBER, "particles of the largest cluster"),
    quantity("size", "s", NUMBER, "particles of a cluster"),
    quantity("part", "sn_c/N", NUMBER, "part of the particles that are in clusters of this size"),
];

const VISCOSITY: &[Quantity] = &[
    quantity("wave_number", "k", WAVE_NUMBER, "magnitude of the wave vector"),
    LAG,
    quantity("autocorrelation", "C", NUMBER, "of the transverse momentum waves, 1 at the start"),
    quantity("fit", "C", NUMBER, "exponential decay, fitted"),
    quantity("shear_viscosity", "η", Viscosity, "mean over the wave numbers, weighted by modes and k²"),
    quantity("viscosity", "η", Viscosity, "of the waves of one length"),
    quantity("kinematic_viscosity", "ν", DIFFUSIVITY, "shear viscosity over the density"),
];

const CIRCULATION: &[Quantity] = &[
    SINCE_START,
    quantity("initial", "Γ_0", DIFFUSIVITY, "circulation of the loop at first"),
    quantity(
        "largest_change",
        "max |Γ − Γ_0|",
        DIFFUSIVITY,
        "as long as the points of the loop are closer together than nodes",
    ),
    quantity("largest_relative_change", "max |Γ − Γ_0|/|Γ_0|", NUMBER, "the largest change over the first value"),
    quantity("resolved_until", "t", TIME, "time up to which the points of the loop are closer together than nodes"),
    quantity("", "Γ", DIFFUSIVITY, "circulation of the absolute velocity along the loop of this name"),
];

const CHAIN: &[Quantity] = &[
    quantity("tau", "τ", NUMBER, "time in units of n/ω_0, that of a cluster of n beads"),
    quantity("time", "t", TIME, "time; of the memory, in units of 1/ω_0"),
    quantity("cluster", "j", NUMBER, "number of the cluster"),
    quantity("micro", "u", NUMBER, "displacement of clusters of beads, over the height of the pulse"),
    quantity("dpd", "u", NUMBER, "displacement in the chain with friction and noise, over the height of the pulse"),
    quantity("frictionless", "u", NUMBER, "displacement in the chain without friction, over the height of the pulse"),
    quantity("limit", "C", NUMBER, "limit of large clusters, max(0, 1 − τ)"),
    quantity("correlation", "C", NUMBER, "momentum autocorrelation over nmkT"),
    quantity("momentum_variance", "⟨P²⟩", NUMBER, "over nmkT"),
    quantity("momentum_variance_over_nmkT", "⟨P²⟩", NUMBER, "over nmkT"),
    quantity("separation_variance", "⟨Δ²⟩", NUMBER, "of neighbouring clusters, over nkT/κ"),
    quantity("separation_variance_times_stiffness_over_nkT", "⟨Δ²⟩", NUMBER, "of neighbouring clusters, over nkT/κ"),
    quantity("peak", "u_m", NUMBER, "height of the pulse, over that at the start"),
    quantity("pulse_peak", "u_m", NUMBER, "height of the pulse at the end, over that at the start"),
    quantity("variance", "σ²", Other("square of a distance of clusters"), "width of the pulse"),
    quantity("pulse_variance", "σ²", Other("square of a distance of clusters"), "width of the pulse at the end"),
    quantity("energy", "E", NUMBER, "energy of the resolved motion, over that at the start"),
    quantity("pulse_energy", "E", NUMBER, "energy of the resolved motion at the end, over that at the start"),
    quantity("running_friction", "γ", NUMBER, "integral of the memory of a cluster of so many beads up to the time"),
    quantity("plateau", "γ", NUMBER, "line through the plateau of the integral"),
    quantity("plateau_friction_by_cluster_size", "γ", NUMBER, "friction at the plateau"),
    quantity("reduced_time", "τ", NUMBER, "time at the end in units of n/ω_0"),
    quantity("reduced_friction", "γ*", NUMBER, "friction of the chain with friction and noise"),
];

const NEIGHBOURS: &[Quantity] = &[
    quantity("neighbours", "z", NUMBER, "number of neighbours of a cell"),
    quantity("fraction", "f", NUMBER, "part of the cells that have this number"),
    quantity("random_points", "f", NUMBER, "that part of the cells of points at random"),
    quantity("mean", "⟨z⟩", NUMBER, "mean number of neighbours"),
    quantity("variance", "⟨z²⟩ − ⟨z⟩²", NUMBER, "variance of the number of neighbours"),
];

const SHEAR_WAVE: &[Quantity] = &[
    SINCE_START,
    quantity("amplitude", "A", VELOCITY, "velocity along x, projected on the wave that it started with"),
    quantity("fit", "A", VELOCITY, "exponential decay, fitted"),
    quantity("wave_number", "k", WAVE_NUMBER, "magnitude of the wave vector"),
    quantity("initial_amplitude", "A_0", VELOCITY, "amplitude of the first sample"),
    quantity("decay_rate", "νk²", RATE, "rate of the exponential decay"),
    quantity("kinematic_viscosity", "ν", DIFFUSIVITY, "decay rate over k²"),
    quantity("shear_viscosity", "η", Viscosity, "kinematic viscosity times the density"),
    quantity("", "η", Viscosity, "known beforehand, for comparison"),
];

const SPECTRA: &[Quantity] = &[
    quantity("wave_number", "k", WAVE_NUMBER, "wave number in the middle of the shell"),
    quantity("modes", "n", NUMBER, "Fourier modes in the shell"),
    quantity("kinetic_energy", "K", Energy, "½ Σ h̃(u² + v²) over nodes, of the modes of the shell"),
    quantity("potential_energy", "U", Energy, "½ c₀² Σ (h̃ − 1)(h − 1), of the modes of the shell"),
    quantity("potential_enstrophy", "Z", SQUARED_RATE, "½ Σ (ζ + f₀)²/h, of the modes of the shell"),
    quantity("enstrophy", "Z_ζ", SQUARED_RATE, "½ Σ ζ², of the modes of the shell"),
];

const PROFILES: &[Quantity] = &[
    quantity("position", "x", LENGTH, "middle of the bin along the axis"),
    quantity("number_density", "n", Density, "particles over volume"),
    quantity("charge_density", "ρ_Z", Density, "elementary charges over volume"),
    quantity(
        "electrostatic_potential",
        "φ",
        Energy,
        "energy of a point charge of one elementary charge in the mean field of the clouds, 0 on average",
    ),
    quantity("velocity", "u", VELOCITY, "momentum over mass"),
    quantity("temperature", "kT", Temperature, "of the motion relative to the centre of mass of the bin"),
    quantity("pressure", "P", Pressure, "pressure tensor relative to the mean velocity of the bin"),
];

const STRESS: &[Quantity] = &[
    LAG_OR_TIME,
    quantity("pressure", "P", Pressure, "pressure tensor, the sum of its three parts"),
    quantity("kinetic", "P_K", Pressure, "momentum that particles carry"),
    quantity("conservative", "P_C", Pressure, "virials of pairs, bonds and angles"),
    quantity("frictional", "P_D", Pressure, "virials of friction, noise and baths"),
    quantity("surface_tension", "γ", Tension, "of the interfaces across the normal"),
    quantity("surface_tension_conservative", "γ_C", Tension, "of the conservative part of the tensor"),
    quantity("viscosity_in_shear", "η", Viscosity, "shear stress over the shear rate"),
    quantity(
        "autocorrelation",
        "V⟨σσ⟩/kT",
        Other("that of a viscosity over time units"),
        "of the shear stress, times V/kT",
    ),
    quantity("viscosity", "η", Viscosity, "sum of the autocorrelation up to the lag"),
    quantity("shear_viscosity", "η", Viscosity, "sum of the autocorrelation up to the longest lag"),
];

const LAG_OR_TIME: Quantity = quantity("time", "t", TIME, "time since the start of the run; of the correlation, lag");

const fn autocorrelations(square: Unit) -> [Quantity; 10] {
    [
        LAG,
        quantity("autocorrelation", "C", NUMBER, "mean over particles and windows, over that at lag 0"),
        quantity("covariance", "⟨A(0)·A(t)⟩", square, "mean over particles and windows"),
        quantity("fit", "C", NUMBER, "the curve that was fitted"),
        quantity("mean_square", "⟨A²⟩", square, "mean over particles at the start of windows"),
        quantity("a", "a", Other("number; of a damped oscillation, 1/time unit"), "parameter of the curve"),
        quantity("b", "b", RATE, "parameter of the curve"),
        quantity("c", "c", NUMBER, "parameter of the curve"),
        quantity("frequency_squared", "Ω²", Other("1/time unit²"), "parameter of the curve"),
        quantity("deviation", "ΔC", NUMBER, "root of the mean squared deviation of the curve"),
    ]
}

const fn histogram(name: &'static str, symbol: &'static str, [unit, square, fourth]: [Unit; 3]) -> [Quantity; 10] {
    [
        quantity(name, symbol, unit, "middle of the bin"),
        quantity("density", "P", INVERSE, "probability density of the bin"),
        quantity("count", "N", NUMBER, "values in the bin"),
        quantity("gaussian", "P", INVERSE, "Gaussian with mean and standard deviation of the values"),
        quantity("maxwell", "P", INVERSE, "Maxwell's density with the mean square of the values"),
        quantity("mean", "⟨x⟩", unit, "mean of the values"),
        quantity("standard_deviation", "s", unit, "standard deviation of the values"),
        quantity("kurtosis", "⟨x⁴⟩/⟨x²⟩²", NUMBER, "3 for a Gaussian about zero"),
        quantity("mean_square", "⟨x²⟩", square, "mean square of the magnitude of the vector"),
        quantity("variance_of_square", "⟨x⁴⟩ − ⟨x²⟩²", fourth, "variance of the square of the magnitude"),
    ]
}

/// Numbers of results that are no quantities: counts, and what was asked for.
const COUNTS: [&str; 10] =
    ["range", "samples", "windows", "values", "below", "above", "modes", "chains", "beads", "bins"];

/// The quantity of a column or of a number in a result. A name may begin with a word (`micro_peak`), and end with an axis, a component, the
/// numbers of species or sizes, and `error`.
pub(super) fn named(id: AnalysisId, name: &str) -> Option<&'static Quantity> {
    let known = of(id);
    let mut rest = name;
    loop {
        if let Some(found) = known.iter().find(|known| !known.name.is_empty() && known.name == rest) {
            return Some(found);
        }
        match rest.rsplit_once('_') {
            Some((before, last)) if is_part(last) => rest = before,
            _ => break,
        }
    }
    let ends = |known: &&Quantity| rest.strip_suffix(known.name).is_some_and(|before| before.ends_with('_'));
    known
        .iter()
        .filter(|known| !known.name.is_empty())
        .find(ends)
        .or_else(|| known.iter().find(|known| known.name.is_empty()))
}

fn is_part(word: &str) -> bool {
    word == "error"
        || numbers_in(word).is_some()
        || (word.len() <= 2 && word.chars().all(|letter| "xyz".contains(letter)))
}

fn numbers_in(word: &str) -> Option<usize> {
    word.parse().ok()
}

/// The numbers at the end of the name of a column: of species, in their order.
pub(super) fn numbers_of(column: &str) -> Vec<usize> {
    let mut numbers: Vec<usize> = column.trim_end_matches("_error").rsplit('_').map_while(numbers_in).collect();
    numbers.reverse();
    numbers
}

/// A result whose numbers have their units, those of a box of this dimension.
pub(super) fn with_units(id: AnalysisId, result: Value, dimension: usize) -> Value {
    match result {
        Value::Object(mut entries) => {
            for (key, value) in &mut entries {
                let is_count = COUNTS.contains(&key.as_str());
                let known = named(id, key).filter(|_| !is_count);
                debug_assert!(known.is_some() || is_count || !value.is_f64(), "unit of `{key}` of {id:?}");
                *value = match known {
                    Some(known) => numbers_with_unit(id, value.take(), known.unit.in_words(Some(dimension)), dimension),
                    None => with_units(id, value.take(), dimension),
                };
            }
            Value::Object(entries)
        }
        Value::Array(entries) => entries.into_iter().map(|entry| with_units(id, entry, dimension)).collect(),
        other => other,
    }
}

/// A quantity with its unit: a number, one with an error, or several of these by other names (components, sizes, loops).
fn numbers_with_unit(id: AnalysisId, quantity: Value, unit: &str, dimension: usize) -> Value {
    match quantity {
        Value::Number(value) => json!({ "value": value, "unit": unit }),
        Value::Object(mut number) if number.contains_key("value") => {
            number.insert("unit".to_owned(), unit.into());
            Value::Object(number)
        }
        Value::Object(parts) if parts.keys().all(|key| is_part(key)) => {
            let parts = parts.into_iter().map(|(key, part)| (key, numbers_with_unit(id, part, unit, dimension)));
            Value::Object(parts.collect::<Map<String, Value>>())
        }
        other => with_units(id, other, dimension),
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use crate::quantity::QUANTITIES;
    use std::fmt::Write;
    use std::path::Path;

    /// The page of all quantities.
    fn page() -> String {
        let mut text = "# Columns of the table of energies\n\n\
            Units are those of the scene: of length, mass, time and energy; in shallow water the unit of mass is the water\n\
            that a node holds at the mean depth. A volume is an area in two dimensions, and a length in one. `columns` of\n\
            [`run.json`](guide/summary.md) has those of a run. This page is made from `src/quantity.rs` by `MESOSCOPE_RECORD=1 cargo test --lib quantities`.\n\n\
            `energies.csv` has the columns of this table that have a meaning for its scene. A vector has a column for each\n\
            axis (`momentum_x`, `momentum_y`, …), and `wall_momentum` one for each wall and axis\n\
            (`wall_z_lower_momentum_x`, …). Those that settle fluctuate about a constant in equilibrium: a run looks for\n\
            transients in them.\n\n\
            | column | symbol | unit | settles | meaning |\n|---|---|---|:-:|---|\n"
            .to_owned();
        for quantity in &QUANTITIES {
            let settles = if quantity.settles { "✓" } else { "" };
            row(&mut text, quantity, &format!(" {settles} |"));
        }
        text
    }

    /// The page of the quantities of analyses.
    fn page_of_analyses() -> String {
        let mut text = "# What analyses find\n\n\
            Columns of the tables of analyses, and keys of their results in [`run.json`](guide/summary.md). Units are those of\n\
            [the other columns](columns.md). Vectors have a column for each axis (`velocity_x`), tensors one for each component\n\
            (`pressure_xy`), and species their numbers in the order of the scene (`number_density_0`,\n\
            `radial_distribution_0_1`); a column that ends in `_error` is the standard error of the one before it. This page is\n\
            made from `src/run/analyses/quantities.rs` by `MESOSCOPE_RECORD=1 cargo test --lib quantities`.\n"
            .to_owned();
        for id in AnalysisId::ALL {
            let tables: Vec<String> = id.tables().iter().map(|names| format!("`{}`", names.file)).collect();
            let (name, tables) = (id.name(), tables.join(", "));
            write!(text, "\n## {name}: {tables}\n\n| name | symbol | unit | meaning |\n|---|---|---|---|\n").unwrap();
            for quantity in of(id) {
                row(&mut text, quantity, "");
            }
        }
        text
    }

    fn row(text: &mut String, Quantity { name, symbol, unit, meaning, .. }: &Quantity, more: &str) {
        let name = if name.is_empty() { "any other".to_owned() } else { format!("`{name}`") };
        let [symbol, meaning] = [symbol, meaning].map(|words| words.replace('|', "\\|"));
        writeln!(text, "| {name} | {symbol} | {} |{more} {meaning} |", unit.in_words(None)).unwrap();
    }

    #[test]
    fn pages_of_the_documentation_are_made_from_the_tables() {
        for (name, page) in [("docs/columns.md", page()), ("docs/results.md", page_of_analyses())] {
            let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(name);
            if std::env::var_os("MESOSCOPE_RECORD").is_some() {
                std::fs::write(&path, &page).unwrap();
            }
            let written = std::fs::read_to_string(&path).unwrap();
            assert!(written == page, "{name} is not that of the tables: MESOSCOPE_RECORD=1 writes it");
        }
    }

    #[test]
    fn names_are_found_with_what_is_added_to_them() {
        let name = |id: AnalysisId, column: &str| named(id, column).map(|found| found.name);
        let radial = AnalysisId::RadialDistribution;
        assert_eq!(name(radial, "radial_distribution_0_12_error"), Some("radial_distribution"));
        assert_eq!((name(radial, "pairs_0_1"), name(radial, "colour")), (Some("pairs"), None));
        assert_eq!(name(AnalysisId::Stress, "conservative_xz"), Some("conservative"));
        assert_eq!(name(AnalysisId::Profiles, "velocity_x_error"), Some("velocity"));
        assert_eq!(name(AnalysisId::Chain, "frictionless_exact_separation_variance"), Some("separation_variance"));
        assert_eq!(name(AnalysisId::Circulation, "the inner loop"), Some(""));
        assert_eq!(numbers_of("radial_distribution_0_12_error"), [0, 12]);
        assert_eq!(numbers_of("velocity_x"), [0; 0]);
    }

    #[test]
    fn every_number_of_a_result_has_its_unit() {
        let result = json!({
            "samples": 3, "pressure": { "xx": { "value": 1.5, "error": 0.5 }, "xy": null },
            "surface_tension": { "value": 2.0, "error": null },
        });
        let expected = json!({
            "samples": 3, "pressure": { "xx": { "value": 1.5, "error": 0.5, "unit": "energy units/length unit²" }, "xy": null },
            "surface_tension": { "value": 2.0, "error": null, "unit": "energy units/length unit" },
        });
        assert_eq!(with_units(AnalysisId::Stress, result, 2), expected);
        let result = json!({ "outer": { "initial": 0.25, "resolved_until": null } });
        let expected = json!({ "outer": { "initial": { "value": 0.25, "unit": "length units²/time unit" }, "resolved_until": null } });
        assert_eq!(with_units(AnalysisId::Circulation, result, 2), expected);
    }
}
