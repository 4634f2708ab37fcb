// Butterflies of four legs.
const RADIX = 4u;
alias Legs = array<vec2<f32>, 4>;

// Leg by leg: naga takes an alias for a type of its own, and returning one for the other makes SPIR-V and HLSL that are not
// valid.
fn transformed(v: Legs) -> Legs {
    let t = fourier4(v[0], v[1], v[2], v[3]);
    return Legs(t[0], t[1], t[2], t[3]);
}

fn gathered(butterfly: Butterfly) -> Legs {
    let a = load_pair(butterfly, 0u);
    let b = load_pair(butterfly, 1u);
    return Legs(a.xy, b.xy, a.zw, b.zw);
}
fn scattered(butterfly: Butterfly, v: Legs) {
    store_pair(butterfly, 0u, vec4<f32>(v[0], v[2]));
    store_pair(butterfly, 1u, vec4<f32>(v[1], v[3]));
}

// Multiplies every leg by the smoothing of its wave, real and imaginary part exchanged for the way back.
fn weighed_legs(v: Legs, butterfly: Butterfly) -> Legs {
    return Legs(
        v[0].yx * symbol(butterfly, 0u),
        v[1].yx * symbol(butterfly, 1u),
        v[2].yx * symbol(butterfly, 2u),
        v[3].yx * symbol(butterfly, 3u),
    );
}
