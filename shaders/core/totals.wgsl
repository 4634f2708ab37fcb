// The sums of a report, each in integers of a unit that the plan states.
//
// A sum is known by its name: the constant holds its place in a row of the report, which the plan of a scene decides
// (src/plan/sums.rs). A row has the sums that its scene needs, first those that kernels add up here, then those that
// accounts keep.

override SUM_KINETIC_ENERGY: u32;
override SUM_VIRIAL: u32;               // of all forces
override SUM_MOMENTUM: u32;             // a component for each axis
override SUM_POTENTIAL_ENERGY: u32;
override SUM_CONSERVATIVE_VIRIAL: u32;
override SUM_SQUARED_FORCE: u32;        // of the conservative force on each particle
override SUM_CURVATURE: u32;            // Laplacian of the potential
override SUM_FIRST_STAGE_VIRIAL: u32;   // of the first of two stages of friction
override SUM_ELECTROSTATIC_ENERGY: u32; // of charges, each by itself included
override SUM_BATH_ENERGY: u32 = 0u;     // of baths with memory
override SUM_BATH_SQUARE: u32;          // of their variables
override SUM_BATH_COUNT: u32;           // of the baths that are counted
override SUM_BATH_MOMENTUM: u32;        // bath times momentum, of oscillators
override SUM_BATH_DISPLACEMENT: u32;    // bath times displacement
override SUM_MOMENTUM_DISPLACEMENT: u32;
override SUM_WALLS: u32;                // momentum that walls have absorbed: three components for each
override SUM_GIVEN_MOMENTUM: u32;       // three components of what body forces have given
override SUM_GIVEN_WORK: u32;           // work of body forces
override SUM_MASS: u32;                 // of cells, or of nodes
override SUM_VOLUME: u32;               // of cells
override SUM_FACE_SIDES: u32;           // two for each face
override SUM_INTERNAL_ENERGY: u32;      // of cells
override SUM_TOTAL_ENERGY: u32;         // kinetic and internal, of cells
override SUM_TEMPERATURE: u32;          // of cells
override SUM_LIMITED_EXCHANGES: u32;    // exchanges between cells that a limit has cut
override SUM_ITERATIONS: u32;           // of the solver of friction
override SUM_RESIDUAL: u32;             // of the solver of friction

override OWN_SUMS: u32;    // sums that kernels add up here
override FIRST_GROUP: u32; // rows of partial sums that belong to the kernels before this one

const MOST_OWN_SUMS: u32 = 16u;
var<private> report_totals: array<vec2<u32>, MOST_OWN_SUMS>; // of each invocation

fn total_add(sum: u32, value: Sum64) { report_totals[sum] = sum64_add(report_totals[sum], value); }
fn total_add_momentum(momentum: Steps) {
    let word = momentum_word(momentum, 0);
    total_add(SUM_MOMENTUM, sum64_of_i32(word.x));
    total_add(SUM_MOMENTUM + 1u, sum64_of_i32(word.y));
    if (DIMENSION == 3u) { total_add(SUM_MOMENTUM + 2u, sum64_of_i32(word.z)); }
}
fn observe_bath(energy: f32, square: f32) {
    total_add(SUM_BATH_ENERGY, sum64_of_f32(energy));
    total_add(SUM_BATH_SQUARE, sum64_of_f32(square));
    total_add(SUM_BATH_COUNT, Sum64(1u, 0u));
}

// Adds the totals of a workgroup up, into a row of `partial_sums`. All lanes call it.
fn total_reduce(group: u32, lane: u32) { reduce_totals(group, lane, 0u, OWN_SUMS - 1u); }
// The totals from one sum to another: those of the motion (kinetic energy to momentum) stand together, as do those of
// the configuration.
fn reduce_totals(group: u32, lane: u32, first: u32, last: u32) {
    for (var sum = first; sum <= last; sum++) { reduce_quantity(FIRST_GROUP + group, lane, sum, report_totals[sum]); }
}
fn reduce_motion(group: u32, lane: u32) { reduce_totals(group, lane, SUM_KINETIC_ENERGY, SUM_MOMENTUM + 2u); }
fn reduce_configuration(group: u32, lane: u32) { reduce_totals(group, lane, SUM_POTENTIAL_ENERGY, SUM_CURVATURE); }

// The motion at the report of a split step has the sums of baths that remember, and leaves those of the configuration.
override BATHS_REMEMBER: u32; // 1 where any do

fn reduce_baths(group: u32, lane: u32) {
    if (BATHS_REMEMBER == 1u) { reduce_totals(group, lane, SUM_BATH_ENERGY, OWN_SUMS - 1u); }
}
