//! The page as one sheet: a picture for slides and messages, which shows all that fits into a glance; scenes are left
//! to the page.

use super::ReportError;
use super::entry::{Entry, Inside, TextTable};
use crate::plot::{Sheet, SheetInk, SheetType, missing_glyphs};
use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;
use image::RgbImage;
use pulldown_cmark::{Event, Options, Parser, Tag, TagEnd};

/// Width of a sheet and of its margins, in pixels: A4 at 200 dots an inch.
const WIDTH: u32 = 1654;
const MARGIN: f64 = 90.0;

/// The most rows of a table on a sheet.
const MOST_ROWS: usize = 40;

/// Room between columns and between blocks.
const GUTTER: f64 = 34.0;

const TITLE: SheetType = SheetType { size: 44.0, is_bold: true, ink: SheetInk::Text };
const HEADING: SheetType = SheetType { size: 28.0, is_bold: true, ink: SheetInk::Text };
const BODY: SheetType = SheetType { size: 22.0, is_bold: false, ink: SheetInk::Text };
const LABEL: SheetType = SheetType { size: 20.0, is_bold: false, ink: SheetInk::Faint };
const NOTE: SheetType = SheetType { size: 22.0, is_bold: false, ink: SheetInk::Mark };

/// The pen on a sheet: all below it is blank.
struct Pen {
    sheet: Sheet,
    top: f64,
    /// Letters so far, to say which of them the fonts lack.
    written: String,
}

/// The sheet of some entries, in their order.
pub(super) fn sheet(entries: &[Entry]) -> Result<RgbImage, ReportError> {
    let mut pen = Pen { sheet: Sheet::new(WIDTH)?, top: MARGIN, written: String::new() };
    for (number, entry) in entries.iter().enumerate() {
        if number > 0 {
            pen.top += GUTTER;
            pen.sheet.lay_rule(pen.top);
            pen.top += 2.0 * GUTTER;
        }
        pen.write_entry(entry);
    }
    let missing = missing_glyphs(&pen.written);
    if !missing.is_empty() {
        pen.top += GUTTER;
        pen.write(
            &format!("□ stands for letters that the fonts of pictures lack: {} in all", missing.chars().count()),
            NOTE,
        );
    }
    let height = pen.top + MARGIN;
    Ok(pen.sheet.painted(height)?)
}

impl Pen {
    fn room() -> f64 {
        f64::from(WIDTH) - 2.0 * MARGIN
    }

    fn write(&mut self, text: &str, style: SheetType) {
        self.top = self.lay(text, style, [MARGIN, self.top], Self::room());
    }

    /// Lays down a text, and returns its bottom.
    fn lay(&mut self, text: &str, style: SheetType, corner: [f64; 2], width: f64) -> f64 {
        // The fonts have no nabla.
        let text = text.replace("∇²", "Δ").replace('∇', "grad ");
        self.written.push_str(&text);
        self.sheet.lay_text(&text, style, corner, width)
    }

    fn write_heading(&mut self, text: &str) {
        self.top += GUTTER;
        self.write(text, HEADING);
        self.top += 0.3 * GUTTER;
    }

    /// Texts below their heading, if there are any.
    fn write_list(&mut self, heading: &str, texts: &[String], style: SheetType) {
        if !texts.is_empty() {
            self.write_heading(heading);
        }
        for text in texts {
            self.write(&format!("· {text}"), style);
        }
    }

