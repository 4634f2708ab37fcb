//! Pictures of a state as pixels: of particles, of cells, of fields.

use super::colour_ranges::{self, ColourRanges};
use crate::engine::Shown;
use crate::families::pictures::{CellValues, MeshPictures, ShownField, ValueScale};
use crate::families::{Model, PictureKind};
use crate::gpu::Gpu;
use crate::numbers::grouped;
use crate::plot::{
    CellPicture, ColorMap, FieldPicture, ParticlePicture, PeriodicCurve, PlotError, Plotter, ShownValues,
};
use crate::printable;
use crate::scene::{Fields, Scene, Snapshot, SnapshotColor, SnapshotSlice};
use crate::state::{Reported, crossings};
use crate::tessellation::Tessellation;
use image::RgbaImage;

/// The pictures of a scene, from its states.
pub(super) struct Views<'a> {
    gpu: &'a Gpu,
    scene: &'a Scene,
    /// Ranges of colours that pictures of a series share.
    pub ranges: ColourRanges,
    plotter: Option<Plotter<'a>>,
}

impl<'a> Views<'a> {
    pub(super) fn new(gpu: &'a Gpu, scene: &'a Scene, ranges: ColourRanges) -> Self {
        Self { gpu, scene, ranges, plotter: None }
    }

