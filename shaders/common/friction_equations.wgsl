// The equations of Crank and Nicolson's friction: for the mean W of the velocities U before and after it,
// (2M + dt G) W = 2MU + J with the friction G and the random impulses J.
override VISCOSITY: f32; // times the time step
@group(0) @binding(21) var<storage, read_write> estimates: array<vec4<f32>>;       // W, residual
@group(0) @binding(22) var<storage, read_write> preconditioners: array<vec4<f32>>; // inverse of a cell's block; 2M
@group(0) @binding(23) var<storage, read_write> searches: array<Search>;

// The image of the preconditioned residual.
fn image_of_search(slot: u32, mine: Search) -> Vector {
    var image = preconditioners[slot].w * mine.residual;
    let count = face_counts[slot];
    for (var number = 0u; number < count; number++) {
        let face = number * PARTICLES + slot;
        let word = face_words[face];
        let other = neighbour_of(word);
        if (other == slot) { continue; }
        let theirs = searches[other];
        let apart = separation(mine.place, theirs.place, word);
        let square = dot(apart, apart);
        let v = mine.residual - theirs.residual;
        image += VISCOSITY * face_lengths[face] * inverseSqrt(square) * (v + dot(v, apart) / square * apart);
    }
    return image;
}
// What a cell adds to the sums of an iteration.
fn products_of(slot: u32, mine: Search, image: Vector) -> vec4<f32> {
    return vec4<f32>(dot(estimates[slot].zw, mine.residual), dot(image, mine.residual), 0.0, 0.0);
}
// A step along the direction of search, from the last one with its image, which is returned.
fn step_along(slot: u32, image: Vector, last: vec4<f32>) -> vec4<f32> {
    let search = searches[slot];
    // What is left of an earlier step need not be a number.
    let direction = vec4<f32>(search.residual, image) + select(vec4<f32>(0.0), solver.turn * last, solver.turn != 0.0);
    let length = vec4<f32>(vec2<f32>(solver.step_length), vec2<f32>(-solver.step_length));
    let estimate = estimates[slot] + length * direction;
    estimates[slot] = estimate;
    searches[slot] = Search(preconditioned(preconditioners[slot].xyz, estimate.zw), search.place);
    return direction;
}
