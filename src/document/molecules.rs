//! Molecules: beads of any species that are bonded together.

use super::defaults::one;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::collections::VecDeque;

/// Molecules of one kind. Beads are numbered from 0.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Molecule {
    /// The species of each bead.
    #[schemars(length(min = 1, max = 65536))]
    pub beads: Vec<String>,
    /// Pairs of beads that are bonded; they join all beads.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    #[schemars(length(max = 1_048_576))]
    pub bonds: Vec<[u32; 2]>,
    /// The type of each bond, for the `types` of an interaction `bonds`; left out, `bond` for all.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub bond_types: Vec<String>,
    /// Triples of beads with angles, the vertex in the middle.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    #[schemars(length(max = 1_048_576))]
    pub angles: Vec<[u32; 3]>,
    /// The type of each angle, for the `types` of an interaction `angles`; left out, `angle` for all.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub angle_types: Vec<String>,
    /// Number of molecules; give this or `number_density`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub count: Option<u64>,
    /// Molecules per unit volume (area in two dimensions); the count is rounded to the nearest integer.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = 0.0))]
    pub number_density: Option<f64>,
    /// Distance of bonded beads at the start.
    #[serde(default = "one")]
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub spacing: f64,
}

impl Molecule {
    /// Number of molecules, whichever way the scene gives it.
    pub(crate) fn resolved_count(&self, volume: f64) -> u64 {
        match (self.count, self.number_density) {
            (Some(count), _) => count,
            (None, Some(density)) => (density * volume).round() as u64,
            (None, None) => 0,
        }
    }

    /// Bonds from end to end: along the shortest way between the two beads that are farthest apart, exactly where there are no rings.
    pub(crate) fn longest_way(&self) -> usize {
        let mut bonded = vec![Vec::new(); self.beads.len()];
        for [a, b] in self.bonds.iter().map(|ends| ends.map(|end| end as usize)) {
            bonded[a].push(b);
            bonded[b].push(a);
        }
        let farthest = |from: usize| {
            let mut reached = vec![false; self.beads.len()];
            let mut ahead = VecDeque::from([(from, 0)]);
            let mut last = (from, 0);
            reached[from] = true;
            while let Some((bead, bonds)) = ahead.pop_front() {
                last = (bead, bonds);
                for &other in &bonded[bead] {
                    if !std::mem::replace(&mut reached[other], true) {
                        ahead.push_back((other, bonds + 1));
                    }
                }
            }
            last
        };
        farthest(farthest(0).0).1
    }
}
