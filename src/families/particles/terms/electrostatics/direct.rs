//! Waves of charges that are summed one by one, with exact phases, in place of a mesh.

use super::Electrostatics;
use super::plan::Summed;
use crate::families::particles::plan::step::Builder;
use crate::plan::{Beyond, SharedSum, Words};
use crate::shaders::{Array, Constant, Entry, charges};
use std::f64::consts::{PI, TAU};

/// Bits of a unit of charge in the sums of a wave, at most: what a number of single precision holds.
const MOST_BITS: i32 = 24;
/// Waves that an invocation gathers impulses from, as in `shaders/charges/direct.wgsl`.
const SHARE: u64 = 64;
/// The most waves.
pub(super) const MOST: f64 = 1_048_576.0;
/// The most waves times charges: invocations are numbered by 32 bits.
pub(super) const MOST_WORK: f64 = 68_719_476_736.0;

/// About how many waves there are up to a wave number, each with its opposite.
pub(super) fn expected_count(largest: f64, volume: f64) -> f64 {
    2.0 * PI / 3.0 * largest.powi(3) * volume / TAU.powi(3)
}

/// The waves up to a wave number, as numbers of waves along each axis; of each and its opposite one.
pub(super) fn waves(largest: f64, lengths: [f64; 3]) -> Vec<[i32; 3]> {
    let most = lengths.map(|length| (largest * length / TAU).floor() as i32);
    let square = |wave: [i32; 3]| (0..3).map(|axis| (TAU * f64::from(wave[axis]) / lengths[axis]).powi(2)).sum::<f64>();
    let all = (0..=most[2])
        .flat_map(|z| (-most[1]..=most[1]).flat_map(move |y| (-most[0]..=most[0]).map(move |x| [x, y, z])));
    // Those whose last number that is not 0 is positive.
    let is_first = |[x, y, z]: [i32; 3]| z > 0 || y > 0 || (y == 0 && x > 0);
    all.filter(|wave| is_first(*wave) && square(*wave) <= largest * largest).collect()
}

/// The weight of a wave and its opposite: potential per unit of charge at its crest.
pub(super) fn weight(electrostatics: &Electrostatics, wave: [i32; 3], lengths: [f64; 3]) -> f64 {
    let square = (0..3).map(|axis| (TAU * f64::from(wave[axis]) / lengths[axis]).powi(2)).sum::<f64>();
    let volume = lengths.iter().product::<f64>();
    8.0 * PI * electrostatics.strength * electrostatics.cloud.spectrum(square) / (square * volume)
}

/// The root mean square of the error of the force on a unit charge, for charges at random places whose squares add up to `squares`: that of the
/// waves that are left out, an integral over their numbers.
pub(super) fn expected_error(electrostatics: &Electrostatics, largest: f64, squares: f64, volume: f64) -> f64 {
    let steps = 4000;
    let end = 30.0 / electrostatics.cloud.width();
    let width = (end - largest).max(0.0) / f64::from(steps);
    let numbers = (0..steps).map(|step| largest + (f64::from(step) + 0.5) * width);
    let left_out = numbers.map(|number| electrostatics.cloud.spectrum(number * number).powi(2) * width).sum::<f64>();
    (squares / volume * 8.0 * electrostatics.strength.powi(2) * left_out).sqrt()
}

impl Electrostatics {
    /// Units of the sums of a wave in an elementary charge: all charges together fit.
    fn wave_units(&self) -> f64 {
        let all = self.charged.sum(f64::abs).max(1.0);
        2_f64.powi(((2_f64.powi(30) / all).log2().floor() as i32).min(MOST_BITS))
    }

