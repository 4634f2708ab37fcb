//! The table of a sweep, `sweep.csv`: a row for every variant.

use super::summary::SweepSummary;
use super::{files, naming};
use crate::output::{OutputError, push_number, quoted, write_atomically};
use serde_json::Value;
use std::path::Path;

/// Writes the table into the directory of the sweep; `keys` are those that distinguish variants.
pub(super) fn write(directory: &Path, summary: &SweepSummary, keys: &[&str]) -> Result<(), OutputError> {
    let text = text(summary, keys);
    write_atomically(&directory.join(files::TABLE), |writer| writer.write_all(text.as_bytes()))
}

/// A quantity with its standard error, which may be missing.
type Observable = (String, f64, Option<f64>);

fn text(summary: &SweepSummary, keys: &[&str]) -> String {
    let observables: Vec<Vec<Observable>> = summary
        .variants
        .iter()
        .map(|variant| {
            let means = variant.means.iter().filter_map(|(name, mean)| observable(name.clone(), mean));
            let results = variant.results.iter().flat_map(|(name, result)| results(name, result));
            means.chain(results).collect()
        })
        .collect();
    // A column of errors is there if any variant has one.
    let mut columns: Vec<(&str, bool)> = Vec::new();
    for (name, _, error) in observables.iter().flatten() {
        match columns.iter_mut().find(|(known, _)| known == name) {
            Some((_, has_error)) => *has_error |= error.is_some(),
            None => columns.push((name, error.is_some())),
        }
    }
    let mut header: Vec<String> = ["variant"].into_iter().chain(keys.iter().copied()).map(str::to_owned).collect();
    header.extend(["state", "steps", "particles", "wall_seconds", "particle_steps_per_second"].map(str::to_owned));
    for (name, has_error) in &columns {
        // Set and measured may have the same name: `temperature`.
        let mean = if header.iter().any(|known| known == name) { "_mean" } else { "" };
        header.push(format!("{name}{mean}"));
        if *has_error {
            header.push(format!("{name}_error"));
        }
    }
    let mut lines = vec![line(&header)];
    for (variant, observables) in summary.variants.iter().zip(&observables) {
        let mut cells = vec![variant.name.clone()];
        for key in keys {
            let setting = variant.settings.iter().find(|setting| setting.key == *key);
            cells.push(setting.map(|setting| plain(&setting.value)).unwrap_or_default());
        }
        cells.push(variant.state.name().to_owned());
        let ended = variant.steps > 0 || !variant.means.is_empty();
        for value in
            [variant.steps as f64, variant.particles as f64, variant.wall_seconds, variant.particle_steps_per_second]
        {
            cells.push(if ended { number(value) } else { String::new() });
        }
        for (name, has_error) in &columns {
            let found = observables.iter().find(|(known, ..)| known == name);
            cells.push(found.map(|(_, value, _)| number(*value)).unwrap_or_default());
            if *has_error {
                cells.push(found.and_then(|(_, _, error)| *error).map(number).unwrap_or_default());
            }
        }
        lines.push(line(&cells));
    }
    lines.concat()
}

fn line(cells: &[String]) -> String {
    let cells: Vec<_> = cells.iter().map(|cell| quoted(cell)).collect();
    format!("{}\n", cells.join(","))
}

/// Text bare and all else as JSON.
fn plain(value: &Value) -> String {
    match value {
        Value::String(_) => naming::readable(value),
        other => other.to_string(),
    }
}

fn number(value: f64) -> String {
    let mut bytes = Vec::new();
    push_number(&mut bytes, value);
    // Digits are ASCII.
    String::from_utf8(bytes).unwrap_or_default()
}

/// A number, or an object with a mean or a value and maybe a standard error.
fn observable(name: String, found: &Value) -> Option<Observable> {
    let value = found.as_f64().or_else(|| found["mean"].as_f64()).or_else(|| found["value"].as_f64())?;
    Some((name, value, found["standard_error"].as_f64()))
}

/// The numbers in the result of an analysis: `radial_distribution.peak_height`.
fn results(name: &str, result: &Value) -> Vec<Observable> {
    let entries = result.as_object().into_iter().flatten();
    entries.filter_map(|(key, value)| observable(format!("{name}.{key}"), value)).collect()
}

#[cfg(test)]
mod tests {
    use super::super::plots::Look;
    use super::super::summary::{VariantState, VariantSummary};
    use super::super::variation::Setting;
    use super::*;
    use serde_json::{Map, json};

    fn variant(name: &str, setting: Option<Value>, means: Value, results: Value) -> VariantSummary {
        let object = |value: Value| value.as_object().cloned().unwrap_or_default();
        VariantSummary {
            name: name.to_owned(),
            label: name.to_owned(),
            settings: setting.map(|value| Setting { key: "a.b".to_owned(), value }).into_iter().collect(),
            state: VariantState::Finished,
            failure: None,
            particles: 8,
            steps: 10,
            wall_seconds: 0.5,
            particle_steps_per_second: 160.0,
            means: object(means),
            results: object(results),
            warnings: Vec::new(),
        }
    }

    #[test]
    fn every_variant_is_a_row_with_means_errors_and_results() {
        let means = json!({"temperature": {"mean": 1.5, "standard_error": 0.25}, "pressure": null});
        let results = json!({"diffusion": {"windows": 3, "einstein": {"value": 0.3, "standard_error": null}}});
        let first = variant("b=one,two", Some(json!("one,two")), means, results);
        let beside = variant("c=1", None, json!({"temperature": {"mean": 2.0, "standard_error": null}}), json!({}));
        let mut failed = variant("b=[1,2]", Some(json!([1, 2])), json!({}), json!({}));
        (failed.state, failed.steps) = (VariantState::Failed, 0);
        let summary = SweepSummary {
            mesoscope_version: String::new(),
            scene: String::new(),
            adapter: None,
            vary: Vec::new(),
            also: Vec::new(),
            set: Vec::new(),
            steps: None,
            plots: Look::default(),
            variants: vec![first, beside, failed],
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
