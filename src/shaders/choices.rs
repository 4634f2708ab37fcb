//! Variants chosen for a kernel.

use super::generated::{FILES, IN_BUFFERS, SLOTS};

/// A variant of a slot: its number among all files.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct Choice(pub(super) u16);

impl Choice {
    /// Path below `shaders`, without the extension.
    ///
    /// ```
    /// use mesoscope::shaders::{Choice, baths::Pairs};
    ///
    /// assert_eq!(Choice::from(Pairs::White).path(), "baths/pairs/white");
    /// ```
    #[must_use]
    pub fn path(self) -> &'static str {
        FILES[usize::from(self.0)].0
    }

    /// Whether the other is of the same slot.
    fn replaces(self, other: Self) -> bool {
        SLOTS[usize::from(self.0)] == SLOTS[usize::from(other.0)]
    }
}

/// At most one variant of every slot.
///
/// ```
/// use mesoscope::shaders::{Choices, baths::Pairs};
///
/// let choices = Choices::new().with(Pairs::White).with(Pairs::Memory);
/// assert_eq!(choices.paths().collect::<Vec<_>>(), ["baths/pairs/memory"]);
/// assert!(choices.has(Pairs::Memory) && !choices.has(Pairs::White));
/// ```
#[derive(Debug, Clone, PartialEq, Eq, Hash, PartialOrd, Ord, Default)]
pub struct Choices(Vec<Choice>);

impl Choices {
    /// None.
    #[must_use]
    pub fn new() -> Self {
        Self::default()
    }

    /// Chooses a variant, in place of one that was chosen for its slot.
    pub(crate) fn choose(&mut self, variant: impl Into<Choice>) {
        let choice = variant.into();
        self.0.retain(|known| !known.replaces(choice));
        let place = self.0.partition_point(|known| *known < choice);
        self.0.insert(place, choice);
    }

    /// These and a variant.
    #[must_use]
    pub fn with(mut self, variant: impl Into<Choice>) -> Self {
        self.choose(variant);
        self
    }

    /// These and a variant, under a condition.
    pub(crate) fn with_if(self, condition: bool, variant: impl Into<Choice>) -> Self {
        if condition { self.with(variant) } else { self }
    }

    /// These and a variant, if there is one.
    pub(crate) fn with_any(self, variant: Option<impl Into<Choice>>) -> Self {
        match variant {
            Some(variant) => self.with(variant),
            None => self,
        }
    }

    /// These and others, which replace those of the same slots.
    pub(crate) fn and(mut self, others: &Self) -> Self {
        others.0.iter().for_each(|choice| self.choose(*choice));
        self
    }

    /// Whether a variant is chosen.
    #[must_use]
    pub fn has(&self, variant: impl Into<Choice>) -> bool {
        self.0.contains(&variant.into())
    }

    /// The variants.
    pub fn iter(&self) -> impl Iterator<Item = Choice> + '_ {
        self.0.iter().copied()
    }

    /// Paths of the variants.
    pub fn paths(&self) -> impl Iterator<Item = &'static str> + '_ {
        self.0.iter().map(|choice| choice.path())
    }

    /// These, with buffers for all arrays of which nothing is said.
    pub(super) fn with_arrays_in_buffers(&self) -> Self {
        IN_BUFFERS.into_iter().fold(Self::new(), Self::with).and(self)
    }
}
