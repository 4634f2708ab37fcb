// The impulses of what acts on a particle by itself, in the half steps around this step and in integer momentum units.
struct OwnImpulses {
    both: Steps,    // of either half step
    closing: Steps, // beyond it, of the half step that ends at this step
    opening: Steps, // beyond it, of the half step that begins here
}

// Forces on a particle by itself: baths on coordinates and a random force. `advance_own` takes them to this step;
// `observe_own` finds their impulses for a report, and leaves them as they are; `observe_own_products` gets the momentum
// that follows. In a first pass of a split step `leave_opening` leaves the impulses of the half step that begins here,
// and those of both, in `kicks`, `finish_own` ends the pass, and a report observes what the pass has made of the baths
// by `observe_advanced_own`.
override OWN_ACTS: u32; // 0 where nothing acts on single particles but body forces
var<private> observed_bath: Vector; // of the particle that is reported

fn advance_own(me: Particle) -> OwnImpulses {
    if (OWN_ACTS == 0u) { return OwnImpulses(Steps(0), Steps(0), Steps(0)); }
    prepare_position_noise();
    let id = me.position.w;
    let noise = advance_hold(id);
    let bath = position_bath(me, species_of(me));
    keep_position_bath(id, bath);
    return OwnImpulses(own_impulse(bath), held_kick(me, noise.closing), held_kick(me, noise.opening));
}
fn observe_own(me: Particle) -> OwnImpulses {
    if (OWN_ACTS == 0u) { return OwnImpulses(Steps(0), Steps(0), Steps(0)); }
    prepare_position_noise();
    let species = species_of(me);
    observed_bath = position_bath(me, species);
    note_position_bath(species, observed_bath);
    return OwnImpulses(own_impulse(observed_bath), held_kick(me, closing_of_hold(me.position.w)), Steps(0));
}
fn own_impulse(bath: Vector) -> Steps {
    let impulse = position_impulse(bath);
    failures_of_particles |= select(FAILURE_IMPULSE, 0u, all_within(impulse, IMPULSE_LIMIT));
    return Steps(round(impulse));
}
fn observe_own_products(me: Particle, momentum: Steps) {
    if (OSCILLATES == 0u) { return; }
    note_bath_products(me.position, species_of(me), observed_bath, Vector(momentum));
}
// A report takes what is in `kicks` twice for the impulse of a whole step: it lacks what the closing half step has
// beyond the opening one.
fn leave_opening(slot: u32, me: Particle, own: OwnImpulses) {
    if (OWN_ACTS == 0u) { return; }
    kicks[slot] = momentum_word(steps_of(kicks[slot]) + own.both + own.opening, 0);
    begin_force();
    add_reported_force(momentum_word(clock_closing() * (own.closing - own.opening), 0));
    store_force(me.position.w);
}
fn observe_advanced_own(me: Particle, momentum: Steps) {
    if (POSITION_BATHS != BATHS_WITH_MEMORY) { return; }
    observed_bath = kept_position_bath(me.position.w);
    note_position_bath(species_of(me), observed_bath);
    observe_own_products(me, momentum);
}
fn finish_own() {
    if (OWN_ACTS == 1u) { raise(failures_of_particles); }
}

// A bath on every coordinate, from what the last step has made of it; its law is in baths/bath. `position_impulse` is
// its impulse of half a step.
override POSITION_BATHS: u32 = 0u; // 0 where there are none, 1 without memory, 2 with it
const BATHS_WITH_MEMORY: u32 = 2u;
override POSITION_LOSS: f32;  // the part of a bath with memory that is lost in a step

