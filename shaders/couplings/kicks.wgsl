// Impulses that couplings add to particles: those of all forces, and for a report those of the conservative ones.
//
// Slot couplings/kicks: `add_kick` adds the impulse of half a step to the particle in a slot, in integer momentum units, in any
// order. Variants plane, volume; the plan follows the box.
// Default: off, for the motion at the report of a split step, whose impulses have been added already.
fn add_kick(slot: u32, kick: Steps) {}

// Slot couplings/gathered: the impulses of half a step that couplings have added to a sorted particle, for the passes over
// particles; `take_gathered_kick` also clears them for the next step.
// Default: off, no coupling but pairs found in cells. The plan of particles chooses `kept` if the scene has listed
// pairs, bonds, angles or tethers, or if a split step visits its pairs once.
fn gathered_kick(slot: u32) -> Steps { return Steps(0); }
fn take_gathered_kick(slot: u32) -> Steps { return Steps(0); }

// Two particles of a pair or a bond, and their slots.
struct Ends { slot: u32, other_slot: u32, me: Particle, other: Particle }

// Slot couplings/conservative: the conservative part of the impulse that couplings have added to a sorted particle
// before a report, which is cleared. The plan of particles chooses `apart` if there is friction beside it.
// Default: all of it, or nothing.
override COUPLINGS_CONSERVE: u32; // 0 where couplings are friction alone
fn conservative_kick(slot: u32, all: Steps) -> Steps {
    if (COUPLINGS_CONSERVE == 0u) { return Steps(0); }
    return all;
}

// Slot couplings/forces: adds the conservative impulse of half a step for a report. Variants plane, volume; the plan follows
// the box.
// Default: off, no coupling has friction, or no force of this scene is conservative.
fn add_force(slot: u32, force: Steps) {}
