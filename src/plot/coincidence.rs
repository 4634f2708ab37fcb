//! Finds curves that lie on each other, so that both are drawn to be seen.

use super::chart::{Series, SeriesStyle};
use super::chart_layout::Placed;
use super::palette::Colour;

/// Points compared of a pair of series, at most.
const COMPARED: usize = 512;
/// Curves that lie on each other in this part of their points look like one.
const MOSTLY: f64 = 0.6;

/// For each series, how many of those painted over it lie on it. Lines are painted in their order, markers against it.
pub(super) fn covered_by(place: &Placed<'_>, tolerance: f64, colour: impl Fn(usize) -> Colour) -> Vec<usize> {
    let panel = place.prepared.panel;
    let marked = |series: &Series| series.style == SeriesStyle::Markers;
    let over = |under: usize, above: usize| {
        let (one, other) = (&panel.series[under], &panel.series[above]);
        let painted_later = if marked(one) { above < under } else { above > under };
        // What has the same colour could not be distinguished by its width.
        painted_later
            && marked(one) == marked(other)
            && colour(under) != colour(above)
            && coincide(one, other, place, tolerance)
    };
    let count = panel.series.len();
    (0..count).map(|under| (0..count).filter(|above| over(under, *above)).count()).collect()
}

/// Whether most points of two series, at the same places x, are less than a few pixels apart.
fn coincide(one: &Series, other: &Series, place: &Placed<'_>, tolerance: f64) -> bool {
    if one.points.len() != other.points.len() || one.points.is_empty() {
        return false;
    }
    let every = one.points.len().div_ceil(COMPARED);
    let pairs = one.points.iter().zip(&other.points).step_by(every);
    let (mut shown, mut alike) = (0, 0);
    for (a, b) in pairs {
        let (Some(a), Some(b)) = (place.pixel(*a), place.pixel(*b)) else { continue };
        if !place.area.contains(a) && !place.area.contains(b) {
            continue;
        }
        shown += 1;
        alike += usize::from((a[0] - b[0]).abs() < 0.5 && (a[1] - b[1]).abs() <= tolerance);
    }
    shown > 0 && f64::from(alike as u32) >= MOSTLY * f64::from(shown)
}

#[cfg(test)]
mod tests {
    use super::super::axis_range::prepare;
    use super::super::canvas::Area;
    use super::super::chart::Panel;
    use super::super::ticks::{AxisMap, Ticks};
    use super::*;

    fn place(panel: &Panel) -> Placed<'_> {
        let map = AxisMap::linear(0.0, 100.0);
        let area = Area { left: 0.0, top: 0.0, right: 100.0, bottom: 100.0 };
        let prepared = super::super::axis_range::Prepared { x: map, y: map, ..prepare(std::slice::from_ref(panel))[0] };
        Placed { prepared, area, x_ticks: Ticks::default(), y_ticks: Ticks::default() }
    }

    fn own(number: usize) -> Colour {
        [number as u8; 4]
    }

    fn line(shift: f64) -> Vec<[f64; 2]> {
        (0..50).map(|i| [f64::from(i), 40.0 + shift + f64::from(i % 7)]).collect()
    }

    #[test]
    fn the_curve_underneath_knows_what_covers_it() {
        let panel = Panel::new("x", "y")
            .with(Series::line("a", line(0.0)))
            .with(Series::line("b", line(30.0)))
            .with(Series::line("c", line(0.2)))
            .with(Series::line("d", line(0.1)));
        assert_eq!(covered_by(&place(&panel), 1.0, own), [2, 0, 1, 0]);
        assert_eq!(covered_by(&place(&panel), 1.0, |_| [0; 4]), [0; 4], "all of one colour");
    }

    #[test]
    fn markers_are_painted_the_other_way_round_and_lines_do_not_cover_them() {
        let panel = Panel::new("x", "y")
            .with(Series::markers("a", line(0.0)))
            .with(Series::markers("b", line(0.0)))
            .with(Series::line("c", line(0.0)));
        assert_eq!(covered_by(&place(&panel), 1.0, own), [0, 1, 0]);
    }

    #[test]
    fn nothing_and_gaps_do_not_coincide() {
        let panel = Panel::new("x", "y")
            .with(Series::line("a", Vec::new()))
            .with(Series::line("b", Vec::new()))
            .with(Series::line("c", vec![[f64::NAN; 2]; 3]))
            .with(Series::line("d", vec![[f64::NAN; 2]; 3]));
        assert_eq!(covered_by(&place(&panel), 1.0, own), [0; 4]);
    }
}
