//! What stands around the box in a snapshot: headings, the key to the colours, a scale bar.

use super::canvas::{Anchor, Area, Canvas, Type};
use super::chart::Scale;
use super::error::PlotError;
use super::palette::{Colour, Inks, scale_colour};
use super::species_colours::species_colours;
use super::text::{CAPITAL_HEIGHT, Weight, in_rows};
use super::ticks::{AxisMap, nice_length, ticks};
use crate::numbers::{grouped, short};
use crate::scene::{Snapshot, Theme};

/// Looks whether lists of so many particles or cells, species with their names and edges of the box can be drawn.
///
/// # Errors
/// [`PlotError::Input`] says what cannot.
pub(super) fn check(
    count: usize,
    lists: &[(usize, &str)],
    (species, names): (&[u32], &[String]),
    lengths: &[f64],
) -> Result<(), PlotError> {
    let lists = lists.iter().filter(|(length, _)| *length != count);
    let lists = lists.map(|(length, name)| format!("{count} positions but {length} {name}"));
    let unnamed = species.iter().filter(|species| **species as usize >= names.len());
    let unnamed = unnamed.map(|species| format!("species {species} has no name"));
    let edges = lengths.iter().enumerate().filter(|(_, length)| !(length.is_finite() && **length > 0.0));
    let edges = edges.map(|(axis, length)| format!("the box has length {length} along axis {axis}"));
    lists.chain(unnamed).chain(edges).next().map_or(Ok(()), |problem| Err(PlotError::Input(problem)))
}

/// What the colours of a picture mean.
pub(super) enum Key<'a> {
    /// The species of each particle or cell, by name.
    Species { names: Vec<String>, species: &'a [u32], counts: Vec<u64>, colours: Vec<Colour>, listed: Vec<usize> },
    /// The value of each on a scale, and whether some lie beyond its lower and its upper end.
    Scale { name: &'a str, values: &'a [f64], map: AxisMap, beyond: [bool; 2] },
}

impl<'a> Key<'a> {
    /// The species that are `shown`, or all where none is named.
    pub(super) fn species(names: &[String], species: &'a [u32], shown: &[String], inks: &Inks) -> Self {
        let mut counts = vec![0; names.len()];
        for species in species {
            counts[*species as usize] += 1;
        }
        let is_listed = |place: &usize| shown.is_empty() || shown.contains(&names[*place]);
        let listed: Vec<usize> = (0..names.len()).filter(is_listed).collect();
        let counts = listed.iter().map(|place| counts[*place]).collect();
        let colours = species_colours(inks, names.len());
        let names = listed.iter().map(|place| names[*place].clone()).collect();
        Self::Species { names, species, counts, colours, listed }
    }

    /// Values on a scale with these ends, or where they are left out with those that fit.
    pub(super) fn scale(name: &'a str, given: Option<[f64; 2]>, fitting: [f64; 2], values: &'a [f64]) -> Self {
        let map = AxisMap::given(Scale::Linear, given).unwrap_or_else(|| AxisMap::around(fitting, 0.0));
        let AxisMap { low, high, .. } = map;
        let any = |outside: &dyn Fn(f64) -> bool| values.iter().any(|value| value.is_finite() && outside(*value));
        // What an end rounds to does not lie beyond it.
        let slack = 1e-9 * (high - low);
        let beyond = [any(&|value| value < low - slack), any(&|value| value > high + slack)];
        Self::Scale { name, values, map, beyond }
    }

    /// The colour of a particle or a cell; what has no place on a scale has that of its lower end.
    pub(super) fn colour(&self, index: usize) -> Colour {
        match self {
            Self::Species { species, colours, .. } => colours[species[index] as usize % colours.len()],
            Self::Scale { values, map, .. } => scale_colour(map.fraction(values[index]).unwrap_or(0.0)),
        }
    }
}

