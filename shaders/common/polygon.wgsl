// A convex polygon around a particle that is cut along bisectors. Side i, counter-clockwise, ends at corner i, where side
// i + 1 begins.
var<private> sides: u32;
var<private> side_words: array<u32, CORNERS>;
var<private> corners: array<Vector, CORNERS>;
// Radius of the circle around a computed corner within which the true one certainly is.
var<private> blurs: array<f32, CORNERS>;
// Square of the distance beyond which no particle cuts the polygon: twice as far as the farthest corner; or more, for it is
// brought up to date as corners are looked at.
var<private> reach: f32;
var<private> overflown: bool;

const UNKNOWN: f32 = 1e15;
// Further than any corner, however blurred, and its square.
const EVERYWHERE: f32 = 1e18;
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
    reach = EVERYWHERE * EVERYWHERE;
}

fn measure_reach() {
    reach = 0.0;
    for (var i = 0u; i < sides; i++) {
        let far = length(corners[i]) + blurs[i];
        reach = max(reach, 4.00001 * far * far);
    }
}

// A bisector: the unit vector towards its site, and half the way.
struct Bisector {
    direction: Vector,
    half: f32,
}

fn beyond(bisector: Bisector, index: u32) -> f32 { return dot(corners[index], bisector.direction) - bisector.half; }

// The corner that is surest beyond a bisector, and how far any may be.
struct Survey {
    surest: u32,
    farthest: f32,
}

// Looks at all corners, four at a time, and brings the reach up to date.
fn survey(bisector: Bisector) -> Survey {
    var surely = vec4<f32>(-4.0 * UNKNOWN);
    var possibly = vec4<f32>(-4.0 * UNKNOWN);
    var indices = vec4<u32>(0u);
    var squares = vec4<f32>(0.0);
    var widest = vec4<f32>(0.0);
    for (var i = 0u; i < sides; i += 4u) {
        let four = min(vec4<u32>(i, i + 1u, i + 2u, i + 3u), vec4<u32>(sides - 1u));
        let a = corners[four.x];
        let b = corners[four.y];
        let c = corners[four.z];
        let d = corners[four.w];
        let x = vec4<f32>(a.x, b.x, c.x, d.x);
        let y = vec4<f32>(a.y, b.y, c.y, d.y);
        let blur = vec4<f32>(blurs[four.x], blurs[four.y], blurs[four.z], blurs[four.w]);
        let height = x * bisector.direction.x + y * bisector.direction.y - bisector.half;
        indices = select(indices, four, height - blur > surely);
        surely = max(surely, height - blur);
        possibly = max(possibly, height + blur);
        squares = max(squares, x * x + y * y);
        widest = max(widest, blur);
    }
    let far = sqrt(largest_of(squares)) + largest_of(widest);
    reach = 4.00001 * far * far;
    let left = select(indices.x, indices.y, surely.y > surely.x);
    let right = select(indices.z, indices.w, surely.w > surely.z);
    let surest = select(left, right, max(surely.z, surely.w) > max(surely.x, surely.y));
    return Survey(surest, largest_of(possibly));
}
fn largest_of(v: vec4<f32>) -> f32 { return max(max(v.x, v.y), max(v.z, v.w)); }

// Cuts the polygon along the bisector of a site, unless no corner is beyond it.
fn cut(site: Site, squared: f32) {
    let inverse = inverseSqrt(squared);
    let bisector = Bisector(site.away * scale() * inverse, 0.5 * squared * inverse);
    let found = survey(bisector);
    for (var pending = found.farthest > 0.0; pending; pending = false) { cut_corners(site, bisector, found.surest); }
}

// Cuts corners beyond a bisector, and with them those next to them that are on it, so that no side without length is left.
// Searches from the surest one, then goes on to both sides.
fn cut_corners(site: Site, bisector: Bisector, surest: u32) {
    var corner = surest;
    var tried = 0u;
    var first = 0u;
    var last = 0u;
    var gone = 0u;
    for (var phase = 0u; phase < 3u && tried < sides && gone < sides;) {
        let height = beyond(bisector, corner);
        var place = i32(sign(height));
        for (var pending = abs(height) <= blurs[corner]; pending; pending = false) {
            place = in_circle(site_of(side_words[corner]), site_of(side_words[after(corner)]), site);
        }
        if (phase == 0u) {
            tried += 1u;
            if (place > 0) {
                first = corner;
                last = corner;
                gone = 1u;
                phase = 1u;
                tried = 0u;
            }
            corner = after(corner);
        } else {
            if (place >= 0) {
                gone += 1u;
                first = select(first, corner, phase == 2u);
                last = select(last, corner, phase == 1u);
                corner = select(after(corner), before(corner), phase == 2u);
            } else {
                phase += 1u;
                corner = before(first);
            }
        }
    }
    // No corner is beyond. Not all are: the particle itself never is.
    if (gone == 0u || gone == sides) { return; }
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
}
