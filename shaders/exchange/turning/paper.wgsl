// As printed: faces turn at half the rate, and mass has the arithmetic mean of the densities.
const TURNING: f32 = 0.5;

fn density_between(mine: f32, theirs: f32) -> f32 { return 0.5 * (mine + theirs); }
