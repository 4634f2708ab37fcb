// A report of tethers: energy, curvature, force. They are tied to points fixed in space and add nothing to a pressure.
override TETHER_ENERGY: f32;    // energy per square of a length, over its quantum
override TETHER_LAPLACIAN: f32; // second derivative of a tether, over its quantum

fn note_tether(slot: u32, length: Vector) {
    total_add(5u, sum64_of_f32(dot(length, length) * TETHER_ENERGY));
    total_add(8u, sum64_of_f32(TETHER_LAPLACIAN));
    add_force(slot, Steps(round(-TETHER * length)));
}
fn finish_tethers(group: u32, lane: u32) { total_reduce(group, lane); }
