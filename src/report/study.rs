//! The pages of sweeps, tradeoffs and maps of stability.

use super::entry::{Entry, TextTable, WIDTH, in_a_line, inside, pictures};
use crate::numbers::{six_digits, with_error};
use crate::output::own_file;
use crate::study::Kind;
use pulldown_cmark::{Event, Options, Parser, html};
use serde_json::{Map, Value};
use std::fs;
use std::path::Path;

/// The most rows of a table that are shown.
const MOST_ROWS: usize = 200;

/// The entry of a study; none of a directory without one.
pub(super) fn entry(directory: &Path) -> Option<Entry> {
    let kind = Kind::of(directory)?;
    let mut entry = Entry::of(kind.noun, directory);
    let summary: Value = entry.readable(own_file::json(&directory.join(kind.summary))).unwrap_or_default();
    let written = summary.pointer("/arguments/text").and_then(Value::as_str);
    let written: Option<Value> = written.and_then(|text| serde_json::from_str(text).ok());
    let title = summary.pointer("/base/title").or_else(|| written.as_ref()?.get("title")).and_then(Value::as_str);
    if let Some(title) = title {
        entry.title = format!("{title}: {}", kind.noun);
    }
    entry.when = summary["date"].as_str().filter(|date| !date.is_empty()).map(str::to_owned);
    for (name, value) in [("adapter", &summary["adapter"]["name"]), ("version", &summary["mesoscope_version"])] {
        value.as_str().into_iter().for_each(|text| entry.add_fact(name, text));
    }
    let varied = summary.pointer("/arguments/vary").or_else(|| summary.get("vary")).cloned().unwrap_or_default();
    for value in varied.as_array().into_iter().flatten() {
        let values: Vec<String> = value["values"].as_array().into_iter().flatten().map(in_a_line).collect();
        let of_key = || format!("{} = {}", value["key"].as_str().unwrap_or_default(), values.join(", "));
        entry.add_fact("varied", value.as_str().map_or_else(of_key, str::to_owned));
    }
    for variant in summary["variants"].as_array().into_iter().flatten().filter(|one| one["state"] != "finished") {
        let failure = variant["failure"].as_str().map(|why| format!("failed: {why}"));
        let why = failure.as_deref().unwrap_or("has not ended");
        entry.missing.push(format!("`{}` {why}", variant["name"].as_str().unwrap_or_default()));
    }
    for (suffix, heading) in [("", "Runs"), ("-averages", "Means over seeds")] {
        let name = format!("{}{suffix}.csv", kind.command);
        let path = directory.join(&name);
        if suffix.is_empty() || path.exists() {
            let text = fs::read_to_string(&path).map_err(|error| format!("`{name}` cannot be read: {error}"));
            let found = entry.readable(text).and_then(|text| table(&text, heading));
            entry.tables.extend(found);
        }
    }
    if let Ok(page) = fs::read_to_string(directory.join(format!("{}.md", kind.command))) {
        let body = without_title(&page);
        entry.words = Some(in_html(body));
        entry.markdown = Some(body.to_owned());
        // The page has the table in words.
        entry.tables.clear();
    }
    for path in pictures(directory) {
        let picture = entry.readable(inside(&path, WIDTH));
        entry.pictures.extend(picture);
    }
    let kept = ["arguments", "scene", "base", "vary", "also", "set", "steps", "state_files"];
    let request: Map<String, Value> =
        kept.iter().filter_map(|key| Some(((*key).to_owned(), summary.get(*key)?.clone()))).collect();
    entry.scene_use = format!(
        "The request below, as `{}` keeps it, has the scene, its settings, what was varied and all options of `mesoscope {}`.",
        kind.summary, kind.command
    );
    entry.scene = serde_json::to_string_pretty(&request).ok();
    entry.scene_is = "The request";
    Some(entry)
}

/// The errors of a table.
const ERRORS: &str = "± standard errors, widened by Student's factor where samples are few";

/// Columns that say nothing of what was found.
const LEFT_OUT: [&str; 3] = ["wall_seconds", "particle_steps_per_second", "particles"];

/// The most rows that become columns, where there are more columns than a page is wide.
const MOST_TURNED: usize = 6;

