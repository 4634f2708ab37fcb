//! JSON text to a JSON value, with the mistakes that a plain parser hides: duplicate keys.

use std::cell::RefCell;
use std::fmt;

use serde::de::{DeserializeSeed, Deserializer, Error as _, MapAccess, SeqAccess, Visitor};
use serde_json::{Map, Number, Value};

use super::path::Path;
use super::{Problems, SceneError};
use crate::state_file;

/// The value of a JSON text, and a problem for every duplicate key.
pub(super) fn parse(name: &str, text: &str) -> Result<(Value, Problems), SceneError> {
    let text = text.strip_prefix('\u{feff}').unwrap_or(text);
    let repeated = RefCell::new(Problems::default());
    let mut deserializer = serde_json::Deserializer::from_str(text);
    let value = ValueAt { path: &Path::Root, repeated: &repeated }
        .deserialize(&mut deserializer)
        .and_then(|value| deserializer.end().map(|()| value))
        .map_err(|error| syntax(name, text, &error))?;
    Ok((value, repeated.into_inner()))
}

fn syntax(name: &str, text: &str, error: &serde_json::Error) -> SceneError {
    let (line, column) = (error.line(), error.column());
    let said = error.to_string();
    let position = format!(" at line {line} column {column}");
    let mut message = said.strip_suffix(&position).unwrap_or(&said).to_owned();
    if text.trim().is_empty() {
        "the file is empty; a scene is a JSON object".clone_into(&mut message);
    } else if let Some(found) = foreign(text.as_bytes()) {
        message = format!("not valid JSON: {found}");
    } else if let Some(hint) = hint(text, line, column, &said) {
        message = format!("not valid JSON: {message}; {hint}");
    } else {
        message = format!("not valid JSON: {message}");
    }
    SceneError::Syntax { name: name.to_owned(), line, column, message }
}

/// Bytes of a file by which those of other programs are known.
const BEGINNING: usize = 1 << 14;

/// Words that begin lines of scripts for LAMMPS; two of them are no accident.
const COMMANDS: [&str; 8] =
    ["units", "atom_style", "pair_style", "pair_coeff", "read_data", "create_box", "boundary", "fix"];

/// What a file is that another program reads or writes, and what to do with it.
pub(super) fn foreign(content: &[u8]) -> Option<String> {
    let start = &content[..content.len().min(BEGINNING)];
    if let Some(format) = state_file::format_of(start) {
        return Some(format!("this is {format}; a scene is a JSON file, and its `state` names a file with particles"));
    }
    let text = String::from_utf8_lossy(start);
    let first_words = text.lines().filter_map(|line| line.split_whitespace().next());
    let is_script = first_words.filter(|word| COMMANDS.contains(word)).take(2).count() == 2;
    is_script.then(|| {
        "this is a script for LAMMPS; a scene is a JSON file (`mesoscope scenes dpd-fluid` prints one), and its `state` reads what \
         `write_data` wrote"
            .to_owned()
    })
}

/// Advice for common mistakes in JSON.
fn hint(text: &str, line: usize, column: usize, said: &str) -> Option<&'static str> {
    if said.contains("number out of range") {
        return Some("every number must be finite in double precision");
    }
    let bytes = text.lines().nth(line.checked_sub(1)?)?.as_bytes();
    // The parser stops somewhere inside the offending word.
    let at = column.saturating_sub(1).min(bytes.len());
    let ends_word = |byte: &u8| byte.is_ascii_whitespace() || b",:[]{}\"".contains(byte);
    let start = bytes[..at].iter().rposition(ends_word).map_or(0, |before| before + 1);
    let end = bytes[at..].iter().position(ends_word).map_or(bytes.len(), |length| at + length);
    let word = bytes[start..end].to_ascii_lowercase();
    let word = word.strip_prefix(b"-").or(word.strip_prefix(b"+")).unwrap_or(&word);
    if word.starts_with(b"nan") || word.starts_with(b"inf") {
        Some("JSON has no NaN or Infinity: every number must be finite")
    } else if word.starts_with(b"//") || word.starts_with(b"/*") || word.starts_with(b"#") {
        Some("JSON has no comments: say it in `description`")
    } else if word.starts_with(b"'") {
        Some("JSON text stands in double quotes")
    } else if word.starts_with(b".") {
        Some("a number starts with a digit: 0.5, not .5")
    } else {
        None
    }
}

/// Reads a value that stands at `path`.
struct ValueAt<'a> {
    path: &'a Path<'a>,
    repeated: &'a RefCell<Problems>,
}

impl<'de> DeserializeSeed<'de> for ValueAt<'_> {
    type Value = Value;

    fn deserialize<D: Deserializer<'de>>(self, deserializer: D) -> Result<Value, D::Error> {
        deserializer.deserialize_any(self)
    }
}

impl<'de> Visitor<'de> for ValueAt<'_> {
    type Value = Value;

    fn expecting(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str("a JSON value")
    }

    fn visit_unit<E>(self) -> Result<Value, E> {
        Ok(Value::Null)
    }

    fn visit_bool<E>(self, value: bool) -> Result<Value, E> {
        Ok(Value::Bool(value))
    }

    fn visit_i64<E>(self, value: i64) -> Result<Value, E> {
        Ok(value.into())
    }

    fn visit_u64<E>(self, value: u64) -> Result<Value, E> {
        Ok(value.into())
    }

    fn visit_f64<E: serde::de::Error>(self, value: f64) -> Result<Value, E> {
        Number::from_f64(value).map(Value::Number).ok_or_else(|| E::custom("number out of range"))
    }

    fn visit_str<E>(self, value: &str) -> Result<Value, E> {
        Ok(Value::String(value.to_owned()))
    }

    fn visit_string<E>(self, value: String) -> Result<Value, E> {
        Ok(Value::String(value))
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut sequence: A) -> Result<Value, A::Error> {
        let mut list = Vec::new();
        loop {
            let path = self.path.index(list.len());
            let Some(value) = sequence.next_element_seed(ValueAt { path: &path, repeated: self.repeated })? else {
                // Lists are as long as a scene is: they shall not take twice their room.
                list.shrink_to_fit();
                return Ok(Value::Array(list));
            };
            list.push(value);
        }
    }

    fn visit_map<A: MapAccess<'de>>(self, mut entries: A) -> Result<Value, A::Error> {
        let mut object = Map::new();
        while let Some(key) = entries.next_key::<String>()? {
            let path = self.path.key(&key);
            let value = entries.next_value_seed(ValueAt { path: &path, repeated: self.repeated })?;
            if object.contains_key(&key) {
                let mut repeated = self.repeated.try_borrow_mut().map_err(A::Error::custom)?;
                repeated.add(path, "the key is given more than once", "every key once");
            }
            object.insert(key, value);
        }
        Ok(Value::Object(object))
    }
}
