//! A scene's JSON against its JSON Schema, with every mistake reported at once.
//!
//! The schema is derived from the types, so keys, types, ranges and choices are written once. This reads the part of
//! JSON Schema that the derivation emits; a test refuses a schema with a keyword that is not read here.

use serde_json::{Map, Value};

use super::path::Path;
use super::{Problem, Problems, SystemKind, nearest};

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
/// are replaced; whole numbers written as `1e6` or `2000.0` become integers. Keys and choices of other kinds of systems are refused,
/// where the kind of this one is known.
pub(super) fn check(
    schema: &Schema<'_>,
    document: &mut Value,
    system: Option<SystemKind>,
    substitute: Substitute,
) -> Problems {
    let mut walker = Walker { system, substitute, problems: Problems::default() };
    walker.check(schema, document, &Path::Root);
    walker.problems
}

/// Magnitudes of non-zero numbers that can be computed with: products of three are finite and not zero.
const MAGNITUDES: [f64; 2] = [1e-100, 1e100];

fn is_reckonable(number: f64) -> bool {
    number == 0.0 || (MAGNITUDES[0]..=MAGNITUDES[1]).contains(&number.abs())
}

/// A schema as it is compared with values, together with those that it refers to.
pub(super) struct Schema<'a> {
    kind: Kind<'a>,
    /// True if there may be no value.
    nullable: bool,
    /// The kinds of systems in which it has a meaning, if not in all.
    only: Option<Only<'a>>,
}

/// A restriction to kinds of systems.
struct Only<'a> {
    kinds: Vec<&'a str>,
    /// What is accepted in place of it, by the kind of the system.
    instead: &'a Value,
    /// The value of a key that is left out.
    default: &'a Value,
}

enum Kind<'a> {
    Any,
    Boolean,
    Number(Range),
    /// A text of so many letters at least.
    Text(u64),
    List(List<'a>),
    Object(Object<'a>),
    Choices(Vec<(&'a str, Schema<'a>)>),
    /// Several kinds of object, distinguished by the text of `type`.
    Tagged(Vec<(&'a str, Schema<'a>)>),
    Alternatives(Vec<Schema<'a>>),
}

struct List<'a> {
    least: Option<u64>,
    most: Option<u64>,
    items: Box<Schema<'a>>,
}

struct Object<'a> {
    known: Vec<(&'a str, Schema<'a>)>,
    is_closed: bool,
    required: Vec<&'a str>,
    /// Keys that are required where those of a condition are not there.
    otherwise: Vec<&'a str>,
    condition: Vec<&'a str>,
}

impl<'a> Schema<'a> {
    /// Reads a part of a schema, in which no type contains itself.
    pub(super) fn read(root: &'a Value, schema: &'a Value) -> Self {
        let only = schema["x-of"].is_array().then(|| Only {
            kinds: texts(&schema["x-of"]),
            instead: &schema["x-instead"],
            default: &schema["default"],
        });
        Self { only, ..Self::read_all(root, schema) }
    }

    /// Reads a schema, whatever the kind of the system.
    fn read_all(root: &'a Value, schema: &'a Value) -> Self {
        let read = |schema: &'a Value| Self::read(root, schema);
        if let Some(reference) = schema["$ref"].as_str() {
            return read(root.pointer(reference.strip_prefix('#').unwrap_or(reference)).unwrap_or(&Value::Null));
        }
        let types = texts(&schema["type"]);
        let nullable = types.contains(&"null");
        let properties = schema["properties"].as_object().into_iter().flatten();
        let kind = match types.into_iter().find(|kind| *kind != "null") {
            Some("boolean") => Kind::Boolean,
            Some("number" | "integer") => Kind::Number(Range::of(schema)),
            Some("string") => Kind::Text(schema["minLength"].as_u64().unwrap_or(0)),
            Some("array") => Kind::List(List {
                least: schema["minItems"].as_u64(),
                most: schema["maxItems"].as_u64(),
                items: Box::new(read(&schema["items"])),
            }),
            Some("object") => Kind::Object(Object {
                known: properties.map(|(key, schema)| (key.as_str(), read(schema))).collect(),
                is_closed: schema["additionalProperties"] == false,
                required: texts(&schema["required"]),
                otherwise: texts(&schema["else"]["required"]),
                condition: texts(&schema["if"]["required"]),
            }),
            _ => return Self::one_of(root, schema),
        };
        Self { kind, nullable, only: None }
    }

