//! Lays a chart out: margins, axes, ticks, legends, series.

use super::canvas::{Anchor, Area, Canvas, Type};
use super::chart::{Axis, Chart, Panel, Scale, Series, SeriesInk, SeriesStyle};
use super::error::PlotError;
use super::palette::{Colour, Inks, inks, line_colour, with_alpha};
use super::series_path::{Run, clipped, length, runs, segments, thinned};
use super::text::{CAPITAL_HEIGHT, LINE_HEIGHT, Weight};
use super::ticks::{AxisMap, Ticks, grouped, ticks};
use crate::scene::{PlotStyle, Theme};

/// Values beyond this cannot be told from infinity once margins are added.
const LARGEST: f64 = 1e300;
const SMALLEST: f64 = 1e-300;

/// Sizes in pixels, all in proportion to the picture.
#[derive(Debug, Clone, Copy)]
pub(super) struct Sizes {
    pub title: f64,
    pub label: f64,
    pub line: f64,
    pub rule: f64,
    pub gap: f64,
}

impl Sizes {
    pub(super) fn new(style: &PlotStyle, panels: usize) -> Self {
        let natural = (f64::from(style.width) / 1600.0).min(f64::from(style.height) / 900.0);
        // Type never grows so large that it leaves the data no room.
        let largest_label = (f64::from(style.height) / (9 + 5 * panels) as f64).min(f64::from(style.width) / 24.0);
        let unit = (style.scale.max(0.05) * natural).min(largest_label / 32.0);
        Self {
            title: (42.0 * unit).max(8.0),
            label: (32.0 * unit).max(7.0),
            line: (3.4 * unit).max(0.8),
            rule: (2.0 * unit).max(1.0),
            gap: 12.0 * unit,
        }
    }
}

/// A panel with everything decided but its place.
struct Prepared<'a> {
    panel: &'a Panel,
    x: AxisMap,
    y: AxisMap,
    /// The x axis of the panel below is the same.
    shares_x_below: bool,
    /// Points that a logarithmic axis has no place for.
    left_out: usize,
    has_data: bool,
}

/// The area of a panel's data and its ticks.
struct Placed {
    area: Area,
    x: AxisMap,
    y: AxisMap,
    x_ticks: Ticks,
    y_ticks: Ticks,
}

impl Placed {
    /// An area without a coordinate system.
    fn empty(area: Area) -> Self {
        let unit = AxisMap { scale: Scale::Linear, low: 0.0, high: 1.0 };
        Self { area, x: unit, y: unit, x_ticks: Ticks::default(), y_ticks: Ticks::default() }
    }

    fn x_pixel(&self, value: f64) -> Option<f64> {
        self.x.fraction(value).map(|fraction| self.area.left + fraction * self.area.width())
    }

    fn y_pixel(&self, value: f64) -> Option<f64> {
        self.y.fraction(value).map(|fraction| self.area.bottom - fraction * self.area.height())
    }

    fn pixel(&self, point: [f64; 2]) -> Option<[f64; 2]> {
        Some([self.x_pixel(point[0])?, self.y_pixel(point[1])?])
    }

    /// Both ends of an error bar; on a logarithmic axis a bar that reaches zero ends at the foot of the panel.
    fn bar(&self, point: [f64; 2], error: f64) -> Option<[[f64; 2]; 2]> {
        let error = error.abs();
        let high = self.pixel([point[0], point[1] + error])?;
        let centre = self.pixel(point)?;
        let low = self.y_pixel(point[1] - error).unwrap_or(self.area.bottom + self.area.height());
        Some([[centre[0], low], high])
    }
}

/// Lays out a chart as shapes.
///
/// # Errors
/// [`PlotError::Input`] if a series has errors but not one per point; [`PlotError::Font`].
pub(super) fn lay_out(chart: &Chart, style: &PlotStyle) -> Result<Canvas, PlotError> {
    for series in chart.panels.iter().flat_map(|panel| &panel.series) {
        if let Some(errors) = &series.errors
            && errors.len() != series.points.len()
        {
            let (errors, points) = (errors.len(), series.points.len());
            return Err(PlotError::Input(format!("series `{}` has {points} points but {errors} errors", series.name)));
        }
    }
    let inks = inks(style.theme);
    let mut layout = Layout {
        canvas: Canvas::new(style.width, style.height, inks.paper)?,
        inks,
        theme: style.theme,
        sizes: Sizes::new(style, chart.panels.len()),
        prepared: prepare(&chart.panels),
        rough: false,
        legends_above: false,
    };
    layout.draw(chart);
    Ok(layout.canvas)
}

fn prepare(panels: &[Panel]) -> Vec<Prepared<'_>> {
    let mut prepared: Vec<Prepared<'_>> = Vec::new();
    for group in panels.chunk_by(|above, below| above.x == below.x) {
        // Lines end at the frame; markers must not be cut by it.
        let lone = |series: &Series| matches!(series.style, SeriesStyle::Markers | SeriesStyle::LineMarkers);
        let marked = group.iter().flat_map(|panel| &panel.series).any(lone);
        let x = axis_map(&group[0].x, group.iter().flat_map(x_values), if marked { 0.03 } else { 0.0 });
        for (index, panel) in group.iter().enumerate() {
            let log = |axis: &Axis, value: f64| axis.scale == Scale::Log && value <= 0.0;
            let points = || panel.series.iter().flat_map(|series| &series.points);
            prepared.push(Prepared {
                panel,
                x,
                y: axis_map(&panel.y, y_values(panel), 0.05),
                shares_x_below: index + 1 < group.len(),
                left_out: points().filter(|point| log(&panel.x, point[0]) || log(&panel.y, point[1])).count(),
                has_data: points().any(|point| {
                    point.iter().all(|value| value.is_finite()) && !log(&panel.x, point[0]) && !log(&panel.y, point[1])
                }),
            });
        }
    }
    prepared
}

