// Heat through a face in a step, conducted and random together: Flekkøy, Coveney and De Fabritiis (44),
// doi:10.1103/PhysRevE.62.2140.
override CONDUCTIVITY: f32; // times the time step

fn conducted_heat(facet: Facet, mine: Side, theirs: Side) -> f32 {
    let conductance = CONDUCTIVITY * facet.length / facet.distance;
    let noise = select(-1.0, 1.0, mine.id < theirs.id) * face_noise(mine.id, theirs.id, facet.image, 1u).x;
    let random = sqrt(2.0 * mine.temperature * theirs.temperature * conductance) * noise;
    let wanted = conductance * (theirs.temperature - mine.temperature) + random;
    return limited_amount(wanted, mine.temperature * mine.mass / MOLECULAR_MASS, theirs.temperature * theirs.mass / MOLECULAR_MASS);
}
