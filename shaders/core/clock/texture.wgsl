// What kernels read of the clock, in a texel: step and key.
var clock: texture_storage_2d<rgba32uint, read_write>;

fn clock_step() -> vec2<u32> { return textureLoad(clock, vec2<u32>(0u)).xy; }
fn clock_key() -> vec2<u32> { return textureLoad(clock, vec2<u32>(0u)).zw; }
fn clock_closing() -> i32 { return closing_of(clock_step()); }
fn show_clock() { textureStore(clock, vec2<u32>(0u), vec4<u32>(control.step, control.key)); }
