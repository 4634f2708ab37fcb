//! The table of a sweep, `sweep.csv`: a row for every variant.

use super::averages::SeedAverage;
use super::observables::{Observable, observable, observables};
use super::summary::SweepSummary;
use super::variant::VariantSummary;
use crate::study::table::{number, rows, settings_of_keys};
use crate::study::{SEED, by_key};

/// The table of variants; `keys` are those that distinguish them.
pub(super) fn text(summary: &SweepSummary, keys: &[&str]) -> String {
    let row = |variant: &VariantSummary| {
        let has_ended = variant.steps > 0 || !variant.means.is_empty();
        let of_run = [
            ("steps", variant.steps as f64),
            ("particles", variant.particles as f64),
            ("wall_seconds", variant.wall_seconds),
            ("particle_steps_per_second", variant.particle_steps_per_second),
        ];
        let mut cells = vec![("variant".to_owned(), variant.name.clone())];
        cells.extend(settings_of_keys(&variant.settings, keys));
        cells.push(("state".to_owned(), variant.state.to_string()));
        cells.extend(of_run.map(|(name, value)| (name.to_owned(), number(has_ended.then_some(value)))));
        (cells, observables(variant))
    };
    table(summary.variants.iter().map(row).collect())
}

/// The table of averages over the seed; none where there are none.
pub(super) fn averages_text(summary: &SweepSummary, keys: &[&str]) -> Option<String> {
    let keys: Vec<&str> = keys.iter().copied().filter(|key| *key != SEED).collect();
    let row = |average: &SeedAverage| {
        let mut cells = settings_of_keys(&average.settings, &keys);
        cells.push(("seeds".to_owned(), average.seeds.to_string()));
        let means = average.means.iter().filter_map(|(name, mean)| observable(name.clone(), mean));
        (cells, means.collect())
    };
    (!summary.averages.is_empty()).then(|| table(summary.averages.iter().map(row).collect()))
}

/// Names of columns and cells in front, and what was measured.
type Row = (Vec<(String, String)>, Vec<Observable>);

/// Lines of cells in front and of all observables with their errors.
fn table(table: Vec<Row>) -> String {
    // A column of errors is there if any row has one.
    let found = table.iter().flat_map(|(_, observables)| observables);
    let columns = by_key(found.map(|observable| (observable.name.clone(), observable.error.is_some())));
    let row = |(mut cells, observables): Row| {
        for (name, errors) in &columns {
            let found = observables.iter().find(|known| known.name == *name);
            // Set and measured may have the same name: `temperature`.
            let mean = if cells.iter().any(|(known, _)| known == name) { "_mean" } else { "" };
            cells.push((format!("{name}{mean}"), number(found.map(|found| found.value))));
            if errors.contains(&true) {
                cells.push((format!("{name}_error"), number(found.and_then(|found| found.error))));
            }
        }
        cells
    };
    rows(table.into_iter().map(row))
}

#[cfg(test)]
mod tests {
    use super::super::look::Look;
    use super::super::variant::{VariantState, VariantSummary};
    use super::*;
    use crate::output::Id;
    use crate::scene::StateFiles;
    use crate::study::Setting;
    use serde_json::{Map, Value, json};

    fn variant(name: &str, setting: Option<Value>, means: Value, results: Value) -> VariantSummary {
        let object = |value: Value| value.as_object().cloned().unwrap_or_default();
        let settings = setting.map(|value| Setting { key: "a.b".to_owned(), value }).into_iter().collect();
        let (name, means, results) = (name.to_owned(), object(means), object(results));
        VariantSummary { name, means, results, ..VariantSummary::blank(settings) }
    }

    #[test]
    fn every_variant_is_a_row_with_means_errors_and_results() {
        let means = json!({"temperature": {"value": 1.5, "error": 0.25}, "pressure": null});
        let results = json!({"diffusion": {"windows": 3, "einstein": {"value": 0.3, "error": null}}});
        let first = variant("b=one,two", Some(json!("one,two")), means, results);
        let further = variant("c=1", None, json!({"temperature": {"value": 2.0, "error": null}}), json!({}));
        let mut failed = variant("b=[1,2]", Some(json!([1, 2])), json!({}), json!({}));
        (failed.state, failed.steps) = (VariantState::Failed, 0);
        let summary = SweepSummary {
            mesoscope_version: String::new(),
            sweep_id: Id::of_sweep([]),
            scene: String::new(),
            adapter: None,
            vary: Vec::new(),
            also: Vec::new(),
            set: Vec::new(),
            steps: None,
            plots: Look::default(),
            variants: vec![first, further, failed],
            averages: Vec::new(),
            state_files: StateFiles::default(),
            base: Value::Object(Map::new()),
        };
        let expected = "variant,a.b,state,steps,particles,wall_seconds,particle_steps_per_second,temperature,\
                        temperature_error,diffusion.windows,diffusion.einstein\n\
                        \"b=one,two\",\"one,two\",finished,10,8,0.5,160,1.5,0.25,3,0.3\n\
                        c=1,,finished,10,8,0.5,160,2,,,\n\
                        \"b=[1,2]\",\"[1,2]\",failed,,,,,,,,\n";
        assert_eq!(text(&summary, &["a.b"]), expected);
    }
}
