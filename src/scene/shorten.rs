//! Shortens a scene to a number of steps: equilibration and the windows of correlations that no longer fit into the run become
//! shorter too.

use serde_json::Value;

use super::Warning;
use super::overrides::dotted;
use crate::numbers::counted;

/// Analyses with windows, and the fewest samples that the schema accepts in one of them.
const WINDOWED: [(&str, u64); 4] = [("diffusion", 2), ("viscosity", 8), ("stress", 2), ("autocorrelations", 2)];

/// Sets the number of steps of a scene, shortens what no longer fits and returns what that was. Values that `overrides` set stay; the
/// checks may refuse them.
pub(super) fn shorten(document: &mut Value, steps: u64, overrides: &[String]) -> Vec<Warning> {
    let asked: Vec<String> =
        overrides.iter().map(|argument| dotted(argument.split('=').next().unwrap_or_default())).collect();
    let is_asked = |path: &str| {
        asked.iter().any(|key| path == key || path.strip_prefix(key.as_str()).is_some_and(|rest| rest.starts_with('.')))
    };
    let mut notices = Vec::new();
    let Some(time) = document.get_mut("time").and_then(Value::as_object_mut) else { return notices };
    let before = time.insert("steps".to_owned(), steps.into()).and_then(|before| whole(&before));
    let equilibration = time.get("equilibration").and_then(whole).unwrap_or(0);
    let windows = windows(document, &|path| is_asked(path));
    let fits = |equilibration: u64| {
        let measured = steps.checked_sub(equilibration);
        measured.is_some_and(|measured| windows.iter().all(|window| window.fits(measured)))
    };
    let mut left_out = equilibration;
    if !fits(equilibration) && !is_asked("time.equilibration") && equilibration > 0 {
        // The same share of the run as before, if that is known and there was a run.
        let share = before
            .filter(|before| *before >= equilibration)
            .map_or(0.25, |before| equilibration as f64 / before as f64);
        left_out = equilibration.min((share * steps as f64) as u64);
    }
    if left_out < equilibration {
        document["time"]["equilibration"] = left_out.into();
        notices.push(notice(
            "time.equilibration",
            format!("shortened from {equilibration} to {left_out} of {steps} steps"),
        ));
    }
    let Some(measured) = steps.checked_sub(left_out) else { return notices };
    // From the last, so that the places of those before hold if it is taken out.
    for window in windows.iter().rev().filter(|window| !window.fits(measured)) {
        if let Some(shortened) = window.shorten(document, measured) {
            notices.insert(usize::from(left_out < equilibration), shortened);
        }
    }
    notices
}

fn notice(path: &str, message: String) -> Warning {
    Warning { path: path.to_owned(), message }
}

/// A whole number, as scenes may write it: `1000` or `1e3`.
fn whole(value: &Value) -> Option<u64> {
    let written = value.as_f64().filter(|number| number.fract() == 0.0 && (0.0..9e15).contains(number));
    value.as_u64().or(written.map(|number| number as u64))
}

/// The window of an analysis.
struct Window {
    name: &'static str,
    /// Its place, in a list of them.
    index: Option<usize>,
    every: u64,
    /// Whether the steps between two samples are asked for as they are.
    every_stays: bool,
    samples: u64,
    fewest: u64,
}

/// The windows of a scene, without those that are asked for as they are.
fn windows(document: &Value, is_asked: &dyn Fn(&str) -> bool) -> Vec<Window> {
    let mut windows = Vec::new();
    for (name, fewest) in WINDOWED {
        let entries: Vec<(Option<usize>, &Value)> = match &document["output"][name] {
            Value::Array(list) => list.iter().enumerate().map(|(index, entry)| (Some(index), entry)).collect(),
            entry => vec![(None, entry)],
        };
        for (index, entry) in entries {
            let (Some(every), Some(samples)) = (whole(&entry["every"]), whole(&entry["window"])) else { continue };
            let mut window = Window { name, index, every, every_stays: false, samples, fewest };
            let place = window.place().replace('[', ".").replace(']', "");
            window.every_stays = is_asked(&format!("{place}.every"));
            if every > 0 && !is_asked(&format!("{place}.window")) {
                windows.push(window);
            }
        }
    }
    windows
}

impl Window {
    fn fits(&self, measured: u64) -> bool {
        u128::from(self.every) * u128::from(self.samples) <= u128::from(measured)
    }

    /// Where it stands, as messages write it.
    fn place(&self) -> String {
        let index = self.index.map(|index| format!("[{index}]")).unwrap_or_default();
        format!("output.{}{index}", self.name)
    }

