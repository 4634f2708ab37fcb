//! The exact state: integer positions and momenta, ordered by particle id.

/// Scales between the integer state and real units.
///
/// ```
/// use mesoscope::state::Units;
///
/// let units = Units { dimension: 3, lengths: [8.0, 8.0, 8.0], gaps: [0.0; 3], momentum: 0.5 };
/// // Positions are taken modulo the box, and displacements the shortest way.
/// let [left, right] = [[-0.5, 0.0, 0.0], [1.0, 0.0, 0.0]].map(|position| units.fraction(position));
/// assert_eq!(units.position(left), [7.5, 0.0, 0.0]);
/// assert_eq!(units.displacement(right, left), [1.5, 0.0, 0.0]);
/// assert_eq!(units.momentum([3, 0, -1]), [1.5, 0.0, -0.5]);
/// // Between walls across z, 6 apart, positions have a period of 8.
/// let walled = Units { gaps: [0.0, 0.0, 2.0], ..units };
/// assert_eq!((walled.edges(), walled.volume(), walled.ends()), ([8.0, 8.0, 6.0], 384.0, [0, 0, 3 << 30]));
/// assert_eq!(walled.position(walled.between_walls([0, 0, 1 << 31])), [0.0, 0.0, 3.0]);
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Units {
    /// Number of dimensions, 2 or 3.
    pub dimension: usize,
    /// Lengths after which positions repeat: those of the box and of the gap behind its walls; the third is 1 in two dimensions.
    pub lengths: [f64; 3],
    /// Empty space behind the walls across each axis, which keeps what is at one of them from what is at the other; zero without walls.
    /// The box lies between 0 and the rest of the length.
    pub gaps: [f64; 3],
    /// Value of one unit of integer momentum; a power of two. Of velocity in shallow water.
    pub momentum: f64,
}

impl Units {
    /// The real position of an integer one, in `[0, length)` on each axis; negative behind a lower wall.
    #[must_use]
    pub fn position(&self, fraction: [u32; 3]) -> [f64; 3] {
        std::array::from_fn(|axis| {
            let position = f64::from(fraction[axis]) * self.lengths[axis] / 4_294_967_296.0;
            let behind_lower = self.gaps[axis] > 0.0 && position > self.lengths[axis] - 0.5 * self.gaps[axis];
            if behind_lower { position - self.lengths[axis] } else { position }
        })
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

    /// The shortest edge of the box.
    #[must_use]
    pub fn shortest_length(&self) -> f64 {
        self.lengths.iter().take(self.dimension).copied().fold(f64::INFINITY, f64::min)
    }

    /// Edge lengths of the box, between its walls where it has any; the third is 1 in two dimensions.
    #[must_use]
    pub fn edges(&self) -> [f64; 3] {
        std::array::from_fn(|axis| self.lengths[axis] - self.gaps[axis])
    }

    /// The volume of the box (area in two dimensions).
    #[must_use]
    pub fn volume(&self) -> f64 {
        self.edges().iter().product()
    }

    /// Number of integer places between the walls across each axis, from 0 on; zero without walls.
    #[must_use]
    pub fn ends(&self) -> [u32; 3] {
        let edges = self.edges();
        std::array::from_fn(|axis| {
            let part = edges[axis] / self.lengths[axis];
            if self.gaps[axis] > 0.0 { (part * 4_294_967_296.0).floor() as u32 } else { 0 }
        })
    }

    /// The integer position at fractions of the box, which are those of the period but between walls.
    #[must_use]
    pub fn between_walls(&self, fraction: [u32; 3]) -> [u32; 3] {
        let ends = self.ends();
        std::array::from_fn(|axis| match ends[axis] {
            0 => fraction[axis],
            end => ((u64::from(fraction[axis]) * u64::from(end)) >> 32) as u32,
        })
    }

    /// A real position in the box as an integer one: between walls the nearest place there.
    pub(crate) fn place(&self, position: [f64; 3]) -> [u32; 3] {
        let ends = self.ends();
        let folded = self.fraction(position);
        std::array::from_fn(|axis| match ends[axis] {
            0 => folded[axis],
            end => {
                let places = position[axis] / self.lengths[axis] * 4_294_967_296.0;
                places.clamp(0.0, f64::from(end - 1)).floor() as u32
            }
        })
    }
}

/// The most particles of a state: they are numbered by 32-bit words.
pub(crate) const MOST_PARTICLES: u64 = u32::MAX as u64;

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
    /// Index of each particle's species in [`crate::families::Model::species`].
    pub species: Vec<u32>,
    /// Momenta that the friction sees, where the integrator predicts them (`groot-warren` with λ ≠ ½); else empty.
    pub predicted: Vec<[i32; 3]>,
    /// Masses of particles that each have their own; else empty. In units that the
    /// model chooses; zero for tracers, which have none.
    pub masses: Vec<u32>,
    /// Kinetic and internal energy together of particles that keep account of it, in units that the model chooses; else
    /// empty.
    pub energies: Vec<i32>,
    /// Mass on each mesh node one step before, in the same units, where a bath on the mesh remembers it; empty at step 0.
    pub node_masses: Vec<u32>,
    /// Bath variable of each mesh node, the bits of an `f32`, where there is a bath on the mesh.
    pub node_bath: Vec<u32>,
    /// What the baths of listed pairs remember, in order of the numbers of their particles; empty without memory and
    /// before the first step.
    pub pair_baths: Vec<PairBath>,
    /// Where the particles were when their neighbours were listed; empty without a list and before the first step.
    pub anchors: Vec<[u32; 3]>,
    /// Bath variables of each particle's coordinates, bits of `f32`, where they have baths with memory.
    pub position_baths: Vec<[u32; 3]>,
    /// Bath variable of each bond, the bits of an `f32`, where bonds have baths with memory.
    pub bond_baths: Vec<u32>,
    /// The coloured noise of each particle, where there is one.
    pub holds: Vec<Hold>,
    /// Where each particle is tied to, in scenes with tethers.
    pub tethers: Vec<[u32; 3]>,
    /// What body forces have given so far, one element in scenes with any; else empty.
    pub account: Vec<Account>,
    /// Momentum that each wall has absorbed so far, the lower before the upper of an axis; empty without walls.
    pub walls: Vec<WallImpulse>,
    /// How often each particle has gone round the box along every axis, where a trajectory is written; else empty. The way
    /// since the start is the difference of positions and so many boxes.
    pub images: Vec<[i32; 3]>,
}

