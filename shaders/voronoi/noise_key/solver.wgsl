// Read once an invocation, and from where it does not take a buffer of its own.
fn prepare_noise() { noise_key = solver.key; }
