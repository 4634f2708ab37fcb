//! Tables of numbers and words, as comma-separated text and in Markdown.

use super::variation::Setting;
use crate::numbers::push_exact;
use crate::output::quoted;
use serde_json::Value;

/// A line of cells.
pub(crate) fn line(cells: &[String]) -> String {
    let cells: Vec<_> = cells.iter().map(|cell| quoted(cell)).collect();
    format!("{}\n", cells.join(","))
}

/// Rows of names and cells, under the names of the first.
pub(crate) fn rows(rows: impl IntoIterator<Item = Vec<(String, String)>>) -> String {
    let mut text = String::new();
    for row in rows {
        let (names, cells): (Vec<String>, Vec<String>) = row.into_iter().unzip();
        if text.is_empty() {
            text = line(&names);
        }
        text.push_str(&line(&cells));
    }
    text
}

/// A number; nothing where there is none or it is not finite.
pub(crate) fn number(value: Option<f64>) -> String {
    let mut digits = Vec::new();
    push_exact(&mut digits, value.unwrap_or(f64::NAN));
    // Digits are ASCII.
    String::from_utf8(digits).unwrap_or_default()
}

/// The value of a setting: text bare, and all else as JSON.
pub(crate) fn plain(value: &Value) -> String {
    value.as_str().map_or_else(|| value.to_string(), str::to_owned)
}

/// The values of keys in the settings of a run, under the names of the keys; nothing where they are not set.
pub(crate) fn settings_of_keys(settings: &[Setting], keys: &[&str]) -> Vec<(String, String)> {
    let value = |key: &&str| settings.iter().find(|setting| setting.key == *key).map(|setting| plain(&setting.value));
    keys.iter().map(|key| ((*key).to_owned(), value(key).unwrap_or_default())).collect()
}

/// A table in Markdown below the names of its columns, of which the first is aligned to the left, and the others as `rule` says: `---`, or
/// `--:` for numbers.
pub(crate) fn markdown(rows: impl IntoIterator<Item = Vec<String>>, rule: &str) -> String {
    let mut lines: Vec<String> = Vec::new();
    for cells in rows {
        lines.push(format!("| {} |", cells.join(" | ")));
        if lines.len() == 1 {
            lines.push(format!("|---{}|", format!("|{rule}").repeat(cells.len() - 1)));
        }
    }
    lines.join("\n")
}

/// A list in Markdown under its heading; nothing where it has no entries.
pub(crate) fn list(heading: &str, entries: impl IntoIterator<Item = String>) -> Vec<String> {
    let entries: Vec<String> = entries.into_iter().map(|entry| format!("- {entry}")).collect();
    if entries.is_empty() { Vec::new() } else { vec![heading.to_owned(), entries.join("\n")] }
}
