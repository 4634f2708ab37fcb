//! Profiles of density, velocity, temperature and stress along an axis of the box.

use super::{
    Conclusion, Descriptor, Drawn, Gathered, NO_SAMPLE, Part, Planner, Sampling, Setting, SumSampler, species_of,
    total_mass,
};
use crate::engine::Sample;
use crate::families::{Checked, Electrostatics, Model};
use crate::measure::blocks::BlockSums;
use crate::measure::statistics::Estimate;
use crate::measure::stress::Components;
use crate::numbers::grouped;
use crate::plan::Need;
use crate::plot::{Chart, ProfiledSpecies, profiles_chart};
use crate::scene::{self, AnalysisId, Axis, Frame, Output, ProfiledQuantity};
use crate::shaders::analyses::{self, InLayers, Layered, LayeredStress};
use crate::shaders::{Array, Choices, Constant, Entry};
use crate::table::Table;
use serde_json::{Value, json};
use std::f64::consts::{PI, TAU};

/// Names of columns, and of the mean in the result.
const POSITION: &str = "position";
const DENSITY: &str = "number_density";
const VELOCITIES: [&str; 3] = ["velocity_x", "velocity_y", "velocity_z"];
const TEMPERATURE: &str = "temperature";
const PRESSURE: &str = "pressure";
const CHARGE: &str = "charge_density";
const POTENTIAL: &str = "electrostatic_potential";
/// Axes of the components of a tensor.
const COMPONENTS: [[usize; 2]; 6] = [[0, 0], [1, 1], [2, 2], [0, 1], [0, 2], [1, 2]];

/// Profiles along an axis.
pub(super) struct Profiles;

fn shows(asked: &scene::Profiles, quantity: ProfiledQuantity) -> bool {
    asked.quantities.contains(&quantity)
}

fn has_motion(asked: &scene::Profiles) -> bool {
    let counts = [ProfiledQuantity::Density, ProfiledQuantity::Charge];
    asked.quantities.iter().any(|quantity| !counts.contains(quantity))
}

impl Descriptor for Profiles {
    fn asked(&self, scene: &Checked) -> Option<Sampling> {
        let asked = scene.output.profiles.as_ref()?;
        let detail = Some(format!("{} bins along {}", grouped(asked.bins.into()), asked.axis));
        Some(Sampling { detail, ..Sampling::after_equilibration(scene, asked.every) })
    }

