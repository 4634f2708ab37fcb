//! What a chart shows: panels, axes, series. No layout and no colours.

use crate::table::Table;

/// A chart: panels stacked above each other under one title.
///
/// Neighbouring panels whose x axes are alike (label, scale and range) share them.
/// In every text `_{…}` sets an index and `^{…}` an exponent.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Chart {
    /// One line that says what is shown.
    pub title: String,
    /// Conditions, in smaller type; may be empty.
    pub subtitle: String,
    /// From top to bottom.
    pub panels: Vec<Panel>,
}

impl Chart {
    /// A chart of those panels that have a series.
    pub(super) fn of_found(title: &str, subtitle: &str, panels: impl IntoIterator<Item = Panel>) -> Self {
        let panels = panels.into_iter().filter(|panel| !panel.series.is_empty()).collect();
        Self { title: title.to_owned(), subtitle: subtitle.to_owned(), panels }
    }

    /// The chart with a legend in its first panel alone, where all have the same.
    pub(super) fn with_one_legend(mut self) -> Self {
        for series in self.panels.iter_mut().skip(1).flat_map(|panel| &mut panel.series) {
            series.name.clear();
        }
        self
    }
}

/// One coordinate system.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Panel {
    /// Horizontal axis.
    pub x: Axis,
    /// Vertical axis.
    pub y: Axis,
    /// In the order of the legend; the first is painted on top.
    pub series: Vec<Series>,
    /// Horizontal lines to compare with.
    pub references: Vec<ReferenceLine>,
    /// From this x on means are taken; what comes before it is shaded.
    pub averaged_from: Option<f64>,
}

impl Panel {
    /// An empty panel with two linear axes.
    #[must_use]
    pub fn new(x: &str, y: &str) -> Self {
        Self { x: Axis::linear(x), y: Axis::linear(y), ..Self::default() }
    }

    /// The panel with a y axis for what its series come to after the start.
    pub(super) fn settled(mut self) -> Self {
        self.y.fit = AxisFit::Settled;
        self
    }

    /// The panel with one more series.
    #[must_use]
    pub fn with(mut self, series: Series) -> Self {
        self.series.push(series);
        self
    }

    /// The panel with a line for each of these columns that a table has, with a name in the legend, and with a band
    /// where the table has errors of the column.
    pub(super) fn with_columns<Column: AsRef<str>, Name: AsRef<str>>(
        mut self,
        table: &Table,
        x: &str,
        columns: impl IntoIterator<Item = (Column, Name)>,
    ) -> Self {
        for (column, name) in columns {
            let errors = table.values(&format!("{}_error", column.as_ref()));
            let line = |points| Series::line(name.as_ref(), points).with_band(errors);
            self.series.extend(table.points(x, column.as_ref()).map(line));
        }
        self
    }

    /// The panel with one more horizontal line at `value`.
    #[must_use]
    pub fn with_reference(mut self, label: &str, value: f64) -> Self {
        self.references.push(ReferenceLine { label: label.to_owned(), value });
        self
    }
}

/// One axis of a panel.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Axis {
    /// The quantity with its unit in parentheses.
    pub label: String,
    /// Linear or logarithmic.
    pub scale: Scale,
    /// Values at the two ends; left out, they follow from the data. A range that is empty, not finite, or not positive
    /// on a logarithmic axis counts as left out.
    pub range: Option<[f64; 2]>,
    /// Names at 0, 1, 2 and so on instead of numbers; empty for an axis of numbers.
    pub categories: Vec<String>,
    /// What of the data the range follows from where it is left out.
    pub fit: AxisFit,
}

impl Axis {
    /// A linear axis that fits its data.
    pub(crate) fn linear(label: &str) -> Self {
        Self { label: label.to_owned(), ..Self::default() }
    }

    /// An axis of names, with the same width for each.
    pub(crate) fn categories(label: &str, names: Vec<String>) -> Self {
        let range = Some([-0.5, names.len().max(1) as f64 - 0.5]);
        Self { label: label.to_owned(), scale: Scale::Linear, range, categories: names, ..Self::default() }
    }

    /// A logarithmic axis that fits its data; what is not positive is left out and the subtitle says so.
    pub(crate) fn log(label: &str) -> Self {
        Self { label: label.to_owned(), scale: Scale::Log, ..Self::default() }
    }
}

/// What of the data the range of a y axis follows from.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum AxisFit {
    /// All of it (default).
    #[default]
    All,
    /// What the series come to after the start: a transient or a lone outlier that would take more than half of the axis
    /// leaves the panel, which is marked where it does, and the subtitle says how far. Linear axes only.
    Settled,
}

