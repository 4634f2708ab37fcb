// Bonds between numbered particles: each has a potential and a bath, whose impulses are opposite at its ends.
override BONDS: u32;
override FIRST_KIND: u32;
override FIRST_BOND: u32;

// `bonds` holds a word for each species, two for each kind of bonds, then the bonds: the ids of both ends, and the kind.
struct BondKind {
    stiffness: f32,      // impulse of half a step per length
    length: f32,         // at rest
    inverse_extent: f32, // of the largest extension; zero where there is none
    remembers: bool,     // whether the bath has a memory
    loss: f32,           // the part of the bath that is lost in a step
    response: f32,       // bath per change of length
    noise: f32,          // bath per unit noise
    bath_energy: f32,    // energy per square of the bath, over its quantum
}

fn bond_kind(kind: u32) -> BondKind {
    let potential = bitcast<vec4<f32>>(bonds[FIRST_KIND + 2u * kind]);
    let bath = bitcast<vec4<f32>>(bonds[FIRST_KIND + 2u * kind + 1u]);
    return BondKind(potential.x, potential.y, potential.z, potential.w != 0.0, bath.x, bath.y, bath.z, bath.w);
}

// Displacement in a step per unit of momentum; zero for what is held.
fn drift_of_end(particle: Particle) -> f32 { return bitcast<f32>(bonds[species_of(particle)].x); }

// The drift of the last step, from which the last position follows to the bit.
fn last_drift(particle: Particle) -> Steps {
    return Steps(round(Vector(steps_of(particle.momentum)) * (drift_of_end(particle) / unit_lengths())));
}
// Slot bonds/way: the way of an end in the last step, in 2^-32 of the box, for a bath of a kind.
// Default: its drift. The plan chooses `between_walls` if walls may have reflected the drift and a bath of a bond has memory.
fn way_of_end(kind: BondKind, particle: Particle) -> Steps { return last_drift(particle); }

// The change of a bond's length over the last step: even under exchange of its ends.
fn change_of_length(kind: BondKind, me: Particle, other: Particle) -> f32 {
    let drifted = way_of_end(kind, me) - way_of_end(kind, other) - copy_drift(me.position, other.position);
    let now = way_between(me.position, other.position);
    let after = Vector(now) * unit_lengths();
    let before = Vector(now - drifted) * unit_lengths();
    let lengths = length(after) + length(before);
    // The difference of two nearly equal lengths, without cancellation.
    let change = dot(after + before, Vector(drifted) * unit_lengths());
    return select(0.0, change / lengths, lengths > 0.0);
}

// The change of length that friction without memory sees: see `drift_seen`.
fn change_seen(kind: BondKind, me: Particle, other: Particle) -> f32 {
    if (FRICTION_SEES == 0u) { return change_of_length(kind, me, other); }
    let mine = Vector(friction_momentum(me)) * drift_of_end(me);
    let theirs = Vector(friction_momentum(other)) * drift_of_end(other);
    let relative = mine - theirs - Vector(copy_drift(me.position, other.position)) * unit_lengths();
    return dot(contact_of(separation(me.position, other.position)).direction, relative);
}

// Adds the impulses of one bond.
fn visit_bond(bond: u32) {
    prepare_bonds();
    let word = bonds[FIRST_BOND + bond];
    let kind = bond_kind(word.z);
    let slot = slots[word.x];
    let other_slot = slots[word.y];
    if (!are_known(vec3<u32>(slot, other_slot, other_slot))) { return; }
    let ends = Ends(slot, other_slot, particle_at(slot), particle_at(other_slot));
    let contact = contact_of(separation(ends.me.position, ends.other.position));
    let stretch = stretch_of(kind, contact.distance);
    let magnitude = stretch.force + bond_bath(bond, kind, ends.me, ends.other);
    let impulse = Steps(round(magnitude * contact.direction));
    add_kick(slot, impulse);
    add_kick(other_slot, -impulse);
    note_bond(ends, stretch, magnitude, contact);
    raise_at(select(FAILURE_BOND, 0u, stretch.possible), bond);
    raise(select(FAILURE_IMPULSE, 0u, is_within(magnitude, IMPULSE_LIMIT)));
}

// The potential of a bond at a length, even under exchange.
override BOND_POTENTIAL: u32; // the cheapest that holds all: 0 is none, 1 harmonic, 2 limits the extension

struct Stretch {
    force: f32,     // impulse of half a step away from each other
    energy: f32,    // in the unit of impulse and length
    curvature: f32, // second derivative of the energy
    possible: bool, // whether the bond can be as long as this
}
fn stretch_of(kind: BondKind, distance: f32) -> Stretch {
    if (BOND_POTENTIAL == 0u) { return Stretch(0.0, 0.0, 0.0, true); }
    let extension = distance - kind.length;
    let pull = kind.stiffness * extension;
    // Harmonic bonds, of any extension.
    if (BOND_POTENTIAL == 1u) { return Stretch(-pull, 0.5 * pull * extension, kind.stiffness, true); }
    // Finitely extensible bonds, doi:10.1063/1.458541; where nothing limits the extension they are harmonic.
    let part = extension * kind.inverse_extent;
    let possible = part * part < 1.0;
    // An impossible bond ends the run; until then its values remain numbers.
    let square = select(0.0, part * part, possible);
    let rest = 1.0 / (1.0 - square);
    return Stretch(-pull * rest, 0.5 * pull * extension * logarithmic_growth(square),
        kind.stiffness * (1.0 + square) * rest * rest, possible);
}
// -ln(1 - x)/x, without cancellation where x is small.
fn logarithmic_growth(x: f32) -> f32 {
    let series = 1.0 + x * (1.0 / 2.0 + x * (1.0 / 3.0 + x * (1.0 / 4.0 + x * (1.0 / 5.0))));
    return select(-log(1.0 - x) / x, series, x < 0.03);
}

