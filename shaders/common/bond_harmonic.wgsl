// Harmonic bonds.
struct Stretch {
    force: f32,     // impulse of half a step away from each other
    energy: f32,    // in the unit of impulse and length
    curvature: f32, // second derivative of the energy
    possible: bool, // whether the bond can be as long as this
}
fn stretch_of(kind: BondKind, distance: f32) -> Stretch {
    let extension = distance - kind.length;
    let pull = kind.stiffness * extension;
    return Stretch(-pull, 0.5 * pull * extension, kind.stiffness, true);
}
