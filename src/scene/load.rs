//! Loading: from a file or a built-in name to a checked scene.

use crate::families::Checked;
use std::collections::HashSet;
use std::fs::File;
use std::io::{self, Read};
use std::path::Path;
use std::sync::{Arc, LazyLock};

use serde::{Deserialize, Serialize};
use serde_json::Value;

use crate::families::{self, StepCheck};

use super::path::related;
use super::shape::{Schema, Substitute};
use super::start::{Fits, Given};
use super::{
    FileStart, KeptStart, Problem, Problems, Scene, SceneError, StateFiles, System, SystemKind, Warning, builtin,
    nearest, overrides, semantics, shape, shorten, start, text,
};

/// Reads the scene in the file `source`, or the built-in scene of that name where there is no such file, applies
/// `overrides` (`path.to.key=value`, in order) and checks the result.
///
/// ```
/// let scene = mesoscope::scene::load("dpd-fluid", &["time.step=0.02".to_owned()])?;
/// assert_eq!(scene.time.step, 0.02);
///
/// let error = mesoscope::scene::load("dpd-fluid", &["time.setp=0.02".to_owned()]).unwrap_err();
/// assert!(error.to_string().contains("time.setp: unknown key; did you mean `step`?"));
/// # Ok::<(), mesoscope::scene::SceneError>(())
/// ```
///
/// # Errors
/// No such scene, a file that cannot be read, text that is not JSON, an override that does not fit, or
/// [`SceneError::Invalid`] with all mistakes at once.
pub fn load(source: &str, overrides: &[String]) -> Result<Checked, SceneError> {
    WrittenScene::read(source)?.with(overrides).check()
}

/// Reads a scene from JSON text; `name` is what messages call it, and a file of its state is looked for beside a file of that
/// name. Otherwise like [`load`].
///
/// ```
/// use mesoscope::scene::{self, SceneError};
///
/// let text = r#"{
///     "title": "Soft particles", "space": {"box": [5, 5, 5]}, "time": {"step": 0.04, "steps": 100},
///     "temperature": 1, "particles": [{"species": "A", "number_density": 3}],
///     "interactions": [{"type": "dpd", "repulsion": 25, "friction": 4.5}]
/// }"#;
/// let scene = scene::parse("soft", text, &["seed=7".to_owned()])?;
/// assert_eq!((scene.seed, scene.output.energies.every), (7, 20));
///
/// let slips = ["time.stepps=3", "temperature=-1"].map(str::to_owned);
/// match scene::parse("soft", text, &slips) {
///     Err(SceneError::Invalid { problems, .. }) => {
///         assert_eq!(problems[0].suggestion.as_deref(), Some("steps"));
///         assert_eq!(problems[1].to_string(), "temperature: found -1; accepted: a number, zero or positive");
///     }
///     other => unreachable!("two mistakes went unnoticed: {other:?}"),
/// }
/// # Ok::<(), SceneError>(())
/// ```
///
/// # Errors
/// Text that is not JSON, or [`SceneError::Invalid`] with all mistakes at once, of overrides too.
pub fn parse(name: &str, text: &str, overrides: &[String]) -> Result<Checked, SceneError> {
    WrittenScene::new(name, text).with(overrides).check()
}

/// A scene as it was written, and what is to change in it before it is checked.
///
/// ```
/// use mesoscope::scene::{self, WrittenScene};
///
/// let short = WrittenScene::read("dpd-fluid")?.for_steps(Some(200)).check()?;
/// assert_eq!((short.time.steps, short.time.equilibration), (200, 50));
/// assert_eq!(short.notices()[0].to_string(), "time.equilibration: shortened from 500 to 50 of 200 steps");
/// # Ok::<(), scene::SceneError>(())
/// ```
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct WrittenScene {
    /// The name of the scene in messages; a file of its state is looked for beside a file of that name.
    #[serde(rename = "scene")]
    pub name: String,
    /// Its text.
    pub text: String,
    /// Overrides, `path.to.key=value`, in order.
    pub set: Vec<String>,
    /// The number of steps of the scene, to which equilibration and windows of correlations that no longer fit are shortened, unless an
    /// override sets them.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub steps: Option<u64>,
}

