//! Comparison of values that are known by a trait only.

use std::any::Any;

/// What can be compared with a value of any type.
pub trait Compared: Any {
    /// Whether the other is of the same type, and equal.
    fn equals(&self, other: &dyn Any) -> bool;
}

impl<T: Any + PartialEq> Compared for T {
    fn equals(&self, other: &dyn Any) -> bool {
        other.downcast_ref::<T>() == Some(self)
    }
}
