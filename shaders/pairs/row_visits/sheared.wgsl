// Across a boundary that shears, the neighbouring cells are those of the place to which the shift takes the particle.
fn visit_particle_of_row(row: u32, index: u32) {
    let me = particle_at(index);
    approach_faces(row);
    prepare_row_hits(row, me);
    visited_place = fraction_of(me.position);
    var displaced = visited_place;
    displaced.x -= face_shift;
    let columns = vec2<u32>(column_of(visited_place), column_of(displaced));
    var sums = pass_begin(me);
    var masks: array<u32, WORDS>;
    var bases: array<u32, WORDS>;
    var word_number = 0u;
    var neighbour = 0u;
    var base = 0u;
    var end = 0u;
    loop {
        var filled = 0u;
        while (filled < WORDS) {
            if (base >= end) {
                if (neighbour == neighbour_rows()) { break; }
                let other_row = neighbour_row(row, neighbour);
                let start = other_row * row_width() + select(columns.x, columns.y, is_across(row, other_row));
                base = cell_at(start);
                end = cell_at(start + 2u * frame() + 1u);
                neighbour += 1u;
                continue;
            }
            let mask = hits_of_row(row, index, word_number, base, min(32u, end - base));
            word_number += 1u;
            masks[filled] = mask;
            bases[filled] = base;
            filled += select(0u, 1u, mask != 0u);
            base += 32u;
        }
        var word = 0u;
        var mask = masks[0];
        var word_base = bases[0];
        while (word < filled) {
            pass_pair(&sums, me, word_base + firstTrailingBit(mask));
            mask &= mask - 1u;
            if (mask == 0u) {
                word += 1u;
                mask = masks[word & 31u];
                word_base = bases[word & 31u];
            }
        }
        if (base >= end && neighbour == neighbour_rows()) { break; }
    }
    pass_end(row, index, me, sums);
}
