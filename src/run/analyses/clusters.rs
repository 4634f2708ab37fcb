//! Clusters of particles that are close to each other.

use super::{Conclusion, Descriptor, Drawn, Gathered, NO_SAMPLE, Part, Sampling, Setting, mean, of_species};
use crate::families::{Bonds, Checked, Model, close_pairs};
use crate::measure::statistics::estimate;
use crate::plot::{Axis, Chart, Panel, Series, SeriesInk};
use crate::scene;
use crate::state::Reported;
use crate::table::Table;
use serde_json::json;

/// Columns of the table over time, and names in the result.
const COLUMNS: [&str; 4] = ["clusters", "mean_size", "weighted_size", "largest_size"];
/// Columns of the table of sizes.
const SIZES: [&str; 3] = ["size", "clusters", "part"];

/// Clusters of particles.
pub(super) struct Clusters;

impl Descriptor for Clusters {
    fn asked(&self, scene: &Checked) -> Option<Sampling> {
        Some(Sampling::after_equilibration(scene, scene.output.clusters.as_ref()?.every))
    }

    fn takes_states(&self) -> bool {
        true
    }

    fn parts(&self, scene: &Checked) -> Vec<Part> {
        // The step, number and sizes of its clusters; the clusters of each size.
        let asked = scene.output.clusters.iter();
        asked.flat_map(|asked| [Part::series(5), Part::sums(1 + members(asked, scene.model()) as usize)]).collect()
    }

    fn numbers_of_state(&self, Setting { scene, .. }: &Setting<'_>, state: &Reported) -> Option<Vec<f64>> {
        let (model, asked) = (scene.model(), scene.output.clusters.as_ref()?);
        let sizes = sizes(asked, model, state);
        let counted = || sizes.iter().filter(|size| **size >= asked.least as usize).map(|size| *size as f64);
        let [clusters, particles, squares] =
            [0, 1, 2].map(|power| counted().fold(0.0, |sum, size: f64| sum + size.powi(power)));
        let mut numbers = vec![state.step as f64, clusters, particles / clusters, squares / particles];
        numbers.push(counted().fold(f64::NAN, f64::max));
        let first = numbers.len();
        numbers.resize(first + 1 + members(asked, model) as usize, 0.0);
        for size in sizes {
            numbers[first + size] += 1.0;
        }
        Some(numbers)
    }

    fn conclude(&self, Setting { scene, .. }: &Setting<'_>, gathered: &Gathered) -> Option<Conclusion> {
        let (model, asked) = (scene.model(), scene.output.clusters.as_ref()?);
        let rows = gathered.part(0).chunks_exact(5);
        let rows = rows.map(|row| [&[model.time.at_sample(row[0])], &row[1..]].concat()).collect();
        let over_time = Table::new(["time"].into_iter().chain(COLUMNS), rows);
        let samples = gathered.samples();
        let particles = members(asked, model) as f64;
        let counts = gathered.part(1).iter().map(|count| count / samples as f64).enumerate();
        let there = counts.filter(|(_, count)| *count > 0.0).map(|(size, count)| (size as f64, count));
        let rows = there.map(|(size, count)| vec![size, count, size * count / particles]).collect();
        let result = if samples == 0 {
            Err(NO_SAMPLE.to_owned())
        } else if particles == 0.0 {
            Err("there are no particles".to_owned())
        } else {
            let mut result = json!({ "samples": samples });
            for column in COLUMNS {
                result[column] = json!(estimate(&over_time.values(column)));
            }
            Ok(of_species(asked.species.as_deref(), result))
        };
        let conclusion = Conclusion::new(over_time, result);
        Some(Conclusion { tables: [conclusion.tables, vec![Table::new(SIZES, rows)]].concat(), ..conclusion })
    }

