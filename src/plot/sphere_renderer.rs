//! The device side of particles: spheres and discs drawn enlarged, then laid over the picture.

use super::palette::linear;
use super::particles::{ParticleInstance, RodInstance, SphereScene};
use super::pipelines::{
    DEPTH_FORMAT, ENLARGED_FORMAT, Target, colour_attachment, filled_buffer, labelled, module, pipeline, uniform,
};
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

pub(super) fn spheres_pipeline(device: &wgpu::Device) -> wgpu::RenderPipeline {
    let module = module(device, "plot/spheres.wgsl", include_str!("../../shaders/plot/spheres.wgsl"));
    let instance = wgpu::VertexBufferLayout {
        array_stride: size_of::<ParticleInstance>() as u64,
        step_mode: wgpu::VertexStepMode::Instance,
        attributes: &wgpu::vertex_attr_array![0 => Float32x3, 1 => Unorm8x4],
    };
    pipeline(device, "plot: particles", &module, ["vertex_sphere", "fragment_sphere"], Some(instance), Target::Enlarged)
}

pub(super) fn rods_pipeline(device: &wgpu::Device) -> wgpu::RenderPipeline {
    let module = module(device, "plot/spheres.wgsl", include_str!("../../shaders/plot/spheres.wgsl"));
    let instance = wgpu::VertexBufferLayout {
        array_stride: size_of::<RodInstance>() as u64,
        step_mode: wgpu::VertexStepMode::Instance,
        attributes: &wgpu::vertex_attr_array![0 => Float32x3, 1 => Float32x3, 2 => Unorm8x4],
    };
    pipeline(device, "plot: bonds", &module, ["vertex_rod", "fragment_rod"], Some(instance), Target::Enlarged)
}

pub(super) fn composite_pipeline(device: &wgpu::Device) -> wgpu::RenderPipeline {
    let module = module(device, "plot/composite.wgsl", include_str!("../../shaders/plot/composite.wgsl"));
    pipeline(device, "plot: overlay", &module, ["vertex_composite", "fragment_composite"], None, Target::Picture)
}

/// Draws the particles and their bonds enlarged, tile by tile, and lays each tile over the picture; of the picture they take the
/// part with this left, top, width and height.
pub(super) fn draw_spheres(
    device: &wgpu::Device,
    queue: &wgpu::Queue,
    [spheres, composite]: [&wgpu::RenderPipeline; 2],
    rods: Option<&wgpu::RenderPipeline>,
    scene: &SphereScene,
    [left, top, width, height]: [u32; 4],
    view: &wgpu::TextureView,
) {
    if scene.particles.is_empty() {
        return;
    }
    let samples = scene.samples;
    let tile = TILE_SIDE / samples;
    let texture_size = wgpu::Extent3d {
        width: width.min(tile) * samples,
        height: height.min(tile) * samples,
        depth_or_array_layers: 1,
    };
    let texture = |label, format, usage| {
        let texture = device.create_texture(&wgpu::TextureDescriptor {
            label: Some(label),
            size: texture_size,
            mip_level_count: 1,
            sample_count: 1,
            dimension: wgpu::TextureDimension::D2,
            format,
            usage: wgpu::TextureUsages::RENDER_ATTACHMENT | usage,
            view_formats: &[],
        });
        texture.create_view(&labelled(label))
    };
    let colour = texture("plot: particles", ENLARGED_FORMAT, wgpu::TextureUsages::TEXTURE_BINDING);
    let depth = texture("plot: depth of particles", DEPTH_FORMAT, wgpu::TextureUsages::empty());
    let mut drawn = vec![Drawn { pipeline: spheres, buffers: buffers(device, queue, &scene.particles) }];
    if let Some(pipeline) = rods {
        drawn.push(Drawn { pipeline, buffers: buffers(device, queue, &scene.rods) });
    }
    for tile_top in (top..top + height).step_by(tile as usize) {
        for tile_left in (left..left + width).step_by(tile as usize) {
            let tile_size = [tile.min(left + width - tile_left), tile.min(top + height - tile_top)];
            let mut encoder =
                device.create_command_encoder(&wgpu::CommandEncoderDescriptor { label: Some("plot: shapes") });
            let camera = camera(scene, [tile_left, tile_top], [texture_size.width, texture_size.height]);
            enlarged_pass(device, queue, &drawn, &mut encoder, &camera, [&colour, &depth]);
            let placement =
                Placement { origin: [tile_left as i32, tile_top as i32], samples: samples as i32, padding: 0 };
            composite_pass(device, queue, composite, &mut encoder, &placement, tile_size, [&colour, view]);
            queue.submit([encoder.finish()]);
        }
    }
}

