// A convex polygon around a particle that is cut along bisectors. Side i, counter-clockwise, ends at corner i, where side
// i + 1 begins. Every corner has a blur: the radius of the circle around it within which the true one certainly is.
//
// Slot tessellation/corners: where the polygon of a cell is kept: word, corner and blur of each side, at most CORNERS. Variants
// private, stored; the plan chooses `stored` once a cell had too many corners. No default.
var<private> polygon_sides: u32;
// Square of the distance beyond which no particle cuts the polygon: twice as far as the farthest corner; or more, because it is
// updated as corners are examined.
var<private> polygon_reach: f32;
var<private> overflown: bool;

// The bisector that is examined: its site, the unit vector towards it, and half the way.
var<private> bisected_site: Site;
var<private> bisector_direction: Vector;
var<private> bisector_distance: f32;

// Corners that are examined at once, with indices known to the compiler: nearly every polygon has no more.
const FEW: u32 = 12u;

// A search along the corners for those to cut: first for one beyond the bisector, from the surest on, then to both sides of
// it for more, among them those on it, so that no side without length is left.
const SEARCHING: u32 = 0u;
const FORWARD: u32 = 1u;
const BACKWARD: u32 = 2u;
const FOUND: u32 = 3u;
var<private> phase: u32;
var<private> searched_corner: u32;
var<private> tried: u32;
var<private> first_beyond: u32;
var<private> last_beyond: u32;
var<private> corners_beyond: u32;
// Single precision cannot decide where the corner is; where it is, once that is known.
var<private> in_doubt: bool;
var<private> known_place: i32;
const NOT_KNOWN: i32 = 2;

fn after_corner(index: u32) -> u32 { return select(index + 1u, 0u, index + 1u == polygon_sides); }
fn before_corner(index: u32) -> u32 { return select(index, polygon_sides, index == 0u) - 1u; }

// The rectangle between a particle and its own images.
fn begin_exact_polygon(slot: u32) {
    let half_box = 2147483648.0 * scale_of_lengths();
    let blur = 100.0 * ROUNDING * length(half_box);
    polygon_sides = 4u;
    set_side(0u, face_word(slot, vec2<i32>(1, 0)), vec3<f32>(half_box.x, half_box.y, blur));
    set_side(1u, face_word(slot, vec2<i32>(0, 1)), vec3<f32>(-half_box.x, half_box.y, blur));
    set_side(2u, face_word(slot, vec2<i32>(-1, 0)), vec3<f32>(-half_box.x, -half_box.y, blur));
    set_side(3u, face_word(slot, vec2<i32>(0, -1)), vec3<f32>(half_box.x, -half_box.y, blur));
    overflown = false;
    in_doubt = false;
    known_place = NOT_KNOWN;
    polygon_reach = EVERYWHERE * EVERYWHERE;
}

// How far a corner is beyond the bisector.
fn height_above_bisector(index: u32) -> f32 { return dot(corner_at(index), bisector_direction) - bisector_distance; }

// Sets the bisector of a site and returns whether it may cut the polygon. Updates the reach, and finds the corner that is surest
// beyond, if there are few.
fn may_cut(there: Site, squared: f32) -> bool {
    bisected_site = there;
    let inverse = inverseSqrt(squared);
    bisector_direction = there.away * scale_of_lengths() * inverse;
    bisector_distance = 0.5 * squared * inverse;
    var highest = -4.0 * UNKNOWN;
    var surest = -4.0 * UNKNOWN;
    var farthest = 0.0;
    var widest = 0.0;
    searched_corner = 0u;
    for (var i = 0u; i < FEW; i++) {
        let exists = i < polygon_sides;
        let blur = blur_at(i);
        let over = dot(corner_at(i), bisector_direction);
        let sure = select(-4.0 * UNKNOWN, over - blur, exists);
        searched_corner = select(searched_corner, i, sure > surest);
        surest = max(surest, sure);
        highest = max(highest, select(-4.0 * UNKNOWN, over + blur, exists));
        farthest = max(farthest, select(0.0, dot(corner_at(i), corner_at(i)), exists));
        widest = max(widest, select(0.0, blur, exists));
    }
    let far = sqrt(farthest) + widest;
    let all = polygon_sides <= FEW;
    polygon_reach = select(polygon_reach, 4.00001 * far * far, all);
    return !all || highest > bisector_distance;
}