// Slot baths/bonds: friction and noise of a bond, an impulse of half a step away from each other, even under exchange;
// `prepare_bonds` comes first. Default: off. The plan chooses `memory` if any bath has one, else `white`;
// `relaxed` for the report of a split step.
fn prepare_bonds() {}
fn bond_bath(bond: u32, kind: BondKind, me: Particle, other: Particle) -> f32 { return 0.0; }

// Noise of the baths of bonds: a standard Gaussian number for each.
override BOND_BATHS_NOISY: u32; // 1 where any has a temperature
override BOND_STREAM_X: u32;    // key of the stream over all steps
override BOND_STREAM_Y: u32;
var<private> bond_key: vec2<u32>;

fn prepare_bond_noise() {
    if (BOND_BATHS_NOISY == 1u) { bond_key = threefry2x32(clock_step(), vec2<u32>(BOND_STREAM_X, BOND_STREAM_Y)); }
}
fn bond_noise(bond: u32) -> f32 {
    if (BOND_BATHS_NOISY == 0u) { return 0.0; }
    return gaussian_of(pair_words(bond_key, vec2<u32>(bond, 0u)));
}

// Slot baths/bond_report: what is done with the new value of a bath.
// Default: kept for the next step. The plan chooses `observed` for reports.
fn note_bond_bath(bond: u32, kind: BondKind, bath: f32) { bond_baths[bond] = select(0.0, bath, kind.remembers); }

// Slot bonds/bond_report: `note_bond` gets each bond with the impulse of potential and bath, `finish_bonds` ends the workgroup. Of several
// ranks the owner of the first end counts a bond.
// Default: off, a step without a report. Plans choose `observed` for reports; of split steps `motion` where the motion is
// measured, and `configuration` half a drift later; for an analysis of the stress `stress`.
fn note_bond(bond: Ends, stretch: Stretch, magnitude: f32, contact: Contact) {}
fn finish_bonds(group: u32, lane: u32) {}

fn note_virial_of_bond(bond: Ends, magnitude: f32, contact: Contact) {
    total_add(SUM_VIRIAL, sum64_of_f32(share_of_bond(bond) * magnitude * contact.distance * PAIR_VIRIAL));
}
// Energy, virial and curvature of the potential.
fn note_configuration_of_bond(bond: Ends, stretch: Stretch, contact: Contact) {
    total_add(SUM_POTENTIAL_ENERGY, sum64_of_f32(stretch.energy * PAIR_VIRIAL));
    let share = share_of_bond(bond);
    total_add(SUM_CONSERVATIVE_VIRIAL, sum64_of_f32(share * stretch.force * contact.distance * PAIR_VIRIAL));
    // Two particles in the same place exert no force, and have no curvature across it either.
    let across = select(0.0, f32(DIMENSION - 1u) * stretch.force / contact.distance, contact.distance > 0.0);
    total_add(SUM_CURVATURE, sum64_of_f32(share * (stretch.curvature - across) * LAPLACIAN));
}
// The conservative forces on both ends, whoever of several ranks counts the bond.
fn gather_force_of_bond(bond: Ends, stretch: Stretch, contact: Contact) {
    let force = Steps(round(stretch.force * contact.direction));
    add_force(bond.slot, kick_of_end(bond.me, force));
    add_force(bond.other_slot, kick_of_end(bond.other, -force));
}

// Adds the impulses of every bond. One invocation a bond; reads `bonds`, `slots` and particles, adds the impulses of half a
// step to `kicks` of both ends.
@compute @workgroup_size(WORKGROUP)
fn pull_bonds(@builtin(workgroup_id) workgroup: vec3<u32>, @builtin(local_invocation_index) lane: u32) {
    let group = linear_workgroup(workgroup);
    let bond = group * WORKGROUP + lane;
    if (bond < BONDS) { visit_bond(bond); }
    finish_bonds(group, lane);
}

// == bonds/stretch/limited
// A potential with a largest force, from where on the energy goes on along a line: of a bond of any length.
override LARGEST_PULL: f32; // impulse of half a step
fn stretch_of(kind: BondKind, distance: f32) -> Stretch {
    if (BOND_POTENTIAL == 0u || kind.stiffness == 0.0) { return Stretch(0.0, 0.0, 0.0, true); }
    let extension = distance - kind.length;
    // K x = F (1 - x²/R²).
    let slope = 2.0 * LARGEST_PULL * kind.inverse_extent;
    let largest = 2.0 * LARGEST_PULL / (kind.stiffness + sqrt(kind.stiffness * kind.stiffness + slope * slope));
    let limited = clamp(extension, -largest, largest);
    let part = limited * kind.inverse_extent;
    let square = part * part;
    let rest = 1.0 / (1.0 - square);
    let pull = kind.stiffness * limited;
    let energy = 0.5 * pull * limited * logarithmic_growth(square) + abs(pull * rest * (extension - limited));
    let curvature = select(0.0, kind.stiffness * (1.0 + square) * rest * rest, extension == limited);
    return Stretch(-pull * rest, energy, curvature, true);
}
