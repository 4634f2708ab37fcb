// First pass along rows: loads the charges of two rows of nodes, half a mesh apart, as one of complex numbers, and clears them for the next
// time that charges are spread.
// Charges beyond this are near the end of what integers hold. One that has gone so far makes potentials that are found too large.
const MOST_CHARGE: i32 = 536870912; // 2^29
const TOO_MUCH_CHARGE: f32 = 1e30;

fn load(node: u32) -> f32 {
    let charge = node_charges[node];
    node_charges[node] = 0;
    return select(f32(charge), TOO_MUCH_CHARGE, charge > MOST_CHARGE || charge < -MOST_CHARGE);
}
fn load_row_pair(line: u32, place: u32) -> vec2<f32> {
    let node = line * LENGTH + place;
    return vec2<f32>(load(node), load(node + LINES * LENGTH));
}
fn load_pair(butterfly: Butterfly, leg: u32) -> vec4<f32> {
    let first = load_row_pair(butterfly.line, source(butterfly, leg));
    return vec4<f32>(first, load_row_pair(butterfly.line, source(butterfly, leg + RADIX / 2u)));
}
