// From the table of species, in whole halves.
override JUMP_ENTRIES: u32; // entries before them

fn jump_of(species: i32) -> i32 {
    let entry = vec4<i32>(coefficient_entry(JUMP_ENTRIES + u32(species)));
    return entry.x * 65536 + entry.y;
}
