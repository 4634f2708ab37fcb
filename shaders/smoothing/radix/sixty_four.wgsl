// Butterflies of sixty-four legs: 8 of 8, and 8 of 8. Only for lines that one pass transforms whole: there is no
// `turned`.
const RADIX = 64u;
alias Legs = array<vec2<f32>, 64>;

// Powers of exp(-2πi/64).
const ROOT1 = vec2<f32>(0.99518472667219693, -0.09801714032956060);
const ROOT2 = vec2<f32>(0.98078528040323043, -0.19509032201612825);
const ROOT3 = vec2<f32>(0.95694033573220882, -0.29028467725446233);
const ROOT4 = vec2<f32>(0.92387953251128674, -0.38268343236508978);
const ROOT5 = vec2<f32>(0.88192126434835505, -0.47139673682599764);
const ROOT6 = vec2<f32>(0.83146961230254524, -0.55557023301960218);
const ROOT7 = vec2<f32>(0.77301045336273699, -0.63439328416364549);
const ROOT9 = vec2<f32>(0.63439328416364549, -0.77301045336273699);
const ROOT10 = vec2<f32>(0.55557023301960229, -0.83146961230254524);
const ROOT12 = vec2<f32>(0.38268343236508984, -0.92387953251128674);
const ROOT14 = vec2<f32>(0.19509032201612833, -0.98078528040323043);
const ROOT15 = vec2<f32>(0.09801714032956077, -0.99518472667219682);
const ROOT18 = vec2<f32>(-0.19509032201612819, -0.98078528040323043);
const ROOT20 = vec2<f32>(-0.38268343236508973, -0.92387953251128674);
const ROOT21 = vec2<f32>(-0.47139673682599770, -0.88192126434835505);
const ROOT25 = vec2<f32>(-0.77301045336273699, -0.63439328416364549);
const ROOT28 = vec2<f32>(-0.92387953251128674, -0.38268343236508989);
const ROOT30 = vec2<f32>(-0.98078528040323043, -0.19509032201612861);
const ROOT35 = vec2<f32>(-0.95694033573220894, 0.29028467725446211);
const ROOT36 = vec2<f32>(-0.92387953251128685, 0.38268343236508967);
const ROOT42 = vec2<f32>(-0.55557023301960218, 0.83146961230254524);
const ROOT49 = vec2<f32>(0.09801714032956009, 0.99518472667219693);

