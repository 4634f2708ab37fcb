//! A scene's JSON against its JSON Schema, with every mistake reported at once.
//!
//! The schema is derived from the types, so keys, types, ranges and choices are written once. This reads the part of
//! JSON Schema that the derivation emits; a test refuses a schema with a keyword that is not read here.

use std::collections::HashMap;

use serde_json::{Map, Value};

use super::path::Path;
use super::{Problem, Problems, nearest};

/// Substitutes for numbers that are refused, and for lists of a wrong length: two choices that are far apart, so that a message that
/// both give does not depend on the substitute.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Substitute {
    /// Small numbers and short lists.
    Least,
    /// Large numbers and long lists.
    Most,
}

/// Checks `document` against `schema` and repairs it: afterwards it satisfies the schema wherever it can be read at all. Unknown keys,
/// and optional values that cannot be read, are removed after they are reported; numbers out of range and lists of a wrong length
/// are replaced; whole numbers written as `1e6` or `2000.0` become integers.
pub(super) fn check(schema: &Value, document: &mut Value, substitute: Substitute) -> Problems {
    let mut walker = Walker { root: schema, substitute, problems: Problems::default(), ranges: HashMap::new() };
    walker.check(schema, document, &Path::Root);
    walker.problems
}

/// Magnitudes of non-zero numbers that can be computed with: products of three are finite and not zero.
const MAGNITUDES: [f64; 2] = [1e-100, 1e100];

fn is_reckonable(number: f64) -> bool {
    number == 0.0 || (MAGNITUDES[0]..=MAGNITUDES[1]).contains(&number.abs())
}

struct Walker<'a> {
    root: &'a Value,
    substitute: Substitute,
    problems: Problems,
    /// Ranges of the schemas of numbers met so far; of other schemas none.
    ranges: HashMap<*const Value, Option<Range>>,
}

impl<'a> Walker<'a> {
    /// Whether the value can be read, right or wrong.
    fn check(&mut self, schema: &'a Value, value: &mut Value, path: &Path<'_>) -> bool {
        if value.is_number() && self.is_right_number(schema, value) {
            return true;
        }
        let layers = layers(self.root, schema);
        if let Some(alternatives) = layers.iter().find_map(|layer| alternatives(layer)) {
            return self.check_alternatives(schema, alternatives, value, path);
        }
        if !self.check_type(schema, &layers, value, path) {
            return false;
        }
        match value {
            Value::Number(_) => self.check_number(schema, &layers, value, path),
            Value::String(text) => self.check_text(schema, &layers, text, path),
            Value::Array(list) => self.check_list(schema, &layers, list, path),
            Value::Object(object) => self.check_object(&layers, object, path),
            Value::Null | Value::Bool(_) => true,
        }
    }

    /// Whether a number is one that a schema of numbers accepts. Scenes may list a hundred thousand of them.
    fn is_right_number(&mut self, schema: &'a Value, value: &Value) -> bool {
        let root = self.root;
        let range = self.ranges.entry(std::ptr::from_ref(schema)).or_insert_with(|| {
            let layers = layers(root, schema);
            let of_numbers = |layer: &&Value| {
                types(layer).iter().all(|kind| ["number", "integer"].contains(kind)) && alternatives(layer).is_none()
            };
            (layers.iter().all(of_numbers) && layers.iter().any(|layer| !types(layer).is_empty()))
                .then(|| Range::of(&layers))
        });
        let Some(range) = range else { return false };
        value.as_f64().is_some_and(|number| {
            let whole = value.is_u64() || value.is_i64();
            range.contains(number) && (whole || !range.integer) && (range.integer || is_reckonable(number))
        })
    }

    /// Reports that the value at `path` is not accepted by `schema`.
    fn refuse(&mut self, schema: &Value, value: &Value, path: &Path<'_>) {
        self.report(schema, path, found(value), None);
    }

