// The visit of a particle: what is noted of it, and in which cells of the rows around it its neighbours are.

// Slot pairs/visit: see above. The plan chooses `sheared` if the scene has shear.
// Default: nothing is noted, and the cells are those around that of the particle.
fn begin_visit(row: u32, me: Particle) {}
// The first columns of these cells in the particle's copy of the box, and across a boundary.
fn columns_of(me: Particle) -> vec2<u32> { return vec2<u32>(column_of(fraction_of(me.position))); }
// Which of them counts in another row.
fn column_towards(row: u32, other_row: u32, columns: vec2<u32>) -> u32 { return columns.x; }
