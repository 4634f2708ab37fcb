// The impulses of what acts on a particle by itself, in the half steps around this step and in integer momentum units.
struct OwnImpulses {
    both: Steps,    // of either half step
    closing: Steps, // beyond it, of the half step that ends at this step
    opening: Steps, // beyond it, of the half step that begins here
}

// Slot couplings/own: `advance_own` takes baths and forces of a particle by itself to this step; `observe_own` finds
// their impulses for a report, and leaves them as they are; `observe_own_products` gets the momentum that follows. The
// plan chooses `acting` if kicks have baths on coordinates or a random force. In a first pass of a split step
// `leave_opening` leaves the impulses of the half step that begins here, and those of both, in `kicks`, `finish_own`
// ends the pass, and a report observes what the pass has made of the baths by `observe_advanced_own`.
// Default: off, nothing acts on single particles but body forces.
fn advance_own(me: Particle) -> OwnImpulses { return OwnImpulses(Steps(0), Steps(0), Steps(0)); }
fn observe_own(me: Particle) -> OwnImpulses { return OwnImpulses(Steps(0), Steps(0), Steps(0)); }
fn observe_own_products(me: Particle, momentum: Steps) {}
fn leave_opening(slot: u32, me: Particle, own: OwnImpulses) {}
fn observe_advanced_own(me: Particle, momentum: Steps) {}
fn finish_own() {}

// Slot baths/coloured_noise: impulses of a coloured noise over the half steps around this step, in integer momentum units.
// Default: off. The plan chooses `held` if the scene has such a noise.
struct NoiseImpulses { closing: Steps, opening: Steps }
fn advance_hold(id: u32) -> NoiseImpulses { return NoiseImpulses(Steps(0), Steps(0)); }
fn closing_of_hold(id: u32) -> Steps { return Steps(0); }

// Slot baths/positions: a bath on every coordinate, from what the last step has made of it; `position_impulse` is its
// impulse of half a step, `keep_position_bath` stores it for `kept_position_bath`. Default: off. The plan chooses
// `memory` or `white`.
fn position_bath(me: Particle, species: i32) -> Vector { return Vector(0.0); }
fn position_impulse(bath: Vector) -> Vector { return bath; }
fn keep_position_bath(id: u32, bath: Vector) {}
fn kept_position_bath(id: u32) -> Vector { return Vector(0.0); }

override FRICTION_SEES: u32; // without memory: 0 the drift of the last step, 1 velocities, predicted if there are any

// The drift that friction without memory sees of a particle.
fn drift_seen(me: Particle) -> Vector {
    if (FRICTION_SEES == 1u) { return Vector(friction_momentum(me)) * drift_of(species_of(me)); }
    return Vector(drift_steps(me.momentum)) * unit_lengths();
}

// Slot baths/flow: what baths on particles take for rest: the drift of the mean flow in a step, and its momentum. The
// plan chooses `peculiar` in a sheared box, unless friction is that of the laboratory.
// Default: what is at rest in the box.
fn flow_of_drift(me: Particle) -> Vector { return Vector(0.0); }
fn flow_of_particle(me: Particle) -> Vector { return Vector(0.0); }

// Noise of the position bath of a coordinate, in its unit: a Gaussian number for each coordinate of a particle.
override POSITION_BATHS_NOISY: u32 = 0u;   // 1 where they have a temperature
override PARTICLE_STREAM_X: u32 = 0u; // key of the stream over all steps
override PARTICLE_STREAM_Y: u32 = 0u;
var<private> position_key: vec2<u32>;

fn prepare_position_noise() {
    if (POSITION_BATHS_NOISY == 1u) {
        position_key = threefry2x32(clock_step(), vec2<u32>(PARTICLE_STREAM_X, PARTICLE_STREAM_Y));
    }
}
fn position_noise(id: u32, species: i32, axis: u32) -> f32 {
    if (POSITION_BATHS_NOISY == 0u) { return 0.0; }
    return position_deviation(species) * gaussian_of(pair_words(position_key, vec2<u32>(id, axis)));
}

// Slot baths/position_report: adds the energy of a position bath to a report.
// Default: off, such baths have none. The plan chooses `observed` if they have memory.
fn note_position_bath(species: i32, bath: Vector) {}

// Slot baths/position_products: adds the products of a position bath, a momentum and a displacement to a report.
// Default: off, nothing says what their means should be. The plan chooses `tethered` if such baths have memory and tethers say where
// displacements begin.
fn note_bath_products(position: vec4<u32>, species: i32, bath: Vector, momentum: Vector) {}
