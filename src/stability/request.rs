//! What a map of stability is asked for.

use super::range::{Range, Spacing, number_of};
use crate::families::{Checked, StepCheck};
use crate::output::Id;
use crate::quantity::{Quantity, Unit};
use crate::run;
use crate::scene::{SceneError, StateFiles, WrittenScene};
use crate::study::{self, LENGTHS, Setting, ShortKeys, StudyError, check_seeds, further_seed};
use crate::tradeoff::{self, References, Stretch, names_of_table, predicted};
use serde::{Deserialize, Serialize};
use serde_json::Value;

/// The key that is varied where nobody says which.
const STEP: &str = "time.step";

/// From a quarter of the time step of the scene to sixteen times.
const USUAL: ([f64; 2], usize) = ([0.25, 16.0], 7);

/// Steps that means are taken over, at least.
const FEWEST_STEPS: f64 = 256.0;
/// Rows of the table of energies in them, at least.
const FEWEST_ROWS: u64 = 64;

/// A scene, what of it to vary, and what is right.
#[derive(Debug, Clone, PartialEq)]
pub struct Request {
    pub(super) arguments: Arguments,
    /// The scene before anything is varied.
    pub(super) base: Checked,
    /// The key along rows, and the numbers of the grid.
    pub(super) along: Along,
    /// The key of rows; none for a single row.
    pub(super) rows: Option<Range>,
}

/// A request as it is written into the summary, and read from there.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub(super) struct Arguments {
    /// The scene.
    #[serde(flatten)]
    pub scene: WrittenScene,
    /// Keys and their values, one or two.
    pub vary: Vec<String>,
    /// The largest error of what is right.
    pub tolerance: f64,
    /// References of the user.
    pub references: References,
    /// Measures to compare; the usual ones if empty.
    pub measures: Vec<String>,
    /// How often the distance of neighbours in a row is halved at an edge.
    pub bisections: u32,
    /// Independent runs of each scene; none for one.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub seeds: Option<u32>,
    /// The files that runs start from.
    #[serde(default, skip_serializing_if = "StateFiles::is_empty")]
    pub state_files: StateFiles,
}

/// A key whose numbers increase along rows.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Along {
    pub key: String,
    pub values: Vec<f64>,
    pub spacing: Spacing,
}

impl Request {
    /// Varies the scene in a file, or a built-in one.
    ///
    /// Each of `vary` is a key with a range, `key=low..high/points`, or with values, `key=value,value,…`. One of them makes a
    /// row, two a map: `time.step`, or else the second, is varied along rows. Without any the time step is. With
    /// `steps` the scene has so many, to which its equilibration is shortened where it does not fit, as
    /// [`crate::scene::WrittenScene::for_steps`] does it; an override of
    /// `time.steps` is such a number too.
    ///
    /// # Errors
    /// [`StudyError::Arguments`] with all mistakes at once, [`StudyError::Scene`] where no scene of the map is accepted.
    pub fn load(source: &str, set: &[String], steps: Option<u64>, vary: &[String]) -> Result<Self, StudyError> {
        let scene = study::written_scene(source, set, steps)?;
        let (state_files, vary) = (StateFiles::of(&scene.name), vary.to_vec());
        Self::new(Arguments { scene, vary, state_files, tolerance: 0.05, bisections: 3, ..Arguments::default() })
    }

