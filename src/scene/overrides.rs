//! Overrides `path.to.key=value` from the command line.

use serde_json::{Map, Value};

use super::Problem;

/// The form of an override, for messages.
const FORM: &str = "path.to.key=value, as in time.step=0.02";

/// Sets the value that an override names. Missing keys are created, and the entry after the last of a list; the schema decides whether
/// they are known. A key that is none at the top of a scene, and is one further down, is not created.
pub(super) fn apply(document: &mut Value, argument: &str, is_at_top: impl Fn(&str) -> bool) -> Result<(), Problem> {
    if let Some(problem) = misplaced(document, argument, is_at_top) {
        return Err(problem);
    }
    set(document, argument)
        .map_err(|(found, accepted)| Problem::new(format_args!("override `{argument}`"), found, accepted))
}

/// Whether an override begins with a key that is further down, and where that is.
fn misplaced(document: &Value, argument: &str, is_at_top: impl Fn(&str) -> bool) -> Option<Problem> {
    let path = dotted(argument.split_once('=')?.0);
    let first = path.split('.').next().filter(|first| !first.is_empty() && !is_at_top(first))?;
    let mut places = Vec::new();
    find(document, first, "", &mut places);
    let rest = &path[first.len()..];
    let places: Vec<String> = places.iter().map(|place| format!("`{place}{rest}`")).collect();
    if places.is_empty() {
        return None;
    }
    let found = format!("found `{first}` at the top of the scene, where it is no key");
    let accepted = format!("the whole path: {}", places.join(" or "));
    Some(Problem::new(format_args!("override `{path}`"), found, accepted))
}

/// The path that an override sets, with dots only: messages write `particles[0].count`.
pub(super) fn dotted(path: &str) -> String {
    path.trim().replace('[', ".").replace(']', "")
}

/// The first few places of a key in a document.
fn find(document: &Value, key: &str, path: &str, places: &mut Vec<String>) {
    const MOST: usize = 3;
    /// Entries of a list that are looked through: longer ones list particles.
    const ENTRIES: usize = 64;
    let below = |name: &str| if path.is_empty() { name.to_owned() } else { format!("{path}.{name}") };
    match document {
        Value::Object(object) => {
            for (name, value) in object {
                if name == key && places.len() < MOST {
                    places.push(below(name));
                }
                find(value, key, &below(name), places);
            }
        }
        Value::Array(list) => {
            for (index, value) in list.iter().take(ENTRIES).enumerate() {
                find(value, key, &below(&index.to_string()), places);
            }
        }
        _ => {}
    }
}

/// What was found and what is accepted, if it fails.
fn set(document: &mut Value, argument: &str) -> Result<(), (String, String)> {
    let misshapen = |found: &str| (found.to_owned(), FORM.to_owned());
    let (path, text) = argument.split_once('=').ok_or_else(|| misshapen("found no `=`"))?;
    let path = dotted(path);
    if path.split('.').any(str::is_empty) {
        return Err(misshapen("found an empty part in the path"));
    }
    let value = value(text.trim()).map_err(|accepted| (format!("found {}", text.trim()), accepted))?;
    let mut place = document;
    let mut walked = String::new();
    // The keys of what a stage sets are paths themselves.
    let parts = match path.splitn(4, '.').collect::<Vec<_>>()[..] {
        ["stages", number, change @ ("set" | "ramp"), key] => vec!["stages", number, change, key],
        _ => path.split('.').collect(),
    };
    let mut segments = parts.into_iter().peekable();
    while let Some(segment) = segments.next() {
        let index = segment.parse::<usize>().ok();
        if place.is_null() {
            *place = if index.is_some() { Value::Array(vec![Value::Null]) } else { Value::Object(Map::new()) };
        }
        place = match place {
            Value::Object(object) => object.entry(segment).or_insert(Value::Null),
            Value::Array(list) => {
                let length = list.len();
                if index == Some(length) && segments.peek().is_none() {
                    list.push(Value::Null);
                }
                index.and_then(|index| list.get_mut(index)).ok_or_else(|| {
                    let accepted = match length {
                        0 => format!("`{walked}.0=…`, for the list is empty"),
                        1 => format!("0, the only index of the list `{walked}`; `{walked}.1=…` appends to it"),
                        _ => format!(
                            "an index from 0 to {} of the list `{walked}`; `{walked}.{length}=…` appends to it",
                            length - 1
                        ),
                    };
                    (format!("found `{segment}`"), accepted)
                })?
            }
            other => {
                let found = format!("found `{segment}` inside of `{walked}`, which is {other}");
                return Err((found, "keys of objects and indices of lists".to_owned()));
            }
        };
        if !walked.is_empty() {
            walked.push('.');
        }
        walked.push_str(segment);
    }
    *place = value;
    Ok(())
}