/// Part of a page that a legend takes, at most, and sizes of its type, of which the largest is taken that fits.
const LEGEND_PART: f64 = 0.3;
const LEGEND_SIZES: [f64; 5] = [1.0, 0.85, 0.7, 0.58, 0.48];
/// The least side of a page with text: nobody could read it on a thumbnail.
const CAPTIONED: f64 = 200.0;
/// The longer side of a page whose size is left out.
const LONGER_SIDE: f64 = 1200.0;
/// Pages that follow their box are no flatter and no narrower than this.
const LEAST_RATIO: f64 = 0.4;

/// A page, and the sizes of everything around the box, in pixels.
pub(super) struct Page {
    pub(super) canvas: Canvas,
    width: f64,
    height: f64,
    margin: f64,
    title: f64,
    label: f64,
    pub(super) rule: f64,
    gap: f64,
    captioned: bool,
    /// The size of the type of the legend, and its entries in rows, each with its width; without one there are no rows.
    legend: (f64, Vec<Vec<(String, f64)>>),
}

impl Page {
    /// The page of a view with these extents along its width and its height.
    ///
    /// # Errors
    /// [`PlotError::Font`] if an embedded font cannot be read.
    pub(super) fn new(style: &Snapshot, theme: Theme, shape: [f64; 2]) -> Result<Self, PlotError> {
        let [width, height] = size(style, shape);
        let exact = style.width.is_some() && style.height.is_some();
        let side = if exact { width.min(height) } else { width.max(height) };
        let unit = side / LONGER_SIDE;
        Ok(Self {
            canvas: Canvas::new(width.round() as u32, height.round() as u32, theme)?,
            width,
            height,
            margin: 28.0 * unit,
            title: (42.0 * unit).max(7.0),
            label: (32.0 * unit).max(6.0),
            rule: (3.0 * unit).max(1.0),
            gap: 14.0 * unit,
            captioned: width.min(height) >= CAPTIONED,
            legend: (0.0, Vec::new()),
        })
    }

    fn text(&self, colour: Colour) -> Type {
        Type { size: self.label, weight: Weight::Regular, colour }
    }

    /// Writes the headings; returns the place of the box between them and the footer.
    pub(super) fn frame(&mut self, title: &str, notes: Vec<String>, key: &Key<'_>) -> Area {
        if !self.captioned {
            let [right, bottom] = [self.width, self.height].map(|side| side - self.margin);
            return Area { left: self.margin, top: self.margin, right, bottom };
        }
        let headings = self.canvas.headings(title, notes, [self.title, self.label], 2, self.width - 2.0 * self.margin);
        let end = self.canvas.write_headings(&headings, [self.margin; 2]);
        let top = if headings.is_empty() { end } else { end + 0.5 * self.gap };
        if let Key::Species { names, counts, .. } = key {
            self.legend = self.legend(names, counts);
        }
        let bottom = self.height - self.margin - self.footer_height() - self.beside();
        let aside = self.margin + self.beside();
        Area { left: aside, top, right: self.width - aside, bottom }
    }

    /// The outline of a view in the middle of a frame, as large as there is room for what stands out of it, and pixels
    /// per unit of length.
    pub(super) fn outline(&self, frame: &Area, shape: [f64; 2], overhang: f64) -> (Area, f64) {
        let room = [frame.width(), frame.height()].map(|side| side - 2.0 * self.rule);
        let fits = (room[0] / (shape[0] + overhang)).min(room[1] / (shape[1] + overhang));
        let pixels_per_length = fits.max(1e-9 / shape[0]);
        (Area::around(frame.centre(), shape.map(|length| length * pixels_per_length)), pixels_per_length)
    }

    /// Room for the lengths of edges beside the box.
    fn beside(&self) -> f64 {
        1.3 * self.label
    }

