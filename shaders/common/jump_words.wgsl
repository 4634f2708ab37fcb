// Random words of the jumps of a coloured noise: they depend on the jump's number, not on the step.
override JUMP_STREAM_X: u32; // key of the stream over all steps
override JUMP_STREAM_Y: u32;

fn words_of_jump(id: u32, jump: u32, half: u32) -> vec2<u32> {
    return pair_words(vec2<u32>(JUMP_STREAM_X, JUMP_STREAM_Y), vec2<u32>(id, 2u * jump + half));
}
// In (-1/2, 1/2), from the top 24 bits.
fn centred_of(word: u32) -> f32 { return (f32(bitcast<i32>(word) >> 8u) + 0.5) * 5.9604645e-8; } // 2^-24
// In (0, 1]: half a unit below 1 rounds to 1.
fn uniform_of_jump(word: u32) -> f32 { return centred_of(word) + 0.5; }
