//! The table of arrays: what kernels keep in buffers and textures, with name, element and purpose, and the functions by which
//! they load and store what may lie in either. How long an array is, and which of the two it lies in, the plan of a scene says.
//!
//! From this table come the declarations of arrays in WGSL, both variants of every function, and `shaders::Array`.

/// An array by its name.
pub struct Array {
    /// The name of the variable in WGSL, and of the buffer or texture.
    pub name: &'static str,
    /// How kernels see it.
    pub seen: Seen,
    /// What it is for: a phrase without a capital and a full stop.
    pub purpose: &'static str,
}

/// How kernels see an array.
pub enum Seen {
    /// As a variable of this type. A page or a variant that sees it otherwise declares what it sees.
    As(&'static str),
    /// The same of what no kernel changes.
    ReadAs(&'static str),
    /// By the functions of [`ACCESSES`], or of a variant that declares it.
    ByFunctions,
    /// Never by its name: it takes the place of another array in kernels that serve several.
    InPlaceOf(&'static str),
}

const fn array(name: &'static str, of: &'static str, purpose: &'static str) -> Array {
    Array { name, seen: Seen::As(of), purpose }
}

const fn table(name: &'static str, of: &'static str, purpose: &'static str) -> Array {
    Array { name, seen: Seen::ReadAs(of), purpose }
}

const fn either(name: &'static str, purpose: &'static str) -> Array {
    Array { name, seen: Seen::ByFunctions, purpose }
}

const fn stand_in(name: &'static str, other: &'static str, purpose: &'static str) -> Array {
    Array { name, seen: Seen::InPlaceOf(other), purpose }
}

/// All arrays. Those of a topic stand together.
pub const ARRAYS: &[Array] = &[
    // What every scene has.
    array("control", "Control", "clock, key of the step's random words, failures"),
    either("clock", "step and key of its random words, for kernels to read"),
    either("particles", "particles in the order in which they are stored"),
    array("demands", "array<u32>", "workgroups of kernels that depend on the step, as they are and as needed"),
    array("paths", "array<Path>", "where each particle was last, and times round the box"),
    stand_in("gathered_paths", "paths", "the same of the particles of all ranks at a sample"),
    // The grid of cells.
    either("cells", "where each cell begins, or in an ordered mesh ends"),
    array("counts", "array<u32>", "particles in each cell"),
    either("ranks", "place of each particle in its cell"),
    either("sorted", "particles in order of cells; for a list, as they were stored before"),
    either("sorted_positions", "positions in order of cells"),
    either("sorted_momenta", "momenta in order of cells"),
    array("staged", "array<Particle>", "sorted particles between two stages of friction"),
    either("staged_momenta", "momenta of sorted particles between two stages of friction"),
    array("probes", "array<u32>", "one word of every sorted particle for the prefilter"),
    array("row_sums", "array<vec2<u32>>", "prefix sums over rows, then over blocks of 256 rows"),
    array("workgroups_done", "atomic<u32>", "workgroups that have ended the step"),
    // Of one of several ranks.
    table(
        "domains",
        "array<Domain>",
        "the part of the box of this rank, the same with its halo, those of its peers, and that of its bonds",
    ),
    table("stored_number", "u32", "particles stored: its own, and copies of those of other ranks"),
    array(
        "owned_slots",
        "array<u32>",
        "whether a particle is this rank's own in the step, and in an inner cell, by slot",
    ),
    array("outgoing", "array<Particle>", "particles that other ranks need, a stretch a peer"),
    array("outgoing_counts", "array<u32>", "their number for each peer, then the number of sorted particles"),
    // Pairs.
    either("coefficients", "coefficients of each pair of species"),
    array(
        "kept_masks",
        "array<array<u32, KEPT_WORDS>>",
        "pairs that the first pass has found, in the buffer of the particles",
    ),
    array("densities", "array<u32>", "local density around each particle, by id"),
    // Couplings.
    array("kicks", "array<vec4<i32>>", "impulses of half a step, by slot"),
    array("forces", "array<vec4<i32>>", "conservative impulses of half a step at a report, by slot"),
    array(
        "anchors",
        "array<vec4<u32>>",
        "where each particle was when the list was made, and was stored before; the highest bit says which of two lists it was",
    ),
    either(
        "neighbours",
        "number of each particle's pairs, then its pairs, one row of particles after the other; two such lists by turns where pairs remember",
    ),
    either("memories", "what the bath of each listed pair remembers, of both lists"),
    array("slots", "array<u32>", "where each particle is stored, by id"),
    array("position_baths", "array<vec4<f32>>", "bath of each coordinate, by id"),
    table("bonds", "array<vec4<u32>>", "bonds and what they are like"),
    array("bond_baths", "array<f32>", "bath of each bond"),
    array("bond_impulses", "array<f32>", "impulse of the friction and noise of each bond in a step"),
    table("angles", "array<vec4<u32>>", "angles and their stiffness"),
    array("excluded_pairs", "array<vec2<u32>>", "pairs of particles, by id, that bonds spare the repulsion"),
    table("exclusions", "array<u32>", "partners that bonds spare from the pair force, in rows of one length, by id"),
    array(
        "excluded_charges",
        "array<vec4<u32>>",
        "pairs of particles, by id, whose charges bonds exclude, and the product of both",
    ),
    table("charged", "array<vec2<u32>>", "particles with a charge: id and charge"),
    array("node_charges", "array<i32>", "charge of each node of a mesh"),
    array("node_potentials", "array<i32>", "electrostatic potential at each node"),
    array("charge_impulses", "array<i32>", "impulses on all charges together, a component each"),
    table(
        "listed_waves",
        "array<vec4<u32>>",
        "waves of charges that are summed: their numbers along each axis, and their weight",
    ),
    array("wave_sums", "array<vec2<u32>>", "charges times cosine and sine of the phase of each wave, summed"),
    array("charge_stresses", "array<vec2<u32>>", "sums of the stress of waves of charges, a row a workgroup"),
    table("charge_energies", "array<f32>", "energy of each wave of charges, up to the middle of every axis"),
    array("tethers", "array<vec4<u32>>", "where each particle is tied to, by id"),
    array("holds", "array<Hold>", "random force on each particle and when it changes, by id"),
    array("account", "array<vec2<u32>>", "momentum and work that body forces have given, a row a workgroup"),
    array("wall_impulses", "array<u32>", "momentum that each wall has taken up, low and high word of every component"),
    // Reports and samples.
    array("reported", "array<Particle>", "particles of the last report, by id"),
    array("reported_forces", "array<vec4<i32>>", "impulses on each particle at a report, by id"),
    array("reported_momenta", "array<vec4<i32>>", "momenta where the temperature is measured, by id"),
    array("reported_stresses", "array<i32>", "virials of each particle at a report, two tensors by id"),
    array("partial_sums", "array<vec2<u32>>", "sums of each workgroup at a report"),
    array(
        "samples",
        "array<vec2<u32>>",
        "rows of sums waiting to be read, each headed by the step, after their numbers",
    ),
    // Analyses.
    array("histogram", "array<u32>", "pairs by distance, low and high word of each bin"),
    stand_in("histogram_samples", "samples", "histograms of pairs waiting to be read"),
    array("dispatches_done", "u32", "dispatches of a histogram that have run"),
    table("wave_vectors", "array<vec4<i32>>", "waves along each axis, and the species, of density waves"),
    stand_in("density_waves", "partial_sums", "amplitudes of density waves of each workgroup"),
    stand_in("density_wave_samples", "samples", "amplitudes of density waves waiting to be read"),
    array("trackers", "array<Tracker>", "each particle as it was when the window began"),
    stand_in("diffusion_sums", "partial_sums", "sums of displacements of each workgroup"),
    stand_in("diffusion_samples", "samples", "rows of sums of displacements waiting to be read"),
    stand_in("mode_sums", "partial_sums", "sums of transverse modes of each workgroup"),
    stand_in("mode_samples", "samples", "rows of transverse modes waiting to be read"),
    table("chain_starts", "array<vec4<u32>>", "first particle or step, steps, group and particles of each chain"),
    table("chain_walks", "array<u32>", "particles along the bonds of each molecule"),
    stand_in("chain_sums", "partial_sums", "sums of sizes of chains of each workgroup"),
    stand_in("chain_samples", "samples", "rows of sums of sizes of chains waiting to be read"),
    stand_in("momentum_sums", "partial_sums", "sums of momenta of each workgroup"),
    array("centre", "array<vec4<f32>>", "velocity of the centre of mass, one element"),
    array("origins", "array<vec4<f32>>", "each particle's vector when the window began"),
    stand_in("velocity_origins", "origins", "each particle's velocity when the window began"),
    stand_in("velocity_products", "partial_sums", "sums of products of velocities of each workgroup"),
    stand_in("velocity_product_samples", "samples", "rows of products of velocities waiting to be read"),
    stand_in("force_origins", "origins", "the force on each particle when the window began"),
    stand_in("force_products", "partial_sums", "sums of products of forces of each workgroup"),
    stand_in("force_product_samples", "samples", "rows of products of forces waiting to be read"),
    stand_in("velocity_counts", "histogram", "velocities by size: counts of each bin and sums of powers"),
    stand_in("velocity_count_samples", "samples", "histograms of velocities waiting to be read"),
    stand_in("speed_counts", "histogram", "speeds: counts of each bin and sums of powers"),
    stand_in("speed_count_samples", "samples", "histograms of speeds waiting to be read"),
    stand_in("acceleration_counts", "histogram", "accelerations: counts of each bin and sums of powers"),
    stand_in("acceleration_count_samples", "samples", "histograms of accelerations waiting to be read"),
    stand_in("layer_sums", "histogram", "sums over the particles of each layer across an axis"),
    stand_in("layer_samples", "samples", "sums over layers waiting to be read"),
    stand_in("stress_sums", "partial_sums", "sums of stresses of each workgroup"),
    stand_in("stress_samples", "samples", "rows of sums of stresses waiting to be read"),
    // Particles of shallow water.
    either("particle_masses", "masses and ids of the particles"),
    either("tidied", "particles in order of cells, for a moment"),
    either("tidied_masses", "masses and ids of the particles in order of cells, for a moment"),
    either("order", "where the particles lie in order of cells"),
    either("bins", "particles of each cell"),
    either("bin_masses", "masses and ids of the particles of each cell"),
    array("stayed", "array<u32>", "particles that stay in each cell; the highest bit says which stretch is current"),
    array(
        "arrived",
        "array<u32>",
        "particles that arrive in each cell, in the first stretch and in the second, by turns",
    ),
    array("tracers", "array<Water>", "particles without mass"),
    stand_in("tracer_samples", "samples", "tracers at reports, waiting to be read"),
    // The mesh of shallow water.
    array("contributions", "array<i32>", "what cells add to the nodes around them"),
    array("node_masses", "array<u32>", "mass on each node, in integer units"),
    array("previous_masses", "array<u32>", "mass on each node one step before"),
    array("depths", "array<f32>", "smoothed depth on each node, as its deviation from one"),
    array("surface", "array<f32>", "depth and bath together on each node"),
    array("node_bath", "array<f32>", "bath variable of each node"),
    array("once_smoothed", "array<f32>", "depth smoothed once"),
    either("waves", "depth in Fourier space, or between iterations"),
    either("waves_next", "depth after the next pass or iteration"),
    array("symbols", "array<f32>", "weight of each wave, up to the middle of every axis"),
    array("roots", "array<vec2<f32>>", "roots of unity, clockwise"),
    array("iteration", "Iteration", "iterations done, and the weight of each"),
    // Voronoi cells.
    array("places", "Places", "where particles are, and which cells are in doubt"),
    array("face_counts", "array<u32>", "number of faces of each cell"),
    array("face_words", "array<u32>", "neighbour behind each face, and its image"),
    array("face_lengths", "array<f32>", "length of each face"),
    array("face_offsets", "array<f32>", "middle of each face from that of the two particles, along the tangent"),
    array("volumes", "array<f32>", "area of each cell"),
    array("exchanges", "array<i32>", "what came through the faces of each cell: momentum, mass, energy"),
    array("pushes", "array<vec4<i32>>", "momentum that came through the faces of each cell"),
    array("predictions", "array<vec4<f32>>", "velocity, pressure and volume that an exchange is expected to bring"),
    array("estimates", "array<vec4<f32>>", "mean velocities in friction, and residuals"),
    array("solver", "Solver", "how far the solver of the friction has come"),
    array("preconditioners", "array<vec4<f32>>", "what a cell's own friction does to its velocity"),
    array("searches", "array<Search>", "preconditioned residuals"),
    array("images", "array<vec2<f32>>", "what friction makes of preconditioned residuals"),
    array("directions", "array<vec4<f32>>", "directions of the search, and what friction makes of them"),
];

/// Functions by which kernels come to an array that may lie in a buffer or in textures. Each place makes a variant of a slot.
pub struct Access {
    /// The array.
    pub array: &'static str,
    /// What it holds.
    pub element: Element,
    /// The slot, and the name of the variant for each place where the array may lie.
    pub slot: &'static str,
    pub places: &'static [(&'static str, Place)],
    /// The functions; one may use those before it.
    pub functions: &'static [Function],
}

/// Where the elements of an array lie.
pub enum Place {
    /// In a buffer, to which kernels also store.
    Buffer,
    /// In a buffer that kernels only read.
    ReadBuffer,
    /// In a texture: the texels of an element one after the other.
    Texture,
    /// In as many textures as an element has texels.
    Textures(&'static [&'static str]),
}

