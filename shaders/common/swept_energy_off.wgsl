// Mass carries no energy that anybody keeps account of.
fn part_within_energy(wanted: f32, mine: Side, theirs: Side) -> f32 { return 1.0; }
