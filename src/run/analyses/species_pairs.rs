//! Pairs of species that analyses have a curve each of.

use super::printed_estimate;
use crate::families::Model;
use crate::printable;
use crate::scene::CountedPairs;
use serde_json::{Value, json};
use std::borrow::Cow;

/// The pairs of species of a result, and the two species of a pair.
const PAIRS: &str = "pairs";
pub(super) const SPECIES: &str = "species";

/// The pairs of species that have a curve each.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum SpeciesPairs {
    /// All particles alike.
    Alike,
    /// Two species, the smaller number first.
    Between([usize; 2]),
    /// Every two of this number.
    All(usize),
}

impl SpeciesPairs {
    /// The pairs that a scene asks for.
    pub(crate) fn of(asked: Option<&CountedPairs>, model: &Model) -> Self {
        let number = |name: &String| model.species_named(name).unwrap_or_default();
        match asked {
            None => Self::Alike,
            Some(CountedPairs::Within(name)) if name == CountedPairs::ALL => Self::All(model.species.len()),
            Some(CountedPairs::Within(name)) => Self::Between([number(name); 2]),
            Some(CountedPairs::Between(names)) => {
                let [a, b] = [number(&names[0]), number(&names[1])];
                Self::Between([a.min(b), a.max(b)])
            }
        }
    }

    /// Two species of each curve, in their order; nothing for all particles alike.
    pub(crate) fn species(self) -> Vec<[usize; 2]> {
        match self {
            Self::Alike => Vec::new(),
            Self::Between(pair) => vec![pair],
            Self::All(count) => (0..count).flat_map(|b| (0..=b).map(move |a| [a, b])).collect(),
        }
    }

    /// The columns of a curve end with the numbers of its species, where there are several curves.
    pub(crate) fn suffix(self, place: usize) -> String {
        match (self, self.species().get(place)) {
            (Self::All(_), Some([a, b])) => format!("_{a}_{b}"),
            _ => String::new(),
        }
    }

    /// The names of the two species of a curve; none of all particles alike.
    pub(crate) fn names(self, place: usize, model: &Model) -> Option<[&str; 2]> {
        self.species().get(place).map(|pair| pair.map(|number| model.species[number].name.as_str()))
    }

    /// The result of curves, of which there is one unless all pairs are asked for.
    pub(crate) fn result(self, mut of_curves: Vec<Value>) -> Value {
        if self.are_all() { json!({ PAIRS: of_curves }) } else { of_curves.swap_remove(0) }
    }

    /// True if results are those of several curves.
    pub(crate) fn are_all(self) -> bool {
        matches!(self, Self::All(_))
    }

    /// Number of curves.
    pub(crate) fn curves(self) -> u64 {
        self.species().len().max(1) as u64
    }
}

/// The results of all curves, one or several.
pub(super) fn results_of(result: &Value) -> &[Value] {
    result[PAIRS].as_array().map_or(std::slice::from_ref(result), Vec::as_slice)
}

/// The names of the species of a pair, if a result is of one.
pub(super) fn names(result: &Value) -> impl Iterator<Item = &str> {
    result[SPECIES].as_array().into_iter().flatten().filter_map(Value::as_str)
}

/// The names of two species for people; none if these are not two.
pub(super) fn pair_in_words<'a>(names: impl IntoIterator<Item = &'a str>) -> Option<String> {
    let names: Vec<Cow<'_, str>> = names.into_iter().map(printable::name).collect();
    (names.len() == 2).then(|| names.join("–"))
}

/// Heights and places of peaks as they are printed at the end of a run, by their keys.
pub(super) fn printed_peaks(result: &Value, symbol: &str, keys: [&str; 2]) -> Vec<(String, String)> {
    let line = |peaks: &Value| {
        let [height, place] = keys.map(|key| printed_estimate(&peaks[key]));
        let pair = pair_in_words(names(peaks)).map(|pair| format!(" of {pair}")).unwrap_or_default();
        Some((format!("{symbol} peak{pair}"), format!("{} at {}", height?, place?)))
    };
    results_of(result).iter().filter_map(line).collect()
}
