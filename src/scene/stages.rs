//! The scenes of the parts of a run, stages and the values of their ramps: each is the whole scene with the numbers that have changed until
//! then, its own steps, and units that have room for the numbers of all.

use super::changes::{STAGE_NUMBERS, differ_in_numbers, displacement_at, is_of_stages, overridden};
use super::{Checked, Output, Problem, Problems, Scene, SceneError, Stage, Warning, nearest};
use crate::families::{self, Bonds, StepCheck, TimeAxis};
use serde_json::{Map, Value};

/// Stages and values of ramps that a run may have: each is checked like a scene, which takes about a millisecond.
const MOST_PARTS: u64 = 4096;

/// Keys of `output` that no stage has for itself: names, looks and intervals that go through a run.
const OF_THE_WHOLE_RUN: [&str; 4] = ["plot", "snapshot", "checkpoint", "fields"];

/// The sum of the steps of stages stands for `time.steps` where a document leaves that out; without stages it may not.
pub(super) fn sum_up_steps(document: &mut Value, problems: &mut Problems) {
    let Some(stages) = document.get("stages").and_then(Value::as_array).filter(|stages| !stages.is_empty()) else {
        let time = document.get("time").and_then(Value::as_object);
        // A misspelt key is one mistake, not two.
        let is_meant =
            |key: &String| !["step", "equilibration"].contains(&key.as_str()) && nearest(key, ["steps"]).is_some();
        if time.is_some_and(|time| !time.keys().any(is_meant)) {
            problems.add("time.steps", "missing", "a whole number, zero or positive; or `stages`, each with `steps`");
        }
        return;
    };
    // Steps that are no number are refused where they stand.
    let steps = stages.iter().map(|stage| stage["steps"].as_f64().filter(|steps| *steps >= 0.0).unwrap_or(0.0));
    let sum = steps.sum::<f64>() as u64;
    if let Some(time) = document.get_mut("time").and_then(Value::as_object_mut) {
        time.entry("steps").or_insert_with(|| sum.into());
    }
}

impl Checked {
    /// The scenes of the parts of a run in which all numbers are constant, one after the other: of stages, and of the values of ramps. The scene
    /// itself where it has no stages.
    ///
    /// Steps are those of the whole run: a part ends at its `time.steps`, and means leave out what is before the first of its stage.
    ///
    /// # Errors
    /// [`SceneError::Invalid`] with all mistakes of the first part that is wrong.
    pub(crate) fn parts(&self) -> Result<Vec<Self>, SceneError> {
        if self.stages.is_empty() {
            return Ok(vec![self.clone()]);
        }
        let mut found: Vec<Self> = Vec::new();
        for (place, stage) in self.stages.iter().enumerate() {
            for number in 0..stage.parts().len() {
                let next = part(self, found.last(), place, number)?;
                found.push(next);
            }
        }
        Ok(found)
    }

    /// The scenes of its stages, each with the numbers of its end; the scene itself where it has no stages.
    #[doc(hidden)]
    #[must_use]
    pub fn of_stages(&self) -> Vec<Self> {
        let mut parts = self.parts().unwrap_or_default();
        let ends = self.ends_of_stages();
        parts.retain(|part| self.stages.is_empty() || ends.contains(&part.time.steps));
        parts
    }

    /// The scene of the end of a run, which its analyses and means are of: with the numbers of its last stage.
    #[doc(hidden)]
    #[must_use]
    pub fn at_end(&self) -> Self {
        self.part_of(self.time.steps).unwrap_or_else(|_| self.clone())
    }

    /// The scene of the part that a run is in at a step.
    ///
    /// # Errors
    /// As [`Self::parts`].
    pub(crate) fn part_of(&self, step: u64) -> Result<Self, SceneError> {
        let mut parts = self.parts()?;
        let number = part_at(&parts, step);
        Ok(parts.swap_remove(number))
    }
}

/// The number of the part that a run is in at a step, of parts as [`Checked::parts`] gives them; at its end it is in the last.
pub(crate) fn part_at(parts: &[Checked], step: u64) -> usize {
    let last = parts.len().saturating_sub(1);
    parts.iter().position(|part| step < part.time.steps).unwrap_or(last)
}

impl Scene {
    /// Its stages; all its steps are one where it has none.
    pub(crate) fn stages_of_run(&self) -> Vec<Stage> {
        if self.stages.is_empty() { vec![Stage::new(self.time.steps, Map::new())] } else { self.stages.clone() }
    }

    /// What each of its stages measures and writes, or the run where it has none.
    pub(crate) fn outputs(&self) -> Vec<Output> {
        let last = self.stages.len().saturating_sub(1);
        let of_stages = self.stages_of_run().into_iter().enumerate();
        of_stages.filter_map(|(place, stage)| stage.output(&self.output, place == last)).collect()
    }

