// Steps that solve for nothing and limit nothing have nothing more to report.
fn observe_run() {}
