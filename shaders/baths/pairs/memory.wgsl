// A bath with exponential memory on every pair; its law is in baths/bath. Here c.friction is the response of the bath to the
// coupling function, and c.noise its standard deviation in equilibrium.
//
// What is kept of a pair is q = e s - c phi and the step. Beyond the cutoff phi is zero and the bath is free: when the pair
// meets again after k steps, one draw stands for all the steps between.
override LOSS: f32;         // 1 - e
override DECAY: f32;        // ln |e|
override SPREAD: f32;       // root of 1 - e^2

fn bath_of_pair(c: Coefficients, contact: Contact, me: Particle, other: Particle, place: u32) -> f32 {
    let memory = pair_memory(place);
    let missed = clock_step().x - memory.y - 1u;
    let kept = exp(DECAY * f32(missed)) * select(1.0, -1.0, (PERSISTENCE < 0.0) & ((missed & 1u) == 1u));
    let exponent = -2.0 * DECAY * (f32(missed) + 1.0);
    let lost = select(1.0 - exp(-exponent), exponent * (1.0 - exponent * (0.5 - exponent * (1.0 / 6.0))), exponent < 0.01);
    let spread = select(sqrt(lost), SPREAD, missed == 0u);
    return advanced_bath(kept * bitcast<f32>(memory.x), f32(clock_closing()) * c.friction, coupling(contact.w),
        c.noise * spread * pair_noise(me.position.w, other.position.w));
}
fn impulse_of_pair(push: f32, c: Coefficients, contact: Contact, root: f32, me: Particle, other: Particle, place: u32) -> f32 {
    let bath = bath_of_pair(c, contact, me, other, place);
    note_bath(c, contact, bath, place);
    return push + impulse_per_bath(root) * bath;
}
