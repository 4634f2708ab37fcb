//! Words beside points, where there is space for them.

use super::canvas::{Anchor, Area, Type};
use super::chart_layout::{Layout, Placed};
use super::chart_legend::obstacles;
use super::series_look::look;
use super::series_path::clipped;
use super::text::{CAPITAL_HEIGHT, Weight};

/// Size of the words, as a part of that of other labels.
const SIZE: f64 = 0.72;

/// The two ends of a line.
type Segment = ([f64; 2], [f64; 2]);

impl Layout {
    /// Writes the labels of the points of a panel. Each stands beside its point, or at the end of a line that leads to it,
    /// wherever it first covers neither data nor another label nor the legend. Where all of the panel is full, it is left out.
    pub(super) fn point_labels(&mut self, place: &Placed<'_>, legend: Option<Area>) {
        let panel = place.prepared.panel;
        if panel.series.iter().all(|series| series.labels.is_empty()) {
            return;
        }
        let radius = 1.5 * self.marker_radius();
        let points = panel.series.iter().flat_map(|series| &series.points).filter_map(|point| place.pixel(*point));
        let points: Vec<[f64; 2]> = points.filter(|point| place.area.contains(*point)).collect();
        let square = |point: &[f64; 2]| Area::around(*point, [2.0 * radius; 2]);
        let mut taken: Vec<Area> = points.iter().map(square).chain(legend).collect();
        let mut lines = obstacles(place);
        let size = SIZE * self.sizes.label;
        for (number, series) in panel.series.iter().enumerate() {
            let colour = look(number, series, &self.canvas.inks).colour;
            let style = Type { size, weight: Weight::Regular, colour };
            for (point, label) in series.points.iter().zip(&series.labels) {
                let Some(at) = place.pixel(*point).filter(|at| place.area.contains(*at)) else { continue };
                let width = self.canvas.typesetter.width(label, style.weight, size);
                let Some((spot, leader)) = free_spot(at, [width, size], radius, (&taken, &lines), &place.area) else {
                    continue;
                };
                if let Some((from, to)) = leader {
                    self.canvas.line(from, to, 0.5 * self.sizes.rule, colour);
                    lines.push((from, to));
                }
                let baseline = 0.5 * (spot.top + spot.bottom + CAPITAL_HEIGHT * size);
                self.canvas.text(label, [spot.left, baseline], Anchor::Start, style);
                taken.push(spot);
            }
        }
    }
}

/// How far around a point places are tried, in heights of a label, where none beside it is free.
const FARTHEST: u32 = 12;

/// Directions tried at each distance.
const DIRECTIONS: u32 = 16;

/// The first place for a label of this width and height where it covers nothing: beside its point, or as near as can be,
/// with a line that leads there and crosses no other label.
fn free_spot(
    at: [f64; 2],
    [width, height]: [f64; 2],
    radius: f64,
    (taken, lines): (&[Area], &[Segment]),
    inside: &Area,
) -> Option<(Area, Option<Segment>)> {
    let is_free = |spot: &Area| {
        let within = inside.contains([spot.left, spot.top]) && inside.contains([spot.right, spot.bottom]);
        let crossed = || lines.iter().any(|(from, to)| clipped(*from, *to, spot).is_some());
        within && !taken.iter().any(|other| overlap(spot, other)) && !crossed()
    };
    let [wide, high] = [radius + 0.5 * width, radius + 0.5 * height];
    let corners = [[wide, -radius], [wide, radius], [-wide, -radius], [-wide, radius]];
    let beside = [[wide, 0.0], [-wide, 0.0], [0.0, -high], [0.0, high]].into_iter().chain(corners);
    let at_offset = |[x, y]: [f64; 2]| Area::around([at[0] + x, at[1] + y], [width, height]);
    let beside = beside.map(at_offset).find(is_free).map(|spot| (spot, None));
    let away = || {
        (1..=FARTHEST).flat_map(|distance| (0..DIRECTIONS).map(move |turn| (distance, turn))).find_map(
            |(distance, turn)| {
                let (sine, cosine) = (std::f64::consts::TAU * f64::from(turn) / f64::from(DIRECTIONS)).sin_cos();
                let reach = radius + height * f64::from(distance);
                let spot = at_offset([cosine * (reach + 0.5 * width), sine * (reach + 0.5 * height)]);
                let end = [at[0].clamp(spot.left, spot.right), at[1].clamp(spot.top, spot.bottom)];
                let is_clear = || taken.iter().all(|other| other.contains(at) || clipped(at, end, other).is_none());
                (is_free(&spot) && is_clear()).then_some((spot, Some((at, end))))
            },
        )
    };
    beside.or_else(away)
}

fn overlap(a: &Area, b: &Area) -> bool {
    a.left < b.right && b.left < a.right && a.top < b.bottom && b.top < a.bottom
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn labels_keep_clear_of_points_and_of_each_other() {
        let inside = Area { left: 0.0, top: 0.0, right: 100.0, bottom: 100.0 };
        let point = [50.0, 50.0];
        let own = Area { left: 45.0, top: 45.0, right: 55.0, bottom: 55.0 };
        let mut taken = vec![own];
        while let Some((spot, _)) = free_spot(point, [20.0, 8.0], 5.0, (&taken, &[]), &inside) {
            assert!(!taken.iter().any(|other| overlap(&spot, other)));
            taken.push(spot);
        }
        assert_eq!(taken[1].left, 55.0, "right of its point where nothing is in the way");
        assert!(taken.len() >= 5, "{}", taken.len());
    }

    #[test]
    fn a_line_leads_to_a_label_that_has_no_place_beside_its_point() {
        let inside = Area { left: 0.0, top: 0.0, right: 100.0, bottom: 100.0 };
        let area = |left: f64, top: f64, right: f64, bottom: f64| Area { left, top, right, bottom };
        let own = area(45.0, 45.0, 55.0, 55.0);
        let [right, left] = [area(56.0, 45.0, 58.0, 55.0), area(42.0, 45.0, 44.0, 55.0)];
        let [above, below] = [area(45.0, 42.0, 55.0, 44.0), area(45.0, 56.0, 55.0, 58.0)];
        let taken = [own, right, left, above, below];
        let Some((spot, Some((from, to)))) = free_spot([50.0, 50.0], [20.0, 8.0], 5.0, (&taken, &[]), &inside) else {
            unreachable!("no line leads to a label");
        };
        assert!(!taken.iter().any(|other| overlap(&spot, other)));
        assert!(from == [50.0, 50.0] && spot.contains(to), "a line ends at its label");
        assert!(taken[1..].iter().all(|other| clipped(from, to, other).is_none()), "and crosses no other");
    }

    #[test]
    fn labels_keep_clear_of_lines_and_edges() {
        let inside = Area { left: 0.0, top: 0.0, right: 100.0, bottom: 100.0 };
        let spot = |at, width, lines: &[Segment]| {
            free_spot(at, [width, 8.0], 5.0, (&[], lines), &inside).map(|(spot, leader)| (spot.left, leader.is_some()))
        };
        assert_eq!(spot([98.0, 50.0], 20.0, &[]), Some((73.0, false)), "left of a point at the right edge");
        let line = ([40.0, 50.0], [90.0, 50.0]);
        assert_eq!(spot([50.0, 50.0], 20.0, &[line]), Some((40.0, false)), "not on a line to the right");
        assert_eq!(spot([50.0, 50.0], 200.0, &[]), None);
    }
}
