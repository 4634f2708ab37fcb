// The prefilter in two dimensions: it finds, without ever missing a neighbour, pairs that may be within the cutoff.
// Each axis keeps its leading bits inside a window of a few cells, 16 in a word; distances are in the quantised units of the x
// axis.
override WINDOW_X: u32;  // the window is the box divided by 2^WINDOW
override WINDOW_Y: u32;
override PROBE_Y: f32;   // length of a window unit of y over one of x; 0 where the axis is a single cell
override PROBE_REACH: f32; // square of the cutoff plus half a quantum's diagonal, in units of x

alias Middle = u32;
struct Probe { x: u32, y: f32 }

fn probe_word(fraction: Fraction) -> u32 {
    return (((fraction.x << WINDOW_X) >> 16u) << 16u) | ((fraction.y << WINDOW_Y) >> 16u);
}
// The middle of a row, from which y is counted so that it needs no wrapping.
fn row_middle(row: u32) -> u32 {
    return u32((f32(row) + 0.5) * (4294967296.0 / f32(CELLS_Y))) << WINDOW_Y;
}
fn probe_of(fraction: Fraction, middle: u32) -> Probe {
    return Probe((fraction.x << WINDOW_X) - (1u << 15u),
        PROBE_Y * f32(bitcast<i32>((fraction.y << WINDOW_Y) - (1u << 15u) - middle)));
}
fn candidate_of(fraction: Fraction, middle: u32) -> Probe { return probe_of(fraction, middle); }
fn probe_of_word(word: u32, middle: u32) -> Probe {
    return Probe(word & 0xffff0000u, PROBE_Y * f32(bitcast<i32>((word << 16u) - middle)));
}
fn probe_hits(a: Probe, b: Probe) -> bool {
    let x = f32(bitcast<i32>(a.x - b.x));
    let y = a.y - b.y;
    return x * x + y * y < PROBE_REACH;
}

// The probe of another lane of a subgroup.
fn shuffled(probe: Probe, lane: u32) -> Probe {
    return Probe(subgroupShuffle(probe.x, lane), subgroupShuffle(probe.y, lane));
}
