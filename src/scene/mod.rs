//! What the user wrote, typed and checked.

pub mod placement;
mod types;

pub use types::*;

impl Space {
    /// Volume of the box (area in two dimensions).
    #[must_use]
    pub fn volume(&self) -> f64 {
        self.lengths.iter().product()
    }
}

impl ParticleGroup {
    /// Number of particles, whichever way the scene gives it.
    #[must_use]
    pub fn resolved_count(&self, volume: f64) -> u64 {
        match (&self.placement, self.count, self.number_density) {
            (Placement::Listed { positions }, _, _) => positions.len() as u64,
            (_, Some(count), _) => count,
            (_, None, Some(density)) => (density * volume).round() as u64,
            (_, None, None) => 0,
        }
    }
}
