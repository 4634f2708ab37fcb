//! Headings under which the help of a command lists its options.

/// Which scene, and what to change in it.
pub const SCENE: &str = "Scene";
/// Options of the results and of their directory.
pub const OUTPUT: &str = "Output";
/// On what, and how long.
pub const RUNNING: &str = "Running";
/// More than one adapter, process or machine.
pub const SEVERAL: &str = "Several adapters and machines";
/// Options of the measures and of their references.
pub const COMPARISON: &str = "Comparison";