/// Particles as a report of a step finds them, ordered by id: what is measured, shown and written into trajectories. A run goes on from a
/// [`State`], whose momenta are half a step behind, and with what baths remember; none goes on from a report.
///
/// ```
/// use mesoscope::state::{Reported, State};
///
/// // At step 0, where a state has the momenta of its report, they are the same.
/// let state = State { positions: vec![[1, 2, 3]], momenta: vec![[4, 5, 6]], species: vec![0], ..State::default() };
/// let reported = Reported::from(state);
/// assert_eq!((reported.len(), reported.total_momentum()), (1, [4, 5, 6]));
/// ```
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct Reported {
    /// The step.
    pub step: u64,
    /// Positions as fractions of the box.
    pub positions: Vec<[u32; 3]>,
    /// Momenta at the full step, in units of [`Units::momentum`].
    pub momenta: Vec<[i32; 3]>,
    /// Index of each particle's species.
    pub species: Vec<u32>,
    /// Masses, as [`State::masses`].
    pub masses: Vec<u32>,
    /// Energies, as [`State::energies`].
    pub energies: Vec<i32>,
    /// How often each particle has gone round the box, as [`State::images`].
    pub images: Vec<[i32; 3]>,
}

impl From<State> for Reported {
    fn from(state: State) -> Self {
        let State { step, positions, momenta, species, masses, energies, images, .. } = state;
        Self { step, positions, momenta, species, masses, energies, images }
    }
}

impl Reported {
    /// How often a particle has gone round the box along every axis, as far as that is known.
    pub(crate) fn image(&self, particle: usize) -> [i32; 3] {
        self.images.get(particle).copied().unwrap_or_default()
    }

    /// The particles of these numbers, in their order; those that do not exist are left out.
    pub(crate) fn of_particles(&self, numbers: &[u32]) -> Self {
        fn of<T: Copy>(array: &[T], numbers: &[u32]) -> Vec<T> {
            numbers.iter().filter_map(|number| array.get(*number as usize).copied()).collect()
        }
        Self {
            step: self.step,
            positions: of(&self.positions, numbers),
            momenta: of(&self.momenta, numbers),
            species: of(&self.species, numbers),
            masses: of(&self.masses, numbers),
            energies: of(&self.energies, numbers),
            images: of(&self.images, numbers),
        }
    }

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
        total(&self.momenta)
    }
}

/// The sum of momenta.
fn total(momenta: &[[i32; 3]]) -> [i64; 3] {
    let mut total = [0; 3];
    for momentum in momenta {
        for axis in 0..3 {
            total[axis] += i64::from(momentum[axis]);
        }
    }
    total
}

