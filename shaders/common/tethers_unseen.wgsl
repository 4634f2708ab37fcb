// A step without a report.
fn note_tether(slot: u32, length: Vector) {}
fn finish_tethers(group: u32, lane: u32) {}