    /// Takes fewer samples, or the fewest at shorter intervals; if even those do not fit, the analysis is left out. Does nothing if an
    /// override forbids it.
    fn shorten(&self, document: &mut Value, measured: u64) -> Option<Warning> {
        let place = self.place();
        let samples = (measured / self.every).max(self.fewest);
        let every = self.every.min(measured / samples);
        if self.every_stays && every < self.every {
            return None;
        }
        let output = &mut document["output"];
        if every == 0 {
            match (output[self.name].as_array_mut(), self.index) {
                (Some(list), Some(index)) => drop(list.remove(index)),
                _ => drop(output.as_object_mut().and_then(|output| output.shift_remove(self.name))),
            }
            let message =
                format!("left out: {measured} steps after equilibration are fewer than the samples of a window");
            return Some(notice(&place, message));
        }
        let entry = match self.index {
            Some(index) => &mut output[self.name][index],
            None => &mut output[self.name],
        };
        entry["every"] = every.into();
        entry["window"] = samples.into();
        let message = format!(
            "shortened from {} samples of {} to {samples} of {}",
            self.samples,
            counted(self.every, "step"),
            counted(every, "step")
        );
        Some(notice(&format!("{place}.window"), message))
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use crate::scene::{self, Checked, Scene, SceneError, WrittenScene, builtin};

    #[test]
    fn every_built_in_scene_runs_for_any_number_of_steps() {
        for scene in builtin() {
            let own = scene::parse(scene.name, scene.text, &[]).unwrap().into_scene().time;
            for steps in [0, 1, 7, 15, 200, 1000, own.steps, 2 * own.steps] {
                let found = WrittenScene::new(scene.name, scene.text).for_steps(Some(steps)).check().unwrap();
                let notices = found.notices();
                assert_eq!(found.time.steps, steps, "{}", scene.name);
                assert!(notices.is_empty() || steps < own.steps, "{} {steps}: {notices:?}", scene.name);
            }
        }
    }

    fn check(set: &[&str], steps: u64) -> Result<Checked, SceneError> {
        let set: Vec<String> = set.iter().map(|argument| (*argument).to_owned()).collect();
        WrittenScene::read("ideal-dissipative-gas")?.with(&set).for_steps(Some(steps)).check()
    }

    fn gas(steps: u64, set: &[&str]) -> (Scene, Vec<String>) {
        let found = check(set, steps).unwrap();
        let notices = found.notices().iter().map(ToString::to_string).collect();
        (found.into_scene(), notices)
    }

    #[test]
    fn what_fits_stays_and_what_does_not_shrinks() {
        // 1 000 of 40 000 steps are left out; the windows are 200 samples of 5 steps and 100 of 10.
        let (found, notices) = gas(2000, &[]);
        assert!(found.time.equilibration == 1000 && notices.is_empty(), "{notices:?}");
        let (found, notices) = gas(200, &[]);
        let output = &found.output;
        let (diffusion, viscosity) = (output.diffusion.as_ref().unwrap(), output.viscosity.as_ref().unwrap());
        assert_eq!(found.time.equilibration, 5);
        assert_eq!((diffusion.every, diffusion.window, viscosity.every, viscosity.window), (5, 39, 10, 19));
        assert_eq!(
            notices,
            [
                "time.equilibration: shortened from 1000 to 5 of 200 steps",
                "output.diffusion.window: shortened from 200 samples of 5 steps to 39 of 5 steps",
                "output.viscosity.window: shortened from 100 samples of 10 steps to 19 of 10 steps",
            ]
        );
        // Fewer samples than a window may have are taken more often, and none at all are no analysis.
        let (found, _) = gas(40, &[]);
        let viscosity = found.output.viscosity.unwrap();
        assert_eq!((found.time.equilibration, viscosity.every, viscosity.window), (1, 4, 8));
        let (found, notices) = gas(3, &[]);
        assert!(found.output.viscosity.is_none() && found.output.diffusion.unwrap().every == 1, "{notices:?}");
        assert!(notices[2].starts_with("output.viscosity: left out: 3 steps"), "{notices:?}");
        assert!(gas(1, &[]).0.output.diffusion.is_none());
    }

    #[test]
    fn windows_in_lists_shrink_by_themselves() {
        let list = r#"[{"quantity":"velocity","every":1,"window":100},{"quantity":"force","every":9,"window":9}]"#;
        let text = |steps: u64| {
            let mut document: Value = serde_json::from_str(builtin()[0].text).unwrap();
            document["output"] = serde_json::json!({});
            document["output"]["autocorrelations"] = serde_json::from_str(list).unwrap();
            let notices = shorten(&mut document, steps, &[]);
            (document["output"]["autocorrelations"].to_string(), notices.len())
        };
        let [velocity, force] = [r#"{"quantity":"velocity","every":1,"window":"#, r#"{"quantity":"force","every":"#];
        assert_eq!(text(1), ("[]".to_owned(), 3));
        let (found, notices) = text(60);
        assert!(found.starts_with(&format!("[{velocity}")) && found.contains(force) && notices == 3, "{found}");
        assert_eq!(text(100_000).1, 0);
    }

    #[test]
    fn what_is_set_beside_it_is_not_touched() {
        for set in ["time.equilibration=300", r#"time={"step":0.02,"equilibration":300}"#, "output.diffusion.window=41"]
        {
            let error = check(&[set], 200).unwrap_err().to_string();
            assert!(error.contains("accepted: "), "{error}");
        }
        let (found, notices) = gas(200, &["time.equilibration=100", "output.viscosity.every=9"]);
        let viscosity = found.output.viscosity.unwrap();
        assert_eq!((found.time.equilibration, found.output.diffusion.unwrap().window), (100, 20));
        assert_eq!((viscosity.every, viscosity.window, notices.len()), (9, 11, 2), "{notices:?}");
        assert!(check(&["time.equilibration=100", "output.viscosity.every=13"], 200).is_err());
    }
}
