//! The device side of particles: spheres and discs drawn enlarged, then laid over the picture.

use super::palette::linear;
use super::particles::{ParticleInstance, RodInstance, SphereScene};
use super::pipelines::{DEPTH_FORMAT, ENLARGED_FORMAT, Page, Painter, Target, view};
use bytemuck::{Pod, Zeroable};

/// Side of the texture that particles are drawn into, larger than life; a big picture takes several turns.
const TILE_SIDE: u32 = 2048;
/// Instances in one vertex buffer: 16 or 28 bytes each, far below the smallest permitted buffer limit.
const INSTANCES_PER_BUFFER: usize = 1 << 21;

#[repr(C)]
#[derive(Clone, Copy, Pod, Zeroable)]
struct Placement {
    origin: [i32; 2],
    samples: i32,
    padding: i32,
}

/// The camera of `spheres.wgsl`.
#[repr(C)]
#[derive(Clone, Copy, Pod, Zeroable)]
struct Camera {
    right: [f32; 4],
    up: [f32; 4],
    toward: [f32; 4],
    centre_and_size: [f32; 4],
    fog: [f32; 4],
    look: [f32; 4],
    rods: [f32; 4],
}

/// Instances of one kind on the device, and how they are drawn.
struct Drawn<'a> {
    pipeline: &'a wgpu::RenderPipeline,
    buffers: Vec<(wgpu::Buffer, u32)>,
}

const SPHERES: Page = ("plot/spheres.wgsl", include_str!("../../shaders/plot/spheres.wgsl"));
const COMPOSITE: Page = ("plot/composite.wgsl", include_str!("../../shaders/plot/composite.wgsl"));

pub(super) fn spheres_pipeline(painter: &Painter) -> wgpu::RenderPipeline {
    let attributes = wgpu::vertex_attr_array![0 => Float32x3, 1 => Unorm8x4];
    let entry_points = ["vertex_sphere", "fragment_sphere"];
    painter.pipeline::<ParticleInstance>("plot: particles", SPHERES, entry_points, &attributes, Target::Enlarged)
}

pub(super) fn rods_pipeline(painter: &Painter) -> wgpu::RenderPipeline {
    let attributes = wgpu::vertex_attr_array![0 => Float32x3, 1 => Float32x3, 2 => Unorm8x4];
    let entry_points = ["vertex_rod", "fragment_rod"];
    painter.pipeline::<RodInstance>("plot: bonds", SPHERES, entry_points, &attributes, Target::Enlarged)
}

pub(super) fn composite_pipeline(painter: &Painter) -> wgpu::RenderPipeline {
    let entry_points = ["vertex_composite", "fragment_composite"];
    painter.pipeline::<()>("plot: overlay", COMPOSITE, entry_points, &[], Target::Picture)
}

/// Draws the particles and their bonds enlarged, tile by tile, and lays each tile over the picture; of the picture they take the
/// part with this left, top, width and height.
pub(super) fn draw_spheres(
    painter: &Painter,
    [spheres, composite]: [&wgpu::RenderPipeline; 2],
    rods: Option<&wgpu::RenderPipeline>,
    scene: &SphereScene,
    [left, top, width, height]: [u32; 4],
    picture: &wgpu::TextureView,
) {
    if scene.particles.is_empty() {
        return;
    }
    let samples = scene.samples;
    let tile = TILE_SIDE / samples;
    let size = [width, height].map(|side| side.min(tile) * samples);
    let texture = |label, format, usage| {
        view(&painter.texture(label, size, format, wgpu::TextureUsages::RENDER_ATTACHMENT | usage), label)
    };
    let colour = texture("plot: particles", ENLARGED_FORMAT, wgpu::TextureUsages::TEXTURE_BINDING);
    let depth = texture("plot: depth of particles", DEPTH_FORMAT, wgpu::TextureUsages::empty());
    let mut drawn = vec![Drawn { pipeline: spheres, buffers: buffers(painter, &scene.particles) }];
    if let Some(pipeline) = rods {
        drawn.push(Drawn { pipeline, buffers: buffers(painter, &scene.rods) });
    }
    for tile_top in (top..top + height).step_by(tile as usize) {
        for tile_left in (left..left + width).step_by(tile as usize) {
            let camera = painter.uniform("plot: camera", &camera(scene, [tile_left, tile_top], size));
            painter.paint("plot: particles", &colour, Some(wgpu::Color::TRANSPARENT), Some(&depth), |pass| {
                for Drawn { pipeline, buffers } in &drawn {
                    let group = painter.bind_group("plot: camera", pipeline, [camera.as_entire_binding()]);
                    pass.set_pipeline(pipeline);
                    pass.set_bind_group(0, &group, &[]);
                    for (buffer, count) in buffers {
                        pass.set_vertex_buffer(0, buffer.slice(..));
                        pass.draw(0..4, 0..*count);
                    }
                }
            });
            let origin = [tile_left as i32, tile_top as i32];
            let placement = Placement { origin, samples: samples as i32, padding: 0 };
            let placement = painter.uniform("plot: placement", &placement);
            let resources = [placement.as_entire_binding(), wgpu::BindingResource::TextureView(&colour)];
            let group = painter.bind_group("plot: overlay", composite, resources);
            let [x, y] = [tile_left, tile_top].map(|pixel| pixel as f32);
            let tile_size = [tile.min(left + width - tile_left), tile.min(top + height - tile_top)];
            let [tile_width, tile_height] = tile_size.map(|side| side as f32);
            painter.paint("plot: overlay", picture, None, None, |pass| {
                pass.set_pipeline(composite);
                pass.set_bind_group(0, &group, &[]);
                pass.set_viewport(x, y, tile_width, tile_height, 0.0, 1.0);
                pass.draw(0..4, 0..1);
            });
        }
    }
}

fn buffers<T: Pod>(painter: &Painter, instances: &[T]) -> Vec<(wgpu::Buffer, u32)> {
    let filled = |chunk: &[T]| {
        let bytes = bytemuck::cast_slice(chunk);
        (painter.filled_buffer("plot: particles", bytes, wgpu::BufferUsages::VERTEX), chunk.len() as u32)
    };
    instances.chunks(INSTANCES_PER_BUFFER).map(filled).collect()
}

fn camera(scene: &SphereScene, tile: [u32; 2], target: [u32; 2]) -> Camera {
    let samples = scene.samples as f32;
    let with = |vector: [f64; 3], last: f64| [vector[0] as f32, vector[1] as f32, vector[2] as f32, last as f32];
    let scale = scene.pixels_per_length * f64::from(scene.samples);
    let fog = |channel: usize| linear(scene.paper[channel]).sqrt();
    Camera {
        right: with(scene.right, scale),
        up: with(scene.up, 0.0),
        toward: with(scene.toward, scene.half_depth),
        centre_and_size: [
            (scene.centre[0] as f32 - tile[0] as f32) * samples,
            (scene.centre[1] as f32 - tile[1] as f32) * samples,
            target[0] as f32,
            target[1] as f32,
        ],
        fog: [fog(0), fog(1), fog(2), scene.fog as f32],
        look: [scene.radius as f32, (scene.radius * scale) as f32, scene.lighting as f32, scene.rim as f32],
        rods: [scene.rod_radius as f32, (scene.rod_radius * scale) as f32, 0.0, 0.0],
    }
}
