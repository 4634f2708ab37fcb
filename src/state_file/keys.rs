//! Keys and values of the second line of a frame of extended XYZ, by its specification, <https://github.com/libAtoms/extxyz>.
//!
//! Keys and values are bare or in double quotes, in which a backslash takes the next character as it is; values may also be lists in
//! brackets or braces, nested or not. ASE reads single quotes too, and takes a key alone for one that is true. Where the two differ in
//! what they read, the line is refused, for one of them would read another box.

use super::{Mistake, shortened};

/// Keys that say what a frame is: nothing may hide them.
const MEANT: [&str; 4] = ["Lattice", "Properties", "pbc", "Origin"];

/// Keys and values of a line.
#[derive(Debug, Default, PartialEq)]
pub(super) struct Keys(Vec<(String, String)>);

impl Keys {
    /// Those of a line. A line that has none by these rules is a comment, unless it names a key that says what the frame is.
    pub(super) fn of(line: &str, place: &str) -> Result<Self, Mistake> {
        match (Cursor { rest: line }).keys() {
            Ok(keys) => Ok(Self(keys)),
            Err(_) if !MEANT.iter().any(|name| names(line, name)) => Ok(Self::default()),
            Err(found) => Err(Mistake::new(
                place,
                found,
                "keys and values as `key=value`, in which a value with blanks, quotes or brackets stands in double quotes, with a \
                 backslash before those that are in it",
            )),
        }
    }

    /// The value of a key: of one that is written so, else in other letters, large or small.
    pub(super) fn value(&self, name: &str, place: &str) -> Result<Option<&str>, Mistake> {
        let exact = self.0.iter().any(|(key, _)| key == name);
        let is_meant = |key: &str| if exact { key == name } else { key.eq_ignore_ascii_case(name) };
        let mut values = self.0.iter().filter(|(key, _)| is_meant(key)).map(|(_, value)| value.as_str());
        let Some(first) = values.next() else { return Ok(None) };
        let Some(other) = values.find(|value| *value != first) else { return Ok(Some(first)) };
        let found = format!("found {name} twice, as \"{}\" and as \"{}\"", shortened(first), shortened(other));
        Err(Mistake::new(place, found, "every key once"))
    }
}

/// Whether a text may give a key a value.
fn names(text: &str, name: &str) -> bool {
    let (text, name) = (text.to_ascii_lowercase(), name.to_ascii_lowercase());
    text.match_indices(&name)
        .any(|(at, _)| text[at + name.len()..].trim_start_matches(['"', ' ', '\t']).starts_with('='))
}

/// What is left of a line.
struct Cursor<'a> {
    rest: &'a str,
}

/// A key or a value, and how it was written.
struct Item {
    text: String,
    is_bare: bool,
}

impl Cursor<'_> {
    fn keys(mut self) -> Result<Vec<(String, String)>, String> {
        let mut found = Vec::new();
        self.skip_blanks();
        while !self.rest.is_empty() {
            let key = self.item(true)?;
            self.skip_blanks();
            if !self.rest.starts_with('=') {
                found.push((key.text, "T".to_owned()));
                continue;
            }
            self.rest = &self.rest[1..];
            if self.rest.starts_with(char::is_whitespace) || self.rest.is_empty() {
                self.skip_blanks();
                let mut ahead = Cursor { rest: self.rest };
                let is_key = ahead.item(true).is_ok() && ahead.rest.trim_start().starts_with('=');
                // ASE writes an empty text as nothing, after which the next key follows.
                if self.rest.is_empty() || is_key {
                    found.push((key.text, String::new()));
                    continue;
                }
            }
            let value = self.item(false)?;
            self.skip_blanks();
            let hidden = |name: &&&str| value.is_bare && names(&value.text, name);
            if let Some(name) = MEANT.iter().find(hidden) {
                return Err(format!("found {name} within the value {}={}", key.text, shortened(&value.text)));
            }
            found.push((key.text, value.text));
        }
        Ok(found)
    }

    fn skip_blanks(&mut self) {
        self.rest = self.rest.trim_start();
    }

    /// Takes the next key or value.
    fn item(&mut self, is_key: bool) -> Result<Item, String> {
        let start = self.rest;
        let inside = |length: usize| (start[1..length - 1].to_owned(), length);
        let (found, is_bare) = match start.chars().next().unwrap_or_default() {
            '"' => (quoted(start), false),
            // Braces hold a text, brackets a list: those around all of it are no part of either.
            '[' | '{' => (group(start).map(inside), false),
            '\'' if !is_key && single_quoted(start).is_some() => (single_quoted(start).map(inside), true),
            _ => (bare(start, is_key), true),
        };
        let open = || format!("found quotes or brackets that do not close, in {}", shortened(start));
        let (text, length) = found.ok_or_else(open)?;
        self.rest = &start[length..];
        let ends =
            self.rest.is_empty() || self.rest.starts_with(char::is_whitespace) || is_key && self.rest.starts_with('=');
        if ends {
            Ok(Item { text, is_bare })
        } else {
            Err(format!("found no blank after {}", shortened(&start[..length])))
        }
    }
}

/// A text in double quotes at the beginning of another, and the bytes that it takes.
fn quoted(text: &str) -> Option<(String, usize)> {
    let mut found = String::new();
    let mut letters = text.char_indices().skip(1);
    while let Some((at, letter)) = letters.next() {
        match letter {
            '"' => return Some((found, at + 1)),
            '\\' => match letters.next()?.1 {
                'n' => found.push('\n'),
                other => found.push(other),
            },
            _ => found.push(letter),
        }
    }
    None
}

