// The pressure when the exchange begins, for explicit steps.
fn middle_pressure(cell: Particle, pressure: f32, volume: f32, heat: f32) -> f32 { return pressure; }
