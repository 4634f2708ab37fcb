// Flat shapes of a plot. Every instance is one quad; the fragment's coverage is computed from the exact shape, so
// edges are smooth without multisampling. The target is an sRGB texture: blending happens in linear light.

struct Viewport {
    // In pixels.
    size: vec2f,
}

@group(0) @binding(0) var<uniform> viewport: Viewport;
@group(0) @binding(1) var atlas: texture_2d<f32>;

const KIND_CAPSULE: u32 = 0u;
const KIND_RECTANGLE: u32 = 1u;
const KIND_POLYGON: u32 = 2u;
const KIND_GLYPH: u32 = 3u;
const KIND_TRIANGLE: u32 = 4u;

struct Instance {
    // Capsule: both ends. Rectangle: two corners. Polygon: centre, then (angle, sides). Glyph: the texture's corner,
    // then the unit vector along a line of text. Triangle: two corners.
    @location(0) ends: vec4f,
    // Glyph: corner and size in the atlas, in texels. Triangle: the third corner.
    @location(1) texels: vec4f,
    // Half width of a capsule, circumradius of a polygon.
    @location(2) radius: f32,
    @location(3) kind: u32,
    // sRGB with straight alpha.
    @location(4) colour: vec4f,
}

struct Varying {
    @builtin(position) position: vec4f,
    @location(0) @interpolate(flat) ends: vec4f,
    @location(1) @interpolate(flat) texels: vec4f,
    @location(2) @interpolate(flat) radius: f32,
    @location(3) @interpolate(flat) kind: u32,
    @location(4) @interpolate(flat) colour: vec4f,
}

fn linear_from_srgb(colour: vec3f) -> vec3f {
    let low = colour / 12.92;
    let high = pow((colour + 0.055) / 1.055, vec3f(2.4));
    return select(high, low, colour <= vec3f(0.04045));
}

@vertex
fn vertex_shape(@builtin(vertex_index) vertex: u32, instance: Instance) -> Varying {
    let corner = vec2f(f32(vertex & 1u), f32(vertex >> 1u));
    var pixel: vec2f;
    switch instance.kind {
        case KIND_CAPSULE: {
            // A quad along the axis: a box around a diagonal line would be nearly all empty fragments.
            let axis = instance.ends.zw - instance.ends.xy;
            let length = length(axis);
            let along = select(vec2f(1.0, 0.0), axis / length, length > 0.0);
            let across = vec2f(-along.y, along.x);
            let margin = instance.radius + 1.0;
            pixel = instance.ends.xy + along * mix(-margin, length + margin, corner.x)
                + across * mix(-margin, margin, corner.y);
        }
        case KIND_RECTANGLE: {
            let low = min(instance.ends.xy, instance.ends.zw) - 1.0;
            let high = max(instance.ends.xy, instance.ends.zw) + 1.0;
            pixel = mix(low, high, corner);
        }
        case KIND_POLYGON: {
            pixel = instance.ends.xy + (corner * 2.0 - 1.0) * (instance.radius + 1.0);
        }
        case KIND_TRIANGLE: {
            // The second triangle of the strip is empty.
            pixel = select(select(instance.texels.xy, instance.ends.zw, vertex == 1u), instance.ends.xy, vertex == 0u);
        }
        default: {
            let along = instance.ends.zw;
            let down = vec2f(-along.y, along.x);
            pixel = instance.ends.xy + along * corner.x * instance.texels.z + down * corner.y * instance.texels.w;
        }
    }
    var out: Varying;
    out.position = vec4f(pixel / viewport.size * vec2f(2.0, -2.0) + vec2f(-1.0, 1.0), 0.0, 1.0);
    out.ends = instance.ends;
    out.texels = instance.texels;
    out.radius = instance.radius;
    out.kind = instance.kind;
    out.colour = vec4f(linear_from_srgb(instance.colour.rgb), instance.colour.a);
    return out;
}

fn capsule_coverage(pixel: vec2f, ends: vec4f, radius: f32) -> f32 {
    let axis = ends.zw - ends.xy;
    let from_start = pixel - ends.xy;
    let squared = dot(axis, axis);
    let along = select(0.0, clamp(dot(from_start, axis) / squared, 0.0, 1.0), squared > 0.0);
    let distance = length(from_start - axis * along) - radius;
    // A line thinner than a pixel fades instead of vanishing between pixel centres.
    return clamp(0.5 - distance, 0.0, 1.0) * min(1.0, radius * 2.0);
}

fn rectangle_coverage(pixel: vec2f, ends: vec4f) -> f32 {
    let low = min(ends.xy, ends.zw);
    let high = max(ends.xy, ends.zw);
    let overlap = clamp(min(high, pixel + 0.5) - max(low, pixel - 0.5), vec2f(0.0), vec2f(1.0));
    return overlap.x * overlap.y;
}

fn polygon_coverage(pixel: vec2f, centre: vec2f, angle: f32, sides: f32, radius: f32) -> f32 {
    let offset = pixel - centre;
    let sector = 6.283185307 / sides;
    let turned = atan2(offset.y, offset.x) - angle;
    let folded = turned - sector * floor(turned / sector) - 0.5 * sector;
    let apothem = radius * cos(0.5 * sector);
    return clamp(0.5 - (length(offset) * cos(folded) - apothem), 0.0, 1.0);
}

fn glyph_coverage(pixel: vec2f, ends: vec4f, texels: vec4f, colour: vec3f) -> f32 {
    let along = ends.zw;
    let down = vec2f(-along.y, along.x);
    let offset = pixel - ends.xy;
    let texel = vec2i(floor(vec2f(dot(offset, along), dot(offset, down))));
    let limit = vec2i(texels.zw);
    if any(texel < vec2i(0)) || any(texel >= limit) {
        return 0.0;
    }
    let coverage = textureLoad(atlas, vec2i(texels.xy) + texel, 0).r;
    // Blending in linear light makes dark strokes on light paper look thin: raise their coverage, not that of light ink.
    let luminance = dot(colour, vec3f(0.2126, 0.7152, 0.0722));
    return pow(coverage, mix(0.72, 1.0, sqrt(luminance)));
}

@fragment
fn fragment_shape(in: Varying) -> @location(0) vec4f {
    let pixel = in.position.xy;
    var coverage: f32;
    switch in.kind {
        case KIND_CAPSULE: {
            coverage = capsule_coverage(pixel, in.ends, in.radius);
        }
        case KIND_RECTANGLE: {
            coverage = rectangle_coverage(pixel, in.ends);
        }
        case KIND_TRIANGLE: {
            coverage = 1.0;
        }
        case KIND_POLYGON: {
            coverage = polygon_coverage(pixel, in.ends.xy, in.ends.z, in.ends.w, in.radius);
        }
        default: {
            coverage = glyph_coverage(pixel, in.ends, in.texels, in.colour.rgb);
        }
    }
    let alpha = coverage * in.colour.a;
    return vec4f(in.colour.rgb * alpha, alpha);
}
