// Of several ranks: too much on one of them is too much on all.
fn kept_mass(mass: i32, least: i32) -> u32 { return bitcast<u32>(select(mass, TOO_MUCH, least < LEAST_MASS)); }
