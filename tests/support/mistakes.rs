//! A correct scene made wrong: what is said of it with overrides, given as `path=value`.

use mesoscope::scene::{self, Checked, SceneError};
use serde_json::Value;

/// The scene that mistakes are made in.
pub struct Correct(pub fn() -> Value);

impl Correct {
    fn text(&self) -> String {
        self.0().to_string()
    }

    /// The scene with these overrides.
    pub fn parse(&self, overrides: &[&str]) -> Result<Checked, SceneError> {
        parse_text(&self.text(), overrides)
    }

    /// The problems of the scene with these overrides.
    #[track_caller]
    pub fn problems(&self, overrides: &[&str]) -> Vec<String> {
        problems_of(&self.text(), overrides)
    }

    /// The scene with these overrides has this one problem, word for word.
    #[track_caller]
    pub fn refused(&self, overrides: &[&str], expected: &str) {
        assert_eq!(self.problems(overrides), [expected], "{overrides:?}");
    }

    /// The one problem of the scene with these overrides has all these parts.
    #[track_caller]
    pub fn refused_with(&self, overrides: &[&str], parts: &[&str]) {
        let problems = self.problems(overrides);
        assert_eq!(problems.len(), 1, "{problems:#?}");
        for part in parts {
            assert!(problems[0].contains(part), "`{part}` is not in: {}", problems[0]);
        }
    }

    /// The scene with these overrides is correct.
    #[track_caller]
    pub fn accepted(&self, overrides: &[&str]) -> Checked {
        self.parse(overrides).unwrap_or_else(|error| panic!("{overrides:?}: {error}"))
    }

    /// What the scene with these overrides is warned of.
    #[track_caller]
    pub fn warnings(&self, overrides: &[&str]) -> Vec<String> {
        mesoscope::families::warnings(&self.accepted(overrides)).iter().map(ToString::to_string).collect()
    }
}

fn parse_text(text: &str, overrides: &[&str]) -> Result<Checked, SceneError> {
    let overrides: Vec<String> = overrides.iter().map(|&argument| argument.to_owned()).collect();
    scene::parse("test.json", text, &overrides)
}

/// The problems of another scene with overrides.
#[track_caller]
pub fn problems_of(text: &str, overrides: &[&str]) -> Vec<String> {
    match parse_text(text, overrides) {
        Err(SceneError::Invalid { problems, .. }) => problems.iter().map(ToString::to_string).collect(),
        other => panic!("{overrides:?}: {other:?}"),
    }
}
