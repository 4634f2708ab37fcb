//! What a user wants varied: `key=value,value,…`.

use crate::scene::value;
use serde::{Deserialize, Serialize};
use serde_json::Value;

/// A key of a scene and the values to try.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Variation {
    /// Path of the key, as in an override: `interactions.0.friction`.
    pub key: String,
    /// The values, in the order of the variants.
    pub values: Vec<Value>,
}

/// A key of a scene and its value in one variant.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Setting {
    /// Path of the key, as in an override.
    pub key: String,
    /// Its value.
    pub value: Value,
}

const ACCEPTED: &str = "accepted: key=value,value,…, as in time.step=0.02,0.04";

impl Setting {
    /// The setting as an override of a scene.
    pub(crate) fn argument(&self) -> String {
        format!("{}={}", self.key, self.value)
    }
}

impl Variation {
    /// Reads `key=value,value,…`. A value is JSON, a number as people write it (`.5`) or text; commas inside brackets,
    /// braces and quotation marks belong to the value.
    ///
    /// # Errors
    /// What is wrong, in words.
    ///
    /// ```
    /// use mesoscope::study::Variation;
    /// let boxes = Variation::parse("space.box=[5,5,5],[10,10,10]")?;
    /// assert_eq!((boxes.key.as_str(), boxes.values.len()), ("space.box", 2));
    /// # Ok::<(), String>(())
    /// ```
    pub fn parse(argument: &str) -> Result<Self, String> {
        let (key, text) = split_key(argument).ok_or(ACCEPTED)?;
        let mut values = Vec::new();
        for piece in pieces(text) {
            if piece.is_empty() {
                return Err(format!("there is an empty value; {ACCEPTED}"));
            }
            let value = read(piece)?;
            if values.iter().any(|known| same(known, &value)) {
                return Err(format!("the value {piece} stands there twice"));
            }
            values.push(value);
        }
        Ok(Self { key, values })
    }
}

/// Values as numbers, if all of them are.
pub(crate) fn numbers(values: &[Value]) -> Option<Vec<f64>> {
    values.iter().map(Value::as_f64).collect()
}

/// Reads the settings of one variant, `key=value,key=value,…`.
pub(crate) fn settings(argument: &str) -> Result<Vec<Setting>, String> {
    let mut settings: Vec<Setting> = Vec::new();
    for piece in pieces(argument) {
        let (key, text) = split_key(piece).ok_or_else(|| {
            format!("`{piece}` is no setting; accepted: key=value,key=value,…, as in time.step=0.01,temperature=0")
        })?;
        if settings.iter().any(|known| known.key == key) {
            return Err(format!("`{key}` is set twice"));
        }
        settings.push(Setting { key, value: read(text)? });
    }
    Ok(settings)
}

/// Takes the number of steps out of overrides that set it: what no longer fits is then shortened, as if it were asked for by itself.
pub(crate) fn steps_of(set: &mut Vec<String>) -> Option<u64> {
    let steps = |argument: &String| {
        let (_, text) = split_key(argument).filter(|(key, _)| key == "time.steps")?;
        let number = value(text).ok()?;
        let written = number.as_f64().filter(|steps| steps.fract() == 0.0 && (0.0..9e15).contains(steps));
        number.as_u64().or(written.map(|steps| steps as u64))
    };
    let found = set.iter().rev().find_map(steps);
    set.retain(|argument| steps(argument).is_none());
    found
}

fn read(text: &str) -> Result<Value, String> {
    value(text).map_err(|accepted| format!("found {text}; accepted: {accepted}"))
}

/// Whether two values are the same to a scene: 1 is 1.0.
fn same(a: &Value, b: &Value) -> bool {
    a == b || (a.is_f64() || b.is_f64()) && a.as_f64().zip(b.as_f64()).is_some_and(|(a, b)| a == b)
}

/// The key in the form that messages and tables use, and the text after it.
fn split_key(argument: &str) -> Option<(String, &str)> {
    let (key, text) = argument.split_once('=')?;
    let key = key.trim().replace('[', ".").replace(']', "");
    (!key.is_empty()).then_some((key, text.trim()))
}

/// The parts of a text between its commas, without those inside brackets, braces and quotation marks.
fn pieces(text: &str) -> Vec<&str> {
    let mut pieces = Vec::new();
    let (mut start, mut depth, mut quoted, mut escaped) = (0, 0_usize, false, false);
    for (at, character) in text.char_indices() {
        match character {
            _ if escaped => escaped = false,
            '\\' if quoted => escaped = true,
            '"' => quoted = !quoted,
            _ if quoted => {}
            '[' | '{' => depth += 1,
            ']' | '}' => depth = depth.saturating_sub(1),
            ',' if depth == 0 => {
                pieces.push(text[start..at].trim());
                start = at + 1;
            }
            _ => {}
        }
    }
    pieces.push(text[start..].trim());
    pieces
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use serde_json::json;

    #[test]
    fn values_are_json_numbers_or_words() {
        let values = |argument: &str| Variation::parse(argument).unwrap().values;
        assert_eq!(values("a=1,.5, 2e3"), [json!(1), json!(0.5), json!(2e3)]);
        assert_eq!(values("integrator.type=splitting,cotter-reich"), [json!("splitting"), json!("cotter-reich")]);
        assert_eq!(values("a=[1,2],[3,4]"), [json!([1, 2]), json!([3, 4])]);
        assert_eq!(values(r#"a={"type":"x","list":[1,2]},null"#), [json!({"type": "x", "list": [1, 2]}), json!(null)]);
        assert_eq!(values(r#"a="one, two","say \"three, four\"""#), [json!("one, two"), json!("say \"three, four\"")]);
        assert_eq!(Variation::parse("interactions[0].friction=1").unwrap().key, "interactions.0.friction");
    }

    #[test]
    fn mistakes_are_named() {
        for (argument, expected) in [
            ("friction", "accepted: key=value,value"),
            ("=1,2", "accepted: key=value,value"),
            ("a=", "empty value"),
            ("a=1,,2", "empty value"),
            ("a=1,2,1", "the value 1 stands there twice"),
            ("a=1,2,1.0", "the value 1.0 stands there twice"),
            ("a=nan", "finite"),
        ] {
            let message = Variation::parse(argument).unwrap_err();
            assert!(message.contains(expected), "{argument}: {message}");
        }
    }

    #[test]
    fn the_last_number_of_steps_counts() {
        let mut set = ["time.steps=10", "seed=1", "time.steps = 2e3", "time.step=0.1"].map(str::to_owned).to_vec();
        assert_eq!((steps_of(&mut set), set.len()), (Some(2000), 2));
        // What is no number of steps stays, and is refused with the scene.
        let mut set = vec!["time.steps=-1".to_owned()];
        assert_eq!((steps_of(&mut set), set.len()), (None, 1));
    }

    #[test]
    fn a_variant_of_its_own_has_several_settings() {
        let found = settings(r#"bath={"type":"markov","rate":2},time.step=.01"#).unwrap();
        assert_eq!(found[0].argument(), r#"bath={"type":"markov","rate":2}"#);
        assert_eq!(found[1], Setting { key: "time.step".to_owned(), value: json!(0.01) });
        assert!(settings("a=1,2").unwrap_err().contains("`2` is no setting"));
        assert!(settings("a=1,a=2").unwrap_err().contains("set twice"));
    }
}
