// Charges on a periodic mesh of three dimensions, by which particles that are clouds of charge act on each other.
//
// Weights of splines are integers, whatever a compiler does to sums of products.
//
// Slots without defaults, chosen by src/families/particles/terms/electrostatics/plan.rs:
// - charges/spline: `ORDER` points of a spline along an axis, their weights (`weights_along`, `slopes_along`), and sums over a row of
//   nodes. Variants four, six, made by build/splines.rs.
override CHARGED: u32; // particles with a charge
override CHARGE_NODES_X: u32;
override CHARGE_NODES_Y: u32;
override CHARGE_NODES_Z: u32;
override CHARGE_UNIT: f32; // units of charge on a node per elementary charge, over 2^72: three weights are in 2^-24

// The cell of a mesh along an axis and the place in it in 2^-32, of a fraction of the box.
struct MeshPlace { cell: u32, offset: u32 }
fn mesh_place(fraction: u32, count: u32) -> MeshPlace {
    let low = (fraction & 0xffffu) * count;
    let high = (fraction >> 16u) * count + (low >> 16u);
    return MeshPlace(high >> 16u, (high << 16u) | (low & 0xffffu));
}

// A cloud of charge: the first node under its spline, and the weights along each axis.
struct Cloud {
    first: vec3<u32>,
    along_x: SplineWeights,
    along_y: SplineWeights,
    along_z: SplineWeights,
}

// A node so many after another one, of as many at most as there are.
fn node_after(first: u32, index: u32, count: u32) -> u32 {
    let node = first + index;
    return select(node, node - count, node >= count);
}

fn cloud_at(position: vec4<u32>) -> Cloud {
    let x = mesh_place(position.x, CHARGE_NODES_X);
    let y = mesh_place(position.y, CHARGE_NODES_Y);
    let z = mesh_place(position.z, CHARGE_NODES_Z);
    let before = ORDER / 2u - 1u;
    return Cloud(
        vec3<u32>(
            node_after(x.cell, CHARGE_NODES_X - before, CHARGE_NODES_X),
            node_after(y.cell, CHARGE_NODES_Y - before, CHARGE_NODES_Y),
            node_after(z.cell, CHARGE_NODES_Z - before, CHARGE_NODES_Z),
        ),
        weights_along(x.offset),
        weights_along(y.offset),
        weights_along(z.offset),
    );
}

// Products alone, which are rounded alike wherever they are computed.
fn spread_on(node: u32, weight: i32, of_row: f32) { atomicAdd(&node_charges[node], i32(round(f32(weight) * of_row))); }

// Layers of a cloud, across z, that an invocation works on; a whole number of times it makes ORDER.
override CLOUD_SHARE: u32;

// Spreads charges over the nodes of the mesh. One invocation some layers of a cloud; reads `charged`, `slots` and particles, adds to
// `node_charges`, clears `charge_impulses`.
@compute @workgroup_size(WORKGROUP)
fn spread_charges(@builtin(workgroup_id) workgroup: vec3<u32>, @builtin(local_invocation_index) lane: u32) {
    let index = linear_workgroup(workgroup) * WORKGROUP + lane;
    if (index < 3u) { charge_impulses[index] = 0; }
    let shares = ORDER / CLOUD_SHARE;
    if (index >= CHARGED * shares) { return; }
    let word = charged[index / shares];
    let slot = slots[word.x];
    // Whoever of several ranks owns a particle spreads its charge.
    if (!is_known(slot) || !is_own(particle_at(slot).position)) { return; }
    var cloud = cloud_at(particle_at(slot).position);
    let charge = bitcast<f32>(word.y) * CHARGE_UNIT;
    let begin = index % shares * CLOUD_SHARE;
    for (var k = begin; k < begin + CLOUD_SHARE; k++) {
        let layer = node_after(cloud.first.z, k, CHARGE_NODES_Z) * CHARGE_NODES_Y;
        let of_layer = f32(cloud.along_z.values[k]) * charge;
        for (var j = 0u; j < ORDER; j++) {
            let row = (layer + node_after(cloud.first.y, j, CHARGE_NODES_Y)) * CHARGE_NODES_X;
            spread_row(row, cloud.first.x, cloud.along_x, f32(cloud.along_y.values[j]) * of_layer);
        }
    }
}

// The weights of a difference of the potential of one, two and three nodes either side.
override DIFFERENCE_ONE: i32;
override DIFFERENCE_TWO: i32;
override DIFFERENCE_THREE: i32;

// Weights along each axis, in a gathering of differences: of the nodes under a spline, and of half as many either side as well.
var<private> plain_x: PlainWeights;
var<private> plain_y: PlainWeights;
var<private> plain_z: PlainWeights;
var<private> slopes_x: SplineSlopes;
var<private> slopes_y: SplineSlopes;
var<private> slopes_z: SplineSlopes;

fn potential_at(node: u32) -> f32 { return f32(node_potentials[node]); }
fn is_under_spline(node: u32) -> bool { return node - ORDER / 2u < ORDER; }

