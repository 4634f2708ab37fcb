// A convex polygon of at most twelve corners in registers: every index is known to the compiler, and there is no branch. It knows
// when it does not know which side of a bisector a corner is on.
//
// Side i, counter-clockwise, ends at corner i, where side i + 1 begins. Every corner has a blur: the radius of the
// circle around it within which the true one certainly is. Beyond the last corner all is zero, which no bisector cuts off.
const MOST: u32 = 12u;
// A word of every corner.
struct Twelve { a: vec4<u32>, b: vec4<u32>, c: vec4<u32> }
var<private> xs: Twelve;
var<private> ys: Twelve;
var<private> corner_blurs: Twelve;
// The sites of the sides: as faces are named, and their separations, because memory is slow.
var<private> side_names: Twelve;
var<private> steps_x: Twelve;
var<private> steps_y: Twelve;
var<private> few_sides: u32;
// Square of the distance beyond which no particle cuts the polygon: twice as far as the farthest corner.
var<private> reach: f32;
var<private> few_doubtful: bool;

// The bisector that is examined, and the corners beyond it, a bit each.
var<private> site: Site;
var<private> corners_beyond_bits: u32;

// The rectangle between a particle and its own images.
fn begin_polygon(slot: u32) {
    let half = 2147483648.0 * scale_of_lengths();
    let blur = bitcast<u32>(100.0 * ROUNDING * length(half));
    let corner = bitcast<vec2<u32>>(half);
    let opposite = bitcast<vec2<u32>>(-half);
    let none = vec4<u32>(0u);
    few_sides = 4u;
    xs = Twelve(vec4<u32>(corner.x, opposite.x, opposite.x, corner.x), none, none);
    ys = Twelve(vec4<u32>(corner.y, corner.y, opposite.y, opposite.y), none, none);
    corner_blurs = Twelve(vec4<u32>(blur), none, none);
    side_names = Twelve(vec4<u32>(face_word(slot, vec2<i32>(1, 0)), face_word(slot, vec2<i32>(0, 1)),
        face_word(slot, vec2<i32>(-1, 0)), face_word(slot, vec2<i32>(0, -1))), none, none);
    steps_x = Twelve(none, none, none);
    steps_y = steps_x;
    reach = EVERYWHERE * EVERYWHERE;
    few_doubtful = false;
}

// Of four corners those that are surely beyond a bisector, a bit each, and above them those in doubt.
fn beyond_of(x: vec4<u32>, y: vec4<u32>, blur: vec4<u32>, direction: Vector, half: f32) -> u32 {
    let over = bitcast<vec4<f32>>(x) * direction.x + bitcast<vec4<f32>>(y) * direction.y - half;
    let width = bitcast<vec4<f32>>(blur);
    let sure = select(vec4<u32>(0u), vec4<u32>(1u, 2u, 4u, 8u), over > width);
    let unsure = select(vec4<u32>(0u), vec4<u32>(65536u), abs(over) <= width);
    let bits = sure | unsure;
    return (bits.x | bits.y) | (bits.z | bits.w);
}

// Whether the bisector of a site so far away (squared) cuts anything off.
fn cuts_few(there: Site, squared: f32) -> bool {
    site = there;
    let inverse = inverseSqrt(squared);
    let direction = there.away * scale_of_lengths() * inverse;
    let half = 0.5 * squared * inverse;
    let all = beyond_of(xs.a, ys.a, corner_blurs.a, direction, half)
        | (beyond_of(xs.b, ys.b, corner_blurs.b, direction, half) << 4u)
        | (beyond_of(xs.c, ys.c, corner_blurs.c, direction, half) << 8u);
    few_doubtful = few_doubtful || all >= 65536u;
    corners_beyond_bits = all & 4095u;
    return all != 0u;
}

fn one_of(v: Twelve, index: u32) -> u32 {
    let none = vec4<u32>(0u);
    let bits = select(none, v.a, vec4<u32>(0u, 1u, 2u, 3u) == vec4<u32>(index))
        | select(none, v.b, vec4<u32>(4u, 5u, 6u, 7u) == vec4<u32>(index))
        | select(none, v.c, vec4<u32>(8u, 9u, 10u, 11u) == vec4<u32>(index));
    return (bits.x | bits.y) | (bits.z | bits.w);
}

fn site_of_side(index: u32) -> Site {
    return site_with(one_of(side_names, index), bitcast<Steps>(vec2<u32>(one_of(steps_x, index), one_of(steps_y, index))));
}

// How corners move for a cut: those before `kept` stay, the others come from `down` places further on or, if `up`, from one
// place before; the two ends of the cut go to `cut_at`; from `sides` on there is nothing.
struct Move { kept: u32, down: u32, up: bool, cut_at: u32, sides: u32 }

