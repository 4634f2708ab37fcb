//! Tables of numbers: what is measured, written to files, read back and drawn.

/// A table of finite numbers; an empty cell is NaN.
///
/// ```
/// use mesoscope::table::Table;
///
/// let table = Table::new(["time", "pressure"], vec![vec![0.0, 23.0], vec![0.5, 24.0]]);
/// assert_eq!(table.column("pressure"), Some(vec![23.0, 24.0]));
/// assert_eq!(table.over_time("pressure", 2.0), Some(vec![[0.0, 11.5], [0.5, 12.0]]));
/// assert_eq!(table.column("temperature"), None);
/// assert!(table.values("temperature").iter().all(|value| value.is_nan()));
/// ```
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Table {
    /// Names of the columns.
    pub columns: Vec<String>,
    /// Rows, each with one number per column; what is missing in a short row is NaN.
    pub rows: Vec<Vec<f64>>,
}

impl Table {
    /// A table of these columns and rows.
    #[must_use]
    pub fn new<Name: Into<String>>(columns: impl IntoIterator<Item = Name>, rows: Vec<Vec<f64>>) -> Self {
        Self { columns: columns.into_iter().map(Into::into).collect(), rows }
    }

    /// Place of the column of this name.
    fn place(&self, name: &str) -> Option<usize> {
        self.columns.iter().position(|column| column == name)
    }

    /// The numbers in the column at this place; NaN where a row ends before it.
    pub fn column_at(&self, place: usize) -> impl Iterator<Item = f64> {
        self.rows.iter().map(move |row| row.get(place).copied().unwrap_or(f64::NAN))
    }

    /// The numbers in the column of this name.
    #[must_use]
    pub fn column(&self, name: &str) -> Option<Vec<f64>> {
        Some(self.column_at(self.place(name)?).collect())
    }

    /// The numbers in the column of this name; NaN in every row where there is no such column.
    #[must_use]
    pub fn values(&self, name: &str) -> Vec<f64> {
        self.column(name).unwrap_or_else(|| vec![f64::NAN; self.rows.len()])
    }

    /// Points of two columns, or none unless there are both.
    pub(crate) fn points(&self, x: &str, y: &str) -> Option<Vec<[f64; 2]>> {
        let (x, y) = (self.place(x)?, self.place(y)?);
        Some(self.column_at(x).zip(self.column_at(y)).map(|(x, y)| [x, y]).collect())
    }

    /// Points (`time`, value / `divisor`) of a column, or none if there is no such column.
    #[must_use]
    pub fn over_time(&self, name: &str, divisor: f64) -> Option<Vec<[f64; 2]>> {
        Some(self.points("time", name)?.into_iter().map(|[time, value]| [time, value / divisor]).collect())
    }
}