    fn needs(&self, output: &Output) -> &'static [Need] {
        match &output.profiles {
            Some(asked) if shows(asked, ProfiledQuantity::Stress) => &[Need::Particles, Need::Momenta, Need::Stresses],
            Some(asked) if has_motion(asked) => &[Need::Particles, Need::Momenta],
            _ => &[Need::Particles],
        }
    }

    fn add_sampler(&self, planner: &mut Planner<'_>) {
        let Some(asked) = &planner.output.profiles else { return };
        let sums = Sums::of(planner.model, asked);
        let mut constants = vec![
            (Constant::Layers, f64::from(asked.bins)),
            (Constant::LayeredAxis, asked.axis as usize as f64),
            (Constant::LayerSums, sums.sampled() as f64),
            (Constant::LayeredSpecies, sums.species as f64),
        ];
        let end = planner.model.units.ends()[asked.axis as usize];
        let mut choices = Choices::new();
        if end > 0 {
            constants.push((Constant::LayerScale, (f64::from(asked.bins) * 2_f64.powi(46) / f64::from(end)).floor()));
        }
        if sums.motion {
            let (velocities, _) = planner.velocities(Some(Frame::Box));
            choices = velocities.with(Layered::Motion).with_if(sums.stress, LayeredStress::Virials);
            let energy = planner.model.units.momentum.powi(2) / planner.plan.quanta.energy;
            constants.push((Constant::LayeredMass, 1.0 / mass_quantum(planner.model)));
            constants.push((Constant::LayeredKinetic, energy));
        }
        let choices =
            choices.with_if(end > 0, analyses::Layers::BetweenWalls).with_if(sums.only.is_some(), InLayers::OfSpecies);
        constants.extend(sums.only.map(|species| (Constant::ProfiledSpecies, species as f64)));
        let (buffers, entries) = ([Array::LayerSums, Array::LayerSamples], asked.bins as usize * sums.sampled());
        let sampler = SumSampler::new(AnalysisId::Profiles, Entry::SumLayers, buffers, entries, asked.every);
        planner.add_counts(&SumSampler { choices, constants, ..sampler }, planner.groups());
    }

    fn parts(&self, scene: &Checked) -> Vec<Part> {
        let asked = scene.output.profiles.iter();
        asked
            .map(|asked| Part::Blocks(BlockSums::new(asked.bins as usize * Sums::of(scene.model(), asked).kept())))
            .collect()
    }

    /// Sums of all layers, one after the other.
    fn numbers_of_sample(&self, setting: &Setting<'_>, sample: &Sample) -> Option<Vec<f64>> {
        let sums = Sums::of(setting.scene.model(), setting.scene.output.profiles.as_ref()?);
        Some(sample.sums.chunks_exact(sums.sampled()).flat_map(|layer| kept(sums, layer, setting)).collect())
    }

    fn conclude(&self, Setting { scene, .. }: &Setting<'_>, gathered: &Gathered) -> Option<Conclusion> {
        let model = scene.model();
        let (asked, blocks) = (scene.output.profiles.as_ref()?, gathered.blocks()?);
        let layers = Layers { asked, model, sums: Sums::of(model, asked), blocks };
        let columns = layers.columns();
        let names = columns.iter().flat_map(|(name, _)| with_error(name));
        let names: Vec<String> = std::iter::once(POSITION.to_owned()).chain(names).collect();
        let bins = asked.bins as usize;
        let width = model.units.edges()[asked.axis as usize] / bins as f64;
        let rows = (0..bins).map(|layer| {
            let found = columns.iter().flat_map(|(_, column)| {
                let found = column(layer);
                let error = found.and_then(|found| found.error);
                [found.map_or(f64::NAN, |found| found.value), error.unwrap_or(f64::NAN)]
            });
            std::iter::once((layer as f64 + 0.5) * width).chain(found).collect()
        });
        let table = Table::new(names, rows.collect());
        let result = if blocks.samples() == 0 {
            Err(NO_SAMPLE.to_owned())
        } else {
            let all: Vec<&str> = model.species.iter().map(|species| species.name.as_str()).collect();
            let species = asked.species.as_ref().map_or_else(|| json!(all), |name| json!(name));
            let mut result = json!({
                "axis": asked.axis,
                "bins": asked.bins,
                "samples": blocks.samples(),
                "species": species,
            });
            if shows(asked, ProfiledQuantity::Temperature) {
                result[TEMPERATURE] = json!(layers.temperature());
            }
            Ok(result)
        };
        // Some errors settle late by chance.
        let is_unsettled = |column: &Number<'_>| {
            let unsettled = |layer: &usize| column(*layer).is_some_and(|found| found.few);
            (0..bins).filter(unsettled).count() * 5 > bins
        };
        let unsettled: Vec<&str> =
            columns.iter().filter(|(_, column)| is_unsettled(column)).map(|(name, _)| name.as_str()).collect();
        let mut warnings = Vec::new();
        if !unsettled.is_empty() {
            let names = unsettled.join(", ");
            warnings.push(format!(
                "the errors in the profiles of {names} are uncertain by more than a quarter and may be larger: the run is \
                 short against correlations"
            ));
        }
        Some(Conclusion { warnings, ..Conclusion::new(table, result) })
    }

    fn species_of(&self, scene: &Checked, numbers: &[usize]) -> Vec<String> {
        species_of(scene, numbers)
    }

    fn chart(&self, drawn: &Drawn<'_>) -> Chart {
        let names = drawn.result["species"].as_array().map(Vec::as_slice).unwrap_or_default();
        let density = |name: &str, column: String, species: &Value| ProfiledSpecies {
            name: name.to_owned(),
            column,
            ink: drawn.ink(&json!({ "species": species })),
        };
        let mut densities = vec![density("all particles", DENSITY.to_owned(), &Value::Null)];
        let of_species =
            |(number, name): (usize, &Value)| density(name.as_str().unwrap_or_default(), density_of(number), name);
        densities.extend(names.iter().enumerate().map(of_species));
        let axis = drawn.scene.output.profiles.as_ref().map_or(Axis::X, |asked| asked.axis).to_string();
        let temperature = Some(drawn.scene.temperature).filter(|temperature| *temperature > 0.0);
        profiles_chart(drawn.title(), &axis, drawn.model.units.dimension, drawn.table, &densities, temperature)
    }

    fn labels(&self) -> &'static [(&'static str, &'static str)] {
        &[("temperature about the flow", TEMPERATURE)]
    }

    fn finds(&self, scene: &Checked) -> Vec<&'static str> {
        let asked = scene.output.profiles.as_ref();
        asked.filter(|asked| shows(asked, ProfiledQuantity::Temperature)).map(|_| TEMPERATURE).into_iter().collect()
    }
}

fn density_of(species: usize) -> String {
    format!("{DENSITY}_{species}")
}

fn with_error(name: &str) -> [String; 2] {
    [name.to_owned(), format!("{name}_error")]
}

