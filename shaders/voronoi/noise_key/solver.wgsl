// The key that the solver of friction keeps, so that the kernel needs no clock; read once an invocation.
fn prepare_noise() { noise_key = solver.key; }
