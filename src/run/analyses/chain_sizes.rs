//! Sizes of chains: mean squared distance of the ends and radius of gyration.

use super::{
    Conclusion, Descriptor, Drawn, Gathered, NO_SAMPLE, Part, Planner, Sampling, Setting, SumSampler, mean,
    printed_estimate,
};
use crate::engine::Sample;
use crate::families::{ChainGroup, Checked, Walks};
use crate::measure::statistics::estimate;
use crate::plan::Words;
use crate::plot::{ChainKind, Chart, SeriesInk, chain_sizes_chart};
use crate::scene::AnalysisId;
use crate::shaders::analyses::Walk;
use crate::shaders::{Array, Choices, Constant, Entry};
use crate::table::Table;
use serde_json::{Value, json};
use std::sync::Arc;

const END_TO_END: &str = "end_to_end_squared";
const GYRATION: &str = "radius_of_gyration_squared";

/// Sizes of chains.
pub(super) struct ChainSizes;

impl Descriptor for ChainSizes {
    fn asked(&self, scene: &Checked) -> Option<Sampling> {
        Some(Sampling::after_equilibration(scene, scene.output.chain_sizes.as_ref()?.every))
    }

    fn add_sampler(&self, planner: &mut Planner<'_>) {
        let Some(asked) = &planner.output.chain_sizes else { return };
        let groups = &planner.model.particles().chain_groups;
        let chains: u64 = groups.iter().map(|group| u64::from(group.chains)).sum();
        planner.plan.add_long_table(Array::ChainStarts, ChainTable(groups.clone()));
        let walks = WalkTable(groups.clone());
        let listed = walks.count() > 0;
        if listed {
            planner.plan.add_long_table(Array::ChainWalks, walks);
        }
        let mut constants = planner.between();
        constants.push((Constant::Chains, chains as f64));
        constants.push((Constant::ChainLength, 1.0 / planner.plan.quanta.length_squared));
        let buffers = [Array::ChainSums, Array::ChainSamples];
        planner.add_sums(&SumSampler {
            choices: Choices::new().with_if(listed, Walk::Listed),
            constants,
            ..SumSampler::new(AnalysisId::ChainSizes, Entry::MeasureChains, buffers, 2 * groups.len(), asked.every)
        });
    }

    fn parts(&self, scene: &Checked) -> Vec<Part> {
        // A step, then two means for each group.
        vec![Part::series(1 + 2 * scene.model().particles().chain_groups.len())]
    }

    fn numbers_of_sample(&self, Setting { scene, plan }: &Setting<'_>, sample: &Sample) -> Option<Vec<f64>> {
        let means = sample.sums.iter().enumerate().map(|(index, sum)| {
            let chains = scene.model().particles().chain_groups.get(index / 2).map_or(1, |group| group.chains.max(1));
            *sum as f64 * plan.quanta.length_squared / f64::from(chains)
        });
        Some(std::iter::once(sample.step as f64).chain(means).collect())
    }

    fn conclude(&self, Setting { scene, .. }: &Setting<'_>, gathered: &Gathered) -> Option<Conclusion> {
        let model = scene.model();
        let groups = &model.particles().chain_groups;
        let columns =
            (0..groups.len()).flat_map(|number| [END_TO_END, GYRATION].map(|quantity| format!("{quantity}_{number}")));
        let rows = gathered.part(0).chunks_exact(1 + 2 * groups.len());
        let rows = rows.map(|row| [&[model.time.at_sample(row[0])], &row[1..]].concat()).collect();
        let table = Table::new(std::iter::once("time".to_owned()).chain(columns), rows);
        let sizes = |(number, group): (usize, &ChainGroup)| {
            let [end_to_end, gyration] =
                [1, 2].map(|place| json!(estimate(&table.column_at(place + 2 * number).collect::<Vec<f64>>())));
            json!({
                "species": group.name,
                "chains": group.chains,
                "beads": group.beads,
                // The last bead of a ring is next to its first, and their distance that of a bond; a branched molecule
                // has more ends.
                END_TO_END: if group.linear { end_to_end } else { Value::Null },
                GYRATION: gyration,
            })
        };
        let result = match gathered.samples() {
            0 => Err(NO_SAMPLE.to_owned()),
            _ => Ok(groups.iter().enumerate().map(sizes).collect()),
        };
        Some(Conclusion::new(table, result))
    }

