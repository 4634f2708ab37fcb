// Whether a particle is within the circle through three others, exactly: integers of several words, in two's complement.
//
// Separations are integers of 34 bits, and so are all terms but for one thing: a unit of y is not as long as one of x. Of
// their squares the lengths are in the ratio of WEIGHT_Y to WEIGHT_X, whole numbers of two words each. A cross product then
// has 67 bits with its sign, a squared length 130, and the sum of three of their products 199. No loops but one: software
// adapters count them.
override WEIGHT_X_LOW: u32;
override WEIGHT_X_HIGH: u32;
override WEIGHT_Y_LOW: u32;
override WEIGHT_Y_HIGH: u32;

// Five words; seven words.
alias Norm = array<u32, 5>;
alias Sum = array<u32, 7>;

// sum + a b + carry, and the new carry.
fn multiply_add(sum: u32, a: u32, b: u32, carry: u32) -> vec2<u32> {
    let a_high = a >> 16u;
    let b_high = b >> 16u;
    let a_low = a & 65535u;
    let b_low = b & 65535u;
    let low = a_low * b_low;
    let middle = a_high * b_low + (low >> 16u);
    let other = a_low * b_high + (middle & 65535u);
    let high = a_high * b_high + (middle >> 16u) + (other >> 16u);
    let first = ((other << 16u) | (low & 65535u)) + sum;
    let total = first + carry;
    return vec2<u32>(total, high + select(0u, 1u, first < sum) + select(0u, 1u, total < carry));
}

// a + b + carry, and the new carry.
fn add_carried(a: u32, b: u32, carry: u32) -> vec2<u32> {
    let first = a + b;
    let total = first + carry;
    return vec2<u32>(total, select(0u, 1u, first < a) + select(0u, 1u, total < first));
}

// A product modulo 2^96.
fn multiply(a: vec3<u32>, b: vec3<u32>) -> vec3<u32> {
    let x = multiply_add(0u, a.x, b.x, 0u);
    let y = multiply_add(0u, a.x, b.y, x.y);
    let z = multiply_add(y.x, a.y, b.x, 0u);
    return vec3<u32>(x.x, z.x, y.y + z.y + a.x * b.z + a.y * b.y + a.z * b.x);
}

fn subtract(a: vec3<u32>, b: vec3<u32>) -> vec3<u32> {
    let x = add_carried(a.x, ~b.x, 1u);
    let y = add_carried(a.y, ~b.y, x.y);
    return vec3<u32>(x.x, y.x, a.z + ~b.z + y.y);
}

// The sum and a square times its weight.
fn add_weighted(sum: Norm, weight: vec2<u32>, square: vec3<u32>) -> Norm {
    let a = multiply_add(sum[0], weight.x, square.x, 0u);
    let b = multiply_add(sum[1], weight.x, square.y, a.y);
    let c = multiply_add(sum[2], weight.x, square.z, b.y);
    let d = multiply_add(b.x, weight.y, square.x, 0u);
    let e = multiply_add(c.x, weight.y, square.y, d.y);
    let f = multiply_add(sum[3], weight.y, square.z, e.y);
    let g = add_carried(f.x, c.y, 0u);
    return Norm(a.x, d.x, e.x, g.x, sum[4] + f.y + g.y);
}

fn add_row(sum: Norm, norm: Norm, factor: u32) -> array<u32, 6> {
    let a = multiply_add(sum[0], norm[0], factor, 0u);
    let b = multiply_add(sum[1], norm[1], factor, a.y);
    let c = multiply_add(sum[2], norm[2], factor, b.y);
    let d = multiply_add(sum[3], norm[3], factor, c.y);
    let e = multiply_add(sum[4], norm[4], factor, d.y);
    return array<u32, 6>(a.x, b.x, c.x, d.x, e.x, e.y);
}

// The sum and the product of a squared length with a cross product, modulo 2^224.
fn add_product(sum: Sum, norm: Norm, factor: vec3<u32>) -> Sum {
    let a = add_row(Norm(sum[0], sum[1], sum[2], sum[3], sum[4]), norm, factor.x);
    let b_high = add_carried(sum[5], a[5], 0u);
    let b = add_row(Norm(a[1], a[2], a[3], a[4], b_high.x), norm, factor.y);
    let c_high = sum[6] + b_high.y + b[5];
    let c = add_row(Norm(b[1], b[2], b[3], b[4], c_high), norm, factor.z);
    // Taken as unsigned, a negative factor is 2^96 too large.
    let negative = (factor.z >> 31u) == 1u;
    let d = add_carried(c[1], select(0u, ~norm[0], negative), select(0u, 1u, negative));
    let e = add_carried(c[2], select(0u, ~norm[1], negative), d.y);
    let f = add_carried(c[3], select(0u, ~norm[2], negative), e.y);
    return Sum(a[0], b[0], c[0], d.x, e.x, f.x, c[4] + select(0u, ~norm[3], negative) + f.y);
}

// A component of the separation from a site: a circle turned by half a turn is still one.
fn component(steps: i32, image: i32) -> vec3<u32> {
    let high = (steps >> 31u) - image;
    return vec3<u32>(bitcast<u32>(steps), bitcast<u32>(high), bitcast<u32>(high >> 31u));
}

// 1 if `c` is within the circle through the particle of the cell, `a` and, counter-clockwise of it, `b`; 0 if it is on it;
// else -1: the sign of |a|^2 c x b + |b|^2 a x c + |c|^2 b x a.
fn in_circle(a: Site, b: Site, c: Site) -> i32 {
    var sum = Sum();
    var here = a;
    var next = b;
    var previous = c;
    for (var term = 0u; term < 3u; term++) {
        let here_image = image_of(here.word);
        let here_x = component(here.steps.x, here_image.x);
        let here_y = component(here.steps.y, here_image.y);
        var norm = add_weighted(Norm(), vec2<u32>(WEIGHT_X_LOW, WEIGHT_X_HIGH), multiply(here_x, here_x));
        norm = add_weighted(norm, vec2<u32>(WEIGHT_Y_LOW, WEIGHT_Y_HIGH), multiply(here_y, here_y));
        let next_image = image_of(next.word);
        let previous_image = image_of(previous.word);
        let forward = multiply(component(previous.steps.x, previous_image.x), component(next.steps.y, next_image.y));
        let backward = multiply(component(previous.steps.y, previous_image.y), component(next.steps.x, next_image.x));
        sum = add_product(sum, norm, subtract(forward, backward));
        let first = here;
        here = next;
        next = previous;
        previous = first;
    }
    let any = sum[0] | sum[1] | sum[2] | sum[3] | sum[4] | sum[5] | sum[6];
    return select(select(1, 0, any == 0u), -1, (sum[6] >> 31u) == 1u);
}
