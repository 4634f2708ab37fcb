//! Defaults of keys of several types.

pub(in crate::document) fn one() -> f64 {
    1.0
}

/// A whole number.
pub(in crate::document) fn whole<const NUMBER: u32>() -> u32 {
    NUMBER
}

/// So many hundredths.
pub(in crate::document) fn hundredths<const NUMBER: u32>() -> f64 {
    f64::from(NUMBER) / 100.0
}

#[expect(clippy::trivially_copy_pass_by_ref, reason = "serde hands over references")]
pub(in crate::document) fn is_zero(value: &f64) -> bool {
    *value == 0.0
}
