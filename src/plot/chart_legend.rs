//! Places and draws the legends of panels.

use super::canvas::{Anchor, Area};
use super::chart::{Panel, Series, SeriesStyle};
use super::chart_layout::{Layout, Placed, Sizes};
use super::palette::with_alpha;
use super::series_look::{Look, look, reference_look};
use super::series_path::{clipped, segments};
use super::text::{LINE_HEIGHT, Weight, in_rows};

/// One line of a legend.
pub(super) struct Entry {
    text: String,
    /// How the points are drawn; a reference has none.
    style: Option<SeriesStyle>,
    look: Look,
}

/// The name of a series, with its mean.
fn entry_text(series: &Series) -> String {
    match series.mean {
        Some(mean) => format!("{} {mean}", series.name).trim_start().to_owned(),
        None => series.name.clone(),
    }
}

impl Layout {
    /// The legend of a panel, which may need none.
    pub(super) fn entries(&self, panel: &Panel) -> Vec<Entry> {
        let series = panel.series.iter().enumerate().map(|(number, series)| Entry {
            text: entry_text(series),
            style: Some(series.style),
            look: look(number, series, &self.canvas.inks),
        });
        let references = panel.references.iter().enumerate().map(|(number, reference)| Entry {
            text: reference.label.clone(),
            style: None,
            look: reference_look(number, panel, &self.canvas.inks),
        });
        let entries: Vec<Entry> = series.chain(references).filter(|entry| !entry.text.is_empty()).collect();
        // A legend of one entry says no more than the axis, unless it holds a mean.
        let means = panel.series.iter().any(|series| series.mean.is_some());
        if entries.len() > usize::from(!means) { entries } else { Vec::new() }
    }

    fn sample_width(&self) -> f64 {
        5.2 * self.sizes.gap
    }

    fn entry_width(&self, entry: &Entry) -> f64 {
        let text = self.canvas.typesetter.width(&entry.text, Weight::Regular, self.sizes.label);
        self.sample_width() + 0.7 * self.sizes.gap + text
    }

    fn legend_line(&self) -> f64 {
        1.25 * self.sizes.label
    }

    /// The emptiest place inside a panel that its legend fits into without touching data; corners are preferred.
    pub(super) fn legend_spot(&self, place: &Placed<'_>) -> Option<Area> {
        let entries = self.entries(place.prepared.panel);
        if entries.is_empty() {
            return None;
        }
        let gap = self.sizes.gap;
        let width = entries.iter().map(|entry| self.entry_width(entry)).fold(0.0, f64::max) + 1.6 * gap;
        let height = entries.len() as f64 * self.legend_line() + gap;
        let inner = place.area.grown(-0.6 * gap);
        if width > 0.6 * inner.width() || height > 0.75 * inner.height() {
            return None;
        }
        let obstacles = obstacles(place);
        let columns = [1.0, 0.0, 0.5, 0.75, 0.25];
        let rows = [0.0, 1.0, 0.5, 0.25, 0.75, 0.125, 0.375, 0.625, 0.875];
        let spot = |[column, row]: [f64; 2]| {
            let left = inner.left + column * (inner.width() - width);
            let top = inner.top + row * (inner.height() - height);
            Area { left, top, right: left + width, bottom: top + height }
        };
        let is_clear = |spot: &Area| {
            let kept_clear = spot.grown(0.4 * gap);
            !obstacles.iter().any(|(from, to)| clipped(*from, *to, &kept_clear).is_some())
        };
        rows.into_iter().flat_map(|row| columns.map(|column| [column, row])).map(spot).find(is_clear)
    }

    pub(super) fn legend_inside(&mut self, panel: &Panel, spot: Area) {
        let gap = self.sizes.gap;
        self.canvas.rectangle(spot, with_alpha(self.canvas.inks.paper, 215));
        for (number, entry) in self.entries(panel).into_iter().enumerate() {
            let y = spot.top + 0.5 * gap + (number as f64 + 0.5) * self.legend_line();
            self.legend_entry(panel, entry, [spot.left + 0.8 * gap, y]);
        }
    }

    /// The entries of a legend, in rows of this width, with what each takes of it.
    pub(super) fn legend_rows(&self, panel: &Panel, width: f64) -> Vec<Vec<(Entry, f64)>> {
        let needed = |entry: Entry| {
            let width = self.entry_width(&entry) + 2.0 * self.sizes.gap;
            (entry, width)
        };
        in_rows(self.entries(panel).into_iter().map(needed), |_| width)
    }

    pub(super) fn legend_above(&mut self, place: &Placed<'_>) {
        let Sizes { label, gap, .. } = self.sizes;
        let (panel, area) = (place.prepared.panel, place.area);
        let rows = self.legend_rows(panel, (f64::from(self.canvas.width) - 3.2 * gap) * 0.8);
        for (from_below, entries) in rows.into_iter().rev().enumerate() {
            let total = entries.iter().map(|(_, width)| width).sum::<f64>() - 2.0 * gap;
            let y = area.top - (from_below as f64 + 0.5) * LINE_HEIGHT * label - 0.2 * gap;
            let mut x = area.right - total;
            for (entry, width) in entries {
                self.legend_entry(panel, entry, [x, y]);
                x += width;
            }
        }
    }

    /// A sample of the line and its name; `at` is the middle of the left edge.
    fn legend_entry(&mut self, panel: &Panel, Entry { text, style, look }: Entry, at: [f64; 2]) {
        let several = panel.series.len() > 1;
        let width = self.sample_width();
        let middle = [at[0] + 0.5 * width, at[1]];
        let run = [at, [at[0] + width, at[1]]];
        let around = Area { left: at[0], top: at[1], right: at[0] + width, bottom: at[1] };
        let rough = self.rough;
        match style {
            None => self.stroke(&run, around, look.dashes, look.colour, 0.75 * self.sizes.line),
            Some(style) => {
                if style == SeriesStyle::Band {
                    let height = 1.1 * self.sizes.gap;
                    let band = Area { left: at[0], top: at[1] - height, right: at[0] + width, bottom: at[1] + height };
                    self.canvas.rectangle(band, with_alpha(look.colour, 64));
                }
                if style != SeriesStyle::Markers {
                    let dashes = if rough && look.marker.is_some() { &[] } else { look.dashes };
                    self.stroke(&run, around, dashes, look.colour, self.sizes.line);
                }
                let marked = matches!(style, SeriesStyle::Markers | SeriesStyle::LineMarkers);
                if marked || (rough && several && look.marker.is_some()) {
                    self.marker(middle, self.marker_radius(), look);
                }
            }
        }
        let style = self.text_style(self.canvas.inks.ink);
        let x = at[0] + width + 0.7 * self.sizes.gap;
        self.canvas.text_centred(&text, [x, at[1]], Anchor::Start, style);
    }
}

/// Everything a legend must not cover, as segments.
pub(super) fn obstacles(place: &Placed<'_>) -> Vec<([f64; 2], [f64; 2])> {
    let panel = place.prepared.panel;
    let mut obstacles = Vec::new();
    for series in &panel.series {
        for run in place.pieces(series) {
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
    let means = panel.series.iter().filter_map(|series| series.mean).map(|mean| mean.value);
    let references = panel.references.iter().map(|reference| reference.value).chain(means);
    let references = references.filter_map(|value| place.y_pixel(value));
    obstacles.extend(references.map(|y| ([place.area.left, y], [place.area.right, y])));
    obstacles
}
