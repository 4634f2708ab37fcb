//! The device side of particles: spheres and discs drawn enlarged, then laid over the picture.

use super::canvas::Area;
use super::error::PlotError;
use super::particles::{ParticleInstance, RodInstance};
use super::pipelines::{DEPTH_FORMAT, ENLARGED_FORMAT, Page, Target, draw_instances, view};
use super::renderer::{Content, Plotter};
use bytemuck::{Pod, Zeroable};

/// Side of the texture that particles are drawn into, larger than life; a big picture takes several turns.
const TILE_SIDE: u32 = 2048;

/// The camera of `spheres.wgsl`.
#[repr(C)]
#[derive(Clone, Copy, Default, Pod, Zeroable)]
pub(super) struct Camera {
    pub right: [f32; 4],
    pub up: [f32; 4],
    pub toward: [f32; 4],
    /// Set for every tile.
    pub centre_and_size: [f32; 4],
    pub fog: [f32; 4],
    pub look: [f32; 4],
    pub rods: [f32; 4],
}

/// Particles and the view of them.
pub(super) struct SphereScene {
    pub particles: Vec<ParticleInstance>,
    pub rods: Vec<RodInstance>,
    pub camera: Camera,
    /// Where the centre of the box lies, in pixels.
    pub centre: [f64; 2],
    /// Part of the picture that particles may cover.
    pub area: Area,
    /// Side of the square of samples per pixel.
    pub samples: u32,
}

const SPHERES: Page = ("plot/spheres.wgsl", include_str!("../../shaders/plot/spheres.wgsl"));
const COMPOSITE: Page = ("plot/composite.wgsl", include_str!("../../shaders/plot/composite.wgsl"));

fn spheres_pipeline(plotter: &Plotter<'_>) -> wgpu::RenderPipeline {
    let attributes = wgpu::vertex_attr_array![0 => Float32x3, 1 => Unorm8x4];
    let entry_points = ["vertex_sphere", "fragment_sphere"];
    plotter.pipeline::<ParticleInstance>("plot: particles", SPHERES, entry_points, &attributes, Target::Enlarged)
}

fn rods_pipeline(plotter: &Plotter<'_>) -> wgpu::RenderPipeline {
    let attributes = wgpu::vertex_attr_array![0 => Float32x3, 1 => Float32x3, 2 => Unorm8x4];
    let entry_points = ["vertex_rod", "fragment_rod"];
    plotter.pipeline::<RodInstance>("plot: bonds", SPHERES, entry_points, &attributes, Target::Enlarged)
}

fn composite_pipeline(plotter: &Plotter<'_>) -> wgpu::RenderPipeline {
    let entry_points = ["vertex_composite", "fragment_composite"];
    plotter.pipeline::<()>("plot: overlay", COMPOSITE, entry_points, &[], Target::Picture)
}

impl Content for SphereScene {
    fn area(&self) -> Area {
        self.area
    }

    /// Draws the particles and their bonds enlarged, tile by tile, and lays each tile over the picture.
    fn draw(&self, plotter: &Plotter<'_>, clip: [u32; 4], picture: &wgpu::TextureView) -> Result<(), PlotError> {
        if self.particles.is_empty() {
            return Ok(());
        }
        let spheres = plotter.once(&plotter.spheres, "pipeline of the particles", spheres_pipeline)?;
        let composite = plotter.once(&plotter.composite, "pipeline of the overlay", composite_pipeline)?;
        let bonded = !self.rods.is_empty();
        let rods = bonded.then(|| plotter.once(&plotter.rods, "pipeline of the bonds", rods_pipeline)).transpose()?;
        plotter.checked("particles", || {
            let rods = rods.map(|rods| (rods, plotter.instances("plot: bonds", &self.rods)));
            let particles = (spheres, plotter.instances("plot: particles", &self.particles));
            let drawn: Vec<_> = [particles].into_iter().chain(rods).collect();
            let [left, top, width, height] = clip;
            let tile = TILE_SIDE / self.samples;
            let size = [width, height].map(|side| side.min(tile) * self.samples);
            let texture = |label, format, usage| {
                view(&plotter.texture(label, size, format, wgpu::TextureUsages::RENDER_ATTACHMENT | usage), label)
            };
            let colour = texture("plot: particles", ENLARGED_FORMAT, wgpu::TextureUsages::TEXTURE_BINDING);
            let depth = texture("plot: depth of particles", DEPTH_FORMAT, wgpu::TextureUsages::empty());
            for tile_top in (top..top + height).step_by(tile as usize) {
                for tile_left in (left..left + width).step_by(tile as usize) {
                    let camera = plotter.uniform("plot: camera", &self.camera([tile_left, tile_top], size));
                    plotter.pass("plot: particles", &colour, Some(wgpu::Color::TRANSPARENT), Some(&depth), |pass| {
                        for (pipeline, instances) in &drawn {
                            plotter.bind(pass, "plot: camera", pipeline, [camera.as_entire_binding()]);
                            draw_instances(pass, instances);
                        }
                    });
                    // The origin, the samples, and what fills the uniform up.
                    let placement = [tile_left, tile_top, self.samples, 0].map(|number| number as i32);
                    let placement = plotter.uniform("plot: placement", &placement);
                    let [x, y] = [tile_left, tile_top].map(|pixel| pixel as f32);
                    let tile_size = [tile.min(left + width - tile_left), tile.min(top + height - tile_top)];
                    let [tile_width, tile_height] = tile_size.map(|side| side as f32);
                    plotter.pass("plot: overlay", picture, None, None, |pass| {
                        let resources = [placement.as_entire_binding(), wgpu::BindingResource::TextureView(&colour)];
                        plotter.bind(pass, "plot: overlay", composite, resources);
                        pass.set_viewport(x, y, tile_width, tile_height, 0.0, 1.0);
                        pass.draw(0..4, 0..1);
                    });
                }
            }
        })
    }
}

impl SphereScene {
    /// The camera of a tile that begins at a pixel of the picture and is drawn into a target of a size.
    fn camera(&self, tile: [u32; 2], target: [u32; 2]) -> Camera {
        let samples = self.samples as f32;
        let [x, y] = [0, 1].map(|axis| (self.centre[axis] as f32 - tile[axis] as f32) * samples);
        Camera { centre_and_size: [x, y, target[0] as f32, target[1] as f32], ..self.camera }
    }
}
