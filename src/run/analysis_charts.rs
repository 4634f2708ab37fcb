//! The chart of each table that an analysis leaves, with the results that belong to it.

use crate::numbers::with_error;
use crate::output::files;
use crate::plot::{
    ChainKind, Chart, Found, Mean, autocorrelation_chart, chain_correlation_chart, chain_equilibrium_chart,
    chain_memory_chart, chain_profile_chart, chain_pulse_chart, chain_sizes_chart, circulation_chart, diffusion_chart,
    histogram_chart, neighbours_chart, radial_distribution_chart, shear_wave_chart, viscosity_chart,
};
use crate::scene::Scene;
use crate::table::Table;
use serde_json::{Map, Value};

/// The chart of the table with this name. What is not among the results of the run is left out.
pub(super) fn analysis_chart(name: &str, table: &Table, scene: &Scene, results: &Map<String, Value>) -> Chart {
    let title = scene.title.as_str();
    let column = |name: &str| -> Vec<f64> {
        let index = table.columns.iter().position(|column| column == name);
        let cell = |row: &Vec<f64>| index.and_then(|index| row.get(index)).copied().unwrap_or(f64::NAN);
        if index.is_some() { table.rows.iter().map(cell).collect() } else { Vec::new() }
    };
    let result = |name: &str| results.get(name).unwrap_or(&Value::Null);
    let chain = |chart: fn(&str, &str, &Table) -> Chart| chart(title, &super::chain::subtitle(name, scene), table);
    match name {
        files::CHAIN_PROFILES => chain(chain_profile_chart),
        files::CHAIN_PULSE => chain(chain_pulse_chart),
        files::CHAIN_CORRELATION => chain(chain_correlation_chart),
        files::CHAIN_MEMORY => chain(chain_memory_chart),
        files::CHAIN_EQUILIBRIUM => chain(chain_equilibrium_chart),
        files::RADIAL_DISTRIBUTION => {
            radial_distribution_chart(title, &column("distance"), &column("radial_distribution"))
        }
        files::CHAIN_SIZES => {
            let kinds = result("chain_sizes").as_array().map(Vec::as_slice).unwrap_or_default();
            chain_sizes_chart(title, table, &kinds.iter().map(chain_kind).collect::<Vec<_>>())
        }
        files::DIFFUSION => {
            let found = result("diffusion");
            let [einstein, green_kubo] =
                ["diffusion_einstein", "diffusion_green_kubo"].map(|key| self::found(&found[key]));
            diffusion_chart(title, table, scene.space.lengths.len(), einstein, green_kubo)
        }
        files::VELOCITY_AUTOCORRELATION | files::FORCE_AUTOCORRELATION => {
            let quantity = if name == files::FORCE_AUTOCORRELATION { "force" } else { "velocity" };
            let [lags, values, errors, fit] = ["time", "autocorrelation", "autocorrelation_error", "fit"].map(column);
            let formula = formula(&result(&format!("{quantity}_autocorrelation"))["fit"]);
            autocorrelation_chart(title, quantity, (&lags, &values, &errors), (&formula, &fit))
        }
        files::CIRCULATION => circulation_chart(title, table),
        files::VELOCITY_HISTOGRAM | files::SPEED_HISTOGRAM | files::ACCELERATION_HISTOGRAM => {
            density_chart(title, table)
        }
        files::NEIGHBOURS => neighbours_chart(title, table),
        files::SHEAR_WAVE => {
            let wave = result("shear_wave");
            let text = |key: &str| found(&wave[key]).map(|(value, error)| with_error(value, error));
            let viscosity = text("kinematic_viscosity").map(|text| format!("; kinematic viscosity {text}"));
            let subtitle = format!(
                "velocity along x, projected on the wave that it started with{}",
                viscosity.unwrap_or_default()
            );
            let fit = text("decay_rate").map(|text| format!("exponential decay, rate {text}"));
            shear_wave_chart(title, &subtitle, fit.as_deref().unwrap_or("exponential decay"), table)
        }
        _ => {
            let viscosity = result("viscosity");
            let waves = viscosity["waves"].as_array().map(Vec::as_slice).unwrap_or_default();
            let waves: Vec<Found> = waves.iter().filter_map(|wave| found(&wave["viscosity"])).collect();
            viscosity_chart(title, table, &waves, found(&viscosity["shear_viscosity"]))
        }
    }
}

/// A coefficient with its error.
fn found(result: &Value) -> Option<Found> {
    Some((result["value"].as_f64()?, result["standard_error"].as_f64()))
}

/// A mean as charts take it.
pub(super) fn mean(result: &Value) -> Option<Mean> {
    let standard_error = result["standard_error"].as_f64();
    let from_few_samples = standard_error.is_some() && result["converged"] == false;
    Some(Mean { value: result["mean"].as_f64()?, standard_error, from_few_samples, ..Mean::default() })
}

