//! The exact state: integer positions and momenta, ordered by particle id.

/// Scales between the integer state and real units.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Units {
    /// Number of dimensions, 2 or 3.
    pub dimension: usize,
    /// Box edge lengths; the third is 1 in two dimensions.
    pub lengths: [f64; 3],
    /// Value of one unit of integer momentum; a power of two. Of velocity in shallow water.
    pub momentum: f64,
}

impl Units {
    /// The real position of an integer one, in `[0, length)` on each axis.
    #[must_use]
    pub fn position(&self, fraction: [u32; 3]) -> [f64; 3] {
        std::array::from_fn(|axis| f64::from(fraction[axis]) * self.lengths[axis] / 4_294_967_296.0)
    }

    /// The integer position of a real one, taken modulo the box.
    #[must_use]
    pub fn fraction(&self, position: [f64; 3]) -> [u32; 3] {
        std::array::from_fn(|axis| {
            let turns = position[axis] / self.lengths[axis];
            ((turns - turns.floor()) * 4_294_967_296.0).round() as u64 as u32
        })
    }

    /// The shortest displacement from `b` to `a`, in real units: one wrapping subtraction an axis.
    #[must_use]
    pub fn displacement(&self, a: [u32; 3], b: [u32; 3]) -> [f64; 3] {
        std::array::from_fn(|axis| {
            f64::from(a[axis].wrapping_sub(b[axis]) as i32) * self.lengths[axis] / 4_294_967_296.0
        })
    }

    /// The real momentum of an integer one.
    #[must_use]
    pub fn momentum(&self, units: [i32; 3]) -> [f64; 3] {
        std::array::from_fn(|axis| f64::from(units[axis]) * self.momentum)
    }

    /// The volume of the box (area in two dimensions).
    #[must_use]
    pub fn volume(&self) -> f64 {
        self.lengths.iter().product()
    }
}

/// Positions, momenta and species of all particles, ordered by id, at one step.
///
/// `positions` are fractions of the box in units of 2⁻³²; `momenta` are in units of [`Units::momentum`]. In two
/// dimensions the third component is zero. In shallow water, where every particle has a mass of its own, momenta are
/// per unit of mass.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct State {
    /// The step this state belongs to.
    pub step: u64,
    /// Positions as fractions of the box.
    pub positions: Vec<[u32; 3]>,
    /// Momenta.
    pub momenta: Vec<[i32; 3]>,
    /// Index of each particle's species in [`crate::model::Model::species`].
    pub species: Vec<u32>,
    /// Momenta that the friction sees, where the integrator predicts them (`groot-warren` with λ ≠ ½); else empty.
    pub predicted: Vec<[i32; 3]>,
    /// Masses in units of [`crate::model::ShallowWater::mass_unit`], zero for tracers, in shallow water; else empty.
    pub masses: Vec<u32>,
    /// Mass on each mesh node one step before, in the same units, where a bath on the mesh remembers it; empty at step 0.
    pub node_masses: Vec<u32>,
    /// Bath variable of each mesh node, the bits of an `f32`, where there is a bath on the mesh.
    pub node_bath: Vec<u32>,
}

impl State {
    /// Number of particles.
    #[must_use]
    pub fn len(&self) -> usize {
        self.positions.len()
    }

    /// Whether there are no particles.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.positions.is_empty()
    }

    /// Total momentum in integer units.
    #[must_use]
    pub fn total_momentum(&self) -> [i64; 3] {
        let mut total = [0; 3];
        for momentum in &self.momenta {
            for axis in 0..3 {
                total[axis] += i64::from(momentum[axis]);
            }
        }
        total
    }
}
