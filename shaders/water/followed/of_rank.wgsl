// Of several ranks: each counts the crossings of a particle from where it has arrived to where it leaves.
fn follow_leaver(id: u32, position: vec4<u32>) { follow(id, position); }
fn follow_arrival(index: u32) {
    let particle = load_water(index);
    paths[particle.id].last = vec4<u32>(particle.position, 0u, 0u);
}
