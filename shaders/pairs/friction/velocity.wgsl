// Friction from the relative velocity along the line of centres, Groot and Warren, doi:10.1063/1.474784.
fn friction_impulse(c: Coefficients, contact: Contact, root: f32, me: Particle, other: Particle) -> f32 {
    let motion = relative_motion(me, other, friction_momentum(me), friction_momentum(other));
    return -c.friction * root * root * dot(contact.direction, motion);
}