    /// Writes the length of an edge of the box outside it, at its middle: below an edge that leads down from the view, else to
    /// its left.
    pub(super) fn edge_length(&mut self, name: &str, length: f64, [from, to]: [[f64; 2]; 2]) {
        if !self.captioned {
            return;
        }
        let style = Type { size: 0.85 * self.label, ..self.text(self.canvas.inks.muted) };
        let text = format!("L_{{{name}}} = {}", short(format!("{length:.4e}").parse().unwrap_or(length)));
        let middle = [0.5 * (from[0] + to[0]), 0.5 * (from[1] + to[1])];
        let off = 0.45 * self.label;
        if (to[0] - from[0]).abs() < 1e-6 * (to[1] - from[1]).abs() {
            self.canvas.text_upwards(&text, [middle[0] - off, middle[1]], Anchor::Middle, style);
            return;
        }
        // Clear of an edge that rises to the right or to the left, or lies flat.
        let rise = (to[1] - from[1]) / (to[0] - from[0]);
        let (anchor, shift) = match rise {
            rise if rise > 0.05 => (Anchor::End, -off),
            rise if rise < -0.05 => (Anchor::Start, off),
            _ => (Anchor::Middle, 0.0),
        };
        let baseline = middle[1] + 0.7 * off + CAPITAL_HEIGHT * style.size;
        self.canvas.text(&text, [middle[0] + shift, baseline], anchor, style);
    }

    fn line(&self) -> f64 {
        1.35 * self.label
    }

    /// Species in rows, the first of which leave room for the scale bar beside them, and the size of their type.
    fn legend(&self, names: &[String], counts: &[u64]) -> (f64, Vec<Vec<(String, f64)>>) {
        let most = (LEGEND_PART * self.height).max(2.0 * self.line());
        let rows_of = |size: f64| {
            let setter = &self.canvas.typesetter;
            let room = self.legend_room(0, size) - 1.2 * size;
            let entry = |(name, count): (&String, &u64)| {
                let text = format!("{name} ({})", grouped(*count));
                let text = setter.shorten(&text, Weight::Regular, size, room);
                let width = setter.width(&text, Weight::Regular, size) + 2.2 * size;
                (text, width)
            };
            let texts: Vec<(String, f64)> = names.iter().zip(counts).map(entry).collect();
            let whole = texts.iter().zip(names).all(|((text, _), name)| text.starts_with(name.as_str()));
            (in_rows(texts, |row| self.legend_room(row, size)), whole)
        };
        // A legend must not crowd out the picture, and names are better small than cut.
        let fits = |size: &f64| {
            let (rows, whole) = rows_of(*size);
            rows.len() as f64 * 1.35 * size <= most && whole
        };
        let sizes = LEGEND_SIZES.map(|part| part * self.label);
        let size = sizes.into_iter().find(fits).unwrap_or(sizes[sizes.len() - 1]);
        let (mut rows, _) = rows_of(size);
        let room = ((most / (1.35 * size)) as usize).max(1);
        let left_out: usize = rows.iter().skip(room).map(Vec::len).sum();
        rows.truncate(room);
        if left_out > 0
            && let Some(last) = rows.last_mut()
        {
            // Its place is that of the last species.
            let replaced = usize::from(last.pop().is_some());
            last.push((format!("and {} more species", left_out + replaced), 0.0));
        }
        (size, rows)
    }

    /// Width of a row of the legend: the scale bar stands beside the first.
    fn legend_room(&self, row: usize, size: f64) -> f64 {
        let beside_the_bar = row as f64 * 1.35 * size < 2.0 * self.line();
        (if beside_the_bar { 0.66 } else { 1.0 }) * (self.width - 2.0 * self.margin)
    }

    fn footer_height(&self) -> f64 {
        let (size, rows) = &self.legend;
        self.gap + (rows.len() as f64 * 1.35 * size).max(2.0 * self.line())
    }

    /// Draws the key to the colours and a scale bar below a box with this outline.
    pub(super) fn footer(&mut self, key: &Key<'_>, outline: Area, pixels_per_length: f64) {
        if !self.captioned {
            return;
        }
        let top = self.height - self.margin - self.footer_height() + self.gap;
        let style = self.text(self.canvas.inks.ink);
        match key {
            Key::Species { colours, listed, .. } => {
                let mut entry = 0;
                let (size, rows) = self.legend.clone();
                let style = Type { size, ..style };
                for (row, entries) in rows.into_iter().enumerate() {
                    let y = top + (row as f64 + 0.5) * 1.35 * size;
                    let mut x = self.margin;
                    for (text, width) in entries {
                        if width > 0.0 {
                            let radius = 0.36 * size;
                            self.canvas.disc([x + radius, y], radius, colours[listed[entry] % colours.len()]);
                        }
                        self.canvas.text_centred(&text, [x + 1.1 * size, y], Anchor::Start, style);
                        x += width;
                        entry += 1;
                    }
                }
            }
            Key::Scale { name, map, beyond, .. } => self.colour_bar(name, map, *beyond, top, style),
        }
        self.scale_bar(top, outline, pixels_per_length, style);
    }