fn x_values(panel: &Panel) -> impl Iterator<Item = f64> + '_ {
    panel.series.iter().flat_map(|series| &series.points).filter(|point| point[1].is_finite()).map(|point| point[0])
}

fn y_values(panel: &Panel) -> impl Iterator<Item = f64> + '_ {
    let of_series = panel.series.iter().flat_map(|series| {
        series.points.iter().enumerate().flat_map(move |(index, point)| {
            let error = series.errors.as_ref().map_or(0.0, |errors| errors[index]);
            let error = if error.is_finite() { error } else { 0.0 };
            let shown = if point[0].is_finite() { point[1] } else { f64::NAN };
            [shown - error, shown, shown + error]
        })
    });
    of_series.chain(panel.references.iter().map(|reference| reference.value))
}

/// The range of an axis: as given, or from the data with a margin.
fn axis_map(axis: &Axis, values: impl Iterator<Item = f64>, margin: f64) -> AxisMap {
    let log = axis.scale == Scale::Log;
    if let Some([low, high]) = axis.range
        && low.abs() <= LARGEST
        && high.abs() <= LARGEST
        && high - low > 1e-12 * low.abs().max(high.abs())
        && (!log || low >= SMALLEST)
    {
        return AxisMap { scale: axis.scale, low, high };
    }
    let (mut low, mut high) = (f64::INFINITY, f64::NEG_INFINITY);
    for value in values.filter(|value| value.is_finite() && (!log || *value > 0.0)) {
        let value = if log { value.clamp(SMALLEST, LARGEST) } else { value.clamp(-LARGEST, LARGEST) };
        low = low.min(value);
        high = high.max(value);
    }
    if low > high {
        (low, high) = if log { (1.0, 10.0) } else { (0.0, 1.0) };
    } else if log {
        let ratio = high / low;
        let grow = if ratio < 1.0 + 1e-9 { 2.0 } else { ratio.powf(margin) };
        (low, high) = (low / grow, high * grow);
    } else {
        // A constant series gets a range in proportion to its value, so that its noise in the last digit stays invisible.
        let span = high - low;
        let constant = span <= 1e-11 * low.abs().max(high.abs()) || span < SMALLEST;
        let grow = if !constant {
            margin * span
        } else if low.abs() < SMALLEST {
            1.0
        } else {
            0.1 * low.abs()
        };
        (low, high) = (low - grow, high + grow);
    }
    AxisMap { scale: axis.scale, low, high }
}

/// How a series is told from the others.
#[derive(Clone, Copy)]
struct Look {
    colour: Colour,
    /// Lengths drawn and skipped, in line widths; empty for a solid line.
    dashes: &'static [f64],
    /// Number of its marker; none where the colour alone has to tell it from its neighbours.
    marker: Option<usize>,
}

const DASHES: [&[f64]; 7] = [
    &[],
    &[4.5, 2.6],
    &[0.01, 2.3],
    &[6.5, 2.4, 0.01, 2.4],
    &[10.0, 3.0],
    &[6.5, 2.3, 0.01, 2.3, 0.01, 2.3],
    &[2.0, 2.5],
];
const REFERENCE_DASHES: &[f64] = &[3.5, 3.0];
/// Labels of y axes that are too long for their panels are set smaller, down to this part of the size of labels.
const Y_LABEL_SIZES: [f64; 4] = [1.0, 0.88, 0.76, 0.64];
/// Up to this many points of a line are marked one by one.
const FEW_POINTS: usize = 30;

struct Layout<'a> {
    canvas: Canvas,
    inks: Inks,
    theme: Theme,
    sizes: Sizes,
    prepared: Vec<Prepared<'a>>,
    /// Lines of the chart are too jagged for dashes; known once the panels have their places.
    rough: bool,
    legends_above: bool,
}

/// One line of a legend.
struct Entry<'a> {
    name: &'a str,
    series: Option<(&'a Series, Look)>,
}