/// A table in comma-separated values, with values and their errors in one cell.
fn table(text: &str, heading: &str) -> Option<TextTable> {
    let mut lines = text.lines().map(cells);
    let names = lines.next()?;
    let all: Vec<Vec<String>> = lines.collect();
    let place = |name: &str| names.iter().position(|known| known == name);
    let is_error =
        |name: &str| name.strip_suffix("_error").is_some_and(|of| place(of).or(place(&format!("{of}_mean"))).is_some());
    let kept: Vec<usize> = (0..names.len())
        .filter(|column| !LEFT_OUT.contains(&names[*column].as_str()) && !is_error(&names[*column]))
        .collect();
    let shown = |row: &Vec<String>, column: usize| {
        let cell = row.get(column).cloned().unwrap_or_default();
        // The mean of a quantity that is also varied has a name of its own.
        let measured = names[column].strip_suffix("_mean").unwrap_or(&names[column]);
        let error = place(&format!("{measured}_error")).filter(|_| place(&format!("{}_mean", names[column])).is_none());
        let error = error.and_then(|error| row.get(error)?.parse::<f64>().ok());
        match (cell.parse::<f64>(), error) {
            (Ok(value), Some(error)) => with_error(value, Some(error)),
            (Ok(value), None) => six_digits(value),
            (Err(_), _) => cell,
        }
    };
    let header: Vec<String> = kept.iter().map(|column| names[*column].replace('_', " ")).collect();
    let rows: Vec<Vec<String>> =
        all.iter().take(MOST_ROWS).map(|row| kept.iter().map(|column| shown(row, *column)).collect()).collect();
    let left_out = (all.len() > MOST_ROWS)
        .then(|| format!("{} more rows are in the table of the directory", all.len() - MOST_ROWS));
    // The table itself does not say which of them are from few samples.
    let errors = names.iter().any(|name| is_error(name)).then(|| ERRORS.to_owned());
    let notes: Vec<String> = errors.into_iter().chain(left_out).collect();
    let note = (!notes.is_empty()).then(|| notes.join("; "));
    if rows.len() <= MOST_TURNED && header.len() > MOST_TURNED {
        let turned = |place: usize| -> Vec<String> {
            std::iter::once(&header[place]).chain(rows.iter().map(|row| &row[place])).cloned().collect()
        };
        let mut turned = (0..header.len()).map(turned);
        let header = turned.next()?;
        let numbers = (1..header.len()).collect();
        return Some(TextTable { heading: heading.to_owned(), header, rows: turned.collect(), numbers, note });
    }
    let is_number =
        |column: &usize| all.iter().all(|row| row.get(kept[*column]).is_none_or(|cell| cell.parse::<f64>().is_ok()));
    let numbers = (0..kept.len()).filter(is_number).collect();
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

/// The page of a study without its title, which is that of the entry.
fn without_title(page: &str) -> &str {
    page.split_once("\n\n").map_or(page, |(first, rest)| if first.starts_with("# ") { rest } else { page })
}

/// Markdown as HTML, without HTML and addresses that are in it: names of a scene may look like them.
fn in_html(body: &str) -> String {
    let is_address = |event: &Event<'_>| {
        use pulldown_cmark::{Tag, TagEnd};
        matches!(event, Event::Start(Tag::Link { .. } | Tag::Image { .. }) | Event::End(TagEnd::Link | TagEnd::Image))
    };
    let events = Parser::new_ext(body, Options::ENABLE_TABLES).filter(|event| !is_address(event));
    let events = events.map(|event| match event {
        Event::Html(text) | Event::InlineHtml(text) => Event::Text(text),
        other => other,
    });
    let mut text = String::new();
    html::push_html(&mut text, events);
    text.replace("<table>", "<div class=\"wide\"><table>").replace("</table>", "</table></div>")
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    #[test]
    fn names_are_neither_html_nor_addresses() {
        let page = "`x` <b>of</b> [a fluid](javascript:alert(1)) ![y](file:///etc/passwd)\n\n| a | b |\n|---|---|\n| 1 | 2 |\n";
        let text = in_html(page);
        assert!(["<b>", "javascript", "file:", "<a", "<img"].iter().all(|part| !text.contains(part)), "{text}");
        assert!(
            ["&lt;b&gt;", "a fluid", "<td>1</td>", "<code>x</code>"].iter().all(|part| text.contains(part)),
            "{text}"
        );
    }

    #[test]
    fn values_stand_with_their_errors_and_few_runs_side_by_side() {
        let wide = "variant,temperature,state,steps,wall_seconds,temperature_mean,temperature_error,pressure,a,b\n\
                    \"t=1,2\",1,finished,40,3.5,1.0123456,0.012,23.5,1,2\nt=2,2,failed,0,,,,,,\n";
        let found = table(wide, "Runs").unwrap();
        assert_eq!(found.header, ["variant", "t=1,2", "t=2"]);
        assert_eq!(found.rows[0], ["temperature", "1", "2"]);
        assert_eq!(found.rows[1], ["state", "finished", "failed"]);
        assert_eq!(found.rows[3], ["temperature mean", "1.012 ± 0.012", ""]);
        assert_eq!((found.rows.len(), found.numbers), (7, vec![1, 2]));
        assert_eq!(found.note.as_deref(), Some(ERRORS));
        assert_eq!(table("seed,pressure\n1,2\n", "Runs").unwrap().note, None);
        let narrow = table("seed,pressure,pressure_error\n1,23.456,0.01\n2,23.5,\n", "Runs").unwrap();
        assert_eq!(narrow.header, ["seed", "pressure"]);
        assert_eq!(narrow.rows, [["1", "23.456 ± 0.010"], ["2", "23.5"]]);
    }
}
