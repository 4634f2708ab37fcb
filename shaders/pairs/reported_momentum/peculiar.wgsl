// The momenta relative to the linear profile of the flow, for analyses.
fn store_momentum(id: u32, momentum: vec4<i32>) {
    var word = momentum;
    word.x -= i32(round(reported_flow));
    reported_momenta[id] = word;
}