impl Layout<'_> {
    fn text_style(&self, colour: Colour) -> Type {
        Type { size: self.sizes.label, weight: Weight::Regular, colour }
    }

    fn draw(&mut self, chart: &Chart) {
        let margin = 1.6 * self.sizes.gap;
        let top = self.headings(chart, margin);
        let (width, height) = (f64::from(self.canvas.width), f64::from(self.canvas.height));
        let frame = Area { left: margin, top, right: width - margin, bottom: height - margin };
        if self.prepared.is_empty() {
            let style = self.text_style(self.inks.muted);
            self.canvas.text_centred("no data", frame.centre(), Anchor::Middle, style);
            return;
        }
        // A legend stands inside a panel if all panels have room for theirs, else all stand above their panels.
        let mut placed = self.place(frame);
        let mut corners: Vec<Option<Area>> =
            (0..self.prepared.len()).map(|index| self.legend_spot(index, &placed[index])).collect();
        let above = (0..self.prepared.len()).any(|index| self.entries(index).len() > 1 && corners[index].is_none());
        if above {
            self.legends_above = true;
            placed = self.place(frame);
            corners = vec![None; self.prepared.len()];
        }
        self.rough = placed.iter().zip(&self.prepared).any(|(place, prepared)| is_rough(prepared.panel, place));
        for (index, place) in placed.iter().enumerate() {
            self.grid(place);
            self.series(index, place);
            self.axes(index, place);
            if let Some(corner) = corners[index] {
                self.legend_inside(index, corner);
            } else if above {
                self.legend_above(index, place.area);
            }
        }
        self.y_labels(&placed, margin);
    }

    /// Title and subtitle; returns where the panels may start.
    fn headings(&mut self, chart: &Chart, margin: f64) -> f64 {
        let mut notes = chart.subtitle.clone();
        let left_out: usize = self.prepared.iter().map(|prepared| prepared.left_out).sum();
        if left_out > 0 {
            let plural = if left_out == 1 { "value" } else { "values" };
            let separator = if notes.is_empty() { "" } else { "; " };
            let count = grouped(left_out as u64);
            notes = format!("{notes}{separator}{count} {plural} ≤ 0 left out of a logarithmic axis");
        }
        let Sizes { title, label, .. } = self.sizes;
        let width = f64::from(self.canvas.width) - 2.0 * margin;
        let mut y = margin;
        for (text, size, weight, colour, lines) in [
            (chart.title.as_str(), title, Weight::SemiBold, self.inks.ink, 2),
            (notes.as_str(), label, Weight::Regular, self.inks.muted, 3),
        ] {
            for line in self.canvas.typesetter.wrap(text, weight, size, width, lines) {
                let baseline = y + CAPITAL_HEIGHT * size;
                self.canvas.text(&line, [margin, baseline], Anchor::Start, Type { size, weight, colour });
                y += LINE_HEIGHT * size;
            }
        }
        y + self.sizes.gap
    }

    fn entries(&self, index: usize) -> Vec<Entry<'_>> {
        let panel = self.prepared[index].panel;
        let series = panel
            .series
            .iter()
            .enumerate()
            .map(|(number, series)| Entry { name: &series.name, series: Some((series, self.look(number, series))) });
        let references = panel.references.iter().map(|reference| Entry { name: &reference.label, series: None });
        series.chain(references).filter(|entry| !entry.name.is_empty()).collect()
    }

    fn look(&self, number: usize, series: &Series) -> Look {
        let dashes = |pattern: usize| DASHES[pattern % DASHES.len()];
        match series.ink {
            SeriesInk::Own => {
                let count = self.inks.series.len();
                let colour = self.inks.series[number % count];
                Look { colour, dashes: dashes(number + number / count), marker: Some(number) }
            }
            SeriesInk::Scale { place, pattern } => {
                Look { colour: line_colour(self.theme, place), dashes: dashes(pattern), marker: None }
            }
            SeriesInk::Ink { pattern } => Look { colour: self.inks.ink, dashes: dashes(pattern), marker: None },
        }
    }

    /// Gives every panel its area.
    fn place(&self, frame: Area) -> Vec<Placed> {
        let Sizes { label, gap, rule, .. } = self.sizes;
        let setter = &self.canvas.typesetter;
        let text_width = |text: &str| setter.width(text, Weight::Regular, label);
        let tick_length = 0.8 * gap;
        let line = LINE_HEIGHT * label;
        let x_axis_height = tick_length + 0.6 * gap + CAPITAL_HEIGHT * label + gap + line;
        let shared_gap = 1.8 * gap;

        // Heights: all panels alike after the axes, rows of legends and multipliers have had theirs.
        let rows = |index: usize, y_ticks: &Ticks| {
            let lines = if self.legends_above { self.legend_rows(index, frame.width() * 0.8).len() } else { 0 };
            let lines = lines.max(usize::from(y_ticks.multiplier.is_some()));
            if lines > 0 { line * lines as f64 + 0.5 * gap } else { 0.5 * CAPITAL_HEIGHT * label }
        };
        let count = self.prepared.len() as f64;
        let y_count = |height: f64| ((height / (1.55 * label)) as usize).clamp(3, 9);
        let rough_height = frame.height() / count * 0.7;
        let rough: Vec<Ticks> =
            self.prepared.iter().map(|prepared| ticks(&prepared.y, y_count(rough_height))).collect();
        let below = |prepared: &Prepared<'_>| if prepared.shares_x_below { shared_gap } else { x_axis_height };
        let fixed: f64 = self
            .prepared
            .iter()
            .enumerate()
            .map(|(index, prepared)| below(prepared) + rows(index, &rough[index]))
            .sum();
        let height = ((frame.height() - fixed) / count).max(4.0);
        let y_ticks: Vec<Ticks> = self.prepared.iter().map(|prepared| ticks(&prepared.y, y_count(height))).collect();

        // Widths: one left edge for all panels.
        let widest =
            y_ticks.iter().flat_map(|ticks| &ticks.major).map(|(_, text)| text_width(text)).fold(0.0, f64::max);
        let label_size = self.y_label_size(height);
        let labels = self
            .prepared
            .iter()
            .map(|prepared| self.y_label_lines(prepared.panel, height, label_size).0.len() as f64)
            .fold(0.0, f64::max);
        let left = (frame.left + labels * line + 0.8 * gap + widest + 0.6 * gap + tick_length + rule)
            .min(frame.left + 0.6 * frame.width());
        let mut overhang: f64 = 0.0;
        let mut all = Vec::new();
        for prepared in &self.prepared {
            let width = frame.right - left;
            let mut wanted = ((width / (3.0 * label)) as usize).clamp(2, 10);
            let mut x_ticks = ticks(&prepared.x, wanted);
            if !prepared.panel.x.categories.is_empty() {
                let names = &prepared.panel.x.categories;
                let room = width / names.len() as f64 - 0.6 * label;
                let named =
                    names.iter().enumerate().map(|(place, name)| (place as f64, shortened(name, room, &text_width)));
                all.push(Ticks { major: named.collect(), ..Ticks::default() });
                continue;
            }
            // Labels of many digits need more room than the first guess gave them.
            while wanted > 1 {
                let widest = x_ticks.major.iter().map(|(_, text)| text_width(text)).fold(0.0, f64::max);
                if x_ticks.major.len() as f64 * (widest + 1.2 * label) <= width * 1.1 {
                    break;
                }
                wanted -= 1;
                x_ticks = ticks(&prepared.x, wanted);
            }
            for (value, text) in &x_ticks.major {
                let fraction = prepared.x.fraction(*value).unwrap_or(0.0);
                overhang = overhang.max(0.5 * text_width(text) - (1.0 - fraction) * width);
            }
            all.push(x_ticks);
        }
        let right = (frame.right - overhang.max(0.0)).max(left + 4.0);
        let mut y = frame.top;
        let mut placed = Vec::new();
        for (index, ((prepared, x_ticks), y_ticks)) in self.prepared.iter().zip(all).zip(y_ticks).enumerate() {
            let top = (y + rows(index, &rough[index])).round();
            let area = Area { left: left.round(), top, right: right.round(), bottom: (top + height).round() };
            y = area.bottom + below(prepared);
            placed.push(Placed { area, x: prepared.x, y: prepared.y, x_ticks, y_ticks });
        }
        placed
    }

    /// The label of the y axis in lines that fit beside a panel of this height, the unit preferably in its own.
    /// The label of the y axis in lines of a size, and whether all of it is there.
    fn y_label_lines(&self, panel: &Panel, height: f64, size: f64) -> (Vec<String>, bool) {
        let Sizes { label, gap, .. } = self.sizes;
        let setter = &self.canvas.typesetter;
        let text = panel.y.label.as_str();
        // Labels may reach into the row of the legend above the panel.
        let room = height + 2.0 * gap + if self.legends_above { LINE_HEIGHT * label } else { 0.0 };
        let fits = |text: &str| setter.width(text, Weight::Regular, size) <= room;
        if !fits(text)
            && let Some(unit) = text.rfind(" (")
            && fits(&text[unit + 1..])
        {
            let mut lines = setter.wrap(&text[..unit], Weight::Regular, size, room, 2);
            if lines.join(" ") == text[..unit] {
                lines.push(text[unit + 1..].to_owned());
                return (lines, true);
            }
        }
        let lines = setter.wrap(text, Weight::Regular, size, room, 3);
        let whole = lines.join(" ") == text;
        (lines, whole)
    }

    /// The largest size, of a few, at which the labels of the y axes of panels of a height are whole.
    fn y_label_size(&self, height: f64) -> f64 {
        let whole =
            |size: &f64| self.prepared.iter().all(|prepared| self.y_label_lines(prepared.panel, height, *size).1);
        let sizes = Y_LABEL_SIZES.map(|part| part * self.sizes.label);
        sizes.into_iter().find(whole).unwrap_or(sizes[sizes.len() - 1])
    }

    fn grid(&mut self, place: &Placed) {
        let area = place.area;
        let rule = 0.7 * self.sizes.rule;
        let grid = self.inks.grid;
        for (value, _) in &place.x_ticks.major {
            if let Some(x) = place.x_pixel(*value) {
                self.canvas.vertical_rule(x, area.top, area.bottom, rule, grid);
            }
        }
        for (value, _) in &place.y_ticks.major {
            if let Some(y) = place.y_pixel(*value) {
                self.canvas.horizontal_rule(area.left, area.right, y, rule, grid);
            }
        }
    }

    fn axes(&mut self, index: usize, place: &Placed) {
        let Sizes { label, gap, rule, .. } = self.sizes;
        let (area, ink) = (place.area, self.inks.ink);
        let style = self.text_style(ink);
        let half = 0.5 * rule;
        self.canvas.vertical_rule(area.left, area.top, area.bottom + half, rule, ink);
        self.canvas.horizontal_rule(area.left - half, area.right, area.bottom, rule, ink);
        let (long, short) = (0.8 * gap, 0.45 * gap);
        let labelled = !self.prepared[index].shares_x_below;
        let x_ticks = place.x_ticks.major.iter().map(|(value, text)| (*value, text.as_str(), long));
        for (value, text, length) in x_ticks.chain(place.x_ticks.minor.iter().map(|value| (*value, "", short))) {
            let Some(x) = place.x_pixel(value).filter(|x| *x >= area.left - 1.0 && *x <= area.right + 1.0) else {
                continue;
            };
            self.canvas.vertical_rule(x, area.bottom, area.bottom + length, rule, ink);
            if labelled {
                let baseline = area.bottom + long + 0.6 * gap + CAPITAL_HEIGHT * label;
                self.canvas.text(text, [x, baseline], Anchor::Middle, style);
            }
        }
        let y_ticks = place.y_ticks.major.iter().map(|(value, text)| (*value, text.as_str(), long));
        for (value, text, length) in y_ticks.chain(place.y_ticks.minor.iter().map(|value| (*value, "", short))) {
            let Some(y) = place.y_pixel(value).filter(|y| *y >= area.top - 1.0 && *y <= area.bottom + 1.0) else {
                continue;
            };
            self.canvas.horizontal_rule(area.left - length, area.left, y, rule, ink);
            self.canvas.text_centred(text, [area.left - long - 0.6 * gap, y], Anchor::End, style);
        }
        if let Some(multiplier) = &place.y_ticks.multiplier {
            self.canvas.text(multiplier, [area.left - long, area.top - 0.8 * gap], Anchor::Start, style);
        }
        if labelled {
            let baseline = area.bottom + long + 0.6 * gap + 2.0 * CAPITAL_HEIGHT * label + 1.2 * gap;
            let mut room = area.width();
            let mut centre = area.centre()[0];
            if let Some(multiplier) = &place.x_ticks.multiplier {
                self.canvas.text(multiplier, [area.right, baseline], Anchor::End, style);
                room -= self.canvas.typesetter.width(multiplier, Weight::Regular, label) + 2.0 * gap;
                centre = centre.min(area.left + 0.5 * room.max(0.0));
            }
            let text = &self.prepared[index].panel.x.label;
            let shortened = self.canvas.typesetter.shorten(text, Weight::Regular, label, room);
            let half_width = 0.5 * self.canvas.typesetter.width(&shortened, Weight::Regular, label);
            // Centred under the axis unless the power of ten at its end needs the place.
            let middle = area.centre()[0];
            let x = if middle + half_width <= area.left + room { middle } else { centre };
            self.canvas.text(&shortened, [x, baseline], Anchor::Middle, style);
        }
        if !self.prepared[index].has_data {
            let style = self.text_style(self.inks.muted);
            // Without data a reference is in the middle; between it and the next rule there is room.
            let below = if self.prepared[index].panel.references.is_empty() { 0.0 } else { 0.125 * area.height() };
            let [x, y] = area.centre();
            self.canvas.text_centred("no data", [x, y + below], Anchor::Middle, style);
        }
    }

    fn y_labels(&mut self, placed: &[Placed], margin: f64) {
        // All panels are of one height.
        let size = placed.first().map_or(self.sizes.label, |place| self.y_label_size(place.area.height()));
        let style = Type { size, ..self.text_style(self.inks.ink) };
        let line = LINE_HEIGHT * style.size;
        let most = placed
            .iter()
            .enumerate()
            .map(|(index, place)| self.y_label_lines(self.prepared[index].panel, place.area.height(), size).0.len())
            .max()
            .unwrap_or(0);
        for (index, place) in placed.iter().enumerate() {
            let (lines, _) = self.y_label_lines(self.prepared[index].panel, place.area.height(), size);
            let first = 0.5 * (most - lines.len()) as f64;
            for (number, text) in lines.iter().enumerate() {
                let baseline = margin + (first + number as f64) * line + CAPITAL_HEIGHT * style.size;
                self.canvas.text_upwards(text, [baseline, place.area.centre()[1]], Anchor::Middle, style);
            }
        }
    }

    /// Draws the data of a panel, clipped to it.
    fn series(&mut self, index: usize, place: &Placed) {
        let panel = self.prepared[index].panel;
        let rough = self.rough;
        self.canvas.clip(Some(place.area.grown(0.5 * self.sizes.rule)));
        for (number, series) in panel.series.iter().enumerate().rev() {
            let colour = self.look(number, series).colour;
            match (&series.errors, series.style) {
                (Some(errors), SeriesStyle::Band) => self.band(place, series, errors, colour),
                (Some(errors), _) => self.error_bars(place, series, errors, colour),
                (None, _) => {}
            }
        }
        let pieces: Vec<Vec<Run>> = panel
            .series
            .iter()
            .map(|series| runs(&series.points, |point| place.pixel(point)).iter().map(|run| thinned(run)).collect())
            .collect();
        // The first is solid: where lines coincide, the dashes of the others are seen on it.
        for (number, series) in panel.series.iter().enumerate() {
            let look = self.look(number, series);
            let width = if rough { 0.7 * self.sizes.line } else { self.sizes.line };
            let dashes = if rough && look.marker.is_some() { &[] } else { look.dashes };
            for run in pieces[number].iter().filter(|_| series.style != SeriesStyle::Markers) {
                self.stroke(run, place, dashes, look.colour, width);
            }
        }
        // Over the lines, or noise around a reference would hide it.
        for reference in &panel.references {
            if let Some(y) = place.y_pixel(reference.value) {
                let run = [[place.area.left, y], [place.area.right, y]];
                self.stroke(&run, place, REFERENCE_DASHES, self.inks.ink, 0.75 * self.sizes.line);
            }
        }
        // Those on the frame are whole, too.
        self.canvas.clip(None);
        for (number, series) in panel.series.iter().enumerate().rev() {
            let look = self.look(number, series);
            match series.style {
                SeriesStyle::Markers | SeriesStyle::LineMarkers => {
                    self.markers(pieces[number].iter().flatten().copied(), place, look, panel);
                }
                SeriesStyle::Line | SeriesStyle::Band if rough && panel.series.len() > 1 && look.marker.is_some() => {
                    self.sparse_markers(&pieces[number], place, look, panel.series.len());
                }
                SeriesStyle::Line | SeriesStyle::Band => {}
            }
        }
    }

    fn stroke(&mut self, run: &[[f64; 2]], place: &Placed, dashes: &[f64], colour: Colour, width: f64) {
        let lengths: Vec<f64> = dashes.iter().map(|length| length * width).collect();
        for (from, to) in segments(run, &place.area.grown(2.0 * width), &lengths) {
            // A point alone in its gap would vanish as a line without length.
            let width = if run.len() == 1 { 2.2 * width } else { width };
            self.canvas.line(from, to, width, colour);
        }
    }

    fn marker_radius(&self) -> f64 {
        2.6 * self.sizes.line
    }

    /// One marker; the paper-coloured rim keeps it apart from lines and neighbours.
    fn marker(&mut self, at: [f64; 2], radius: f64, look: Look) {
        // Angles in quarter turns of a circle; sizes give every shape about the same area.
        let shape = match look.marker.unwrap_or(0) % 6 {
            0 => None,
            1 => Some((4, 0.5, 1.2)),
            2 => Some((3, -1.0, 1.4)),
            3 => Some((4, 0.0, 1.25)),
            4 => Some((3, 1.0, 1.4)),
            _ => Some((5, -1.0, 1.2)),
        };
        let rim = 0.45 * self.sizes.line;
        match shape {
            None => {
                self.canvas.disc(at, radius + rim, self.inks.paper);
                self.canvas.disc(at, radius, look.colour);
            }
            Some((sides, quarter_turns, size)) => {
                let angle = quarter_turns * std::f64::consts::FRAC_PI_2;
                let corner = 1.0 / (std::f64::consts::PI / f64::from(sides)).cos();
                self.canvas.polygon(at, radius * size + rim * corner, sides, angle, self.inks.paper);
                self.canvas.polygon(at, radius * size, sides, angle, look.colour);
            }
        }
    }

    fn markers(&mut self, points: impl Iterator<Item = [f64; 2]>, place: &Placed, look: Look, panel: &Panel) {
        let count = panel.series.iter().map(|series| series.points.len()).max().unwrap_or(0) as f64;
        // Crowded markers shrink down to dots.
        let room = (place.area.width() * place.area.height() / count.max(1.0)).sqrt();
        let radius = self.marker_radius().min(0.3 * room).max(0.45 * self.sizes.line);
        let area = place.area.grown(0.5 * self.sizes.rule);
        for point in points.filter(|point| area.contains(*point)) {
            self.marker(point, radius, look);
        }
    }

    /// A few markers along a line too jagged for dashes to be seen; all of them if it has only few points.
    fn sparse_markers(&mut self, pieces: &[Run], place: &Placed, look: Look, series: usize) {
        let points: Vec<[f64; 2]> =
            pieces.iter().flatten().copied().filter(|point| place.area.contains(*point)).collect();
        if points.len() <= FEW_POINTS {
            for point in points {
                self.marker(point, self.marker_radius(), look);
            }
            return;
        }
        let count = 7;
        for index in 0..count {
            let shift = (look.marker.unwrap_or(0) as f64 + 0.5) / series as f64;
            let target = place.area.left + (f64::from(index) + shift) / f64::from(count) * place.area.width();
            let nearest = points.iter().min_by(|a, b| (a[0] - target).abs().total_cmp(&(b[0] - target).abs()));
            if let Some(point) = nearest.filter(|point| (point[0] - target).abs() < 0.05 * place.area.width()) {
                self.marker(*point, self.marker_radius(), look);
            }
        }
    }

    fn error_bars(&mut self, place: &Placed, series: &Series, errors: &[f64], colour: Colour) {
        let width = 0.6 * self.sizes.line;
        let cap = self.marker_radius() * 0.9;
        // Bars that would touch each other become a band.
        if series.points.len() as f64 * cap > place.area.width() {
            return self.band(place, series, errors, colour);
        }
        let area = place.area.grown(2.0 * cap);
        for (point, error) in series.points.iter().zip(errors) {
            let Some([low, high]) = place.bar(*point, *error) else { continue };
            if let Some((from, to)) = clipped(low, high, &area) {
                self.canvas.line(from, to, width, colour);
            }
            for end in [low, high].into_iter().filter(|end| area.contains(*end)) {
                self.canvas.line([end[0] - cap, end[1]], [end[0] + cap, end[1]], width, colour);
            }
        }
    }

    /// A shaded band, column by column of pixels, so that no seams show.
    fn band(&mut self, place: &Placed, series: &Series, errors: &[f64], colour: Colour) {
        let columns = place.area.width().ceil() as usize + 1;
        let mut spans = vec![None::<(f64, f64)>; columns];
        let mut cover = |column: f64, low: f64, high: f64| {
            if let Some(span) = spans.get_mut(column.max(0.0) as usize)
                && column >= 0.0
            {
                let (top, bottom) = span.unwrap_or((f64::INFINITY, f64::NEG_INFINITY));
                *span = Some((top.min(high), bottom.max(low)));
            }
        };
        let mut previous: Option<[[f64; 2]; 2]> = None;
        for (point, error) in series.points.iter().zip(errors) {
            let bar = place.bar(*point, *error);
            if let Some([low, high]) = bar {
                cover((low[0] - place.area.left).floor(), low[1], high[1]);
                if let Some([last_low, last_high]) = previous {
                    let step = low[0] - last_low[0];
                    let first = (last_low[0] - place.area.left).floor().max(-1.0) + 1.0;
                    let last = (low[0] - place.area.left).floor().min(columns as f64);
                    let mut column = first;
                    while column < last {
                        let t = ((place.area.left + column + 0.5 - last_low[0]) / step).clamp(0.0, 1.0);
                        cover(
                            column,
                            last_low[1] + t * (low[1] - last_low[1]),
                            last_high[1] + t * (high[1] - last_high[1]),
                        );
                        column += 1.0;
                    }
                }
            }
            previous = bar;
        }
        let area = place.area.grown(4.0);
        for (column, span) in spans.iter().enumerate() {
            if let Some((top, bottom)) = span {
                let left = place.area.left + column as f64;
                let top = top.max(area.top);
                let bottom = bottom.min(area.bottom);
                if bottom > top {
                    self.canvas.rectangle(Area { left, top, right: left + 1.0, bottom }, with_alpha(colour, 64));
                }
            }
        }
    }

    fn sample_width(&self) -> f64 {
        5.2 * self.sizes.gap
    }

    fn entry_width(&self, entry: &Entry<'_>) -> f64 {
        let text = self.canvas.typesetter.width(entry.name, Weight::Regular, self.sizes.label);
        self.sample_width() + 0.7 * self.sizes.gap + text
    }

    fn legend_line(&self) -> f64 {
        1.25 * self.sizes.label
    }

    /// The emptiest place inside a panel that its legend fits into without touching data; corners are preferred.
    fn legend_spot(&self, index: usize, place: &Placed) -> Option<Area> {
        let entries = self.entries(index);
        if entries.len() < 2 {
            return None;
        }
        let gap = self.sizes.gap;
        let width = entries.iter().map(|entry| self.entry_width(entry)).fold(0.0, f64::max) + 1.6 * gap;
        let height = entries.len() as f64 * self.legend_line() + gap;
        let inner = place.area.grown(-0.6 * gap);
        if width > 0.6 * inner.width() || height > 0.75 * inner.height() {
            return None;
        }
        let obstacles = self.obstacles(index, place);
        let columns = [1.0, 0.0, 0.5, 0.75, 0.25];
        let rows = [0.0, 1.0, 0.5, 0.25, 0.75, 0.125, 0.375, 0.625, 0.875];
        for row in rows {
            for column in columns {
                let left = inner.left + column * (inner.width() - width);
                let top = inner.top + row * (inner.height() - height);
                let spot = Area { left, top, right: left + width, bottom: top + height };
                let kept_clear = spot.grown(0.4 * gap);
                if !obstacles.iter().any(|(from, to)| clipped(*from, *to, &kept_clear).is_some()) {
                    return Some(spot);
                }
            }
        }
        None
    }

    /// Everything a legend must not cover, as segments.
    fn obstacles(&self, index: usize, place: &Placed) -> Vec<([f64; 2], [f64; 2])> {
        let panel = self.prepared[index].panel;
        let mut obstacles = Vec::new();
        for series in &panel.series {
            for run in runs(&series.points, |point| place.pixel(point)) {
                let run = thinned(&run);
                if series.style == SeriesStyle::Markers {
                    obstacles.extend(run.iter().map(|point| (*point, *point)));
                } else {
                    obstacles.extend(segments(&run, &place.area, &[]));
                }
            }
            for (point, error) in series.points.iter().zip(series.errors.iter().flatten()) {
                obstacles.extend(place.bar(*point, *error).map(|[low, high]| (low, high)));
            }
        }
        let references = panel.references.iter().filter_map(|reference| place.y_pixel(reference.value));
        obstacles.extend(references.map(|y| ([place.area.left, y], [place.area.right, y])));
        obstacles
    }

    fn legend_inside(&mut self, index: usize, spot: Area) {
        let gap = self.sizes.gap;
        self.canvas.rectangle(spot, with_alpha(self.inks.paper, 215));
        for number in 0..self.entries(index).len() {
            let y = spot.top + 0.5 * gap + (number as f64 + 0.5) * self.legend_line();
            self.legend_entry(index, number, [spot.left + 0.8 * gap, y]);
        }
    }

    /// How many entries go into each row of a legend of this width.
    fn legend_rows(&self, index: usize, width: f64) -> Vec<usize> {
        let entries = self.entries(index);
        let mut rows = Vec::new();
        if entries.len() < 2 {
            return rows;
        }
        let mut used = f64::INFINITY;
        for entry in &entries {
            let needed = self.entry_width(entry) + 2.0 * self.sizes.gap;
            if used + needed > width {
                rows.push(0);
                used = 0.0;
            }
            used += needed;
            if let Some(last) = rows.last_mut() {
                *last += 1;
            }
        }
        rows
    }

    fn legend_above(&mut self, index: usize, area: Area) {
        let Sizes { label, gap, .. } = self.sizes;
        let rows = self.legend_rows(index, (f64::from(self.canvas.width) - 3.2 * gap) * 0.8);
        let mut number = 0;
        for (row, count) in rows.iter().enumerate() {
            let widths: Vec<f64> =
                self.entries(index)[number..number + count].iter().map(|entry| self.entry_width(entry)).collect();
            let total = widths.iter().sum::<f64>() + 2.0 * gap * (count.saturating_sub(1)) as f64;
            let from_below = (rows.len() - row) as f64 - 0.5;
            let y = area.top - from_below * LINE_HEIGHT * label - 0.2 * gap;
            let mut x = area.right - total;
            for width in widths {
                self.legend_entry(index, number, [x, y]);
                x += width + 2.0 * gap;
                number += 1;
            }
        }
    }

    /// A sample of the line and its name; `at` is the middle of the left edge.
    fn legend_entry(&mut self, index: usize, number: usize, at: [f64; 2]) {
        let panel = self.prepared[index].panel;
        let (name, sample) = {
            let entries = self.entries(index);
            (entries[number].name.to_owned(), entries[number].series.map(|(series, look)| (series.style, look)))
        };
        let width = self.sample_width();
        let middle = [at[0] + 0.5 * width, at[1]];
        let run = [at, [at[0] + width, at[1]]];
        let around = Placed::empty(Area { left: at[0], top: at[1], right: at[0] + width, bottom: at[1] });
        let rough = self.rough;
        match sample {
            None => self.stroke(&run, &around, REFERENCE_DASHES, self.inks.ink, 0.75 * self.sizes.line),
            Some((style, look)) => {
                if style == SeriesStyle::Band {
                    let height = 1.1 * self.sizes.gap;
                    let band = Area { left: at[0], top: at[1] - height, right: at[0] + width, bottom: at[1] + height };
                    self.canvas.rectangle(band, with_alpha(look.colour, 64));
                }
                if style != SeriesStyle::Markers {
                    let dashes = if rough && look.marker.is_some() { &[] } else { look.dashes };
                    self.stroke(&run, &around, dashes, look.colour, self.sizes.line);
                }
                let marked = matches!(style, SeriesStyle::Markers | SeriesStyle::LineMarkers);
                if marked || (rough && panel.series.len() > 1 && look.marker.is_some()) {
                    self.marker(middle, self.marker_radius(), look);
                }
            }
        }
        let style = self.text_style(self.inks.ink);
        let x = at[0] + width + 0.7 * self.sizes.gap;
        self.canvas.text_centred(&name, [x, at[1]], Anchor::Start, style);
    }
}

