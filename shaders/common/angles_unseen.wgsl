// A step without a report.
fn note_angle(stiffness: f32, corner: Corner, first: Steps, last: Steps) {}
fn finish_angles(group: u32, lane: u32) {}
