// All particles have the same mass: the difference of two momenta is exact in integers.
fn relative_motion(me: Particle, other: Particle, mine: Steps, theirs: Steps) -> Vector {
    return Vector(mine - theirs);
}
