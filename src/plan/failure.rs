//! What kernels find wrong with a step, as they leave it in the control buffer.

/// Something that a kernel may find wrong.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum FailureKind {
    /// The impulses on a particle left the range of integers, or were not numbers.
    Impulse,
    /// A momentum came near the end of its range.
    Momentum,
    /// A particle moved further in one step than it may.
    Displacement,
    /// Too many particles in one place for an array: the frame of a row, a bin, a list.
    Frames,
    /// More mass around a mesh node than its integer can hold.
    Crowding,
    /// A depth became negative at a mesh node.
    Depth,
    /// A bond longer than its potential allows.
    Bond,
    /// A mass left its range.
    Mass,
    /// An internal energy became negative.
    Energy,
    /// The adapter left a loop before its end.
    Loops,
    /// A bond reaches beyond what a rank knows around its part.
    Reach,
    /// A solver needs more iterations than were recorded.
    Iterations,
    /// More charge around a mesh node, or a larger potential, than its integer can hold.
    Charges,
}

impl FailureKind {
    /// Its bit.
    #[must_use]
    pub const fn bit(self) -> u32 {
        1 << self as u32
    }
}

/// What was found wrong with a step, and where.
///
/// ```
/// use mesoscope::plan::{Failure, FailureKind};
///
/// let failure = Failure { step: 12, bits: FailureKind::Bond.bit(), place: 7 };
/// assert!(failure.is(FailureKind::Bond) && !failure.is(FailureKind::Momentum));
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Failure {
    /// The first step that failed.
    pub step: u64,
    /// The bits of all that was found in the batch.
    pub bits: u32,
    /// The first mesh node, bond or cell with a failure, where it has one.
    pub place: u32,
}

impl Failure {
    /// Whether this kind is among its kinds.
    #[must_use]
    pub fn is(&self, kind: FailureKind) -> bool {
        self.bits & kind.bit() != 0
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::FailureKind;
    use std::path::Path;

    /// Name and value of every constant of the shaders that begins with `FAILURE_`.
    fn declared(directory: &Path, found: &mut Vec<(String, u32)>) {
        for entry in std::fs::read_dir(directory).unwrap() {
            let path = entry.unwrap().path();
            if path.is_dir() {
                declared(&path, found);
            } else if path.extension().is_some_and(|extension| extension == "wgsl") {
                let text = std::fs::read_to_string(path).unwrap();
                let constants = text.lines().filter_map(|line| line.trim_start().strip_prefix("const FAILURE_"));
                found.extend(constants.map(|rest| {
                    let (name, value) = rest.split_once(": u32 = ").unwrap();
                    (format!("FAILURE_{name}"), value.split('u').next().unwrap().parse().unwrap())
                }));
            }
        }
    }

    #[test]
    fn the_bits_are_those_of_the_shaders() {
        let known = [
            (FailureKind::Impulse, "FAILURE_IMPULSE"),
            (FailureKind::Momentum, "FAILURE_MOMENTUM"),
            (FailureKind::Displacement, "FAILURE_DISPLACEMENT"),
            (FailureKind::Frames, "FAILURE_FRAMES"),
            (FailureKind::Crowding, "FAILURE_CROWDING"),
            (FailureKind::Depth, "FAILURE_DEPTH"),
            (FailureKind::Bond, "FAILURE_BOND"),
            (FailureKind::Mass, "FAILURE_MASS"),
            (FailureKind::Energy, "FAILURE_ENERGY"),
            (FailureKind::Loops, "FAILURE_LOOPS"),
            (FailureKind::Reach, "FAILURE_REACH"),
            (FailureKind::Iterations, "FAILURE_ITERATIONS"),
            (FailureKind::Charges, "FAILURE_CHARGES"),
        ];
        let mut found = Vec::new();
        declared(&Path::new(env!("CARGO_MANIFEST_DIR")).join("shaders"), &mut found);
        found.sort_by_key(|(_, bit)| *bit);
        assert_eq!(found, known.map(|(kind, name)| (name.to_owned(), kind.bit())));
    }
}
