// Adds the momentum that a wall absorbs to its sums, low and high words, in any order.
fn note_reflection(axis: u32, upper: bool, momentum: Steps) {
    let word = momentum_word(momentum, 0);
    let first = 6u * wall_number(axis, upper);
    for (var k = 0u; k < 3u; k++) {
        let value = select(Sum64(0u), sum64_of_i32(word[k]), is_booked);
        let before = atomicAdd(&wall_impulses[first + 2u * k], value.x);
        let carry = select(0u, 1u, before + value.x < before);
        atomicAdd(&wall_impulses[first + 2u * k + 1u], value.y + carry);
    }
}