    pub(super) fn new(mut arguments: Arguments) -> Result<Self, StudyError> {
        let mut mistakes = Vec::new();
        let mut ranges = Vec::new();
        for argument in &arguments.vary {
            match Range::parse(argument) {
                Ok(Range { key, .. }) if LENGTHS.contains(&key.as_str()) => {
                    let why = "all runs cover the same simulated time; --steps N says how much";
                    mistakes.push(format!("`{key}` cannot be varied: {why}"));
                }
                Ok(Range { key, .. }) if ranges.iter().any(|known: &Range| known.key == key) => {
                    mistakes.push(format!("`{key}` is varied twice"));
                }
                Ok(range) => ranges.push(range),
                Err(message) => mistakes.push(format!("`--vary {argument}`: {message}")),
            }
        }
        if arguments.vary.len() > 2 {
            mistakes.push(format!("{} keys are varied; accepted: one for a row, two for a map", arguments.vary.len()));
        }
        let base = arguments.scene.check_among(&arguments.state_files, StepCheck::Allow)?;
        arguments.state_files.note(&base);
        mistakes.extend(study::refusal_of_stages(&base));
        if ranges.is_empty() && mistakes.is_empty() {
            let ([low, high], points) = USUAL;
            let step = base.time.step;
            ranges.extend(Range::parse(&format!("{STEP}={}..{}/{points}", low * step, high * step)));
        }
        StudyError::refuse(mistakes)?;
        check_values(&arguments.scene, &ranges)?;
        let place = ranges.iter().position(|range| range.key == STEP).unwrap_or(ranges.len().saturating_sub(1));
        let range = ranges.remove(place);
        let Some(values) = range.numbers() else {
            let why = "which takes numbers that increase; accepted: key=low..high/points";
            return Err(StudyError::mistake(format!("`{}` is varied along rows, {why}", range.key)));
        };
        let along = Along { key: range.key, values, spacing: range.spacing };
        let mut request = Self { arguments, base, along, rows: ranges.pop() };
        // Keys that say what file particles start from, or how.
        let starts_vary = request.keys().iter().any(|key| *key == "state" || key.starts_with("state."));
        // A key that is misspelt, say: no scene at all is a mistake, some that are none are a result.
        let (mut first, mut is_one) = (None, false);
        for (row, value) in request.places() {
            match request.scene(row, value, 0) {
                Ok(scene) => {
                    request.arguments.state_files.note(&scene);
                    is_one = true;
                }
                Err(error @ SceneError::StateChanged { .. }) => return Err(error.into()),
                Err(error) => first = first.or(Some(error)),
            }
            if is_one && !starts_vary {
                break;
            }
        }
        match first {
            Some(error) if !is_one => Err(error.into()),
            _ => Ok(request),
        }
    }

    /// The same, in which errors up to this part are right.
    ///
    /// # Errors
    /// [`StudyError::Arguments`] unless it is a number above zero.
    pub fn with_tolerance(mut self, tolerance: f64) -> Result<Self, StudyError> {
        if !(tolerance.is_finite() && tolerance > 0.0) {
            return Err(StudyError::mistake(format!("a tolerance of {tolerance}; accepted: a number above zero")));
        }
        self.arguments.tolerance = tolerance;
        Ok(self)
    }

    /// The same, in which edges are located to a part 2⁻ⁿ of the distance between neighbours in a row.
    #[must_use]
    pub fn with_bisections(mut self, bisections: u32) -> Self {
        self.arguments.bisections = bisections.min(20);
        self
    }

    /// The same with `seeds` independent runs of each scene, side by side in memory: means are taken over them, with
    /// standard errors from their scatter, and a scene is unstable that is with one of them.
    ///
    /// # Errors
    /// [`StudyError::Arguments`] unless there are 1 to [`study::MOST_SEEDS`], and where the seed is varied.
    pub fn with_seeds(mut self, seeds: u32) -> Result<Self, StudyError> {
        check_seeds(seeds, self.cell_count(), self.keys())?;
        self.arguments.seeds = (seeds > 1).then_some(seeds);
        Ok(self)
    }

    /// The same with measures to compare, and what they should be where no law says it.
    ///
    /// # Errors
    /// [`StudyError::Arguments`] names those that no run has, and those that there is nothing to compare with.
    pub fn with_measures(mut self, measures: &[String], references: References) -> Result<Self, StudyError> {
        let columns = run::quantities(self.base.model());
        let known: Vec<&str> = columns.into_iter().chain(names_of_table(&self.base)).collect();
        let mut mistakes = Vec::new();
        let asked = measures.iter().map(|measure| ("--measure", measure.as_str()));
        for (option, measure) in asked.chain(references.measures().map(|measure| ("--reference", measure))) {
            let lawless = || format!("no law says what `{measure}` should be; add `--reference {measure}=VALUE`");
            let is_known = references.known(measure, &self.base).is_some();
            mistakes.extend(tradeoff::unknown(option, measure, &known).or_else(|| (!is_known).then(lawless)));
        }
        StudyError::refuse(mistakes)?;
        self.arguments.measures = measures.to_vec();
        self.arguments.references = references;
        Ok(self)
    }

