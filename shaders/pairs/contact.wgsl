// The geometry of a pair. Every term is odd or even under exchange of its particles, so both ends find the same bits
// however a compiler contracts; so must every law that both ends compute: the rule is in pairs/friction.wgsl.
override CUTOFF: f32;

struct Contact {
    direction: Vector, // from the other particle to this one; zero if they coincide
    distance: f32,
    w: f32,            // 1 - r/rc
    inside: bool,      // closer than the cutoff
}

// Slot pairs/apart: from the nearest copy of the other particle to this one, in 2^-32 of the box, and how far the last
// step has moved the copy without its particle: odd under exchange. The plan chooses `sheared` if the scene has shear.
// Default: round the periodic box.
fn way_between(position: vec4<u32>, other: vec4<u32>) -> Steps {
    return signed(fraction_of(position) - fraction_of(other));
}
fn copy_drift(position: vec4<u32>, other: vec4<u32>) -> Steps { return Steps(0); }

// The ids of the pair whose separation was taken last: local densities are found by them, and compilers remove them
// where nothing is.
var<private> pair_ids: vec2<u32>;

// The same as a length.
fn separation(position: vec4<u32>, other: vec4<u32>) -> Vector {
    pair_ids = vec2<u32>(position.w, other.w);
    return Vector(way_between(position, other)) * unit_lengths();
}
fn contact_of(d: Vector) -> Contact {
    let square = dot(d, d);
    let inverse = inverseSqrt(max(square, 1e-30));
    let distance = square * inverse;
    return Contact(d * inverse, distance, 1.0 - distance * (1.0 / CUTOFF), square < CUTOFF * CUTOFF);
}
