// Rounded.
fn in_circle(a: Site, b: Site, c: Site) -> i32 {
    let v = meeting(a, b);
    let d = c.away * scale();
    return i32(sign(dot(v.xy, d) - 0.5 * dot(d, d)));
}
