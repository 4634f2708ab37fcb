//! Bonds and angles in a scene.

use crate::document::defaults::is_default;
use crate::document::{Bath, Links, Scene};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Bonds along chains, between listed particles, or of a file.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct BondsInteraction {
    /// Species whose chains are bonded; left out, all chains.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(length(max = 256))]
    pub species: Option<Vec<String>>,
    /// Pairs of particle numbers to bond, in place of chains.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub pairs: Vec<[u32; 2]>,
    /// Types of bonds in the file of `state`, in place of chains; left out in a scene with a `state` and no chains, all of them.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(length(max = 256))]
    pub types: Option<Vec<String>>,
    /// The potential; left out, none.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub potential: Option<BondPotential>,
    /// Friction γ along the bond.
    #[serde(default)]
    #[schemars(range(min = 0.0))]
    pub friction: f64,
    /// The heat bath of every bond, coupled to its length.
    #[serde(default, skip_serializing_if = "is_default")]
    pub bath: Bath,
    /// Whether bonded particles do not repel each other.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub exclude_repulsion: bool,
    /// True if the charges of bonded particles do not act on each other.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub exclude_charges: bool,
}

impl BondsInteraction {
    /// Whether friction or a bath with memory acts along the bonds.
    pub(crate) fn has_bath(&self) -> bool {
        self.bath.acts(self.friction)
    }

    /// The bonds that it asks for in a scene.
    pub(crate) fn links<'a>(&'a self, scene: &'a Scene) -> Links<'a, 2> {
        let of_start = scene.start().map_or(&[][..], |start| &start.bonds);
        Links { listed: &self.pairs, species: self.species.as_deref(), types: self.types.as_deref(), of_start }
    }
}

/// The potential of a bond of length r.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(tag = "type", rename_all = "kebab-case", deny_unknown_fields)]
pub enum BondPotential {
    /// V = K(r - r₀)²/2.
    Harmonic {
        /// Spring constant K.
        #[schemars(range(min = 0.0))]
        stiffness: f64,
        /// Rest length r₀.
        #[serde(default)]
        #[schemars(range(min = 0.0))]
        length: f64,
    },
    /// Finitely extensible: V = -K R²/2 ln(1 - (r - r₀)²/R²), doi:10.1063/1.458541 with r₀ = 0.
    Fene {
        /// Spring constant K.
        #[schemars(range(min = 0.0))]
        stiffness: f64,
        /// Largest extension R.
        #[schemars(extend("exclusiveMinimum" = 0))]
        extent: f64,
        /// Rest length r₀.
        #[serde(default)]
        #[schemars(range(min = 0.0))]
        length: f64,
    },
}

/// Stiffness of chains, of listed triples, or of the angles of a file.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct AnglesInteraction {
    /// Species whose chains are stiff; left out, all chains.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(length(max = 256))]
    pub species: Option<Vec<String>>,
    /// Triples of particle numbers with the vertex of the angle in the middle, in place of chains.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub triples: Vec<[u32; 3]>,
    /// Types of angles in the file of `state`, in place of chains; left out in a scene with a `state` and no chains, all of them.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(length(max = 256))]
    pub types: Option<Vec<String>>,
    /// Stiffness k.
    pub stiffness: f64,
}

impl AnglesInteraction {
    /// The angles that it asks for in a scene.
    pub(crate) fn links<'a>(&'a self, scene: &'a Scene) -> Links<'a, 3> {
        let of_start = scene.start().map_or(&[][..], |start| &start.angles);
        Links { listed: &self.triples, species: self.species.as_deref(), types: self.types.as_deref(), of_start }
    }
}