    /// The measures that are compared.
    pub(super) fn measures(&self) -> Vec<String> {
        let Arguments { measures, references, .. } = &self.arguments;
        let mut all = measures.clone();
        if all.is_empty() {
            let columns = run::quantities(self.base.model());
            let compared = Quantity::columns_shown_in(Unit::Temperature).filter(|name| columns.contains(name));
            let usual = compared.chain(names_of_table(&self.base));
            all.extend(usual.filter(|name| predicted(name, &self.base).is_some()).map(str::to_owned));
        }
        all.extend(references.measures().map(str::to_owned).filter(|name| !measures.contains(name)));
        all.dedup();
        all
    }

    /// The scene before anything is varied.
    #[must_use]
    pub fn base(&self) -> &Checked {
        &self.base
    }

    /// Scenes of the grid.
    pub(crate) fn cell_count(&self) -> usize {
        self.row_count() * self.along.values.len()
    }

    /// The rows and values of the grid.
    pub(super) fn places(&self) -> Vec<(usize, f64)> {
        (0..self.row_count()).flat_map(|row| self.along.values.iter().map(move |value| (row, *value))).collect()
    }

    pub(super) fn row_count(&self) -> usize {
        self.rows.as_ref().map_or(1, |rows| rows.values.len())
    }

    /// The key of rows.
    pub(super) fn row_key(&self) -> Option<&str> {
        self.rows.as_ref().map(|rows| rows.key.as_str())
    }

    /// The setting of a row.
    pub(super) fn setting(&self, row: usize) -> Option<Setting> {
        let rows = self.rows.as_ref()?;
        Some(Setting { key: rows.key.clone(), value: rows.values.get(row)?.clone() })
    }

    /// What a row is called: `friction = 4.5`.
    pub(super) fn row_label(&self, row: usize) -> String {
        self.setting(row).map_or_else(String::new, |setting| self.short_keys().label(&[setting]))
    }

    /// The keys that are varied.
    fn keys(&self) -> Vec<&str> {
        self.row_key().into_iter().chain([self.along.key.as_str()]).collect()
    }

    /// Their short names.
    pub(super) fn short_keys(&self) -> ShortKeys {
        ShortKeys::of(&self.keys())
    }

    /// A scene of the map, with the length that the base has and the seed that is `further` places after its own.
    pub(super) fn varied(&self, row: usize, value: f64, further: u32) -> Result<Checked, SceneError> {
        let along = Setting { key: self.along.key.clone(), value: number_of(value) };
        let settings = self.setting(row).into_iter().chain([along]).map(|setting| setting.argument());
        let settings: Vec<String> = settings.chain(further_seed(self.base.seed, further)).collect();
        let Arguments { scene, state_files, .. } = &self.arguments;
        scene.clone().with(&settings).check_among(state_files, StepCheck::Allow)
    }

    /// A scene of the map over the common stretch of time with each seed.
    pub(super) fn scenes(&self, row: usize, value: f64) -> Result<Vec<Checked>, SceneError> {
        (0..self.seeds()).map(|further| self.scene(row, value, further)).collect()
    }

    /// The independent runs of each scene.
    pub(super) fn seeds(&self) -> u32 {
        self.arguments.seeds.unwrap_or(1)
    }

    /// A scene of the map over the common stretch of time, with such a seed.
    pub(super) fn scene(&self, row: usize, value: f64, further: u32) -> Result<Checked, SceneError> {
        let found = self.varied(row, value, further)?;
        let stretch = Stretch::of(&self.base);
        let step = found.time.step;
        // However long the steps, there are enough of them to see what becomes of the scene.
        let averaged = (stretch.averaged / step).ceil().max(FEWEST_STEPS) as u64;
        let before = if stretch.equilibration > 0.0 { FEWEST_STEPS } else { 0.0 };
        let every = (self.base.output.energies.every as f64 * self.base.time.step / step).round() as u64;
        Ok(found.changed(|scene| {
            scene.time.equilibration = (stretch.equilibration / step).round().max(before) as u64;
            scene.time.steps = scene.time.equilibration.saturating_add(averaged);
            scene.output.energies.every = every.clamp(1, (averaged / FEWEST_ROWS).max(1));
        }))
    }

    /// What tells this map from others: its scenes, and what is right.
    pub(super) fn id(&self) -> Id {
        let scenes = self.places().into_iter().filter_map(|(row, value)| self.scene(row, value, 0).ok());
        Id::of_study(scenes.map(|scene| Id::of_run(&scene)), &self.arguments)
    }
}