    /// Reports what is not accepted by `schema`, and what may have been meant.
    fn report(&mut self, schema: &Value, path: &Path<'_>, phrase: String, suggestion: Option<String>) {
        let accepted = if self.problems.is_full() { String::new() } else { accepted(self.root, schema) };
        self.problems.push(Problem::new(path, phrase, accepted).suggest(suggestion));
    }

    fn check_alternatives(
        &mut self,
        schema: &'a Value,
        alternatives: &'a [Value],
        value: &mut Value,
        path: &Path<'_>,
    ) -> bool {
        if let Some(choices) = choices(alternatives) {
            let is_right = value.as_str().is_some_and(|text| choices.contains(&text));
            if !is_right {
                let suggestion = value.as_str().and_then(|text| nearest(text, choices));
                self.report(schema, path, found(value), suggestion);
            }
            return is_right;
        }
        if let Some(tags) = tags(self.root, alternatives) {
            return self.check_tagged(schema, alternatives, &tags, value, path);
        }
        // Whatever the value comes nearest to being is what its author meant.
        let mut fewest: Option<(Problems, Value, bool)> = None;
        // But for a null, nobody means none by saying something.
        for branch in alternatives.iter().filter(|branch| value.is_null() || branch["type"] != "null") {
            let mut attempt = Walker { problems: Problems::default(), ranges: HashMap::new(), ..*self };
            let mut mended = value.clone();
            let readable = attempt.check(branch, &mut mended, path);
            if fewest.as_ref().is_none_or(|(problems, ..)| attempt.problems.count() < problems.count()) {
                fewest = Some((attempt.problems, mended, readable));
            }
        }
        fewest.is_some_and(|(problems, mended, readable)| {
            *value = mended;
            self.problems.append(problems);
            readable
        })
    }