/// Defines [`StateArray`] from the fields of a state in the order of a checkpoint, with the types of their elements; `true`
/// where every particle has one.
macro_rules! state_arrays {
    ($($variant:ident $field:ident [$element:ty] $of_particles:literal)*) => {
        /// An array that some states have and others not.
        #[derive(Debug, Clone, Copy, PartialEq, Eq)]
        pub enum StateArray {
            $(#[doc = concat!("[`State::", stringify!($field), "`].")] $variant,)*
        }

        impl StateArray {
            /// All of them, in the order of a checkpoint.
            pub const ALL: [Self; [$(stringify!($field)),*].len()] = [$(Self::$variant),*];

            /// The name, also in a checkpoint.
            pub(crate) const fn name(self) -> &'static str {
                match self { $(Self::$variant => stringify!($field),)* }
            }

            /// True if it has an element for every particle, if any.
            pub(crate) const fn is_of_particles(self) -> bool {
                match self { $(Self::$variant => $of_particles,)* }
            }

            /// Words of an element.
            pub(crate) const fn width(self) -> usize {
                match self { $(Self::$variant => size_of::<$element>() / 4,)* }
            }
        }

        impl State {
            /// The words of an array.
            #[must_use]
            pub fn words(&self, array: StateArray) -> &[u32] {
                match array { $(StateArray::$variant => bytemuck::cast_slice(&self.$field),)* }
            }

            /// Sets an array.
            ///
            /// ```
            /// use mesoscope::state::{StateArray, State};
            ///
            /// let mut state = State { masses: vec![3, 5], ..State::default() };
            /// let mut copy = State::default();
            /// for array in StateArray::ALL {
            ///     copy.set_words(array, state.words(array))?;
            /// }
            /// assert_eq!(copy, state);
            /// assert!(state.set_words(StateArray::Tethers, &[1, 2]).is_err());
            /// # Ok::<(), String>(())
            /// ```
            ///
            /// # Errors
            /// Words that are no whole number of its elements.
            pub fn set_words(&mut self, array: StateArray, words: &[u32]) -> Result<(), String> {
                match array { $(StateArray::$variant => self.$field = elements(array, words)?,)* }
                Ok(())
            }
        }
    };
}

state_arrays! {
    Predicted predicted [[i32; 3]] true
    Masses masses [u32] true
    Energies energies [i32] true
    NodeMasses node_masses [u32] false
    NodeBath node_bath [u32] false
    PairBaths pair_baths [PairBath] false
    Anchors anchors [[u32; 3]] true
    PositionBaths position_baths [[u32; 3]] true
    BondBaths bond_baths [u32] false
    Holds holds [Hold] true
    Tethers tethers [[u32; 3]] true
    Account account [Account] false
    Walls walls [WallImpulse] false
    Images images [[i32; 3]] true
}

/// The elements of an array in its words.
fn elements<T: bytemuck::Pod>(array: StateArray, words: &[u32]) -> Result<Vec<T>, String> {
    let elements = bytemuck::try_cast_slice(words).map_err(|_| format!("its `{}` are cut off", array.name()))?;
    Ok(elements.to_vec())
}

/// How often something crosses the ends of the box on its way, which is shorter than half of it, from one fraction to
/// another.
///
/// ```
/// use mesoscope::state::crossings;
///
/// let [left, middle, right] = [1 << 29, 1 << 31, 7 << 29];
/// assert_eq!(crossings([left, right, left], [right, left, middle]), [-1, 1, 0]);
/// ```
#[must_use]
pub fn crossings(from: [u32; 3], to: [u32; 3]) -> [i32; 3] {
    std::array::from_fn(|axis| {
        let (from, to) = (from[axis], to[axis]);
        let forward = to.wrapping_sub(from).cast_signed() >= 0;
        i32::from(forward && to < from) - i32::from(!forward && to > from)
    })
}

/// The copy of `b` that is nearest to `a` across an axis, where the copy of the box above it is displaced along x by a part of the box.
pub(crate) fn sheared_copy(a: [u32; 3], b: [u32; 3], (axis, shift): (usize, u32)) -> [u32; 3] {
    let boxes_up = crossings(a, b)[axis] as u32;
    [b[0].wrapping_add(boxes_up.wrapping_mul(shift)), b[1], b[2]]
}

/// What the bath of a listed pair remembers.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, bytemuck::Pod, bytemuck::Zeroable)]
pub struct PairBath {
    /// The smaller of the particles' numbers.
    pub first: u32,
    /// The larger one.
    pub second: u32,
    /// e s - λₑ(1 + e)/2 φ at the last step at which the pair was in contact, the bits of an `f32`.
    pub memory: u32,
    /// The low word of that step.
    pub stamp: u32,
    /// 1 if the pair is spared its repulsion; else 0.
    pub spared: u32,
}

