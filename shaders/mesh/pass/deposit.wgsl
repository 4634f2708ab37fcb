// Collects the particles of a cell and spreads their mass over the nodes under its splines.
//
// The moments Σ m xᵃ yᵇ of the cell are integer sums, so that their order does not matter; the masses of the nodes
// follow from them, and what rounding leaves over goes to one node: no mass is lost.

// The most that the integers of a cell hold.
const MOST_MASS: f32 = 2.1e9;

fn visit_cell(cell: u32) {
    if (cell == 0u) { begin_unsorted_step(); }
    var moments: Moments;
    var total = 0.0;
    let bin = opened_bin(cell);
    collect(cell, bin);
    var k = 0u;
    // Ends: k counts to bin.count. Left at its end: see pairs/clusters.
    loop {
        if (k < bin.count) {
            let particle = load_water(place_in(bin, k));
            total += f32(particle.mass);
            add_particle(&moments, particle);
        }
        k++;
        if (k >= bin.count) { break; }
    }
    moments = without_rounding(moments, i32(bin.count));
    spread_masses(cell, node_weights(moments), moments[0].x, total > MOST_MASS);
}
