// Tethers: a spring from every particle to where it started, V = K d^2 / 2.
override TETHER: f32;           // K: impulse of half a step per length
override TETHER_ENERGY: f32;    // K/2: energy per square of a length, over its quantum
override TETHER_LAPLACIAN: f32; // K in every dimension, over its quantum

fn impulse_of_tether(length: Vector) -> Vector { return -TETHER * length; }
fn energy_of_tether(length: Vector) -> f32 { return dot(length, length) * TETHER_ENERGY; }

// Slot bonds/tether_report: `note_tether` gets each particle with its displacement, `finish_tethers` ends the workgroup.
// Default: off, a step without a report. The plan chooses `observed` for reports.
fn note_tether(slot: u32, me: Particle, length: Vector) {}
fn finish_tethers(group: u32, lane: u32) {}
