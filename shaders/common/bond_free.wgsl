// Bonds without a potential.
struct Stretch {
    force: f32,     // impulse of half a step away from each other
    energy: f32,    // in the unit of impulse and length
    curvature: f32, // second derivative of the energy
    possible: bool, // whether the bond can be as long as this
}
fn stretch_of(kind: BondKind, distance: f32) -> Stretch { return Stretch(0.0, 0.0, 0.0, true); }
