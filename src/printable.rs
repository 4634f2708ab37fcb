//! Text from scenes, command lines and file names, made safe for a terminal.
//!
//! A title may hold anything that JSON can express: escape sequences that clear a screen or set its title, carriage
//! returns and line breaks that forge messages, marks that turn the direction of writing. They are shown as escapes
//! instead, as Rust writes them: `\u{1b}[2J`.

use std::borrow::Cow;
use std::path::Path;

/// Whether a character does something on a terminal rather than stand there: control characters, line and paragraph
/// separators, and marks that change the direction of what follows.
fn acts(character: char) -> bool {
    character.is_control()
        || matches!(character, '\u{61c}' | '\u{200e}' | '\u{200f}' | '\u{2028}'..='\u{202e}' | '\u{2066}'..='\u{2069}')
}

fn escaped(text: &str, is_kept: impl Fn(char) -> bool) -> Cow<'_, str> {
    let is_bad = |character: char| acts(character) && !is_kept(character);
    if !text.contains(is_bad) {
        return Cow::Borrowed(text);
    }
    let mut safe = String::with_capacity(text.len() + 8);
    for character in text.chars() {
        if is_bad(character) {
            safe.extend(character.escape_default());
        } else {
            safe.push(character);
        }
    }
    Cow::Owned(safe)
}

/// A name or title within a line: line breaks and tabs are shown as escapes too.
///
/// ```
/// use mesoscope::printable;
///
/// assert_eq!(printable::name("Wasser, 25 °C"), "Wasser, 25 °C");
/// assert_eq!(printable::name("a\u{1b}[31m\nerror: none\u{202e}"), r"a\u{1b}[31m\nerror: none\u{202e}");
/// ```
#[must_use]
pub fn name(text: &str) -> Cow<'_, str> {
    escaped(text, |_| false)
}

/// The name of a file or directory, as [`name`] shows it.
///
/// ```
/// use std::path::Path;
/// assert_eq!(mesoscope::printable::path(Path::new("runs/a\nb")), r"runs/a\nb");
/// ```
#[must_use]
pub fn path(path: &Path) -> String {
    name(&path.to_string_lossy()).into_owned()
}

/// A whole message: its line breaks are its own.
///
/// ```
/// assert_eq!(mesoscope::printable::message("two\nlines\r\u{9b}2J"), "two\nlines\\r\\u{9b}2J");
/// ```
#[must_use]
pub fn message(text: &str) -> Cow<'_, str> {
    escaped(text, |character| character == '\n')
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn nothing_that_acts_on_a_terminal_is_left() {
        for code in 0..=0x2_ffff_u32 {
            let Some(character) = char::from_u32(code) else { continue };
            let text = format!("a{character}b");
            let safe = name(&text);
            assert!(!safe.contains(acts), "{code:x}");
            assert_eq!(safe == text, !acts(character), "{code:x}");
            assert_eq!(message(&text).contains('\n'), character == '\n', "{code:x}");
        }
        // Scripts that are written from right to left, accents and emoji are text like any other.
        for text in ["שלום", "e\u{301}", "👩\u{200d}🔬", "∇·v"] {
            assert_eq!(name(text), text);
        }
    }
}
