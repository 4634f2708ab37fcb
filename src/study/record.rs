//! The summary of a study: written after every run, read to go on.

use super::error::StudyError;
use super::kind::Kind;
use super::lists::each_once;
use super::shard_places;
use crate::output::{Id, OutputError, RunDirectory, own_file, write_atomically};
use crate::plot::Chart;
use crate::scene::{PlotStyle, SceneError};
use serde::Serialize;
use serde::de::DeserializeOwned;
use serde_json::Value;
use std::fmt::{Debug, Display};
use std::path::Path;

/// What is said of a summary whose request was edited.
pub(crate) const ASKS_ELSE: &str = "asks for something else than at its beginning";

/// The key of the checksum of what was asked for.
const CHECKSUM: &str = "request_checksum";

/// Pictures of a study, each made when it is its turn, with the names of their files.
pub type Charts<'c> = Box<dyn Iterator<Item = (String, Chart)> + 'c>;

/// What a kind of study writes down: what it was asked for and what came out.
pub trait Record: Debug + Clone + Serialize + DeserializeOwned {
    /// What a user asks for.
    type Request: Debug + Clone;
    /// What came out of one run; its text says it in a few words.
    type Ended: Debug + Display;
    /// What follows between the first runs and the pictures; its text announces it.
    type Phase: Debug + Display;

    /// The kind of study.
    const KIND: &'static Kind;

    /// What is known before anything has run.
    fn before(request: &Self::Request) -> Self;

    /// The request that this is of.
    ///
    /// # Errors
    /// [`StudyError`] if it is not one that the program accepts.
    fn request(&self) -> Result<Self::Request, StudyError>;

