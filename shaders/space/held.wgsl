// Particles that are held: fixed where they are, or frozen behind a wall and carried along with it. They keep the
// momentum that they have, which no impulse changes.
//
// Slot space/held: `held_momentum` is the momentum that a particle keeps of a new one, `held_kick` the impulse that it
// keeps of one. The others are for reports, see pairs/observation: held particles have no motion of their own and no
// part in virials, half of which belong to the other particle of a pair. The plan chooses `by_species` if masses differ
// or any species is held.
// Slot space/measured: `mobile_part` is 1 for a particle that can move and 0 for one that is held; `is_measured` says
// which particles, by id, analyses of single particles average over: held particles have no motion of their own there
// either. The plan chooses `mobile` if any species is held.
// Default: all particles can move.
fn held_momentum(me: Particle, momentum: Steps) -> Steps { return momentum; }
fn held_kick(me: Particle, kick: Steps) -> Steps { return kick; }
fn mobile_part(me: Particle) -> f32 { return 1.0; }
// The same of a bond: its table knows who can move, so that its kernels need no table of species.
fn share_of_bond(bond: Ends) -> f32 { return 1.0; }
fn kick_of_end(end: Particle, kick: Steps) -> Steps { return kick; }
fn report_motion(me: Particle, momentum: Steps, virial: Sum64) { observe_motion(species_of(me), momentum, virial); }
fn report_configuration(me: Particle, sums: PairSums, bonded: Steps) { observe_configuration(sums, bonded); }
fn reported_motion(me: Particle, momentum: Steps) -> Steps { return momentum; }
fn reported_virial(me: Particle, virial: Sum64) -> Sum64 { return virial; }
fn is_measured(id: u32) -> bool { return id < PARTICLES; }

// No impulse moves the particle.
fn is_held(me: Particle) -> bool { return yielding_of(species_of(me)) == 0.0; }
// The part of what two particles have in common that belongs to those that can move.
fn mobile_share(me: Particle, other: Particle) -> f32 { return 0.5 * (mobile_part(me) + mobile_part(other)); }