    /// One of several kinds of object, distinguished by the text of `type`.
    fn check_tagged(
        &mut self,
        schema: &'a Value,
        alternatives: &'a [Value],
        tags: &[&'a str],
        value: &mut Value,
        path: &Path<'_>,
    ) -> bool {
        let kinds = quoted(tags, '`');
        let Value::Object(object) = value else {
            let meant = value.as_str().and_then(|text| nearest(text, tags.iter().copied()));
            self.report(schema, path, found(value), meant.map(|tag| format!("{{\"type\": \"{tag}\"}}")));
            return false;
        };
        let place = path.key("type");
        match object.get("type") {
            None => {
                // A misspelt `type` is both an unknown key and a missing one.
                let suggestion = object.keys().find(|key| nearest(key, ["type"]).is_some());
                let found = suggestion.map_or("missing".to_owned(), |key| format!("missing (found `{key}`)"));
                self.problems.add(place, found, kinds);
            }
            Some(Value::String(text)) => {
                if let Some(chosen) = tags.iter().position(|tag| tag == text) {
                    return self.check(&alternatives[chosen], value, path);
                }
                let problem = Problem::new(place, format!("found \"{text}\""), kinds);
                self.problems.push(problem.suggest(nearest(text, tags.iter().copied())));
            }
            Some(other) => self.problems.add(place, found(other), kinds),
        }
        false
    }

    fn check_type(&mut self, schema: &Value, layers: &[&Value], value: &mut Value, path: &Path<'_>) -> bool {
        for layer in layers {
            let types = types(layer);
            if types.is_empty() {
                continue;
            }
            if types.contains(&"integer")
                && let Some(number) = value.as_f64()
                && value.is_f64()
                && number.fract() == 0.0
            {
                if number >= 0.0 && number < u64::MAX as f64 {
                    *value = (number as u64).into();
                } else if number < 0.0 && number >= i64::MIN as f64 {
                    *value = (number as i64).into();
                }
            }
            let matches = match value {
                Value::Null => types.contains(&"null"),
                Value::Bool(_) => types.contains(&"boolean"),
                Value::Number(number) => types.contains(&"number") || types.contains(&"integer") && !number.is_f64(),
                Value::String(_) => types.contains(&"string"),
                Value::Array(_) => types.contains(&"array"),
                Value::Object(_) => types.contains(&"object"),
            };
            if !matches {
                self.refuse(schema, value, path);
                return false;
            }
        }
        true
    }

    fn check_number(&mut self, schema: &Value, layers: &[&Value], value: &mut Value, path: &Path<'_>) -> bool {
        let range = Range::of(layers);
        // Within a whole number's format, u64 and f64 compare exactly enough: every bound is far below 2^53 or at 2^64.
        let inside = value.as_f64().is_some_and(|number| range.contains(number))
            && !(range.integer && value.as_i64().is_none() && value.as_u64().is_none());
        if !inside {
            self.refuse(schema, value, path);
            *value = range.substitute(self.substitute);
        } else if !range.integer
            && let Some(number) = value.as_f64().filter(|number| !is_reckonable(*number))
        {
            let [least, most] = MAGNITUDES;
            let accepted = format!(
                "a number nearer to the others of the scene, of a magnitude from {least:e} to {most:e}: choose other units"
            );
            self.problems.refuse(path, format!("{number:e}"), accepted);
            *value = range.substitute(self.substitute);
        }
        true
    }

    fn check_text(&mut self, schema: &Value, layers: &[&Value], text: &str, path: &Path<'_>) -> bool {
        for layer in layers {
            let short = layer["minLength"].as_u64().is_some_and(|least| (text.chars().count() as u64) < least);
            let other = layer.get("const").is_some_and(|only| only != text);
            let none = layer["enum"].as_array().is_some_and(|choices| !choices.iter().any(|choice| choice == text));
            if short || other || none {
                let choices = layer["enum"].as_array().into_iter().flatten().filter_map(Value::as_str);
                self.report(schema, path, format!("found \"{text}\""), nearest(text, choices));
                return short;
            }
        }
        true
    }

    fn check_list(&mut self, schema: &'a Value, layers: &[&'a Value], list: &mut Vec<Value>, path: &Path<'_>) -> bool {
        let mut readable = true;
        for layer in layers {
            let length = list.len() as u64;
            let short = layer["minItems"].as_u64().is_some_and(|least| length < least);
            let long = layer["maxItems"].as_u64().is_some_and(|most| length > most);
            if short || long {
                let entries = if length == 1 { "entry" } else { "entries" };
                self.report(schema, path, format!("found a list of {length} {entries}"), None);
                readable &= layer["minItems"] != layer["maxItems"] && self.resize(layer, list);
            }
            let first = layer["prefixItems"].as_array().map_or(&[][..], Vec::as_slice);
            for (index, entry) in list.iter_mut().enumerate() {
                if let Some(schema) = first.get(index).or_else(|| layer.get("items")) {
                    readable &= self.check(schema, entry, &path.index(index));
                }
            }
        }
        readable
    }

    /// Gives a list of a wrong length a right one, if there are entries for it.
    fn resize(&self, layer: &'a Value, list: &mut Vec<Value>) -> bool {
        let bound = |key: &str| layer[key].as_u64().map(|bound| bound as usize);
        let (least, most) = (bound("minItems").unwrap_or(0), bound("maxItems"));
        let length = match self.substitute {
            Substitute::Least => least,
            Substitute::Most => most.unwrap_or(list.len()).max(least),
        };
        let items = layers(self.root, &layer["items"]);
        let is_number = items.iter().any(|layer| types(layer).iter().any(|kind| ["number", "integer"].contains(kind)));
        if list.len() > length {
            list.truncate(length);
        } else if is_number {
            list.resize(length.min(least.max(8)), Range::of(&items).substitute(self.substitute));
        }
        list.len() >= least
    }

