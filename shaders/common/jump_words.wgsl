// Random words of the jumps of a coloured noise: they depend on the jump's number, not on the step.
override JUMP_STREAM_X: u32; // key of the stream over all steps
override JUMP_STREAM_Y: u32;

fn words_of_jump(id: u32, jump: u32, half: u32) -> vec2<u32> {
    return pair_words(vec2<u32>(JUMP_STREAM_X, JUMP_STREAM_Y), vec2<u32>(id, 2u * jump + half));
}
// In (0, 1]: half a unit below 1 rounds to 1.
fn uniform_of_jump(word: u32) -> f32 { return centred_uniform(word) + 0.5; }
