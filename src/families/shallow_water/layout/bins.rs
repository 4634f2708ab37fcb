//! How particles lie in bins.

use super::WATER;
use crate::plan::Misfit;

/// A bin of particles for every cell of a mesh.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Bins {
    /// Cells on each axis.
    pub cells: [u32; 2],
    /// Particles that stay in a cell, for which its bin has places.
    pub capacity: usize,
    /// Particles that arrive in a step, for which it has places twice.
    pub arrivals: usize,
    /// Whether cells are centred on nodes, rather than between them.
    pub centred: bool,
}

impl Bins {
    fn cell(&self, position: [u32; 3]) -> usize {
        let along = |axis: usize| {
            let count = u64::from(self.cells[axis]);
            let shift = if self.centred { 1 << 31 } else { 0 };
            ((u64::from(position[axis]) * count + shift) >> 32) % count
        };
        (along(1) * u64::from(self.cells[0]) + along(0)) as usize
    }

    fn count(&self) -> usize {
        self.cells[0] as usize * self.cells[1] as usize
    }

    /// Puts particles into their bins: the bins, how many are in each, and none on their way.
    pub(super) fn pack(&self, particles: &[[u32; WATER]]) -> Result<Vec<Vec<u32>>, Misfit> {
        let mut bins = vec![0; WATER * self.places() * self.count()];
        let mut stayed = vec![0; self.count()];
        for particle in particles {
            let cell = self.cell([particle[0], particle[1], 0]);
            let place = stayed[cell] as usize;
            if place == self.capacity {
                return Err(Misfit::Crowded);
            }
            let first = WATER * (cell * self.places() + place);
            bins[first..first + WATER].copy_from_slice(particle);
            stayed[cell] += 1;
        }
        Ok(vec![bins, stayed, vec![0; 2 * self.count()]])
    }

    fn places(&self) -> usize {
        self.capacity + 2 * self.arrivals
    }

    /// The particles in bins, those that have stayed and those that have arrived.
    pub(super) fn particles<'a>(&self, bins: &'a [u32], stayed: &[u32], arrived: &[u32]) -> Vec<&'a [u32]> {
        let mut particles = Vec::new();
        for (cell, bin) in bins.chunks_exact(WATER * self.places()).enumerate().take(self.count()) {
            let bin: Vec<&[u32]> = bin.chunks_exact(WATER).collect();
            let low = stayed.get(cell).map_or(0, |word| (word & 0x7fff_ffff) as usize);
            particles.extend(bin.iter().take(low.min(self.capacity)));
            for turn in 0..2 {
                let high = arrived.get(turn * self.count() + cell).map_or(0, |count| *count as usize);
                particles.extend(bin.iter().skip(self.capacity + turn * self.arrivals).take(high.min(self.arrivals)));
            }
        }
        particles
    }
}