    fn check_object(&mut self, layers: &[&'a Value], object: &mut Map<String, Value>, path: &Path<'_>) -> bool {
        let known: Vec<(&'a str, &'a Value)> = layers
            .iter()
            .filter_map(|layer| layer["properties"].as_object())
            .flatten()
            .map(|(key, schema)| (key.as_str(), schema))
            .collect();
        let closed = layers
            .iter()
            .any(|layer| layer["additionalProperties"] == false || layer["unevaluatedProperties"] == false);
        let required = layers.iter().filter_map(|layer| layer["required"].as_array()).flatten();
        let required = required.chain(layers.iter().flat_map(|layer| required_otherwise(layer, object)));
        let required: Vec<&str> = required.filter_map(Value::as_str).collect();
        let mut missing: Vec<&str> = required.iter().copied().filter(|key| !object.contains_key(*key)).collect();
        let mut readable = missing.is_empty();

        let mut taken_out = Vec::new();
        for (key, value) in object.iter_mut() {
            match known.iter().find(|(name, _)| name == key) {
                Some((_, schema)) if self.check(schema, value, &path.key(key)) => {}
                // Without a list of interactions or pairs a scene would be another one.
                Some(_) if value.is_array() => readable = false,
                Some(_) => {
                    readable &= !required.contains(&key.as_str());
                    taken_out.push(key.clone());
                }
                None if closed && self.problems.is_full() => {
                    self.problems.add("", "", "");
                    taken_out.push(key.clone());
                }
                None if closed => {
                    // What is not there yet is likelier to be meant than what is; a missing key most of all.
                    let names = known.iter().map(|(name, _)| *name);
                    let suggestion = nearest(key, missing.iter().copied()).or_else(|| nearest(key, names.clone()));
                    // A misspelt required key is one mistake, not two.
                    missing.retain(|key| suggestion.as_deref() != Some(*key));
                    let accepted = names.filter(|name| *name != "$schema").collect::<Vec<_>>().join(", ");
                    let problem = Problem::new(path.key(key), "unknown key", accepted);
                    self.problems.push(problem.suggest(suggestion));
                    taken_out.push(key.clone());
                }
                None => {}
            }
        }
        for key in taken_out {
            object.remove(&key);
        }
        for key in missing {
            let schema = known.iter().find(|(name, _)| *name == key).map_or(&Value::Null, |(_, schema)| *schema);
            self.problems.add(path.key(key), "missing", accepted(self.root, schema));
        }
        readable
    }
}

/// Keys that are required where those that an `if` requires are not there.
fn required_otherwise<'a>(layer: &'a Value, object: &Map<String, Value>) -> &'a [Value] {
    let is_there = |key: &Value| key.as_str().and_then(|key| object.get(key)).is_some_and(|value| !value.is_null());
    let condition = layer["if"]["required"].as_array().map_or(&[][..], Vec::as_slice);
    let otherwise = layer["else"]["required"].as_array().map_or(&[][..], Vec::as_slice);
    if condition.iter().all(is_there) { &[] } else { otherwise }
}

/// A schema and what it refers to, outermost first.
fn layers<'a>(root: &'a Value, schema: &'a Value) -> Vec<&'a Value> {
    let mut layers = vec![schema];
    let mut current = schema;
    while let Some(target) =
        current["$ref"].as_str().and_then(|reference| root.pointer(reference.strip_prefix('#').unwrap_or(reference)))
    {
        layers.push(target);
        current = target;
    }
    layers
}

fn alternatives(schema: &Value) -> Option<&[Value]> {
    schema.get("oneOf").or_else(|| schema.get("anyOf"))?.as_array().map(Vec::as_slice)
}

/// The texts that are accepted, where every alternative is one.
fn choices(alternatives: &[Value]) -> Option<Vec<&str>> {
    alternatives.iter().map(|choice| choice["const"].as_str()).collect()
}

/// The texts of `type` that select an alternative, where every one has such a text.
fn tags<'a>(root: &'a Value, alternatives: &'a [Value]) -> Option<Vec<&'a str>> {
    let tag = |layer: &&'a Value| layer["properties"]["type"]["const"].as_str();
    alternatives.iter().map(|branch| layers(root, branch).iter().find_map(tag)).collect()
}

