//! Pair forces in a scene.

use crate::document::Bath;
use crate::document::defaults::{hundredths, is_default, one};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Parameters of a DPD interaction. Repulsions of several add up; a pair of species has the friction of one of them.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct DpdInteraction {
    /// Range rc of the forces of every pair of species that has none of its own in `pairs`.
    #[serde(default = "one")]
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub cutoff: f64,
    /// Exponent of the friction weight ω = (1 - r/rc)^exponent of every pair of species that has none of its own in `pairs`; 2 is the
    /// standard choice.
    #[serde(default = "hundredths::<200>")]
    #[schemars(range(min = 0.0, max = 100.0))]
    pub weight_exponent: f64,
    /// Repulsion a of every pair of species not listed in `pairs`; if all are zero there is no conservative force.
    #[serde(default)]
    pub repulsion: f64,
    /// Friction γ of every pair of species not listed in `pairs`; the noise follows from σ² = 2γkT.
    #[serde(default)]
    #[schemars(range(min = 0.0))]
    pub friction: f64,
    /// A repulsion that grows with the local density: many-body dissipative particle dynamics, in which a negative `repulsion` makes a
    /// liquid with a free surface.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub many_body: Option<ManyBody>,
    /// Pairs of species with coefficients of their own.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    #[schemars(length(max = 32896))]
    pub pairs: Vec<DpdPair>,
    /// The heat bath of every pair, coupled to φ(r) with φ' = √ω.
    #[serde(default, skip_serializing_if = "is_default")]
    pub bath: Bath,
    /// Margin of the neighbour list beyond the cutoff, where the scene needs a list: with memory, beside a coloured
    /// noise, or on a line. With a wide margin the list is rebuilt less often and holds more pairs, with none in every
    /// step; no result but the noise depends on it. Of several `dpd` the largest holds. Left out, the one at which a
    /// step is expected to cost least, by the number of particles, their speeds and the time step. The scene in run.json has
    /// the choice.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = 0.0))]
    pub skin: Option<f64>,
}

impl DpdInteraction {
    /// The frictions of pairs of species.
    fn frictions(&self) -> impl Iterator<Item = f64> {
        self.pairs.iter().filter_map(|pair| pair.friction).chain([self.friction])
    }

    /// True if any pair has a bath.
    pub(crate) fn has_bath(&self) -> bool {
        self.frictions().any(|friction| self.bath.acts(friction))
    }

    /// Whether the bath of any pair has a memory.
    pub(crate) fn remembers(&self) -> bool {
        matches!(self.bath, Bath::Memory { .. })
            && self.frictions().any(|friction| friction != 0.0 || self.bath.acts(friction))
    }
}

/// The repulsion B (ρ̄ᵢ + ρ̄ⱼ) (1 - r/rd) between all particles, which depends on the local density ρ̄ around both.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ManyBody {
    /// Strength B, a force per density.
    #[schemars(range(min = 0.0))]
    pub repulsion: f64,
    /// Range rd of the force and of the weight of the density; to have a liquid, less than the range of the attraction.
    #[serde(default = "hundredths::<75>")]
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub cutoff: f64,
}

/// Coefficients of one pair of species.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct DpdPair {
    /// The two species; the same name twice for a species with itself.
    pub between: [String; 2],
    /// Repulsion a; left out, that of the interaction.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub repulsion: Option<f64>,
    /// Friction γ; left out, that of the interaction.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = 0.0))]
    pub friction: Option<f64>,
    /// Range rc; left out, that of the interaction. At least a hundredth of the largest in the scene.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub cutoff: Option<f64>,
    /// Exponent of the friction weight; left out, that of the interaction.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = 0.0, max = 100.0))]
    pub weight_exponent: Option<f64>,
    /// The many-body repulsion; left out, that of the interaction, from which it must not differ.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub many_body: Option<ManyBody>,
}

impl DpdInteraction {
    /// The many-body repulsion, if it has any strength.
    pub(crate) fn acting_many_body(&self) -> Option<ManyBody> {
        self.many_body.filter(|many_body| many_body.repulsion > 0.0)
    }

    /// The cutoff of the interaction, unless every pair of this many species has one of its own.
    pub(crate) fn common_cutoff(&self, species: usize) -> Option<f64> {
        let mut own: Vec<[&str; 2]> =
            self.pairs.iter().filter(|pair| pair.cutoff.is_some()).map(DpdPair::key).collect();
        own.sort_unstable();
        own.dedup();
        (own.len() < species * (species + 1) / 2).then_some(self.cutoff)
    }
}

impl DpdPair {
    /// Both species, in alphabetical order.
    pub(crate) fn key(&self) -> [&str; 2] {
        let mut key = [self.between[0].as_str(), self.between[1].as_str()];
        key.sort_unstable();
        key
    }
}
