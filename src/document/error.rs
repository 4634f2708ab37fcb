//! Everything that can be wrong with a scene, in words for the person who wrote it.

use std::fmt;
use std::path::PathBuf;

use crate::numbers::counted;
use crate::printable;

/// One mistake in a scene.
#[derive(Debug, Clone, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub struct Problem {
    /// Where: `interactions[0].friction`.
    pub path: String,
    /// What is there, as a phrase: `found -1`, `unknown key`, `missing`.
    pub found: String,
    /// What would be right.
    pub accepted: String,
    /// The nearest valid key, choice or name.
    pub suggestion: Option<String>,
}

impl Problem {
    pub(crate) fn new(path: impl fmt::Display, found: impl Into<String>, accepted: impl Into<String>) -> Self {
        Self { path: path.to_string(), found: cut(found.into()), accepted: cut(accepted.into()), suggestion: None }
    }

    pub(crate) fn suggest(mut self, suggestion: Option<String>) -> Self {
        self.suggestion = suggestion;
        self
    }
}

/// The longest phrase of a message, in characters.
const LONGEST_PHRASE: usize = 800;

/// A phrase short enough to be read: names in a scene may be of any length.
fn cut(phrase: String) -> String {
    match phrase.char_indices().nth(LONGEST_PHRASE) {
        Some((end, _)) => format!("{}…", &phrase[..end]),
        None => phrase,
    }
}

/// Names of a list that are shown.
const NAMES: usize = 24;

/// Names as a list that may be read; what is beyond some is counted.
pub(crate) fn named<'a>(names: impl IntoIterator<Item = &'a str>) -> String {
    let mut names = names.into_iter();
    let list = names.by_ref().take(NAMES).collect::<Vec<_>>().join(", ");
    let more = names.count();
    if more > 0 { format!("{list} and {more} more") } else { list }
}

impl fmt::Display for Problem {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(formatter, "{}: {}; ", printable::name(&self.path), printable::name(&self.found))?;
        if let Some(suggestion) = &self.suggestion {
            write!(formatter, "did you mean `{}`? ", printable::name(suggestion))?;
        }
        write!(formatter, "accepted: {}", printable::name(&self.accepted))
    }
}

/// Something that is allowed in a scene, but that its author should know.
#[derive(Debug, Clone, PartialEq, Eq)]
#[non_exhaustive]
pub struct Warning {
    /// Where: `time.step`.
    pub path: String,
    /// What it means and what to do about it.
    pub message: String,
}

impl fmt::Display for Warning {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(formatter, "{}: {}", printable::name(&self.path), printable::name(&self.message))
    }
}

/// The reason why a scene could not be loaded.
///
/// ```
/// use mesoscope::prelude::*;
///
/// let wrong = ["temperature=-1", "time.step=0"].map(str::to_owned);
/// let Err(SceneError::Invalid { problems, .. }) = scene::load("dpd-fluid", &wrong) else { return };
/// assert_eq!(problems.len(), 2);
/// ```
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum SceneError {
    /// Neither a file nor a built-in scene has this name.
    #[error("no scene `{}`: no file has this path{}, and the built-in scenes are {builtin}", printable::name(.name), did_you_mean(.suggestion.as_deref()))]
    NotFound {
        /// What was asked for.
        name: String,
        /// The nearest built-in name.
        suggestion: Option<String>,
        /// The names of all built-in scenes.
        builtin: String,
    },
    /// The file exists but cannot be read.
    #[error("cannot read the scene {}: {source}", printable::path(path))]
    Read {
        /// The file.
        path: PathBuf,
        /// What the operating system said.
        source: std::io::Error,
    },
    /// The file of a state is not the one that other scenes of the same study started from.
    #[error(
        "`{}` is not what it was when the first scenes were read from it: {}; restore it, or begin again with --force",
        printable::path(path),
        printable::name(reason)
    )]
    StateChanged {
        /// The file.
        path: PathBuf,
        /// What is different, in words.
        reason: String,
    },
    /// Its particles are more than what it is to run on can hold.
    #[error("{reason}")]
    TooManyParticles {
        /// What does not fit, and what to do, in words.
        reason: String,
    },
    /// The text is not JSON.
    #[error("{}:{line}:{column}: {}", printable::name(.name), printable::name(.message))]
    Syntax {
        /// File or built-in name.
        name: String,
        /// Line, from 1.
        line: usize,
        /// Column in bytes, from 1.
        column: usize,
        /// What is wrong and, where it is known, what to do.
        message: String,
    },
    /// The scene says something that is not accepted.
    #[error("{}", list(.name, .problems, *.more))]
    Invalid {
        /// File or built-in name.
        name: String,
        /// The mistakes, in the order of the scene; the first few hundred.
        problems: Vec<Problem>,
        /// How many there are beyond these.
        more: usize,
        /// Whether there are checks that need a scene without them, and have not been made.
        further: bool,
    },
    /// With the numbers of the scene a kernel would need one that single precision cannot hold.
    #[error(
        "{path}: found {number:e}; accepted: a number nearer to the others of the scene, for `{constant}` of the kernels would be \
         {value:e}, and single precision holds 1e-38 to 3e38: choose other units"
    )]
    Precision {
        /// The number of the scene that is furthest from one.
        path: String,
        /// What it is.
        number: f64,
        /// The constant that does not fit.
        constant: String,
        /// What it would be.
        value: f64,
    },
    /// The scene satisfies its schema and yet the program does not understand it: a defect of the program.
    #[error(
        "scene `{}` satisfies the schema but cannot be read ({}); this is a defect of mesoscope, please report it",
        printable::name(.name), printable::name(.message)
    )]
    SchemaMismatch {
        /// File or built-in name.
        name: String,
        /// What the typed reader said.
        message: String,
    },
}

/// Mistakes beyond this number are counted, not listed.
const LISTED: usize = 20;

fn list(scene: &str, problems: &[Problem], more: usize) -> String {
    let count = problems.len() + more;
    let mut lines = vec![format!("scene `{}` has {}:", printable::name(scene), counted(count as u64, "mistake"))];
    lines.extend(problems.iter().take(LISTED).map(ToString::to_string));
    if count > LISTED {
        lines.push(format!("and {} more", count - LISTED));
    }
    lines.join("\n  ")
}

/// The name nearest to one that is not known, as a question in brackets.
pub(crate) fn did_you_mean(suggestion: Option<&str>) -> String {
    suggestion.map(|name| format!(" (did you mean `{name}`?)")).unwrap_or_default()
}