    fn chart(&self, drawn: &Drawn<'_>) -> Chart {
        let asked = drawn.scene.output.clusters.as_ref();
        let subtitle = asked.map_or_else(String::new, |asked| {
            let least = if drawn.place == 0 && asked.least > 1 {
                format!(", of {} or more", asked.least)
            } else {
                String::new()
            };
            format!("particles closer than {} or bonded{least}", asked.distance)
        });
        if drawn.place == 1 {
            let panel = Panel { x: Axis::log("Particles in a cluster"), y: Axis::log("Clusters"), ..Panel::default() };
            let points = drawn.column("size").into_iter().zip(drawn.column("clusters"));
            let panel = panel.with(Series::markers("", points.map(|(size, count)| [size, count]).collect()));
            return drawn.of_species(Chart { title: drawn.title().to_owned(), subtitle, panels: vec![panel] });
        }
        let series = |column: &str, name: &str, ink: SeriesInk| {
            let mean = mean(&drawn.result[column]);
            let points = drawn.table.over_time(column, 1.0).unwrap_or_default();
            Series { mean, ..Series::line(name, points).with_ink(ink) }
        };
        let time = "Time (time units)";
        let number = Panel::new(time, "Clusters").with(series("clusters", "clusters", drawn.ink(drawn.result)));
        let sizes =
            [("mean_size", "mean of clusters"), ("weighted_size", "mean of particles"), ("largest_size", "largest")];
        let mut size = Panel::new(time, "Particles in a cluster");
        size.series =
            sizes.iter().zip(1..).map(|((column, name), ink)| series(column, name, SeriesInk::Numbered(ink))).collect();
        Chart { title: drawn.title().to_owned(), subtitle, panels: vec![number, size] }
    }

    fn labels(&self) -> &'static [(&'static str, &'static str)] {
        &[
            ("clusters", COLUMNS[0]),
            ("particles in a cluster", COLUMNS[1]),
            ("particles in the largest cluster", COLUMNS[3]),
        ]
    }

    fn finds(&self, _: &Checked) -> Vec<&'static str> {
        COLUMNS.to_vec()
    }
}

/// Particles that clusters are made of: those of a species, or all that are not frozen.
fn members(asked: &scene::Clusters, model: &Model) -> u64 {
    let species = model.species.iter().filter(|species| is_member(asked, &species.name, species.frozen));
    species.map(|species| species.count).sum()
}

fn is_member(asked: &scene::Clusters, name: &str, frozen: bool) -> bool {
    !frozen && asked.species.as_ref().is_none_or(|asked| asked == name)
}

/// The particles in each cluster of a state.
fn sizes(asked: &scene::Clusters, model: &Model, state: &Reported) -> Vec<usize> {
    let are_members: Vec<bool> =
        model.species.iter().map(|species| is_member(asked, &species.name, species.frozen)).collect();
    let ids: Vec<usize> = (0..state.positions.len()).filter(|id| are_members[state.species[*id] as usize]).collect();
    let positions: Vec<[u32; 3]> = ids.iter().map(|id| state.positions[*id]).collect();
    let mut clusters = Joined((0..ids.len()).collect());
    close_pairs(model, state.step, &positions, asked.distance, &mut |pair| clusters.join(pair.first, pair.second));
    for bond in model.particles().bonds.iter().flat_map(Bonds::iter) {
        let [first, second] = bond.ends.map(|id| ids.binary_search(&(id as usize)).ok());
        if let (Some(first), Some(second)) = (first, second) {
            clusters.join(first, second);
        }
    }
    let mut sizes = vec![0; ids.len()];
    for member in 0..ids.len() {
        sizes[clusters.root(member)] += 1;
    }
    sizes.retain(|size| *size > 0);
    sizes
}

/// Members of clusters, each with another one of its cluster or, the first of it, itself.
struct Joined(Vec<usize>);

impl Joined {
    fn root(&mut self, mut member: usize) -> usize {
        while self.0[member] != member {
            self.0[member] = self.0[self.0[member]];
            member = self.0[member];
        }
        member
    }

    fn join(&mut self, first: usize, second: usize) {
        let [first, second] = [first, second].map(|member| self.root(member));
        self.0[first.max(second)] = first.min(second);
    }
}
