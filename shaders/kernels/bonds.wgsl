// Every bond hands the impulses of half a step to both of its ends: those of its potential and of its bath.
override BONDS: u32;
@group(0) @binding(33) var<storage, read_write> slots: array<u32>;

struct Ends { slot: u32, other_slot: u32, me: Particle, other: Particle }

@compute @workgroup_size(WORKGROUP)
fn main(@builtin(workgroup_id) workgroup: vec3<u32>, @builtin(local_invocation_index) lane: u32) {
    let group = linear_workgroup(workgroup);
    let bond = group * WORKGROUP + lane;
    if (bond < BONDS) { visit(bond); }
    finish_bonds(group, lane);
}

fn visit(bond: u32) {
    prepare_bonds();
    let word = bonds[FIRST_BOND + bond];
    let kind = bond_kind(word.z);
    let slot = slots[word.x];
    let other_slot = slots[word.y];
    let ends = Ends(slot, other_slot, stored_particle(slot), stored_particle(other_slot));
    let contact = contact_of(separation(ends.me.position, ends.other.position));
    let stretch = stretch_of(kind, contact.distance);
    let magnitude = stretch.force + bond_bath(bond, kind, ends.me, ends.other);
    let impulse = Steps(round(magnitude * contact.direction));
    add_kick(slot, impulse);
    add_kick(other_slot, -impulse);
    note_bond(ends, stretch, magnitude, contact);
    raise_at(select(FAILURE_BOND, 0u, stretch.possible), bond);
    raise(select(FAILURE_IMPULSE, 0u, is_within(magnitude, IMPULSE_LIMIT)));
}
