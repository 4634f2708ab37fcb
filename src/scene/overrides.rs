//! Overrides `path.to.key=value` from the command line.

use serde_json::{Map, Value};

use super::Problem;

/// The form of an override, for messages.
const FORM: &str = "path.to.key=value, as in time.step=0.02";

/// Sets the value that an override names. Missing keys are created; the schema decides whether they are known.
pub(super) fn apply(document: &mut Value, argument: &str) -> Result<(), Problem> {
    set(document, argument)
        .map_err(|(found, accepted)| Problem::new(format_args!("override `{argument}`"), found, accepted))
}

/// What was found and what is accepted, if it fails.
fn set(document: &mut Value, argument: &str) -> Result<(), (String, String)> {
    let misshapen = |found: &str| (found.to_owned(), FORM.to_owned());
    let (path, text) = argument.split_once('=').ok_or_else(|| misshapen("found no `=`"))?;
    // Messages write `particles[0].count`; accept what they print.
    let path = path.trim().replace('[', ".").replace(']', "");
    if path.split('.').any(str::is_empty) {
        return Err(misshapen("found an empty part in the path"));
    }
    let value = value(text.trim()).map_err(|accepted| (format!("found {}", text.trim()), accepted))?;
    let mut place = document;
    let mut walked = String::new();
    for segment in path.split('.') {
        let index = segment.parse::<usize>().ok();
        if place.is_null() {
            *place = if index.is_some() { Value::Array(vec![Value::Null]) } else { Value::Object(Map::new()) };
        }
        place = match place {
            Value::Object(object) => object.entry(segment).or_insert(Value::Null),
            Value::Array(list) => {
                let length = list.len();
                index.and_then(|index| list.get_mut(index)).ok_or_else(|| {
                    let accepted = match length {
                        0 => format!("the whole of `{walked}`, a list that is empty"),
                        1 => format!("0, the only index of the list `{walked}`"),
                        _ => format!("an index from 0 to {} of the list `{walked}`", length - 1),
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
        apply(&mut document, argument).map(|()| document).map_err(|error| error.to_string())
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
    }

    #[test]
    fn mistakes_are_named() {
        for (argument, expected) in [
            ("time.step", "found no `=`; accepted: path.to.key=value"),
            ("=3", "empty part"),
            ("time..step=3", "empty part"),
            ("particles.1.count=3", "found `1`; accepted: 0, the only index of the list `particles`"),
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
