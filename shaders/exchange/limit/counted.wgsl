// No more than a part of what a cell has may cross one face; how often that part was reached is counted.
override EXCHANGE_LIMIT: f32;
var<private> cuts: u32;

// What comes from the other cell, or goes there if negative.
fn limited_amount(wanted: f32, mine: f32, theirs: f32) -> f32 {
    let most = EXCHANGE_LIMIT * select(mine, theirs, wanted > 0.0);
    // What is not a number stays so, and the exchange reports it.
    let cut = is_number(wanted) && abs(wanted) > most;
    cuts += select(0u, 1u, cut);
    return select(wanted, select(-most, most, wanted > 0.0), cut);
}
// A loop, not a branch: see `raise`.
fn report_cuts() {
    for (var pending = cuts; pending != 0u; pending = 0u) {
        let before = atomicAdd(&control.limited, pending);
        if (before + pending < before) { atomicAdd(&control.limited_high, 1u); }
    }
}
