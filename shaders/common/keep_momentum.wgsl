// What a pass leaves of a particle for the next stays where the particle is.
fn keep_momentum(index: u32, word: vec4<i32>) { sorted[index].momentum = word; }
