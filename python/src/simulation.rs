//! Simulations that Python advances step by step.

use crate::errors;
use crate::runs::{GLANCE, check_fork, checked, choice};
use mesoscope::gpu::{AdapterChoice, unseen_card};
use mesoscope::output::TrajectoryWriter;
use mesoscope::run::{Frame, RunError};
use numpy::ndarray::{Array2, Array3};
use numpy::{IntoPyArray, PyArray1, PyArray2, PyArray3, PyReadonlyArray2};
use pyo3::exceptions::PyRuntimeWarning;
use pyo3::prelude::*;
use pyo3::types::PyDict;
use std::collections::HashMap;
use std::ffi::CString;
use std::path::PathBuf;
use std::sync::{Mutex, MutexGuard, PoisonError};

/// A simulation with the trajectories that it writes.
struct Open {
    simulation: mesoscope::Simulation,
    trajectories: HashMap<PathBuf, TrajectoryWriter>,
}

/// A scene on a device. `mesoscope.Simulation` wraps it.
#[pyclass(frozen)]
pub struct Simulation {
    open: Mutex<Option<Open>>,
    process: u32,
}

impl Simulation {
    /// A simulation that was opened, or not; it warns of a graphics card that no driver offers.
    fn opened(
        py: Python<'_>,
        simulation: Result<mesoscope::Simulation, RunError>,
        choice: &AdapterChoice,
    ) -> PyResult<Self> {
        let simulation = simulation.map_err(|error| errors::of_run(py, &error))?;
        if let Some(warning) = unseen_card(simulation.adapter(), choice) {
            let warning = CString::new(warning).unwrap_or_default();
            PyErr::warn(py, &py.get_type::<PyRuntimeWarning>(), &warning, 2)?;
        }
        Ok(Self::new(simulation))
    }

    fn new(simulation: mesoscope::Simulation) -> Self {
        let open = Open { simulation, trajectories: HashMap::new() };
        Self { open: Mutex::new(Some(open)), process: std::process::id() }
    }

    /// Works with the simulation while other threads of Python may run.
    fn with<T: Send>(&self, py: Python<'_>, work: impl FnOnce(&mut Open) -> Result<T, RunError> + Send) -> PyResult<T> {
        if self.process != std::process::id() {
            check_fork(py)?;
        }
        let ended = py.detach(|| {
            let mut open: MutexGuard<'_, Option<Open>> = self.open.lock().unwrap_or_else(PoisonError::into_inner);
            open.as_mut().map(work)
        });
        match ended {
            Some(Ok(value)) => Ok(value),
            Some(Err(error)) => Err(errors::of_run(py, &error)),
            None => Err(errors::of(
                py,
                "RunError",
                "this simulation is closed: make another one, or use it inside of its `with`",
            )),
        }
    }
}

impl Simulation {
    /// Drops the simulation. In a process that was forked its device belongs to another one, and is left alone.
    fn leave(&self) {
        let open = self.open.lock().unwrap_or_else(PoisonError::into_inner).take();
        if self.process != std::process::id() {
            std::mem::forget(open);
        }
    }
}

impl Drop for Simulation {
    fn drop(&mut self) {
        self.leave();
    }
}

/// Rows of an array of shape (N, 1 to 3), with zeros in place of the columns that are missing.
fn vectors(array: &PyReadonlyArray2<'_, f64>) -> Vec<[f64; 3]> {
    let array = array.as_array();
    let columns = array.shape()[1].min(3);
    array
        .rows()
        .into_iter()
        .map(|row| std::array::from_fn(|axis| if axis < columns { row[axis] } else { 0.0 }))
        .collect()
}

fn array_of<'py, T: numpy::Element + Copy>(py: Python<'py>, rows: &[[T; 3]]) -> PyResult<Bound<'py, PyArray2<T>>> {
    let shaped = Array2::from_shape_vec((rows.len(), 3), rows.as_flattened().to_vec());
    Ok(shaped.map_err(|error| errors::of(py, "RunError", error.to_string()))?.into_pyarray(py))
}

