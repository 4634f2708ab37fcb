//! Errors of the library as exceptions of `mesoscope.errors`.

use mesoscope::run::RunError;
use mesoscope::scene::SceneError;
use mesoscope::study::StudyError;
use pyo3::exceptions::PyKeyboardInterrupt;
use pyo3::prelude::*;

/// An exception of this name with these arguments.
fn exception(py: Python<'_>, name: &str, message: String, mistakes: Vec<(String, String)>) -> PyErr {
    let made = py
        .import("mesoscope.errors")
        .and_then(|module| module.getattr(name))
        .and_then(|class| class.call1((message, mistakes)));
    made.map_or_else(|error| error, PyErr::from_value)
}

pub fn of_scene(py: Python<'_>, error: &SceneError) -> PyErr {
    let mistakes = match error {
        SceneError::Invalid { problems, .. } => {
            let text = |problem: &mesoscope::scene::Problem| {
                let text = problem.to_string();
                let of_path = format!("{}: ", problem.path);
                text.strip_prefix(&of_path).map_or_else(|| text.clone(), str::to_owned)
            };
            problems.iter().map(|problem| (problem.path.clone(), text(problem))).collect()
        }
        _ => Vec::new(),
    };
    exception(py, "SceneError", error.to_string(), mistakes)
}

/// The failure of a run or of a simulation.
pub fn of_run(py: Python<'_>, error: &RunError) -> PyErr {
    let name = match error {
        RunError::Scene(error) => return of_scene(py, error),
        RunError::Interrupted { .. } | RunError::NotBegun | RunError::Paused { .. } => {
            return PyKeyboardInterrupt::new_err(error.to_string());
        }
        RunError::Arrays { mistakes } => {
            let mistakes = mistakes.iter().map(|mistake| (String::new(), mistake.clone())).collect();
            return exception(py, "ArrayError", error.to_string(), mistakes);
        }
        RunError::Gpu(_) | RunError::TooLarge { .. } => "AdapterError",
        RunError::Unstable { .. } | RunError::UnstableTrial(_) | RunError::GaveUp { .. } => "UnstableError",
        RunError::Output(_) | RunError::Checkpoint(_) | RunError::Stopped { .. } => "FileError",
        _ => "RunError",
    };
    exception(py, name, error.to_string(), Vec::new())
}

/// The failure of a study.
pub fn of_study(py: Python<'_>, error: &StudyError) -> PyErr {
    let name = match error {
        StudyError::Scene(error) => return of_scene(py, error),
        StudyError::Interrupted { .. } | StudyError::InterruptedShard { .. } => {
            return PyKeyboardInterrupt::new_err(error.to_string());
        }
        StudyError::Arguments { .. } | StudyError::Variants { .. } => "SceneError",
        StudyError::Gpu(_) => "AdapterError",
        StudyError::Output(_) => "FileError",
        _ => "RunError",
    };
    exception(py, name, error.to_string(), Vec::new())
}

/// An exception of this name.
pub fn of(py: Python<'_>, name: &str, message: impl Into<String>) -> PyErr {
    exception(py, name, message.into(), Vec::new())
}
