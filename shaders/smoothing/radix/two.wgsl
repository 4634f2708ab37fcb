// Butterflies of two legs.
const RADIX = 2u;
alias Legs = array<vec2<f32>, 2>;

fn transformed(v: Legs) -> Legs { return Legs(v[0] + v[1], v[0] - v[1]); }

fn gathered(butterfly: Butterfly) -> Legs {
    let a = load_pair(butterfly, 0u);
    return Legs(a.xy, a.zw);
}
fn scattered(butterfly: Butterfly, v: Legs) {
    store_pair(butterfly, 0u, vec4<f32>(v[0], v[1]));
}

// Multiplies every leg by the smoothing of its wave, real and imaginary part exchanged for the way back.
fn weighed_legs(v: Legs, butterfly: Butterfly) -> Legs {
    return Legs(
        v[0].yx * symbol(butterfly, 0u),
        v[1].yx * symbol(butterfly, 1u),
    );
}
