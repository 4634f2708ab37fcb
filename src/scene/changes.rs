//! Changes of numbers of a scene between the steps of a simulation.

use super::overrides::dotted;
use super::{Checked, Problem, Problems, Scene, SceneError, WrittenScene};
use serde_json::Value;

/// Keys whose numbers may change between steps, by their beginnings.
const CHANGEABLE: [&str; 5] = ["temperature", "interactions.", "integrator.", "space.shear.rate", "space.walls."];

/// The numbers that may change between steps, in words.
const ACCEPTED: &str = "temperature, numbers of `interactions`, `integrator` and `space.walls`, and space.shear.rate";

/// The numbers that may change between stages of a run, in words.
pub(super) const STAGE_NUMBERS: &str =
    "time.step, temperature, numbers of `interactions`, `integrator` and `space.walls`, and space.shear.rate";

/// True if a number in this place may change between stages of a run.
pub(super) fn is_of_stages(key: &str) -> bool {
    key == "time.step" || is_changeable(key)
}

/// True if a number in this place may change between steps.
fn is_changeable(key: &str) -> bool {
    // The phase of what oscillates is that of the step: with another frequency it would jump.
    !key.ends_with(".frequency")
        && CHANGEABLE
            .iter()
            .any(|known| key == known.trim_end_matches('.') || known.ends_with('.') && key.starts_with(known))
}

/// A key with dots only, and what is wrong with it, if its number may not change between steps.
pub(crate) fn changeable(key: &str) -> Result<String, String> {
    let key = dotted(key);
    if is_changeable(&key) {
        return Ok(key);
    }
    Err(format!("{key}: it cannot change between steps; accepted: {ACCEPTED}"))
}

/// The scene with overrides, of what its run keeps.
///
/// # Errors
/// [`SceneError`] with all mistakes.
pub(crate) fn overridden(scene: &Scene, settings: &[String]) -> Result<Checked, SceneError> {
    let text = serde_json::to_string(scene).unwrap_or_default();
    WrittenScene::new(scene.title.as_str(), text).with(settings).check_kept(scene.start().cloned())
}

/// The displacement at the start that keeps sheared boundaries where they are at a step though they move at another rate in what follows; none
/// where they stay there anyway.
pub(crate) fn displacement_at(before: &Checked, after: &Scene, step: u64) -> Option<f64> {
    let (model, shear) = (before.model(), before.model().particles().shear?);
    let now = model.clock(step).wrapping_mul(2);
    let shift = |scene: Scene| Checked::presumed(scene).model().particles().shear.map_or(0, |shear| shear.shift(now));
    if shift(after.clone()) == shear.shift(now) {
        return None;
    }
    let mut still = after.clone();
    still.space.shear.as_mut()?.displacement = 0.0;
    let first = f64::from(shear.shift(now).wrapping_sub(shift(still)));
    Some(first / 4_294_967_296.0 * model.units.lengths[0])
}

/// True if two scenes differ in numbers only, and their particles not at all, whatever they write and in which stages.
pub(crate) fn differ_in_numbers(one: &Checked, other: &Checked) -> bool {
    let shape = |scene: &Scene| {
        let mut document = serde_json::to_value(scene).unwrap_or_default();
        for key in ["output", "stages", "announced", "push_off"] {
            document.as_object_mut().and_then(|scene| scene.remove(key));
        }
        // A displacement of zero is left out.
        if let Some(shear) = document.pointer_mut("/space/shear").and_then(Value::as_object_mut) {
            shear.remove("displacement");
        }
        blank(&mut document);
        document
    };
    let particles = |scene: &Checked| {
        scene.model().species.iter().map(|known| (known.count, known.mass, known.fixed)).collect::<Vec<_>>()
    };
    shape(one) == shape(other) && particles(one) == particles(other)
}

/// Replaces all numbers, which may differ.
fn blank(document: &mut Value) {
    match document {
        Value::Number(number) => *number = 0.into(),
        Value::Array(list) => list.iter_mut().for_each(blank),
        Value::Object(object) => object.values_mut().for_each(blank),
        _ => {}
    }
}

/// Checks the numbers that a scene announces: places of numbers that may change, and a scene without mistakes with all
/// of them.
pub(super) fn check_announced(scene: &Checked, problems: &mut Problems) {
    for (place, announced) in scene.announced.iter().enumerate() {
        // Simulations that go on from a stage announce the time steps of others.
        if !is_of_stages(&announced.key) {
            let found = format_args!("`{}`, which cannot change between steps", announced.key);
            problems.refuse(format_args!("announced[{place}].key"), found, ACCEPTED);
        }
    }
    if scene.announced.is_empty() || !problems.is_empty() {
        return;
    }
    let Some(largest) = scene.as_announced() else {
        let found = "a path at which this scene has no number";
        problems.refuse("announced", found, "paths of numbers, as in `interactions.0.repulsion`");
        return;
    };
    if let Err(SceneError::Invalid { problems: others, .. }) = overridden(&largest, &[]) {
        for Problem { path, found, accepted, .. } in others {
            problems.add("announced", format_args!("with the largest values at once, {path}: {found}"), accepted);
        }
    }
}