/// Refuses single values that make no scene whatever the others are, such as a time step of zero; a key that takes none of its
/// values is refused with the scene.
fn check_values(scene: &WrittenScene, ranges: &[Range]) -> Result<(), StudyError> {
    let mistake = |key: &str, value: &Value| {
        let setting = Setting { key: key.to_owned(), value: value.clone() }.argument();
        let problem = scene.clone().with(&[setting]).misshapen()?;
        Some(format!("`--vary {key}=…`: {problem}"))
    };
    let of_range = |range: &Range| {
        let wrong: Vec<String> = range.values.iter().filter_map(|value| mistake(&range.key, value)).collect();
        if wrong.len() < range.values.len() { wrong } else { Vec::new() }
    };
    StudyError::refuse(ranges.iter().flat_map(of_range).collect())
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    fn request(vary: &[&str]) -> Result<Request, StudyError> {
        let vary: Vec<String> = vary.iter().map(|text| (*text).to_owned()).collect();
        Request::load("dpd-fluid", &["space.box=[6,6,6]".to_owned()], None, &vary)
    }

    #[test]
    fn the_time_step_is_varied_along_rows() {
        let alone = request(&[]).unwrap();
        let step = alone.base.time.step;
        assert_eq!((alone.along.key.as_str(), alone.row_count(), alone.cell_count()), ("time.step", 1, 7));
        assert_eq!((alone.along.values[0], alone.along.values[6]), (0.25 * step, 16.0 * step));
        let map = request(&["time.step=0.01..0.1/3", "interactions.0.friction=1..100/5"]).unwrap();
        assert_eq!(
            (map.along.key.as_str(), map.row_key(), map.cell_count()),
            ("time.step", Some("interactions.0.friction"), 15)
        );
        assert_eq!(map.row_label(1), "friction = 3.162");
        let other = request(&["integrator.type=splitting,groot-warren", "temperature=0.5..2/3"]).unwrap();
        assert_eq!((other.along.key.as_str(), other.row_label(1).as_str()), ("temperature", "type = groot-warren"));
    }

    #[test]
    fn values_that_make_no_scene_are_mistakes() {
        let error = request(&["time.step=0..1/3", "temperature=-1..1/3"]).unwrap_err().to_string();
        for part in ["`--vary time.step=…`: time.step: found 0; accepted: ", "temperature: found -1; accepted: "] {
            assert!(error.contains(part), "{error}");
        }
    }

    #[test]
    fn all_runs_cover_the_time_of_the_scene_with_enough_steps() {
        let map = request(&["time.step=1e-3..10/9"]).unwrap();
        let time = |scene: &Checked| (scene.time.steps - scene.time.equilibration) as f64 * scene.time.step;
        let wanted = time(&map.base);
        for value in &map.along.values {
            let scene = map.scene(0, *value, 0).unwrap();
            let averaged = scene.time.steps - scene.time.equilibration;
            assert!(averaged >= 256 && averaged / scene.output.energies.every >= 64, "{value}");
            assert!(time(&scene) >= wanted * (1.0 - 1e-12), "{value}");
        }
    }

    #[test]
    fn mistakes_are_named_all_at_once() {
        let text = request(&["time.steps=1..100/3", "a=1..2/10000000", "b"]).unwrap_err().to_string();
        assert_eq!(text.lines().count(), 4, "{text}");
        let text = request(&["time.setp=0.01..0.1/3"]).unwrap_err().to_string();
        assert!(text.contains("did you mean `step`?"), "{text}");
        let text = request(&["time.step=0.1,0.05"]).unwrap_err().to_string();
        assert!(text.contains("numbers that increase"), "{text}");
        let measures = |names: &[&str]| {
            let names: Vec<String> = names.iter().map(|name| (*name).to_owned()).collect();
            request(&[]).unwrap().with_measures(&names, References::default())
        };
        let text = measures(&["presure", "pressure"]).unwrap_err().to_string();
        assert!(text.contains("did you mean `pressure`?") && text.contains("--reference pressure=VALUE"), "{text}");
        assert_eq!(measures(&["temperature"]).unwrap().measures(), ["temperature"]);
        assert_eq!(request(&[]).unwrap().measures(), ["temperature", "configurational_temperature"]);
        let cells = Request::load("voronoi-energy", &[], None, &[]).unwrap();
        assert_eq!(cells.measures(), ["limited_exchange_share"]);
        let water = Request::load("shallow-water", &[], None, &[]).unwrap();
        assert_eq!(water.measures(), ["energy_drift"]);
    }
}
