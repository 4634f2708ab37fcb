//! The device side of a field: its values and colours as textures, drawn into the place of the image.

use super::field::FieldScene;
use super::palette::linear;
use super::pipelines::{Target, colour_attachment, module, pipeline};
use bytemuck::{Pod, Zeroable};

/// The uniform of `field.wgsl`.
#[repr(C)]
#[derive(Clone, Copy, Pod, Zeroable)]
struct Image {
    area: [f32; 4],
    nodes: [i32; 2],
    samples: [i32; 2],
    limits: [f32; 2],
    interpolation: u32,
    padding: u32,
    missing: [f32; 4],
}

const SHADER: &str = include_str!("../../shaders/plot/field.wgsl");

pub(super) fn field_pipeline(device: &wgpu::Device) -> wgpu::RenderPipeline {
    let module = module(device, "plot/field.wgsl", SHADER);
    pipeline(device, "plot: field", &module, ["vertex_field", "fragment_field"], None, Target::Picture)
}

/// Draws the image of a field into a picture; `clip` is its part inside the picture: left, top, width, height.
pub(super) fn draw_field(
    device: &wgpu::Device,
    queue: &wgpu::Queue,
    pipeline: &wgpu::RenderPipeline,
    scene: &FieldScene,
    clip: [u32; 4],
    view: &wgpu::TextureView,
) {
    let [kx, ky] = scene.nodes;
    let values = bytemuck::cast_slice(&scene.fractions);
    let values = texture(device, queue, "plot: field", wgpu::TextureFormat::R32Float, [ky, kx], values);
    // Read back as linear light and written as sRGB again: the same bytes.
    let table = bytemuck::cast_slice(&scene.table);
    let colours = scene.table.len() as u32;
    let table = texture(device, queue, "plot: colours", wgpu::TextureFormat::Rgba8UnormSrgb, [colours, 1], table);
    let missing = scene.missing;
    let image = Image {
        area: scene.area.map(|pixels| pixels as f32),
        nodes: scene.nodes.map(|nodes| nodes as i32),
        samples: scene.samples.map(|samples| samples as i32),
        limits: scene.limits.map(|limit| limit as f32),
        interpolation: scene.interpolation,
        padding: 0,
        missing: [linear(missing[0]), linear(missing[1]), linear(missing[2]), 1.0],
    };
    let uniform = device.create_buffer(&wgpu::BufferDescriptor {
        label: Some("plot: image"),
        size: size_of::<Image>() as u64,
        usage: wgpu::BufferUsages::UNIFORM | wgpu::BufferUsages::COPY_DST,
        mapped_at_creation: false,
    });
    queue.write_buffer(&uniform, 0, bytemuck::bytes_of(&image));
    let group = device.create_bind_group(&wgpu::BindGroupDescriptor {
        label: Some("plot: field"),
        layout: &pipeline.get_bind_group_layout(0),
        entries: &[
            wgpu::BindGroupEntry { binding: 0, resource: uniform.as_entire_binding() },
            wgpu::BindGroupEntry { binding: 1, resource: wgpu::BindingResource::TextureView(&values) },
            wgpu::BindGroupEntry { binding: 2, resource: wgpu::BindingResource::TextureView(&table) },
        ],
    });
    let mut encoder = device.create_command_encoder(&wgpu::CommandEncoderDescriptor { label: Some("plot: field") });
    {
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("plot: field"),
            color_attachments: &[Some(colour_attachment(view, None))],
            ..Default::default()
        });
        let [x, y, width, height] = clip;
        pass.set_pipeline(pipeline);
        pass.set_bind_group(0, &group, &[]);
        pass.set_scissor_rect(x, y, width, height);
        pass.draw(0..4, 0..1);
    }
    queue.submit([encoder.finish()]);
}

fn texture(
    device: &wgpu::Device,
    queue: &wgpu::Queue,
    label: &str,
    format: wgpu::TextureFormat,
    [width, height]: [u32; 2],
    bytes: &[u8],
) -> wgpu::TextureView {
    let size = wgpu::Extent3d { width, height, depth_or_array_layers: 1 };
    let texture = device.create_texture(&wgpu::TextureDescriptor {
        label: Some(label),
        size,
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format,
        usage: wgpu::TextureUsages::TEXTURE_BINDING | wgpu::TextureUsages::COPY_DST,
        view_formats: &[],
    });
    // Both formats hold four bytes a texel.
    let layout = wgpu::TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(4 * width), rows_per_image: None };
    queue.write_texture(texture.as_image_copy(), bytes, layout, size);
    texture.create_view(&wgpu::TextureViewDescriptor { label: Some("plot: field"), ..Default::default() })
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, clippy::panic)]
    use super::*;
    use std::mem::offset_of;

    #[test]
    fn the_uniform_lies_as_in_the_shader() {
        let shader = naga::front::wgsl::parse_str(SHADER).unwrap();
        let (_, image) = shader.types.iter().find(|(_, kind)| kind.name.as_deref() == Some("Image")).unwrap();
        let naga::TypeInner::Struct { members, span } = &image.inner else { panic!("Image is a struct") };
        let found: Vec<(&str, usize)> =
            members.iter().map(|member| (member.name.as_deref().unwrap(), member.offset as usize)).collect();
        let expected = [
            ("area", offset_of!(Image, area)),
            ("nodes", offset_of!(Image, nodes)),
            ("samples", offset_of!(Image, samples)),
            ("limits", offset_of!(Image, limits)),
            ("interpolation", offset_of!(Image, interpolation)),
            ("padding", offset_of!(Image, padding)),
            ("missing", offset_of!(Image, missing)),
        ];
        assert_eq!(found, expected);
        assert_eq!(*span as usize, size_of::<Image>());
    }
}
