//! Overrides `path.to.key=value` from the command line.

use serde_json::{Map, Value};

use super::error::SceneError;

/// Sets what one override names. Missing keys are created; whether they are known is for the schema to say.
pub(super) fn apply(document: &mut Value, argument: &str) -> Result<(), SceneError> {
    set(document, argument).map_err(|message| SceneError::Override { argument: argument.to_owned(), message })
}

fn set(document: &mut Value, argument: &str) -> Result<(), String> {
    let Some((path, text)) = argument.split_once('=') else {
        return Err("accepted: path.to.key=value, as in time.step=0.02".to_owned());
    };
    // Messages write `particles[0].count`; accept what they print.
    let path = path.trim().replace('[', ".").replace(']', "");
    let value = value(text.trim())?;
    let mut place = document;
    let mut walked = String::new();
    for segment in path.split('.') {
        if segment.is_empty() {
            return Err("the path has an empty part; accepted: path.to.key=value, as in time.step=0.02".to_owned());
        }
        if place.is_null() {
            *place = Value::Object(Map::new());
        }
        place = match place {
            Value::Object(object) => object.entry(segment).or_insert(Value::Null),
            Value::Array(list) => {
                let length = list.len();
                segment.parse::<usize>().ok().and_then(|index| list.get_mut(index)).ok_or_else(|| {
                    let accepted = match length {
                        0 => "and it is empty".to_owned(),
                        1 => "and its only index is 0".to_owned(),
                        _ => format!("and its indices are 0 to {}", length - 1),
                    };
                    format!("`{walked}` is a list, {accepted}; found `{segment}`")
                })?
            }
            other => {
                return Err(format!("`{walked}` is {other}, not an object or a list, and has no `{segment}` inside"));
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

/// JSON where it is JSON; a number as people write numbers (`.5`, `+2`); otherwise text.
pub(crate) fn value(text: &str) -> Result<Value, String> {
    if let Ok(value) = serde_json::from_str(text) {
        return Ok(value);
    }
    match text.parse::<f64>() {
        Ok(number) if number.is_finite() => Ok(number.into()),
        Ok(_) => Err(format!("every number must be finite; found {text} (if it is a name, quote it: '\"{text}\"')")),
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
        assert_eq!(after("output.trajectory.every=9").unwrap()["output"], json!({"trajectory": {"every": 9}}));
    }

    #[test]
    fn mistakes_are_named() {
        for (argument, expected) in [
            ("time.step", "accepted: path.to.key=value"),
            ("=3", "empty part"),
            ("time..step=3", "empty part"),
            ("particles.1.count=3", "only index is 0; found `1`"),
            ("particles.first.count=3", "found `first`"),
            ("time.step.unit=3", "`time.step` is 0.04"),
            ("time.step=nan", "finite"),
            ("time.step=1e999", "finite"),
        ] {
            let message = after(argument).unwrap_err();
            assert!(message.contains(expected), "{argument}: {message}");
        }
    }
}