impl WrittenScene {
    /// The scene in the file `source`, or the built-in scene of that name.
    ///
    /// # Errors
    /// There is no such scene, or the file cannot be read or is not text.
    pub fn read(source: &str) -> Result<Self, SceneError> {
        let path = Path::new(source);
        // A directory of a scene's name is the likely place of its last run, not a scene.
        if path.exists() && !path.is_dir() {
            let bytes = bytes(path).map_err(|error| SceneError::Read { path: path.to_owned(), source: error })?;
            return Ok(Self::new(source, String::from_utf8(bytes).map_err(|error| not_text(source, &error))?));
        }
        match builtin().iter().find(|scene| scene.name == source) {
            Some(scene) => Ok(Self::new(scene.name, scene.text)),
            None => Err(unknown_builtin(source)),
        }
    }

    /// A scene of this name and text.
    #[must_use]
    pub fn new(name: impl Into<String>, text: impl Into<String>) -> Self {
        Self { name: name.into(), text: text.into(), ..Self::default() }
    }

    /// The same with further overrides.
    #[must_use]
    pub fn with(mut self, overrides: &[String]) -> Self {
        self.set.extend_from_slice(overrides);
        self
    }

    /// The same with this number of steps, where one is given.
    #[must_use]
    pub fn for_steps(self, steps: Option<u64>) -> Self {
        Self { steps: steps.or(self.steps), ..self }
    }

    /// The scene, checked, with a model of it.
    ///
    /// # Errors
    /// Text that is not JSON, a file of its state that cannot be read, or [`SceneError::Invalid`] with all mistakes at once.
    pub fn check(&self) -> Result<Checked, SceneError> {
        self.check_among(&StateFiles::default(), StepCheck::Refuse)
    }

    /// The same; `fits` is asked once the particles of its file or its molecules are counted, before any of them is read or placed. A few
    /// are not worth asking.
    ///
    /// # Errors
    /// As [`Self::check`], and what `fits` returns.
    pub fn check_fitting(&self, fits: &Fits<'_>) -> Result<Checked, SceneError> {
        self.check_from(StepCheck::Refuse, Source::File(&StateFiles::default(), Some(fits)))
    }

    /// The same with the files that other scenes of the same text were read with; [`StepCheck::Allow`] accepts a time step that no scheme
    /// is stable with, to see what becomes of it.
    ///
    /// # Errors
    /// As [`Self::check`], and [`SceneError::StateChanged`] if one of the files is not what it was.
    pub(crate) fn check_among(&self, files: &StateFiles, step: StepCheck) -> Result<Checked, SceneError> {
        self.check_from(step, Source::File(files, None))
    }

    /// The same, but the file of a state is not read: what a run keeps of it is given, as far as it is known. Nor is the time step
    /// refused: whoever let the run begin has decided that.
    ///
    /// # Errors
    /// As [`Self::check`].
    pub(crate) fn check_kept(&self, start: Option<Arc<FileStart>>) -> Result<Checked, SceneError> {
        self.check_from(StepCheck::Allow, Source::Kept(start))
    }

    /// The text with overrides written into it, and nothing else changed but the path of the file of its state: that becomes absolute, since
    /// the text may be kept anywhere.
    ///
    /// # Errors
    /// As [`Self::check_among`].
    pub(crate) fn resolved(&self, files: &StateFiles) -> Result<String, SceneError> {
        // After this there is no mistake in text and overrides.
        self.check_among(files, StepCheck::Refuse)?;
        let (mut document, _) = text::parse(&self.name, &self.text)?;
        overridden(&mut document, &self.set);
        if let Some(file) = document.pointer_mut("/state/file")
            && let Some(path) = file.as_str().map(|file| files.path(&self.name, file))
        {
            *file = std::path::absolute(&path).unwrap_or(path).display().to_string().into();
        }
        let text = serde_json::to_string_pretty(&document).map_err(|error| mismatch(&self.name, &error))?;
        Ok(text + "\n")
    }

    /// The seed that it asks for, whatever else it says.
    ///
    /// # Errors
    /// Text that is not JSON.
    pub(crate) fn seed(&self) -> Result<u64, SceneError> {
        let (mut document, _) = text::parse(&self.name, &self.text)?;
        overridden(&mut document, &self.set);
        // A seed that is none is a mistake of the scene.
        Ok(document.get("seed").and_then(Value::as_u64).unwrap_or_default())
    }

