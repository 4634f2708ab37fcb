// Integer velocities are rotated by quarter turns and three shears: exactly reversible, and no length is lost.
override QUARTER_TURNS: u32;
override TURN_TANGENT: f32; // of half the angle that is left
override TURN_SINE: f32;

fn turned_by_rotation(velocity: vec2<i32>) -> vec2<i32> {
    var v = velocity;
    if ((QUARTER_TURNS & 1u) == 1u) { v = vec2<i32>(v.y, -v.x); }
    if ((QUARTER_TURNS & 2u) == 2u) { v = -v; }
    v.x += i32(round(TURN_TANGENT * f32(v.y)));
    v.y -= i32(round(TURN_SINE * f32(v.x)));
    v.x += i32(round(TURN_TANGENT * f32(v.y)));
    return v;
}