/// Names in a row, each between quotes.
fn quoted(names: &[&str], quote: char) -> String {
    names.iter().map(|name| format!("{quote}{name}{quote}")).collect::<Vec<_>>().join(", ")
}

fn types(schema: &Value) -> Vec<&str> {
    match &schema["type"] {
        Value::String(only) => vec![only],
        Value::Array(several) => several.iter().filter_map(Value::as_str).collect(),
        _ => Vec::new(),
    }
}

/// The numbers a schema accepts.
#[derive(Default)]
struct Range {
    integer: bool,
    least: Option<f64>,
    above: Option<f64>,
    most: Option<f64>,
    below: Option<f64>,
}

impl Range {
    fn of(layers: &[&Value]) -> Self {
        let mut range = Self::default();
        for layer in layers {
            range.integer |= types(layer).contains(&"integer");
            let (least, most) = match layer["format"].as_str() {
                Some("uint32") => (Some(0.0), Some(f64::from(u32::MAX))),
                Some("uint64") => (Some(0.0), None),
                _ => (None, None),
            };
            range.least = layer["minimum"].as_f64().or(least).or(range.least);
            range.most = layer["maximum"].as_f64().or(most).or(range.most);
            range.above = layer["exclusiveMinimum"].as_f64().or(range.above);
            range.below = layer["exclusiveMaximum"].as_f64().or(range.below);
        }
        range
    }

    fn contains(&self, number: f64) -> bool {
        self.least.is_none_or(|least| number >= least)
            && self.most.is_none_or(|most| number <= most)
            && self.above.is_none_or(|above| number > above)
            && self.below.is_none_or(|below| number < below)
    }

    /// A number in the range; if the range has no end, a moderate one.
    fn substitute(&self, substitute: Substitute) -> Value {
        let least = self.least.or(self.above.map(|above| above + if self.integer { 1.0 } else { 1e-3 }));
        let most = self.most.or(self.below.map(|below| below - if self.integer { 1.0 } else { 1e-3 }));
        let number = match substitute {
            Substitute::Least => least.or(most).unwrap_or(0.0),
            Substitute::Most => most.unwrap_or_else(|| least.map_or(1e3, |least| 1e3 * (1.0 + least.abs()))),
        };
        if !self.integer {
            return number.into();
        }
        if number < 0.0 { (number as i64).into() } else { (number as u64).into() }
    }

    fn describe(&self) -> String {
        let kind = if self.integer { "a whole number" } else { "a number" };
        match (self.least, self.above, self.most, self.below) {
            (Some(least), _, Some(most), _) if least == most => format!("the number {least}"),
            (Some(least), _, Some(most), _) => format!("{kind} from {least} to {most}"),
            (Some(0.0), _, _, _) if self.integer => format!("{kind}, zero or positive, up to {}", u64::MAX),
            (Some(0.0), _, _, _) => format!("{kind}, zero or positive"),
            (Some(least), _, _, _) => format!("{kind} of at least {least}"),
            (_, Some(0.0), None, None) => format!("{kind} greater than zero"),
            (_, Some(above), None, None) => format!("{kind} greater than {above}"),
            (_, Some(above), Some(most), _) => format!("{kind} greater than {above}, at most {most}"),
            (_, _, Some(most), _) => format!("{kind} of at most {most}"),
            (_, Some(above), _, Some(below)) => format!("{kind} above {above} and below {below}"),
            (_, _, _, Some(below)) => format!("{kind} below {below}"),
            (None, None, None, None) => kind.to_owned(),
        }
    }
}

/// A value of a scene, short enough for one line.
fn found(value: &Value) -> String {
    match value {
        Value::String(text) if text.chars().count() > 40 => {
            format!("found the text \"{}…\"", text.chars().take(40).collect::<String>())
        }
        Value::String(text) => format!("found the text \"{text}\""),
        Value::Array(list) => format!("found a list of {}", list.len()),
        Value::Object(_) => "found an object".to_owned(),
        Value::Null | Value::Bool(_) | Value::Number(_) => format!("found {value}"),
    }
}

