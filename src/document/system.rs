//! The system of a scene: its kind, the interactions that this kind has, and their integrator.

use super::{CellIntegrator, Integrator, Interaction, ShallowWaterInteraction, VoronoiInteraction, WaterIntegrator};
use schemars::{JsonSchema, Schema, SchemaGenerator};
use serde::de::{DeserializeOwned, Error};
use serde::{Deserialize, Deserializer, Serialize, Serializer};
use serde_json::{Value, json};
use std::borrow::Cow;

/// The system of a scene, which is the keys `interactions` and `integrator` of the document.
#[derive(Debug, Clone, PartialEq)]
pub enum System {
    /// Particles with forces between them.
    Particles {
        /// How the equations of motion are integrated.
        integrator: Integrator,
        /// Forces between particles.
        interactions: Vec<Interaction>,
    },
    /// Shallow water on particles and a mesh.
    ShallowWater {
        /// How the equations of motion are integrated.
        integrator: WaterIntegrator,
        /// The water.
        water: Box<ShallowWaterInteraction>,
    },
    /// Voronoi cells.
    Voronoi {
        /// How the equations of motion are integrated.
        integrator: CellIntegrator,
        /// The fluid of the cells.
        cells: Box<VoronoiInteraction>,
    },
}

/// A kind of systems. Keys and choices of a scene that have a meaning in some kinds only name these in the schema, in `x-of`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, strum::IntoStaticStr)]
#[strum(serialize_all = "kebab-case")]
pub enum SystemKind {
    /// [`System::Particles`].
    Particles,
    /// [`System::ShallowWater`].
    ShallowWater,
    /// [`System::Voronoi`].
    Voronoi,
}

impl SystemKind {
    /// All kinds.
    pub const ALL: [Self; 3] = [Self::Particles, Self::ShallowWater, Self::Voronoi];

    /// The name of the kind in the schema; that of its interaction, where it has one of its own.
    pub(crate) fn name(self) -> &'static str {
        self.into()
    }

    /// The kind, as messages call it.
    pub(crate) const fn in_words(self) -> &'static str {
        match self {
            Self::Particles => "particles",
            Self::ShallowWater => "shallow water",
            Self::Voronoi => "Voronoi DPD",
        }
    }

    /// The kind of systems with these interactions, as a document has them.
    pub(crate) fn from_interactions(interactions: &[Value]) -> Self {
        let is_among = |kind: &Self| interactions.iter().any(|interaction| interaction["type"] == kind.name());
        Self::ALL.into_iter().find(is_among).unwrap_or(Self::Particles)
    }
}

impl System {
    /// Interactions that are the only one of a scene.
    pub(crate) const STANDING_ALONE: [&str; 3] = ["harmonic-chain", "shallow-water", "voronoi"];

    /// The kind of the system.
    pub(crate) const fn kind(&self) -> SystemKind {
        match self {
            Self::Particles { .. } => SystemKind::Particles,
            Self::ShallowWater { .. } => SystemKind::ShallowWater,
            Self::Voronoi { .. } => SystemKind::Voronoi,
        }
    }

    /// The name of the integrator in a scene.
    #[must_use]
    pub const fn integrator_name(&self) -> &'static str {
        match self {
            Self::Particles { integrator: Integrator::Splitting { .. }, .. }
            | Self::Voronoi { integrator: CellIntegrator::Splitting {}, .. } => "splitting",
            Self::Particles { integrator: Integrator::GrootWarren { .. }, .. } => "groot-warren",
            Self::Particles { integrator: Integrator::CotterReich {}, .. } => "cotter-reich",
            Self::ShallowWater { integrator: WaterIntegrator::Gyro {}, .. } => "gyro",
            Self::ShallowWater { integrator: WaterIntegrator::Rotate {}, .. } => "rotate",
            Self::Voronoi { integrator: CellIntegrator::Euler {}, .. } => "euler",
        }
    }

    /// The integrator of particles, in a system of them.
    #[must_use]
    pub const fn particle_integrator(&self) -> Option<&Integrator> {
        if let Self::Particles { integrator, .. } = self { Some(integrator) } else { None }
    }

    /// The integrator of particles, in a system of them, to replace it.
    #[must_use]
    pub const fn particle_integrator_mut(&mut self) -> Option<&mut Integrator> {
        if let Self::Particles { integrator, .. } = self { Some(integrator) } else { None }
    }

    /// The interactions of particles, of which systems of other kinds have none.
    pub(crate) fn interactions(&self) -> &[Interaction] {
        if let Self::Particles { interactions, .. } = self { interactions } else { &[] }
    }

    /// The interactions of particles, in a system of them, to change them.
    #[must_use]
    pub const fn interactions_mut(&mut self) -> Option<&mut Vec<Interaction>> {
        if let Self::Particles { interactions, .. } = self { Some(interactions) } else { None }
    }

    /// Shallow water, in a system of it.
    pub(crate) fn shallow_water(&self) -> Option<&ShallowWaterInteraction> {
        if let Self::ShallowWater { water, .. } = self { Some(water) } else { None }
    }

    /// Shallow water, in a system of it, to change it.
    #[must_use]
    pub fn shallow_water_mut(&mut self) -> Option<&mut ShallowWaterInteraction> {
        if let Self::ShallowWater { water, .. } = self { Some(water) } else { None }
    }

    /// The fluid of Voronoi cells, in a system of them.
    pub(crate) fn voronoi(&self) -> Option<&VoronoiInteraction> {
        if let Self::Voronoi { cells, .. } = self { Some(cells) } else { None }
    }

    /// The highest temperature kT of a bath, in a scene of a temperature; 0 without interactions.
    pub(crate) fn hottest(&self, scene: f64) -> f64 {
        match self {
            Self::Particles { interactions, .. } => {
                interactions.iter().map(|interaction| interaction.bath_temperature(scene)).fold(0.0, f64::max)
            }
            Self::ShallowWater { .. } => scene,
            Self::Voronoi { cells, .. } => cells.hottest(scene),
        }
    }
}