// Of many corners it examines all first, which `may_cut` has not done.
fn begin_search() {
    let many = polygon_sides > FEW;
    var surest = -4.0 * UNKNOWN;
    var highest = -4.0 * UNKNOWN;
    var farthest = 0.0;
    var widest = 0.0;
    for (var i = 0u; many && i < polygon_sides; i++) {
        let place = corner_at(i);
        let blur = blur_at(i);
        let over = dot(place, bisector_direction) - bisector_distance;
        searched_corner = select(searched_corner, i, over - blur > surest);
        surest = max(surest, over - blur);
        highest = max(highest, over + blur);
        farthest = max(farthest, dot(place, place));
        widest = max(widest, blur);
    }
    let far = sqrt(farthest) + widest;
    polygon_reach = select(polygon_reach, 4.00001 * far * far, many);
    phase = select(SEARCHING, FOUND, many && highest <= 0.0);
    tried = 0u;
    corners_beyond = 0u;
    known_place = NOT_KNOWN;
}

// Goes on until corners are found or there are none, or one is in doubt.
fn search_corners() {
    loop {
        if (phase == FOUND) { break; }
        let over = height_above_bisector(searched_corner);
        var place = i32(sign(over));
        if (abs(over) <= blur_at(searched_corner)) {
            in_doubt = known_place == NOT_KNOWN;
            if (in_doubt) { break; }
            place = known_place;
            known_place = NOT_KNOWN;
        }
        if (phase == SEARCHING) {
            tried += 1u;
            if (place > 0) {
                first_beyond = searched_corner;
                last_beyond = searched_corner;
                corners_beyond = 1u;
                phase = FORWARD;
            } else if (tried == polygon_sides) {
                phase = FOUND;
            }
            searched_corner = after_corner(searched_corner);
        } else if (place >= 0) {
            corners_beyond += 1u;
            first_beyond = select(first_beyond, searched_corner, phase == BACKWARD);
            last_beyond = select(last_beyond, searched_corner, phase == FORWARD);
            searched_corner = select(after_corner(searched_corner), before_corner(searched_corner), phase == BACKWARD);
            // Never in exact arithmetic: the particle is not beyond.
            if (corners_beyond == polygon_sides) { phase = FOUND; }
        } else {
            phase += 1u;
            searched_corner = before_corner(first_beyond);
        }
    }
}

// Settles a doubt.
fn decide() {
    known_place = in_circle(site_of(side_word(searched_corner)), site_of(side_word(after_corner(searched_corner))), bisected_site);
    in_doubt = false;
}

// Cuts off the corners that were found.
fn cut_exactly() {
    if (corners_beyond == 0u || corners_beyond == polygon_sides) { return; }
    if (polygon_sides + 2u - corners_beyond > CORNERS) {
        overflown = true;
        return;
    }
    let entry = meeting(site_of(side_word(first_beyond)), bisected_site);
    let leaving = meeting(bisected_site, site_of(side_word(after_corner(last_beyond))));
    let first_word = side_word(first_beyond);
    // What follows the cut moves up or down to make room for two corners.
    let wrapped = last_beyond < first_beyond;
    let up = !wrapped && corners_beyond == 1u;
    let shift = select(2 - i32(corners_beyond), -i32(last_beyond) - 1, wrapped);
    let moved = select(select(polygon_sides - last_beyond - 1u, 0u, corners_beyond == 2u), first_beyond - last_beyond, wrapped);
    var origin = select(i32(last_beyond) + 1, i32(polygon_sides) - 1, up);
    let way = select(1, -1, up);
    for (var i = 0u; i < moved; i++) {
        let place = u32(origin + shift);
        let from_there = u32(origin);
        set_side(place, side_word(from_there), vec3<f32>(corner_at(from_there), blur_at(from_there)));
        origin += way;
    }
    if (wrapped) { first_beyond = first_beyond - last_beyond - 1u; }
    polygon_sides = polygon_sides + 2u - corners_beyond;
    set_side(first_beyond, first_word, entry);
    set_side(first_beyond + 1u, bisected_site.word, leaving);
}
