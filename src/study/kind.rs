//! The kinds of studies, in words.

/// What a kind of study is called, and what belongs to it.
#[derive(Debug, Clone, Copy)]
pub struct Kind {
    /// Its command.
    pub command: &'static str,
    /// What messages call one of them.
    pub noun: &'static str,
    /// The name of its summary.
    pub summary: &'static str,
    /// How to replace one: `run the sweep again`.
    pub again: &'static str,
    /// What resuming one does: `finishes the sweep`.
    pub resumed: &'static str,
    /// What makes one shorter: `--budget to shorten them`.
    pub shortened: &'static str,
    /// Whether it may have written a file of this name.
    pub has_file: fn(&str) -> bool,
}

/// The name of the picture of a quantity.
pub(crate) fn plot(command: &str, quantity: &str) -> String {
    format!("{command}-{quantity}.png")
}

/// Whether a name is that of such a picture.
pub(crate) fn is_plot(command: &str, name: &str) -> bool {
    let rest = name.strip_prefix(command).and_then(|rest| rest.strip_prefix('-'));
    rest.and_then(|rest| rest.strip_suffix(".png")).is_some_and(|quantity| !quantity.is_empty())
}
