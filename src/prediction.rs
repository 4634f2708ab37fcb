//! The momentum that friction sees where the scheme of Groot and Warren predicts it (λ ≠ ½), as particles carry it.
//!
//! A particle keeps the shift from its momentum to the predicted one in 23 bits beside its species: three components of
//! six bits, and five of an exponent that they have in common. So it takes no more memory than one without prediction,
//! and each component of the shift is known to 1/32 of the largest or better. As friction is a pair impulse, momentum
//! stays exact all the same, and as the shift alone is rounded, nothing depends on how fast the fluid moves.
//! `shaders/space/particle.wgsl` does the same on the device.

const BITS: u32 = 6;
const EXPONENT_BITS: u32 = 5;
/// More than any momentum of a run: larger ones stop it.
const LARGEST_SHIFT: i32 = 1 << 30;

/// Predicted momenta m ṽ(n+1) = p(n+½) + (2λ - 1) H(n), the shift from p(n+½) in few bits; H is the opening half kick.
pub(crate) fn predicted(momenta: &[[i32; 3]], opening: &[[i64; 3]], lambda: f64) -> Vec<[i32; 3]> {
    let shift = |units: i64| (2.0 * lambda - 1.0) * units as f64;
    let seen = |(momentum, kick): (&[i32; 3], &[i64; 3])| {
        shifted(*momentum, unpacked(packed(kick.map(|units| shift(units).round_ties_even() as i32))))
    };
    momenta.iter().zip(opening).map(seen).collect()
}

/// A momentum and a shift, in wrapping integers as on the device.
pub(crate) fn shifted(momentum: [i32; 3], shift: [i32; 3]) -> [i32; 3] {
    std::array::from_fn(|axis| momentum[axis].wrapping_add(shift[axis]))
}

/// The bits of a shift, rounded half up.
pub(crate) fn packed(shift: [i32; 3]) -> u32 {
    let shift = shift.map(|units| units.clamp(-LARGEST_SHIFT, LARGEST_SHIFT));
    let largest = shift.iter().fold(0, |largest, units| units.unsigned_abs().max(largest));
    // The largest component rounds to at most 31.
    let exponent = (largest + (largest >> (BITS - 1))).checked_ilog2().unwrap_or(0).saturating_sub(BITS - 2);
    let rounded = |units: i32| ((units + ((1 << exponent) >> 1)) >> exponent) as u32 & ((1 << BITS) - 1);
    let place = |axis: usize| rounded(shift[axis]) << (EXPONENT_BITS + BITS * axis as u32);
    exponent | place(0) | place(1) | place(2)
}

/// The shift that bits stand for.
pub(crate) fn unpacked(bits: u32) -> [i32; 3] {
    let exponent = bits & ((1 << EXPONENT_BITS) - 1);
    std::array::from_fn(|axis| {
        let above = 32 - BITS - EXPONENT_BITS - BITS * axis as u32;
        (((bits << above) as i32) >> (32 - BITS)).wrapping_shl(exponent)
    })
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use rand::{RngExt, SeedableRng};

    #[test]
    fn a_shift_is_kept_to_one_part_in_thirty_two_of_its_largest_component() {
        let mut random = rand::rngs::StdRng::seed_from_u64(1);
        for _ in 0..100_000 {
            let size = f64::from(random.random_range(0_f32..30.0)).exp2();
            let shift: [i32; 3] = std::array::from_fn(|_| (size * f64::from(random.random_range(-1_f32..1.0))) as i32);
            let kept = unpacked(packed(shift));
            let largest = shift.iter().map(|units| units.abs()).max().unwrap();
            for axis in 0..3 {
                assert!((kept[axis] - shift[axis]).abs() <= largest / 30, "{shift:?} became {kept:?}");
            }
            assert_eq!(packed(kept), packed(unpacked(packed(kept))));
            assert_eq!(unpacked(packed(kept)), kept, "what was kept once is kept");
            assert!(packed(shift) < 1 << 24, "the species has the other eight bits");
        }
    }

    #[test]
    fn small_shifts_are_exact() {
        for units in -31..=31 {
            let shift = [units, -units, 31];
            assert_eq!(unpacked(packed(shift)), shift);
        }
        assert_eq!(packed([0; 3]), 0);
    }

    #[test]
    fn the_largest_shift_fits() {
        for shift in [[i32::MAX, 0, i32::MIN], [LARGEST_SHIFT, -LARGEST_SHIFT, 0]] {
            let kept = unpacked(packed(shift));
            assert!(kept.iter().zip(shift).all(|(kept, units)| kept.signum() == units.signum()));
        }
    }
}
