// Particles around the one whose cell is made, and where they are from there.
//
// Lengths are in units of the mean distance of particles, so that single precision is enough for any box.
override SPACING: f32;

struct Site {
    word: u32,         // slot and image, as `face.wgsl` packs them
    steps: Steps,      // shortest separation, from the site to the particle of the cell
    away: Vector,      // displacement to the site in units of 2^-32 of the box, with the image's boxes
}

var<private> home: Fraction;

fn scale() -> Vector { return unit_lengths() / SPACING; }

fn site_with(word: u32, steps: Steps) -> Site {
    return Site(word, steps, 4294967296.0 * Vector(image_of(word)) - Vector(steps));
}
fn site_of(word: u32) -> Site { return site_with(word, signed(home - place_of(neighbour_of(word)))); }

// From one site to another, to full relative precision however close they are: low words of integers, and as many boxes as
// are missing.
fn between(a: Site, b: Site) -> Vector {
    let near = Vector(a.steps - b.steps);
    return near + 4294967296.0 * round((b.away - a.away - near) * (1.0 / 4294967296.0));
}