fn chain_kind(result: &Value) -> ChainKind {
    ChainKind {
        species: result["species"].as_str().unwrap_or_default().to_owned(),
        beads: result["beads"].as_u64().unwrap_or_default(),
        end_to_end: mean(&result["end_to_end_squared"]),
        gyration: mean(&result["radius_of_gyration_squared"]),
    }
}

/// The curve that was fitted to an autocorrelation, with its parameters.
fn formula(fit: &Value) -> String {
    let parameter =
        |name: &str, key: &str| found(&fit[key]).map(|(value, error)| format!("{name} = {}", with_error(value, error)));
    let (curve, parameters) = match fit["curve"].as_str() {
        Some("exponential") => ("a exp(−bt)", vec![("a", "a"), ("b", "b")]),
        Some("stretched-exponential") => ("a exp(−(bt)^{c})", vec![("a", "a"), ("b", "b"), ("c", "c")]),
        Some("damped-oscillation") => ("damped oscillation", vec![("a", "a"), ("Ω²", "frequency_squared")]),
        _ => return "fit".to_owned(),
    };
    let parameters: Vec<String> = parameters.into_iter().filter_map(|(name, key)| parameter(name, key)).collect();
    format!("fit {curve}: {}", parameters.join(", "))
}

/// A histogram from its table: centres of bins, densities, counts, and the density to compare with.
fn density_chart(title: &str, table: &Table) -> Chart {
    let column = |index: usize| table.rows.iter().map(move |row| row.get(index).copied().unwrap_or(f64::NAN));
    let name = |index: usize| table.columns.get(index).map_or("", String::as_str);
    let centres: Vec<f64> = column(0).collect();
    // A single bin does not tell its width, but its density does, unless nothing was counted.
    let width = match centres.as_slice() {
        [first, .., last] => (last - first) / (centres.len() - 1) as f64,
        _ => 1.0 / column(1).sum::<f64>(),
    };
    let first = centres.first().map_or(0.0, |first| first - 0.5 * width);
    let edges: Vec<f64> = if width.is_finite() && width > 0.0 {
        (0..=centres.len()).map(|edge| first + edge as f64 * width).collect()
    } else {
        Vec::new()
    };
    let compared: Vec<[f64; 2]> = centres.iter().zip(column(3)).map(|(centre, density)| [*centre, density]).collect();
    let densities: Vec<f64> = column(1).collect();
    let label = match name(3) {
        "maxwell" => "Maxwell's density",
        _ => "Gaussian of the same variance",
    };
    histogram_chart(title, name(0), &edges, &densities, (label, &compared))
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use serde_json::json;

    #[test]
    fn fits_have_their_numbers_and_errors() {
        let fit = json!({
            "curve": "exponential", "a": { "value": 1.0, "standard_error": null },
            "b": { "value": 4.51234, "standard_error": 0.0312 }, "deviation": 0.1,
        });
        assert_eq!(formula(&fit), "fit a exp(−bt): a = 1, b = 4.512 ± 0.031");
        assert_eq!(formula(&Value::Null), "fit");
    }

    #[test]
    fn results_stand_in_the_charts_of_their_tables() {
        let scene = crate::scene::load("ideal-dissipative-gas", &[]).unwrap();
        let results = json!({
            "diffusion": { "diffusion_einstein": { "value": 0.3, "standard_error": 0.01 }, "diffusion_green_kubo": null },
            "shear_wave": { "decay_rate": { "value": 0.2, "standard_error": 0.01 },
                "kinematic_viscosity": { "value": 7.0, "standard_error": null } },
        });
        let results = results.as_object().unwrap();
        let table = |columns: &[&str]| Table {
            columns: columns.iter().map(ToString::to_string).collect(),
            rows: (0..8).map(|row| vec![1.0 + f64::from(row); columns.len()]).collect(),
        };
        let chart = analysis_chart(files::DIFFUSION, &table(&["time", "mean_squared_displacement"]), &scene, results);
        assert_eq!(chart.panels[0].series[1].name, "6 D t + b, D = 0.300 ± 0.010");
        let chart = analysis_chart(files::SHEAR_WAVE, &table(&["time", "amplitude", "fit"]), &scene, results);
        assert!(chart.subtitle.ends_with("kinematic viscosity 7"), "{}", chart.subtitle);
        assert_eq!(chart.panels[0].series[1].name, "exponential decay, rate 0.200 ± 0.010");
        // A run of an earlier version, without results.
        let chart =
            analysis_chart(files::DIFFUSION, &table(&["time", "mean_squared_displacement"]), &scene, &Map::new());
        assert_eq!(chart.panels[0].series.len(), 1);
    }
}
