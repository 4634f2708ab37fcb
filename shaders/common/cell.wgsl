// A Voronoi cell as particles store it: position.z is its mass and momentum.z its total energy, both in integer units.
override MASS_UNIT: f32;
override MOMENTUM_UNIT: f32;

fn mass_of(cell: Particle) -> f32 { return f32(cell.position.z) * MASS_UNIT; }
fn velocity_of(cell: Particle) -> Vector {
    return Vector(steps_of(cell.momentum)) * MOMENTUM_UNIT / mass_of(cell);
}