/// Bytes of a text in single quotes at the beginning of another, which ends before a blank; an apostrophe alone is a letter.
fn single_quoted(text: &str) -> Option<usize> {
    let ends = |at: &usize| text[at + 1..].chars().next().is_none_or(char::is_whitespace);
    text.match_indices('\'').skip(1).map(|(at, _)| at).find(ends).map(|at| at + 1)
}

/// Bytes of a group in brackets or braces at the beginning of a text, with all that is nested in it.
fn group(text: &str) -> Option<usize> {
    let mut closing = Vec::new();
    let mut at = 0;
    while let Some(letter) = text[at..].chars().next() {
        match letter {
            '"' => at += quoted(&text[at..])?.1 - 1,
            '[' => closing.push(']'),
            '{' => closing.push('}'),
            ']' | '}' if closing.pop() != Some(letter) => return None,
            '\\' => at += text[at + 1..].chars().next()?.len_utf8(),
            _ => {}
        }
        at += letter.len_utf8();
        if closing.is_empty() {
            return Some(at);
        }
    }
    None
}

/// A key or value without quotes at the beginning of a text, and the bytes that it takes. Quotes and brackets in it, which the specification has
/// not and ASE takes away, close before it ends.
fn bare(text: &str, is_key: bool) -> Option<(String, usize)> {
    let mut found = String::new();
    let (mut closing, mut is_quoted) = (Vec::new(), false);
    let mut letters = text.char_indices();
    let mut end = text.len();
    while let Some((at, letter)) = letters.next() {
        match letter {
            '\\' => {
                found.extend(letters.next().map(|(_, next)| next));
                continue;
            }
            '=' if is_key => end = at,
            _ if letter.is_whitespace() => end = at,
            '"' => is_quoted = !is_quoted,
            '[' if !is_quoted => closing.push(']'),
            '{' if !is_quoted => closing.push('}'),
            ']' | '}' if !is_quoted && closing.pop() != Some(letter) => return None,
            _ => {}
        }
        if end < text.len() {
            break;
        }
        found.push(letter);
    }
    (closing.is_empty() && !is_quoted).then_some((found, end))
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    #[track_caller]
    fn are(line: &str, expected: &[(&str, &str)]) {
        let keys = Keys::of(line, "line 2").unwrap();
        let found: Vec<(&str, &str)> = keys.0.iter().map(|(key, value)| (key.as_str(), value.as_str())).collect();
        assert_eq!(found, expected, "{line}");
    }

    #[test]
    fn values_are_bare_quoted_or_lists() {
        are(
            r#"Lattice="1 0 0" a='x y' b={1 2} plain=3 alone Properties=species:S:1 url=http://a?b=c end="#,
            &[
                ("Lattice", "1 0 0"),
                ("a", "x y"),
                ("b", "1 2"),
                ("plain", "3"),
                ("alone", "T"),
                ("Properties", "species:S:1"),
                ("url", "http://a?b=c"),
                ("end", ""),
            ],
        );
        are(
            "pbc=[T, T, F]\tcell = [[8, 0], [0, 8]] it=it's tis='tis x=y",
            &[("pbc", "T, T, F"), ("cell", "[8, 0], [0, 8]"), ("it", "it's"), ("tis", "'tis"), ("x", "y")],
        );
        are(r#"empty= next="" a = 1"#, &[("empty", ""), ("next", ""), ("a", "1")]);
        are("", &[]);
    }

    /// What stands within a value is no key.
    #[test]
    fn quotes_hide_what_is_in_them() {
        are(r#"a="b \" Lattice='3' \\" pbc="F F F""#, &[("a", r#"b " Lattice='3' \"#), ("pbc", "F F F")]);
        are(r#""my key"=1 "x \"y\""="pbc=T""#, &[("my key", "1"), (r#"x "y""#, "pbc=T")]);
        are(
            r#"meta={"cell": {"a": "}"}, "b": [1,2]} pbc=T,T,T"#,
            &[("meta", r#""cell": {"a": "}"}, "b": [1,2]"#), ("pbc", "T,T,T")],
        );
        are(r#"list=["a, b]", "pbc=T"] n="one\ntwo""#, &[("list", r#""a, b]", "pbc=T""#), ("n", "one\ntwo")]);
    }

    /// A line that readers do not agree on is refused where a key that counts is in it, and is a comment where none is.
    #[test]
    fn what_does_not_close() {
        for open in [r#"a="b"#, r#"a="b"c"#, "a=[1, 2", "a={1]", "x]", r#"a=5" b"#, r#"a=b"c d""#, r#"a="b\""#] {
            are(open, &[]);
            let found = Keys::of(&format!("pbc=T,T,T {open}"), "line 2").unwrap_err();
            assert_eq!(found.place, "line 2");
            assert!(
                found.found.starts_with("found quotes or") || found.found.starts_with("found no blank"),
                "{found:?}"
            );
        }
        for hidden in [r#"a='b pbc="F F F" c'"#, "a=b\\ Lattice=3", "a=x_pbc=F"] {
            let found = Keys::of(hidden, "line 2").unwrap_err().found;
            assert!(found.contains("within the value a="), "{found}");
        }
    }

    #[test]
    fn every_key_once() {
        let keys = Keys::of("lattice=fcc Lattice=1 PBC=T a=1 a=2 A=3 b=1 b=1", "line 2").unwrap();
        assert_eq!(keys.value("Lattice", ""), Ok(Some("1")));
        assert_eq!(keys.value("pbc", ""), Ok(Some("T")));
        assert_eq!(keys.value("b", ""), Ok(Some("1")));
        assert_eq!(keys.value("none", ""), Ok(None));
        assert_eq!(keys.value("a", "line 2").unwrap_err().found, "found a twice, as \"1\" and as \"2\"");
    }
}