    /// The first steps of its stages, and the last step of the run; zero alone where it has no stages.
    pub(crate) fn ends_of_stages(&self) -> Vec<u64> {
        let ends = self.stages.iter().scan(0_u64, |end, stage| {
            *end = end.saturating_add(stage.steps);
            Some(*end)
        });
        std::iter::once(0).chain(ends).collect()
    }
}

/// The scene of a part of a stage, after that of the part before.
fn part(whole: &Scene, before: Option<&Checked>, place: usize, number: usize) -> Result<Checked, SceneError> {
    let ends = whole.ends_of_stages();
    let mut base = whole.clone();
    let stages = std::mem::take(&mut base.stages);
    // One that is no output was refused.
    base.output = stages[place].output(&base.output, place + 1 == stages.len()).unwrap_or_default();
    let push_off = stages[place].push_off.or(base.push_off);
    // Bonds at the start are those of the first stage.
    base.push_off = push_off.or(stages[0].push_off);
    let firsts = stages[place].parts();
    let begin = ends[place].saturating_add(firsts[number]);
    // Analyses are those of the whole stage.
    let whole_stage = ends[place + 1];
    let end = firsts.get(number + 1).map_or(whole_stage, |next| ends[place].saturating_add(*next));
    let earlier = stages[..place].iter().flat_map(|stage| stage.settings(0, 1));
    let mut settings: Vec<String> = earlier.chain(stages[place].settings(number, firsts.len())).collect();
    settings.push(format!("time.steps={whole_stage}"));
    settings.push(format!("time.equilibration={}", ends[place].max(base.time.equilibration.min(whole_stage))));
    let mut scene = overridden(&base, &settings)?.into_scene();
    if let Some(displacement) = before.and_then(|before| displacement_at(before, &scene, begin)) {
        settings.push(format!("space.shear.displacement={displacement}"));
        scene = overridden(&base, &settings)?.into_scene();
    }
    let interval = scene.time.step;
    let time = before.map_or(0.0, |before| before.model().time.at(begin));
    scene.time.steps = end;
    scene.announced = whole.announced_in_all();
    scene.push_off = push_off;
    let after_turns = before.is_some_and(|before| before.model().follows_paths(&before.output));
    Ok(Checked::presumed(scene).with_times(TimeAxis { step: begin, time, interval }).after_turns(after_turns))
}

/// Shares another number of steps among stages, in proportion, one for each at least. Returns what was done.
pub(super) fn shorten(document: &mut Value, steps: u64) -> Option<Warning> {
    let stages = document.get_mut("stages").and_then(Value::as_array_mut).filter(|stages| !stages.is_empty())?;
    let before: Vec<u64> =
        stages.iter().map(|stage| stage["steps"].as_f64().map(|steps| steps as u64)).collect::<Option<_>>()?;
    let sum: u64 = before.iter().copied().fold(0, u64::saturating_add);
    if sum == steps || sum == 0 || steps < before.len() as u64 {
        return None;
    }
    let mut left = steps;
    for (number, (stage, own)) in stages.iter_mut().zip(&before).enumerate() {
        let following = (before.len() - 1 - number) as u64;
        let share = (steps as f64 * *own as f64 / sum as f64).round() as u64;
        let share = if following == 0 { left } else { share.clamp(1, left - following) };
        stage["steps"] = share.into();
        left -= share;
    }
    let message = format!("{sum} steps in all made {steps}, each in proportion");
    Some(Warning { path: "stages".to_owned(), message })
}

/// Checks the stages of a scene that is right without them.
pub(super) fn check(whole: &Checked, step: StepCheck, problems: &mut Problems) {
    if whole.push_off.is_some() {
        check_push_off(whole, "push_off".to_owned(), problems);
    }
    if whole.stages.is_empty() || !problems.is_empty() {
        return;
    }
    let sum = whole.stages.iter().map(|stage| stage.steps).fold(0, u64::saturating_add);
    if sum != whole.time.steps {
        let accepted = format!("{sum}, the sum of the steps of its stages, or no `time.steps` at all");
        problems.refuse("time.steps", whole.time.steps, accepted);
    }
    for (place, stage) in whole.stages.iter().enumerate() {
        check_keys(whole, place, problems);
        check_output(whole, place, problems);
        if stage.push_off.is_some() {
            check_push_off(whole, format!("stages[{place}].push_off"), problems);
        }
        if stage.ramp.is_empty() && stage.ramp_every.is_some() {
            let found = "steps between values of a ramp, of a stage without one";
            problems.refuse(format!("stages[{place}].ramp_every"), found, "no `ramp_every`, or a `ramp`");
        }
    }
    let count = whole.stages.iter().map(Stage::part_count).fold(0, u64::saturating_add);
    if count > MOST_PARTS {
        let accepted = format!("at most {MOST_PARTS}, with more steps in `ramp_every`");
        problems.refuse("stages", format!("{count} stages and values of ramps"), accepted);
    }
    let mut before: Option<Checked> = None;
    for (place, stage) in whole.stages.iter().enumerate() {
        if !problems.is_empty() {
            return;
        }
        let parts = stage.parts().len();
        for number in 0..parts {
            if !problems.is_empty() {
                return;
            }
            let path = format!("stages[{place}]");
            match part(whole, before.as_ref(), place, number) {
                Ok(next) => {
                    let mut own = Problems::default();
                    families::check(&next, step, &mut own);
                    repeat(stage, &path, own.into_parts().0, problems);
                    if !differ_in_numbers(before.as_ref().unwrap_or(whole), &next) {
                        let found = "a number in a place where the scene has none";
                        problems.refuse(
                            &path,
                            found,
                            "paths of numbers of the scene, as in `interactions.0.repulsion`",
                        );
                    }
                    before = Some(next);
                }
                Err(SceneError::Invalid { problems: others, .. }) => repeat(stage, &path, others, problems),
                Err(error) => problems.refuse(&path, error, "a scene without mistakes"),
            }
        }
    }
}

