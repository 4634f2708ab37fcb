// Particles as spheres and bonds as rods in parallel projection: one quad each, the surface and its depth found per fragment.
// Drawn larger than the picture and averaged down by composite.wgsl.

struct Camera {
    // Unit vectors of the view in box coordinates; w of `right` is pixels per unit of length.
    right: vec4f,
    up: vec4f,
    // Towards the viewer; w is half the depth that maps onto [0, 1].
    toward: vec4f,
    // Where the centre of the box lands, then the size of the target, both in pixels of the target.
    centre_and_size: vec4f,
    // Colour of the paper that distance fades into (square roots of linear light), and how much of it the farthest
    // point takes.
    fog: vec4f,
    // Radius in units of length, radius in pixels, strength of the lighting, darkness of the rim.
    look: vec4f,
    // Of bonds: radius in units of length, radius in pixels.
    rods: vec4f,
}

@group(0) @binding(0) var<uniform> camera: Camera;

struct Particle {
    // Relative to the centre of the box.
    @location(0) position: vec3f,
    // sRGB.
    @location(1) colour: vec4f,
}

struct Varying {
    @builtin(position) position: vec4f,
    @location(0) @interpolate(flat) centre: vec2f,
    @location(1) @interpolate(flat) height: f32,
    @location(2) @interpolate(flat) colour: vec3f,
}

struct Surface {
    @location(0) colour: vec4f,
    @builtin(frag_depth) depth: f32,
}

fn linear_from_srgb(colour: vec3f) -> vec3f {
    let low = colour / 12.92;
    let high = pow((colour + 0.055) / 1.055, vec3f(2.4));
    return select(high, low, colour <= vec3f(0.04045));
}

// Where a place relative to the centre of the box is seen.
fn pixel_of(place: vec3f) -> vec2f {
    let seen = vec2f(dot(place, camera.right.xyz), -dot(place, camera.up.xyz));
    return camera.centre_and_size.xy + seen * camera.right.w;
}

fn target_of(pixel: vec2f) -> vec4f {
    return vec4f(pixel / camera.centre_and_size.zw * vec2f(2.0, -2.0) + vec2f(-1.0, 1.0), 0.5, 1.0);
}

@vertex
fn vertex_sphere(@builtin(vertex_index) vertex: u32, particle: Particle) -> Varying {
    let corner = vec2f(f32(vertex & 1u), f32(vertex >> 1u)) * 2.0 - 1.0;
    let centre = pixel_of(particle.position);
    var out: Varying;
    out.position = target_of(centre + corner * (camera.look.y + 1.0));
    out.centre = centre;
    out.height = dot(particle.position, camera.toward.xyz);
    out.colour = linear_from_srgb(particle.colour.rgb);
    return out;
}

@fragment
fn fragment_sphere(in: Varying) -> Surface {
    let offset = (in.position.xy - in.centre) / camera.look.y;
    let squared = dot(offset, offset);
    if squared > 1.0 {
        discard;
    }
    let normal = vec3f(offset.x, -offset.y, sqrt(1.0 - squared));
    return surface(in.colour, normal, squared, in.height + normal.z * camera.look.x);
}

// A surface in the light at a height towards the viewer; `squared` is the square of the distance from the axis of sight through
// the middle, in radii.
fn surface(own: vec3f, normal: vec3f, squared: f32, height: f32) -> Surface {
    let farness = clamp(0.5 - 0.5 * height / camera.toward.w, 0.0, 1.0);

    let light = normalize(vec3f(-0.45, 0.65, 0.75));
    let half_way = normalize(light + vec3f(0.0, 0.0, 1.0));
    let diffuse = 0.42 + 0.66 * max(dot(normal, light), 0.0);
    // To the 32nd power.
    let facing = max(dot(normal, half_way), 0.0);
    let facing_2 = facing * facing;
    let facing_4 = facing_2 * facing_2;
    let facing_8 = facing_4 * facing_4;
    let facing_16 = facing_8 * facing_8;
    let gloss = 0.16 * facing_16 * facing_16;
    let lit = own * diffuse + gloss;
    let rim = 1.0 - camera.look.w * smoothstep(0.62, 0.95, squared);
    let colour = mix(own, lit, camera.look.z) * rim;

    var out: Surface;
    // Mixed and stored in nearly perceptual steps: in linear light a little white would drown a dark colour.
    out.colour = vec4f(mix(sqrt(colour), camera.fog.rgb, camera.fog.a * farness), 1.0);
    out.depth = farness;
    return out;
}

// Half of a bond, from the particle whose colour it has.
struct Rod {
    // Of the particle, relative to the centre of the box.
    @location(0) position: vec3f,
    // From there to the middle of the bond.
    @location(1) reach: vec3f,
    // sRGB.
    @location(2) colour: vec4f,
}

struct RodVarying {
    @builtin(position) position: vec4f,
    @location(0) @interpolate(flat) start: vec2f,
    // Unit vector of the rod in the picture.
    @location(1) @interpolate(flat) along: vec2f,
    // Height of the start, and length of the rod in pixels.
    @location(2) @interpolate(flat) height: f32,
    @location(3) @interpolate(flat) extent: f32,
    // Cosine and sine of the angle between the rod and the picture.
    @location(4) @interpolate(flat) tilt: vec2f,
    @location(5) @interpolate(flat) colour: vec3f,
}

@vertex
fn vertex_rod(@builtin(vertex_index) vertex: u32, rod: Rod) -> RodVarying {
    let start = pixel_of(rod.position);
    let way = pixel_of(rod.position + rod.reach) - start;
    let seen = length(way);
    let along = select(vec2f(1.0, 0.0), way / seen, seen > 1e-3);
    // The surface of a rod that comes towards the viewer begins before its axis does, and one that goes away ends after it.
    let margin = camera.rods.y + 1.0;
    let corner = vec2f(f32(vertex & 1u), f32(vertex >> 1u) * 2.0 - 1.0);
    let place = along * mix(-margin, seen + margin, corner.x) + vec2f(-along.y, along.x) * margin * corner.y;
    let rise = dot(rod.reach, camera.toward.xyz) * camera.right.w;
    let extent = max(sqrt(seen * seen + rise * rise), 1e-3);
    var out: RodVarying;
    out.position = target_of(start + place);
    out.start = start;
    out.along = along;
    out.height = dot(rod.position, camera.toward.xyz);
    out.extent = extent;
    out.tilt = vec2f(seen, rise) / extent;
    out.colour = linear_from_srgb(rod.colour.rgb);
    return out;
}

@fragment
fn fragment_rod(in: RodVarying) -> Surface {
    let offset = in.position.xy - in.start;
    let across = vec2f(-in.along.y, in.along.x);
    let beside = dot(offset, across) / camera.rods.y;
    let squared = beside * beside;
    let front = sqrt(max(1.0 - squared, 0.0));
    // How far along the rod the surface is that is seen here. One that points at the viewer is hidden by the particle before it.
    let place = (dot(offset, in.along) + front * camera.rods.y * in.tilt.y) / max(in.tilt.x, 0.02);
    if squared > 1.0 || place < 0.0 || place > in.extent || in.tilt.x < 0.02 {
        discard;
    }
    let level = across * beside - in.along * (in.tilt.y * front);
    let normal = vec3f(level.x, -level.y, in.tilt.x * front);
    let rise = place * in.tilt.y + front * camera.rods.y * in.tilt.x;
    return surface(in.colour, normal, squared, in.height + rise / camera.right.w);
}
