// The stress of angles at a report: of both arms from the vertex, whose traces cancel. The sum of r f over both is symmetric, because an
// angle does not change when it is turned.
fn note_angle(stiffness: f32, corner: Corner, first: Steps, last: Steps) {
    let middle = particle_at(corner.slots.y);
    let first_arm = separation(particle_at(corner.slots.x).position, middle.position);
    let last_arm = separation(particle_at(corner.slots.z).position, middle.position);
    let a = padded(first_arm);
    let b = padded(last_arm);
    let f = padded(Vector(first));
    let g = padded(Vector(last));
    // All of the angle, where a pair counts half.
    let diagonal = 2.0 * STRESS * (a * f + b * g);
    let across = STRESS * (a.xxy * f.yzz + a.yzz * f.xxy + b.xxy * g.yzz + b.yzz * g.xxy);
    add_stress(middle.position.w, CONSERVATIVE, Stress(vec3<i32>(round(diagonal)), vec3<i32>(round(across))));
}
fn finish_angles(group: u32, lane: u32) {}

fn padded(vector: Vector) -> vec3<f32> {
    let words = words_of_force(vector);
    return vec3<f32>(words[0], words[1], words[2]);
}
