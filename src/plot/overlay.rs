//! One quantity of several runs in one chart.

use super::chart::{Chart, Panel, Series, SeriesInk};
use super::quantities::{TIME, quantity_label};

/// More names than this would crowd out the curves.
const MOST_NAMES: usize = 12;

/// The curves of a quantity over each other, against time, each with a name that tells its run from the others. Curves
/// on a scale of colours are named at even distances where there are too many of them.
pub(crate) fn overlay_chart(
    title: &str,
    subtitle: &str,
    quantity: &str,
    relative: bool,
    mut curves: Vec<Series>,
) -> Chart {
    let on_scale: Vec<&mut Series> = curves
        .iter_mut()
        .filter(|curve| !curve.name.is_empty() && matches!(curve.ink, SeriesInk::Scale { .. }))
        .collect();
    let count = on_scale.len();
    for (place, curve) in on_scale.into_iter().enumerate() {
        if !is_named(place, count) {
            curve.name.clear();
        }
    }
    let panel = Panel { series: curves, ..Panel::new(TIME, &quantity_label(quantity, relative)).settled() };
    Chart { title: title.to_owned(), subtitle: subtitle.to_owned(), panels: vec![panel] }
}

/// Whether one of `count` curves in order gets a name: every so many of them do, and the last.
fn is_named(place: usize, count: usize) -> bool {
    let every = count.saturating_sub(1).div_ceil(MOST_NAMES - 1).max(1);
    let last = count.saturating_sub(1);
    // One that would stand close to the last gives way to it.
    place == last || place.is_multiple_of(every) && (every == 1 || last - place >= every.div_ceil(2))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn curve(name: &str, ink: SeriesInk) -> Series {
        Series::line(name, vec![[0.0, 1.0]]).with_ink(ink)
    }

    #[test]
    fn few_curves_are_all_named_and_many_at_even_distances() {
        assert!((0..12).all(|place| is_named(place, 12)));
        for count in [13, 16, 20, 30, 99, 1000] {
            let named: Vec<usize> = (0..count).filter(|place| is_named(*place, count)).collect();
            assert_eq!((named[0], named[named.len() - 1]), (0, count - 1));
            assert!((7..=12).contains(&named.len()), "{named:?}");
            let mut steps: Vec<usize> = named.windows(2).map(|pair| pair[1] - pair[0]).collect();
            let last = steps.pop().unwrap_or(0);
            assert!(steps.iter().all(|step| *step == steps[0]), "{named:?}");
            assert!(2 * last >= steps[0] && last < 2 * steps[0], "{named:?}");
        }
    }

    #[test]
    fn a_curve_to_compare_with_keeps_its_name() {
        let scale = |number: usize| SeriesInk::Scale { place: number as f64 / 29.0, pattern: 0 };
        let mut curves: Vec<Series> = (0..30).map(|number| curve(&format!("{number}"), scale(number))).collect();
        curves.push(curve("limit", SeriesInk::Ink { pattern: 1 }));
        let chart = overlay_chart("t", "s", "total_energy", true, curves);
        let panel = &chart.panels[0];
        assert_eq!(panel.series.len(), 31);
        assert_eq!(panel.series.iter().filter(|series| !series.name.is_empty()).count(), 11 + 1);
        assert_eq!(panel.series[30].name, "limit");
        assert_eq!(panel.x.label, "Time (time units)");
    }
}
