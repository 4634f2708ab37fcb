// Momenta between the two stages of a relaxation.

// Slot pairs/staged: `stage` puts a sorted particle where the second stage reads it, at the same index. Variant apart: the plan of
// pairs chooses it where sorted particles are in textures, of which only that of the momenta is needed again.
// Default: in a buffer, whole.
fn stage(index: u32, particle: Particle) { staged[index] = particle; }
