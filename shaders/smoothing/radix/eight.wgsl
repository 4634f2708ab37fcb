// Butterflies of eight legs.
const RADIX = 8u;
alias Legs = array<vec2<f32>, 8>;

// Leg by leg: naga takes an alias for a type of its own, and returning one for the other makes SPIR-V and HLSL that are not
// valid.
fn transformed(v: Legs) -> Legs {
    let t = fourier8(v[0], v[1], v[2], v[3], v[4], v[5], v[6], v[7]);
    return Legs(t[0], t[1], t[2], t[3], t[4], t[5], t[6], t[7]);
}

fn gathered(butterfly: Butterfly) -> Legs {
    let a = load_pair(butterfly, 0u);
    let b = load_pair(butterfly, 1u);
    let c = load_pair(butterfly, 2u);
    let d = load_pair(butterfly, 3u);
    return Legs(a.xy, b.xy, c.xy, d.xy, a.zw, b.zw, c.zw, d.zw);
}
fn scattered(butterfly: Butterfly, v: Legs) {
    store_pair(butterfly, 0u, vec4<f32>(v[0], v[4]));
    store_pair(butterfly, 1u, vec4<f32>(v[1], v[5]));
    store_pair(butterfly, 2u, vec4<f32>(v[2], v[6]));
    store_pair(butterfly, 3u, vec4<f32>(v[3], v[7]));
}

// Multiplies leg j by the j-th power of a root of unity.
fn turned_legs(v: Legs, step: u32) -> Legs {
    let w1 = roots[step];
    let w2 = roots[2u * step];
    let w3 = times(w2, w1);
    let w4 = roots[4u * step];
    let w5 = times(w4, w1);
    let w6 = times(w4, w2);
    let w7 = times(w4, w3);
    return Legs(
        v[0],
        times(v[1], w1),
        times(v[2], w2),
        times(v[3], w3),
        times(v[4], w4),
        times(v[5], w5),
        times(v[6], w6),
        times(v[7], w7),
    );
}

// Multiplies every leg by the smoothing of its wave, real and imaginary part exchanged for the way back.
fn weighed_legs(v: Legs, butterfly: Butterfly) -> Legs {
    return Legs(
        v[0].yx * symbol(butterfly, 0u),
        v[1].yx * symbol(butterfly, 1u),
        v[2].yx * symbol(butterfly, 2u),
        v[3].yx * symbol(butterfly, 3u),
        v[4].yx * symbol(butterfly, 4u),
        v[5].yx * symbol(butterfly, 5u),
        v[6].yx * symbol(butterfly, 6u),
        v[7].yx * symbol(butterfly, 7u),
    );
}
