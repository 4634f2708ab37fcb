// Particles of species that no impulse moves are held, if there are any.
fn is_still(me: Particle) -> bool {
    if (HELD == 0u) { return false; }
    return is_held(me);
}
fn held_momentum(me: Particle, momentum: Steps) -> Steps {
    if (!is_still(me)) { return momentum; }
    let held = steps_of(me.momentum);
    absorb(me, momentum - held);
    return held;
}
fn held_kick(me: Particle, kick: Steps) -> Steps { return select(kick, Steps(0), is_still(me)); }
fn share_of_bond(bond: Ends) -> f32 { return 0.5 * (mobile_part_of_end(bond.me) + mobile_part_of_end(bond.other)); }
fn mobile_part_of_end(end: Particle) -> f32 { return select(1.0, 0.0, HELD == 1u && drift_of_end(end) <= 0.0); }
fn kick_of_end(end: Particle, kick: Steps) -> Steps {
    return select(kick, Steps(0), HELD == 1u && drift_of_end(end) <= 0.0);
}

fn report_motion(me: Particle, momentum: Steps, virial: Sum64) {
    if (is_still(me)) {
        report_absorbed(me, momentum - steps_of(me.momentum));
    } else {
        observe_motion(species_of(me), momentum, virial);
    }
}
// The energies of pairs are those of both ends; forces and curvatures are those of particles that can move.
fn report_configuration(me: Particle, sums: PairSums, bonded: Steps) {
    if (is_still(me)) {
        total_add(SUM_POTENTIAL_ENERGY, sums.energy);
    } else {
        observe_configuration(sums, bonded);
    }
}
fn reported_motion(me: Particle, momentum: Steps) -> Steps {
    return select(momentum, steps_of(me.momentum), is_still(me));
}
fn reported_virial(me: Particle, virial: Sum64) -> Sum64 { return select(virial, Sum64(0u), is_still(me)); }
