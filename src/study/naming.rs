//! Names of variants, for directories and for people.

use super::variation::Setting;
use serde_json::Value;

/// The variant that changes nothing.
const UNCHANGED: &str = "unchanged";

/// Longest name of a directory, in bytes; all common file systems take 255.
const LONGEST: usize = 120;

/// Keys that settings are made of, and the shortest ends of their paths that tell them apart: `friction` for
/// `interactions.0.friction`. An end never begins with the index of a list.
pub(crate) struct ShortKeys(Vec<(String, String)>);

impl ShortKeys {
    pub(crate) fn of(keys: &[&str]) -> Self {
        let end = |key: &str, length: usize| -> String {
            let parts: Vec<&str> = key.split('.').collect();
            let mut first = parts.len().saturating_sub(length);
            while first > 0 && parts[first].parse::<u64>().is_ok() {
                first -= 1;
            }
            parts[first..].join(".")
        };
        let short = |key: &&str| {
            let unlike =
                |length: &usize| keys.iter().all(|other| other == key || end(other, *length) != end(key, *length));
            let length = (1..=key.split('.').count()).find(unlike);
            length.map_or_else(|| (*key).to_owned(), |length| end(key, length))
        };
        Self(keys.iter().map(|key| ((*key).to_owned(), short(key))).collect())
    }

    /// Those of settings, among each other.
    pub(crate) fn of_settings(settings: &[Setting]) -> Self {
        Self::of(&settings.iter().map(|setting| setting.key.as_str()).collect::<Vec<_>>())
    }

    /// The short form of a key; a key that is not among them as it is.
    pub(crate) fn short<'a>(&'a self, key: &'a str) -> &'a str {
        self.0.iter().find(|(known, _)| known == key).map_or(key, |(_, short)| short)
    }

    /// What a legend says of a variant: `friction = 4.5, step = 0.02`.
    pub(crate) fn label(&self, settings: &[Setting]) -> String {
        if settings.is_empty() {
            return UNCHANGED.to_owned();
        }
        let part = |setting: &Setting| format!("{} = {}", self.short(&setting.key), readable(&setting.value));
        settings.iter().map(part).collect::<Vec<_>>().join(", ")
    }
}

/// The name of the directory of a variant: `friction=4.5,step=0.02`.
pub(super) fn directory(settings: &[Setting], short: &ShortKeys) -> String {
    if settings.is_empty() {
        return UNCHANGED.to_owned();
    }
    let part =
        |setting: &Setting| format!("{}={}", portable(short.short(&setting.key)), portable(&readable(&setting.value)));
    let mut name = settings.iter().map(part).collect::<Vec<_>>().join(",");
    // All of it is ASCII.
    name.truncate(LONGEST);
    name
}

/// The names, with a number added where one is taken already, whatever the case of its letters.
pub(super) fn distinct(names: Vec<String>) -> Vec<String> {
    let mut taken = std::collections::HashSet::new();
    let mut number_of = |name: String| {
        let numbered = (2..).map(|number| format!("{name}~{number}"));
        let mut candidates = std::iter::once(name.clone()).chain(numbered);
        candidates.find(|candidate| taken.insert(candidate.to_lowercase())).unwrap_or_default()
    };
    names.into_iter().map(&mut number_of).collect()
}

/// A value as people write it. An object that only says its type is called by it.
pub(crate) fn readable(value: &Value) -> String {
    match value {
        Value::String(text) => text.clone(),
        Value::Array(list) => list.iter().map(readable).collect::<Vec<_>>().join(" × "),
        Value::Object(object) => {
            let part = |(key, value): (&String, &Value)| match (key.as_str(), value) {
                ("type", Value::String(kind)) => kind.clone(),
                _ => format!("{key} {}", readable(value)),
            };
            object.iter().map(part).collect::<Vec<_>>().join(" ")
        }
        other => other.to_string(),
    }
}

/// A text with nothing but characters that every file system and shell takes as they are.
fn portable(text: &str) -> String {
    let text = text.replace(" × ", "x");
    let name: String =
        text.chars().map(|c| if c.is_ascii_alphanumeric() || "+-._".contains(c) { c } else { '-' }).collect();
    if name.is_empty() { "-".to_owned() } else { name }
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    fn named(settings: &[(&str, Value)]) -> (String, String) {
        let settings: Vec<Setting> =
            settings.iter().map(|(key, value)| Setting { key: (*key).to_owned(), value: value.clone() }).collect();
        let short = ShortKeys::of_settings(&settings);
        (directory(&settings, &short), short.label(&settings))
    }

    fn pair(directory: &str, label: &str) -> (String, String) {
        (directory.to_owned(), label.to_owned())
    }

    #[test]
    fn names_read_like_the_settings() {
        assert_eq!(named(&[("interactions.0.friction", json!(4.5))]), pair("friction=4.5", "friction = 4.5"));
        assert_eq!(
            named(&[("time.step", json!(0.02)), ("integrator.type", json!("splitting"))]),
            pair("step=0.02,type=splitting", "step = 0.02, type = splitting")
        );
        assert_eq!(named(&[("space.box", json!([5, 5, 2.5]))]), pair("box=5x5x2.5", "box = 5 × 5 × 2.5"));
        assert_eq!(named(&[("space.box.0", json!(7))]), pair("box.0=7", "box.0 = 7"));
        assert_eq!(
            named(&[("integrator", json!({"type": "groot-warren", "lambda": 0.65}))]),
            pair("integrator=groot-warren-lambda-0.65", "integrator = groot-warren lambda 0.65")
        );
        assert_eq!(named(&[]), pair("unchanged", "unchanged"));
        assert_eq!(named(&[("title", json!("../a b/ü"))]).0, "title=..-a-b--");
        assert_eq!(named(&[("title", json!(""))]).0, "title=-");
        assert_eq!(named(&[("title", json!("x".repeat(1000)))]).0.len(), LONGEST);
    }

    #[test]
    fn keys_that_end_alike_say_more() {
        let short = |keys: [&str; 3]| {
            let found = ShortKeys::of(&keys);
            keys.map(|key| found.short(key).to_owned())
        };
        let keys = ["particles.0.mass", "particles.1.mass", "time.step"];
        assert_eq!(short(keys), ["particles.0.mass", "particles.1.mass", "step"]);
        assert_eq!(short(["a.b.every", "c.every", "every"]), ["b.every", "c.every", "every"]);
        assert_eq!(ShortKeys::of(&keys).short("time.steps"), "time.steps");
    }

    #[test]
    fn a_name_that_is_taken_gets_a_number() {
        let names = ["a", "b", "A", "a"].map(str::to_owned).to_vec();
        assert_eq!(distinct(names), ["a", "b", "A~2", "a~3"]);
    }
}
