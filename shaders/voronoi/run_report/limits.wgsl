// How often a limit has cut an exchange so far.
fn observe_run() { total_add(9u, Sum64(atomicLoad(&control.limited), atomicLoad(&control.limited_high))); }
