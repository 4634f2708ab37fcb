//! The space that particles move in: walls with layers of frozen particles behind them, boundaries that shear. Each has
//! its checks in a scene, its numbers, and its part of a plan and of the float64 reference.

pub(crate) mod layers;
pub(crate) mod shear;
pub(crate) mod walls;