/// The value of one unit of the sums of masses: all together are less than 2^62 of them.
fn mass_quantum(model: &Model) -> f64 {
    let total = total_mass(model);
    if total > 0.0 { total.log2().ceil().exp2() * 2_f64.powi(-61) } else { 1.0 }
}

/// What is summed of every layer.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
struct Sums {
    /// The species that it is of; none of all.
    only: Option<usize>,
    species: usize,
    dimension: usize,
    motion: bool,
    stress: bool,
}

impl Sums {
    fn of(model: &Model, asked: &scene::Profiles) -> Self {
        let only = asked.species.as_deref().and_then(|name| model.species_named(name));
        let species = if only.is_some() { 1 } else { model.species.len().max(1) };
        let stress = shows(asked, ProfiledQuantity::Stress);
        Self { only, species, dimension: model.units.dimension, motion: has_motion(asked), stress }
    }

    /// Sums of a layer in a sample: particles of each species, mass, momentum, twice the kinetic energy, and two tensors of six
    /// components: the momentum that is carried, and the virials.
    fn sampled(self) -> usize {
        self.species + if self.motion { self.dimension + 2 } else { 0 } + if self.stress { 12 } else { 0 }
    }

    /// Sums of a layer that are kept: particles of each species, mass, momentum, twice the kinetic energy relative to the centre of
    /// mass of the layer, and the degrees of freedom that it belongs to; then the momentum that is carried and the virials together.
    fn kept(self) -> usize {
        self.freedom() + usize::from(self.motion) + if self.stress { 6 } else { 0 }
    }

    /// The place of the degrees of freedom among those that are kept.
    fn freedom(self) -> usize {
        self.species + if self.motion { self.dimension + 2 } else { 0 }
    }
}

/// A number of a layer.
type Number<'a> = Box<dyn Fn(usize) -> Option<Estimate> + 'a>;

/// The kept sums of a layer. Twice the energy of n particles relative to their centre of mass has d(n - 1) kT.
fn kept(sums: Sums, layer: &[i64], Setting { scene, plan }: &Setting<'_>) -> Vec<f64> {
    let model = scene.model();
    let Sums { only, species, dimension, motion, stress } = sums;
    // Those that are frozen behind walls are in no layer.
    let of = |number: usize| model.species.get(only.unwrap_or(number));
    let is_frozen = |number: usize| of(number).is_some_and(|species| species.frozen);
    let counts = layer.iter().take(species).enumerate();
    let mut row: Vec<f64> = counts.map(|(number, count)| if is_frozen(number) { 0.0 } else { *count as f64 }).collect();
    if !motion {
        return row;
    }
    let is_moving = |number: &usize| of(*number).is_some_and(|species| !species.fixed);
    let moving: f64 = (0..species).filter(is_moving).map(|number| row[number]).sum();
    let mass = layer[species] as f64 * mass_quantum(model);
    let momenta = layer[species + 1..][..dimension].iter();
    let momentum: Vec<f64> = momenta.map(|momentum| *momentum as f64 * model.units.momentum).collect();
    let energy = layer[species + 1 + dimension] as f64 * plan.quanta.energy;
    let of_centre = if mass > 0.0 { momentum.iter().map(|p| p * p).sum::<f64>() / mass } else { 0.0 };
    row.push(mass);
    row.extend(&momentum);
    // A single particle has none, but for rounding.
    let freedom = dimension as f64 * (moving - 1.0).max(0.0);
    row.push(if freedom > 0.0 { energy - of_centre } else { 0.0 });
    row.push(freedom);
    if stress {
        let tensors = &layer[species + dimension + 2..];
        row.extend((0..6).map(|component| {
            tensors[component] as f64 * plan.quanta.energy + tensors[6 + component] as f64 * plan.stress_unit
        }));
    }
    row
}

/// Sums of all layers, one after the other.
struct Layers<'a> {
    asked: &'a scene::Profiles,
    model: &'a Model,
    sums: Sums,
    blocks: &'a BlockSums,
}

