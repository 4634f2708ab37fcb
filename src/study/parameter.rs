//! What an axis calls a key of a scene: its quantity, what that belongs to, and its unit.

use crate::plot::capitalised;
use crate::quantity::{RATE, TIME, Unit, VELOCITY};
use crate::scene::Scene;
use serde_json::Value;

const LENGTH: Unit = Unit::Other("length units");

/// Units of numbers of a scene, by the last part of their key.
const UNITS: [(&str, Unit); 16] = [
    ("temperature", Unit::Temperature),
    ("repulsion", Unit::Other("energy units/length unit")),
    ("friction", Unit::Other("mass units/time unit")),
    ("stiffness", Unit::Other("energy units/length unit²")),
    ("cutoff", LENGTH),
    ("skin", LENGTH),
    ("length", LENGTH),
    ("extent", LENGTH),
    ("spacing", LENGTH),
    ("radius", LENGTH),
    ("mass", Unit::Other("mass units")),
    ("number_density", Unit::Density),
    ("rate", RATE),
    ("rotation", RATE),
    ("wave_speed", VELOCITY),
    ("time", TIME),
];

/// Parts of a scene that a key within them is not said to be of.
const LISTS: [&str; 6] = ["space", "time", "interactions", "particles", "pairs", "species"];

/// Interactions and their parts whose keys of the same names have other units, which no axis gives.
const OTHERWISE: [&str; 3] = ["harmonic-chain", "angles", "many_body"];

/// The name of a key for an axis: `Repulsion of A–B (energy units/length unit)` for `interactions.0.pairs.0.repulsion`,
/// where the scene says whose it is. Where the quantity of the key is not known it is the key, as short as `short`.
///
/// ```
/// use mesoscope::{scene, study};
///
/// let mixture = scene::load("binary-mixture", &[])?;
/// let label = |key| study::parameter_label(key, key, &mixture);
/// assert_eq!(label("interactions.0.pairs.0.repulsion"), "Repulsion of A–B (energy units/length unit)");
/// assert_eq!(label("particles.1.number_density"), "Number density of B (1/length unit²)");
/// assert_eq!(label("time.step"), "Time step (time units)");
/// assert_eq!(label("integrator.type"), "Type of the integrator");
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[must_use]
pub fn parameter_label(key: &str, short: &str, scene: &Scene) -> String {
    let (name, unit) = in_words(key, scene).unwrap_or_else(|| (short.to_owned(), String::new()));
    capitalised(&name) + &unit
}

/// The name of a key within a sentence: `repulsion of A–B`.
pub(crate) fn parameter_name(key: &str, scene: &Scene) -> String {
    in_words(key, scene).map_or_else(|| key.to_owned(), |(name, _)| name)
}

/// The quantity of a key with what it belongs to, and its unit in parentheses, where that is known.
fn in_words(key: &str, scene: &Scene) -> Option<(String, String)> {
    // Plain data: this conversion cannot fail.
    let document = serde_json::to_value(scene).unwrap_or_default();
    let parts: Vec<&str> = key.split('.').collect();
    // All that the key lies in, the outermost first.
    let mut around = vec![&document];
    for part in &parts[..parts.len() - 1] {
        let outer = around[around.len() - 1];
        around.extend(part.parse().map_or_else(|_| outer.get(part), |index: usize| outer.get(index)));
    }
    let names: Vec<&str> = parts.into_iter().filter(|part| part.parse::<usize>().is_err()).collect();
    let unit_in_words = |unit: Unit| format!(" ({})", unit.in_words(Some(scene.space.lengths.len())));
    let (name, holders) = names.split_last()?;
    if names == ["time", "step"] {
        return Some(("time step".to_owned(), unit_in_words(TIME)));
    }
    let holder = holders
        .last()
        .filter(|holder| !LISTS.contains(*holder))
        .map(|holder| format!("the {}", holder.replace('_', " ")));
    let owner = around.iter().rev().find_map(|object| owner(object));
    let of: Vec<String> = [name.replace('_', " ")].into_iter().chain(holder).chain(owner).collect();
    let is_otherwise = |object: &&Value| object["type"].as_str().is_some_and(|kind| OTHERWISE.contains(&kind));
    let has_unit = !around.iter().any(is_otherwise) && !names.iter().any(|name| OTHERWISE.contains(name));
    let unit = UNITS.iter().find(|(known, _)| known == name && has_unit).map(|(_, unit)| unit_in_words(*unit));
    Some((of.join(" of "), unit.unwrap_or_default()))
}

/// Whose the values of an object are: those of a pair of species, or of one.
fn owner(object: &Value) -> Option<String> {
    let text = |value: &Value| value.as_str().map(str::to_owned);
    let pair: Option<Vec<String>> = object["between"].as_array().map(|pair| pair.iter().filter_map(text).collect());
    pair.map(|pair| pair.join("–")).or_else(|| text(&object["species"]))
}
