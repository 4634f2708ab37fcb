// The part of the box that one of several ranks advances: which particles are its own, and what other ranks have to know of them.
//
// A rank stores its own particles and copies of all others within the halo around its domain, and advances both by the same kernels.
// Where a step ends, copies are forgotten: whoever owned a particle during the step sends it to all ranks that need it in the next.

// Part of a periodic box, in fractions of it; a width of zero stands for the whole axis.
struct Domain { low: vec4<u32>, width: vec4<u32> }

override PEERS: u32; // ranks with which particles are exchanged
override ROOM: u32;  // particles that one of them can be sent in a step

// The domains: that of this rank, the same with its halo, and those of its peers with their halos.
const OWN: u32 = 0u;
const NEEDED: u32 = 1u;
const OF_PEERS: u32 = 2u;
// The last one, where there are bonds: where their ends have to be known.
fn bonded_domain() -> u32 { return OF_PEERS + PEERS; }
// The number of a particle that is forgotten.
const NOBODY: u32 = 0xffffffffu;
// The mark of a particle in an inner cell.
const INNER: u32 = 2u;
// The slot of a particle that is not known.
const NOWHERE: u32 = 0xffffffffu;

fn lies_in(domain: u32, position: vec4<u32>) -> bool {
    let width = domains[domain].width;
    return all(((position - domains[domain].low) < width) | (width == vec4<u32>(0u)));
}

// Slot ranks/inner: the mark of a sorted particle that no other rank has to know of. The plan of particles
// chooses `marked` where the device goes on with these while the others are on their way.
// Default: no particle is marked as inner.
fn mark_of(row: u32, index: u32, own: bool) -> u32 { return select(0u, 1u, own); }
fn is_inner(slot: u32) -> bool { return false; }

// Ends a step or half of a drift: sends on what other ranks need, forgets what this one does not need, and empties the cells, in which
// particles are counted again once those of others have arrived. Inner particles stay as they are. One invocation a stored particle or a
// cell; reads `owned_slots` and `domains`, updates `particles`, `outgoing_counts` and `counts`, writes `outgoing`; where there are bonds, updates `slots`.
@compute @workgroup_size(WORKGROUP)
fn send_particles(@builtin(workgroup_id) workgroup: vec3<u32>, @builtin(local_invocation_index) lane: u32) {
    let slot = linear_workgroup(workgroup) * WORKGROUP + lane;
    if (slot < CELLS) { counts[slot] = 0u; }
    if (slot >= sorted_count() || is_inner(slot)) { return; }
    let particle = stored_particle(slot);
    if (owned_slots[slot] != 0u) {
        for (var peer = 0u; peer < PEERS; peer++) {
            if (lies_in(OF_PEERS + peer, particle.position)) {
                let place = atomicAdd(&outgoing_counts[peer], 1u);
                if (place < ROOM) { outgoing[peer * ROOM + place] = particle; } else { raise(FAILURE_FRAMES); }
            }
        }
        if (lies_in(NEEDED, particle.position)) { return; }
    }
    forget_slot(particle.position.w);
    var nobody = particle;
    nobody.position.w = NOBODY;
    store_particle(slot, nobody);
}

// Before the first sort no particle is known to bonds. One invocation a particle; writes `slots`.
@compute @workgroup_size(WORKGROUP)
fn forget_slots(@builtin(workgroup_id) workgroup: vec3<u32>, @builtin(local_invocation_index) lane: u32) {
    let id = linear_workgroup(workgroup) * WORKGROUP + lane;
    if (id < arrayLength(&slots)) { slots[id] = NOWHERE; }
}

// == ranks/inner/marked
// Those in inner cells are marked, and left alone where the others are sent and counted: see pairs/rows_of_part.
fn mark_of(row: u32, index: u32, own: bool) -> u32 {
    let inner = inner_of_row(row);
    return select(select(0u, 1u, own), INNER, (index >= inner.x) & (index < inner.y));
}
fn is_inner(slot: u32) -> bool { return slot < sorted_count() && owned_slots[slot] == INNER; }

// == grid/stored/of_rank
// Several ranks: the particles that are stored, without those that were removed, which get no rank in any cell.
const NO_RANK: u32 = 0xffffffffu;

fn stored_count() -> u32 { return stored_number; }
// After a sort, which leaves out those that are forgotten.
fn sorted_count() -> u32 { return atomicLoad(&outgoing_counts[PEERS]); }
fn is_own(position: vec4<u32>) -> bool { return position.w != NOBODY && lies_in(OWN, position); }
fn forgets(index: u32) -> bool {
    // What stays where it was has been counted.
    if (is_inner(index)) { return true; }
    let forgotten = stored_position(index).w == NOBODY;
    if (forgotten) { put_rank(index, NO_RANK); }
    return forgotten;
}
fn has_no_rank(rank: u32) -> bool { return rank == NO_RANK; }

// == bonds/presence/of_rank
// Of one of several ranks: what is not within its halo is nowhere. A bond with an end within the domain of bonds has to have both.
override BOND_REACH: f32; // the longest bond along which friction is passed on

fn is_known(slot: u32) -> bool { return slot != NOWHERE; }
fn are_known(slots_of_ends: vec3<u32>) -> bool {
    let known = slots_of_ends != vec3<u32>(NOWHERE);
    if (all(known)) { return true; }
    for (var end = 0u; end < 3u; end++) {
        if (known[end] && lies_in(bonded_domain(), particle_at(slots_of_ends[end]).position)) { raise(FAILURE_REACH); }
    }
    return false;
}
fn check_reach(me: vec4<u32>, other: vec4<u32>, distance: f32) {
    let relied_on = lies_in(bonded_domain(), me) || lies_in(bonded_domain(), other);
    raise(select(0u, FAILURE_REACH, relied_on && !is_within(distance, BOND_REACH)));
}

// == couplings/slots/of_rank
// Of one of several ranks: where each particle that it knows is sorted, by id; the others are nowhere.
fn note_slot(id: u32, slot: u32) { slots[id] = slot; }
fn forget_slot(id: u32) { slots[id] = NOWHERE; }

// == space/followed/of_rank
// Of several ranks: whoever owns a particle counts its crossings, and whoever knows of it notes where it was, in every step. A particle is
// known to its next owner before it becomes that one's, and the crossings that all ranks have counted are its own.
fn followed_count() -> u32 { return stored_number; }
fn follow(id: u32, position: vec4<u32>) {
    if (id == NOBODY) { return; }
    let crossed = select(vec4<i32>(0), crossings(paths[id].last, position), lies_in(OWN, position));
    paths[id] = Path(position, paths[id].images + crossed);
}
