//! Pairs counted by distance, for the radial distribution function.

use super::Planner;
use super::species_pairs::SpeciesPairs;
use crate::plan::recording::record_histogram;
use crate::plan::serial_memory::TURNS;
use crate::plan::{Grid, Kernel, Options, Ordered, Sampler};
use crate::scene::{AnalysisId, RadialDistribution};
use crate::shaders::analyses::{CountedPairs, Partial};
use crate::shaders::core::Dispatches;
use crate::shaders::{Array, Constant, Entry};
use crate::state::Units;

/// Histograms kept on the device between two readbacks.
const CAPACITY: u64 = 16;

/// The most pairs that one dispatch examines: a second's work of a small adapter. Systems with a watchdog end what takes seconds.
const PAIRS: u64 = 1 << 30;

/// One part in this many of them takes negligible time: a batch of steps may have many such histograms.
const SHORT: u128 = 64;

/// The most dispatches that share a histogram.
const MOST_DISPATCHES: u64 = 1 << 12;

/// Enough workgroups to fill an adapter.
const ENOUGH: u64 = 8192;

/// How the kernel knows the pairs of species.
impl SpeciesPairs {
    fn choice(self) -> Option<Partial> {
        match self {
            Self::Alike => None,
            Self::Between(_) => Some(Partial::Between),
            Self::All(_) => Some(Partial::All),
        }
    }

    fn constants(self, bins: u32) -> Vec<(Constant, f64)> {
        match self {
            Self::Alike => Vec::new(),
            Self::Between([a, b]) => vec![(Constant::FirstSpecies, a as f64), (Constant::SecondSpecies, b as f64)],
            Self::All(_) => vec![(Constant::PairBins, bins.into())],
        }
    }
}

/// What the kernel that counts pairs has to know.
pub(super) struct PairHistogram<'a> {
    pub units: &'a Units,
    /// True if there are walls.
    pub walled: bool,
    pub grid: &'a Grid,
    pub options: Options,
    pub asked: &'a RadialDistribution,
    pub pairs: SpeciesPairs,
}