fn four_moved(own: vec4<u32>, others: vec4<u32>, index: vec4<u32>, m: Move, entry: u32, leaving: u32) -> vec4<u32> {
    var four = select(others, own, index < vec4<u32>(m.kept));
    four = select(four, vec4<u32>(entry), index == vec4<u32>(m.cut_at));
    four = select(four, vec4<u32>(leaving), index == vec4<u32>(m.cut_at + 1u));
    return select(four, vec4<u32>(0u), index >= vec4<u32>(m.sides));
}

fn corners_moved(v: Twelve, m: Move, entry: u32, leaving: u32) -> Twelve {
    let none = vec4<u32>(0u);
    let four = (m.down & 4u) != 0u;
    let a = select(v.a, v.b, four);
    let b = select(v.b, v.c, four);
    let c = select(v.c, none, four);
    let two = (m.down & 2u) != 0u;
    let d = select(a, vec4<u32>(a.zw, b.xy), two);
    let e = select(b, vec4<u32>(b.zw, c.xy), two);
    let f = select(c, vec4<u32>(c.zw, 0u, 0u), two);
    let one = (m.down & 1u) != 0u;
    let g = select(select(d, vec4<u32>(d.yzw, e.x), one), vec4<u32>(0u, v.a.xyz), m.up);
    let h = select(select(e, vec4<u32>(e.yzw, f.x), one), vec4<u32>(v.a.w, v.b.xyz), m.up);
    let i = select(select(f, vec4<u32>(f.yzw, 0u), one), vec4<u32>(v.b.w, v.c.xyz), m.up);
    return Twelve(
        four_moved(v.a, g, vec4<u32>(0u, 1u, 2u, 3u), m, entry, leaving),
        four_moved(v.b, h, vec4<u32>(4u, 5u, 6u, 7u), m, entry, leaving),
        four_moved(v.c, i, vec4<u32>(8u, 9u, 10u, 11u), m, entry, leaving));
}

fn farthest_of(x: vec4<u32>, y: vec4<u32>) -> f32 {
    let u = bitcast<vec4<f32>>(x);
    let v = bitcast<vec4<f32>>(y);
    let squares = u * u + v * v;
    return max(max(squares.x, squares.y), max(squares.z, squares.w));
}
fn widest_of(blur: vec4<u32>) -> f32 {
    let width = bitcast<vec4<f32>>(blur);
    return max(max(width.x, width.y), max(width.z, width.w));
}

// Cuts off the corners beyond the bisector.
fn cut_few() {
    let wrapped = (corners_beyond_bits & 1u) != 0u && (corners_beyond_bits >> (few_sides - 1u)) == 1u;
    let left = ~corners_beyond_bits & ((1u << few_sides) - 1u);
    let first = select(firstTrailingBit(corners_beyond_bits), firstLeadingBit(left) + 1u, wrapped);
    let last = select(firstLeadingBit(corners_beyond_bits), firstTrailingBit(left) - 1u, wrapped);
    let gone = select(last + 1u - first, few_sides + last + 1u - first, wrapped);
    let up = !wrapped && gone == 1u;
    let down = select(select(gone - 2u, 0u, up), last + 1u, wrapped);
    let count = few_sides + 2u - gone;
    let cut_at = select(first, first - last - 1u, wrapped);
    let next = select(last + 1u, 0u, last + 1u == few_sides);
    // Too many corners, or (never in exact arithmetic) none left.
    if (left == 0u || count > MOST || down > 7u) {
        few_doubtful = true;
        return;
    }
    let before = site_of_side(first);
    let entry = meeting(before, site);
    let leaving = meeting(site, site_of_side(next));
    let m = Move(select(first, 0u, wrapped), down, up, cut_at, count);
    xs = corners_moved(xs, m, bitcast<u32>(entry.x), bitcast<u32>(leaving.x));
    ys = corners_moved(ys, m, bitcast<u32>(entry.y), bitcast<u32>(leaving.y));
    corner_blurs = corners_moved(corner_blurs, m, bitcast<u32>(entry.z), bitcast<u32>(leaving.z));
    side_names = corners_moved(side_names, m, before.word, site.word);
    let before_steps = bitcast<vec2<u32>>(before.steps);
    let steps = bitcast<vec2<u32>>(site.steps);
    steps_x = corners_moved(steps_x, m, before_steps.x, steps.x);
    steps_y = corners_moved(steps_y, m, before_steps.y, steps.y);
    few_sides = count;
    let farthest = max(max(farthest_of(xs.a, ys.a), farthest_of(xs.b, ys.b)), farthest_of(xs.c, ys.c));
    let far = sqrt(farthest) + max(max(widest_of(corner_blurs.a), widest_of(corner_blurs.b)), widest_of(corner_blurs.c));
    reach = 4.00001 * far * far;
}

fn corners_turned(v: Twelve) -> Twelve {
    return Twelve(vec4<u32>(v.a.yzw, v.b.x), vec4<u32>(v.b.yzw, v.c.x), vec4<u32>(v.c.yzw, v.a.x));
}