    fn colour_bar(&mut self, name: &str, map: &AxisMap, beyond: [bool; 2], top: f64, style: Type) {
        let y = top + 0.5 * self.line();
        let height = 0.8 * self.label;
        let inner = self.width - 2.0 * self.margin;
        let name = self.canvas.typesetter.shorten(name, style.weight, style.size, 0.42 * inner);
        // Arrowheads at the ends have their place whether there are any or not.
        let arrowhead = 0.9 * height;
        let left = self.margin + self.canvas.typesetter.width(&name, style.weight, style.size) + self.gap + arrowhead;
        let room = self.margin + 0.7 * inner - left - arrowhead;
        let width = (0.4 * inner).min(room).max(0.15 * inner);
        self.canvas.text_centred(&name, [self.margin, y], Anchor::Start, style);
        for (shown, end, direction, fraction) in [(beyond[0], left, -1.0, 0.0), (beyond[1], left + width, 1.0, 1.0)] {
            if shown {
                let radius = 0.58 * height;
                let angle = if direction < 0.0 { std::f64::consts::PI } else { 0.0 };
                self.canvas.polygon([end + direction * 0.55 * radius, y], radius, 3, angle, scale_colour(fraction));
            }
        }
        let columns = width.ceil().max(1.0) as u32;
        for column in 0..columns {
            let from = left.round() + f64::from(column);
            let colour = scale_colour((f64::from(column) + 0.5) / f64::from(columns));
            let (top, bottom) = ((y - 0.5 * height).round(), (y + 0.5 * height).round());
            self.canvas.rectangle(Area { left: from, top, right: from + 1.0, bottom }, colour);
        }
        let marks = ticks(map, 4);
        for (value, text) in &marks.major {
            let x = left + map.fraction(*value).unwrap_or(0.0) * width;
            let foot = y + 0.5 * height;
            self.canvas.vertical_rule(x, foot, foot + 0.4 * self.gap, 0.7 * self.rule, style.colour);
            let baseline = foot + 0.8 * self.gap + CAPITAL_HEIGHT * self.label;
            self.canvas.text(text, [x, baseline], Anchor::Middle, style);
        }
        if let Some(multiplier) = &marks.multiplier {
            self.canvas.text_centred(multiplier, [left + width + self.gap + arrowhead, y], Anchor::Start, style);
        }
    }

    fn scale_bar(&mut self, top: f64, outline: Area, pixels_per_length: f64, style: Type) {
        let room = 0.25 * (self.width - 2.0 * self.margin).min(outline.width().max(1.0) * 2.0);
        let length = nice_length(room / pixels_per_length);
        let unit = if length == 1.0 { "length unit" } else { "length units" };
        let text = format!("{} {unit}", short(length));
        let right = self.width - self.margin;
        let (bar, text_width) =
            (length * pixels_per_length, self.canvas.typesetter.width(&text, style.weight, style.size));
        let middle = right - 0.5 * bar.max(text_width);
        let y = top + 0.3 * self.line();
        let (from, to) = (middle - 0.5 * bar, middle + 0.5 * bar);
        self.canvas.horizontal_rule(from, to, y, 1.3 * self.rule, style.colour);
        for x in [from, to] {
            self.canvas.vertical_rule(x, y - 0.55 * self.gap, y + 0.55 * self.gap, self.rule, style.colour);
        }
        self.canvas.text(&text, [middle, y + self.gap + CAPITAL_HEIGHT * self.label], Anchor::Middle, style);
    }
}

