// Bonds between numbered particles, after a word for each species and two for each kind of bonds.
override FIRST_KIND: u32;
override FIRST_BOND: u32;
@group(0) @binding(30) var<storage, read> bonds: array<vec4<u32>>;

struct BondKind {
    stiffness: f32,      // impulse of half a step per length
    length: f32,         // at rest
    inverse_extent: f32, // of the largest extension; zero where there is none
    remembers: bool,     // whether the bath has a memory
    loss: f32,           // what one step takes from the bath
    response: f32,       // bath per change of length
    noise: f32,          // bath per unit noise
    bath_energy: f32,    // energy per square of the bath, over its quantum
}

fn bond_kind(kind: u32) -> BondKind {
    let potential = bitcast<vec4<f32>>(bonds[FIRST_KIND + 2u * kind]);
    let bath = bitcast<vec4<f32>>(bonds[FIRST_KIND + 2u * kind + 1u]);
    return BondKind(potential.x, potential.y, potential.z, potential.w != 0.0, bath.x, bath.y, bath.z, bath.w);
}
// Displacement in a step per unit of momentum: zero of what is held.
fn drift_of_end(particle: Particle) -> f32 { return bitcast<f32>(bonds[species_of(particle)].x); }
