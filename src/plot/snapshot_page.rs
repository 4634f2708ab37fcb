//! What stands around the box in a snapshot: headings, the key to the colours, a scale bar.

use super::canvas::{Anchor, Area, Canvas, Type};
use super::palette::{Colour, Inks, scale_colour};
use super::text::{CAPITAL_HEIGHT, LINE_HEIGHT, Weight};
use super::ticks::{AxisMap, grouped, nice_length, short_number, ticks};
use crate::scene::Snapshot;

/// What the colours of a picture mean.
pub(super) enum Key<'a> {
    Species { names: &'a [String], counts: Vec<u64>, colours: [Colour; 8] },
    Scale { name: &'a str, map: AxisMap },
}

impl<'a> Key<'a> {
    /// The species of particles, by name.
    pub(super) fn species(names: &'a [String], species: &[u32], inks: &Inks) -> Self {
        let mut counts = vec![0; names.len()];
        for species in species {
            counts[*species as usize] += 1;
        }
        Self::Species { names, counts, colours: inks.species }
    }

    /// The colour of a species; on a scale, that of its lower end.
    pub(super) fn colour_of(&self, species: u32) -> Colour {
        match self {
            Self::Species { colours, .. } => colours[species as usize % colours.len()],
            Self::Scale { .. } => scale_colour(0.0),
        }
    }
}

/// Rows of species below a picture, at most.
const LEGEND_ROWS: usize = 6;

/// Sizes of everything around the box, in pixels.
pub(super) struct Page {
    width: f64,
    height: f64,
    margin: f64,
    title: f64,
    label: f64,
    pub(super) rule: f64,
    gap: f64,
    /// A thumbnail has no text: nobody could read it.
    captioned: bool,
}

impl Page {
    pub(super) fn new(style: &Snapshot) -> Self {
        let (width, height) = (f64::from(style.width), f64::from(style.height));
        let unit = width.min(height) / 1200.0;
        Self {
            width,
            height,
            margin: 28.0 * unit,
            title: (42.0 * unit).max(7.0),
            label: (32.0 * unit).max(6.0),
            rule: (3.0 * unit).max(1.0),
            gap: 14.0 * unit,
            captioned: width.min(height) >= 200.0,
        }
    }

    fn text(&self, colour: Colour) -> Type {
        Type { size: self.label, weight: Weight::Regular, colour }
    }

    /// Writes the headings; returns the place of the box between them and the footer.
    pub(super) fn frame(&self, canvas: &mut Canvas, headings: [&str; 2], key: &Key<'_>, inks: &Inks) -> Area {
        let top = if self.captioned { self.headings(canvas, headings, inks) } else { self.margin };
        let footer = if self.captioned { self.footer_height(canvas, key) } else { 0.0 };
        let bottom = self.height - self.margin - footer;
        Area { left: self.margin, top, right: self.width - self.margin, bottom }
    }

    fn headings(&self, canvas: &mut Canvas, [title, subtitle]: [&str; 2], inks: &Inks) -> f64 {
        let mut y = self.margin;
        let width = self.width - 2.0 * self.margin;
        for (text, size, weight, colour) in
            [(title, self.title, Weight::SemiBold, inks.ink), (subtitle, self.label, Weight::Regular, inks.muted)]
        {
            for line in canvas.typesetter.wrap(text, weight, size, width, 2) {
                let baseline = [self.margin, y + CAPITAL_HEIGHT * size];
                canvas.text(&line, baseline, Anchor::Start, Type { size, weight, colour });
                y += LINE_HEIGHT * size;
            }
        }
        if y > self.margin { y + 0.5 * self.gap } else { y }
    }

    fn line(&self) -> f64 {
        1.35 * self.label
    }

    /// Species in rows that leave room for the scale bar beside the first.
    fn legend_rows(&self, canvas: &Canvas, names: &[String], counts: &[u64]) -> Vec<Vec<(String, f64)>> {
        let room = 0.66 * (self.width - 2.0 * self.margin);
        let mut rows: Vec<Vec<(String, f64)>> = Vec::new();
        let mut used = f64::INFINITY;
        for (name, count) in names.iter().zip(counts) {
            let text = format!("{name} ({})", grouped(*count));
            let text = canvas.typesetter.shorten(&text, Weight::Regular, self.label, room - 1.2 * self.label);
            let width = canvas.typesetter.width(&text, Weight::Regular, self.label) + 2.2 * self.label;
            if used + width > room {
                rows.push(Vec::new());
                used = 0.0;
            }
            used += width;
            if let Some(row) = rows.last_mut() {
                row.push((text, width));
            }
        }
        // A legend must not crowd out the picture.
        let left_out: usize = rows.iter().skip(LEGEND_ROWS).map(Vec::len).sum();
        rows.truncate(LEGEND_ROWS);
        if left_out > 0
            && let Some(last) = rows.last_mut()
        {
            // Its place is that of the last species.
            let replaced = usize::from(last.pop().is_some());
            last.push((format!("and {} more species", left_out + replaced), 0.0));
        }
        rows
    }

    fn footer_height(&self, canvas: &Canvas, key: &Key<'_>) -> f64 {
        let lines = match key {
            Key::Species { names, counts, .. } => self.legend_rows(canvas, names, counts).len().max(1) as f64,
            Key::Scale { .. } => 1.0,
        };
        self.gap + (lines * self.line()).max(2.0 * self.line())
    }

    /// Draws the key to the colours and a scale bar below a box with this outline.
    pub(super) fn footer(
        &self,
        canvas: &mut Canvas,
        key: &Key<'_>,
        inks: &Inks,
        outline: Area,
        pixels_per_length: f64,
    ) {
        if !self.captioned {
            return;
        }
        let top = self.height - self.margin - self.footer_height(canvas, key) + self.gap;
        let style = self.text(inks.ink);
        match key {
            Key::Species { names, counts, colours } => {
                let mut species = 0;
                for (row, entries) in self.legend_rows(canvas, names, counts).into_iter().enumerate() {
                    let y = top + (row as f64 + 0.5) * self.line();
                    let mut x = self.margin;
                    for (text, width) in entries {
                        if width > 0.0 {
                            let radius = 0.36 * self.label;
                            canvas.disc([x + radius, y], radius, colours[species % colours.len()]);
                        }
                        canvas.text_centred(&text, [x + 1.1 * self.label, y], Anchor::Start, style);
                        x += width;
                        species += 1;
                    }
                }
            }
            Key::Scale { name, map } => self.colour_bar(canvas, name, map, top, style),
        }
        self.scale_bar(canvas, top, outline, pixels_per_length, style);
    }

    fn colour_bar(&self, canvas: &mut Canvas, name: &str, map: &AxisMap, top: f64, style: Type) {
        let y = top + 0.5 * self.line();
        let left = self.margin + canvas.typesetter.width(name, style.weight, style.size) + self.gap;
        let width = 0.42 * (self.width - 2.0 * self.margin);
        let height = 0.8 * self.label;
        canvas.text_centred(name, [self.margin, y], Anchor::Start, style);
        let columns = width.ceil().max(1.0) as u32;
        for column in 0..columns {
            let from = left.round() + f64::from(column);
            let colour = scale_colour((f64::from(column) + 0.5) / f64::from(columns));
            let (top, bottom) = ((y - 0.5 * height).round(), (y + 0.5 * height).round());
            canvas.rectangle(Area { left: from, top, right: from + 1.0, bottom }, colour);
        }
        let marks = ticks(map, 4);
        for (value, text) in &marks.major {
            let x = left + map.fraction(*value).unwrap_or(0.0) * width;
            let foot = y + 0.5 * height;
            canvas.vertical_rule(x, foot, foot + 0.4 * self.gap, 0.7 * self.rule, style.colour);
            let baseline = foot + 0.8 * self.gap + CAPITAL_HEIGHT * self.label;
            canvas.text(text, [x, baseline], Anchor::Middle, style);
        }
        if let Some(multiplier) = &marks.multiplier {
            canvas.text_centred(multiplier, [left + width + self.gap, y], Anchor::Start, style);
        }
    }

    fn scale_bar(&self, canvas: &mut Canvas, top: f64, outline: Area, pixels_per_length: f64, style: Type) {
        let room = 0.25 * (self.width - 2.0 * self.margin).min(outline.width().max(1.0) * 2.0);
        let length = nice_length(room / pixels_per_length);
        let unit = if length == 1.0 { "length unit" } else { "length units" };
        let text = format!("{} {unit}", short_number(length));
        let right = self.width - self.margin;
        let (bar, text_width) = (length * pixels_per_length, canvas.typesetter.width(&text, style.weight, style.size));
        let middle = right - 0.5 * bar.max(text_width);
        let y = top + 0.3 * self.line();
        let (from, to) = (middle - 0.5 * bar, middle + 0.5 * bar);
        canvas.horizontal_rule(from, to, y, 1.3 * self.rule, style.colour);
        for x in [from, to] {
            canvas.vertical_rule(x, y - 0.55 * self.gap, y + 0.55 * self.gap, self.rule, style.colour);
        }
        canvas.text(&text, [middle, y + self.gap + CAPITAL_HEIGHT * self.label], Anchor::Middle, style);
    }
}