/// How values are laid along an axis.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Scale {
    /// Equal differences take equal lengths (default).
    #[default]
    Linear,
    /// Equal ratios take equal lengths.
    Log,
}

/// Points of one quantity.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Series {
    /// Name in the legend.
    pub name: String,
    /// Pairs x, y. A point that is not finite is a gap in the line.
    pub points: Vec<[f64; 2]>,
    /// Half length of the error bar (half width of a band) of every point, in units of y.
    pub errors: Option<Vec<f64>>,
    /// How the points are drawn.
    pub style: SeriesStyle,
    /// What it is drawn with.
    pub ink: SeriesInk,
    /// Its mean, drawn over the part of the panel that it was taken from.
    pub mean: Option<Mean>,
    /// Points whose error is from few samples: their markers are hollow. Empty where there are none.
    pub few: Vec<bool>,
    /// A word beside every point, as far as there is space for it; empty for a series without labels.
    pub labels: Vec<String>,
}

/// The mean of a series.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Mean {
    /// In units of y.
    pub value: f64,
    /// Its standard error, where that is known.
    pub standard_error: Option<f64>,
    /// Whether the error may be larger than it says.
    pub from_few_samples: bool,
    /// Whether it includes the way to equilibrium.
    pub unequilibrated: bool,
}

impl Series {
    /// Points joined by a line.
    #[must_use]
    pub fn line(name: &str, points: Vec<[f64; 2]>) -> Self {
        Self { name: name.to_owned(), points, ..Self::default() }
    }

    /// A line that others are compared with, dashed in the ink of the axes: a fit, or what is exact.
    pub(crate) fn compared(name: &str, points: Vec<[f64; 2]>) -> Self {
        Self::line(name, points).with_ink(SeriesInk::Ink { pattern: 1 })
    }

    /// Separate markers.
    #[must_use]
    pub fn markers(name: &str, points: Vec<[f64; 2]>) -> Self {
        Self { name: name.to_owned(), points, style: SeriesStyle::Markers, ..Self::default() }
    }

    /// The series drawn with this ink.
    pub(crate) fn with_ink(mut self, ink: SeriesInk) -> Self {
        self.ink = ink;
        self
    }

    /// The series with an error for every point, if any of them is known.
    pub(super) fn with_known_errors(self, errors: Vec<f64>) -> Self {
        if errors.iter().any(|error| error.is_finite()) { self.with_errors(errors) } else { self }
    }

    /// The series in a band of errors, if any of them is known.
    pub(crate) fn with_band(self, errors: Vec<f64>) -> Self {
        let series = self.with_known_errors(errors);
        let style = if series.errors.is_some() { SeriesStyle::Band } else { SeriesStyle::Line };
        Self { style, ..series }
    }

    /// The series with an error for every point.
    #[must_use]
    pub fn with_errors(mut self, errors: Vec<f64>) -> Self {
        self.errors = Some(errors);
        self
    }
}

/// How the points of a series are drawn.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum SeriesStyle {
    /// Joined by a line (default).
    #[default]
    Line,
    /// A marker each.
    Markers,
    /// Markers joined by a line.
    LineMarkers,
    /// A line inside a shaded band as wide as the errors.
    Band,
    /// A thin, pale line, for one of the samples that a mean is of.
    Thin,
}

/// What a series is drawn with.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub enum SeriesInk {
    /// A colour, dashes and markers that distinguish it from the series around it (default).
    #[default]
    Own,
    /// The colour, dashes and markers of a number, whichever series stand around it: for a quantity that looks the same
    /// wherever it is shown. A panel should have numbers for all its series or for none.
    Numbered(usize),
    /// The colour of a place, 0 to 1, on a scale whose lightness rises evenly: for series in an order of their own.
    Scale {
        /// The place on the scale.
        place: f64,
        /// Number of the pattern of dashes; 0 is a solid line.
        pattern: usize,
    },
    /// The ink of the axes, for a series that the others are compared with.
    Ink {
        /// Number of the pattern of dashes; 0 is a solid line.
        pattern: usize,
    },
    /// The colour of a species in snapshots, given by its number twice; of a pair of species the colour of the first,
    /// with the dashes and markers of the second.
    Species([usize; 2]),
    /// The grey of all particles beside those of one species.
    AllSpecies,
    /// A grey that stands back behind all others.
    Faint,
}

/// A horizontal line to compare with.
#[derive(Debug, Clone, PartialEq)]
pub struct ReferenceLine {
    /// Name in the legend.
    pub label: String,
    /// Where the line lies, in units of y.
    pub value: f64,
}
