//! Stages of a run.

use super::{Announced, Output, Scene};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use serde_json::{Map, Value};

/// A stage of a run. Numbers of the scene are named by their paths, as in overrides: `{"interactions.0.repulsion": 50}`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Stage {
    /// Number of steps.
    #[schemars(range(min = 1))]
    pub steps: u64,
    /// Numbers that change where the stage begins, and stay as they are in the stages that follow.
    #[serde(default, skip_serializing_if = "Map::is_empty")]
    pub set: Map<String, Value>,
    /// Numbers that go along a line in the course of the stage, each with its first and its last value, at which it stays.
    #[serde(default, skip_serializing_if = "Map::is_empty")]
    pub ramp: Map<String, Value>,
    /// Steps from one value of a ramp to the next; left out, a hundredth of the stage.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = 1))]
    pub ramp_every: Option<u64>,
    /// The largest force of a bond in this stage: where its potential has more, the bond pulls or pushes with this, and the energy grows in
    /// proportion to the length. Bonds of any length begin so, those of a finite extent too; momentum stays what it is.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(extend("exclusiveMinimum" = 0, "x-of" = ["particles"]))]
    pub push_off: Option<f64>,
    /// What is measured and written in this stage, beside or in place of what `output` of the scene says: intervals of the table of energies
    /// and of the trajectory, and analyses, which begin with the stage and end with it; `null` leaves one out.
    #[serde(default, skip_serializing_if = "Map::is_empty")]
    #[schemars(with = "Output")]
    pub output: Map<String, Value>,
}

/// Values that a ramp has if its scene does not say how many.
const MOVES: u64 = 100;

impl Stage {
    /// A stage of constant numbers.
    pub(crate) fn new(steps: u64, set: Map<String, Value>) -> Self {
        Self { steps, set, ramp: Map::new(), ramp_every: None, push_off: None, output: Map::new() }
    }

    /// The numbers that change where it begins, with their values and dots only in their paths.
    pub(crate) fn changes(&self) -> impl Iterator<Item = (String, &Value)> {
        self.set.iter().map(|(key, value)| (dotted(key), value))
    }

    /// The numbers that go along a line, with their first and last values; what is no pair of numbers has none.
    pub(crate) fn ramps(&self) -> impl Iterator<Item = (String, Option<[f64; 2]>)> {
        let ends = |value: &Value| match value.as_array().map(Vec::as_slice) {
            Some([first, last]) => Some([first.as_f64()?, last.as_f64()?]),
            _ => None,
        };
        self.ramp.iter().map(move |(key, value)| (dotted(key), ends(value)))
    }

    /// The paths of all numbers that it changes.
    pub(crate) fn keys(&self) -> Vec<String> {
        self.set.keys().chain(self.ramp.keys()).map(|key| dotted(key)).collect()
    }

    /// The first steps of the parts in which all its numbers are constant, counted from its own first.
    pub(crate) fn parts(&self) -> Vec<u64> {
        (0..self.part_count()).map(|part| part * self.part_steps()).collect()
    }

    /// Their number.
    pub(crate) fn part_count(&self) -> u64 {
        self.steps.div_ceil(self.part_steps()).max(1)
    }

    /// Steps of each but the last.
    fn part_steps(&self) -> u64 {
        let every = self.ramp_every.unwrap_or_else(|| self.steps.div_ceil(MOVES));
        if self.ramp.is_empty() { self.steps.max(1) } else { every.max(1) }
    }

    /// The output of the stage, of a scene with this output; analyses of that are those of the last stage. None where it is no output.
    pub(crate) fn output(&self, of_scene: &Output, is_last: bool) -> Option<Output> {
        let output = if is_last { of_scene.clone() } else { of_scene.without_analyses() };
        if self.output.is_empty() {
            return Some(output);
        }
        let mut document = serde_json::to_value(output).ok()?;
        document.as_object_mut()?.extend(self.output.clone());
        serde_json::from_value(document).ok()
    }

    /// Overrides that make the numbers those of one of its parts, of so many.
    pub(crate) fn settings(&self, part: usize, parts: usize) -> Vec<String> {
        let way = if parts < 2 { 1.0 } else { part as f64 / (parts - 1) as f64 };
        let set = self.changes().map(|(key, value)| format!("{key}={value}"));
        let ramps = self.ramps().filter_map(|(key, ends)| Some((key, ends?)));
        // Both ends exactly.
        let value = move |[first, last]: [f64; 2]| if way < 1.0 { first + way * (last - first) } else { last };
        set.chain(ramps.map(|(key, ends)| format!("{key}={}", value(ends)))).collect()
    }
}

impl Scene {
    /// The numbers that are announced, and those that stages change, with the value of each that has the largest magnitude.
    pub(crate) fn announced_in_all(&self) -> Vec<Announced> {
        let mut found = self.announced.clone();
        if self.stages.is_empty() {
            return found;
        }
        let document = serde_json::to_value(self).unwrap_or_default();
        let at_first = |key: &str| document.pointer(&format!("/{}", key.replace('.', "/"))).and_then(Value::as_f64);
        let mut note = |key: String, value: Option<f64>| {
            let Some(value) = value else { return };
            match found.iter_mut().find(|known| dotted(&known.key) == key) {
                Some(known) if known.largest.abs() < value.abs() => known.largest = value,
                Some(_) => {}
                None => found.push(Announced { key, largest: value }),
            }
        };
        for stage in &self.stages {
            stage.keys().into_iter().for_each(|key| note(key.clone(), at_first(&key)));
            stage.changes().for_each(|(key, value)| note(key, value.as_f64()));
            for (key, ends) in stage.ramps() {
                ends.into_iter().flatten().for_each(|value| note(key.clone(), Some(value)));
            }
        }
        found
    }
}

fn dotted(key: &str) -> String {
    key.replace('[', ".").replace(']', "")
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use serde_json::json;

    #[test]
    fn a_ramp_has_both_ends_and_equal_moves() {
        let stage: Stage = serde_json::from_value(json!({
            "steps": 10, "set": {"temperature": 2}, "ramp": {"interactions[0].repulsion": [25, 50]}, "ramp_every": 4,
        }))
        .unwrap();
        assert_eq!(stage.parts(), [0, 4, 8]);
        let settings: Vec<Vec<String>> = (0..3).map(|part| stage.settings(part, 3)).collect();
        for (settings, repulsion) in settings.iter().zip(["25", "37.5", "50"]) {
            assert_eq!(settings, &["temperature=2".to_owned(), format!("interactions.0.repulsion={repulsion}")]);
        }
        let long = Stage { steps: 1050, ramp_every: None, ..stage.clone() };
        assert_eq!((long.parts().len(), long.parts()[1]), (96, 11));
        assert_eq!(Stage { ramp: Map::new(), ..stage.clone() }.parts(), [0]);
        // In a single part a ramp is at its end.
        assert_eq!(stage.settings(0, 1)[1], "interactions.0.repulsion=50");
    }
}
