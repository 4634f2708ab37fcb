//! Defaults of keys of several types.

pub(in crate::document) fn one() -> f64 {
    1.0
}

/// A whole number.
pub(in crate::document) fn whole<const NUMBER: u32>() -> u32 {
    NUMBER
}

/// A number in hundredths.
pub(in crate::document) fn hundredths<const NUMBER: u32>() -> f64 {
    f64::from(NUMBER) / 100.0
}

/// True if a value is that of a key which is left out.
pub(in crate::document) fn is_default<T: Default + PartialEq>(value: &T) -> bool {
    *value == T::default()
}
