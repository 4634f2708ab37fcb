//! Defaults of keys of several types.

pub(in crate::document) fn one() -> f64 {
    1.0
}

pub(in crate::document) fn half() -> f64 {
    0.5
}

#[expect(clippy::trivially_copy_pass_by_ref, reason = "serde hands over references")]
pub(in crate::document) fn is_zero(value: &f64) -> bool {
    *value == 0.0
}