fn transformed(v: Legs) -> Legs {
    let a = fourier8(v[0], v[8], v[16], v[24], v[32], v[40], v[48], v[56]);
    let b = fourier8(v[1], v[9], v[17], v[25], v[33], v[41], v[49], v[57]);
    let c = fourier8(v[2], v[10], v[18], v[26], v[34], v[42], v[50], v[58]);
    let d = fourier8(v[3], v[11], v[19], v[27], v[35], v[43], v[51], v[59]);
    let e = fourier8(v[4], v[12], v[20], v[28], v[36], v[44], v[52], v[60]);
    let f = fourier8(v[5], v[13], v[21], v[29], v[37], v[45], v[53], v[61]);
    let g = fourier8(v[6], v[14], v[22], v[30], v[38], v[46], v[54], v[62]);
    let h = fourier8(v[7], v[15], v[23], v[31], v[39], v[47], v[55], v[63]);
    let x0 = fourier8(a[0], b[0], c[0], d[0], e[0], f[0], g[0], h[0]);
    let x1 = fourier8(a[1], times(b[1], ROOT1), times(c[1], ROOT2), times(d[1], ROOT3), times(e[1], ROOT4), times(f[1],
        ROOT5), times(g[1], ROOT6), times(h[1], ROOT7));
    let x2 = fourier8(a[2], times(b[2], ROOT2), times(c[2], ROOT4), times(d[2], ROOT6), eighth(e[2]), times(f[2],
        ROOT10), times(g[2], ROOT12), times(h[2], ROOT14));
    let x3 = fourier8(a[3], times(b[3], ROOT3), times(c[3], ROOT6), times(d[3], ROOT9), times(e[3], ROOT12), times(f[3],
        ROOT15), times(g[3], ROOT18), times(h[3], ROOT21));
    let x4 = fourier8(a[4], times(b[4], ROOT4), eighth(c[4]), times(d[4], ROOT12), quarter(e[4]), times(f[4], ROOT20),
        quarter(eighth(g[4])), times(h[4], ROOT28));
    let x5 = fourier8(a[5], times(b[5], ROOT5), times(c[5], ROOT10), times(d[5], ROOT15), times(e[5], ROOT20),
        times(f[5], ROOT25), times(g[5], ROOT30), times(h[5], ROOT35));
    let x6 = fourier8(a[6], times(b[6], ROOT6), times(c[6], ROOT12), times(d[6], ROOT18), quarter(eighth(e[6])),
        times(f[6], ROOT30), times(g[6], ROOT36), times(h[6], ROOT42));
    let x7 = fourier8(a[7], times(b[7], ROOT7), times(c[7], ROOT14), times(d[7], ROOT21), times(e[7], ROOT28),
        times(f[7], ROOT35), times(g[7], ROOT42), times(h[7], ROOT49));
    return Legs(
        x0[0], x1[0], x2[0], x3[0], x4[0], x5[0], x6[0], x7[0],
        x0[1], x1[1], x2[1], x3[1], x4[1], x5[1], x6[1], x7[1],
        x0[2], x1[2], x2[2], x3[2], x4[2], x5[2], x6[2], x7[2],
        x0[3], x1[3], x2[3], x3[3], x4[3], x5[3], x6[3], x7[3],
        x0[4], x1[4], x2[4], x3[4], x4[4], x5[4], x6[4], x7[4],
        x0[5], x1[5], x2[5], x3[5], x4[5], x5[5], x6[5], x7[5],
        x0[6], x1[6], x2[6], x3[6], x4[6], x5[6], x6[6], x7[6],
        x0[7], x1[7], x2[7], x3[7], x4[7], x5[7], x6[7], x7[7],
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
    let p16 = load_pair(butterfly, 16u);
    let p17 = load_pair(butterfly, 17u);
    let p18 = load_pair(butterfly, 18u);
    let p19 = load_pair(butterfly, 19u);
    let p20 = load_pair(butterfly, 20u);
    let p21 = load_pair(butterfly, 21u);
    let p22 = load_pair(butterfly, 22u);
    let p23 = load_pair(butterfly, 23u);
    let p24 = load_pair(butterfly, 24u);
    let p25 = load_pair(butterfly, 25u);
    let p26 = load_pair(butterfly, 26u);
    let p27 = load_pair(butterfly, 27u);
    let p28 = load_pair(butterfly, 28u);
    let p29 = load_pair(butterfly, 29u);
    let p30 = load_pair(butterfly, 30u);
    let p31 = load_pair(butterfly, 31u);
    return Legs(
        p0.xy, p1.xy, p2.xy, p3.xy, p4.xy, p5.xy, p6.xy, p7.xy,
        p8.xy, p9.xy, p10.xy, p11.xy, p12.xy, p13.xy, p14.xy, p15.xy,
        p16.xy, p17.xy, p18.xy, p19.xy, p20.xy, p21.xy, p22.xy, p23.xy,
        p24.xy, p25.xy, p26.xy, p27.xy, p28.xy, p29.xy, p30.xy, p31.xy,
        p0.zw, p1.zw, p2.zw, p3.zw, p4.zw, p5.zw, p6.zw, p7.zw,
        p8.zw, p9.zw, p10.zw, p11.zw, p12.zw, p13.zw, p14.zw, p15.zw,
        p16.zw, p17.zw, p18.zw, p19.zw, p20.zw, p21.zw, p22.zw, p23.zw,
        p24.zw, p25.zw, p26.zw, p27.zw, p28.zw, p29.zw, p30.zw, p31.zw,
    );
}
fn scattered(butterfly: Butterfly, v: Legs) {
    store_pair(butterfly, 0u, vec4<f32>(v[0], v[32]));
    store_pair(butterfly, 1u, vec4<f32>(v[1], v[33]));
    store_pair(butterfly, 2u, vec4<f32>(v[2], v[34]));
    store_pair(butterfly, 3u, vec4<f32>(v[3], v[35]));
    store_pair(butterfly, 4u, vec4<f32>(v[4], v[36]));
    store_pair(butterfly, 5u, vec4<f32>(v[5], v[37]));
    store_pair(butterfly, 6u, vec4<f32>(v[6], v[38]));
    store_pair(butterfly, 7u, vec4<f32>(v[7], v[39]));
    store_pair(butterfly, 8u, vec4<f32>(v[8], v[40]));
    store_pair(butterfly, 9u, vec4<f32>(v[9], v[41]));
    store_pair(butterfly, 10u, vec4<f32>(v[10], v[42]));
    store_pair(butterfly, 11u, vec4<f32>(v[11], v[43]));
    store_pair(butterfly, 12u, vec4<f32>(v[12], v[44]));
    store_pair(butterfly, 13u, vec4<f32>(v[13], v[45]));
    store_pair(butterfly, 14u, vec4<f32>(v[14], v[46]));
    store_pair(butterfly, 15u, vec4<f32>(v[15], v[47]));
    store_pair(butterfly, 16u, vec4<f32>(v[16], v[48]));
    store_pair(butterfly, 17u, vec4<f32>(v[17], v[49]));
    store_pair(butterfly, 18u, vec4<f32>(v[18], v[50]));
    store_pair(butterfly, 19u, vec4<f32>(v[19], v[51]));
    store_pair(butterfly, 20u, vec4<f32>(v[20], v[52]));
    store_pair(butterfly, 21u, vec4<f32>(v[21], v[53]));
    store_pair(butterfly, 22u, vec4<f32>(v[22], v[54]));
    store_pair(butterfly, 23u, vec4<f32>(v[23], v[55]));
    store_pair(butterfly, 24u, vec4<f32>(v[24], v[56]));
    store_pair(butterfly, 25u, vec4<f32>(v[25], v[57]));
    store_pair(butterfly, 26u, vec4<f32>(v[26], v[58]));
    store_pair(butterfly, 27u, vec4<f32>(v[27], v[59]));
    store_pair(butterfly, 28u, vec4<f32>(v[28], v[60]));
    store_pair(butterfly, 29u, vec4<f32>(v[29], v[61]));
    store_pair(butterfly, 30u, vec4<f32>(v[30], v[62]));
    store_pair(butterfly, 31u, vec4<f32>(v[31], v[63]));
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
        v[32].yx * symbol(butterfly, 32u),
        v[33].yx * symbol(butterfly, 33u),
        v[34].yx * symbol(butterfly, 34u),
        v[35].yx * symbol(butterfly, 35u),
        v[36].yx * symbol(butterfly, 36u),
        v[37].yx * symbol(butterfly, 37u),
        v[38].yx * symbol(butterfly, 38u),
        v[39].yx * symbol(butterfly, 39u),
        v[40].yx * symbol(butterfly, 40u),
        v[41].yx * symbol(butterfly, 41u),
        v[42].yx * symbol(butterfly, 42u),
        v[43].yx * symbol(butterfly, 43u),
        v[44].yx * symbol(butterfly, 44u),
        v[45].yx * symbol(butterfly, 45u),
        v[46].yx * symbol(butterfly, 46u),
        v[47].yx * symbol(butterfly, 47u),
        v[48].yx * symbol(butterfly, 48u),
        v[49].yx * symbol(butterfly, 49u),
        v[50].yx * symbol(butterfly, 50u),
        v[51].yx * symbol(butterfly, 51u),
        v[52].yx * symbol(butterfly, 52u),
        v[53].yx * symbol(butterfly, 53u),
        v[54].yx * symbol(butterfly, 54u),
        v[55].yx * symbol(butterfly, 55u),
        v[56].yx * symbol(butterfly, 56u),
        v[57].yx * symbol(butterfly, 57u),
        v[58].yx * symbol(butterfly, 58u),
        v[59].yx * symbol(butterfly, 59u),
        v[60].yx * symbol(butterfly, 60u),
        v[61].yx * symbol(butterfly, 61u),
        v[62].yx * symbol(butterfly, 62u),
        v[63].yx * symbol(butterfly, 63u),
    );
}