    /// A picture by a plotter that is made once.
    pub(super) fn draw(
        &mut self,
        draw: impl FnOnce(&Plotter<'_>) -> Result<RgbaImage, PlotError>,
    ) -> Result<RgbaImage, PlotError> {
        let plotter = self.plotter.take().map_or_else(|| Plotter::new(self.gpu), Ok);
        plotter.and_then(|plotter| draw(self.plotter.insert(plotter)))
    }

    pub(super) fn snapshot(&mut self, shown: &Shown, model: &Model) -> Option<Result<RgbaImage, PlotError>> {
        let (units, state) = (model.units, &shown.state);
        if model.picture() == PictureKind::Cells {
            return Some(self.cells(state, model));
        }
        // Points on a line show nothing.
        if units.dimension == 1 {
            return None;
        }
        // With layers of frozen particles the picture shows what is behind the walls too.
        let (edges, lengths) = (units.edges(), model.edges_with_layers());
        let place = |position: &[u32; 3]| {
            let place = units.position(*position);
            std::array::from_fn(|axis| place[axis] + 0.5 * (lengths[axis] - edges[axis]))
        };
        let asked = &self.scene.output.snapshot;
        let is_shown = |name: &String| asked.species.is_empty() || asked.species.contains(name);
        let of_species: Vec<bool> = model.species.iter().map(|species| is_shown(&species.name)).collect();
        let mut particles: Vec<usize> =
            (0..state.len()).filter(|&index| of_species.get(state.species[index] as usize) == Some(&true)).collect();
        let sampled = particles.len() as u64;
        if let Some(slice) = asked.slice {
            let axis = slice.axis as usize;
            let is_walled = model.particles().walls.iter().any(|walls| walls.axis == axis);
            let period = (!is_walled).then_some(edges[axis]);
            particles.retain(|&index| slice.holds(units.position(state.positions[index])[axis], period));
        }
        let positions: Vec<[f64; 3]> = particles.iter().map(|&index| place(&state.positions[index])).collect();
        let species: Vec<u32> = particles.iter().map(|&index| state.species[index]).collect();
        let by_speed = self.scene.output.snapshot.color == SnapshotColor::Speed;
        let speed = |&index: &usize| {
            let mass = model.species[state.species[index] as usize].mass;
            units.momentum(state.momenta[index]).iter().map(|component| component * component).sum::<f64>().sqrt()
                / mass
        };
        let speeds: Option<Vec<f64>> = by_speed.then(|| particles.iter().map(speed).collect());
        let names: Vec<String> = model.species.iter().map(|species| species.name.clone()).collect();
        let mut subtitle = at_time(state, model);
        if shown.numbers.is_some() {
            let all: u64 =
                model.species.iter().filter(|species| is_shown(&species.name)).map(|species| species.count).sum();
            let [some, all] = [sampled, all].map(grouped);
            subtitle = format!("{subtitle}; {some} of {all} particles");
        }
        if let Some(SnapshotSlice { axis, position, thickness }) = asked.slice {
            subtitle = format!("{subtitle}; slice at {axis} = {position} ± {}", rounded(0.5 * thickness));
        }
        if !asked.species.is_empty() {
            let names: Vec<_> = asked.species.iter().map(|name| printable::name(name)).collect();
            subtitle = format!("{subtitle}; {} only", names.join(", "));
        }
        let range = speeds.as_ref().map(|speeds| {
            let begin = || colour_ranges::of_speeds(speeds, model.temperature, lightest(model));
            self.ranges.of("speed", asked.range, begin)
        });
        let bonds: Vec<[u32; 2]> = match &model.particles().bonds {
            Some(bonds) if asked.bonds => {
                // A rod knows no copy that is displaced.
                let across = |ends: [usize; 2]| {
                    let [a, b] = ends.map(|end| state.positions[end]);
                    model.particles().shear.is_some_and(|shear| crossings(a, b)[shear.gradient] != 0)
                };
                let ends =
                    bonds.iter().filter_map(|bond| Some([shown.place(bond.ends[0])?, shown.place(bond.ends[1])?]));
                let place = |index: usize| particles.binary_search(&index).ok().map(|place| place as u32);
                let drawn = ends.filter(|ends| !across(*ends));
                drawn.filter_map(|ends| Some([place(ends[0])?, place(ends[1])?])).collect()
            }
            _ => Vec::new(),
        };
        let picture = ParticlePicture {
            dimension: units.dimension as u32,
            lengths,
            positions: &positions,
            species: &species,
            species_names: &names,
            speeds: speeds.as_deref(),
            bonds: &bonds,
            radius: self.scene.output.snapshot.radius.unwrap_or_else(|| radius(model)),
            title: &self.scene.title,
            subtitle: &subtitle,
        };
        let style = Snapshot { range, ..asked.clone() };
        let theme = self.scene.output.plot.theme;
        Some(self.draw(|plotter| plotter.draw_particles(&picture, &style, theme)))
    }

    /// Draws the cells of a tessellation.
    fn cells(&mut self, state: &Reported, model: &Model) -> Result<RgbaImage, PlotError> {
        let units = model.units;
        let lengths = [units.lengths[0], units.lengths[1]];
        let positions: Vec<[f64; 2]> =
            state.positions.iter().map(|position| units.position(*position)).map(|[x, y, _]| [x, y]).collect();
        let tessellation = Tessellation::of_fractions(lengths, &state.positions);
        let color = self.scene.output.snapshot.color;
        let shown = model.physics().cell_values(color, state, &tessellation, model);
        let names: Vec<String> = model.species.iter().map(|species| species.name.clone()).collect();
        let subtitle = at_time(state, model);
        let asked = &self.scene.output.snapshot;
        let temperature = model.temperature;
        let begin = |shown: &CellValues| match shown.scale {
            ValueScale::Speeds => colour_ranges::of_speeds(&shown.values, temperature, lightest(model)),
            ValueScale::Temperatures => colour_ranges::of_temperatures(&shown.values, temperature),
            ValueScale::Densities { mean, molecules } => {
                colour_ranges::of_densities(&shown.values, mean, molecules, temperature > 0.0)
            }
        };
        // A picture alone has the colours that fit it best.
        let range = match &shown {
            Some(shown) if asked.every > 0 => Some(self.ranges.of(shown.label, asked.range, || begin(shown))),
            _ => asked.range,
        };
        let picture = CellPicture {
            lengths,
            positions: &positions,
            tessellation: &tessellation,
            species: &state.species,
            species_names: &names,
            shown: shown.as_ref().map(|shown| ShownValues { label: shown.label, values: &shown.values }),
            title: &self.scene.title,
            subtitle: &subtitle,
        };
        let style = Snapshot { range, ..asked.clone() };
        let theme = self.scene.output.plot.theme;
        self.draw(|plotter| plotter.draw_cells(&picture, &style, theme))
    }

    /// The range of the colours of a field, where it is not that of its values.
    pub(super) fn range_of_field(&mut self, shown: &ShownField, asked: &Fields) -> Option<[f64; 2]> {
        let given = asked.ranges.of(shown.quantity);
        if asked.every == 0 {
            return given;
        }
        let extrema = shown.field.extrema();
        Some(self.ranges.of(shown.described.name, given, || colour_ranges::of_field(extrema, shown.from_zero)))
    }

    /// A field, with the loops of tracers.
    pub(super) fn field(
        &mut self,
        shown: &ShownField,
        pictures: &MeshPictures,
        state: &Reported,
        range: Option<[f64; 2]>,
        model: &Model,
    ) -> Result<RgbaImage, PlotError> {
        let curves: Vec<PeriodicCurve<'_>> =
            pictures.loops.iter().map(|points| PeriodicCurve { points, closed: true }).collect();
        // Pictures of one range have one map.
        let [low, high] = range.or(shown.field.extrema()).unwrap_or_default();
        let centre = shown.centre.filter(|centre| low < *centre && *centre < high);
        let subtitle = at_time(state, model);
        let picture = FieldPicture {
            title: &self.scene.title,
            subtitle: &subtitle,
            map: centre.map_or(ColorMap::Sequential, |centre| ColorMap::Diverging { centre }),
            range,
            curves: &curves,
            ..FieldPicture::new(&shown.field)
        };
        let style = &self.scene.output.plot;
        self.draw(|plotter| plotter.draw_field(&picture, style))
    }
}

/// The time of a state.
fn at_time(state: &Reported, model: &Model) -> String {
    format!("t = {} time units", rounded(model.time.at(state.step)))
}

/// Mass of the lightest species that has particles.
fn lightest(model: &Model) -> f64 {
    let masses = model.species.iter().filter(|species| species.count > 0).map(|species| species.mass);
    masses.fold(f64::INFINITY, f64::min)
}

/// A third of the largest cutoff, or, without one, of the distance between neighbours.
fn radius(model: &Model) -> f64 {
    let spacing = || {
        let volume = model.units.volume() / model.particle_count().max(1) as f64;
        volume.powf(1.0 / model.units.dimension as f64)
    };
    model.particles().pair_force.as_ref().map_or_else(spacing, |force| force.cutoff) / 3.0
}

/// A time without the noise digits of a product: `0.3`, not `0.30000000000000004`.
fn rounded(time: f64) -> f64 {
    format!("{time:.12e}").parse().unwrap_or(time)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn times_read_as_people_write_them() {
        assert_eq!(rounded(0.1 * 3.0).to_string(), "0.3");
        assert_eq!(rounded(1e-9 * 3.0).to_string(), "0.000000003");
        assert_eq!(rounded(80.0).to_string(), "80");
    }
}
