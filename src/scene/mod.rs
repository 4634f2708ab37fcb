//! What the user wrote, typed and checked.
//!
//! [`load`] goes from text to JSON, applies overrides, compares the JSON with the [`schema`] that the types define,
//! reads it into a [`Scene`] and checks what a schema cannot say. Mistakes are reported all at once.

mod builtin;
mod chains;
mod coloured_noise;
mod colours;
mod couplings;
mod error;
pub(crate) mod harmonic_chain;
mod load;
mod nearest;
mod overrides;
mod path;
pub mod placement;
mod problems;
mod semantics;
mod shallow_water;
mod shape;
mod shorten;
mod stability;
mod start;
pub mod surface;
mod text;
mod types;
pub(crate) mod voronoi;
mod voronoi_start;
mod warnings;

pub use builtin::{Builtin, builtin};
pub use error::{Problem, SceneError, Warning};
pub use harmonic_chain::{ChainEquilibrium, ChainOutput, ChainPulse, HarmonicChainInteraction};
pub(crate) use load::checked;
pub use load::{load, load_for, parse, parse_for, read, schema, unknown_builtin};
pub(crate) use overrides::value;
pub use semantics::BYTES_PER_PARTICLE;
pub use start::check_start;
pub use types::*;
pub use voronoi::{
    CellEnergy, EquationOfState, FrictionSolver, InitialMasses, TemperatureRegion, VoronoiForm, VoronoiInteraction,
    shear_waves,
};
pub(crate) use warnings::brief;
pub use warnings::warnings;

impl Space {
    /// Volume of the box (area in two dimensions).
    #[must_use]
    pub fn volume(&self) -> f64 {
        self.lengths.iter().product()
    }

    /// The shortest edge of the box.
    pub(crate) fn shortest_length(&self) -> f64 {
        self.lengths.iter().copied().fold(f64::INFINITY, f64::min)
    }
}

impl Interaction {
    /// Range of the pair forces; zero where there are none.
    #[must_use]
    pub fn cutoff(&self) -> f64 {
        match self {
            Self::Dpd(dpd) => dpd.cutoff,
            _ => 0.0,
        }
    }
}

impl Interaction {
    /// Temperature of the heat bath, in a scene of a temperature; that of the scene without one.
    pub(crate) fn bath_temperature(&self, scene: f64) -> f64 {
        match self {
            Self::Dpd(dpd) => dpd.bath.temperature(scene),
            Self::Langevin(langevin) => langevin.bath.temperature(scene),
            Self::Bonds(bonds) => bonds.bath.temperature(scene),
            Self::ColouredNoise(_)
            | Self::Tether(_)
            | Self::Angles(_)
            | Self::HarmonicChain(_)
            | Self::ShallowWater(_) => scene,
            Self::Voronoi(voronoi) => voronoi.hottest(scene),
        }
    }
}

impl ParticleGroup {
    /// Number of particles, whichever way the scene gives it; a density is rounded to whole chains.
    #[must_use]
    pub fn resolved_count(&self, volume: f64) -> u64 {
        let beads = self.chain.as_ref().map_or(1.0, |chain| f64::from(chain.beads.max(1)));
        match (&self.placement, self.count, self.number_density) {
            (Placement::Listed { positions }, _, _) => positions.len() as u64,
            (_, Some(count), _) => count,
            (_, None, Some(density)) => ((density * volume / beads).round() * beads) as u64,
            (_, None, None) => 0,
        }
    }
}
