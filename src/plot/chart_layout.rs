//! Lays a chart out: headings, and the places of panels, ticks and legends.

use super::axis_range::{Prepared, prepare};
use super::canvas::{Anchor, Area, Canvas, Type};
use super::chart::{Chart, Panel, Series, SeriesStyle};
use super::error::PlotError;
use super::palette::Colour;
use super::series_path::{Run, length, runs, thinned};
use super::text::{CAPITAL_HEIGHT, LINE_HEIGHT, Weight};
use super::ticks::{Ticks, ticks, ticks_along};
use crate::numbers::counted_in_groups;
use crate::scene::{Headings, PlotStyle};

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

/// A panel with the area of its data and its ticks.
pub(super) struct Placed<'a> {
    pub prepared: Prepared<'a>,
    pub area: Area,
    pub x_ticks: Ticks,
    pub y_ticks: Ticks,
}

impl Placed<'_> {
    pub(super) fn x_pixel(&self, value: f64) -> Option<f64> {
        self.prepared.x.fraction(value).map(|fraction| self.area.left + fraction * self.area.width())
    }

    pub(super) fn y_pixel(&self, value: f64) -> Option<f64> {
        self.prepared.y.fraction(value).map(|fraction| self.area.bottom - fraction * self.area.height())
    }

    pub(super) fn pixel(&self, point: [f64; 2]) -> Option<[f64; 2]> {
        Some([self.x_pixel(point[0])?, self.y_pixel(point[1])?])
    }

    /// The connected pieces of a series, in pixels.
    pub(super) fn pieces(&self, series: &Series) -> Vec<Run> {
        runs(&series.points, |point| self.pixel(point)).iter().map(|run| thinned(run)).collect()
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
    let chart = &in_style(chart, style);
    let mut layout = Layout {
        canvas: Canvas::new(style.width, style.height(), style.theme)?,
        sizes: Sizes::new(style, chart.panels.len()),
        rough: false,
        legends_above: false,
    };
    layout.draw(chart, &prepare(&chart.panels));
    Ok(layout.canvas)
}

/// A chart with the headings and the names of units that a style asks for.
fn in_style(chart: &Chart, style: &PlotStyle) -> Chart {
    let mut chart = chart.clone();
    match style.headings {
        Headings::All => {}
        Headings::Conditions => chart.title.clear(),
        Headings::None => (chart.title, chart.subtitle) = Default::default(),
    }
    if !style.units.are_usual() {
        let named = |label: &mut String| *label = style.units.in_label(label);
        named(&mut chart.subtitle);
        for panel in &mut chart.panels {
            [&mut panel.x.label, &mut panel.y.label].into_iter().for_each(named);
            panel.series.iter_mut().map(|series| &mut series.name).for_each(named);
            panel.references.iter_mut().map(|reference| &mut reference.label).for_each(named);
        }
    }
    chart
}

pub(super) struct Layout {
    pub(super) canvas: Canvas,
    pub(super) sizes: Sizes,
    /// Lines of the chart are too jagged for dashes; known once the panels have their places.
    pub(super) rough: bool,
    pub(super) legends_above: bool,
}

impl Layout {
    pub(super) fn text_style(&self, colour: Colour) -> Type {
        Type { size: self.sizes.label, weight: Weight::Regular, colour }
    }

    fn draw(&mut self, chart: &Chart, prepared: &[Prepared<'_>]) {
        let margin = 1.6 * self.sizes.gap;
        let top = self.headings(chart, prepared, margin);
        let (width, height) = (f64::from(self.canvas.width), f64::from(self.canvas.height));
        let frame = Area { left: margin, top, right: width - margin, bottom: height - margin };
        if prepared.is_empty() {
            let style = self.text_style(self.canvas.inks.muted);
            self.canvas.text_centred("no data", frame.centre(), Anchor::Middle, style);
            return;
        }
        // A legend stands inside a panel if all panels have room for theirs, else all stand above their panels.
        let mut placed = self.place(prepared, frame);
        let mut corners: Vec<Option<Area>> = placed.iter().map(|place| self.legend_spot(place)).collect();
        let without_room = |(place, corner): (&Placed<'_>, &Option<Area>)| {
            corner.is_none() && !self.entries(place.prepared.panel).is_empty()
        };
        if placed.iter().zip(&corners).any(without_room) {
            self.legends_above = true;
            placed = self.place(prepared, frame);
            corners = vec![None; placed.len()];
        }
        self.rough = placed.iter().any(is_rough);
        for (place, corner) in placed.iter().zip(corners) {
            self.equilibration(place);
            self.grid(place);
            self.series(place);
            self.axes(place);
            self.point_labels(place, corner);
            if let Some(corner) = corner {
                self.legend_inside(place.prepared.panel, corner);
            } else if self.legends_above {
                self.legend_above(place);
            }
        }
        self.y_labels(&placed, margin);
    }

    /// Title and subtitle; returns where the panels may start.
    fn headings(&mut self, chart: &Chart, prepared: &[Prepared<'_>], margin: f64) -> f64 {
        let mut notes = vec![chart.subtitle.clone()];
        let left_out: usize = prepared.iter().map(|prepared| prepared.left_out).sum();
        if left_out > 0 {
            let values = counted_in_groups(left_out as u64, "value");
            notes.push(format!("{values} ≤ 0 left out of a logarithmic axis"));
        }
        let beyond: Vec<String> = prepared.iter().filter_map(Prepared::beyond_note).collect();
        if !beyond.is_empty() {
            notes.push(format!("off the scale: {}", beyond.join(", ")));
        }
        let Sizes { title, label, gap, .. } = self.sizes;
        let width = f64::from(self.canvas.width) - 2.0 * margin;
        let headings = self.canvas.headings(&chart.title, notes, [title, label], 3, width);
        self.canvas.write_headings(&headings, [margin; 2]) + gap
    }

    /// Gives every panel its area.
    fn place<'p>(&self, prepared: &[Prepared<'p>], frame: Area) -> Vec<Placed<'p>> {
        let Sizes { label, gap, rule, .. } = self.sizes;
        let setter = &self.canvas.typesetter;
        let text_width = |text: &str| setter.width(text, Weight::Regular, label);
        let tick_length = 0.8 * gap;
        let line = LINE_HEIGHT * label;
        let x_axis_height = tick_length + 0.6 * gap + CAPITAL_HEIGHT * label + gap + line;
        let shared_gap = 1.8 * gap;

