//! The charts of Voronoi DPD, made from the tables of a run.

use super::chart::{Axis, Chart, Panel, Series, SeriesInk};
use super::points::{highest, pairs, steps};
use super::quantities::TIME;
use crate::table::Table;

/// The histogram of the numbers of neighbours of cells, compared with that of random points, with the mean of 6 that every
/// tessellation has.
///
/// The columns are `neighbours`, `fraction`, `fraction_error` and `random_points`.
///
/// ```
/// use mesoscope::plot::neighbours_chart;
/// use mesoscope::table::Table;
///
/// let columns = ["neighbours", "fraction", "fraction_error", "random_points"];
/// let rows = vec![vec![5.0, 0.26, 0.01, 0.26], vec![6.0, 0.29, 0.01, 0.30]];
/// let chart = neighbours_chart("Cells", &Table::new(columns, rows));
/// assert!(chart.panels[0].series.iter().any(|series| series.points == [[5.0, 0.26], [6.0, 0.29]]));
/// ```
#[must_use]
pub fn neighbours_chart(title: &str, table: &Table) -> Chart {
    let [numbers, fractions, errors, random] =
        ["neighbours", "fraction", "fraction_error", "random_points"].map(|name| table.values(name));
    let mut outline = steps(numbers.iter().zip(&fractions).map(|(n, f)| ([n - 0.5, n + 0.5], *f)));
    // From the axis and back to it.
    if let (Some([left, _]), Some([right, _])) = (outline.first().copied(), outline.last().copied()) {
        outline.insert(0, [left, 0.0]);
        outline.push([right, 0.0]);
    }
    let mean = numbers.iter().zip(&fractions).map(|(n, f)| n * f).sum::<f64>();
    let square = numbers.iter().zip(&fractions).map(|(n, f)| n * n * f).sum::<f64>();
    let mut panel = Panel::new("Neighbours of a cell", "Fraction of cells");
    panel.series.push(Series::line("measured", outline).with_ink(SeriesInk::Numbered(0)));
    panel.series.push(Series::markers("random points", pairs(&numbers, &random)).with_ink(SeriesInk::Numbered(1)));
    if errors.iter().any(|error| error.is_finite() && *error > 0.0) {
        let bars =
            Series::markers("", pairs(&numbers, &fractions)).with_errors(errors).with_ink(SeriesInk::Numbered(0));
        panel.series.push(bars);
    }
    let top = 1.08 * highest(fractions.iter().chain(&random).copied()).max(1e-9);
    panel.series.push(Series::compared("mean of every tessellation, 6", vec![[6.0, 0.0], [6.0, top]]));
    panel.y.range = Some([0.0, top]);
    let subtitle = format!("mean {mean:.4}, variance {:.3}; 1.78 for random points", square - mean * mean);
    Chart { title: title.to_owned(), subtitle, panels: vec![panel] }
}

const MAGNITUDE: &str = "Magnitude of the amplitude (length units/time unit)";

/// The amplitude of a shear wave over time, with the exponential decay of this name fitted to it: on a linear axis, and its magnitude on a
/// logarithmic one.
///
/// The columns are `time`, `amplitude` and `fit`.
///
/// ```
/// use mesoscope::plot::shear_wave_chart;
/// use mesoscope::table::Table;
///
/// let columns = ["time", "amplitude", "fit"];
/// let rows = vec![vec![0.0, 0.5, 0.5], vec![1.0, -0.02, 0.01]];
/// let chart = shear_wave_chart("A wave", "", "exponential decay", &Table::new(columns, rows));
/// // A logarithmic axis shows the magnitude.
/// assert_eq!(chart.panels[1].series[0].points[1], [1.0, 0.02]);
/// ```
#[must_use]
pub fn shear_wave_chart(title: &str, subtitle: &str, fit_name: &str, table: &Table) -> Chart {
    let [amplitude, fit] = ["amplitude", "fit"].map(|column| table.over_time(column, 1.0).unwrap_or_default());
    let fitted = fit.iter().any(|point| point[1].is_finite());
    let magnitude = amplitude.iter().map(|[time, value]| [*time, value.abs()]).collect();
    let mut panels = Vec::new();
    for (label, points) in [("Amplitude of the velocity (length units/time unit)", amplitude), (MAGNITUDE, magnitude)] {
        let mut panel = Panel::new(TIME, label).with(Series::line("measured", points));
        if fitted {
            panel.series.push(Series::compared(fit_name, fit.clone()));
        }
        panels.push(panel);
    }
    panels[0].references.push(super::chart::ReferenceLine { label: String::new(), value: 0.0 });
    panels[1].y = Axis::log(MAGNITUDE);
    Chart { title: title.to_owned(), subtitle: subtitle.to_owned(), panels }.with_one_legend()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn table(columns: &[&str], rows: &[&[f64]]) -> Table {
        Table::new(columns.to_vec(), rows.iter().map(|row| row.to_vec()).collect())
    }

    #[test]
    fn a_histogram_stands_on_its_axis() {
        let columns = ["neighbours", "fraction", "fraction_error", "random_points"];
        let chart = neighbours_chart("t", &table(&columns, &[&[5.0, 0.25, 0.01, 0.26], &[7.0, 0.75, 0.01, 0.2]]));
        let panel = &chart.panels[0];
        assert_eq!(
            panel.series[0].points,
            [[4.5, 0.0], [4.5, 0.25], [5.5, 0.25], [6.5, 0.75], [7.5, 0.75], [7.5, 0.0]]
        );
        assert!(chart.subtitle.starts_with("mean 6.5000, variance 0.750"), "{}", chart.subtitle);
        assert_eq!(panel.series[2].errors, Some(vec![0.01; 2]));
        let names: Vec<&str> = panel.series.iter().map(|series| series.name.as_str()).collect();
        assert_eq!(names, ["measured", "random points", "", "mean of every tessellation, 6"]);
    }

    #[test]
    fn a_wave_has_its_fit_beside_it() {
        let columns = ["time", "amplitude", "fit"];
        let chart = shear_wave_chart("t", "s", "decay", &table(&columns, &[&[0.0, 1.0, 1.0], &[1.0, -0.5, 0.6]]));
        assert_eq!(chart.panels[1].series[0].points[1], [1.0, 0.5]);
        assert_eq!(chart.panels[1].series[1].points[1], [1.0, 0.6]);
        let without = shear_wave_chart("t", "s", "decay", &table(&columns, &[&[0.0, 1.0, f64::NAN]]));
        assert_eq!(without.panels[0].series.len(), 1);
    }
}
