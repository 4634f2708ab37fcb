// Nothing is drawn in this part of the step.
fn prepare_noise() {}
