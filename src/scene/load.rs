//! Loading: from a file or a built-in name to a checked scene.

use std::collections::HashSet;
use std::fs::File;
use std::io::{self, Read};
use std::path::Path;
use std::sync::{Arc, LazyLock};

use serde_json::Value;

use crate::families::{self, StepCheck};

use super::path::related;
use super::shape::{Schema, Substitute};
use super::start::Fits;
use super::{
    FileStart, KeptStart, Problem, Problems, Scene, SceneError, StateFiles, Warning, builtin, nearest, overrides,
    semantics, shape, shorten, start, text,
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
pub fn load(source: &str, overrides: &[String]) -> Result<Scene, SceneError> {
    Ok(load_for(source, overrides, None)?.0)
}

/// Like [`load`], for a run of this many steps: if the scene has more, equilibration and the windows of correlations that no longer
/// fit are shortened, unless an override sets them. Also returns what was shortened.
///
/// ```
/// use mesoscope::scene;
///
/// let (scene, notices) = scene::load_for("dpd-fluid", &[], Some(200))?;
/// assert_eq!((scene.time.steps, scene.time.equilibration), (200, 50));
/// assert_eq!(notices[0].to_string(), "time.equilibration: shortened from 500 to 50 of 200 steps");
/// # Ok::<(), scene::SceneError>(())
/// ```
///
/// # Errors
/// As [`load`].
pub fn load_for(source: &str, overrides: &[String], steps: Option<u64>) -> Result<(Scene, Vec<Warning>), SceneError> {
    let (name, text) = read(source)?;
    parse_for(&name, &text, overrides, steps)
}

/// Like [`load_for`], for a scene that is asked of `fits` once the particles of its file or its molecules are counted, before any of them
/// is read or placed; a few are not worth asking.
///
/// # Errors
/// As [`load`], and what `fits` returns.
pub fn load_fitting(
    source: &str,
    overrides: &[String],
    steps: Option<u64>,
    fits: &Fits<'_>,
) -> Result<(Scene, Vec<Warning>), SceneError> {
    let (name, text) = read(source)?;
    let draft = Draft { name: &name, text: &text, overrides, steps };
    draft.parse(StepCheck::Refuse, Source::File(&StateFiles::default(), Some(fits)))
}

/// The name and the text of the scene in the file `source`, or of the built-in scene of that name.
///
/// ```
/// use mesoscope::scene;
///
/// let (name, text) = scene::read("dpd-fluid")?;
/// assert_eq!(name, "dpd-fluid");
/// assert!(text.starts_with('{'));
/// # Ok::<(), scene::SceneError>(())
/// ```
///
/// # Errors
/// There is no such scene, or the file cannot be read or is not text.
pub fn read(source: &str) -> Result<(String, String), SceneError> {
    let path = Path::new(source);
    // A directory of a scene's name is the likely place of its last run, not a scene.
    if path.exists() && !path.is_dir() {
        let bytes = bytes(path).map_err(|error| SceneError::Read { path: path.to_owned(), source: error })?;
        let text = String::from_utf8(bytes).map_err(|error| not_text(source, &error))?;
        return Ok((source.to_owned(), text));
    }
    match builtin().iter().find(|scene| scene.name == source) {
        Some(scene) => Ok((scene.name.to_owned(), scene.text.to_owned())),
        None => Err(unknown_builtin(source)),
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
pub fn parse(name: &str, text: &str, overrides: &[String]) -> Result<Scene, SceneError> {
    Ok(parse_for(name, text, overrides, None)?.0)
}

/// Like [`parse`], for a run of so many steps, as [`load_for`].
///
/// # Errors
/// As [`parse`].
pub fn parse_for(
    name: &str,
    text: &str,
    overrides: &[String],
    steps: Option<u64>,
) -> Result<(Scene, Vec<Warning>), SceneError> {
    parse_with(&StateFiles::default(), name, text, overrides, steps, StepCheck::Refuse)
}

/// Like [`parse_for`], with the files that other scenes of the same text were read with; [`StepCheck::Allow`] accepts a time step that
/// no scheme is stable with, to see what becomes of it.
///
/// # Errors
/// As [`parse`], and [`SceneError::StateChanged`] if one of the files is not what it was.
pub(crate) fn parse_with(
    files: &StateFiles,
    name: &str,
    text: &str,
    overrides: &[String],
    steps: Option<u64>,
    step: StepCheck,
) -> Result<(Scene, Vec<Warning>), SceneError> {
    Draft { name, text, overrides, steps }.parse(step, Source::File(files, None))
}

/// Like [`parse`], but the file of a state is not read: what a run keeps of it is given, as far as it is known. Nor is the time step
/// refused: whoever let the run begin has decided that.
///
/// # Errors
/// As [`parse`].
pub(crate) fn parse_kept(
    name: &str,
    text: &str,
    overrides: &[String],
    start: Option<Arc<FileStart>>,
) -> Result<Scene, SceneError> {
    Ok(Draft { name, text, overrides, steps: None }.parse(StepCheck::Allow, Source::Kept(start))?.0)
}

/// Where what a scene keeps of the file of its state comes from.
#[derive(Clone)]
enum Source<'a> {
    /// The file, which is one of these or is looked for beside a scene of that name, if its particles fit.
    File(&'a StateFiles, Option<&'a Fits<'a>>),
    /// The run that has read it.
    Kept(Option<Arc<FileStart>>),
}

/// The text of a scene with a name for messages, what is set in it, and the steps of its run, if it is to have fewer.
#[derive(Clone, Copy)]
struct Draft<'a> {
    name: &'a str,
    text: &'a str,
    overrides: &'a [String],
    steps: Option<u64>,
}

impl Draft<'_> {
    /// The scene that can be read of it, with numbers in place of those that are refused.
    fn read(&self, substitute: Substitute) -> Result<Reading, SceneError> {
        let (mut document, mut problems) = text::parse(self.name, self.text)?;
        problems.extend(overridden(&mut document, self.overrides));
        let notices =
            self.steps.map(|steps| shorten::shorten(&mut document, steps, self.overrides)).unwrap_or_default();
        let left_out = |place: &str| document.pointer(place).is_none();
        let (integrator, colour) = (left_out("/integrator"), left_out("/output/snapshot/color"));
        problems.append(shape::check(&SHAPE, &mut document, substitute));
        let groups = document.get("particles").and_then(Value::as_array).into_iter().flatten();
        let masses = groups.map(|group| group.get("mass").is_some()).collect();
        // What the shape check has mended may be readable, and then everything can be said at once.
        if !problems.is_empty() {
            fill_in(&mut document, substitute);
        }
        let scene = serde_json::from_value(document).map_err(|error| error.to_string()).map(|mut scene| {
            families::complete(&mut scene, integrator, colour);
            scene
        });
        Ok(Reading { problems, scene, notices, masses })
    }

    fn parse(&self, step: StepCheck, source: Source<'_>) -> Result<(Scene, Vec<Warning>), SceneError> {
        let name = self.name;
        // A run that was begun without a rule of relaxation goes on without one.
        let is_kept = matches!(source, Source::Kept(_));
        let mut reading = self.read(Substitute::Least)?;
        let mut unreadable = Problems::default();
        if let Ok(scene) = &mut reading.scene {
            match source {
                // Numbers that stand in for refused ones are not compared with a file.
                Source::File(..) if reading.problems.iter().any(|known| says_where_particles_are(&known.path)) => {}
                Source::File(files, fits) => {
                    unreadable = start::read(scene, &reading.masses, (name, files), fits, &mut reading.notices)?;
                    let known: Vec<&str> = reading.problems.iter().map(|known| known.path.as_str()).collect();
                    unreadable.retain(|found| known.iter().all(|known| !related(known, &found.path)));
                }
                Source::Kept(start) => scene.kept = start.map(KeptStart::of).unwrap_or_default(),
            }
        }
        if reading.problems.is_empty() && unreadable.is_empty() {
            let mut scene =
                reading.scene.map_err(|message| SceneError::SchemaMismatch { name: name.to_owned(), message })?;
            let mut problems = semantics::check(&scene);
            // What needs a model or a start needs a scene that makes sense.
            let further = !problems.is_empty();
            if !further {
                if !is_kept {
                    families::settle(&mut scene);
                }
                families::check(&scene, step, &mut problems);
            }
            return if problems.is_empty() {
                Ok((scene, reading.notices))
            } else {
                Err(invalid(name, problems, further))
            };
        }
        let mut problems = reading.problems;
        problems.append(unreadable);
        // What a file should say, or what its box is compared with, is missing wherever it is needed.
        if let Some(scene) = reading.scene.ok().filter(|scene| !scene.has_start()) {
            let mut misfits = semantics::check(&scene);
            drop(scene);
            // What depends on a number that stands in for a refused one is nobody's mistake, nor is a misfit in the same place.
            if !misfits.is_empty() {
                let other = self.read(Substitute::Most)?.scene;
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

/// Whether a mistake in this place concerns which file is read, the box that the file is compared with, or which molecules there are.
fn says_where_particles_are(path: &str) -> bool {
    ["state", "space", "molecules"].iter().any(|key| related(key, path))
}

/// The schema, which is derived once.
static SCHEMA: LazyLock<Value> = LazyLock::new(schema);

/// The same as documents are compared with it.
static SHAPE: LazyLock<Schema<'_>> = LazyLock::new(|| Schema::read(&SCHEMA, &SCHEMA));

/// The first mistake that overrides make in the shape of a scene, whatever it means.
pub(crate) fn misshapen(name: &str, text: &str, overrides: &[String]) -> Option<Problem> {
    Draft { name, text, overrides, steps: None }.read(Substitute::Least).ok()?.problems.iter().next().cloned()
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
    scene: Result<Scene, String>,
    /// What was shortened for a run of so many steps, or is not used of a file.
    notices: Vec<Warning>,
    /// Which groups give their mass.
    masses: Vec<bool>,
}

/// The text of a scene with overrides written into it, and nothing else changed but the path of the file of its state: that becomes
/// absolute, since the text may be kept anywhere.
///
/// # Errors
/// As [`parse`].
pub(crate) fn with_overrides(
    files: &StateFiles,
    name: &str,
    text: &str,
    overrides: &[String],
) -> Result<String, SceneError> {
    // After this there is no mistake in text and overrides.
    parse_with(files, name, text, overrides, None, StepCheck::Refuse)?;
    let (mut document, _) = text::parse(name, text)?;
    overridden(&mut document, overrides);
    if let Some(file) = document.pointer_mut("/state/file")
        && let Some(path) = file.as_str().map(|file| files.path(name, file))
    {
        *file = std::path::absolute(&path).unwrap_or(path).display().to_string().into();
    }
    let text = serde_json::to_string_pretty(&document)
        .map_err(|error| SceneError::SchemaMismatch { name: name.to_owned(), message: error.to_string() })?;
    Ok(text + "\n")
}

/// A scene that has been changed, checked like one that is kept.
///
/// # Errors
/// As [`parse`]; mistakes are said to be in `name`.
pub(crate) fn checked(name: &str, scene: &Scene) -> Result<Scene, SceneError> {
    let text = serde_json::to_string(scene)
        .map_err(|error| SceneError::SchemaMismatch { name: name.to_owned(), message: error.to_string() })?;
    parse_kept(name, &text, &[], scene.start().cloned())
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
