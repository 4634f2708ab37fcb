// Particles around the one whose cell is made, their displacements, and the corners and faces of the cell.
//
// Lengths are in units of the mean distance of particles, so that single precision is enough for any box.
override SPACING: f32;

struct Site {
    word: u32,         // slot and image, as `face_word` packs them
    steps: Steps,      // shortest separation, from the site to the particle of the cell
    away: Vector,      // displacement to the site in units of 2^-32 of the box, with the image's boxes
}

var<private> home: Fraction;

fn scale_of_lengths() -> Vector { return unit_lengths() / SPACING; }
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

// The blur of a corner of which nothing is known.
const UNKNOWN: f32 = 1e15;
// Further than any corner, however blurred.
const EVERYWHERE: f32 = 1e18;
// Half the distance from 1 to the next larger number.
const ROUNDING: f32 = 5.9604645e-8;

// Where the bisectors of two sites meet, and its blur. The shorter displacement and the way between the sites are the two
// best known sides of the triangle.
fn meeting(first: Site, second: Site) -> vec3<f32> {
    let a = first.away * scale_of_lengths();
    let b = second.away * scale_of_lengths();
    let swap = dot(b, b) < dot(a, a);
    let p = select(a, b, swap);
    let q = select(b, a, swap);
    let e = select(between(first, second), between(second, first), swap) * scale_of_lengths();
    let pp = dot(p, p);
    let n = pp * Vector(e.y, -e.x) - dot(e, p + q) * Vector(p.y, -p.x);
    let lengths = sqrt(pp * dot(e, e));
    let cross = p.x * e.y - p.y * e.x;
    // The second site is counter-clockwise of the first.
    let turned = select(cross, -cross, swap);
    let least = 4e-6 * lengths;
    let corner = n * (0.5 / select(max(turned, least), -max(turned, least), swap));
    let blur = (lengths / max(turned, least)) * (20.0 * sqrt(pp) + 40.0 * length(q) + 80.0 * length(corner)) * ROUNDING;
    return vec3<f32>(corner, select(blur, UNKNOWN, turned <= least));
}

// Stores a side of the polygon, from one corner to the next, as a face. Returns its part of the volume, over the square of SPACING.
fn store_face(slot: u32, number: u32, there: Site, begin: Vector, end: Vector) -> f32 {
    let away = there.away * scale_of_lengths();
    let distance = length(away);
    let normal = away / distance;
    let face_length = max(dot(end - begin, Vector(-normal.y, normal.x)), 0.0);
    let element = number * PARTICLES + slot;
    face_words[element] = there.word;
    face_lengths[element] = face_length * SPACING;
    face_offsets[element] = 0.5 * dot(end + begin, Vector(normal.y, -normal.x)) * SPACING;
    return 0.25 * face_length * distance;
}