impl PairHistogram<'_> {
    /// Adds the kernel, what records its counts, and the sampler.
    pub(crate) fn add(self, planner: &mut Planner<'_>, ordered: &Ordered) {
        let plan = &mut *planner.plan;
        let mut kernels = ordered.kernels.clone();
        let bins = u64::from(self.asked.bins) * self.pairs.curves();
        let spans: [u64; 3] = std::array::from_fn(|axis| self.span(axis));
        let (segments, parts) = self.shares(plan.particles, spans);
        let shares = self.grid.rows() * segments * parts;
        let (dispatches, takes_long) = self.dispatches(plan.particles, spans);
        let dispatches = dispatches.min(shares);
        let choices = (ordered.choices.clone())
            .with_if(dispatches > 1, Dispatches::InTurn)
            .with_if(self.walled, CountedPairs::BetweenWalls)
            .with_any(self.pairs.choice());
        let shares = shares.div_ceil(dispatches);
        let mut constants = vec![
            (Constant::Bins, bins as f64),
            (Constant::HistogramRange, self.asked.range),
            (Constant::SpanX, spans[0] as f64),
            (Constant::SpanY, spans[1] as f64),
            (Constant::SpanZ, spans[2] as f64),
            (Constant::Segments, segments as f64),
            (Constant::Parts, parts as f64),
        ];
        constants.extend(self.pairs.constants(self.asked.bins));
        if dispatches > 1 {
            constants.push((Constant::Shares, shares as f64));
        }
        let kernel =
            Kernel::new("pair_histogram", Entry::CountPairsByDistance, choices.clone(), shares).with(constants);
        let count = plan.add_kernel(Kernel { takes_long, ..kernel });
        if dispatches > 1 {
            let next = Kernel::new("next_dispatch", Entry::NextDispatch, choices, 1);
            let next = plan.add_kernel(next.with(vec![(Constant::Dispatches, dispatches as f64)]));
            kernels.extend([count, next].repeat(dispatches as usize));
            plan.add_buffer(Array::DispatchesDone, 4);
        } else {
            kernels.push(count);
        }
        kernels.push(plan.add_kernel(record_histogram(bins).renamed(vec![(Array::Samples, Array::HistogramSamples)])));
        if let Some(wider) = plan.part.as_mut().and_then(|part| part.wider.as_mut()) {
            wider.samplers.push(plan.samplers.len());
        }
        plan.add_buffer(Array::Histogram, 8 * bins);
        let (id, samples) = (AnalysisId::RadialDistribution, Array::HistogramSamples);
        let plain = planner.sampler(id, self.asked.every, samples, bins as usize, CAPACITY);
        planner.plan.samplers.push(Sampler { kernels, needs_report: ordered.needs_report, ..plain });
    }

    /// Cells that the range covers on an axis.
    fn span(&self, axis: usize) -> u64 {
        if axis >= self.grid.dimension {
            return 1;
        }
        let width = self.units.lengths[axis] / f64::from(self.grid.cells[axis]);
        (2 * (self.asked.range / width).ceil() as u64 + 1).min(self.grid.cells[axis].into())
    }

    /// Dispatches that share the pairs, and whether each takes so long that it has to be the last of a submission.
    fn dispatches(&self, particles: u64, spans: [u64; 3]) -> (u64, bool) {
        let cells_around = spans.iter().product::<u64>();
        let candidates =
            u128::from(particles) * u128::from(particles) * u128::from(cells_around) / u128::from(self.grid.count());
        let at_once = u128::from(self.options.pairs_in_dispatch.unwrap_or(PAIRS).max(1));
        let dispatches = candidates.div_ceil(at_once).clamp(1, MOST_DISPATCHES.into());
        (dispatches as u64, candidates / dispatches > at_once / SHORT)
    }

    /// Workgroups that share the particles of a row, and those that share the rows around each of these: enough to fill the
    /// adapter, and so many that no lane runs more loop iterations than it should.
    fn shares(&self, particles: u64, spans: [u64; 3]) -> (u64, u64) {
        let rows = self.grid.rows();
        let rows_around = spans[1] * spans[2];
        // Lanes of a vector wait for the fullest of their cells, and every cell costs an iteration and the end of a loop.
        let in_cell = (particles / self.grid.count()).max(1);
        let turns_of_cell = in_cell + 2 * in_cell.isqrt() + 2;
        let candidates = turns_of_cell.saturating_mul(spans[0]).saturating_mul(rows_around);
        let rounds = (particles / rows).div_ceil(self.options.workgroup()).max(1);
        // Of all particles of a lane, if one workgroup took the row.
        let turns = rounds.saturating_mul(candidates);
        let segments = rounds.min((ENOUGH / rows).max(turns.div_ceil(TURNS)).max(1));
        let parts = (rounds.div_ceil(segments).saturating_mul(candidates)).div_ceil(TURNS).clamp(1, rows_around);
        (segments, parts)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn histogram<'a>(units: &'a Units, grid: &'a Grid, asked: &'a RadialDistribution) -> PairHistogram<'a> {
        PairHistogram { units, walled: false, grid, options: Options::default(), asked, pairs: SpeciesPairs::Alike }
    }

    /// Over a thousand million pairs are shared; a batch may have many histograms of some millions each.
    #[test]
    fn histograms_that_take_long_are_shared_and_submitted_by_themselves() {
        for (range, expected) in [(1.0, (1, false)), (5.0, (1, true)), (25.0, (15, true))] {
            let units = Units { dimension: 3, lengths: [50.0; 3], gaps: [0.0; 3], momentum: 1.0 };
            let particles = 125_000;
            let grid = Grid::new(&units, 1.0, particles);
            let asked = RadialDistribution { every: 1, range, bins: 10, species: None };
            let histogram = histogram(&units, &grid, &asked);
            let spans: [u64; 3] = std::array::from_fn(|axis| histogram.span(axis));
            assert_eq!(histogram.dispatches(particles, spans), expected, "{range}");
        }
    }

    #[test]
    fn no_lane_makes_more_turns_than_software_adapters_do() {
        for (edge, density, range) in
            [(10.0, 3.0, 3.0), (20.0, 3.0, 10.0), (69.34, 3.0, 10.0), (42.0, 1.0, 21.0), (110.0, 3.0, 55.0)]
        {
            let units = Units { dimension: 3, lengths: [edge; 3], gaps: [0.0; 3], momentum: 1.0 };
            let particles = (density * edge * edge * edge) as u64;
            let grid = Grid::new(&units, 1.0, particles);
            let asked = RadialDistribution { every: 1, range, bins: 10, species: None };
            let histogram = histogram(&units, &grid, &asked);
            let spans: [u64; 3] = std::array::from_fn(|axis| histogram.span(axis));
            let (segments, parts) = histogram.shares(particles, spans);
            // A lane's particles, the rows of cells that it visits around each, the cells of these, and the particles in the
            // fullest of some: five standard deviations above the mean.
            let mean = particles.div_ceil(grid.count());
            let in_cell = mean + 5 * mean.isqrt();
            let own = (particles / grid.rows()).div_ceil(64).div_ceil(segments);
            let turns = own * (spans[1] * spans[2]).div_ceil(parts) * spans[0] * (2 + in_cell);
            assert!(turns < 65_535, "{edge} {range}: {turns} with {segments} segments, {parts} parts");
        }
    }
}