/// A largest force of bonds is of bonds that have a potential.
fn check_push_off(scene: &Checked, path: String, problems: &mut Problems) {
    let bonds = scene.model().particles().bonds.as_ref();
    if !bonds.is_some_and(Bonds::have_potentials) {
        let found = "a largest force of bonds, in a scene without bonds that have a potential";
        problems.refuse(path, found, "no `push_off`: the repulsion of pairs is bounded by itself");
    }
}

/// Checks the numbers that a stage changes.
fn check_keys(whole: &Checked, place: usize, problems: &mut Problems) {
    let stage = &whole.stages[place];
    let keys = stage.keys();
    let set = stage.changes().map(|(key, value)| (format!("set.{key}"), value.clone(), value.is_number(), "a number"));
    let ramps = stage.ramp.values().zip(stage.ramps());
    let ramps = ramps.map(|(value, (key, ends))| {
        (format!("ramp.{key}"), value.clone(), ends.is_some(), "a list of two numbers, the first and the last value")
    });
    for (number, (name, value, is_right, accepted)) in set.chain(ramps).enumerate() {
        let (path, key) = (format!("stages[{place}].{name}"), &keys[number]);
        if keys[..number].contains(key) {
            problems.refuse(&path, "a number that is given twice", "each number once");
        }
        if !is_of_stages(key) {
            problems.refuse(path, "a key that cannot change in a run", STAGE_NUMBERS);
        } else if !is_right {
            problems.refuse(path, value, accepted);
        } else if key == "time.step" && whole.model().particles().have_oscillating_forces() {
            let found = "a change of the time step of a field that oscillates, whose phase is that of its steps";
            problems.refuse(path, found, "one time step in all stages, or a constant field");
        } else if key == "time.step" && whole.model().has_memory() {
            let found = "a change of the time step of baths that remember";
            problems.refuse(path, found, "one time step in all stages, or baths without memory");
        }
    }
}

/// Checks what a stage measures and writes.
fn check_output(whole: &Checked, place: usize, problems: &mut Problems) {
    let stage = &whole.stages[place];
    let path = |key: &str| format!("stages[{place}].output.{key}");
    for key in stage.output.keys().filter(|key| OF_THE_WHOLE_RUN.contains(&key.as_str())) {
        let accepted =
            format!("`energies`, `trajectory` and analyses in a stage; `output.{key}` is one for the whole run");
        problems.refuse(path(key), format_args!("`{key}`"), accepted);
    }
    let outputs = whole.outputs();
    let Some(output) = outputs.get(place).filter(|_| outputs.len() == whole.stages.len()) else {
        problems.refuse(format!("stages[{place}].output"), "no output", "keys and values as `output` has them");
        return;
    };
    let first = outputs.iter().find_map(|output| output.trajectory.as_ref());
    if let (Some(own), Some(first)) = (&output.trajectory, first)
        && (own.format, &own.species) != (first.format, &first.species)
    {
        let accepted = "the same format and species in the trajectories of all stages, which are one file";
        problems.refuse(path("trajectory"), "a trajectory of another format or of other species", accepted);
    }
}

/// Reports the mistakes of a stage.
fn repeat(stage: &Stage, path: &str, others: Vec<Problem>, problems: &mut Problems) {
    for Problem { path: place, found, accepted, .. } in others {
        let key = place.strip_prefix("output.").and_then(|key| key.split(['.', '[']).next());
        if key.is_some_and(|key| stage.output.contains_key(key)) {
            problems.add(format_args!("{path}.{place}"), found, accepted);
        } else {
            problems.add(path, format_args!("with its numbers, {place}: {found}"), accepted);
        }
    }
}