/// A random force that is constant for a random time.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, bytemuck::Pod, bytemuck::Zeroable)]
pub struct Hold {
    /// The force, bits of `f32`.
    pub force: [u32; 3],
    /// What is left of its time beyond whole half steps, in half steps, the bits of an `f32`.
    pub fraction: u32,
    /// Whole half steps that are left of its time.
    pub halves: u32,
    /// Number of jumps so far.
    pub jump: u32,
}

/// What body forces have given to all particles together, up to the momenta of a state.
///
/// ```
/// use mesoscope::state::Account;
///
/// let account = Account::new([3, -1, 0], i64::MIN);
/// assert_eq!((account.momentum(), account.work()), ([3, -1, 0], i64::MIN));
/// ```
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, bytemuck::Pod, bytemuck::Zeroable)]
pub struct Account {
    /// Low and high words of three sums of momentum and one of work.
    words: [[u32; 2]; 4],
}

impl Account {
    /// Momentum in units of the state, and work in the unit of energy of a report.
    #[must_use]
    pub fn new([x, y, z]: [i64; 3], work: i64) -> Self {
        Self { words: [x, y, z, work].map(|sum| [sum as u32, (sum >> 32) as u32]) }
    }

    fn sum(&self, index: usize) -> i64 {
        let [low, high] = self.words[index];
        (u64::from(high) << 32 | u64::from(low)).cast_signed()
    }

    /// Momentum, up to p(n-½) in the state of a step n.
    #[must_use]
    pub fn momentum(&self) -> [i64; 3] {
        std::array::from_fn(|axis| self.sum(axis))
    }

    /// Work, up to the report point of the step before.
    #[must_use]
    pub fn work(&self) -> i64 {
        self.sum(3)
    }
}

/// The momentum that a wall has absorbed from all particles that met it, up to the positions of a state.
///
/// ```
/// use mesoscope::state::WallImpulse;
///
/// assert_eq!(WallImpulse::new([3, -1, i64::MIN]).momentum(), [3, -1, i64::MIN]);
/// ```
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, bytemuck::Pod, bytemuck::Zeroable)]
pub struct WallImpulse {
    /// Low and high words of three sums.
    words: [[u32; 2]; 3],
}

impl WallImpulse {
    /// Momentum in units of the state.
    #[must_use]
    pub fn new(momentum: [i64; 3]) -> Self {
        Self { words: momentum.map(|sum| [sum as u32, (sum >> 32) as u32]) }
    }

    /// Momentum in units of the state.
    #[must_use]
    pub fn momentum(&self) -> [i64; 3] {
        self.words.map(|[low, high]| (u64::from(high) << 32 | u64::from(low)).cast_signed())
    }
}

impl State {
    /// Number of elements of an array.
    pub(crate) fn length(&self, array: StateArray) -> usize {
        self.words(array).len() / array.width()
    }

    /// The first array that has neither no element nor one for each particle, where it should.
    pub(crate) fn misshapen(&self) -> Option<StateArray> {
        let wrong = |array: &StateArray| ![0, self.len()].contains(&self.length(*array));
        StateArray::ALL.into_iter().filter(|array| array.is_of_particles()).find(wrong)
    }

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

    /// Total momentum with what walls have absorbed, less what body forces have added, in integer units.
    ///
    /// ```
    /// use mesoscope::state::{Account, State};
    ///
    /// let account = vec![Account::new([7, 0, -1], 0)];
    /// let state = State { momenta: vec![[5, 1, 0], [3, 0, 0]], account, ..State::default() };
    /// assert_eq!(state.exchanged_momentum(), [1, 1, 1]);
    /// ```
    #[must_use]
    pub fn exchanged_momentum(&self) -> [i64; 3] {
        let (total, from_body_forces) =
            (self.total_momentum(), self.account.first().copied().unwrap_or_default().momentum());
        let taken = |axis: usize| self.walls.iter().map(|wall| wall.momentum()[axis]).sum::<i64>();
        std::array::from_fn(|axis| total[axis] - from_body_forces[axis] + taken(axis))
    }

    /// Total momentum in integer units.
    ///
    /// ```
    /// use mesoscope::state::State;
    ///
    /// let momenta = vec![[5, 0, i32::MAX], [-3, 0, i32::MAX]];
    /// let state = State { momenta, ..State::default() };
    /// assert_eq!(state.total_momentum(), [2, 0, 2 * i64::from(i32::MAX)]);
    /// ```
    #[must_use]
    pub fn total_momentum(&self) -> [i64; 3] {
        total(&self.momenta)
    }
}