    /// The first mistake that overrides make in the shape of a scene, whatever it means.
    pub(crate) fn misshapen(&self) -> Option<Problem> {
        self.substituted(Substitute::Least).ok()?.problems.iter().next().cloned()
    }

    /// The scene that can be read of it, with numbers in place of those that are refused.
    fn substituted(&self, substitute: Substitute) -> Result<Reading, SceneError> {
        let (mut document, mut problems) = text::parse(&self.name, &self.text)?;
        problems.extend(overridden(&mut document, &self.set));
        super::stages::sum_up_steps(&mut document, &mut problems);
        let mut notices = self.steps.map(|steps| shorten::shorten(&mut document, steps, &self.set)).unwrap_or_default();
        notices.extend(self.steps.and_then(|steps| super::stages::shorten(&mut document, steps)));
        let left_out = |place: &str| document.pointer(place).is_none();
        let (integrator, colour) = (left_out("/integrator"), left_out("/output/snapshot/color"));
        let system = kind_of_system(&document, &mut problems);
        problems.append(shape::check(&SHAPE, &mut document, system, substitute));
        let groups = document.get("particles").and_then(Value::as_array).into_iter().flatten();
        let given = groups.map(Given::of_group).collect();
        // What the shape check has mended may be readable, and then everything can be said at once.
        if !problems.is_empty() {
            fill_in(&mut document, substitute);
        }
        let scene = serde_json::from_value(document).map(|mut scene| {
            families::complete(&mut scene, integrator, colour);
            scene
        });
        Ok(Reading { problems, scene, notices, given })
    }

    fn check_from(&self, step: StepCheck, source: Source<'_>) -> Result<Checked, SceneError> {
        let name = self.name.as_str();
        // A run that was begun without a rule of relaxation goes on without one.
        let is_kept = matches!(source, Source::Kept(_));
        let mut reading = self.substituted(Substitute::Least)?;
        let mut unreadable = Problems::default();
        if let Ok(scene) = &mut reading.scene {
            match source {
                // Numbers that stand in for refused ones are not compared with a file.
                Source::File(..) if reading.problems.iter().any(|known| says_where_particles_are(&known.path)) => {}
                Source::File(files, fits) => {
                    unreadable = start::read(scene, &reading.given, (name, files), fits, &mut reading.notices)?;
                    let known: Vec<&str> = reading.problems.iter().map(|known| known.path.as_str()).collect();
                    unreadable.retain(|found| known.iter().all(|known| !related(known, &found.path)));
                }
                Source::Kept(start) => scene.kept = start.map(KeptStart::of).unwrap_or_default(),
            }
        }
        if reading.problems.is_empty() && unreadable.is_empty() {
            let mut scene = reading.scene.map_err(|error| mismatch(name, &error))?;
            let mut problems = semantics::check(&scene);
            // What needs a model or a start needs a scene that makes sense.
            if !problems.is_empty() {
                return Err(invalid(name, problems, true));
            }
            if !is_kept {
                families::settle(&mut scene);
            }
            let checked = Checked::presumed(scene).noting(reading.notices);
            families::check(&checked, step, &mut problems);
            super::changes::check_announced(&checked, &mut problems);
            super::stages::check(&checked, step, &mut problems);
            return if problems.is_empty() { Ok(checked) } else { Err(invalid(name, problems, false)) };
        }
        let mut problems = reading.problems;
        problems.append(unreadable);
        // What a file should say, or what its box is compared with, is missing wherever it is needed.
        if let Some(scene) = reading.scene.ok().filter(|scene| !scene.has_start()) {
            let mut misfits = semantics::check(&scene);
            drop(scene);
            // What depends on a number that stands in for a refused one is nobody's mistake, nor is a misfit in the same place.
            if !misfits.is_empty() {
                let other = self.substituted(Substitute::Most)?.scene;
                let others = other.map(|scene| semantics::check(&scene)).unwrap_or_default();
                let others: HashSet<&Problem> = others.iter().collect();
                misfits.retain(|misfit| {
                    others.contains(misfit) && problems.iter().all(|known| !related(&known.path, &misfit.path))
                });
            }
            problems.append(misfits);
        }
        Err(invalid(name, problems, true))
    }
}

/// The longest text that is read as a scene: more than ten million listed particles.
const LONGEST_TEXT: u64 = 512 << 20;