/// A frame as a dictionary of arrays.
fn dictionary(py: Python<'_>, frame: Frame) -> PyResult<Bound<'_, PyDict>> {
    let found = PyDict::new(py);
    found.set_item("step", frame.step)?;
    found.set_item("time", frame.time)?;
    found.set_item("box", PyArray1::from_slice(py, &frame.lengths))?;
    found.set_item("displacement", frame.displacement)?;
    found.set_item("periodic", frame.periodic)?;
    found.set_item("positions", array_of(py, &frame.positions)?)?;
    found.set_item("velocities", array_of(py, &frame.velocities)?)?;
    found.set_item("images", array_of(py, &frame.images)?)?;
    found.set_item("species", frame.species.into_pyarray(py))?;
    found.set_item("masses", frame.masses.into_pyarray(py))?;
    Ok(found)
}

#[pymethods]
impl Simulation {
    /// A simulation of a scene at its start.
    #[staticmethod]
    #[pyo3(signature = (name, text, settings, adapter=None, ranks=1))]
    fn start(
        py: Python<'_>,
        name: &str,
        text: Option<String>,
        settings: Vec<String>,
        adapter: Option<&str>,
        ranks: u32,
    ) -> PyResult<Self> {
        check_fork(py)?;
        let scene = checked(name, text, &settings, None).map_err(|error| errors::of_scene(py, &error))?;
        let choice = choice(adapter);
        let simulation = py.detach(|| mesoscope::Simulation::on_ranks(&scene, &choice, ranks));
        Self::opened(py, simulation, &choice)
    }

    /// A simulation that goes on from a checkpoint.
    #[staticmethod]
    #[pyo3(signature = (path, adapter=None, ranks=1))]
    fn resume(py: Python<'_>, path: PathBuf, adapter: Option<&str>, ranks: u32) -> PyResult<Self> {
        check_fork(py)?;
        let choice = choice(adapter);
        let simulation = py.detach(|| mesoscope::Simulation::from_checkpoint_on_ranks(&path, &choice, ranks));
        Self::opened(py, simulation, &choice)
    }

    /// Closes the device, unless another simulation is on it.
    fn close(&self, py: Python<'_>) {
        py.detach(|| self.leave());
    }

    fn is_closed(&self) -> bool {
        self.open.lock().unwrap_or_else(PoisonError::into_inner).is_none()
    }

    /// Takes steps; signals are seen between slices of them.
    fn advance(&self, py: Python<'_>, steps: u64) -> PyResult<()> {
        let mut left = steps;
        while left > 0 {
            left -= self.with(py, |open| open.simulation.advance_within(left, GLANCE))?;
            py.check_signals()?;
        }
        Ok(())
    }

    fn step(&self, py: Python<'_>) -> PyResult<u64> {
        self.with(py, |open| Ok(open.simulation.step()))
    }

    fn time(&self, py: Python<'_>) -> PyResult<f64> {
        self.with(py, |open| Ok(open.simulation.time()))
    }

    fn adapter(&self, py: Python<'_>) -> PyResult<String> {
        self.with(py, |open| Ok(open.simulation.adapter().name.clone()))
    }

    /// Number of ranks that share the simulation, and what they have to share where there are fewer adapters.
    fn ranks(&self, py: Python<'_>) -> PyResult<(usize, Vec<String>)> {
        self.with(py, |open| {
            let ranks = open.simulation.ranks();
            Ok((ranks.len().max(1), mesoscope::ranks::sharing_anywhere(ranks)))
        })
    }

    /// The scene as JSON text.
    fn scene(&self, py: Python<'_>) -> PyResult<String> {
        self.with(py, |open| Ok(serde_json::to_string(open.simulation.scene()).unwrap_or_default()))
    }

    /// The names of the species.
    fn species_names(&self, py: Python<'_>) -> PyResult<Vec<String>> {
        self.with(py, |open| {
            Ok(open.simulation.scene().model().species.iter().map(|species| species.name.clone()).collect())
        })
    }

    /// Bonds, as pairs of particles.
    fn bonds<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<u32>>> {
        let bonds: Vec<[u32; 2]> = self.with(py, |open| {
            let bonds = open.simulation.scene().model().particles().bonds.clone();
            Ok(bonds.iter().flat_map(|bonds| bonds.iter().map(|bond| bond.ends).collect::<Vec<_>>()).collect())
        })?;
        let shaped = Array2::from_shape_vec((bonds.len(), 2), bonds.as_flattened().to_vec());
        Ok(shaped.map_err(|error| errors::of(py, "RunError", error.to_string()))?.into_pyarray(py))
    }

    fn frame<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let frame = self.with(py, |open| open.simulation.frame())?;
        dictionary(py, frame)
    }

    /// Numbers of a row of the table of energies.
    fn observables(&self, py: Python<'_>) -> PyResult<Vec<(&'static str, f64)>> {
        self.with(py, |open| open.simulation.observables())
    }

    /// Means with their standard errors, samples and whether these are few.
    #[allow(clippy::type_complexity)]
    fn means(&self, py: Python<'_>) -> PyResult<Vec<(&'static str, Option<(f64, Option<f64>, usize, bool)>)>> {
        self.with(py, |open| {
            let means = open.simulation.means().into_iter();
            Ok(means
                .map(|(name, found)| (name, found.map(|mean| (mean.value, mean.error, mean.samples, mean.few))))
                .collect())
        })
    }

    /// The table of energies: names of columns and rows.
    fn energies<'py>(&self, py: Python<'py>) -> PyResult<(Vec<String>, Bound<'py, PyArray2<f64>>)> {
        let table = self.with(py, |open| Ok(open.simulation.energies()))?;
        let numbers: Vec<f64> = table.rows.iter().flatten().copied().collect();
        let shaped = Array2::from_shape_vec((table.rows.len(), table.columns.len()), numbers);
        let shaped = shaped.map_err(|error| errors::of(py, "RunError", error.to_string()))?;
        Ok((table.columns, shaped.into_pyarray(py)))
    }

    /// The parts of the pressure tensor, of shape (3, 6); none where the scene has no `output.stress`.
    fn stress(&self, py: Python<'_>) -> PyResult<Option<[[f64; 6]; 3]>> {
        self.with(py, |open| open.simulation.stress())
    }

    /// Fields of shallow water: name, nodes along x and y, edges of the box, values.
    #[allow(clippy::type_complexity)]
    fn fields<'py>(&self, py: Python<'py>) -> PyResult<Vec<(&'static str, [f64; 2], Bound<'py, PyArray2<f64>>)>> {
        let fields = self.with(py, |open| open.simulation.fields())?;
        let shaped = fields.into_iter().map(|(quantity, field)| {
            let values = Array2::from_shape_vec((field.nodes[0], field.nodes[1]), field.values);
            let values = values.map_err(|error| errors::of(py, "RunError", error.to_string()))?;
            Ok((quantity.stem(), field.lengths, values.into_pyarray(py)))
        });
        shaped.collect()
    }

    /// Areas of Voronoi cells and their neighbours.
    #[allow(clippy::type_complexity)]
    fn cells<'py>(&self, py: Python<'py>) -> PyResult<Option<(Bound<'py, PyArray1<f64>>, Vec<Vec<usize>>)>> {
        let cells = self.with(py, |open| open.simulation.cells())?;
        Ok(cells.map(|cells| {
            let areas: Vec<f64> = cells.cells.iter().map(|cell| cell.volume).collect();
            let neighbours =
                |cell: &mesoscope::tessellation::Cell| cell.faces.iter().map(|face| face.neighbour).collect();
            (areas.into_pyarray(py), cells.cells.iter().map(neighbours).collect())
        }))
    }

    /// The current step as a picture: an array of shape (height, width, 4) of bytes.
    fn draw<'py>(&self, py: Python<'py>) -> PyResult<Option<Bound<'py, PyArray3<u8>>>> {
        let Some(picture) = self.with(py, |open| open.simulation.draw())? else { return Ok(None) };
        let (width, height) = picture.dimensions();
        let shaped = Array3::from_shape_vec((height as usize, width as usize, 4), picture.into_raw());
        Ok(Some(shaped.map_err(|error| errors::of(py, "RunError", error.to_string()))?.into_pyarray(py)))
    }

    /// Changes a number of the scene, given as JSON text; the largest rounding and the change of the total momentum by it.
    fn set(&self, py: Python<'_>, key: String, value: &str) -> PyResult<(f64, [f64; 3])> {
        let value: serde_json::Value =
            serde_json::from_str(value).map_err(|error| errors::of(py, "ArrayError", error.to_string()))?;
        let rounding = self.with(py, |open| open.simulation.set(&key, value))?;
        Ok((rounding.largest, rounding.momentum))
    }

    fn set_positions(&self, py: Python<'_>, positions: PyReadonlyArray2<'_, f64>) -> PyResult<f64> {
        let positions = vectors(&positions);
        self.with(py, |open| Ok(open.simulation.set_positions(&positions)?.largest))
    }

    fn set_velocities(&self, py: Python<'_>, velocities: PyReadonlyArray2<'_, f64>) -> PyResult<f64> {
        let velocities = vectors(&velocities);
        self.with(py, |open| Ok(open.simulation.set_velocities(&velocities)?.largest))
    }

    /// Changes so far, as JSON text.
    fn changes(&self, py: Python<'_>) -> PyResult<String> {
        self.with(py, |open| Ok(serde_json::to_string(open.simulation.changes()).unwrap_or_default()))
    }

    fn summary(&self, py: Python<'_>, path: PathBuf) -> PyResult<()> {
        self.with(py, |open| open.simulation.summary(&path))
    }

    fn checkpoint(&self, py: Python<'_>, path: PathBuf) -> PyResult<()> {
        self.with(py, |open| open.simulation.checkpoint(&path))
    }

    /// Adds the current step to a trajectory, which begins anew with the first frame that this simulation adds.
    fn write(&self, py: Python<'_>, path: PathBuf) -> PyResult<()> {
        self.with(py, |open| {
            let mut trajectory = match open.trajectories.remove(&path) {
                Some(trajectory) => trajectory,
                None => open.simulation.trajectory(&path)?,
            };
            open.simulation.write(&mut trajectory)?;
            open.trajectories.insert(path, trajectory);
            Ok(())
        })
    }
}
