//! The device side of a field: its values and colours as textures, drawn into the place of the image.

use super::canvas::Area;
use super::error::PlotError;
use super::palette::Colour;
use super::pipelines::{Page, Target};
use super::renderer::{Content, Plotter};
use bytemuck::{Pod, Zeroable};

/// The uniform of `field.wgsl`.
#[repr(C)]
#[derive(Clone, Copy, Pod, Zeroable)]
pub(super) struct Image {
    /// Left, top, width and height in pixels.
    pub area: [f32; 4],
    /// Nodes along x and y.
    pub nodes: [i32; 2],
    pub samples: [i32; 2],
    pub limits: [f32; 2],
    pub interpolation: u32,
    pub padding: u32,
    /// Colour where there is no value, in linear light.
    pub missing: [f32; 4],
}

/// The image of a field.
pub(super) struct FieldScene {
    pub image: Image,
    /// One fraction of the table per node, in the order of [`Field::values`](crate::measure::Field::values).
    pub fractions: Vec<f32>,
    pub table: Vec<Colour>,
}

const FIELD: Page = ("plot/field.wgsl", include_str!("../../shaders/plot/field.wgsl"));

impl Content for FieldScene {
    /// In a picture too small for its type the image may stand out of it.
    fn area(&self) -> Area {
        let [left, top, width, height] = self.image.area.map(f64::from);
        Area { left, top, right: left + width, bottom: top + height }
    }

    fn draw(
        &self,
        plotter: &Plotter<'_>,
        [x, y, width, height]: [u32; 4],
        picture: &wgpu::TextureView,
    ) -> Result<(), PlotError> {
        let pipeline = plotter.once(&plotter.field, "pipeline of the fields", |plotter| {
            plotter.pipeline::<()>("plot: field", FIELD, ["vertex_field", "fragment_field"], &[], Target::Picture)
        })?;
        plotter.checked("field", || {
            let [kx, ky] = self.image.nodes.map(|nodes| nodes as u32);
            let fractions = bytemuck::cast_slice(&self.fractions);
            let values = plotter.filled_texture("plot: field", [ky, kx], wgpu::TextureFormat::R32Float, fractions);
            // Read back as linear light and written as sRGB again: the same bytes.
            let (size, table) = ([self.table.len() as u32, 1], bytemuck::cast_slice(&self.table));
            let table = plotter.filled_texture("plot: colours", size, wgpu::TextureFormat::Rgba8UnormSrgb, table);
            let image = plotter.uniform("plot: image", &self.image);
            plotter.pass("plot: field", picture, None, None, |pass| {
                let textures = [&values, &table].map(wgpu::BindingResource::TextureView);
                let resources = std::iter::once(image.as_entire_binding()).chain(textures);
                plotter.bind(pass, "plot: field", pipeline, resources);
                pass.set_scissor_rect(x, y, width, height);
                pass.draw(0..4, 0..1);
            });
        })
    }
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
