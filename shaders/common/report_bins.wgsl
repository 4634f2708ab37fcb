// Reported particles are kept for the rest of the step, where the host looks for them too.
fn store_reported(index: u32, particle: Water) { store(index, particle); }
