// The key of the step, read once an invocation: the compiler cannot cache a buffer that is also written.
fn prepare_noise() { noise_key = clock_key(); }
