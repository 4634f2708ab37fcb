// The limit applies to the internal energy that mass carries: the part of it that may pass.
fn part_within_energy(wanted: f32, mine: Side, theirs: Side) -> f32 {
    let donor = select(mine.temperature * mine.mass, theirs.temperature * theirs.mass, wanted > 0.0) / MOLECULAR_MASS;
    let most = EXCHANGE_LIMIT * max(donor, 0.0);
    return select(1.0, most / abs(wanted), abs(wanted) > most);
}