fn bytes(path: &Path) -> io::Result<Vec<u8>> {
    let mut bytes = Vec::new();
    File::open(path)?.take(LONGEST_TEXT + 1).read_to_end(&mut bytes)?;
    if bytes.len() as u64 > LONGEST_TEXT {
        let message = format!("it exceeds the limit of {} MiB", LONGEST_TEXT >> 20);
        return Err(io::Error::new(io::ErrorKind::FileTooLarge, message));
    }
    Ok(bytes)
}

/// The error for a name that is neither a file nor a built-in scene.
///
/// ```
/// let error = mesoscope::scene::unknown_builtin("dpd-fluit");
/// assert!(error.to_string().contains("dpd-fluid"));
/// ```
#[must_use]
pub fn unknown_builtin(name: &str) -> SceneError {
    let names = builtin().iter().map(|scene| scene.name);
    let stem = Path::new(name).file_stem().and_then(|stem| stem.to_str()).unwrap_or(name);
    SceneError::NotFound {
        name: name.to_owned(),
        suggestion: nearest(stem, names.clone()),
        builtin: names.collect::<Vec<_>>().join(", "),
    }
}

/// Where what a scene keeps of the file of its state comes from.
#[derive(Clone)]
enum Source<'a> {
    /// The file, which is one of these or is looked for beside a scene of that name, if its particles fit.
    File(&'a StateFiles, Option<&'a Fits<'a>>),
    /// The run that has read it.
    Kept(Option<Arc<FileStart>>),
}

/// Whether a mistake in this place concerns which file is read, the box that the file is compared with, or which molecules there are.
fn says_where_particles_are(path: &str) -> bool {
    ["state", "space", "molecules"].iter().any(|key| related(key, path))
}

/// The schema, which is derived once.
static SCHEMA: LazyLock<Value> = LazyLock::new(schema);

/// The same as documents are compared with it.
static SHAPE: LazyLock<Schema<'_>> = LazyLock::new(|| Schema::read(&SCHEMA, &SCHEMA));

/// The kind of the system of a document, as far as its interactions say so; some of these stand alone.
fn kind_of_system(document: &Value, problems: &mut Problems) -> Option<SystemKind> {
    let interactions = document["interactions"].as_array().map_or(&[][..], Vec::as_slice);
    let types: Option<Vec<&str>> = interactions.iter().map(|interaction| interaction["type"].as_str()).collect();
    let known = SCHEMA["properties"]["interactions"]["items"]["oneOf"].as_array()?;
    let is_known = |name: &&str| known.iter().any(|known| known["properties"]["type"]["const"] == **name);
    let types = types.filter(|types| types.iter().all(is_known))?;
    let kind = SystemKind::from_interactions(interactions);
    if types.len() < 2 {
        return Some(kind);
    }
    let mut seen = HashSet::new();
    for (index, name) in types.into_iter().enumerate() {
        if System::STANDING_ALONE.contains(&name) && seen.insert(name) {
            let accepted = format!("`{name}` as the only interaction of a scene");
            problems.refuse(format!("interactions[{index}]"), "together with another interaction", accepted);
        }
    }
    seen.is_empty().then_some(kind)
}

/// Applies overrides to the JSON of a scene; returns those that cannot be.
fn overridden(document: &mut Value, overrides: &[String]) -> Vec<Problem> {
    let is_at_top = |key: &str| SCHEMA["properties"].get(key).is_some();
    overrides.iter().filter_map(|argument| overrides::apply(document, argument, is_at_top).err()).collect()
}

/// What could be read of a text.
struct Reading {
    /// The mistakes of its shape.
    problems: Problems,
    /// The scene, in which numbers that were refused are replaced; it satisfies the schema. Or why there is none.
    scene: serde_json::Result<Scene>,
    /// What was shortened for a run of so many steps, or is not used of a file.
    notices: Vec<Warning>,
    /// The numbers that each group gives itself.
    given: Vec<Given>,
}

impl Scene {
    /// The scene, checked, with a model of it; a file of its state that has not been read is looked for in the current directory.
    ///
    /// ```
    /// use mesoscope::scene::{self, SceneError};
    ///
    /// let mut scene = scene::load("dpd-fluid", &["output={}".to_owned()])?.into_scene();
    /// scene.space.lengths = vec![4.0; 3];
    /// assert_eq!(scene.check()?.model().particle_count(), 192);
    /// scene.temperature = f64::NAN;
    /// assert!(matches!(scene.check(), Err(SceneError::Invalid { problems, .. }) if problems[0].path == "temperature"));
    /// # Ok::<(), SceneError>(())
    /// ```
    ///
    /// # Errors
    /// As [`parse`], with the title in place of a name.
    pub fn check(&self) -> Result<Checked, SceneError> {
        self.check_with(StepCheck::Refuse)
    }

