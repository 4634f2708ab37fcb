// The clock as a texel that kernels read: step and key. Where software adapters load words lane by lane, a texel that every lane
// reads costs less than a buffer.
var clock: texture_storage_2d<rgba32uint, read_write>;

fn clock_step() -> vec2<u32> { return textureLoad(clock, vec2<u32>(0u)).xy; }
fn clock_key() -> vec2<u32> { return textureLoad(clock, vec2<u32>(0u)).zw; }
fn clock_closing() -> i32 { return closing_of(clock_step()); }
fn show_clock() { textureStore(clock, vec2<u32>(0u), vec4<u32>(control.step, control.key)); }
