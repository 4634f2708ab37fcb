//! Draws the data of a panel: lines, markers, error bars, bands, means and references.

use super::axis_range::Prepared;
use super::canvas::Area;
use super::chart::{Mean, Panel, Series, SeriesStyle};
use super::chart_layout::{Layout, Placed};
use super::coincidence::covered_by;
use super::palette::{Colour, with_alpha};
use super::series_look::{Look, MARKERS, look, reference_look};
use super::series_path::{Run, clipped, segments};

/// Up to this many points of a line are marked one by one.
const FEW_POINTS: usize = 30;
/// What a line or a marker gains in width for each that covers it.
const LINE_GAIN: f64 = 1.0;
const MARKER_GAIN: f64 = 0.55;
/// How much a thin line covers, of 255.
const THIN_OPACITY: u8 = 170;
/// The hole of a hollow marker, in sizes of the marker.
const HOLLOW: f64 = 0.42;
/// Places where a series leaves its panel that are marked, at most.
const MOST_EXITS: usize = 4;

impl Layout {
    /// Draws the data of a panel, clipped to it.
    pub(super) fn series(&mut self, place: &Placed<'_>) {
        let panel = place.prepared.panel;
        let rough = self.rough;
        let inks = self.canvas.inks;
        let looks: Vec<Look> =
            panel.series.iter().enumerate().map(|(number, series)| look(number, series, &inks)).collect();
        self.canvas.clip(Some(place.area.grown(0.5 * self.sizes.rule)));
        for (number, series) in panel.series.iter().enumerate().rev() {
            let colour = looks[number].colour;
            if let Some(mean) = series.mean {
                self.mean(place, mean, panel.averaged_from, colour);
            }
            match (&series.errors, series.style) {
                (Some(errors), SeriesStyle::Band) => self.band(place, series, errors, colour),
                (Some(errors), _) => self.error_bars(place, series, errors, colour),
                (None, _) => {}
            }
        }
        let pieces: Vec<Vec<Run>> = panel.series.iter().map(|series| place.pieces(series)).collect();
        let covered = covered_by(place, self.sizes.line, |number| looks[number].colour);
        // Where lines coincide, those underneath are wider, so that all of them are seen.
        for (number, series) in panel.series.iter().enumerate() {
            let look = looks[number];
            let width = if rough { 0.7 * self.sizes.line } else { self.sizes.line };
            let width = width * (1.0 + LINE_GAIN * covered[number] as f64);
            let dashes = if rough && look.marker.is_some() { &[] } else { look.dashes };
            let (colour, width, dashes) = match series.style {
                SeriesStyle::Thin => (with_alpha(look.colour, THIN_OPACITY), 0.45 * self.sizes.line, &[][..]),
                _ => (look.colour, width, dashes),
            };
            for run in pieces[number].iter().filter(|_| series.style != SeriesStyle::Markers) {
                self.stroke(run, place.area, dashes, colour, width);
            }
        }
        // Over the lines, or noise around a reference would hide it.
        for (number, reference) in panel.references.iter().enumerate() {
            if let Some(y) = place.y_pixel(reference.value) {
                let run = [[place.area.left, y], [place.area.right, y]];
                let look = reference_look(number, panel, &inks);
                self.stroke(&run, place.area, look.dashes, look.colour, 0.75 * self.sizes.line);
            }
        }
        // Those on the frame are whole, too.
        self.canvas.clip(None);
        for (number, series) in panel.series.iter().enumerate().rev() {
            let look = looks[number];
            match series.style {
                SeriesStyle::Markers | SeriesStyle::LineMarkers => {
                    let size = 1.0 + MARKER_GAIN * covered[number] as f64;
                    self.markers(pieces[number].iter().flatten().copied(), place, (look, size), panel);
                    let few = series.points.iter().zip(&series.few).filter(|(_, few)| **few);
                    let hollow = Look { colour: self.canvas.inks.paper, ..look };
                    self.markers(
                        few.filter_map(|(point, _)| place.pixel(*point)),
                        place,
                        (hollow, HOLLOW * size),
                        panel,
                    );
                }
                SeriesStyle::Line | SeriesStyle::Band if rough && panel.series.len() > 1 && look.marker.is_some() => {
                    self.sparse_markers(&pieces[number], place, look, [number, panel.series.len()]);
                }
                SeriesStyle::Line | SeriesStyle::Band | SeriesStyle::Thin => {}
            }
        }
        for number in 0..panel.series.len() {
            self.exits(place, number, looks[number].colour);
        }
    }

    /// Shades what comes before the stretch that means are taken over.
    pub(super) fn equilibration(&mut self, place: &Placed<'_>) {
        let Prepared { panel, has_data, .. } = place.prepared;
        let Some(end) = panel.averaged_from.and_then(|from| place.x_pixel(from)) else { return };
        let right = end.min(place.area.right).round();
        if has_data && right > place.area.left {
            self.canvas.rectangle(Area { right, ..place.area }, with_alpha(self.canvas.inks.muted, 30));
        }
    }

    /// A mean, as a bar under its series over the stretch that it was taken from: as wide as its error on both sides, and no
    /// thinner than can be seen.
    fn mean(&mut self, place: &Placed<'_>, mean: Mean, from: Option<f64>, colour: Colour) {
        let area = place.area;
        let left = from.and_then(|from| place.x_pixel(from)).unwrap_or(area.left).max(area.left);
        let error = mean.standard_error.filter(|error| error.is_finite()).unwrap_or(0.0).abs();
        let [Some(centre), Some(top), Some(bottom)] =
            [0.0, error, -error].map(|off| place.y_pixel(mean.value + off).filter(|y| y.is_finite()))
        else {
            return;
        };
        let half = 1.7 * self.sizes.line;
        let bar = Area {
            left,
            top: top.min(centre - half).max(area.top),
            right: area.right,
            bottom: bottom.max(centre + half).min(area.bottom),
        };
        if bar.left < bar.right && bar.top < bar.bottom {
            self.canvas.rectangle(bar, with_alpha(colour, 90));
        }
    }

