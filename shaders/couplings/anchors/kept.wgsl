// Positions when neighbours were listed, see grid/next.
fn note_anchor(slot: u32, position: vec4<u32>) { anchors[slot] = position; }
