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
