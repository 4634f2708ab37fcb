// Transforms of four and of eight numbers, and the roots of unity within those of sixteen.
const ROOT_HALF = 0.70710678118654752440;
const SIXTEENTH = vec2<f32>(0.92387953251128675613, -0.38268343236508977173);
const THREE_SIXTEENTHS = vec2<f32>(0.38268343236508977173, -0.92387953251128675613);

fn eighth(a: vec2<f32>) -> vec2<f32> { return ROOT_HALF * vec2<f32>(a.x + a.y, a.y - a.x); }

fn fourier4(a: vec2<f32>, b: vec2<f32>, c: vec2<f32>, d: vec2<f32>) -> array<vec2<f32>, 4> {
    let even_sum = a + c;
    let even_difference = a - c;
    let odd_sum = b + d;
    let odd_difference = quarter(b - d);
    return array<vec2<f32>, 4>(
        even_sum + odd_sum,
        even_difference + odd_difference,
        even_sum - odd_sum,
        even_difference - odd_difference,
    );
}

fn fourier8(
    a: vec2<f32>, b: vec2<f32>, c: vec2<f32>, d: vec2<f32>, e: vec2<f32>, f: vec2<f32>, g: vec2<f32>, h: vec2<f32>,
) -> array<vec2<f32>, 8> {
    let even = fourier4(a, c, e, g);
    let odd = fourier4(b, d, f, h);
    let p = eighth(odd[1]);
    let q = quarter(odd[2]);
    let r = quarter(eighth(odd[3]));
    return array<vec2<f32>, 8>(
        even[0] + odd[0], even[1] + p, even[2] + q, even[3] + r,
        even[0] - odd[0], even[1] - p, even[2] - q, even[3] - r,
    );
}
