//! Headings under which the help of a command lists its options.

/// Which scene, and what to change in it.
pub const SCENE: &str = "Scene";
/// What is written, and where.
pub const OUTPUT: &str = "Output";
/// On what, and how long.
pub const RUNNING: &str = "Running";
/// More than one adapter, process or machine.
pub const SEVERAL: &str = "Several adapters and machines";
/// What is measured, and what it is compared with.
pub const COMPARISON: &str = "Comparison";
