//! Where a report keeps each of its sums.

use crate::shaders::{Constant, Sum};

/// The sums of a report, each of one or more components, in the order in which its rows hold them: first those
/// that kernels add up, then those that accounts keep.
///
/// ```
/// use mesoscope::{plan::Sums, shaders::Sum};
///
/// let sums = Sums::default().with(Sum::KineticEnergy, 1).with_account(Sum::GivenWork, 1).with(Sum::Momentum, 3);
/// assert_eq!(sums.len(), 5);
/// assert_eq!([Sum::Momentum, Sum::GivenWork].map(|sum| sums.place(sum)), [Some(1), Some(4)]);
/// assert_eq!(sums.place(Sum::Virial), None);
/// assert_eq!(sums.row(&[7, 0, -2, 0, 3]).component(Sum::Momentum, 1), Some(-2));
/// ```
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Sums {
    /// Sums that kernels add up, with the number of their components.
    own: Vec<(Sum, usize)>,
    /// Sums that accounts keep.
    accounts: Vec<(Sum, usize)>,
}

impl Sums {
    /// These sums, and one more that kernels add up, of a number of components.
    #[must_use]
    pub fn with(mut self, sum: Sum, components: usize) -> Self {
        self.own.push((sum, components));
        self
    }

    /// These sums, and if a condition holds others of one component.
    pub(crate) fn with_if(self, condition: bool, sums: &[Sum]) -> Self {
        sums.iter().filter(|_| condition).fold(self, |all, sum| all.with(*sum, 1))
    }

    /// These sums, and one more that an account keeps; none of no components.
    #[must_use]
    pub fn with_account(mut self, sum: Sum, components: usize) -> Self {
        self.accounts.extend((components > 0).then_some((sum, components)));
        self
    }

    /// The number of all components.
    #[must_use]
    pub fn len(&self) -> usize {
        self.in_order().map(|(_, components)| components).sum()
    }

    /// Whether a report sums nothing.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// The place of a sum, or of its first component, in a row; nothing if the report lacks it.
    #[must_use]
    pub fn place(&self, sum: Sum) -> Option<usize> {
        self.place_of_component(sum, 0)
    }

    /// A row of a report with its values by name.
    #[must_use]
    pub fn row<'a>(&'a self, values: &'a [i64]) -> ReportRow<'a> {
        ReportRow { sums: self, values }
    }

    /// The constants by which kernels of a report know its rows.
    pub(crate) fn constants(&self) -> Vec<(Constant, f64)> {
        let own: usize = self.own.iter().map(|(_, components)| components).sum();
        let mut constants = vec![(Constant::Quantities, self.len() as f64), (Constant::OwnSums, own as f64)];
        let mut place = 0;
        for (sum, components) in self.in_order() {
            constants.push((sum.constant(), place as f64));
            place += components;
        }
        constants
    }

    fn in_order(&self) -> impl Iterator<Item = (Sum, usize)> {
        self.own.iter().chain(&self.accounts).copied()
    }

    fn place_of_component(&self, sum: Sum, component: usize) -> Option<usize> {
        let mut first = 0;
        for (known, components) in self.in_order() {
            if known == sum {
                return (component < components).then_some(first + component);
            }
            first += components;
        }
        None
    }
}

/// A row of a report.
#[derive(Debug, Clone, Copy)]
pub struct ReportRow<'a> {
    sums: &'a Sums,
    values: &'a [i64],
}

impl ReportRow<'_> {
    /// The value of a sum; nothing if the report lacks it.
    pub(crate) fn value(&self, sum: Sum) -> Option<i64> {
        self.component(sum, 0)
    }

    /// The value of a component of a sum; nothing if the report lacks it.
    #[must_use]
    pub fn component(&self, sum: Sum, component: usize) -> Option<i64> {
        self.values.get(self.sums.place_of_component(sum, component)?).copied()
    }

    /// The value of a sum as a number; zero if the report lacks it.
    pub(crate) fn number(&self, sum: Sum) -> f64 {
        self.component_number(sum, 0)
    }

    /// Three components of a sum from one on as numbers; zeros of those that the report lacks.
    pub(crate) fn vector(&self, sum: Sum, first: usize) -> [f64; 3] {
        [0, 1, 2].map(|axis| self.component_number(sum, first + axis))
    }

    /// A row that is too short has no number where a value is missing.
    fn component_number(&self, sum: Sum, component: usize) -> f64 {
        let place = self.sums.place_of_component(sum, component);
        place.map_or(0.0, |place| self.values.get(place).map_or(f64::NAN, |value| *value as f64))
    }
}
