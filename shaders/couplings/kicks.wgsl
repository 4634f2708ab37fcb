// Impulses that couplings add to particles: those of all forces, and for a report those of the conservative ones.
//
// Slot couplings/kicks: `add_kick` adds the impulse of half a step to the particle in a slot, in integer momentum units, in any
// order. Variants plane, volume; the plan follows the box.
// Default: off, for the motion at the report of a split step, whose impulses have been added already.
fn add_kick(slot: u32, kick: Steps) {}

// The impulses of half a step that couplings have added to a sorted particle, for the passes over particles;
// `take_gathered_kick` also clears them for the next step.
override GATHERS: u32; // 1 where there are listed pairs, bonds, angles, tethers, or a split step that visits pairs once

fn gathered_kick(slot: u32) -> Steps {
    if (GATHERS == 0u) { return Steps(0); }
    return steps_of(kicks[slot]);
}
fn take_gathered_kick(slot: u32) -> Steps {
    if (GATHERS == 0u) { return Steps(0); }
    let kick = steps_of(kicks[slot]);
    kicks[slot] = vec4<i32>(0);
    return kick;
}

// Two particles of a pair or a bond, and their slots.
struct Ends { slot: u32, other_slot: u32, me: Particle, other: Particle }

// The conservative part of the impulse that couplings have added to a sorted particle before a report. Where there is
// friction beside it, it is gathered by itself, see couplings/forces, and cleared.
override COUPLINGS_CONSERVE: u32; // 0 where couplings are friction alone, 1 where they have none, 2 where they have both

fn conservative_kick(slot: u32, all: Steps) -> Steps {
    if (COUPLINGS_CONSERVE == 0u) { return Steps(0); }
    if (COUPLINGS_CONSERVE == 1u) { return all; }
    let kick = steps_of(forces[slot]);
    forces[slot] = vec4<i32>(0);
    return kick;
}