/// What an array holds.
pub enum Element {
    /// A number or a vector: of one, two or four words.
    Number(&'static str),
    /// A structure whose fields, by name and type, are texels.
    Fields(&'static str, &'static [(&'static str, &'static str)]),
    /// A structure that kernels know in one form, and that lies in buffers in another.
    Packed(Packed),
}

/// An element that is packed to be stored and unpacked when it is loaded.
pub struct Packed {
    /// The structure that kernels know, and the one in a buffer, all of whose fields are pairs of words.
    pub known: &'static str,
    pub stored: &'static str,
    /// The functions from one in a buffer, from its texels, and to one in a buffer.
    pub unpack: &'static str,
    pub unpack_texels: &'static str,
    pub pack: &'static str,
    /// For each texel the function that makes it, and the fields that it holds: one or two.
    pub texels: &'static [(&'static str, &'static [&'static str])],
}

/// A function for an array.
pub enum Function {
    /// Loads an element.
    Load(&'static str),
    /// Stores one.
    Store(&'static str),
    /// Loads a field.
    LoadField(&'static str, &'static str),
    /// Stores a field, or of packed elements all fields that share a texel with it.
    StoreField(&'static str, &'static str),
    /// Copies an element of another array, which lies in this buffer or these textures, to a place here.
    Copy(&'static str, &'static [&'static str]),
}

use Function::{Copy, Load, LoadField, Store, StoreField};

const IN_EITHER: &[(&str, Place)] = &[("buffer", Place::Buffer), ("texture", Place::Texture)];

const PARTICLE: Element = Element::Fields("Particle", &[("position", "vec4<u32>"), ("momentum", "vec4<i32>")]);

const WATER: Element = Element::Packed(Packed {
    known: "Water",
    stored: "StoredWater",
    unpack: "unpacked",
    unpack_texels: "unpacked_texels",
    pack: "packed",
    texels: &[("motion_word", &["position", "velocity"]), ("mass_word", &["mass_and_id"])],
});

const fn access(
    array: &'static str,
    slot: &'static str,
    element: &'static str,
    functions: &'static [Function],
) -> Access {
    Access { array, element: Element::Number(element), slot, places: IN_EITHER, functions }
}

/// The functions of all arrays.
pub const ACCESSES: &[Access] = &[
    access("cells", "arrays/cells", "u32", &[Load("cell_at"), Store("put_cell")]),
    Access {
        array: "coefficients",
        element: Element::Number("vec4<f32>"),
        slot: "arrays/coefficients",
        places: &[("buffer", Place::ReadBuffer), ("texture", Place::Texture)],
        functions: &[Load("coefficient_entry")],
    },
    access("memories", "arrays/memories", "vec2<u32>", &[Load("pair_memory"), Store("put_pair_memory")]),
    access("neighbours", "arrays/neighbours", "u32", &[Load("neighbour_word"), Store("put_neighbour_word")]),
    access("order", "arrays/order", "u32", &[Load("index_in_order"), Store("set_order")]),
    access("ranks", "arrays/ranks", "u32", &[Load("rank_of"), Store("put_rank")]),
    access("waves", "arrays/waves", "vec2<f32>", &[Load("wave_at")]),
    access("waves_next", "arrays/waves_next", "vec2<f32>", &[Store("put_wave")]),
    Access {
        array: "particles",
        element: PARTICLE,
        slot: "arrays/particles",
        places: IN_EITHER,
        functions: &[
            LoadField("stored_position", "position"),
            LoadField("stored_momentum", "momentum"),
            Load("stored_particle"),
            StoreField("store_position", "position"),
            StoreField("replace_stored_momentum", "momentum"),
            Store("store_particle"),
        ],
    },
    // Where rows of cells have frames, with those filled in.
    Access {
        array: "sorted",
        element: PARTICLE,
        slot: "arrays/sorted",
        places: &[
            ("buffer", Place::Buffer),
            ("texture", Place::Texture),
            ("apart", Place::Textures(&["sorted_positions", "sorted_momenta"])),
        ],
        functions: &[
            LoadField("position_at", "position"),
            LoadField("momentum_at", "momentum"),
            Load("particle_at"),
            Store("sort_particle"),
            StoreField("keep_momentum", "momentum"),
        ],
    },
    Access {
        array: "staged_momenta",
        element: Element::Number("vec4<i32>"),
        slot: "arrays/staged_momenta",
        places: &[("texture", Place::Texture)],
        functions: &[Store("put_staged_momentum")],
    },
    // Particles of shallow water stay where they lie, whatever their cells ...
    Access {
        array: "particles",
        element: WATER,
        slot: "water/particles",
        places: &[
            ("in_place", Place::Buffer),
            ("in_place_textures", Place::Textures(&["particles", "particle_masses"])),
        ],
        functions: &[
            Load("load_water"),
            LoadField("stored_water_position", "position"),
            StoreField("store_motion", "position"),
            Store("store_water"),
        ],
    },
    // ... or lie in the bins of their cells.
    Access {
        array: "bins",
        element: WATER,
        slot: "water/particles",
        places: &[("bins", Place::Buffer), ("bins_textures", Place::Textures(&["bins", "bin_masses"]))],
        functions: &[Load("load_water"), Store("store_water")],
    },
    Access {
        array: "tidied",
        element: WATER,
        slot: "water/tidied",
        places: &[("buffers", Place::Buffer), ("textures", Place::Textures(&["tidied", "tidied_masses"]))],
        functions: &[Copy("copy_particle", &["particles", "particle_masses"])],
    },
];
