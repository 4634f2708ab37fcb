//! Words beside points, where there is space for them.

use super::canvas::{Anchor, Area, Type};
use super::chart_layout::{Layout, Placed};
use super::series_path::clipped;
use super::text::{CAPITAL_HEIGHT, Weight};

/// Size of the words, as a part of that of other labels.
const SIZE: f64 = 0.72;

/// The two ends of a line.
type Segment = ([f64; 2], [f64; 2]);

impl Layout<'_> {
    /// Writes the labels of the points of a panel. Each stands right of, left of, above or below its point, wherever it first
    /// covers neither data nor another label nor the legend; where that is nowhere, it is left out.
    pub(super) fn point_labels(&mut self, index: usize, place: &Placed, legend: Option<Area>) {
        let panel = self.prepared[index].panel;
        if panel.series.iter().all(|series| series.labels.is_empty()) {
            return;
        }
        let radius = 1.5 * self.marker_radius();
        let points: Vec<[f64; 2]> = panel
            .series
            .iter()
            .flat_map(|series| &series.points)
            .filter_map(|point| place.pixel(*point))
            .filter(|point| place.area.contains(*point))
            .collect();
        let square =
            |[x, y]: [f64; 2]| Area { left: x - radius, top: y - radius, right: x + radius, bottom: y + radius };
        let mut taken: Vec<Area> = points.iter().copied().map(square).chain(legend).collect();
        let lines = self.obstacles(index, place);
        let size = SIZE * self.sizes.label;
        for (number, series) in panel.series.iter().enumerate() {
            let colour = self.look(number, series).colour;
            let style = Type { size, weight: Weight::Regular, colour };
            for (point, label) in series.points.iter().zip(&series.labels) {
                let Some(at) = place.pixel(*point).filter(|at| place.area.contains(*at)) else { continue };
                let width = self.canvas.typesetter.width(label, style.weight, size);
                let Some(spot) = free_spot(at, [width, size], radius, (&taken, &lines), &place.area) else { continue };
                let baseline = 0.5 * (spot.top + spot.bottom + CAPITAL_HEIGHT * size);
                self.canvas.text(label, [spot.left, baseline], Anchor::Start, style);
                taken.push(spot);
            }
        }
    }
}

/// The first place around a point where a label of this width and height covers nothing.
fn free_spot(
    [x, y]: [f64; 2],
    [width, height]: [f64; 2],
    radius: f64,
    (taken, lines): (&[Area], &[Segment]),
    inside: &Area,
) -> Option<Area> {
    let area = |left: f64, top: f64| Area { left, top, right: left + width, bottom: top + height };
    let (middle, centre) = (y - 0.5 * height, x - 0.5 * width);
    let spots = [
        area(x + radius, middle),
        area(x - radius - width, middle),
        area(centre, y - radius - height),
        area(centre, y + radius),
        area(x + radius, y - radius - 0.5 * height),
        area(x + radius, y + radius - 0.5 * height),
        area(x - radius - width, y - radius - 0.5 * height),
        area(x - radius - width, y + radius - 0.5 * height),
    ];
    let is_free = |spot: &Area| {
        let within = spot.left >= inside.left
            && spot.right <= inside.right
            && spot.top >= inside.top
            && spot.bottom <= inside.bottom;
        let crossed = || lines.iter().any(|(from, to)| clipped(*from, *to, spot).is_some());
        within && !taken.iter().any(|other| overlap(spot, other)) && !crossed()
    };
    spots.into_iter().find(is_free)
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
        let mut found = Vec::new();
        while let Some(spot) = free_spot(point, [20.0, 8.0], 5.0, (&taken, &[]), &inside) {
            assert!(!taken.iter().any(|other| overlap(&spot, other)));
            taken.push(spot);
            found.push(spot);
        }
        assert_eq!(found.first().map(|spot| spot.left), Some(55.0), "right of its point where nothing is in the way");
        assert!((4..=8).contains(&found.len()), "{}", found.len());
        let corner = free_spot([98.0, 50.0], [20.0, 8.0], 5.0, (&[], &[]), &inside);
        assert_eq!(corner.map(|spot| spot.right), Some(93.0), "left of a point at the right edge");
        let line = ([40.0, 50.0], [90.0, 50.0]);
        let above = free_spot(point, [20.0, 8.0], 5.0, (&[], &[line]), &inside);
        assert_eq!(above.map(|spot| (spot.left, spot.bottom)), Some((40.0, 45.0)), "not on a line to the right");
        assert_eq!(free_spot(point, [200.0, 8.0], 5.0, (&[], &[]), &inside), None);
    }
}
