//! Whether single precision can hold the numbers that follow from a scene.

use super::{Contents, Plan};
use crate::document::{Scene, SceneError};
use crate::shaders::Array;
use serde_json::Value;

/// Refuses a plan of a scene if a constant or coefficient of its kernels is too large or too small for single precision.
///
/// ```
/// use mesoscope::plan::{Hardware, Options, check_precision};
/// use mesoscope::run::plan;
/// use mesoscope::scene;
///
/// let heavy = ["particles.0.mass=1e60"].map(str::to_owned);
/// let scene = scene::load("dpd-fluid", &heavy)?;
/// let plan = plan(&scene, Hardware::default(), Options::default());
/// let refusal = check_precision(&scene, &plan).map_or_else(|error| error.to_string(), |()| String::new());
/// assert!(refusal.starts_with("particles[0].mass: found 1e60; "), "{refusal}");
/// # Ok::<(), scene::SceneError>(())
/// ```
///
/// # Errors
/// [`SceneError::Precision`] with the number of the scene that is furthest from one.
pub fn check_precision(scene: &Scene, plan: &Plan) -> Result<(), SceneError> {
    let constants = plan.constants.iter().chain(plan.kernels.iter().flat_map(|kernel| &kernel.constants));
    let mut lost = constants.filter(|(_, value)| !fits(*value)).map(|(constant, value)| (constant.name(), *value));
    let coefficients = || {
        let buffers = plan.buffers.iter().map(|buffer| (buffer.array, &buffer.contents));
        let textures = plan.textures.iter().map(|texture| (texture.array, &texture.contents));
        let (array, contents) = buffers.chain(textures).find(|(array, _)| *array == Array::Coefficients)?;
        let Contents::Bytes(bytes) = contents else { return None };
        let numbers = bytemuck::pod_collect_to_vec::<u8, f32>(bytes);
        let value = numbers.into_iter().find(|number| !number.is_finite())?;
        Some((array.name(), f64::from(value)))
    };
    let Some((constant, value)) = lost.next().or_else(coefficients) else { return Ok(()) };
    let mut furthest = (String::new(), 1.0);
    let document = serde_json::to_value(scene).unwrap_or_default();
    for key in ["space", "time", "temperature", "particles", "interactions"] {
        walk(&document[key], key.to_owned(), &mut furthest);
    }
    let (path, number) = furthest;
    Err(SceneError::Precision { path, number, constant: constant.to_owned(), value })
}

fn fits(value: f64) -> bool {
    let single = value as f32;
    single.is_finite() && (value == 0.0 || single != 0.0)
}

/// Finds the number whose magnitude is furthest from one.
fn walk(value: &Value, path: String, furthest: &mut (String, f64)) {
    match value {
        Value::Number(number) => {
            let distance = |number: f64| number.abs().log10().abs();
            let number = number.as_f64().unwrap_or(1.0);
            if number != 0.0 && distance(number) > distance(furthest.1) {
                *furthest = (path, number);
            }
        }
        Value::Array(list) => {
            for (index, value) in list.iter().enumerate() {
                walk(value, format!("{path}[{index}]"), furthest);
            }
        }
        Value::Object(object) => {
            for (key, value) in object {
                walk(value, format!("{path}.{key}"), furthest);
            }
        }
        Value::Null | Value::Bool(_) | Value::String(_) => {}
    }
}
