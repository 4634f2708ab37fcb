// What a cell shows its neighbours in an iteration. Where it is are words: their bits as a real number might not survive.
struct Search { residual: Vector, place: Fraction } // the residual preconditioned

// The inverse of a cell's own 2 by 2 block of the equations, xx, xy, yy, times a vector.
fn preconditioned(inverse: vec3<f32>, v: Vector) -> Vector {
    return Vector(inverse.x * v.x + inverse.y * v.y, inverse.y * v.x + inverse.z * v.y);
}