impl Layers<'_> {
    /// The mean over samples of a sum of a layer over its volume.
    fn density(&self, of: impl Fn(&[f64]) -> f64, layer: usize) -> Option<Estimate> {
        let first = layer * self.sums.kept();
        let volume = self.model.units.volume() / f64::from(self.asked.bins);
        self.blocks.mean(|row| of(&row[first..]) / volume)
    }

    /// The ratio of two sums of a layer.
    fn ratio(&self, numerator: usize, denominator: usize, layer: usize) -> Option<Estimate> {
        let first = layer * self.sums.kept();
        self.blocks.ratio(|row| row[first + numerator], |row| row[first + denominator])
    }

    /// A component of the mean pressure tensor of a layer: of the momentum relative to the mean velocity u of the layer, Σ m(v - u)(v - u) =
    /// Σ mvv - uP - Pu + uuM, and of the virials.
    fn pressure(&self, component: usize, layer: usize) -> Option<Estimate> {
        let (first, species) = (layer * self.sums.kept(), self.sums.species);
        let place = self.sums.freedom() + 1 + component;
        let axes = COMPONENTS[component].map(|axis| species + 1 + axis);
        let mass = self.blocks.total(first + species);
        let [a, b] = axes.map(|axis| if mass > 0.0 { self.blocks.total(first + axis) / mass } else { 0.0 });
        let of = |sums: &[f64]| sums[place] - a * sums[axes[1]] - b * sums[axes[0]] + a * b * sums[species];
        self.density(of, layer)
    }

    /// Columns of the table with their numbers in a layer.
    fn columns(&self) -> Vec<(String, Number<'_>)> {
        let Sums { species, dimension, .. } = self.sums;
        let mut columns: Vec<(String, Number<'_>)> = Vec::new();
        if shows(self.asked, ProfiledQuantity::Density) {
            let all = move |row: &[f64]| row[..species].iter().sum();
            columns.push((DENSITY.to_owned(), Box::new(move |layer| self.density(all, layer))));
            let is_free = |number: &usize| !self.model.species.get(*number).is_some_and(|species| species.frozen);
            let free = (0..species).filter(is_free).count();
            for number in (0..species).filter(is_free).filter(|_| free > 1) {
                let of = move |row: &[f64]| row[number];
                columns.push((density_of(number), Box::new(move |layer| self.density(of, layer))));
            }
        }
        if shows(self.asked, ProfiledQuantity::Charge) {
            let charge = |layer| self.density(|row| self.charge(row), layer);
            columns.push((CHARGE.to_owned(), Box::new(charge)));
            if let Some(response) = self.response() {
                let potential = move |layer: usize| {
                    let width = self.sums.kept();
                    let at = |(other, row): (usize, &[f64])| response[layer.abs_diff(other)] * self.charge(row);
                    self.blocks.mean(|row| row.chunks_exact(width).enumerate().map(at).sum())
                };
                columns.push((POTENTIAL.to_owned(), Box::new(potential)));
            }
        }
        if shows(self.asked, ProfiledQuantity::Velocity) {
            for (axis, name) in VELOCITIES.into_iter().take(dimension).enumerate() {
                let ratio = move |layer| self.ratio(species + 1 + axis, species, layer);
                columns.push((name.to_owned(), Box::new(ratio)));
            }
        }
        if shows(self.asked, ProfiledQuantity::Temperature) {
            let [thermal, freedom] = [1, 2].map(|place| species + dimension + place);
            columns.push((TEMPERATURE.to_owned(), Box::new(move |layer| self.ratio(thermal, freedom, layer))));
        }
        if shows(self.asked, ProfiledQuantity::Stress) {
            for (name, component) in Components::of(dimension).iter() {
                columns.push((format!("{PRESSURE}_{name}"), Box::new(move |layer| self.pressure(component, layer))));
            }
        }
        columns
    }

    /// The charge of the particles of a layer.
    fn charge(&self, row: &[f64]) -> f64 {
        self.model.species.iter().zip(row).map(|(species, count)| species.charge * count).sum()
    }

    /// The potential of a layer by a unit charge in another, by their distance in layers: for Gaussian clouds `4π kT lB/(A L) Σ_k e^(-k²σ²/2)
    /// cos(kz)/k²` over the waves that layers resolve; none where charges do not act on each other.
    fn response(&self) -> Option<Vec<f64>> {
        let Electrostatics { strength, cloud, .. } = self.model.particles().electrostatics.as_ref()?;
        let (bins, length) = (self.asked.bins, self.model.units.lengths[self.asked.axis as usize]);
        let over_volume = 4.0 * PI * strength / self.model.units.volume();
        let of_wave = |wave: u32, layers: u32| {
            let number = TAU * f64::from(wave) / length;
            // The shortest wave of an even number of layers is its own mirror image.
            let images = if 2 * wave == bins { 1.0 } else { 2.0 };
            let phase = TAU * f64::from(wave) * f64::from(layers) / f64::from(bins);
            images * cloud.spectrum_of_one(number) * phase.cos() / (number * number)
        };
        let at = |layers| over_volume * (1..=bins / 2).map(|wave| of_wave(wave, layers)).sum::<f64>();
        Some((0..bins).map(at).collect())
    }

    /// The temperature of all layers together.
    fn temperature(&self) -> Option<Estimate> {
        let (width, freedom) = (self.sums.kept(), self.sums.freedom());
        let sum = move |place: usize| move |row: &[f64]| row.iter().skip(place).step_by(width).sum::<f64>();
        self.blocks.ratio(sum(freedom - 1), sum(freedom))
    }
}
