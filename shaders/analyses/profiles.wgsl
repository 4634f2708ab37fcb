// Sums over the particles in layers of equal width across an axis of the box, from which profiles along that axis follow.
//
// Slot analyses/layered: what is summed of a particle beside its number. Default: nothing. The plan chooses `motion` for profiles
// of the velocity and the temperature.
//
// Slot analyses/layered_stress: what `motion` adds for profiles of the stress, from the momentum of a particle in integer units and that
// over its mass. Default: nothing. The plan chooses `virials` for them.
// Slot analyses/in_layers: the particles, by id, that are summed. The plan chooses `of_species` where a scene names a species. Default: all.
override LAYERS: u32;
override LAYERED_AXIS: u32;
override LAYER_SUMS: u32;     // of a layer: the particles of each species, then what the slot sums
override LAYERED_SPECIES: u32;

// Sums of one layer after the other in `histogram`. One invocation a particle, by id.
@compute @workgroup_size(WORKGROUP)
fn sum_layers(@builtin(workgroup_id) workgroup: vec3<u32>, @builtin(local_invocation_index) lane: u32) {
    let id = linear_workgroup(workgroup) * WORKGROUP + lane;
    if (!is_in_layers(id)) { return; }
    let particle = stored_particle(id);
    let first = layer_of(particle.position[LAYERED_AXIS]) * LAYER_SUMS;
    add_global(first + min(u32(species_in(particle.momentum)), LAYERED_SPECIES - 1u), Sum64(1u, 0u));
    add_layered(first + LAYERED_SPECIES, id, particle);
}

// Slot analyses/layers: the layer of a particle. The plan chooses `between_walls` for an axis with walls.
// Default: the integer part of LAYERS times the fraction of the box, exactly; LAYERS is at most 2^16.
fn layer_of(fraction: u32) -> u32 {
    return ((fraction >> 16u) * LAYERS + (((fraction & 0xffffu) * LAYERS) >> 16u)) >> 16u;
}

fn is_in_layers(id: u32) -> bool { return id < PARTICLES; }
fn add_layered(entry: u32, id: u32, particle: Particle) {}
fn add_layered_stress(entry: u32, id: u32, p: vec3<f32>, v: vec3<f32>) {}
