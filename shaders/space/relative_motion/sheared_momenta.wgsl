// All particles have the same mass, and the copy of the other across a boundary that shears has a momentum of its own: exact in integers.
fn relative_motion(me: Particle, other: Particle, mine: Steps, theirs: Steps) -> Vector {
    var difference = mine - theirs;
    difference.x -= boxes_up(fraction_of(me.position), fraction_of(other.position)) * jump_of(species_of(me));
    return Vector(difference);
}