/// JSON where it is JSON; a number as people write numbers (`.5`, `+2`); otherwise text. What is accepted, if it is none.
pub(crate) fn value(text: &str) -> Result<Value, String> {
    match serde_json::from_str(text) {
        Ok(value) => return Ok(value),
        // Nobody begins a name like this.
        Err(error) if text.starts_with(['[', '{', '"']) => return Err(format!("JSON ({error})")),
        Err(_) => {}
    }
    match text.parse::<f64>() {
        Ok(number) if number.is_finite() => Ok(number.into()),
        Ok(_) => Err(format!("a finite number (a name is quoted: '\"{text}\"')")),
        Err(_) => Ok(Value::String(text.to_owned())),
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]

    use serde_json::json;

    use super::*;

    fn after(argument: &str) -> Result<Value, String> {
        let mut document = json!({"time": {"step": 0.04}, "particles": [{"species": "A"}]});
        let is_at_top = |key: &str| !["step", "species"].contains(&key);
        apply(&mut document, argument, is_at_top).map(|()| document).map_err(|error| error.to_string())
    }

    #[test]
    fn values_are_json_then_numbers_then_text() {
        assert_eq!(after("time.step=0.02").unwrap()["time"]["step"], json!(0.02));
        assert_eq!(after("time.step=.02").unwrap()["time"]["step"], json!(0.02));
        assert_eq!(after("time.steps=5").unwrap()["time"]["steps"], json!(5));
        assert_eq!(after("title=two words = three").unwrap()["title"], json!("two words = three"));
        assert_eq!(after("space.box=[3, 4]").unwrap()["space"]["box"], json!([3, 4]));
    }

    #[test]
    fn paths_reach_into_lists_and_create_objects() {
        assert_eq!(after("particles.0.count=7").unwrap()["particles"][0]["count"], json!(7));
        assert_eq!(after("particles[0].count=7").unwrap()["particles"][0]["count"], json!(7));
        assert_eq!(after("pairs.0.repulsion=9").unwrap()["pairs"], json!([{"repulsion": 9}]));
        assert_eq!(after("output.trajectory.every=9").unwrap()["output"], json!({"trajectory": {"every": 9}}));
        assert_eq!(after(r#"particles.1={"count":7}"#).unwrap()["particles"][1], json!({"count": 7}));
        let staged = after(r#"stages=[{"steps":5}]"#).unwrap();
        let mut document = staged;
        apply(&mut document, "stages.0.set.interactions.1.repulsion=9", |_| true).unwrap();
        assert_eq!(document["stages"], json!([{"steps": 5, "set": {"interactions.1.repulsion": 9}}]));
        assert_eq!(after("pairs=[]").unwrap()["pairs"], json!([]));
    }

    #[test]
    fn mistakes_are_named() {
        for (argument, expected) in [
            ("time.step", "found no `=`; accepted: path.to.key=value"),
            ("=3", "empty part"),
            ("time..step=3", "empty part"),
            (
                "particles.1.count=3",
                "found `1`; accepted: 0, the only index of the list `particles`; `particles.1=…` appends to it",
            ),
            ("particles.2={}", "found `2`; accepted: 0, the only index of the list `particles`"),
            (
                "step=0.02",
                "override `step`: found `step` at the top of the scene, where it is no key; accepted: the whole path: `time.step`",
            ),
            ("species[0]=A", "the whole path: `particles.0.species.0`"),
            ("particles.first.count=3", "found `first`"),
            ("time.step.unit=3", "found `unit` inside of `time.step`, which is 0.04"),
            ("time.step=nan", "found nan; accepted: a finite number"),
            ("time.step=1e999", "finite"),
            ("space.box=[6,6,nan]", "found [6,6,nan]; accepted: JSON (expected ident at line 1"),
            ("time={\"step\": 1", "accepted: JSON (EOF while parsing an object at line 1 column 10)"),
        ] {
            let message = after(argument).unwrap_err();
            assert!(message.contains(expected), "{argument}: {message}");
        }
    }
}
