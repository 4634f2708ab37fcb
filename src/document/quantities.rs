//! What autocorrelations, histograms and profiles are of.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A vector of every particle whose autocorrelation can be measured.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema, strum::Display)]
#[serde(rename_all = "kebab-case")]
#[strum(serialize_all = "kebab-case")]
pub enum CorrelatedQuantity {
    /// The velocity, where the temperature is measured.
    Velocity,
    /// The change of momentum around the report over the time it takes: all forces, friction and noise included.
    /// With `splitting` it is that of the whole step, two half kicks and the relaxation between them.
    #[schemars(extend("x-of" = ["particles"], "x-instead" = {
        "voronoi": "\"velocity\" in Voronoi DPD, where momentum moves with mass",
    }))]
    Force,
}

/// A curve fitted to a decay in time t.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum DecayFit {
    /// None (default).
    #[default]
    None,
    /// a exp(-bt).
    Exponential,
    /// a exp(-(bt)^c).
    StretchedExponential,
    /// exp(-at/2) \[cos Ωt + (a/2Ω) sin Ωt\], a damped oscillation, or overdamped where Ω² < 0.
    DampedOscillation,
}

/// The frame of reference of velocities.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Frame {
    /// The box.
    Box,
    /// The centre of mass of all particles at the same step.
    CentreOfMass,
}

/// What a histogram counts.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema, strum::Display)]
#[serde(rename_all = "kebab-case")]
#[strum(serialize_all = "kebab-case")]
pub enum CountedQuantity {
    /// Components of the velocity, where the temperature is measured.
    Velocity,
    /// The magnitude of the velocity.
    Speed,
    /// Components of the acceleration: the force that `autocorrelations` correlate over the mass.
    #[schemars(extend("x-of" = ["particles"], "x-instead" = {
        "voronoi": "\"velocity\" or \"speed\" in Voronoi DPD, where momentum moves with mass",
    }))]
    Acceleration,
}

/// What profiles along an axis show.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema, strum::Display)]
#[serde(rename_all = "kebab-case")]
#[strum(serialize_all = "kebab-case")]
pub enum ProfiledQuantity {
    /// Particles per volume (area in two dimensions), of each species and in all.
    Density,
    /// The velocity of the centre of mass of a bin, by components.
    Velocity,
    /// The kinetic temperature of the velocities relative to that of the centre of mass of the bin.
    Temperature,
    /// The pressure tensor: momentum relative to the mean velocity of the bin, and the virials of its particles, of which each has
    /// half of every pair and bond.
    #[schemars(extend("x-of" = ["particles"], "x-instead" = {
        "voronoi": "`output.viscosity` or `output.shear_wave` for what the stress is wanted for; the faces of cells have no virial",
    }))]
    Stress,
    /// Charge per volume, of all species together, and beside `electrostatics` the potential: the energy of a point charge of one elementary
    /// charge, relative to its mean.
    #[schemars(extend("x-of" = ["particles"], "x-instead" = {
        "voronoi": "cells without a charge: nothing acts on charges in Voronoi DPD",
    }))]
    Charge,
}

impl ProfiledQuantity {
    /// Those that are shown unless a scene names others.
    pub const USUAL: [Self; 3] = [Self::Density, Self::Velocity, Self::Temperature];
}

/// An axis of the box.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema, strum::Display)]
#[serde(rename_all = "kebab-case")]
#[strum(serialize_all = "kebab-case")]
pub enum Axis {
    /// The first.
    X,
    /// The second.
    Y,
    /// The third.
    Z,
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use crate::document::BathScheme;
    use crate::scene;
    use serde_json::{json, to_value};
    use std::collections::BTreeSet;
    use std::fmt::Display;

    /// Messages call choices as scenes do: the two derivations are told alike.
    #[test]
    fn words_of_choices_are_those_of_scenes() {
        fn compare<T: Serialize + Display>(choices: &[T]) {
            for choice in choices {
                assert_eq!(to_value(choice).unwrap(), json!(choice.to_string()));
            }
        }
        compare(&[Axis::X, Axis::Y, Axis::Z]);
        compare(&[CorrelatedQuantity::Velocity, CorrelatedQuantity::Force]);
        compare(&[CountedQuantity::Velocity, CountedQuantity::Speed, CountedQuantity::Acceleration]);
        compare(&ProfiledQuantity::USUAL);
        compare(&[ProfiledQuantity::Stress]);
        compare(&[BathScheme::CotterReich, BathScheme::Symmetric, BathScheme::Exponential]);
        let mut kinds = BTreeSet::new();
        for builtin in scene::builtin() {
            for interaction in scene::load(builtin.name, &[]).unwrap().interactions() {
                assert_eq!(to_value(interaction).unwrap()["type"], json!(interaction.name()));
                kinds.insert(interaction.name());
            }
        }
        assert!(kinds.len() > 5, "{kinds:?}");
    }
}
