//! The extension module of the Python package `mesoscope`: a thin layer over the library. Scenes pass as JSON text, arrays as `NumPy` arrays;
//! what can be read from files is read in Python.

mod errors;
mod runs;
mod simulation;

use pyo3::prelude::*;

#[pymodule]
mod _mesoscope {
    #[pymodule_export]
    use super::runs::{
        adapters, check, driver_environment, resume, run_scene, scenes, schema, stability, sweep, tradeoff,
    };
    #[pymodule_export]
    use super::simulation::Simulation;
}
