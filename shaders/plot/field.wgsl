// A field on a periodic mesh as an image: every fragment takes values from the nodes around it and looks the colour
// of their mean up in a table. Values are fractions of the table, so that the host decides in double precision.

struct Image {
    // Left, top, width and height, in pixels of the picture.
    area: vec4f,
    // Nodes along x and y.
    nodes: vec2i,
    // Samples in one pixel along x and y: one at least for every node that falls into it.
    samples: vec2i,
    // Fractions of the table at both ends of the colour bar; what lies beyond takes the colour of the end.
    limits: vec2f,
    interpolation: u32,
    padding: u32,
    // Colour where there is no value, in linear light.
    missing: vec4f,
}

@group(0) @binding(0) var<uniform> image: Image;
// The texel (ky, kx) is the node (kx, ky).
@group(0) @binding(1) var field: texture_2d<f32>;
@group(0) @binding(2) var table: texture_2d<f32>;

const NEAREST: u32 = 0u;
const LINEAR: u32 = 1u;
const CUBIC: u32 = 2u;

// A node without a value holds -1e30.
const LEAST_VALUE: f32 = -1e29;
const NO_VALUE: f32 = -1e30;

@vertex
fn vertex_field(@builtin(vertex_index) vertex: u32) -> @builtin(position) vec4f {
    // The viewport is set to the image, so the quad covers all of it.
    let corner = vec2f(f32(vertex & 1u), f32(vertex >> 1u));
    return vec4f(corner * 2.0 - 1.0, 0.0, 1.0);
}

fn node_value(node: vec2i) -> f32 {
    let wrapped = (node % image.nodes + image.nodes) % image.nodes;
    return textureLoad(field, wrapped.yx, 0).r;
}

fn nearest_value(place: vec2f) -> f32 {
    return node_value(vec2i(floor(place + 0.5)));
}

// Nodes without a value leave their weight to the others, down to the middle between two nodes.
fn linear_value(place: vec2f) -> f32 {
    if nearest_value(place) < LEAST_VALUE {
        return NO_VALUE;
    }
    let below = vec2i(floor(place));
    let t = fract(place);
    var sum = vec2f(0.0);
    for (var i = 0; i < 2; i++) {
        for (var j = 0; j < 2; j++) {
            let value = node_value(below + vec2i(i, j));
            let weight = select(1.0 - t.x, t.x, i == 1) * select(1.0 - t.y, t.y, j == 1);
            if value > LEAST_VALUE {
                sum += weight * vec2f(value, 1.0);
            }
        }
    }
    return sum.x / sum.y;
}

// Keys's cubic convolution: smooth, and exact at the nodes.
fn cubic_weights(t: f32) -> vec4f {
    return vec4f(
        ((-0.5 * t + 1.0) * t - 0.5) * t,
        (1.5 * t - 2.5) * t * t + 1.0,
        ((-1.5 * t + 2.0) * t + 0.5) * t,
        (0.5 * t - 0.5) * t * t,
    );
}

fn cubic_value(place: vec2f) -> f32 {
    let below = vec2i(floor(place));
    let along_x = cubic_weights(fract(place.x));
    let along_y = cubic_weights(fract(place.y));
    var sum = 0.0;
    for (var i = 0; i < 4; i++) {
        for (var j = 0; j < 4; j++) {
            let value = node_value(below + vec2i(i - 1, j - 1));
            if value < LEAST_VALUE {
                return linear_value(place);
            }
            sum += along_x[i] * along_y[j] * value;
        }
    }
    return sum;
}

fn value_at(place: vec2f) -> f32 {
    switch image.interpolation {
        case NEAREST: {
            return nearest_value(place);
        }
        case LINEAR: {
            return linear_value(place);
        }
        default: {
            return cubic_value(place);
        }
    }
}

@fragment
fn fragment_field(@builtin(position) position: vec4f) -> @location(0) vec4f {
    let corner = floor(position.xy) - image.area.xy;
    var sum = 0.0;
    var found = 0;
    for (var row = 0; row < image.samples.y; row++) {
        for (var column = 0; column < image.samples.x; column++) {
            let within = (vec2f(f32(column), f32(row)) + 0.5) / vec2f(image.samples);
            let fraction = (corner + within) / image.area.zw;
            // Pixels count downwards, y upwards.
            let value = value_at(vec2f(fraction.x, 1.0 - fraction.y) * vec2f(image.nodes));
            if value > LEAST_VALUE {
                sum += value;
                found++;
            }
        }
    }
    if 2 * found < image.samples.x * image.samples.y {
        return image.missing;
    }
    let fraction = clamp(sum / f32(found), image.limits.x, image.limits.y);
    let last = f32(textureDimensions(table).x - 1u);
    return textureLoad(table, vec2i(i32(round(fraction * last)), 0), 0);
}
