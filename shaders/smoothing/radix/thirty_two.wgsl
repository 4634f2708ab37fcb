// Butterflies of thirty-two legs: 8 of 4, and 4 of 8.
const RADIX = 32u;
alias Legs = array<vec2<f32>, 32>;

// Powers of exp(-2πi/32).
const ROOT1 = vec2<f32>(0.98078528040323043, -0.19509032201612825);
const ROOT2 = vec2<f32>(0.92387953251128674, -0.38268343236508978);
const ROOT3 = vec2<f32>(0.83146961230254524, -0.55557023301960218);
const ROOT5 = vec2<f32>(0.55557023301960229, -0.83146961230254524);
const ROOT6 = vec2<f32>(0.38268343236508984, -0.92387953251128674);
const ROOT7 = vec2<f32>(0.19509032201612833, -0.98078528040323043);
const ROOT9 = vec2<f32>(-0.19509032201612819, -0.98078528040323043);
const ROOT10 = vec2<f32>(-0.38268343236508973, -0.92387953251128674);
const ROOT14 = vec2<f32>(-0.92387953251128674, -0.38268343236508989);
const ROOT15 = vec2<f32>(-0.98078528040323043, -0.19509032201612861);
const ROOT18 = vec2<f32>(-0.92387953251128685, 0.38268343236508967);
const ROOT21 = vec2<f32>(-0.55557023301960218, 0.83146961230254524);

fn transformed(v: Legs) -> Legs {
    let a = fourier4(v[0], v[8], v[16], v[24]);
    let b = fourier4(v[1], v[9], v[17], v[25]);
    let c = fourier4(v[2], v[10], v[18], v[26]);
    let d = fourier4(v[3], v[11], v[19], v[27]);
    let e = fourier4(v[4], v[12], v[20], v[28]);
    let f = fourier4(v[5], v[13], v[21], v[29]);
    let g = fourier4(v[6], v[14], v[22], v[30]);
    let h = fourier4(v[7], v[15], v[23], v[31]);
    let x0 = fourier8(a[0], b[0], c[0], d[0], e[0], f[0], g[0], h[0]);
    let x1 = fourier8(a[1], times(b[1], ROOT1), times(c[1], ROOT2), times(d[1], ROOT3), eighth(e[1]), times(f[1],
        ROOT5), times(g[1], ROOT6), times(h[1], ROOT7));
    let x2 = fourier8(a[2], times(b[2], ROOT2), eighth(c[2]), times(d[2], ROOT6), quarter(e[2]), times(f[2], ROOT10),
        quarter(eighth(g[2])), times(h[2], ROOT14));
    let x3 = fourier8(a[3], times(b[3], ROOT3), times(c[3], ROOT6), times(d[3], ROOT9), quarter(eighth(e[3])),
        times(f[3], ROOT15), times(g[3], ROOT18), times(h[3], ROOT21));
    return Legs(
        x0[0], x1[0], x2[0], x3[0],
        x0[1], x1[1], x2[1], x3[1],
        x0[2], x1[2], x2[2], x3[2],
        x0[3], x1[3], x2[3], x3[3],
        x0[4], x1[4], x2[4], x3[4],
        x0[5], x1[5], x2[5], x3[5],
        x0[6], x1[6], x2[6], x3[6],
        x0[7], x1[7], x2[7], x3[7],
    );
}

