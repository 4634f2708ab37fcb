// Positions when neighbours were listed, see grid/next; for what pairs remember, where each particle was stored before, and which list was
// made then.
fn note_anchor(slot: u32, position: vec4<u32>, before: u32) {
    anchors[slot] = vec4<u32>(position.xyz, before | (current_list() << 31u));
}
