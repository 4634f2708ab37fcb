// A convex polygon around a particle that is cut along bisectors. Side i, counter-clockwise, ends at corner i, where side
// i + 1 begins. With every corner goes its blur: the radius of the circle around it within which the true one certainly is.
var<private> sides: u32;
// Square of the distance beyond which no particle cuts the polygon: twice as far as the farthest corner; or more, for it is
// brought up to date as corners are looked at.
var<private> reach: f32;
var<private> overflown: bool;

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
    in_doubt = false;
    known_place = NOT_KNOWN;
    reach = EVERYWHERE * EVERYWHERE;
}

// The bisector that is looked at: its site, the unit vector towards it, and half the way.
var<private> site: Site;
var<private> direction: Vector;
var<private> half: f32;

fn height(index: u32) -> f32 { return dot(corner_at(index), direction) - half; }

// Corners that are looked at at once, with indices known to the compiler: nearly every polygon has no more.
const FEW: u32 = 12u;

// Takes up the bisector of a site and says whether it may cut the polygon. Brings the reach up to date, and finds the corner
// that is surest beyond, if there are few.
fn may_cut(there: Site, squared: f32) -> bool {
    site = there;
    let inverse = inverseSqrt(squared);
    direction = there.away * scale() * inverse;
    half = 0.5 * squared * inverse;
    var highest = -4.0 * UNKNOWN;
    var surest = -4.0 * UNKNOWN;
    var farthest = 0.0;
    var widest = 0.0;
    corner = 0u;
    for (var i = 0u; i < FEW; i++) {
        let exists = i < sides;
        let blur = blur_at(i);
        let over = dot(corner_at(i), direction);
        let sure = select(-4.0 * UNKNOWN, over - blur, exists);
        corner = select(corner, i, sure > surest);
        surest = max(surest, sure);
        highest = max(highest, select(-4.0 * UNKNOWN, over + blur, exists));
        farthest = max(farthest, select(0.0, dot(corner_at(i), corner_at(i)), exists));
        widest = max(widest, select(0.0, blur, exists));
    }
    let far = sqrt(farthest) + widest;
    let all = sides <= FEW;
    reach = select(reach, 4.00001 * far * far, all);
    return !all || highest > half;
}

// A search along the corners for those to cut: first for one beyond the bisector, from the surest on, then to both sides of
// it for more, among them those on it, so that no side without length is left.
const SEARCHING: u32 = 0u;
const FORWARD: u32 = 1u;
const BACKWARD: u32 = 2u;
const FOUND: u32 = 3u;
var<private> phase: u32;
var<private> corner: u32;
var<private> tried: u32;
var<private> first: u32;
var<private> last: u32;
var<private> gone: u32;
// Single precision cannot tell where the corner is; where it is, once that is known.
var<private> in_doubt: bool;
var<private> known_place: i32;
const NOT_KNOWN: i32 = 2;

// Of many corners it looks at all first, which `may_cut` has not done.
fn begin_search() {
    let many = sides > FEW;
    var surest = -4.0 * UNKNOWN;
    var highest = -4.0 * UNKNOWN;
    var farthest = 0.0;
    var widest = 0.0;
    for (var i = 0u; many && i < sides; i++) {
        let place = corner_at(i);
        let blur = blur_at(i);
        let over = dot(place, direction) - half;
        corner = select(corner, i, over - blur > surest);
        surest = max(surest, over - blur);
        highest = max(highest, over + blur);
        farthest = max(farthest, dot(place, place));
        widest = max(widest, blur);
    }
    let far = sqrt(farthest) + widest;
    reach = select(reach, 4.00001 * far * far, many);
    phase = select(SEARCHING, FOUND, many && highest <= 0.0);
    tried = 0u;
    gone = 0u;
    known_place = NOT_KNOWN;
}

// Goes on until corners are found or there are none, or one is in doubt.
fn search() {
    loop {
        if (phase == FOUND) { break; }
        let over = height(corner);
        var place = i32(sign(over));
        if (abs(over) <= blur_at(corner)) {
            in_doubt = known_place == NOT_KNOWN;
            if (in_doubt) { break; }
            place = known_place;
            known_place = NOT_KNOWN;
        }
        if (phase == SEARCHING) {
            tried += 1u;
            if (place > 0) {
                first = corner;
                last = corner;
                gone = 1u;
                phase = FORWARD;
            } else if (tried == sides) {
                phase = FOUND;
            }
            corner = after(corner);
        } else if (place >= 0) {
            gone += 1u;
            first = select(first, corner, phase == BACKWARD);
            last = select(last, corner, phase == FORWARD);
            corner = select(after(corner), before(corner), phase == BACKWARD);
            // Never in exact arithmetic: the particle is not beyond.
            if (gone == sides) { phase = FOUND; }
        } else {
            phase += 1u;
            corner = before(first);
        }
    }
}

// Settles a doubt.
fn decide() {
    known_place = in_circle(site_of(side_word(corner)), site_of(side_word(after(corner))), site);
    in_doubt = false;
}

// Cuts the corners that were found off the polygon.
fn cut() {
    if (gone == 0u || gone == sides) { return; }
    if (sides + 2u - gone > CORNERS) {
        overflown = true;
        return;
    }
    let entry = meeting(site_of(side_word(first)), site);
    let leaving = meeting(site, site_of(side_word(after(last))));
    let first_word = side_word(first);
    // What follows the cut moves up or down to leave room for two corners.
    let wrapped = last < first;
    let up = !wrapped && gone == 1u;
    let shift = select(2 - i32(gone), -i32(last) - 1, wrapped);
    let moved = select(select(sides - last - 1u, 0u, gone == 2u), first - last, wrapped);
    var origin = select(i32(last) + 1, i32(sides) - 1, up);
    let way = select(1, -1, up);
    for (var i = 0u; i < moved; i++) {
        let place = u32(origin + shift);
        let from_there = u32(origin);
        set_side(place, side_word(from_there), vec3<f32>(corner_at(from_there), blur_at(from_there)));
        origin += way;
    }
    if (wrapped) { first = first - last - 1u; }
    sides = sides + 2u - gone;
    set_side(first, first_word, entry);
    set_side(first + 1u, site.word, leaving);
}