/// The interactions of the other kinds, each of which is a system by itself.
#[derive(Clone, Serialize, Deserialize, JsonSchema)]
#[serde(tag = "type", rename_all = "kebab-case", deny_unknown_fields)]
enum Medium {
    /// Rotating shallow water by the Hamiltonian particle-mesh method, with a heat bath on the mesh on request.
    ShallowWater(Box<ShallowWaterInteraction>),
    /// Voronoi DPD: particles that are the cells of a tessellation, with friction, noise and pressure at their faces.
    Voronoi(Box<VoronoiInteraction>),
}

/// The keys of a document that are a system.
#[derive(Serialize)]
struct Keys<'a, Integrator, Interaction> {
    integrator: &'a Integrator,
    interactions: &'a [Interaction],
}

impl Serialize for System {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        match self {
            Self::Particles { integrator, interactions } => Keys { integrator, interactions }.serialize(serializer),
            Self::ShallowWater { integrator, water } => {
                Keys { integrator, interactions: &[Medium::ShallowWater(water.clone())] }.serialize(serializer)
            }
            Self::Voronoi { integrator, cells } => {
                Keys { integrator, interactions: &[Medium::Voronoi(cells.clone())] }.serialize(serializer)
            }
        }
    }
}

impl<'de> Deserialize<'de> for System {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        #[derive(Deserialize)]
        struct Keys {
            integrator: Option<Value>,
            #[serde(default)]
            interactions: Vec<Value>,
        }
        fn integrator<T: DeserializeOwned + Default, E: Error>(value: Option<Value>) -> Result<T, E> {
            value.map_or_else(|| Ok(T::default()), |value| serde_json::from_value(value).map_err(E::custom))
        }
        let keys = Keys::deserialize(deserializer)?;
        if SystemKind::from_interactions(&keys.interactions) == SystemKind::Particles {
            let interactions = keys.interactions.into_iter().map(serde_json::from_value).collect::<Result<_, _>>();
            let interactions = interactions.map_err(D::Error::custom)?;
            return Ok(Self::Particles { integrator: integrator(keys.integrator)?, interactions });
        }
        let [medium] = <[Value; 1]>::try_from(keys.interactions)
            .map_err(|_| D::Error::custom("an interaction that is a system by itself stands beside others"))?;
        Ok(match serde_json::from_value(medium).map_err(D::Error::custom)? {
            Medium::ShallowWater(water) => Self::ShallowWater { integrator: integrator(keys.integrator)?, water },
            Medium::Voronoi(cells) => Self::Voronoi { integrator: integrator(keys.integrator)?, cells },
        })
    }
}

impl JsonSchema for System {
    fn inline_schema() -> bool {
        true
    }

    fn schema_name() -> Cow<'static, str> {
        "System".into()
    }

    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        let branches = |schema: Schema| match schema.get("oneOf") {
            Some(Value::Array(branches)) => branches.clone(),
            _ => Vec::new(),
        };
        let integrators = [
            (SystemKind::Particles, Integrator::json_schema(generator)),
            (SystemKind::ShallowWater, WaterIntegrator::json_schema(generator)),
            (SystemKind::Voronoi, CellIntegrator::json_schema(generator)),
        ];
        let integrators = integrators.into_iter().flat_map(|(kind, schema)| {
            branches(schema).into_iter().map(move |mut branch| {
                branch["x-of"] = json!([kind.name()]);
                branch
            })
        });
        let integrators: Vec<Value> = integrators.collect();
        let interactions = [Interaction::json_schema(generator), Medium::json_schema(generator)];
        let interactions: Vec<Value> = interactions.into_iter().flat_map(branches).collect();
        schemars::json_schema!({
            "type": "object",
            "properties": {
                "integrator": {
                    "description": "How the equations of motion are integrated.",
                    // The first is one of two kinds.
                    "anyOf": integrators,
                },
                "interactions": {
                    "description": "Forces between particles.",
                    "type": "array",
                    "default": [],
                    "maxItems": 256,
                    "items": { "description": "A force between particles.", "oneOf": interactions },
                },
            },
        })
    }
}
