//! The pages of sweeps, tradeoffs and maps of stability.

use super::entry::{Entry, TextTable, WIDTH, inside, pictures};
use crate::output::own_file;
use crate::study::Kind;
use pulldown_cmark::{Event, Options, Parser, html};
use serde_json::Value;
use std::fs;
use std::path::Path;

/// The most rows of a table that are shown.
const MOST_ROWS: usize = 200;

/// The entry of a study; none of a directory without one.
pub(super) fn entry(directory: &Path) -> Option<Entry> {
    let kind = Kind::of(directory)?;
    let mut entry = Entry::of(kind.noun, directory);
    let summary: Value = match own_file::json(&directory.join(kind.summary)) {
        Ok(summary) => summary,
        Err(error) => {
            entry.missing.push(error.to_string());
            Value::Null
        }
    };
    let text = |key: &str| summary[key].as_str().map(str::to_owned);
    let written = summary.pointer("/arguments/text").and_then(Value::as_str);
    let written: Option<Value> = written.and_then(|text| serde_json::from_str(text).ok());
    let title = summary.pointer("/base/title").or_else(|| written.as_ref()?.get("title")).and_then(Value::as_str);
    if let Some(title) = title {
        entry.title = format!("{title}: {}", kind.noun);
    }
    entry.when = text("date").filter(|date| !date.is_empty());
    if let Some(adapter) = summary["adapter"]["name"].as_str() {
        entry.add_fact("adapter", adapter);
    }
    if let Some(version) = text("mesoscope_version") {
        entry.add_fact("version", version);
    }
    let varied = summary.pointer("/arguments/vary").or_else(|| summary.get("vary")).cloned().unwrap_or_default();
    for value in varied.as_array().into_iter().flatten() {
        let shown = value.as_str().map_or_else(
            || {
                let values =
                    value["values"].as_array().map(|all| all.iter().map(super::entry::in_a_line).collect::<Vec<_>>());
                format!("{} = {}", value["key"].as_str().unwrap_or_default(), values.unwrap_or_default().join(", "))
            },
            str::to_owned,
        );
        entry.add_fact("varied", shown);
    }
    let unfinished =
        summary["variants"].as_array().into_iter().flatten().filter(|variant| variant["state"] != "finished");
    for variant in unfinished {
        let name = variant["name"].as_str().unwrap_or_default();
        let why =
            variant["failure"].as_str().map_or_else(|| "has not ended".to_owned(), |why| format!("failed: {why}"));
        entry.missing.push(format!("`{name}` {why}"));
    }
    for (suffix, heading) in [("", "Runs"), ("-averages", "Means over seeds")] {
        let path = directory.join(format!("{}{suffix}.csv", kind.command));
        if suffix.is_empty() || path.exists() {
            match fs::read_to_string(&path) {
                Ok(found) => entry.tables.extend(table(&found, heading)),
                Err(error) => entry.missing.push(format!("`{}{suffix}.csv` cannot be read: {error}", kind.command)),
            }
        }
    }
    if let Ok(page) = fs::read_to_string(directory.join(format!("{}.md", kind.command))) {
        entry.words = Some(in_html(&page));
        // The page has the table in words.
        entry.tables.clear();
    }
    for path in pictures(directory) {
        let name = path.file_stem().map(|stem| stem.to_string_lossy().replace('_', " ")).unwrap_or_default();
        match inside(&path, name, WIDTH) {
            Ok(picture) => entry.pictures.push(picture),
            Err(note) => entry.missing.push(note),
        }
    }
    let scene = summary.pointer("/arguments/scene").or_else(|| summary.get("scene")).and_then(Value::as_str);
    let settings = summary.pointer("/arguments/set").or_else(|| summary.get("set")).and_then(Value::as_array);
    let quoted = |text: &str| format!("'{}'", text.replace('\'', r"'\''"));
    let mut command = format!("mesoscope {} {}", kind.command, scene.map(quoted).unwrap_or_default());
    for setting in settings.into_iter().flatten().filter_map(Value::as_str) {
        command = format!("{command} --set {}", quoted(setting));
    }
    for value in varied.as_array().into_iter().flatten() {
        let argument = value.as_str().map_or_else(
            || {
                let values =
                    value["values"].as_array().map(|all| all.iter().map(ToString::to_string).collect::<Vec<_>>());
                format!("{}={}", value["key"].as_str().unwrap_or_default(), values.unwrap_or_default().join(","))
            },
            str::to_owned,
        );
        command = format!("{command} --vary {}", quoted(&argument));
    }
    entry.repeat = vec![format!("`{}` in the directory has all that was requested.", kind.summary)];
    entry.command = Some(command);
    Some(entry)
}

/// A table in comma-separated values, whose columns are numbers where all cells are.
fn table(text: &str, heading: &str) -> Option<TextTable> {
    let mut lines = text.lines().map(cells);
    let header = lines.next()?;
    let all: Vec<Vec<String>> = lines.collect();
    let is_number = |column: &usize| {
        all.iter().all(|row| row.get(*column).is_none_or(|cell| cell.is_empty() || cell.parse::<f64>().is_ok()))
    };
    let numbers: Vec<usize> = (0..header.len()).filter(is_number).collect();
    let shown = |(column, cell): (usize, &String)| match cell.parse::<f64>() {
        Ok(number) if numbers.contains(&column) => crate::numbers::six_digits(number),
        _ => cell.clone(),
    };
    let rows = all.iter().take(MOST_ROWS).map(|row| row.iter().enumerate().map(shown).collect()).collect();
    let note = (all.len() > MOST_ROWS)
        .then(|| format!("{} more rows are in the table of the directory", all.len() - MOST_ROWS));
    Some(TextTable { heading: heading.to_owned(), header, rows, numbers, note })
}

/// The cells of a line, of which some are in quotes.
fn cells(line: &str) -> Vec<String> {
    let (mut cells, mut is_quoted) = (vec![String::new()], false);
    let mut letters = line.chars().peekable();
    while let Some(letter) = letters.next() {
        let last = cells.len() - 1;
        match letter {
            '"' if is_quoted && letters.peek() == Some(&'"') => {
                letters.next();
                cells[last].push('"');
            }
            '"' => is_quoted = !is_quoted,
            ',' if !is_quoted => cells.push(String::new()),
            letter => cells[last].push(letter),
        }
    }
    cells
}

/// Markdown as HTML, without what is HTML in it: names of a scene may look like it. Its title is that of the entry.
fn in_html(page: &str) -> String {
    let body = page.split_once("\n\n").map_or(page, |(first, rest)| if first.starts_with("# ") { rest } else { page });
    let events = Parser::new_ext(body, Options::ENABLE_TABLES).map(|event| match event {
        Event::Html(text) | Event::InlineHtml(text) => Event::Text(text),
        other => other,
    });
    let mut text = String::new();
    html::push_html(&mut text, events);
    text.replace("<table>", "<div class=\"wide\"><table>").replace("</table>", "</table></div>")
}
