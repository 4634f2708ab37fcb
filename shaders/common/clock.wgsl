// What kernels read of the clock.
fn clock_step() -> vec2<u32> { return control.step; }
fn clock_key() -> vec2<u32> { return control.key; }
fn clock_closing() -> i32 { return control.closing; }
fn show_clock() {}
