// Collects the particles of a cell and spreads them over the nodes under its splines.
//
// The moments Σ m xᵃ yᵇ of the cell are integer sums, so that their order does not matter; the masses of the nodes
// follow from them, and what rounding leaves over goes to one node: no mass is lost.

// A number from 0 to 2²³ plus this is rounded to an integer, which is then in the last bits.
const ROUNDING: f32 = 8388608.0;
// The most that the integers of a cell hold, and what stands for more: less than nothing, which the nodes notice.
const MOST: f32 = 2.1e9;
const TOO_MUCH: i32 = -1073741824;
@group(0) @binding(18) var<storage, read_write> contributions: array<i32>; // [node of the cell][cell]

@compute @workgroup_size(WORKGROUP)
fn main(@builtin(workgroup_id) workgroup: vec3<u32>, @builtin(num_workgroups) workgroups: vec3<u32>,
    @builtin(local_invocation_index) lane: u32) {
    let cell = linear_workgroup(workgroup, workgroups) * WORKGROUP + lane;
    if (cell == 0u) { begin_unsorted_step(); }
    if (cell >= CELLS_X * CELLS_Y) { return; }
    var moments: array<IntegerPowers, WIDTH>;
    var total = 0.0;
    collect(cell);
    let end = end_of(cell);
    for (var index = first_of(cell); index < end; index++) {
        let particle = stored(index);
        let position = particle.position;
        let mass = particle.mass;
        let x = place_along(position.x, CELLS_X).offset;
        var terms = f32(mass) * powers(place_along(position.y, CELLS_Y).offset);
        total += terms.x;
        moments[0] += bitcast<IntegerPowers>(terms + ROUNDING);
        for (var a = 1u; a < WIDTH; a++) {
            terms *= x;
            moments[a] += bitcast<IntegerPowers>(terms + ROUNDING);
        }
    }
    let offset = i32(end - first_of(cell)) * bitcast<i32>(ROUNDING);
    for (var a = 0u; a < WIDTH; a++) { moments[a] -= offset; }
    var real: Square; // [power of y][power of x]
    for (var a = 0u; a < WIDTH; a++) { real[a] = Powers(moments[a]); }
    let weights = SPLINE * real * transpose(SPLINE);
    var left = moments[0].x;
    for (var k = 0u; k < WIDTH; k++) {
        let shares = IntegerPowers(round(weights[k]));
        for (var l = 0u; l < WIDTH; l++) {
            left -= shares[l];
            contributions[(k * WIDTH + l) * (CELLS_X * CELLS_Y) + cell] = shares[l];
        }
    }
    let own = (NODES_BEFORE * WIDTH + NODES_BEFORE) * (CELLS_X * CELLS_Y) + cell;
    contributions[own] = select(contributions[own] + left, TOO_MUCH, total > MOST);
}