/// A name cut to a width, with an ellipsis where something is missing.
fn shortened(name: &str, room: f64, width: &dyn Fn(&str) -> f64) -> String {
    if width(name) <= room {
        return name.to_owned();
    }
    let mut kept: String = name.to_owned();
    while kept.pop().is_some() {
        let text = format!("{}…", kept.trim_end());
        if width(&text) <= room {
            return text;
        }
    }
    String::new()
}

/// Whether a line of the panel goes up and down so much that dashes could not be told from noise.
fn is_rough(panel: &Panel, place: &Placed) -> bool {
    panel.series.iter().filter(|series| series.style != SeriesStyle::Markers).any(|series| {
        let pieces = runs(&series.points, |point| place.pixel(point));
        let drawn: f64 = pieces.iter().map(|run| length(&thinned(run), &place.area)).sum();
        drawn > 2.5 * (place.area.width() + place.area.height())
    })
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, clippy::expect_used)]
    use super::*;
    use crate::noise;
    use crate::plot::ReferenceLine;
    use std::sync::mpsc::channel;
    use std::time::Duration;

    /// What a table that was written by hand, or a quantity without a scale, may put into a chart.
    const DEGENERATE: [f64; 14] = [
        f64::NAN,
        f64::INFINITY,
        f64::NEG_INFINITY,
        0.0,
        -0.0,
        5e-324,
        1e-310,
        -1e-300,
        1.0,
        1.0 + f64::EPSILON,
        -3.0,
        1e300,
        f64::MAX,
        -f64::MAX,
    ];

    fn degenerate_chart(seed: u64) -> Chart {
        let mut drawn = 0;
        let mut below = |limit: usize| {
            drawn += 1;
            noise::step_key(seed, 99, drawn)[0] as usize % limit
        };
        let mut chart = Chart::default();
        for _ in 0..=below(3) {
            let mut panel = Panel::new("x", "y");
            for axis in [&mut panel.x, &mut panel.y] {
                axis.scale = if below(2) == 0 { Scale::Linear } else { Scale::Log };
                axis.range = (below(2) == 0).then(|| [DEGENERATE[below(14)], DEGENERATE[below(14)]]);
            }
            for _ in 0..below(3) {
                let points: Vec<[f64; 2]> = (0..below(7)).map(|_| [0, 1].map(|_| DEGENERATE[below(14)])).collect();
                let errors = (below(2) == 0).then(|| points.iter().map(|_| DEGENERATE[below(14)]).collect());
                let style = [SeriesStyle::Line, SeriesStyle::Markers, SeriesStyle::LineMarkers, SeriesStyle::Band];
                let style = style[below(4)];
                panel.series.push(Series { errors, style, ..Series::line("s", points) });
            }
            let references =
                (0..below(2)).map(|_| ReferenceLine { label: "r".to_owned(), value: DEGENERATE[below(14)] });
            panel.references.extend(references);
            chart.panels.push(panel);
        }
        chart
    }

    #[test]
    fn every_chart_is_laid_out_in_the_end() {
        let (done, laid_out) = channel();
        std::thread::spawn(move || {
            for seed in 0..400 {
                let chart = degenerate_chart(seed);
                let result = lay_out(&chart, &PlotStyle::default()).map(|_| ()).map_err(|error| error.to_string());
                done.send((seed, result)).unwrap();
            }
        });
        for expected in 0..400 {
            let (seed, result) = laid_out.recv_timeout(Duration::from_mins(1)).expect("a chart never ends");
            assert_eq!((seed, result), (expected, Ok(())));
        }
    }
}
