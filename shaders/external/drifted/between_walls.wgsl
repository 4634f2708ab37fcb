// A drift that walls may have reflected, followed back: reflection is its own inverse.
fn work_of_drift(me: Particle, kick: Steps, step: u32) -> f32 {
    let species = species_of(me);
    let back = fly_all(Flight(fraction_of(me.position), -steps_of(me.momentum), Steps(1), -1), species);
    let opening = external_kick_at(back.place, species, step - 1u);
    return dot(Vector(kick), Vector(steps_of(me.momentum))) + dot(Vector(opening), Vector(-back.momentum));
}
