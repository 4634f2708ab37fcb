// A report of oscillators: the products of which the means are the covariances of bath, momentum and displacement.
override BATH_MOMENTUM: f32;         // bath times momentum, over its quantum
override BATH_DISPLACEMENT: f32;     // bath times displacement, over its quantum
override MOMENTUM_DISPLACEMENT: f32; // momentum times displacement, over its quantum

fn note_bath_products(position: vec4<u32>, species: i32, bath: Vector, momentum: Vector) {
    if (position_energy(species) == 0.0) { return; }
    let displacement = separation(position, tethers[position.w]);
    total_add(SUM_BATH_MOMENTUM, sum64_of_signed(dot(bath, momentum) * BATH_MOMENTUM));
    total_add(SUM_BATH_DISPLACEMENT, sum64_of_signed(dot(bath, displacement) * BATH_DISPLACEMENT));
    total_add(SUM_MOMENTUM_DISPLACEMENT, sum64_of_signed(dot(momentum, displacement) * MOMENTUM_DISPLACEMENT));
}
