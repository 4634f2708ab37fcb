// A report of tethers: energy, curvature, force. They are tied to points fixed in space and add nothing to a pressure.
fn note_tether(slot: u32, me: Particle, length: Vector) {
    total_add(SUM_POTENTIAL_ENERGY, sum64_of_f32(energy_of_tether(length)));
    total_add(SUM_CURVATURE, sum64_of_f32(mobile_part(me) * TETHER_LAPLACIAN));
    add_force(slot, Steps(round(mobile_part(me) * impulse_of_tether(length))));
}
fn finish_tethers(group: u32, lane: u32) { total_reduce(group, lane); }