    fn write_entry(&mut self, entry: &Entry) {
        self.write(&entry.title, TITLE);
        let when = entry.when.as_ref().map(|when| format!(" · {when}")).unwrap_or_default();
        self.write(&format!("{} in {}{when}", entry.kind, entry.directory), LABEL);
        if let Some(description) = &entry.description {
            self.top += 0.3 * GUTTER;
            self.write(description, BODY);
        }
        self.write_list("Not all of it is here", &entry.missing, NOTE);
        let facts = entry.facts.iter().map(|fact| vec![fact.name.to_owned(), fact.text.clone()]).collect();
        let heading = format!("Differences from the built-in scene {}", entry.builtin.as_deref().unwrap_or_default());
        let differences = entry.differences.iter().map(|d| vec![d.key.clone(), d.before.clone(), d.after.clone()]);
        let differences = TextTable::new(&heading, &["key", "built-in", "here"], differences.collect());
        for table in [TextTable::new("What was computed", &[], facts), differences] {
            if !table.rows.is_empty() {
                self.write_heading(&table.heading);
                self.write_table(&table);
            }
        }
        self.write_list("Before trusting the numbers", &entry.warnings, NOTE);
        for table in &entry.tables {
            self.write_heading(&table.heading);
            self.write_table(table);
        }
        if let Some(markdown) = &entry.markdown {
            self.write_markdown(markdown);
        }
        let exactly = entry.conserved.iter().map(|line| format!("to the last bit: {line}"));
        let lines: Vec<String> = exactly.chain(entry.not_conserved.iter().map(|line| format!("not: {line}"))).collect();
        self.write_list("What is conserved", &lines, BODY);
        self.lay_pictures("Pictures", &entry.pictures, 2);
        self.lay_pictures("As it went on", &entry.strip, 6);
        self.write_heading("How to repeat it");
        for line in &entry.repeat {
            self.write(line, BODY);
        }
        if entry.scene.is_some() {
            let (directory, scene) = (&entry.directory, entry.scene_is.to_lowercase());
            self.write(&format!("The page that `mesoscope report {directory}` makes has {scene} as well."), BODY);
        }
    }

    /// A table, in parts below each other where its columns do not fit side by side: each begins with the first column.
    fn write_table(&mut self, table: &TextTable) {
        let shown = &table.rows[..table.rows.len().min(MOST_ROWS)];
        let rows = || std::iter::once(&table.header).filter(|header| !header.is_empty()).chain(shown);
        let count = rows().map(Vec::len).max().unwrap_or(0);
        let widest = |column: usize| {
            let cells = rows().filter_map(|row| row.get(column));
            let widest = cells.map(|cell| self.sheet.width_of(cell, BODY)).fold(0.0, f64::max);
            // Longer texts are set in several lines.
            widest.min(0.45 * Self::room())
        };
        let natural: Vec<f64> = (0..count).map(widest).collect();
        for columns in parts(&natural, Self::room()) {
            let room = Self::room() - GUTTER * columns.len().saturating_sub(1) as f64;
            let widths = fitting(&columns.iter().map(|column| natural[*column]).collect::<Vec<_>>(), room);
            for (number, row) in rows().enumerate() {
                let is_header = number == 0 && !table.header.is_empty();
                let (mut left, mut bottom) = (MARGIN, self.top);
                for (column, width) in columns.iter().zip(&widths) {
                    let cell = row.get(*column).map(String::as_str).unwrap_or_default();
                    let is_label = is_header || table.header.is_empty() && *column == 0;
                    let style = if is_label { LABEL } else { BODY };
                    let own = self.sheet.width_of(cell, style);
                    let shift = if table.numbers.contains(column) { (width - own).max(0.0) } else { 0.0 };
                    bottom = self.lay(cell, style, [left + shift, self.top], width - shift).max(bottom);
                    left += width + GUTTER;
                }
                self.top = bottom + 0.15 * GUTTER;
            }
            self.top += 0.5 * GUTTER;
        }
        let left_out = table.rows.len() - shown.len();
        if left_out > 0 {
            self.write(&format!("{left_out} more rows are in the page"), LABEL);
        }
        if let Some(note) = &table.note {
            self.write(note, LABEL);
        }
    }

    /// Pictures side by side below their heading, each with its name below.
    fn lay_pictures(&mut self, heading: &str, pictures: &[Inside], columns: usize) {
        if !pictures.is_empty() {
            self.write_heading(heading);
        }
        let width = (Self::room() - GUTTER * (columns - 1) as f64) / columns as f64;
        for row in pictures.chunks(columns) {
            let mut bottom = self.top;
            for (column, inside) in row.iter().enumerate() {
                let left = MARGIN + column as f64 * (width + GUTTER);
                // It was read before: a picture that cannot be is among what is missing.
                let bytes = STANDARD.decode(&inside.data).unwrap_or_default();
                let Ok(picture) = image::load_from_memory(&bytes) else {
                    continue;
                };
                let below = self.sheet.lay_picture(&picture.into_rgb8(), [left, self.top], width);
                bottom = self.lay(&inside.name, LABEL, [left, below + 4.0], width).max(bottom);
            }
            self.top = bottom + 0.5 * GUTTER;
        }
    }

