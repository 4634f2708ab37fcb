// Finitely extensible bonds, doi:10.1063/1.458541; where nothing limits the extension they are harmonic.

// -ln(1 - x)/x, without cancellation where x is small.
fn logarithmic_growth(x: f32) -> f32 {
    let series = 1.0 + x * (1.0 / 2.0 + x * (1.0 / 3.0 + x * (1.0 / 4.0 + x * (1.0 / 5.0))));
    return select(-log(1.0 - x) / x, series, x < 0.03);
}
fn stretch_of(kind: BondKind, distance: f32) -> Stretch {
    let extension = distance - kind.length;
    let part = extension * kind.inverse_extent;
    let possible = part * part < 1.0;
    // An impossible bond ends the run; until then its values remain numbers.
    let square = select(0.0, part * part, possible);
    let pull = kind.stiffness * extension;
    let rest = 1.0 / (1.0 - square);
    return Stretch(-pull * rest, 0.5 * pull * extension * logarithmic_growth(square),
        kind.stiffness * (1.0 + square) * rest * rest, possible);
}