fn gathered(butterfly: Butterfly) -> Legs {
    let p0 = load_pair(butterfly, 0u);
    let p1 = load_pair(butterfly, 1u);
    let p2 = load_pair(butterfly, 2u);
    let p3 = load_pair(butterfly, 3u);
    let p4 = load_pair(butterfly, 4u);
    let p5 = load_pair(butterfly, 5u);
    let p6 = load_pair(butterfly, 6u);
    let p7 = load_pair(butterfly, 7u);
    let p8 = load_pair(butterfly, 8u);
    let p9 = load_pair(butterfly, 9u);
    let p10 = load_pair(butterfly, 10u);
    let p11 = load_pair(butterfly, 11u);
    let p12 = load_pair(butterfly, 12u);
    let p13 = load_pair(butterfly, 13u);
    let p14 = load_pair(butterfly, 14u);
    let p15 = load_pair(butterfly, 15u);
    return Legs(
        p0.xy, p1.xy, p2.xy, p3.xy, p4.xy, p5.xy, p6.xy, p7.xy,
        p8.xy, p9.xy, p10.xy, p11.xy, p12.xy, p13.xy, p14.xy, p15.xy,
        p0.zw, p1.zw, p2.zw, p3.zw, p4.zw, p5.zw, p6.zw, p7.zw,
        p8.zw, p9.zw, p10.zw, p11.zw, p12.zw, p13.zw, p14.zw, p15.zw,
    );
}
fn scattered(butterfly: Butterfly, v: Legs) {
    store_pair(butterfly, 0u, vec4<f32>(v[0], v[16]));
    store_pair(butterfly, 1u, vec4<f32>(v[1], v[17]));
    store_pair(butterfly, 2u, vec4<f32>(v[2], v[18]));
    store_pair(butterfly, 3u, vec4<f32>(v[3], v[19]));
    store_pair(butterfly, 4u, vec4<f32>(v[4], v[20]));
    store_pair(butterfly, 5u, vec4<f32>(v[5], v[21]));
    store_pair(butterfly, 6u, vec4<f32>(v[6], v[22]));
    store_pair(butterfly, 7u, vec4<f32>(v[7], v[23]));
    store_pair(butterfly, 8u, vec4<f32>(v[8], v[24]));
    store_pair(butterfly, 9u, vec4<f32>(v[9], v[25]));
    store_pair(butterfly, 10u, vec4<f32>(v[10], v[26]));
    store_pair(butterfly, 11u, vec4<f32>(v[11], v[27]));
    store_pair(butterfly, 12u, vec4<f32>(v[12], v[28]));
    store_pair(butterfly, 13u, vec4<f32>(v[13], v[29]));
    store_pair(butterfly, 14u, vec4<f32>(v[14], v[30]));
    store_pair(butterfly, 15u, vec4<f32>(v[15], v[31]));
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
    let w16 = roots[16u * step];
    let w17 = times(w16, w1);
    let w18 = times(w16, w2);
    let w19 = times(w16, w3);
    let w20 = times(w16, w4);
    let w21 = times(w16, w5);
    let w22 = times(w16, w6);
    let w23 = times(w16, w7);
    let w24 = times(w16, w8);
    let w25 = times(w16, w9);
    let w26 = times(w16, w10);
    let w27 = times(w16, w11);
    let w28 = times(w16, w12);
    let w29 = times(w16, w13);
    let w30 = times(w16, w14);
    let w31 = times(w16, w15);
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
        times(v[16], w16),
        times(v[17], w17),
        times(v[18], w18),
        times(v[19], w19),
        times(v[20], w20),
        times(v[21], w21),
        times(v[22], w22),
        times(v[23], w23),
        times(v[24], w24),
        times(v[25], w25),
        times(v[26], w26),
        times(v[27], w27),
        times(v[28], w28),
        times(v[29], w29),
        times(v[30], w30),
        times(v[31], w31),
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
        v[16].yx * symbol(butterfly, 16u),
        v[17].yx * symbol(butterfly, 17u),
        v[18].yx * symbol(butterfly, 18u),
        v[19].yx * symbol(butterfly, 19u),
        v[20].yx * symbol(butterfly, 20u),
        v[21].yx * symbol(butterfly, 21u),
        v[22].yx * symbol(butterfly, 22u),
        v[23].yx * symbol(butterfly, 23u),
        v[24].yx * symbol(butterfly, 24u),
        v[25].yx * symbol(butterfly, 25u),
        v[26].yx * symbol(butterfly, 26u),
        v[27].yx * symbol(butterfly, 27u),
        v[28].yx * symbol(butterfly, 28u),
        v[29].yx * symbol(butterfly, 29u),
        v[30].yx * symbol(butterfly, 30u),
        v[31].yx * symbol(butterfly, 31u),
    );
}