    /// The kernels of waves up to a wave number.
    pub(super) fn one_by_one(&self, largest: f64, builder: &mut Builder<'_>) -> Summed {
        let lengths = builder.model.units.lengths;
        let count = waves(largest, lengths).len() as u64;
        let impulse = |axis: usize| builder.scales().impulse() * TAU / lengths[axis];
        let impulses = [impulse(0), impulse(1), impulse(2)];
        builder.plan.constants.extend([
            (Constant::WaveUnit, self.wave_units()),
            (Constant::ChargeImpulseX, impulses[0]),
            (Constant::ChargeImpulseY, impulses[1]),
            (Constant::ChargeImpulseZ, impulses[2]),
        ]);
        builder.plan.add_long_table(Array::ListedWaves, WaveList { electrostatics: self.clone(), largest, lengths });
        builder.plan.add_buffer(Array::WaveSums, 16 * count);
        let choices = builder.choices().and(&builder.kicks());
        let all = (Constant::ChargeWaves, count as f64);
        let sum = builder.kernel(
            "sum_charge_waves",
            Entry::SumChargeWaves,
            choices.clone(),
            count * builder.workgroup_size(),
        );
        builder.plan.kernels[sum].constants.extend([all, (Constant::Quantities, 2.0)]);
        builder.plan.kernels[sum].renamed.push((Array::PartialSums, Array::WaveSums));
        if let Some(part) = &mut builder.plan.part {
            let division = part.part.division;
            part.sums.push(SharedSum::everywhere(Array::WaveSums, Beyond::Wrapped, 4 * count, sum, &division));
        }
        let parts = count.div_ceil(SHARE);
        let mut pulls = |choices| {
            let pulls = self.pulls("pull_by_waves", Entry::PullByWaves, parts, &choices, builder);
            builder.plan.kernels[pulls[0]].constants.push(all);
            pulls
        };
        let pull = pulls(choices.clone());
        let pulled = pulls(choices.clone().with(charges::Report::Observed));
        Summed {
            kicks: [&[sum], &pull[..]].concat(),
            forth: vec![sum],
            back: pulled.to_vec(),
            choices: choices.with(charges::Wave::Listed),
            constants: Vec::new(),
            renamed: Vec::new(),
            waves: count,
            energy: 0.5 / self.wave_units(),
            operations: 60.0 * count as f64 * self.charged.count() as f64,
        }
    }
}

/// The waves and their weights.
#[derive(Debug, Clone, PartialEq)]
struct WaveList {
    electrostatics: Electrostatics,
    largest: f64,
    lengths: [f64; 3],
}

impl Words for WaveList {
    fn count(&self) -> u64 {
        4 * waves(self.largest, self.lengths).len() as u64
    }

    fn words(&self) -> Vec<u32> {
        let units = self.electrostatics.wave_units();
        let entry = |wave: [i32; 3]| {
            let [x, y, z] = wave.map(i32::cast_unsigned);
            [x, y, z, ((weight(&self.electrostatics, wave, self.lengths) / units) as f32).to_bits()]
        };
        waves(self.largest, self.lengths).into_iter().flat_map(entry).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::super::Cloud;
    use super::*;

    #[test]
    fn waves_are_one_of_each_pair() {
        let lengths = [6.0, 5.0, 7.0];
        let listed = waves(3.1, lengths);
        let mut both: Vec<[i32; 3]> = listed.iter().flat_map(|wave| [*wave, wave.map(|number| -number)]).collect();
        both.sort_unstable();
        both.dedup();
        assert_eq!(both.len(), 2 * listed.len());
        let within = |wave: [i32; 3]| {
            (0..3).map(|axis| (TAU * f64::from(wave[axis]) / lengths[axis]).powi(2)).sum::<f64>() <= 3.1 * 3.1
        };
        let all = (-8..=8).flat_map(|x| (-8..=8).flat_map(move |y| (-8..=8).map(move |z| [x, y, z])));
        assert_eq!(all.filter(|wave| *wave != [0; 3] && within(*wave)).count(), both.len());
        assert!((expected_count(3.1, 210.0) / listed.len() as f64 - 1.0).abs() < 0.05, "{}", listed.len());
    }

    /// Errors that were computed apart from this, for 196 ions in a box of 10, over the rms force of .955.
    #[test]
    fn errors_are_those_of_the_waves_that_are_left_out() {
        for (cut, found) in [(2.3, 2.7e-3), (2.67, 4.5e-4), (3.05, 5e-5), (3.44, 3.5e-6)] {
            let electrostatics =
                Electrostatics { cloud: Cloud::Gaussian { width: 0.6076 }, ..Electrostatics::default() };
            let error = expected_error(&electrostatics, cut / 0.6076, 196.0, 1000.0) / 0.955;
            assert!((error / found).ln().abs() < 0.4, "{cut}: {error}");
        }
    }
}