/// What a schema accepts, as a phrase.
fn accepted(root: &Value, schema: &Value) -> String {
    let layers = layers(root, schema);
    if let Some(alternatives) = layers.iter().find_map(|layer| alternatives(layer)) {
        if let Some(choices) = choices(alternatives) {
            return quoted(&choices, '"');
        }
        if let Some(tags) = tags(root, alternatives) {
            return format!("an object whose `type` is {}", quoted(&tags, '"'));
        }
        let phrases: Vec<String> = alternatives
            .iter()
            .filter(|branch| types(branch) != ["null"])
            .map(|branch| accepted(root, branch))
            .collect();
        return phrases.join(", or ");
    }
    let kind = layers.iter().find_map(|layer| types(layer).into_iter().find(|kind| *kind != "null"));
    let from_layers = |key: &str| layers.iter().find_map(|layer| layer.get(key));
    match kind {
        Some("number" | "integer") => Range::of(&layers).describe(),
        Some("string") => match from_layers("enum").and_then(Value::as_array) {
            Some(choices) => choices.iter().map(Value::to_string).collect::<Vec<_>>().join(", "),
            None => match from_layers("const") {
                Some(only) => only.to_string(),
                None if from_layers("minLength").is_some() => "text that is not empty".to_owned(),
                None => "text".to_owned(),
            },
        },
        Some("boolean") => "true or false".to_owned(),
        Some("array") => {
            let bound = |key: &str| from_layers(key).and_then(Value::as_u64);
            let length = match (bound("minItems"), bound("maxItems")) {
                (Some(least), Some(most)) if least == most => format!(" of {least} entries"),
                (Some(least), Some(most)) => format!(" of {least} to {most} entries"),
                (Some(least), None) => format!(" of at least {least} entries"),
                (None, Some(most)) => format!(" of at most {most} entries"),
                (None, None) => String::new(),
            };
            match from_layers("items") {
                Some(items) => format!("a list{length}, each {}", accepted(root, items)),
                None => format!("a list{length}"),
            }
        }
        Some("object") => {
            let keys = layers.iter().filter_map(|layer| layer["properties"].as_object()).flat_map(Map::keys);
            let keys: Vec<&str> = keys.map(String::as_str).filter(|key| *key != "$schema").collect();
            format!("an object with {}", quoted(&keys, '`'))
        }
        _ => "any value".to_owned(),
    }
}

#[cfg(test)]
mod tests {
    use serde_json::json;

    use super::*;

    /// Every keyword in the published schema, by the place where keywords stand.
    fn keywords(schema: &Value, into: &mut Vec<String>) {
        let Some(object) = schema.as_object() else { return };
        for (key, value) in object {
            into.push(key.clone());
            match key.as_str() {
                "properties" | "$defs" => {
                    value.as_object().into_iter().flatten().for_each(|(_, schema)| keywords(schema, into));
                }
                "oneOf" | "anyOf" | "prefixItems" => {
                    value.as_array().into_iter().flatten().for_each(|schema| keywords(schema, into));
                }
                "items" => keywords(value, into),
                _ => {}
            }
        }
    }

    #[test]
    fn every_keyword_of_the_schema_is_read() {
        let read = [
            "$defs",
            "$ref",
            "$schema",
            "additionalProperties",
            "anyOf",
            "const",
            "default",
            "description",
            // Of `if` and `else` the required keys are read; numbers of particles are checked, in better words, with their meaning.
            "else",
            "enum",
            "exclusiveMaximum",
            "exclusiveMinimum",
            "format",
            "if",
            "items",
            "maxItems",
            "maximum",
            "minItems",
            "minLength",
            "minimum",
            "oneOf",
            "prefixItems",
            "properties",
            "required",
            "then",
            "title",
            "type",
            "unevaluatedProperties",
        ];
        let mut found = Vec::new();
        keywords(&crate::scene::schema(), &mut found);
        assert!(found.len() > 300, "the walk over the schema stopped early: {}", found.len());
        found.retain(|keyword| !read.contains(&keyword.as_str()));
        assert!(found.is_empty(), "not read: {found:?}");
    }