    /// Like [`Self::check`], but a time step that no scheme is stable with is accepted: to see what becomes of it.
    ///
    /// # Errors
    /// As [`Self::check`].
    pub fn check_but_step(&self) -> Result<Checked, SceneError> {
        self.check_with(StepCheck::Allow)
    }

    fn check_with(&self, step: StepCheck) -> Result<Checked, SceneError> {
        let written = self.written(&self.title)?;
        match self.start() {
            Some(start) => written.check_from(step, Source::Kept(Some(Arc::clone(start)))),
            None => written.check_among(&StateFiles::default(), step),
        }
    }

    /// The scene as text of this name.
    fn written(&self, name: &str) -> Result<WrittenScene, SceneError> {
        let text = serde_json::to_string(self).map_err(|error| mismatch(name, &error))?;
        Ok(WrittenScene::new(name, text))
    }

    /// The scene after a change, checked like one that a run keeps.
    ///
    /// # Errors
    /// As [`Self::check`]; mistakes are said to be in `name`.
    pub(crate) fn check_kept(&self, name: &str) -> Result<Checked, SceneError> {
        self.written(name)?.check_kept(self.start().cloned())
    }
}

fn mismatch(name: &str, error: &serde_json::Error) -> SceneError {
    SceneError::SchemaMismatch { name: name.to_owned(), message: error.to_string() }
}

/// Numbers for further checks in place of required ones that a scene lacks.
fn fill_in(document: &mut Value, substitute: Substitute) {
    let numbers = match substitute {
        Substitute::Least => [1e-3.into(), 1e-3.into(), 0.into()],
        Substitute::Most => [1e3.into(), 1.into(), (1_u64 << 53).into()],
    };
    let places = [("", "temperature"), ("/time", "step"), ("/time", "steps")];
    if let Some(scene) = document.as_object_mut() {
        scene.entry("time").or_insert_with(|| serde_json::json!({}));
    }
    for ((place, key), number) in places.into_iter().zip::<[Value; 3]>(numbers) {
        if let Some(object) = document.pointer_mut(place).and_then(Value::as_object_mut) {
            object.entry(key).or_insert(number);
        }
    }
}

fn invalid(name: &str, problems: Problems, further: bool) -> SceneError {
    let (problems, more) = problems.into_parts();
    SceneError::Invalid { name: name.to_owned(), problems, more, further }
}

fn not_text(name: &str, error: &std::string::FromUtf8Error) -> SceneError {
    let before = &error.as_bytes()[..error.utf8_error().valid_up_to()];
    let before = std::str::from_utf8(before).unwrap_or_default();
    let line = before.matches('\n').count() + 1;
    let column = before.len() - before.rfind('\n').map_or(0, |end| end + 1) + 1;
    let message = text::foreign(error.as_bytes());
    let message = message.unwrap_or_else(|| "this is not UTF-8 text; a scene is a JSON file".to_owned());
    SceneError::Syntax { name: name.to_owned(), line, column, message }
}

/// The JSON Schema of a scene (draft 2020-12), derived from [`Scene`].
///
/// ```
/// let schema = mesoscope::scene::schema();
/// assert_eq!(schema["properties"]["title"]["description"], "One line that names the scene; it heads every plot.");
/// let validator = jsonschema::validator_for(&schema)?;
/// assert!(!validator.is_valid(&serde_json::json!({"title": "no box, no time, no particles"})));
/// assert!(validator.is_valid(&serde_json::json!({
///     "title": "an ideal gas", "space": {"box": [8, 8]}, "time": {"step": 0.01, "steps": 10}, "temperature": 1,
///     "particles": [{"species": "A", "count": 10}], "interactions": []
/// })));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[must_use]
pub fn schema() -> Value {
    let schema = schemars::schema_for!(Scene);
    // Serialisation puts the keys in reading order.
    serde_json::to_value(&schema).unwrap_or_else(|_| schema.to_value())
}
