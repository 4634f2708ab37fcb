//! A right scene made wrong: what is said of the scene that `base` of the test gives, with overrides.
#![allow(dead_code, clippy::unwrap_used, clippy::expect_used, clippy::panic)]

use mesoscope::scene::{self, Scene, SceneError};

use super::base;

/// The scene with these overrides, given as `path=value`.
pub fn parse(overrides: &[&str]) -> Result<Scene, SceneError> {
    parse_text(&base().to_string(), overrides)
}

fn parse_text(text: &str, overrides: &[&str]) -> Result<Scene, SceneError> {
    let overrides: Vec<String> = overrides.iter().map(|&argument| argument.to_owned()).collect();
    scene::parse("test.json", text, &overrides)
}

/// The problems of the scene with these overrides.
#[track_caller]
pub fn problems(overrides: &[&str]) -> Vec<String> {
    problems_of(&base().to_string(), overrides)
}

/// The problems of another scene with overrides.
#[track_caller]
pub fn problems_of(text: &str, overrides: &[&str]) -> Vec<String> {
    match parse_text(text, overrides) {
        Err(SceneError::Invalid { problems, .. }) => problems.iter().map(ToString::to_string).collect(),
        other => panic!("{overrides:?}: {other:?}"),
    }
}

/// The scene with these overrides has this one problem, word for word.
#[track_caller]
pub fn refused(overrides: &[&str], expected: &str) {
    assert_eq!(problems(overrides), [expected], "{overrides:?}");
}

/// The one problem of the scene with these overrides has all these parts.
#[track_caller]
pub fn refused_with(overrides: &[&str], parts: &[&str]) {
    let problems = problems(overrides);
    assert_eq!(problems.len(), 1, "{problems:#?}");
    for part in parts {
        assert!(problems[0].contains(part), "`{part}` is not in: {}", problems[0]);
    }
}

/// The scene with these overrides is right.
#[track_caller]
pub fn accepted(overrides: &[&str]) -> Scene {
    parse(overrides).unwrap_or_else(|error| panic!("{overrides:?}: {error}"))
}

/// What the scene with these overrides is warned of.
#[track_caller]
pub fn warnings(overrides: &[&str]) -> Vec<String> {
    scene::warnings(&accepted(overrides)).iter().map(ToString::to_string).collect()
}