    /// Arrowheads where a series leaves a panel whose axis does not show all of it.
    fn exits(&mut self, place: &Placed<'_>, number: usize, colour: Colour) {
        let is_thin = place.prepared.panel.series[number].style == SeriesStyle::Thin;
        if is_thin || place.prepared.beyond == [None; 2] {
            return;
        }
        let (area, radius) = (place.area, 0.9 * self.marker_radius());
        let side = |point: &[f64; 2]| match place.prepared.y.fraction(point[1]) {
            Some(fraction) if fraction > 1.0 => 1,
            Some(fraction) if fraction < 0.0 => -1,
            _ => 0,
        };
        let points = &place.prepared.panel.series[number].points;
        let outside = points.chunk_by(|a, b| side(a) == side(b)).filter(|stretch| side(&stretch[0]) != 0);
        for stretch in outside.take(MOST_EXITS) {
            let Some(x) = place.x_pixel(stretch[0][0]) else { continue };
            // Side by side where several series leave at once.
            let x = (x + (1.1 + 2.2 * number as f64) * radius).clamp(area.left, area.right);
            let up = side(&stretch[0]) > 0;
            let (y, quarter_turns) =
                if up { (area.top + 1.2 * radius, -1.0) } else { (area.bottom - 1.2 * radius, 1.0) };
            let angle = quarter_turns * std::f64::consts::FRAC_PI_2;
            self.canvas.polygon([x, y], 1.5 * radius, 3, angle, self.canvas.inks.paper);
            self.canvas.polygon([x, y], 1.1 * radius, 3, angle, colour);
        }
    }

    pub(super) fn stroke(&mut self, run: &[[f64; 2]], area: Area, dashes: &[f64], colour: Colour, width: f64) {
        let lengths: Vec<f64> = dashes.iter().map(|length| length * width).collect();
        for (from, to) in segments(run, &area.grown(2.0 * width), &lengths) {
            // A point alone in its gap would vanish as a line without length.
            let width = if run.len() == 1 { 2.2 * width } else { width };
            self.canvas.line(from, to, width, colour);
        }
    }

    pub(super) fn marker_radius(&self) -> f64 {
        2.6 * self.sizes.line
    }

    /// One marker; the paper-coloured rim keeps it apart from lines and neighbours.
    pub(super) fn marker(&mut self, at: [f64; 2], radius: f64, look: Look) {
        // Angles in quarter turns of a circle; sizes give every shape about the same area.
        let shape = match look.marker.unwrap_or(0) % MARKERS {
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
                self.canvas.disc(at, radius + rim, self.canvas.inks.paper);
                self.canvas.disc(at, radius, look.colour);
            }
            Some((sides, quarter_turns, size)) => {
                let angle = quarter_turns * std::f64::consts::FRAC_PI_2;
                let corner = 1.0 / (std::f64::consts::PI / f64::from(sides)).cos();
                self.canvas.polygon(at, radius * size + rim * corner, sides, angle, self.canvas.inks.paper);
                self.canvas.polygon(at, radius * size, sides, angle, look.colour);
            }
        }
    }

    fn markers(
        &mut self,
        points: impl Iterator<Item = [f64; 2]>,
        place: &Placed<'_>,
        (look, size): (Look, f64),
        panel: &Panel,
    ) {
        let count = panel.series.iter().map(|series| series.points.len()).max().unwrap_or(0) as f64;
        // Crowded markers shrink down to dots.
        let room = (place.area.width() * place.area.height() / count.max(1.0)).sqrt();
        let radius = size * self.marker_radius().min(0.3 * room).max(0.45 * self.sizes.line);
        let area = place.area.grown(0.5 * self.sizes.rule);
        for point in points.filter(|point| area.contains(*point)) {
            self.marker(point, radius, look);
        }
    }

    /// A few markers along a line too jagged for dashes to be seen; all of them if it has only few points.
    fn sparse_markers(&mut self, pieces: &[Run], place: &Placed<'_>, look: Look, [number, series]: [usize; 2]) {
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
            let shift = (number as f64 + 0.5) / series as f64;
            let target = place.area.left + (f64::from(index) + shift) / f64::from(count) * place.area.width();
            let nearest = points.iter().min_by(|a, b| (a[0] - target).abs().total_cmp(&(b[0] - target).abs()));
            if let Some(point) = nearest.filter(|point| (point[0] - target).abs() < 0.05 * place.area.width()) {
                self.marker(*point, self.marker_radius(), look);
            }
        }
    }

    fn error_bars(&mut self, place: &Placed<'_>, series: &Series, errors: &[f64], colour: Colour) {
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
    fn band(&mut self, place: &Placed<'_>, series: &Series, errors: &[f64], colour: Colour) {
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
                    for column in first as usize..last as usize {
                        let column = column as f64;
                        let t = ((place.area.left + column + 0.5 - last_low[0]) / step).clamp(0.0, 1.0);
                        let between = |from: [f64; 2], to: [f64; 2]| from[1] + t * (to[1] - from[1]);
                        cover(column, between(last_low, low), between(last_high, high));
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
}
