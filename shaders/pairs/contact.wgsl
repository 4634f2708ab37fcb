// The geometry of a pair. Every term is odd or even under exchange of its particles, so both ends find the same bits
// however a compiler contracts; so must every law that both ends compute: the rule is in pairs/friction/relaxation.wgsl.
override CUTOFF: f32;

struct Contact {
    direction: Vector, // from the other particle to this one; zero if they coincide
    distance: f32,
    w: f32,            // 1 - r/rc
    inside: bool,      // closer than the cutoff
}

// Slot pairs/separation: from the other particle to this one, by the shortest way: odd under exchange. The plan chooses `sheared` if the
// scene has shear, `noted` if forces depend on local densities, and `sheared_noted` if both.
// Default: round the periodic box.
fn separation(position: vec4<u32>, other: vec4<u32>) -> Vector {
    return Vector(signed(fraction_of(position) - fraction_of(other))) * unit_lengths();
}
fn contact_of(d: Vector) -> Contact {
    let square = dot(d, d);
    let inverse = inverseSqrt(max(square, 1e-30));
    let distance = square * inverse;
    return Contact(d * inverse, distance, 1.0 - distance * (1.0 / CUTOFF), square < CUTOFF * CUTOFF);
}