        // Heights: all panels alike after the axes, rows of legends and multipliers have had theirs.
        let count = prepared.len() as f64;
        let y_count = |height: f64| ((height / (1.55 * label)) as usize).clamp(3, 9);
        let rough_count = y_count(frame.height() / count * 0.7);
        let above = |prepared: &Prepared<'_>| {
            let legend =
                if self.legends_above { self.legend_rows(prepared.panel, frame.width() * 0.8).len() } else { 0 };
            let lines = legend.max(usize::from(ticks(&prepared.y, rough_count).multiplier.is_some()));
            if lines > 0 { line * lines as f64 + 0.5 * gap } else { 0.5 * CAPITAL_HEIGHT * label }
        };
        let below = |prepared: &Prepared<'_>| if prepared.shares_x_below { shared_gap } else { x_axis_height };
        let fixed: f64 = prepared.iter().map(|prepared| below(prepared) + above(prepared)).sum();
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
        let y_ticks: Vec<Ticks> = prepared.iter().map(of_y).collect();

        // Widths: one left edge for all panels.
        let texts = y_ticks.iter().flat_map(|ticks| &ticks.major);
        let widest = texts.map(|(_, text)| text_width(text)).fold(0.0, f64::max);
        let panels: Vec<&Panel> = prepared.iter().map(|prepared| prepared.panel).collect();
        let label_size = self.y_label_size(&panels, height);
        let labels =
            panels.iter().map(|panel| self.y_label_lines(panel, height, label_size).0.len()).max().unwrap_or(0);
        let left = (frame.left + labels as f64 * line + 0.8 * gap + widest + 0.6 * gap + tick_length + rule)
            .min(frame.left + 0.6 * frame.width());
        let width = frame.right - left;
        let mut overhang: f64 = 0.0;
        let of_x = |prepared: &Prepared<'_>| match prepared.panel.x.categories.as_slice() {
            [] => {
                let ticks = ticks_along(&prepared.x, width, label, 1, text_width);
                for (value, text) in &ticks.major {
                    let fraction = prepared.x.fraction(*value).unwrap_or(0.0);
                    overhang = overhang.max(0.5 * text_width(text) - (1.0 - fraction) * width);
                }
                ticks
            }
            names => named(names, width / names.len() as f64 - 0.6 * label),
        };
        let x_ticks: Vec<Ticks> = prepared.iter().map(of_x).collect();
        let right = (frame.right - overhang.max(0.0)).max(left + 4.0);
        let mut y = frame.top;
        let mut placed = Vec::new();
        for ((prepared, x_ticks), y_ticks) in prepared.iter().zip(x_ticks).zip(y_ticks) {
            let top = (y + above(prepared)).round();
            let area = Area { left: left.round(), top, right: right.round(), bottom: (top + height).round() };
            y = area.bottom + below(prepared);
            placed.push(Placed { prepared: *prepared, area, x_ticks, y_ticks });
        }
        placed
    }
}

/// Whether a line of the panel goes up and down so much that dashes could not be distinguished from noise.
fn is_rough(place: &Placed<'_>) -> bool {
    place
        .prepared
        .panel
        .series
        .iter()
        .filter(|series| !matches!(series.style, SeriesStyle::Markers | SeriesStyle::Thin))
        .any(|series| {
            let drawn: f64 = place.pieces(series).iter().map(|run| length(run, &place.area)).sum();
            drawn > 2.5 * (place.area.width() + place.area.height())
        })
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, clippy::expect_used)]
    use super::super::chart::Scale;
    use super::*;
    use crate::noise;
    use crate::plot::{AxisFit, Mean, ReferenceLine};
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