fn buffers<T: Pod>(device: &wgpu::Device, queue: &wgpu::Queue, instances: &[T]) -> Vec<(wgpu::Buffer, u32)> {
    let filled = |chunk: &[T]| {
        let bytes = bytemuck::cast_slice(chunk);
        (filled_buffer(device, queue, "plot: particles", bytes, wgpu::BufferUsages::VERTEX), chunk.len() as u32)
    };
    instances.chunks(INSTANCES_PER_BUFFER).map(filled).collect()
}

fn enlarged_pass(
    device: &wgpu::Device,
    queue: &wgpu::Queue,
    drawn: &[Drawn<'_>],
    encoder: &mut wgpu::CommandEncoder,
    camera: &Camera,
    [colour, depth]: [&wgpu::TextureView; 2],
) {
    let camera = uniform(device, queue, "plot: camera", camera);
    let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
        label: Some("plot: particles"),
        color_attachments: &[Some(colour_attachment(colour, Some(wgpu::Color::TRANSPARENT)))],
        depth_stencil_attachment: Some(wgpu::RenderPassDepthStencilAttachment {
            view: depth,
            depth_ops: Some(wgpu::Operations { load: wgpu::LoadOp::Clear(1.0), store: wgpu::StoreOp::Discard }),
            stencil_ops: None,
        }),
        ..Default::default()
    });
    for Drawn { pipeline, buffers } in drawn {
        let group = device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("plot: camera"),
            layout: &pipeline.get_bind_group_layout(0),
            entries: &[wgpu::BindGroupEntry { binding: 0, resource: camera.as_entire_binding() }],
        });
        pass.set_pipeline(pipeline);
        pass.set_bind_group(0, &group, &[]);
        for (buffer, count) in buffers {
            pass.set_vertex_buffer(0, buffer.slice(..));
            pass.draw(0..4, 0..*count);
        }
    }
}

fn composite_pass(
    device: &wgpu::Device,
    queue: &wgpu::Queue,
    pipeline: &wgpu::RenderPipeline,
    encoder: &mut wgpu::CommandEncoder,
    placement: &Placement,
    size: [u32; 2],
    [enlarged, view]: [&wgpu::TextureView; 2],
) {
    let group = device.create_bind_group(&wgpu::BindGroupDescriptor {
        label: Some("plot: overlay"),
        layout: &pipeline.get_bind_group_layout(0),
        entries: &[
            wgpu::BindGroupEntry {
                binding: 0,
                resource: uniform(device, queue, "plot: placement", placement).as_entire_binding(),
            },
            wgpu::BindGroupEntry { binding: 1, resource: wgpu::BindingResource::TextureView(enlarged) },
        ],
    });
    let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
        label: Some("plot: overlay"),
        color_attachments: &[Some(colour_attachment(view, None))],
        ..Default::default()
    });
    let [x, y] = placement.origin.map(|pixel| pixel as f32);
    pass.set_pipeline(pipeline);
    pass.set_bind_group(0, &group, &[]);
    pass.set_viewport(x, y, size[0] as f32, size[1] as f32, 0.0, 1.0);
    pass.draw(0..4, 0..1);
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