    /// Reads a schema of alternatives.
    fn one_of(root: &'a Value, schema: &'a Value) -> Self {
        let Some(all) = schema["oneOf"].as_array().or_else(|| schema["anyOf"].as_array()) else {
            return Self { kind: Kind::Any, nullable: false, only: None };
        };
        let tag = |branch: &'a Value| branch["properties"]["type"]["const"].as_str();
        let read = |branch: &'a Value| Self::read(root, branch);
        let mut others: Vec<Self> = all.iter().filter(|branch| branch["type"] != "null").map(read).collect();
        let nullable = others.len() < all.len();
        let constants: Option<Vec<&str>> = all.iter().map(|choice| choice["const"].as_str()).collect();
        let kind = if let Some(choices) = constants {
            Kind::Choices(choices.into_iter().zip(others).collect())
        } else if let Some(tags) = all.iter().map(tag).collect::<Option<Vec<_>>>() {
            Kind::Tagged(tags.into_iter().zip(others).collect())
        } else if others.len() == 1 {
            others.remove(0).kind
        } else {
            Kind::Alternatives(others)
        };
        Self { kind, nullable, only: None }
    }

    /// True if it has a meaning in a kind of systems, as far as that is known.
    fn is_of(&self, system: Option<SystemKind>) -> bool {
        let Some((only, system)) = self.only.as_ref().zip(system) else { return true };
        only.kinds.contains(&system.name())
    }

    /// A phrase for what it accepts in a kind of systems.
    fn accepted(&self, system: Option<SystemKind>) -> String {
        match &self.kind {
            Kind::Any => "any value".to_owned(),
            Kind::Boolean => "true or false".to_owned(),
            Kind::Number(range) => range.describe(),
            Kind::Text(0) => "text".to_owned(),
            Kind::Text(_) => "text that is not empty".to_owned(),
            Kind::List(List { least, most, items }) => {
                let length = match (least, most) {
                    (Some(least), Some(most)) if least == most => format!(" of {least} entries"),
                    (Some(least), Some(most)) => format!(" of {least} to {most} entries"),
                    (Some(least), None) => format!(" of at least {least} entries"),
                    (None, Some(most)) => format!(" of at most {most} entries"),
                    (None, None) => String::new(),
                };
                format!("a list{length}, each {}", items.accepted(system))
            }
            Kind::Object(object) => format!("an object with {}", quoted(object.names(system), '`')),
            Kind::Choices(choices) => quoted(names(choices, system), '"'),
            Kind::Tagged(kinds) => format!("an object whose `type` is {}", quoted(names(kinds, system), '"')),
            Kind::Alternatives(all) => all.iter().map(|one| one.accepted(system)).collect::<Vec<_>>().join(", or "),
        }
    }
}

impl Only<'_> {
    /// True if a value is what leaving it out would be.
    fn is_left_out(&self, value: &Value) -> bool {
        let is_empty = match value {
            Value::Null | Value::Bool(false) => true,
            Value::Array(list) => list.is_empty(),
            Value::Object(object) => object.is_empty(),
            _ => false,
        };
        is_empty || value == self.default
    }

    /// What is accepted in place of a key in a system of another kind.
    fn accepted(&self, system: SystemKind) -> String {
        if let Some(instead) = self.instead[system.name()].as_str() {
            return instead.to_owned();
        }
        let kinds = SystemKind::ALL.into_iter().filter(|kind| self.kinds.contains(&kind.name()));
        let scenes: Vec<String> = kinds.map(|kind| format!("a scene of {}", kind.in_words())).collect();
        format!("{} only", scenes.join(" or "))
    }
}

