//! A place in a JSON document, formatted only for messages.

use std::borrow::Cow;
use std::fmt;

/// A place in a JSON document, as a chain towards the root.
#[derive(Clone, Copy)]
pub(crate) enum Path<'a> {
    Root,
    Key { parent: &'a Path<'a>, key: &'a str },
    Index { parent: &'a Path<'a>, index: usize },
}

impl<'a> Path<'a> {
    pub(crate) fn key(&'a self, key: &'a str) -> Path<'a> {
        Path::Key { parent: self, key }
    }

    pub(crate) fn index(&'a self, index: usize) -> Path<'a> {
        Path::Index { parent: self, index }
    }
}

/// The name of the document itself in a message.
pub(super) const TOP_LEVEL: &str = "top level";

impl fmt::Display for Path<'_> {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Path::Root => formatter.write_str(TOP_LEVEL),
            Path::Key { parent: Path::Root, key } => formatter.write_str(&shortened(key)),
            Path::Key { parent, key } => write!(formatter, "{parent}.{}", shortened(key)),
            Path::Index { parent: Path::Root, index } => write!(formatter, "[{index}]"),
            Path::Index { parent, index } => write!(formatter, "{parent}[{index}]"),
        }
    }
}

/// Characters of a key that are shown; no key of a scene is as long.
const LONGEST_KEY: usize = 60;

fn shortened(key: &str) -> Cow<'_, str> {
    match key.char_indices().nth(LONGEST_KEY) {
        Some((end, _)) => format!("{}…", &key[..end]).into(),
        None => key.into(),
    }
}

/// Whether one of two places contains the other.
pub(crate) fn related(a: &str, b: &str) -> bool {
    let (outer, inner) = if a.len() <= b.len() { (a, b) } else { (b, a) };
    outer == TOP_LEVEL || inner.strip_prefix(outer).is_some_and(|rest| rest.is_empty() || rest.starts_with(['.', '[']))
}
