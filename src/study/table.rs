//! Tables of numbers and words, as comma-separated text.

use crate::numbers::push_exact;
use crate::output::quoted;
use serde_json::Value;

/// A line of cells.
pub(crate) fn line(cells: &[String]) -> String {
    let cells: Vec<_> = cells.iter().map(|cell| quoted(cell)).collect();
    format!("{}\n", cells.join(","))
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