impl List<'_> {
    /// Gives a list of a wrong length a right one, if there are entries for it.
    fn resize(&self, list: &mut Vec<Value>, substitute: Substitute) -> bool {
        let least = self.least.unwrap_or(0) as usize;
        let length = match substitute {
            Substitute::Least => least,
            Substitute::Most => self.most.map_or(list.len(), |most| most as usize).max(least),
        };
        if list.len() > length {
            list.truncate(length);
        } else if let Kind::Number(range) = &self.items.kind {
            list.resize(length.min(least.max(8)), range.substitute(substitute));
        }
        list.len() >= least
    }
}

impl<'a> Object<'a> {
    fn schema(&self, key: &str) -> Option<&Schema<'a>> {
        self.known.iter().find(|(name, _)| *name == key).map(|(_, schema)| schema)
    }

    /// Keys as messages name them, in a kind of systems.
    fn names(&self, system: Option<SystemKind>) -> impl Iterator<Item = &'a str> {
        names(&self.known, system).filter(|name| *name != "$schema")
    }

    /// Keys that an object has to have.
    fn required(&self, object: &Map<String, Value>) -> Vec<&'a str> {
        let is_there = |key: &&str| object.get(*key).is_some_and(|value| !value.is_null());
        let otherwise = self.otherwise.iter().filter(|_| !self.condition.iter().all(is_there));
        self.required.iter().chain(otherwise).copied().collect()
    }
}

struct Walker {
    system: Option<SystemKind>,
    substitute: Substitute,
    problems: Problems,
}

impl Walker {
    /// True if the value can be read, right or wrong.
    fn check(&mut self, schema: &Schema<'_>, value: &mut Value, path: &Path<'_>) -> bool {
        match (&schema.kind, &mut *value) {
            (_, Value::Null) if schema.nullable => true,
            (Kind::Choices(choices), _) => self.check_choice(schema, choices, value, path),
            (Kind::Tagged(kinds), _) => self.check_tagged(schema, kinds, value, path),
            (Kind::Alternatives(all), _) => self.check_alternatives(schema, all, value, path),
            (Kind::Any, _) | (Kind::Boolean, Value::Bool(_)) => true,
            (Kind::Number(range), Value::Number(_)) => self.check_number(schema, range, value, path),
            (Kind::Text(least), Value::String(text)) => {
                if (text.chars().count() as u64) < *least {
                    self.report(schema, path, format!("found \"{text}\""), None);
                }
                true
            }
            (Kind::List(kind), Value::Array(list)) => self.check_list(schema, kind, list, path),
            (Kind::Object(kind), Value::Object(object)) => self.check_object(kind, object, path),
            _ => {
                self.refuse(schema, value, path);
                false
            }
        }
    }

    /// Reports that the value at `path` is not accepted by `schema`.
    fn refuse(&mut self, schema: &Schema<'_>, value: &Value, path: &Path<'_>) {
        self.report(schema, path, found(value), None);
    }

    /// Reports what is not accepted by `schema`, and what may have been meant.
    fn report(&mut self, schema: &Schema<'_>, path: &Path<'_>, phrase: String, suggestion: Option<String>) {
        let accepted = if self.problems.is_full() { String::new() } else { schema.accepted(self.system) };
        self.problems.push(Problem::new(path, phrase, accepted).suggest(suggestion));
    }

