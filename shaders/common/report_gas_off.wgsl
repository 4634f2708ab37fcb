// A gas at the temperature of the scene that exchanges mass has no potential.
fn observe_gas(cell: Particle, volume: f32) {}
