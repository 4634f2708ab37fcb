// The search of a lane for the hits of its particle, row by row around it: up to 32 candidates of a row at a time.
struct RowSearch {
    place: vec2<u32>,   // of the row of the particle
    columns: vec2<u32>, // in which the neighbours begin: see pairs/visit
    rows: u32,          // that have been begun
    base: u32,          // where the candidates of the last row go on, and where they end
    end: u32,
    words: u32,         // of hits that have been found, with those that are empty
}

fn search_around(row: u32, me: Particle) -> RowSearch {
    begin_visit(row, me);
    prepare_row_hits(row, me);
    return RowSearch(place_of_row(row), columns_of(me), 0u, 0u, 0u, 0u);
}
// Goes on with the next row.
fn begin_row(search: ptr<function, RowSearch>, row: u32) {
    let other_row = row_near((*search).place, (*search).rows);
    let start = other_row * row_width() + column_towards(row, other_row, (*search).columns);
    (*search).base = cell_at(start);
    (*search).end = cell_at(start + 2u * frame() + 1u);
    (*search).rows += 1u;
}
// The hits among the next candidates of the row that was begun, of which there are some.
fn next_hits(search: ptr<function, RowSearch>, row: u32, index: u32) -> u32 {
    let base = (*search).base;
    let mask = hits_of_row(row, index, (*search).words, base, min(32u, (*search).end - base));
    (*search).words += 1u;
    (*search).base += 32u;
    return mask;
}

// Slot pairs/hits: see pairs/hits. Default: the prefilter, candidate by candidate.
fn prepare_row_hits(row: u32, me: Particle) {
    hits_middle = row_middle(row);
    hits_probe = probe_of(fraction_of(me.position), hits_middle);
}
fn hits_of_row(row: u32, index: u32, word: u32, base: u32, count: u32) -> u32 {
    var mask = 0u;
    // From the last to the first, which is the lowest bit.
    for (var left = count; left > 0u; left--) {
        mask = (mask << 1u) | hit_of(hits_probe, candidate_probe(base + left - 1u, hits_middle));
    }
    let own = index - base;
    mask &= ~select(0u, 1u << (own & 31u), own < 32u);
    keep_mask(row, index, word, mask);
    return mask;
}
