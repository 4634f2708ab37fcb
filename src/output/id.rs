//! What distinguishes the files of one run from those of another.

use super::OutputError;
use crate::scene::{Scene, Stage};
use crate::state_file::checkpoint::Fnv;
use serde::{Deserialize, Serialize};
use std::fmt;
use std::path::Path;

/// The id of a run or of a sweep, which is in all of its files whose format has a place for it.
///
/// It is a checksum of everything in a scene except the number of steps: a run and its continuation have the same id, a run
/// of another scene or seed has another. Its text begins with a letter, so that no reader takes it for a number.
///
/// ```
/// use mesoscope::output::Id;
///
/// let scene = |set: &str| mesoscope::scene::load("dpd-fluid", &[set.to_owned()]);
/// let id = Id::of_run(&*scene("seed=1")?);
/// assert_eq!(id.to_string().len(), 17);
/// assert_eq!(Id::parse(&id.to_string()), Some(id));
/// assert_eq!(Id::of_run(&*scene("time.steps=50000")?), id);
/// assert_ne!(Id::of_run(&*scene("seed=2")?), id);
/// # Ok::<(), mesoscope::scene::SceneError>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default, Serialize, Deserialize)]
#[serde(into = "String", try_from = "String")]
pub struct Id {
    kind: Kind,
    checksum: u64,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
enum Kind {
    #[default]
    Run,
    Sweep,
}

impl Kind {
    /// Its noun, which begins with the letter of its text, and its key in files.
    fn words(self) -> [&'static str; 2] {
        match self {
            Self::Run => ["run", RUN_KEY],
            Self::Sweep => ["sweep", SWEEP_KEY],
        }
    }

    fn letter(self) -> &'static str {
        &self.words()[0][..1]
    }
}

impl Id {
    /// The id of a run of this scene.
    #[must_use]
    pub fn of_run(scene: &Scene) -> Self {
        let mut endless = scene.clone();
        endless.time.steps = 0;
        let mut sum = Fnv::new();
        // A scene is numbers and text, which can always be written.
        sum.add(&serde_json::to_vec(&endless).unwrap_or_default());
        Self { kind: Kind::Run, checksum: sum.0 }
    }

    /// The id of a sweep that consists of these runs, in this order.
    ///
    /// ```
    /// use mesoscope::output::Id;
    ///
    /// let run = Id::of_run(&*mesoscope::scene::load("dpd-fluid", &[])?);
    /// assert_ne!(Id::of_sweep([run]), Id::of_sweep([run, run]));
    /// assert!(Id::of_sweep([run]).to_string().starts_with('s'));
    /// # Ok::<(), mesoscope::scene::SceneError>(())
    /// ```
    #[must_use]
    pub fn of_sweep(runs: impl IntoIterator<Item = Self>) -> Self {
        Self { kind: Kind::Sweep, checksum: sum_of(runs).0 }
    }

    /// The id of a study that consists of these runs and was asked for in this way.
    pub(crate) fn of_study(runs: impl IntoIterator<Item = Self>, asked: &impl Serialize) -> Self {
        let mut sum = sum_of(runs);
        // A request is numbers and text, which can always be written.
        sum.add(&serde_json::to_vec(asked).unwrap_or_default());
        Self { kind: Kind::Sweep, checksum: sum.0 }
    }

    /// The id that a text stands for, if it does.
    #[must_use]
    pub fn parse(text: &str) -> Option<Self> {
        let kind = [Kind::Run, Kind::Sweep].into_iter().find(|kind| text.starts_with(kind.letter()))?;
        let id = Self { kind, checksum: u64::from_str_radix(text.get(1..)?, 16).ok()? };
        // One text for each id: no signs, no capital letters, no other length.
        (id.to_string() == text).then_some(id)
    }

    /// Looks whether the id in a file is this one, which is that of another file; a file without any is not of another run.
    pub(super) fn check(self, path: &Path, found: Option<Self>, reference: &'static str) -> Result<(), OutputError> {
        match found.filter(|found| *found != self) {
            None => Ok(()),
            Some(found) => Err(OutputError::OtherRun { path: path.to_path_buf(), found, expected: self, reference }),
        }
    }

    /// Its noun.
    pub(super) fn noun(self) -> &'static str {
        self.kind.words()[0]
    }

    /// What files call it.
    pub(crate) fn key(self) -> &'static str {
        self.kind.words()[1]
    }
}

fn sum_of(runs: impl IntoIterator<Item = Id>) -> Fnv {
    let mut sum = Fnv::new();
    for run in runs {
        sum.add(&run.checksum.to_le_bytes());
    }
    sum
}

/// Number of characters of an id.
pub(super) const LENGTH: usize = 17;
/// True if two scenes are those of one run, however many steps they have, and further stages.
pub(crate) fn of_one_run(one: &Scene, other: &Scene) -> bool {
    let [mine, theirs] = [one, other].map(Scene::stages_of_run);
    let common = mine.len().min(theirs.len());
    // The last that both have may have become longer, or shorter where another one followed.
    let last = |stages: &[Stage]| Stage { steps: 0, ..stages[common - 1].clone() };
    let mut as_long = one.clone();
    as_long.time.steps = other.time.steps;
    as_long.stages.clone_from(&other.stages);
    as_long == *other && mine[..common - 1] == theirs[..common - 1] && last(&mine) == last(&theirs)
}

/// What files call the id of a run.
pub(super) const RUN_KEY: &str = "run_id";
/// What files call the id of a sweep.
pub(super) const SWEEP_KEY: &str = "sweep_id";

impl fmt::Display for Id {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(formatter, "{}{:016x}", self.kind.letter(), self.checksum)
    }
}

impl From<Id> for String {
    fn from(id: Id) -> Self {
        id.to_string()
    }
}

impl TryFrom<String> for Id {
    type Error = String;

    fn try_from(text: String) -> Result<Self, Self::Error> {
        Self::parse(&text).ok_or_else(|| format!("`{}` is no id of a run or sweep", text.escape_debug()))
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    #[test]
    fn each_id_has_one_text() {
        let id = Id { kind: Kind::Run, checksum: 0xab };
        assert_eq!(id.to_string(), "r00000000000000ab");
        assert_eq!(serde_json::from_str::<Id>("\"r00000000000000ab\"").unwrap(), id);
        for text in
            ["", "r", "rab", "00000000000000ab", "r00000000000000AB", "r+0000000000000ab", "r000000000000000ab", "é"]
        {
            assert_eq!(Id::parse(text), None, "{text}");
        }
    }
}
