// The prefilter in three dimensions: it finds, without ever missing a neighbour, pairs that may be within the cutoff.
// Each axis keeps its leading bits inside a window of a few cells, 12 (x) or 10 in a word; distances are in the quantised units
// of the x axis.
override WINDOW_X: u32;  // the window is the box divided by 2^WINDOW
override WINDOW_Y: u32;
override WINDOW_Z: u32;
override PROBE_Y: f32;   // length of a window unit of y over one of x; 0 where the axis is a single cell
override PROBE_Z: f32;
override PROBE_REACH: f32; // square of the cutoff plus half a quantum's diagonal, in units of x

alias Middle = vec2<u32>;
struct Probe { x: u32, y: f32, z: f32 }

fn probe_word(fraction: Fraction) -> u32 {
    return (((fraction.x << WINDOW_X) >> 20u) << 20u) | (((fraction.y << WINDOW_Y) >> 22u) << 10u)
        | ((fraction.z << WINDOW_Z) >> 22u);
}
// The middle of a row, from which y and z are counted so that they need no wrapping.
fn row_middle(row: u32) -> vec2<u32> {
    let z = row / CELLS_Y;
    let y = row - z * CELLS_Y;
    return vec2<u32>(u32((f32(y) + 0.5) * (4294967296.0 / f32(CELLS_Y))) << WINDOW_Y,
        u32((f32(z) + 0.5) * (4294967296.0 / f32(CELLS_Z))) << WINDOW_Z);
}
fn probe_of(fraction: Fraction, middle: vec2<u32>) -> Probe {
    return Probe((fraction.x << WINDOW_X) - (1u << 19u),
        PROBE_Y * f32(bitcast<i32>((fraction.y << WINDOW_Y) - (1u << 21u) - middle.x)),
        PROBE_Z * f32(bitcast<i32>((fraction.z << WINDOW_Z) - (1u << 21u) - middle.y)));
}
fn candidate_of(fraction: Fraction, middle: vec2<u32>) -> Probe { return probe_of(fraction, middle); }
fn probe_of_word(word: u32, middle: vec2<u32>) -> Probe {
    return Probe(word & 0xfff00000u, PROBE_Y * f32(bitcast<i32>(((word << 12u) & 0xffc00000u) - middle.x)),
        PROBE_Z * f32(bitcast<i32>((word << 22u) - middle.y)));
}
fn probe_hits(a: Probe, b: Probe) -> bool {
    let x = f32(bitcast<i32>(a.x - b.x));
    let y = a.y - b.y;
    let z = a.z - b.z;
    return x * x + y * y + z * z < PROBE_REACH;
}

// The probe of another lane of a subgroup.
fn shuffled(probe: Probe, lane: u32) -> Probe {
    return Probe(subgroupShuffle(probe.x, lane), subgroupShuffle(probe.y, lane), subgroupShuffle(probe.z, lane));
}
