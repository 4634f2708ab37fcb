//! The device side of a field: its values and colours as textures, drawn into the place of the image.

use super::field::FieldScene;
use super::palette::linear;
use super::pipelines::{Page, Painter, Target};
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

const FIELD: Page = ("plot/field.wgsl", include_str!("../../shaders/plot/field.wgsl"));

pub(super) fn field_pipeline(painter: &Painter) -> wgpu::RenderPipeline {
    painter.pipeline::<()>("plot: field", FIELD, ["vertex_field", "fragment_field"], &[], Target::Picture)
}

/// Draws the image of a field into a picture; `clip` is its part inside the picture: left, top, width, height.
pub(super) fn draw_field(
    painter: &Painter,
    pipeline: &wgpu::RenderPipeline,
    scene: &FieldScene,
    [x, y, width, height]: [u32; 4],
    view: &wgpu::TextureView,
) {
    let [kx, ky] = scene.nodes;
    let fractions = bytemuck::cast_slice(&scene.fractions);
    let values = painter.filled_texture("plot: field", [ky, kx], wgpu::TextureFormat::R32Float, fractions);
    // Read back as linear light and written as sRGB again: the same bytes.
    let (colours, table) = (scene.table.len() as u32, bytemuck::cast_slice(&scene.table));
    let table = painter.filled_texture("plot: colours", [colours, 1], wgpu::TextureFormat::Rgba8UnormSrgb, table);
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
    let uniform = painter.uniform("plot: image", &image);
    let textures = [&values, &table].map(wgpu::BindingResource::TextureView);
    let resources = std::iter::once(uniform.as_entire_binding()).chain(textures);
    let group = painter.bind_group("plot: field", pipeline, resources);
    painter.paint("plot: field", view, None, None, |pass| {
        pass.set_pipeline(pipeline);
        pass.set_bind_group(0, &group, &[]);
        pass.set_scissor_rect(x, y, width, height);
        pass.draw(0..4, 0..1);
    });
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, clippy::panic)]
    use super::*;
    use std::mem::offset_of;

    #[test]
    fn the_uniform_lies_as_in_the_shader() {
        let shader = naga::front::wgsl::parse_str(FIELD.1).unwrap();
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
