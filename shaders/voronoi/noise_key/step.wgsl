// Read once an invocation: a buffer that is also written cannot be cached by the compiler.
fn prepare_noise() { noise_key = clock_key(); }
