// Butterflies of sixteen legs.
const RADIX = 16u;
alias Legs = array<vec2<f32>, 16>;

fn transformed(v: Legs) -> Legs {
    let a = fourier4(v[0], v[4], v[8], v[12]);
    let b = fourier4(v[1], v[5], v[9], v[13]);
    let c = fourier4(v[2], v[6], v[10], v[14]);
    let d = fourier4(v[3], v[7], v[11], v[15]);
    let p = fourier4(a[0], b[0], c[0], d[0]);
    let q = fourier4(a[1], times(b[1], SIXTEENTH), eighth(c[1]), times(d[1], THREE_SIXTEENTHS));
    let r = fourier4(a[2], eighth(b[2]), quarter(c[2]), quarter(eighth(d[2])));
    let s = fourier4(a[3], times(b[3], THREE_SIXTEENTHS), quarter(eighth(c[3])), -times(d[3], SIXTEENTH));
    return Legs(p[0], q[0], r[0], s[0], p[1], q[1], r[1], s[1], p[2], q[2], r[2], s[2], p[3], q[3], r[3], s[3]);
}

fn gathered(butterfly: Butterfly) -> Legs {
    let a = load_pair(butterfly, 0u);
    let b = load_pair(butterfly, 1u);
    let c = load_pair(butterfly, 2u);
    let d = load_pair(butterfly, 3u);
    let e = load_pair(butterfly, 4u);
    let f = load_pair(butterfly, 5u);
    let g = load_pair(butterfly, 6u);
    let h = load_pair(butterfly, 7u);
    return Legs(a.xy, b.xy, c.xy, d.xy, e.xy, f.xy, g.xy, h.xy, a.zw, b.zw, c.zw, d.zw, e.zw, f.zw, g.zw, h.zw);
}
fn scattered(butterfly: Butterfly, v: Legs) {
    store_pair(butterfly, 0u, vec4<f32>(v[0], v[8]));
    store_pair(butterfly, 1u, vec4<f32>(v[1], v[9]));
    store_pair(butterfly, 2u, vec4<f32>(v[2], v[10]));
    store_pair(butterfly, 3u, vec4<f32>(v[3], v[11]));
    store_pair(butterfly, 4u, vec4<f32>(v[4], v[12]));
    store_pair(butterfly, 5u, vec4<f32>(v[5], v[13]));
    store_pair(butterfly, 6u, vec4<f32>(v[6], v[14]));
    store_pair(butterfly, 7u, vec4<f32>(v[7], v[15]));
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
    let w8 = roots[8u * step];
    let w9 = times(w8, w1);
    let w10 = times(w8, w2);
    let w11 = times(w8, w3);
    let w12 = times(w8, w4);
    let w13 = times(w8, w5);
    let w14 = times(w8, w6);
    let w15 = times(w8, w7);
    return Legs(
        v[0],
        times(v[1], w1),
        times(v[2], w2),
        times(v[3], w3),
        times(v[4], w4),
        times(v[5], w5),
        times(v[6], w6),
        times(v[7], w7),
        times(v[8], w8),
        times(v[9], w9),
        times(v[10], w10),
        times(v[11], w11),
        times(v[12], w12),
        times(v[13], w13),
        times(v[14], w14),
        times(v[15], w15),
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
        v[8].yx * symbol(butterfly, 8u),
        v[9].yx * symbol(butterfly, 9u),
        v[10].yx * symbol(butterfly, 10u),
        v[11].yx * symbol(butterfly, 11u),
        v[12].yx * symbol(butterfly, 12u),
        v[13].yx * symbol(butterfly, 13u),
        v[14].yx * symbol(butterfly, 14u),
        v[15].yx * symbol(butterfly, 15u),
    );
}
