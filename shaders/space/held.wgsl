// Particles that are held: fixed where they are, or frozen behind a wall and carried along with it. They keep the
// momentum that they have, which no impulse changes: see HELD of space/mass.

// No impulse moves the particle.
fn is_held(me: Particle) -> bool {
    if (HELD == 0u) { return false; }
    return yielding_of(species_of(me)) == 0.0;
}
// The momentum that a particle keeps of a new one, and the impulse that it keeps of one.
fn held_momentum(me: Particle, momentum: Steps) -> Steps {
    if (!is_held(me)) { return momentum; }
    let held = steps_of(me.momentum);
    absorb(me, momentum - held);
    return held;
}
fn held_kick(me: Particle, kick: Steps) -> Steps {
    if (is_held(me)) { return Steps(0); }
    return kick;
}
// 1 for a particle that can move and 0 for one that is held, and the part of what two particles have in common that
// belongs to those that can move.
fn mobile_part(me: Particle) -> f32 {
    if (is_held(me)) { return 0.0; }
    return 1.0;
}
fn mobile_share(me: Particle, other: Particle) -> f32 { return 0.5 * (mobile_part(me) + mobile_part(other)); }

// The same of a bond: its table knows who can move, so that its kernels need no table of species.
fn is_held_end(end: Particle) -> bool {
    if (HELD == 0u) { return false; }
    return drift_of_end(end) <= 0.0;
}
fn mobile_part_of_end(end: Particle) -> f32 {
    if (is_held_end(end)) { return 0.0; }
    return 1.0;
}
fn share_of_bond(bond: Ends) -> f32 { return 0.5 * (mobile_part_of_end(bond.me) + mobile_part_of_end(bond.other)); }
fn kick_of_end(end: Particle, kick: Steps) -> Steps {
    if (is_held_end(end)) { return Steps(0); }
    return kick;
}

// Slot analyses/measured: the particles, by id, that an analysis of single particles averages over. The plan chooses `of_species` where a
// scene names a species. Default: all that can move, for held ones have no motion of their own.
fn is_measured(id: u32) -> bool {
    if (HELD == 0u) { return id < PARTICLES; }
    return id < PARTICLES && !is_held(stored_particle(id));
}

// For reports, see pairs/observation: held particles have no motion of their own there either, and no part in virials,
// half of which belong to the other particle of a pair.
fn report_motion(me: Particle, momentum: Steps, virial: Sum64) {
    if (is_held(me)) {
        report_absorbed(me, momentum - steps_of(me.momentum));
    } else {
        observe_motion(species_of(me), momentum, virial);
    }
}
// The energies of pairs are those of both ends; forces and curvatures are those of particles that can move.
fn report_configuration(me: Particle, sums: PairSums, bonded: Steps) {
    if (is_held(me)) {
        total_add(SUM_POTENTIAL_ENERGY, sums.energy);
    } else {
        observe_configuration(sums, bonded);
    }
}
fn reported_motion(me: Particle, momentum: Steps) -> Steps {
    return select(momentum, steps_of(me.momentum), is_held(me));
}
fn reported_virial(me: Particle, virial: Sum64) -> Sum64 { return select(virial, Sum64(0u), is_held(me)); }