    /// One of several texts.
    fn check_choice(
        &mut self,
        schema: &Schema<'_>,
        choices: &[(&str, Schema<'_>)],
        value: &Value,
        path: &Path<'_>,
    ) -> bool {
        let text = value.as_str().unwrap_or_default();
        match choices.iter().find(|(choice, _)| *choice == text) {
            Some((_, chosen)) if chosen.is_of(self.system) => return true,
            Some((_, chosen)) => self.refuse_choice(chosen, text, path, schema.accepted(self.system)),
            None => {
                self.report(schema, path, found(value), nearest(text, names(choices, self.system)));
            }
        }
        false
    }

    /// Refuses a choice of another kind of systems.
    fn refuse_choice(&mut self, chosen: &Schema<'_>, text: &str, path: &Path<'_>, accepted: String) {
        if let Some((only, system)) = chosen.only.as_ref().zip(self.system) {
            let accepted = only.instead[system.name()].as_str().map_or(accepted, ToOwned::to_owned);
            self.problems.refuse(path, format!("\"{text}\" in a scene of {}", system.in_words()), accepted);
        }
    }

    fn check_alternatives(
        &mut self,
        schema: &Schema<'_>,
        all: &[Schema<'_>],
        value: &mut Value,
        path: &Path<'_>,
    ) -> bool {
        // Whatever the value comes nearest to being is what its author meant; a value that is none of them as a whole may be any.
        let mut fewest: Option<(Problems, Value, bool)> = None;
        let (found, own) = (found(value), path.to_string());
        let mut is_foreign = true;
        for branch in all {
            let mut attempt = Self { problems: Problems::default(), ..*self };
            let mut mended = value.clone();
            let readable = attempt.check(branch, &mut mended, path);
            is_foreign &= attempt.problems.iter().any(|problem| problem.path == own);
            if fewest.as_ref().is_none_or(|(problems, ..)| attempt.problems.count() < problems.count()) {
                fewest = Some((attempt.problems, mended, readable));
            }
        }
        fewest.is_some_and(|(problems, mended, readable)| {
            *value = mended;
            if is_foreign {
                self.report(schema, path, found, None);
            } else {
                self.problems.append(problems);
            }
            readable
        })
    }

    /// One of several kinds of object, distinguished by the text of `type`.
    fn check_tagged(
        &mut self,
        schema: &Schema<'_>,
        kinds: &[(&str, Schema<'_>)],
        value: &mut Value,
        path: &Path<'_>,
    ) -> bool {
        let Value::Object(object) = value else {
            let meant = value.as_str().and_then(|text| nearest(text, names(kinds, self.system)));
            self.report(schema, path, found(value), meant.map(|tag| format!("{{\"type\": \"{tag}\"}}")));
            return false;
        };
        let (place, accepted) = (path.key("type"), quoted(names(kinds, self.system), '`'));
        match object.get("type") {
            None => {
                // A misspelt `type` is both an unknown key and a missing one.
                let suggestion = object.keys().find(|key| nearest(key, ["type"]).is_some());
                let found = suggestion.map_or("missing".to_owned(), |key| format!("missing (found `{key}`)"));
                self.problems.add(place, found, accepted);
            }
            Some(Value::String(text)) => {
                let of_this_name = || kinds.iter().filter(|(tag, _)| tag == text).map(|(_, chosen)| chosen);
                if let Some(chosen) = of_this_name().find(|chosen| chosen.is_of(self.system)) {
                    return self.check(chosen, value, path);
                }
                if let Some(foreign) = of_this_name().next() {
                    self.refuse_choice(foreign, text, &place, accepted);
                    return false;
                }
                let problem = Problem::new(place, format!("found \"{text}\""), accepted);
                self.problems.push(problem.suggest(nearest(text, names(kinds, self.system))));
            }
            Some(other) => self.problems.add(place, found(other), accepted),
        }
        false
    }

    fn check_number(&mut self, schema: &Schema<'_>, range: &Range, value: &mut Value, path: &Path<'_>) -> bool {
        let number = value.as_f64().unwrap_or(f64::NAN);
        if range.integer && value.is_f64() {
            let Some(whole) = whole(number) else {
                self.refuse(schema, value, path);
                return false;
            };
            *value = whole;
        }
        // Within a whole number's format, u64 and f64 compare exactly enough: every bound is far below 2^53 or at 2^64.
        if !range.contains(number) {
            self.refuse(schema, value, path);
            *value = range.substitute(self.substitute);
        } else if !range.integer && !is_reckonable(number) {
            let [least, most] = MAGNITUDES;
            let accepted = format!(
                "a number nearer to the others of the scene, of a magnitude from {least:e} to {most:e}: choose other units"
            );
            self.problems.refuse(path, format!("{number:e}"), accepted);
            *value = range.substitute(self.substitute);
        }
        true
    }

    fn check_list(&mut self, schema: &Schema<'_>, kind: &List<'_>, list: &mut Vec<Value>, path: &Path<'_>) -> bool {
        let mut readable = true;
        let length = list.len() as u64;
        if kind.least.is_some_and(|least| length < least) || kind.most.is_some_and(|most| length > most) {
            let entries = if length == 1 { "entry" } else { "entries" };
            self.report(schema, path, format!("found a list of {length} {entries}"), None);
            readable = kind.least != kind.most && kind.resize(list, self.substitute);
        }
        for (index, entry) in list.iter_mut().enumerate() {
            readable &= self.check(&kind.items, entry, &path.index(index));
        }
        readable
    }

    fn check_object(&mut self, kind: &Object<'_>, object: &mut Map<String, Value>, path: &Path<'_>) -> bool {
        let required = kind.required(object);
        let mut missing: Vec<&str> = required.iter().copied().filter(|key| !object.contains_key(*key)).collect();
        let mut readable = missing.is_empty();

        let mut taken_out = Vec::new();
        for (key, value) in object.iter_mut() {
            let schema = kind.schema(key);
            let only = schema.filter(|known| !known.is_of(self.system)).and_then(|known| known.only.as_ref());
            let refused = only.zip(self.system).filter(|(only, _)| !only.is_left_out(value));
            if let Some((only, system)) = refused {
                let found = format!("in a scene of {}", system.in_words());
                self.problems.refuse(path.key(key), found, only.accepted(system));
            }
            // What is refused as a whole is refused once, and read so that nothing else seems to be missing.
            let system = self.system;
            self.system = system.filter(|_| refused.is_none());
            let is_readable = schema.is_some_and(|schema| self.check(schema, value, &path.key(key)));
            self.system = system;
            match schema {
                Some(_) if is_readable => {}
                // Without a list of interactions or pairs a scene would be another one.
                Some(_) if value.is_array() => readable = false,
                Some(_) => {
                    readable &= !required.contains(&key.as_str());
                    taken_out.push(key.clone());
                }
                None if kind.is_closed && self.problems.is_full() => {
                    self.problems.add("", "", "");
                    taken_out.push(key.clone());
                }
                None if kind.is_closed => {
                    // What is not there yet is likelier to be meant than what is; a missing key most of all.
                    let suggestion =
                        nearest(key, missing.iter().copied()).or_else(|| nearest(key, names(&kind.known, self.system)));
                    // A misspelt required key is one mistake, not two.
                    missing.retain(|key| suggestion.as_deref() != Some(*key));
                    let accepted = kind.names(self.system).collect::<Vec<_>>().join(", ");
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
            let accepted = kind.schema(key).map_or_else(|| "any value".to_owned(), |known| known.accepted(self.system));
            self.problems.add(path.key(key), "missing", accepted);
        }
        readable
    }
}

/// The texts of a list, or one alone.
fn texts(value: &Value) -> Vec<&str> {
    value.as_array().map_or(std::slice::from_ref(value), Vec::as_slice).iter().filter_map(Value::as_str).collect()
}

fn names<'a>(schemas: &[(&'a str, Schema<'_>)], system: Option<SystemKind>) -> impl Iterator<Item = &'a str> {
    schemas.iter().filter(move |(_, schema)| schema.is_of(system)).map(|(name, _)| *name)
}

/// Names in a row, each between quotes.
fn quoted<'a>(names: impl Iterator<Item = &'a str>, quote: char) -> String {
    names.map(|name| format!("{quote}{name}{quote}")).collect::<Vec<_>>().join(", ")
}

/// A number as an integer, if it is one.
fn whole(number: f64) -> Option<Value> {
    match number {
        _ if number.fract() != 0.0 => None,
        0.0..18_446_744_073_709_551_616.0 => Some((number as u64).into()),
        -9_223_372_036_854_775_808.0..0.0 => Some((number as i64).into()),
        _ => None,
    }
}

/// The numbers a schema accepts.
struct Range {
    integer: bool,
    least: Option<f64>,
    above: Option<f64>,
    most: Option<f64>,
    below: Option<f64>,
}

impl Range {
    fn of(schema: &Value) -> Self {
        let (least, most) = match schema["format"].as_str() {
            Some("uint32") => (Some(0.0), Some(f64::from(u32::MAX))),
            Some("uint64") => (Some(0.0), None),
            _ => (None, None),
        };
        Self {
            integer: texts(&schema["type"]).contains(&"integer"),
            least: schema["minimum"].as_f64().or(least),
            above: schema["exclusiveMinimum"].as_f64(),
            most: schema["maximum"].as_f64().or(most),
            below: schema["exclusiveMaximum"].as_f64(),
        }
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

#[cfg(test)]
mod tests {
    use serde_json::json;

    use super::*;

    /// Every keyword in the published schema, by the place where keywords stand.
    fn keywords(schema: &Value, into: &mut Vec<String>) {
        let Some(object) = schema.as_object() else { return };
        let may_stand_beside =
            |key: &String| ["$ref", "default", "description", "x-instead", "x-of"].contains(&key.as_str());
        assert!(!object.contains_key("$ref") || object.keys().all(may_stand_beside), "beside a reference: {object:?}");
        for (key, value) in object {
            into.push(key.clone());
            match key.as_str() {
                "properties" | "$defs" => {
                    value.as_object().into_iter().flatten().for_each(|(_, schema)| keywords(schema, into));
                }
                "oneOf" | "anyOf" => {
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
            // The steps of a run without stages are checked where those of stages are summed up.
            "allOf",
            "anyOf",
            "const",
            "default",
            "description",
            // Of `if` and `else` the required keys are read; numbers of particles are checked, in better words, with their meaning.
            "else",
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
            "properties",
            "required",
            "then",
            "title",
            "type",
            "x-instead",
            "x-of",
        ];
        let mut found = Vec::new();
        keywords(&crate::scene::schema(), &mut found);
        assert!(found.len() > 300, "the walk over the schema stopped early: {}", found.len());
        found.retain(|keyword| !read.contains(&keyword.as_str()));
        assert!(found.is_empty(), "not read: {found:?}");
    }

    fn messages(schema: &Value, mut value: Value) -> Vec<String> {
        check(&Schema::read(schema, schema), &mut value, None, Substitute::Least)
            .iter()
            .map(ToString::to_string)
            .collect()
    }

    #[test]
    fn references_lead_to_objects() {
        let schema = json!({
            "$ref": "#/$defs/Inner",
            "$defs": {"Inner": {"type": "object", "properties": {"type": {"const": "x", "type": "string"},
                "size": {"type": "integer", "maximum": 3}}, "required": ["size"], "additionalProperties": false}},
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
    fn lists_enumerations_and_absent_values() {
        let schema = json!({"type": "object", "properties": {
            "pair": {"type": "array", "items": {"type": "number"}, "minItems": 2},
            "mode": {"oneOf": [{"type": "string", "const": "fast"}, {"type": "string", "const": "exact"}]},
            "maybe": {"anyOf": [{"type": "object", "properties": {"n": {"type": "integer"}}}, {"type": "null"}]},
        }});
        assert!(messages(&schema, json!({"pair": [2, 1], "mode": "fast", "maybe": null})).is_empty());
        assert_eq!(
            messages(&schema, json!({"pair": [1, "b"], "mode": "exat", "maybe": {"n": 1.5}})),
            [
                "pair[1]: found the text \"b\"; accepted: a number",
                "mode: found the text \"exat\"; did you mean `exact`? accepted: \"fast\", \"exact\"",
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
        assert!(check(&Schema::read(&schema, &schema), &mut value, None, Substitute::Least).is_empty());
        assert_eq!(value, json!(1_000_000_000_000_u64));
        assert_eq!(messages(&schema, json!(1e30)).len(), 1);
        assert_eq!(messages(&schema, json!(-1.0)).len(), 1);
        assert_eq!(messages(&schema, json!(0.5)).len(), 1);
        assert_eq!(messages(&json!({"type": "integer", "format": "uint32"}), json!(4_294_967_296_u64)).len(), 1);
    }
}