    fn species_of(&self, scene: &Checked, numbers: &[usize]) -> Vec<String> {
        let groups = &scene.model().particles().chain_groups;
        numbers.iter().filter_map(|number| groups.get(*number)).map(|group| group.name.clone()).collect()
    }

    fn chart(&self, drawn: &Drawn<'_>) -> Chart {
        let kinds = drawn.result.as_array().map(Vec::as_slice).unwrap_or_default();
        let mut kinds: Vec<ChainKind> = kinds.iter().map(chain_kind).collect();
        let numbers: Option<Vec<usize>> = kinds.iter().map(|kind| drawn.model.species_named(&kind.species)).collect();
        for (kind, number) in kinds.iter_mut().zip(numbers.into_iter().flatten()) {
            kind.ink = SeriesInk::Species([number; 2]);
        }
        chain_sizes_chart(drawn.title(), drawn.table, &kinds)
    }

    fn printed(&self, result: &Value) -> Vec<(String, String)> {
        let sizes = |kind: &Value| {
            let [species, beads] = [kind["species"].as_str().unwrap_or_default(), &kind["beads"].to_string()];
            [("end-to-end distance²", END_TO_END), ("gyration radius²", GYRATION)].map(|(label, size)| {
                Some((format!("{label} of `{species}` ({beads} beads)"), printed_estimate(&kind[size])?))
            })
        };
        result.as_array().into_iter().flatten().flat_map(sizes).flatten().collect()
    }
}

/// The first particle of each chain, or the first step of its walk in the list, the number of steps, the number of its
/// group, and that of its particles.
#[derive(Debug, Clone, PartialEq)]
struct ChainTable(Vec<ChainGroup>);

impl Words for ChainTable {
    fn count(&self) -> u64 {
        4 * self.0.iter().map(|group| u64::from(group.chains)).sum::<u64>()
    }

    fn words(&self) -> Vec<u32> {
        let mut words = Vec::with_capacity(self.count() as usize);
        let mut listed = 0;
        for (number, group) in (0..).zip(&self.0) {
            let ChainGroup { chains, steps, beads, .. } = *group;
            let first = match &group.walks {
                Walks::Consecutive(first) => *first,
                Walks::Listed(walks) => {
                    listed += walks.len() as u32;
                    listed - walks.len() as u32
                }
            };
            words.extend((0..chains).flat_map(|chain| [first + chain * steps, steps, number, beads]));
        }
        words
    }
}

/// The walks that are listed.
#[derive(Debug, Clone, PartialEq)]
struct WalkTable(Vec<ChainGroup>);

impl WalkTable {
    fn listed(&self) -> impl Iterator<Item = &Arc<[u32]>> {
        self.0.iter().filter_map(|group| match &group.walks {
            Walks::Consecutive(_) => None,
            Walks::Listed(walks) => Some(walks),
        })
    }
}

impl Words for WalkTable {
    fn count(&self) -> u64 {
        self.listed().map(|walks| walks.len() as u64).sum()
    }

    fn words(&self) -> Vec<u32> {
        self.listed().flat_map(|walks| walks.iter().copied()).collect()
    }
}

fn chain_kind(result: &Value) -> ChainKind {
    ChainKind {
        species: result["species"].as_str().unwrap_or_default().to_owned(),
        beads: result["beads"].as_u64().unwrap_or_default(),
        ink: SeriesInk::Own,
        end_to_end: mean(&result[END_TO_END]),
        gyration: mean(&result[GYRATION]),
    }
}
