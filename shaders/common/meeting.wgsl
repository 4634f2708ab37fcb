// Corners of Voronoi cells, and how well they are known.
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