// The differences of the potential that a layer of nodes adds to those of a cloud. Fused products, so that all plans round alike.
fn slopes_of_layer(first: vec3<u32>, layer: u32) -> vec3<f32> {
    let along_z = node_after(first.z, layer, CHARGE_NODES_Z) * CHARGE_NODES_Y;
    let under_z = is_under_spline(layer);
    let plain = select(0.0, plain_z.values[min(layer - ORDER / 2u, ORDER - 1u)], under_z);
    let slope = slopes_z.values[layer];
    var sums = vec3<f32>(0.0);
    for (var j = 0u; j < ORDER; j++) {
        let row = (along_z + node_after(first.y, j + ORDER / 2u, CHARGE_NODES_Y)) * CHARGE_NODES_X;
        var of_row = vec2<f32>(0.0);
        if (under_z) { of_row = slope_of_row(row, first.x); } else { of_row.x = potential_of_row(row, first.x); }
        sums.x = fma(of_row.y, plain_y.values[j] * plain, sums.x);
        sums.y = fma(of_row.x, slopes_y.values[j + ORDER / 2u] * plain, sums.y);
        sums.z = fma(of_row.x, plain_y.values[j] * slope, sums.z);
    }
    if (!under_z) { return sums; }
    // Rows beyond the spline along y.
    for (var j = 0u; j < ORDER; j++) {
        let beyond = select(j, j + ORDER, j >= ORDER / 2u);
        let row = (along_z + node_after(first.y, beyond, CHARGE_NODES_Y)) * CHARGE_NODES_X;
        sums.y = fma(potential_of_row(row, first.x), slopes_y.values[beyond] * plain, sums.y);
    }
    return sums;
}

// Impulse of half a step per unit of charge and of a sum of differences.
override CHARGE_IMPULSE_X: f32;
override CHARGE_IMPULSE_Y: f32;
override CHARGE_IMPULSE_Z: f32;

// Slot charges/report: what is done with the impulse of a charge beside adding it to `kicks`.
// Default: nothing. The plan chooses `observed` for reports.
fn note_charge(slot: u32, kick: Steps) {}

// Gathers the impulses on charges. One invocation some layers of a cloud, each with one beyond it; reads `charged`, `slots`, particles and
// `node_potentials`, adds to `kicks` and `charge_impulses`.
@compute @workgroup_size(WORKGROUP)
fn pull_charges(@builtin(workgroup_id) workgroup: vec3<u32>, @builtin(local_invocation_index) lane: u32) {
    let index = linear_workgroup(workgroup) * WORKGROUP + lane;
    let shares = ORDER / CLOUD_SHARE;
    if (index >= CHARGED * shares) { return; }
    let word = charged[index / shares];
    let slot = slots[word.x];
    if (!is_known(slot)) { return; }
    let cloud = cloud_at(particle_at(slot).position);
    plain_x = plain_weights(cloud.along_x);
    plain_y = plain_weights(cloud.along_y);
    plain_z = plain_weights(cloud.along_z);
    slopes_x = slopes_along(cloud.along_x);
    slopes_y = slopes_along(cloud.along_y);
    slopes_z = slopes_along(cloud.along_z);
    let first = vec3<u32>(
        node_after(cloud.first.x, CHARGE_NODES_X - ORDER / 2u, CHARGE_NODES_X),
        node_after(cloud.first.y, CHARGE_NODES_Y - ORDER / 2u, CHARGE_NODES_Y),
        node_after(cloud.first.z, CHARGE_NODES_Z - ORDER / 2u, CHARGE_NODES_Z),
    );
    let scale = -bitcast<f32>(word.y) * vec3<f32>(CHARGE_IMPULSE_X, CHARGE_IMPULSE_Y, CHARGE_IMPULSE_Z);
    let begin = index % shares * CLOUD_SHARE;
    var kick = Steps(0);
    var possible = true;
    for (var layer = begin; layer < begin + CLOUD_SHARE; layer++) {
        // One of the two is under the spline. What a layer adds is rounded by itself, however many an invocation works on.
        let impulse = slopes_of_layer(first, layer) * scale;
        let other = slopes_of_layer(first, layer + ORDER) * scale;
        possible = possible && all_within(impulse, IMPULSE_LIMIT) && all_within(other, IMPULSE_LIMIT);
        kick += select(Steps(0), Steps(round(impulse)) + Steps(round(other)), possible);
    }
    raise(select(FAILURE_IMPULSE, 0u, possible));
    let own_kick = select(Steps(0), kick, is_own(particle_at(slot).position));
    atomicAdd(&charge_impulses[0], own_kick.x);
    atomicAdd(&charge_impulses[1], own_kick.y);
    atomicAdd(&charge_impulses[2], own_kick.z);
    add_kick(slot, kick);
    note_charge(slot, kick);
}

// Takes back what rounding has given all charges together, the same from all but for one unit; from step to step others begin. One
// invocation a charge; reads `charged`, `slots` and `charge_impulses`, adds to `kicks`.
@compute @workgroup_size(WORKGROUP)
fn balance_charges(@builtin(workgroup_id) workgroup: vec3<u32>, @builtin(local_invocation_index) lane: u32) {
    let rank = linear_workgroup(workgroup) * WORKGROUP + lane;
    if (rank >= CHARGED) { return; }
    let slot = slots[charged[rank].x];
    if (!is_known(slot)) { return; }
    let place = i32((clock_step().x + rank) % CHARGED);
    var kick = Steps(0);
    for (var axis = 0u; axis < 3u; axis++) {
        let sum = charge_impulses[axis];
        let count = i32(CHARGED);
        // Rounded down, whatever the sign.
        let whole = (sum - select(0, count - 1, sum < 0)) / count;
        kick[axis] = -(whole + select(0, 1, place < sum - whole * count));
    }
    add_kick(slot, kick);
    note_charge(slot, kick);
}

// == charges/report/observed
// A report of charges: the conservative forces on them.
fn note_charge(slot: u32, kick: Steps) { add_force(slot, held_kick(particle_at(slot), kick)); }
