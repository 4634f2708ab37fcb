// How often a limit has cut an exchange so far.
fn observe_run() { total_add(SUM_LIMITED_EXCHANGES, Sum64(atomicLoad(&control.limited), atomicLoad(&control.limited_high))); }
