// Whether a particle is within the circle through three others, exactly: integers of several words, in two's complement.
//
// Displacements are integers of 34 bits, and so are all terms up to one thing: a unit of y is not as long as one of x. Of
// their squares the lengths are in the ratio of WEIGHT_Y to WEIGHT_X, whole numbers of two words each.
override WEIGHT_X_LOW: u32;
override WEIGHT_X_HIGH: u32;
override WEIGHT_Y_LOW: u32;
override WEIGHT_Y_HIGH: u32;

// A cross product has 67 bits with its sign, a squared length 130, and their products, summed, 199.
const CROSS_WORDS: u32 = 3u;
const NORM_WORDS: u32 = 5u;
const WORDS: u32 = 7u;
alias Long = array<u32, WORDS>;

// Both words of a product.
fn product(a: u32, b: u32) -> vec2<u32> {
    let a_high = a >> 16u;
    let b_high = b >> 16u;
    let a_low = a & 65535u;
    let b_low = b & 65535u;
    let low = a_low * b_low;
    let middle = a_high * b_low + (low >> 16u);
    let other = a_low * b_high + (middle & 65535u);
    return vec2<u32>((other << 16u) | (low & 65535u), a_high * b_high + (middle >> 16u) + (other >> 16u));
}

// Loops over words are not to be unrolled, for compilers would take seconds: they cannot know that no polygon has as many
// sides as it would take to change a number of words.
fn opaque(words: u32) -> u32 { return words + (sides >> 16u); }

// The product of two numbers modulo 2 to the power of so many words.
fn multiply(first: Long, second: Long, words: u32) -> Long {
    var a = first;
    var b = second;
    var result = Long();
    for (var i = 0u; i < words; i++) {
        var carry = 0u;
        for (var j = 0u; i + j < words; j++) {
            let both = product(a[i], b[j]);
            let sum = result[i + j] + both.x;
            let total = sum + carry;
            carry = both.y + select(0u, 1u, sum < both.x) + select(0u, 1u, total < carry);
            result[i + j] = total;
        }
    }
    return result;
}

// A sum, or a difference if `sign` is all ones: a + ~b + 1.
fn combine(first: Long, second: Long, sign: u32) -> Long {
    var a = first;
    var b = second;
    var carry = sign & 1u;
    for (var i = 0u; i < opaque(WORDS); i++) {
        let sum = a[i] + (b[i] ^ sign);
        let total = sum + carry;
        carry = select(0u, 1u, sum < a[i]) + select(0u, 1u, total < sum);
        a[i] = total;
    }
    return a;
}

// The first words of a number with its sign in all that follow.
fn extended(number: Long, words: u32) -> Long {
    var result = number;
    let sign = bitcast<u32>(bitcast<i32>(result[words - 1u]) >> 31u);
    for (var i = words; i < opaque(WORDS); i++) { result[i] = sign; }
    return result;
}

// A component of the separation from a site: a circle turned half round is still one.
fn component(site: Site, axis: u32) -> Long {
    let steps = site.steps[axis];
    let high = bitcast<u32>((steps >> 31u) - image_of(site.word)[axis]);
    return extended(Long(bitcast<u32>(steps), high, 0u, 0u, 0u, 0u, 0u), 2u);
}

// 1 if `c` is within the circle through the particle of the cell, `a` and, counter-clockwise of it, `b`; 0 if it is on it;
// else -1: the sign of |a|^2 c x b + |b|^2 a x c + |c|^2 b x a.
fn in_circle(a: Site, b: Site, c: Site) -> i32 {
    var sum = Long();
    var at = a;
    var next = b;
    var previous = c;
    for (var term = 0u; term < opaque(3u); term++) {
        var norm = Long();
        var cross_product = Long();
        for (var axis = 0u; axis < opaque(2u); axis++) {
            let along = component(at, axis);
            let square = multiply(along, along, opaque(CROSS_WORDS));
            let weight = select(vec2<u32>(WEIGHT_Y_LOW, WEIGHT_Y_HIGH), vec2<u32>(WEIGHT_X_LOW, WEIGHT_X_HIGH), axis == 0u);
            let weighted = multiply(Long(weight.x, weight.y, 0u, 0u, 0u, 0u, 0u), square, opaque(NORM_WORDS));
            norm = combine(norm, weighted, 0u);
            let part = multiply(component(previous, axis), component(next, 1u - axis), opaque(CROSS_WORDS));
            cross_product = combine(cross_product, part, select(0xffffffffu, 0u, axis == 0u));
        }
        sum = combine(sum, multiply(extended(cross_product, CROSS_WORDS), norm, opaque(WORDS)), 0u);
        let first = at;
        at = next;
        next = previous;
        previous = first;
    }
    var any = 0u;
    for (var i = 0u; i < opaque(WORDS); i++) { any |= sum[i]; }
    return select(select(1, 0, any == 0u), -1, (sum[WORDS - 1u] >> 31u) == 1u);
}