    /// True of each part that fits that request, with the words that follow "it" where one does not.
    fn checks(&self, request: &Self::Request) -> Vec<(bool, &'static str)>;

    /// The version of the program that wrote it.
    fn version(&self) -> &str;

    /// The id of the study, which its pictures have too.
    fn id(&self) -> Id;

    /// Names of the runs that have directories of their own.
    fn runs(&self) -> Vec<&str> {
        Vec::new()
    }

    /// The same, ready to go on in its directory.
    #[must_use]
    fn resumed(self, _: &Self::Request, _: &RunDirectory) -> Self {
        self
    }

    /// The tables that it leaves beside its summary, with the names of their files.
    fn tables(&self, request: &Self::Request) -> Vec<(&'static str, String)>;

    /// The page that says in words what came out, with the name of its file.
    fn page(&self, _: &Self::Request) -> Option<(&'static str, String)> {
        None
    }

    /// Its pictures; its runs are in this directory.
    ///
    /// # Errors
    /// [`StudyError`] if what a run left there cannot be read or is not of this study.
    fn charts<'c>(&'c self, request: &'c Self::Request, directory: &RunDirectory) -> Result<Charts<'c>, StudyError>;

    /// The look of its pictures with changes to it, given as overrides of the scene.
    ///
    /// # Errors
    /// [`SceneError`] if they make no scene.
    fn style(&self, request: &Self::Request, overrides: &[String]) -> Result<PlotStyle, SceneError>;

    /// How far it is, to be read after "interrupted".
    fn progress(&self) -> String {
        String::new()
    }

    /// Whether this version of the program wrote it: ids follow from the keys of scenes, which other versions may not have.
    fn is_of_this_version(&self) -> bool {
        self.version() == env!("CARGO_PKG_VERSION")
    }
}

/// Writes a summary into the directory of its study.
pub(crate) fn save<R: Record>(record: &R, directory: &Path) -> Result<(), OutputError> {
    let path = directory.join(R::KIND.summary);
    let summary = serde_json::to_value(record);
    let mut summary = summary.map_err(|source| OutputError::Json { path: path.clone(), source })?;
    summary[CHECKSUM] = checksum_of(R::KIND, &summary).into();
    write_atomically(&path, |writer| writeln!(writer, "{summary:#}"))
}

/// The checksum of what a summary says that was asked for: of the text, so that it holds for every version of the program, whatever
/// keys scenes have in it.
fn checksum_of(kind: &Kind, summary: &Value) -> String {
    let asked = kind.asked.iter().map(|key| summary.get(key).cloned().unwrap_or_default());
    own_file::checksum_of([&asked.collect()])
}

/// Reads the summary in the directory of a study.
pub(crate) fn load<R: Record>(directory: &Path) -> Result<R, StudyError> {
    let path = directory.join(R::KIND.summary);
    own_file::json(&path).map_err(|error| match error {
        OutputError::Io { source, .. } if source.kind() == std::io::ErrorKind::NotFound => {
            StudyError::Nothing { kind: R::KIND, path: directory.to_path_buf() }
        }
        OutputError::Line { path, line, problem } => {
            let Kind { noun, again, .. } = R::KIND;
            let problem = format!("this is no summary of a {noun} ({problem}); {again} with --force");
            OutputError::Line { path, line, problem }.into()
        }
        error => error.into(),
    })
}

/// Refuses a summary that a later version of the program wrote.
///
/// # Errors
/// [`StudyError::Later`], [`StudyError::Changed`] where it names no version.
pub(crate) fn check_version<R: Record>(record: &R, directory: &Path) -> Result<(), StudyError> {
    let (kind, path) = (R::KIND, directory.join(R::KIND.summary));
    let Some(is_later) = is_later(record.version(), env!("CARGO_PKG_VERSION")) else {
        return Err(StudyError::Changed { kind, path, reasons: vec!["has a `mesoscope_version` that is no version"] });
    };
    if is_later {
        return Err(StudyError::Later { kind, path, version: record.version().to_owned() });
    }
    Ok(())
}

/// Whether a version of the program comes after another, whatever they were built from; none where one is no version.
fn is_later(one: &str, other: &str) -> Option<bool> {
    let [one, other] = [one, other].map(|text| semver::Version::parse(text).ok());
    Some(one?.cmp_precedence(&other?).is_gt())
}

/// Opens the directory of a study, which belongs to this process from then on: its summary and what it was asked for.
///
/// # Errors
/// [`StudyError`] if there is none, if another process or a shard of it writes there, and if the summary or a picture is not of this study.
pub(super) fn reopen<R: Record>(directory: &Path) -> Result<(R, R::Request, RunDirectory), StudyError> {
    // Nothing is written where there is no study, no lock either.
    load::<R>(directory)?;
    let claimed = RunDirectory::claim(directory)?;
    let record: R = load(directory)?;
    shard_places::check_idle(directory, |_| true)?;
    check_version(&record, directory)?;
    let (kind, path) = (R::KIND, directory.join(R::KIND.summary));
    let stored: Value = own_file::json(&path)?;
    // Summaries of early versions do not say what they asked for when they were written.
    let is_as_asked = stored.get(CHECKSUM).is_none_or(|noted| *noted == checksum_of(kind, &stored));
    let request = match record.request() {
        Err(_) if !is_as_asked => return Err(StudyError::Changed { kind, path, reasons: vec![ASKS_ELSE] }),
        request => request?,
    };
    let checks = record.checks(&request).into_iter().chain([(is_as_asked, ASKS_ELSE)]);
    let reasons = each_once(checks.filter(|(fits, _)| !fits).map(|(_, reason)| reason));
    if !reasons.is_empty() {
        return Err(StudyError::Changed { kind, path, reasons });
    }
    claimed.check_ids(record.id(), kind.summary, |name| kind.has_file(name))?;
    Ok((record, request, claimed))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn versions_have_an_order() {
        let order = [
            "0.9.1",
            "0.10.0",
            "0.99.99",
            "1.0.0-alpha",
            "1.0.0-alpha.1",
            "1.0.0-alpha.beta",
            "1.0.0-beta.2",
            "1.0.0-beta.11",
            "1.0.0-rc.1",
            "1.0.0",
            "1.0.1-rc.1+build.5",
        ];
        for (place, one) in order.iter().enumerate() {
            for (other_place, other) in order.iter().enumerate() {
                assert_eq!(is_later(one, other), Some(place > other_place), "{one} {other}");
            }
        }
        assert_eq!(is_later("1.0.0+one", "1.0.0+other"), Some(false));
        for text in ["latest", "", "1", "1.0", "1.0.0.0", "1.0.x", "+1.0.0", "1.0.0-", "1.0.0-a..b", "-1.0.0"] {
            assert_eq!(is_later(text, "1.0.0"), None, "{text}");
        }
    }
}