fn position_bath(me: Particle, species: i32) -> Vector {
    if (POSITION_BATHS == 0u) { return Vector(0.0); }
    let response = position_response(species);
    let id = me.position.w;
    var after = Vector(0.0);
    if (POSITION_BATHS == BATHS_WITH_MEMORY) {
        let drift = Vector(last_way(me.position, me.momentum)) * unit_lengths() - flow_of_drift(me);
        let before = bath_of(position_baths[id]);
        for (var axis = 0u; axis < DIMENSION; axis++) {
            after[axis] = advanced_bath(kept_of_bath(before[axis], POSITION_LOSS), response, drift[axis],
                position_noise(id, species, axis));
        }
        // At step 0 the bath keeps its initial value.
        return select(before, after, clock_closing() == 1);
    }
    // The friction is of the last drift, also where a wall has reflected it: of the velocity that the particle has now.
    let drift = drift_seen(me) - flow_of_drift(me);
    for (var axis = 0u; axis < DIMENSION; axis++) {
        after[axis] = advanced_bath(0.0, response, drift[axis], position_noise(id, species, axis));
    }
    return after;
}
fn position_impulse(bath: Vector) -> Vector {
    if (POSITION_BATHS == 0u) { return bath; }
    return impulse_per_bath(1.0) * bath;
}
fn keep_position_bath(id: u32, bath: Vector) {
    if (POSITION_BATHS == BATHS_WITH_MEMORY) { position_baths[id] = bath_word(bath); }
}
fn kept_position_bath(id: u32) -> Vector { return bath_of(position_baths[id]); }

override FRICTION_SEES: u32; // without memory: 0 the drift of the last step, 1 velocities, predicted if there are any

// The drift that friction without memory sees of a particle.
fn drift_seen(me: Particle) -> Vector {
    if (FRICTION_SEES == 1u) { return Vector(friction_momentum(me)) * drift_of(species_of(me)); }
    return Vector(drift_steps(me.momentum)) * unit_lengths();
}

// Baths on particles take for rest what is at rest in the box, or in a sheared box the linear profile of the flow where
// the particle is: its drift in a step, and its momentum. For the drift of the last step that is exact in the stress of
// a report; the flow of a part s of the drift before would make it 1 + s gamma dt / m times as large.
override SEES_FLOW: u32 = 0u; // 1 where friction is that of velocities relative to the flow

fn flow_of_drift(me: Particle) -> Vector {
    if (SEES_FLOW == 0u) { return Vector(0.0); }
    return drift_of(species_of(me)) * flow_of_particle(me);
}
fn flow_of_particle(me: Particle) -> Vector {
    var flow = Vector(0.0);
    if (SEES_FLOW == 0u) { return flow; }
    flow.x = flow_at(fraction_of(me.position), species_of(me));
    return flow;
}

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

// A report of the baths with memory: their energies and squares.
fn note_position_bath(species: i32, bath: Vector) {
    if (POSITION_BATHS != BATHS_WITH_MEMORY) { return; }
    for (var axis = 0u; axis < DIMENSION; axis++) {
        report_bath(bath[axis], 1.0, position_energy(species));
    }
}

// A report of oscillators: the products of which the means are the covariances of bath, momentum and displacement.
override OSCILLATES: u32 = 0u;       // 1 where tethers say where displacements of baths with memory begin
override BATH_MOMENTUM: f32;         // bath times momentum, over its quantum
override BATH_DISPLACEMENT: f32;     // bath times displacement, over its quantum
override MOMENTUM_DISPLACEMENT: f32; // momentum times displacement, over its quantum

fn note_bath_products(position: vec4<u32>, species: i32, bath: Vector, momentum: Vector) {
    if (position_energy(species) == 0.0) { return; }
    let displacement = separation(position, tethers[position.w]);
    total_add(SUM_BATH_MOMENTUM, sum64_of_signed(dot(bath, momentum) * BATH_MOMENTUM));
    total_add(SUM_BATH_DISPLACEMENT, sum64_of_signed(dot(bath, displacement) * BATH_DISPLACEMENT));
    total_add(SUM_MOMENTUM_DISPLACEMENT, sum64_of_signed(dot(momentum, displacement) * MOMENTUM_DISPLACEMENT));
}