    /// The page of a study.
    fn write_markdown(&mut self, markdown: &str) {
        let (mut text, mut table) = (String::new(), TextTable::default());
        let (mut row, mut is_item) = (Vec::new(), false);
        for event in Parser::new_ext(markdown, Options::ENABLE_TABLES) {
            match event {
                Event::Text(part) | Event::Code(part) | Event::Html(part) | Event::InlineHtml(part) => {
                    text.push_str(&part);
                }
                Event::SoftBreak | Event::HardBreak => text.push(' '),
                Event::Start(Tag::Item) => is_item = true,
                Event::End(TagEnd::Item) => {
                    if !text.is_empty() {
                        self.write(&format!("· {}", std::mem::take(&mut text)), BODY);
                    }
                    is_item = false;
                }
                Event::End(TagEnd::Heading(_)) => self.write_heading(&std::mem::take(&mut text)),
                Event::End(TagEnd::CodeBlock) => {
                    for line in std::mem::take(&mut text).lines() {
                        self.write(line, BODY);
                    }
                    self.top += 0.3 * GUTTER;
                }
                Event::End(TagEnd::Paragraph) if !is_item => {
                    self.write(&std::mem::take(&mut text), BODY);
                    self.top += 0.3 * GUTTER;
                }
                Event::End(TagEnd::TableCell) => row.push(std::mem::take(&mut text)),
                Event::End(TagEnd::TableHead) => table.header = std::mem::take(&mut row),
                Event::End(TagEnd::TableRow) => table.rows.push(std::mem::take(&mut row)),
                Event::End(TagEnd::Table) => {
                    self.write_table(&std::mem::take(&mut table));
                    self.top += 0.3 * GUTTER;
                }
                _ => {}
            }
        }
    }
}

/// Columns in parts, each with the first column and as many others as fit into a room.
fn parts(widths: &[f64], room: f64) -> Vec<Vec<usize>> {
    let first = widths.first().copied().unwrap_or(0.0);
    let mut parts: Vec<Vec<usize>> = vec![(0..widths.len().min(1)).collect()];
    let mut used = first;
    for (column, width) in widths.iter().enumerate().skip(1) {
        if used + GUTTER + width > room && parts[parts.len() - 1].len() > 1 {
            parts.push(vec![0]);
            used = first;
        }
        used += GUTTER + width;
        let last = parts.len() - 1;
        parts[last].push(column);
    }
    parts
}

/// Widths of columns that fit into a room: those wider than some common width are cut to it.
fn fitting(natural: &[f64], room: f64) -> Vec<f64> {
    let mut sorted = natural.to_vec();
    sorted.sort_by(f64::total_cmp);
    let (mut left, mut most) = (room, f64::INFINITY);
    for (place, width) in sorted.iter().enumerate() {
        let share = left / (sorted.len() - place) as f64;
        if *width > share {
            most = share;
            break;
        }
        left -= width;
    }
    natural.iter().map(|width| width.min(most)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn wide_columns_share_what_narrow_ones_leave() {
        assert_eq!(fitting(&[10.0, 20.0], 100.0), [10.0, 20.0]);
        assert_eq!(fitting(&[10.0, 200.0, 80.0], 100.0), [10.0, 45.0, 45.0]);
        assert_eq!(fitting(&[], 100.0), [0.0; 0]);
    }

    #[test]
    fn columns_that_do_not_fit_stand_below_with_the_first() {
        let widths = [100.0, 300.0, 300.0, 300.0];
        assert_eq!(parts(&widths, 1500.0), [[0, 1, 2, 3]]);
        assert_eq!(parts(&widths, 850.0), [vec![0, 1, 2], vec![0, 3]]);
        assert_eq!(parts(&[900.0, 900.0], 1000.0), [[0, 1]]);
        assert_eq!(parts(&[], 1000.0), [[0; 0]]);
    }
}
