// A convex polygon around a particle that is cut along bisectors. Side i, counter-clockwise, ends at corner i, where side
// i + 1 begins.
var<private> sides: u32;
var<private> side_words: array<u32, CORNERS>;
var<private> corners: array<Vector, CORNERS>;
// Radius of the circle around a computed corner within which the true one certainly is.
var<private> blurs: array<f32, CORNERS>;
// Where the corners are at a cut: 1 beyond the bisector, 0 on it, -1 on this side.
var<private> corner_places: array<i32, CORNERS>;
// Square of the distance beyond which no particle cuts the polygon: twice as far as the farthest corner.
var<private> reach: f32;
var<private> overflown: bool;

const UNKNOWN: f32 = 1e15;
// Half the distance from 1 to the next larger number.
const ROUNDING: f32 = 5.9604645e-8;

// Where the bisectors of two sites meet, and its blur. The shorter displacement and the way between the sites are the two
// best known sides of the triangle.
fn meeting(first: Site, second: Site) -> vec3<f32> {
    let a = first.away * scale();
    let b = second.away * scale();
    let swap = dot(b, b) < dot(a, a);
    let p = select(a, b, swap);
    let q = select(b, a, swap);
    let e = select(between(first, second), between(second, first), swap) * scale();
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

fn set_side(index: u32, word: u32, corner: vec3<f32>) {
    side_words[index] = word;
    corners[index] = corner.xy;
    blurs[index] = corner.z;
}

fn after(index: u32) -> u32 { return select(index + 1u, 0u, index + 1u == sides); }
fn before(index: u32) -> u32 { return select(index, sides, index == 0u) - 1u; }

// The rectangle between a particle and its own images.
fn begin_polygon(slot: u32) {
    let half = 2147483648.0 * scale();
    let blur = 100.0 * ROUNDING * length(half);
    sides = 4u;
    set_side(0u, face_word(slot, vec2<i32>(1, 0)), vec3<f32>(half.x, half.y, blur));
    set_side(1u, face_word(slot, vec2<i32>(0, 1)), vec3<f32>(-half.x, half.y, blur));
    set_side(2u, face_word(slot, vec2<i32>(-1, 0)), vec3<f32>(-half.x, -half.y, blur));
    set_side(3u, face_word(slot, vec2<i32>(0, -1)), vec3<f32>(half.x, -half.y, blur));
    overflown = false;
    measure_reach();
}

fn measure_reach() {
    reach = 0.0;
    for (var i = 0u; i < sides; i++) {
        let far = length(corners[i]) + blurs[i];
        reach = max(reach, far * far);
    }
    reach *= 4.00001;
}

// A bisector: the unit vector towards its site, and half the way.
struct Bisector {
    direction: Vector,
    half: f32,
}

fn beyond(bisector: Bisector, index: u32) -> f32 { return dot(corners[index], bisector.direction) - bisector.half; }

// Cuts the polygon along the bisector of a site, unless no corner is beyond it. Corners on it go only with ones beyond, so
// that no side without length is left.
fn cut(site: Site, squared: f32) {
    let inverse = inverseSqrt(squared);
    let bisector = Bisector(site.away * scale() * inverse, 0.5 * squared * inverse);
    var highest = -1.0;
    for (var i = 0u; i < sides; i++) { highest = max(highest, beyond(bisector, i) + blurs[i]); }
    for (var pending = highest > 0.0; pending; pending = false) { cut_corners(site, bisector); }
}

fn cut_corners(site: Site, bisector: Bisector) {
    var found = false;
    var first = 0u;
    for (var i = 0u; i < sides; i++) {
        let far = beyond(bisector, i);
        var place = i32(sign(far));
        for (var pending = abs(far) <= blurs[i]; pending; pending = false) {
            place = in_circle(site_of(side_words[i]), site_of(side_words[after(i)]), site);
        }
        corner_places[i] = place;
        found = found || place > 0;
        first = select(first, i, place > 0);
    }
    if (!found) { return; }
    var last = first;
    var gone = 1u;
    for (; gone < sides && corner_places[after(last)] >= 0; gone++) { last = after(last); }
    for (; gone < sides && corner_places[before(first)] >= 0; gone++) { first = before(first); }
    // The particle itself is never beyond, and neither is the whole polygon.
    if (gone == sides) { return; }
    if (sides + 2u - gone > CORNERS) {
        overflown = true;
        return;
    }
    let entry = meeting(site_of(side_words[first]), site);
    let leaving = meeting(site, site_of(side_words[after(last)]));
    let first_word = side_words[first];
    // What follows the cut moves up or down to leave room for two corners.
    let wrapped = last < first;
    let up = !wrapped && gone == 1u;
    let shift = select(2 - i32(gone), -i32(last) - 1, wrapped);
    let moved = select(select(sides - last - 1u, 0u, gone == 2u), first - last, wrapped);
    var origin = select(i32(last) + 1, i32(sides) - 1, up);
    let way = select(1, -1, up);
    for (var i = 0u; i < moved; i++) {
        let place = u32(origin + shift);
        side_words[place] = side_words[origin];
        corners[place] = corners[origin];
        blurs[place] = blurs[origin];
        origin += way;
    }
    if (wrapped) { first = first - last - 1u; }
    sides = sides + 2u - gone;
    set_side(first, first_word, entry);
    set_side(first + 1u, site.word, leaving);
    measure_reach();
}
