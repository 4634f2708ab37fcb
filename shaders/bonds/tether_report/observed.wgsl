// A report of tethers: energy, curvature, force. They are tied to points fixed in space and add nothing to a pressure.
fn note_tether(slot: u32, length: Vector) {
    total_add(5u, sum64_of_f32(energy_of_tether(length)));
    total_add(8u, sum64_of_f32(TETHER_LAPLACIAN));
    add_force(slot, Steps(round(impulse_of_tether(length))));
}
fn finish_tethers(group: u32, lane: u32) { total_reduce(group, lane); }