/// Width and height of the page: what the style says, and else what the shape of the view asks for.
pub(super) fn size(style: &Snapshot, shape: [f64; 2]) -> [f64; 2] {
    let given = [style.width, style.height].map(|side| side.map(f64::from));
    if let [Some(width), Some(height)] = given {
        return [width, height];
    }
    let longer = given[0].or(given[1]).unwrap_or(LONGER_SIDE);
    let unit = longer / LONGER_SIDE;
    // Headings of two lines, the footer and margins, as on a page of this unit; a thumbnail has margins alone.
    let captions = longer >= CAPTIONED;
    let [beside, above] = if captions { [140.0 * unit, 300.0 * unit] } else { [56.0 * unit; 2] };
    let ratio = (shape[1] / shape[0]).clamp(1e-3, 1e3);
    let height_of = |width: f64| (width - beside).max(1.0) * ratio + above;
    let width_of = |height: f64| (height - above).max(1.0) / ratio + beside;
    let [width, height] = match given {
        [Some(width), None] => [width, height_of(width).clamp(LEAST_RATIO * width, width / LEAST_RATIO)],
        [None, Some(height)] => [width_of(height).clamp(LEAST_RATIO * height, height / LEAST_RATIO), height],
        _ if height_of(longer) <= longer => [longer, height_of(longer).max(LEAST_RATIO * longer)],
        _ => [width_of(longer).max(LEAST_RATIO * longer), longer],
    };
    // Codecs of films want even sides.
    let even = |side: f64, given: Option<f64>| given.unwrap_or(2.0 * (0.5 * side).round());
    [even(width, given[0]), even(height, given[1])]
}

#[cfg(test)]
mod tests {
    use super::*;

    fn pixels(width: Option<u32>, height: Option<u32>, shape: [f64; 2]) -> [u32; 2] {
        size(&Snapshot { width, height, ..Snapshot::default() }, shape).map(|side| side.round() as u32)
    }

    #[test]
    fn pages_follow_the_shape_of_the_box() {
        assert_eq!(pixels(Some(640), Some(480), [2.0, 1.0]), [640, 480], "both sides are given");
        for (shape, wide) in [([2.0, 1.0], true), ([3.0, 1.0], true), ([1.0, 2.0], false), ([1.0, 5.0], false)] {
            let [width, height] = pixels(None, None, shape);
            assert_eq!(width.max(height), 1200);
            assert!(if wide { height < 900 } else { width < 900 }, "{shape:?}: {width} x {height}");
            assert!(width.is_multiple_of(2) && height.is_multiple_of(2));
        }
        // The box fills the page but for what is written around it.
        let [width, height] = pixels(Some(800), None, [2.0, 1.0]);
        assert_eq!(width, 800);
        assert!((500..=600).contains(&height), "{height}");
        assert_eq!(pixels(None, Some(150), [1.0, 1.0]), [150, 150], "a thumbnail");
        let [width, height] = pixels(None, None, [1000.0, 1.0]);
        assert_eq!((width, height), (1200, 480), "room for the captions");
    }

    #[test]
    fn all_of_thirty_species_are_in_the_legend() {
        let names: Vec<String> = (0..30).map(|number| format!("species {number}")).collect();
        let counts = vec![1234; 30];
        for [width, height] in [[1200, 1200], [640, 640], [300, 900]] {
            let style = Snapshot { width: Some(width), height: Some(height), ..Snapshot::default() };
            let Ok(page) = Page::new(&style, Theme::Light, [1.0, 1.0]) else { continue };
            let (size, rows) = page.legend(&names, &counts);
            let found: Vec<String> = rows.iter().flatten().map(|(text, _)| text.clone()).collect();
            let expected: Vec<String> = names.iter().map(|name| format!("{name} (1234)")).collect();
            assert_eq!(found, expected, "{width} x {height}");
            assert!(rows.len() as f64 * 1.35 * size <= LEGEND_PART * f64::from(height) + 1.0);
            for (number, row) in rows.iter().enumerate() {
                let used: f64 = row.iter().map(|(_, width)| width).sum();
                assert!(used <= page.legend_room(number, size), "row {number} of {width} x {height}");
            }
        }
    }
}
