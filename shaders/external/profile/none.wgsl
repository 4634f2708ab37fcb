// No body forces act.
fn external_kick(me: Particle) -> Steps { return Steps(0); }
