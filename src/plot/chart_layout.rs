//! Lays a chart out: headings, and the places of panels, ticks and legends.

use super::axis_range::{Prepared, prepare};
use super::canvas::{Anchor, Area, Canvas, Type};
use super::chart::{Chart, SeriesStyle};
use super::error::PlotError;
use super::palette::Colour;
use super::series_path::{length, runs, thinned};
use super::text::{CAPITAL_HEIGHT, LINE_HEIGHT, Weight};
use super::ticks::{AxisMap, Ticks, ticks, ticks_along};
use crate::numbers::grouped;
use crate::scene::PlotStyle;

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
        let natural = (f64::from(style.width) / 1600.0).min(f64::from(style.height()) / 900.0);
        // Type never grows so large that it leaves the data no room.
        let largest_label = (f64::from(style.height()) / (9 + 5 * panels) as f64).min(f64::from(style.width) / 24.0);
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

/// The area of a panel's data and its ticks.
pub(super) struct Placed {
    pub area: Area,
    pub x: AxisMap,
    pub y: AxisMap,
    pub x_ticks: Ticks,
    pub y_ticks: Ticks,
}

impl Placed {
    /// An area without a coordinate system.
    pub(super) fn empty(area: Area) -> Self {
        let unit = AxisMap::linear(0.0, 1.0);
        Self { area, x: unit, y: unit, x_ticks: Ticks::default(), y_ticks: Ticks::default() }
    }

    pub(super) fn x_pixel(&self, value: f64) -> Option<f64> {
        self.x.fraction(value).map(|fraction| self.area.left + fraction * self.area.width())
    }

    pub(super) fn y_pixel(&self, value: f64) -> Option<f64> {
        self.y.fraction(value).map(|fraction| self.area.bottom - fraction * self.area.height())
    }

    pub(super) fn pixel(&self, point: [f64; 2]) -> Option<[f64; 2]> {
        Some([self.x_pixel(point[0])?, self.y_pixel(point[1])?])
    }

    /// Both ends of an error bar; on a logarithmic axis a bar that reaches zero ends at the foot of the panel.
    pub(super) fn bar(&self, point: [f64; 2], error: f64) -> Option<[[f64; 2]; 2]> {
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
    let mut layout = Layout {
        canvas: Canvas::new(style.width, style.height(), style.theme)?,
        sizes: Sizes::new(style, chart.panels.len()),
        prepared: prepare(&chart.panels),
        rough: false,
        legends_above: false,
    };
    layout.draw(chart);
    Ok(layout.canvas)
}

pub(super) struct Layout<'a> {
    pub(super) canvas: Canvas,
    pub(super) sizes: Sizes,
    pub(super) prepared: Vec<Prepared<'a>>,
    /// Lines of the chart are too jagged for dashes; known once the panels have their places.
    pub(super) rough: bool,
    pub(super) legends_above: bool,
}
impl Layout<'_> {
    pub(super) fn text_style(&self, colour: Colour) -> Type {
        Type { size: self.sizes.label, weight: Weight::Regular, colour }
    }

    fn draw(&mut self, chart: &Chart) {
        let margin = 1.6 * self.sizes.gap;
        let top = self.headings(chart, margin);
        let (width, height) = (f64::from(self.canvas.width), f64::from(self.canvas.height));
        let frame = Area { left: margin, top, right: width - margin, bottom: height - margin };
        if self.prepared.is_empty() {
            let style = self.text_style(self.canvas.inks.muted);
            self.canvas.text_centred("no data", frame.centre(), Anchor::Middle, style);
            return;
        }
        // A legend stands inside a panel if all panels have room for theirs, else all stand above their panels.
        let mut placed = self.place(frame);
        let mut corners: Vec<Option<Area>> =
            (0..self.prepared.len()).map(|index| self.legend_spot(index, &placed[index])).collect();
        let above = (0..self.prepared.len()).any(|index| !self.entries(index).is_empty() && corners[index].is_none());
        if above {
            self.legends_above = true;
            placed = self.place(frame);
            corners = vec![None; self.prepared.len()];
        }
        self.rough = placed.iter().zip(&self.prepared).any(|(place, prepared)| is_rough(prepared.panel, place));
        for (index, place) in placed.iter().enumerate() {
            self.equilibration(index, place);
            self.grid(place);
            self.series(index, place);
            self.axes(index, place);
            self.point_labels(index, place, corners[index]);
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
        let mut notes = vec![chart.subtitle.clone()];
        let left_out: usize = self.prepared.iter().map(|prepared| prepared.left_out).sum();
        if left_out > 0 {
            let (count, plural) = (grouped(left_out as u64), if left_out == 1 { "value" } else { "values" });
            notes.push(format!("{count} {plural} ≤ 0 left out of a logarithmic axis"));
        }
        let beyond: Vec<String> = self.prepared.iter().filter_map(Prepared::beyond_note).collect();
        if !beyond.is_empty() {
            notes.push(format!("off the scale: {}", beyond.join(", ")));
        }
        let Sizes { title, label, gap, .. } = self.sizes;
        let width = f64::from(self.canvas.width) - 2.0 * margin;
        let headings = self.canvas.headings(&chart.title, notes, [title, label], 3, width);
        self.canvas.write_headings(&headings, [margin; 2]) + gap
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
        let named = |names: &[String], room: f64| {
            let shortened = names.iter().map(|name| setter.shorten(name, Weight::Regular, label, room));
            // Where there is no room for an ellipsis either, there is no name.
            let shown = shortened.map(|name| if text_width(&name) <= room { name } else { String::new() });
            Ticks { major: shown.enumerate().map(|(at, name)| (at as f64, name)).collect(), ..Ticks::default() }
        };
        let of_y = |prepared: &Prepared<'_>| match prepared.panel.y.categories.as_slice() {
            [] => ticks(&prepared.y, y_count(height)),
            names => named(names, 0.3 * frame.width()),
        };
        let y_ticks: Vec<Ticks> = self.prepared.iter().map(of_y).collect();

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
            if !prepared.panel.x.categories.is_empty() {
                let names = &prepared.panel.x.categories;
                let room = width / names.len() as f64 - 0.6 * label;
                all.push(named(names, room));
                continue;
            }
            let x_ticks = ticks_along(&prepared.x, width, label, 1, text_width);
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
}

/// Whether a line of the panel goes up and down so much that dashes could not be distinguished from noise.
fn is_rough(panel: &super::chart::Panel, place: &Placed) -> bool {
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
    use crate::plot::{AxisFit, Mean, Panel, ReferenceLine, Series};
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
                let mean = Mean { value: DEGENERATE[below(14)], ..Mean::default() };
                let mean = (below(2) == 0).then_some(mean);
                panel.series.push(Series { errors, style, mean, ..Series::line("s", points) });
            }
            let references =
                (0..below(2)).map(|_| ReferenceLine { label: "r".to_owned(), value: DEGENERATE[below(14)] });
            panel.references.extend(references);
            panel.averaged_from = (below(2) == 0).then(|| DEGENERATE[below(14)]);
            panel.y.fit = if below(2) == 0 { AxisFit::All } else { AxisFit::Settled };
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
