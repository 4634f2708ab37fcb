// Charges on a periodic mesh of three dimensions, by which particles that are clouds of charge act on each other.
//
// Weights of splines are integers, so that charges are gathered by the weights that they were spread with, whatever a compiler does to
// sums of products.
//
// Slots without defaults, chosen by src/families/particles/terms/electrostatics/plan.rs:
// - charges/spline: `ORDER` points of a spline along an axis, and their weights (`weights_along`). Variants four, six.
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

// One layer of a cloud of charge: nodes at one place along z under its spline.
struct CloudLayer {
    first: vec2<u32>,      // first node along x and y
    row: u32,              // nodes before the layer
    along_x: SplineWeights,
    along_y: SplineWeights,
    share: f32,            // weight of the layer, times the charge
}

// The first node under a spline along an axis.
fn first_node(cell: u32, count: u32) -> u32 { return (cell + count + 1u - ORDER / 2u) % count; }
fn node_after(first: u32, index: u32, count: u32) -> u32 {
    let node = first + index;
    return select(node, node - count, node >= count);
}

fn cloud_layer(index: u32, slot: u32) -> CloudLayer {
    let word = charged[index / ORDER];
    let layer = index % ORDER;
    let position = particle_at(slot).position;
    let x = mesh_place(position.x, CHARGE_NODES_X);
    let y = mesh_place(position.y, CHARGE_NODES_Y);
    let z = mesh_place(position.z, CHARGE_NODES_Z);
    let along_z = weights_along(z.offset);
    let node_z = node_after(first_node(z.cell, CHARGE_NODES_Z), layer, CHARGE_NODES_Z);
    return CloudLayer(
        vec2<u32>(first_node(x.cell, CHARGE_NODES_X), first_node(y.cell, CHARGE_NODES_Y)),
        node_z * CHARGE_NODES_Y,
        weights_along(x.offset),
        weights_along(y.offset),
        along_z.values[layer] * (bitcast<f32>(word.y) * CHARGE_UNIT),
    );
}
// The charge that a layer brings to one of its nodes: products alone, which are rounded alike wherever they are computed.
fn charge_on_node(cloud: CloudLayer, i: u32, j: u32) -> f32 {
    return round(cloud.along_x.values[i] * (cloud.along_y.values[j] * cloud.share));
}
fn node_of_layer(cloud: CloudLayer, i: u32, j: u32) -> u32 {
    let row = cloud.row + node_after(cloud.first.y, j, CHARGE_NODES_Y);
    return row * CHARGE_NODES_X + node_after(cloud.first.x, i, CHARGE_NODES_X);
}

// Spreads charges over the nodes of the mesh. One invocation a layer of a cloud; reads `charged`, `slots` and particles, adds to
// `node_charges`.
@compute @workgroup_size(WORKGROUP)
fn spread_charges(@builtin(workgroup_id) workgroup: vec3<u32>, @builtin(local_invocation_index) lane: u32) {
    let index = linear_workgroup(workgroup) * WORKGROUP + lane;
    if (index < 3u) { charge_impulses[index] = 0; }
    if (index >= CHARGED * ORDER) { return; }
    let slot = slots[charged[index / ORDER].x];
    // Whoever of several ranks owns a particle spreads its charge.
    if (!is_known(slot) || !is_own(particle_at(slot).position)) { return; }
    let cloud = cloud_layer(index, slot);
    for (var j = 0u; j < ORDER; j++) {
        for (var i = 0u; i < ORDER; i++) {
            atomicAdd(&node_charges[node_of_layer(cloud, i, j)], i32(charge_on_node(cloud, i, j)));
        }
    }
}

// The weights of a difference of the potential of one, two and three nodes either side.
override DIFFERENCE_ONE: i32;
override DIFFERENCE_TWO: i32;
override DIFFERENCE_THREE: i32;

fn potential_of_node(x: u32, y: u32, z: u32) -> i32 {
    return node_potentials[(z * CHARGE_NODES_Y + y) * CHARGE_NODES_X + x];
}
// The node so many after one; `before` counts nodes back, as many ahead of a whole turn.
fn node_before(node: u32, index: u32, count: u32) -> u32 { return node_after(node, count - index, count); }

// Finds the differences of the potential around each node: integers, so that what charges give each other is opposite. One invocation a
// node; reads `node_potentials`, writes `node_fields`.
@compute @workgroup_size(WORKGROUP)
fn find_charge_fields(@builtin(workgroup_id) workgroup: vec3<u32>, @builtin(local_invocation_index) lane: u32) {
    let node = linear_workgroup(workgroup) * WORKGROUP + lane;
    if (node >= CHARGE_NODES_X * CHARGE_NODES_Y * CHARGE_NODES_Z) { return; }
    let x = node % CHARGE_NODES_X;
    let y = node / CHARGE_NODES_X % CHARGE_NODES_Y;
    let z = node / (CHARGE_NODES_X * CHARGE_NODES_Y);
    var weights = array<i32, 3>(DIFFERENCE_ONE, DIFFERENCE_TWO, DIFFERENCE_THREE);
    var field = vec3<i32>(0);
    for (var index = 1u; index <= ORDER / 2u; index++) {
        let along_x = potential_of_node(node_after(x, index, CHARGE_NODES_X), y, z)
            - potential_of_node(node_before(x, index, CHARGE_NODES_X), y, z);
        let along_y = potential_of_node(x, node_after(y, index, CHARGE_NODES_Y), z)
            - potential_of_node(x, node_before(y, index, CHARGE_NODES_Y), z);
        let along_z = potential_of_node(x, y, node_after(z, index, CHARGE_NODES_Z))
            - potential_of_node(x, y, node_before(z, index, CHARGE_NODES_Z));
        field += weights[index - 1u] * vec3<i32>(along_x, along_y, along_z);
    }
    node_fields[node] = vec4<i32>(field, 0);
}

// Impulse of half a step per unit of charge on a node and of a difference.
override CHARGE_IMPULSE_X: f32;
override CHARGE_IMPULSE_Y: f32;
override CHARGE_IMPULSE_Z: f32;

// Slot charges/report: what is done with the impulse of a charge beside adding it to `kicks`.
// Default: nothing. The plan chooses `observed` for reports.
fn note_charge(slot: u32, kick: Steps) {}

// Gathers the impulses on charges. One invocation a layer of a cloud; reads `charged`, `slots`, particles and `node_fields`, adds to
// `kicks` and `charge_impulses`.
@compute @workgroup_size(WORKGROUP)
fn pull_charges(@builtin(workgroup_id) workgroup: vec3<u32>, @builtin(local_invocation_index) lane: u32) {
    let index = linear_workgroup(workgroup) * WORKGROUP + lane;
    if (index >= CHARGED * ORDER) { return; }
    let slot = slots[charged[index / ORDER].x];
    if (!is_known(slot)) { return; }
    let cloud = cloud_layer(index, slot);
    var field = vec3<f32>(0.0);
    for (var j = 0u; j < ORDER; j++) {
        for (var i = 0u; i < ORDER; i++) {
            field -= charge_on_node(cloud, i, j) * vec3<f32>(node_fields[node_of_layer(cloud, i, j)].xyz);
        }
    }
    let impulse = field * vec3<f32>(CHARGE_IMPULSE_X, CHARGE_IMPULSE_Y, CHARGE_IMPULSE_Z);
    let possible = all_within(impulse, IMPULSE_LIMIT);
    raise(select(FAILURE_IMPULSE, 0u, possible));
    let kick = select(Steps(0), Steps(round(impulse)), possible);
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