    fn messages(schema: &Value, mut value: Value) -> Vec<String> {
        check(schema, &mut value, Substitute::Least).iter().map(ToString::to_string).collect()
    }

    #[test]
    fn references_with_siblings_are_one_object() {
        let schema = json!({
            "type": "object", "$ref": "#/$defs/Inner", "properties": {"type": {"const": "x", "type": "string"}},
            "unevaluatedProperties": false,
            "$defs": {"Inner": {"type": "object", "properties": {"size": {"type": "integer", "maximum": 3}},
                "required": ["size"]}},
        });
        assert!(messages(&schema, json!({"type": "x", "size": 3})).is_empty());
        assert_eq!(
            messages(&schema, json!({"type": "x", "size": 4})),
            ["size: found 4; accepted: a whole number of at most 3"]
        );
        assert_eq!(messages(&schema, json!({"type": "x"})), ["size: missing; accepted: a whole number of at most 3"]);
        assert_eq!(
            messages(&schema, json!({"type": "x", "seize": 4})),
            ["seize: unknown key; did you mean `size`? accepted: type, size",]
        );
    }

    #[test]
    fn tuples_enumerations_and_absent_values() {
        let schema = json!({"type": "object", "properties": {
            "pair": {"type": "array", "prefixItems": [{"type": "string"}, {"type": "number"}], "minItems": 2},
            "mode": {"type": "string", "enum": ["fast", "exact"]},
            "maybe": {"anyOf": [{"type": "object", "properties": {"n": {"type": "integer"}}}, {"type": "null"}]},
        }});
        assert!(messages(&schema, json!({"pair": ["a", 1], "mode": "fast", "maybe": null})).is_empty());
        assert_eq!(
            messages(&schema, json!({"pair": ["a", "b"], "mode": "exat", "maybe": {"n": 1.5}})),
            [
                "pair[1]: found the text \"b\"; accepted: a number",
                "mode: found \"exat\"; did you mean `exact`? accepted: \"fast\", \"exact\"",
                "maybe.n: found 1.5; accepted: a whole number",
            ]
        );
    }

    #[test]
    fn every_mistake_in_an_optional_object_is_told() {
        let schema = json!({"type": "object", "properties": {"maybe": {"anyOf": [
            {"type": "object", "additionalProperties": false, "required": ["every"],
                "properties": {"every": {"type": "integer", "minimum": 1}, "window": {"type": "integer", "minimum": 1}}},
            {"type": "null"},
        ]}}});
        assert!(messages(&schema, json!({"maybe": null})).is_empty());
        assert_eq!(
            messages(&schema, json!({"maybe": {"every": 0, "window": 0}})),
            [
                "maybe.every: found 0; accepted: a whole number of at least 1",
                "maybe.window: found 0; accepted: a whole number of at least 1",
            ]
        );
        assert_eq!(
            messages(&schema, json!({"maybe": {"evry": 5, "windw": 20}})).len(),
            2,
            "what a slip stands for is not missing too"
        );
        assert_eq!(
            messages(&schema, json!({"maybe": {}})),
            ["maybe.every: missing; accepted: a whole number of at least 1"]
        );
    }

    #[test]
    fn whole_numbers_may_be_written_with_an_exponent() {
        let schema = json!({"type": "integer", "format": "uint64", "minimum": 0});
        let mut value = json!(1e12);
        assert!(check(&schema, &mut value, Substitute::Least).is_empty());
        assert_eq!(value, json!(1_000_000_000_000_u64));
        assert_eq!(messages(&schema, json!(1e30)).len(), 1);
        assert_eq!(messages(&schema, json!(-1.0)).len(), 1);
        assert_eq!(messages(&schema, json!(0.5)).len(), 1);
        assert_eq!(messages(&json!({"type": "integer", "format": "uint32"}), json!(4_294_967_296_u64)).len(), 1);
    }
}
