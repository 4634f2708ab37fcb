fn store_momentum(id: u32, momentum: vec4<i32>) { reported_momenta[id] = momentum; }
