// Harmonic bonds, of any extension.
fn stretch_of(kind: BondKind, distance: f32) -> Stretch {
    let extension = distance - kind.length;
    let pull = kind.stiffness * extension;
    return Stretch(-pull, 0.5 * pull * extension, kind.stiffness, true);
}
