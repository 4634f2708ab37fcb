//! How cells lie in buffers, as `shaders/voronoi/cell.wgsl` declares them.

use crate::plan::{Length, Misfit, Places, StateLayout, content};
use crate::shaders::Array;
use crate::state::{State, StateArray};

/// Words of a cell.
const CELL: usize = 8;

/// Voronoi cells: an array `particles` of position, mass and id, momentum, energy and species.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct CellLayout {
    /// Whether cells keep account of their energy.
    pub energies: bool,
}

impl StateLayout for CellLayout {
    fn buffers(&self) -> Vec<Array> {
        vec![Array::Particles]
    }

    fn pack(&self, state: &State, order: &[usize]) -> Result<Vec<Vec<u32>>, Misfit> {
        if state.masses.len() != state.len() {
            return Err("masses are".into());
        }
        if self.energies && state.energies.len() != state.len() {
            return Err("energies are".into());
        }
        let words = order.iter().flat_map(|&id| -> [u32; CELL] {
            let ([x, y, _], [px, py, _]) = (state.positions[id], state.momenta[id]);
            let energy = if self.energies { state.energies[id] } else { 0 };
            [x, y, state.masses[id], id as u32, px as u32, py as u32, energy as u32, state.species[id]]
        });
        Ok(vec![words.collect()])
    }

    fn unpack(&self, step: u64, contents: &[&[u32]], count: usize) -> Result<State, String> {
        let mut state = State {
            step,
            positions: vec![[0; 3]; count],
            momenta: vec![[0; 3]; count],
            species: vec![0; count],
            masses: vec![0; count],
            energies: vec![0; if self.energies { count } else { 0 }],
            ..State::default()
        };
        let mut places = Places::of(count);
        for cell in content(contents, 0).chunks_exact(CELL).take(count) {
            let id = places.take(cell[3])?;
            state.positions[id] = [cell[0], cell[1], 0];
            state.masses[id] = cell[2];
            state.momenta[id] = [cell[4] as i32, cell[5] as i32, 0];
            state.species[id] = cell[7];
            if self.energies {
                state.energies[id] = cell[6] as i32;
            }
        }
        Ok(state)
    }

    fn arrays(&self, count: usize) -> Vec<(StateArray, Length)> {
        let energies = if self.energies { count } else { 0 };
        vec![(StateArray::Masses, Length::Exactly(count)), (StateArray::Energies, Length::Exactly(energies))]
    }
}
