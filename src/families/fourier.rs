//! Fourier transforms of real fields on periodic meshes of two or three dimensions: forth, a weight for every wave, and back.
//!
//! Two rows half a mesh apart go through the transform along x as the real and imaginary part of one. The first pass along
//! the second axis, which needs both, separates them, and the last pass back joins them. Of the waves along x only those up to the
//! middle are kept: the others are their conjugates. In three dimensions the second axis is z, and the last one, where the
//! transform turns back, is y.

use std::f64::consts::TAU;

use crate::plan::{Buffer, Contents, Kernel};
use crate::shaders::smoothing::{Lines, Load, Radix, SharedTwist, Store, Twist};
use crate::shaders::{Array, Choices, Constant, Entry};

/// The longest lines that a pass transforms whole: on lavapipe short ones cost little but the passes.
const WHOLE_LINE: u32 = 64;
/// The largest radix of a pass over longer lines: on lavapipe two passes of 32 take .75 of the time of three of 16.
const LARGEST_RADIX: u32 = 32;
/// Radices of lines that one pass transforms whole, and of those that several do.
const WHOLE: [u32; 12] = [64, 40, 32, 24, 20, 16, 12, 10, 8, 6, 4, 2];
const IN_PASSES: [u32; 7] = [32, 20, 16, 12, 10, 8, 6];
/// The fewest lanes of a workgroup of a transform, and the fewest workgroups as long as there are more lanes.
const FEWEST_LANES: u64 = 8;
const FEWEST_WORKGROUPS: u64 = 8;
/// The most lanes of a workgroup whose lanes share butterflies, as `build/radices.rs` has it.
const MOST_SHARING: u64 = 64;

/// A transform of a field on a mesh.
pub(crate) struct Fourier {
    /// Edges of the mesh, that of z 1 in two dimensions: each a product of even radices.
    pub mesh: [u32; 3],
    /// The names of its kernels along x and along the other axes.
    pub names: [&'static str; 2],
    pub workgroup: u64,
    /// True if several lanes share a butterfly of many legs.
    pub by_lanes: bool,
    /// How the field comes in, and how it goes out.
    pub load: Load,
    pub store: Store,
}

/// An axis along which lines are transformed.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Axis {
    /// Rows, along x.
    Rows,
    /// Along y in two dimensions, along z in three.
    Columns,
    /// Along y in three dimensions.
    Slices,
}

/// One pass over all lines of an axis.
#[derive(Clone, Copy)]
struct Pass {
    axis: Axis,
    entry: Entry,
    load: Load,
    store: Store,
    radix: u32,
    /// Length of the transforms that are finished before.
    finished: u32,
    /// Where the pass's results belong: the length of the transforms finished before, or 1 where the transform turns back.
    span: u32,
}

impl Fourier {
    /// The kernels, in order. Data goes to and fro between `waves_next`, from which the first of them would load, and `waves`.
    pub(crate) fn kernels(&self) -> Vec<Kernel> {
        self.passes().into_iter().enumerate().map(|(number, pass)| self.kernel(pass, number)).collect()
    }

    /// The place of the kernel that turns back, and a kernel that leaves all waves where that would leave what it has begun to
    /// transform back: at (z height + y) columns + x.
    pub(crate) fn spectrum(&self) -> (usize, Kernel) {
        let passes = self.passes();
        let turn = passes.len() / 2;
        let pass = Pass { entry: Entry::FourierPass, span: passes[turn].finished, ..passes[turn] };
        (turn, self.kernel(pass, turn))
    }

    /// Waves along x that are kept.
    pub(crate) fn columns(&self) -> u32 {
        self.mesh[0] / 2 + 1
    }

    fn is_flat(&self) -> bool {
        self.mesh[2] == 1
    }

    /// Axes with the lengths of their lines, in the order in which they are transformed.
    fn axes(&self) -> Vec<(Axis, u32)> {
        let [width, height, depth] = self.mesh;
        if self.is_flat() {
            vec![(Axis::Rows, width), (Axis::Columns, height)]
        } else {
            vec![(Axis::Rows, width), (Axis::Columns, depth), (Axis::Slices, height)]
        }
    }

    /// Length of a line whose roots of unity are those of all lines.
    fn roots(&self) -> u32 {
        self.axes().into_iter().map(|(_, length)| length).fold(1, least_common_multiple)
    }

    fn passes(&self) -> Vec<Pass> {
        let axes: Vec<(Axis, Vec<u32>)> =
            self.axes().into_iter().map(|(axis, length)| (axis, radices(length))).collect();
        let mut passes = Vec::new();
        let mut line = |axis, radices: &[u32], mut finished: u32| {
            for &radix in radices {
                let (entry, load, store) = (Entry::FourierPass, Load::Waves, Store::Waves);
                passes.push(Pass { axis, entry, load, store, radix, finished, span: finished });
                finished *= radix;
            }
        };
        for (axis, radices) in &axes {
            line(*axis, radices, 1);
        }
        // The last pass forth is the first one back.
        if let Some(((axis, last), before)) = axes.split_last() {
            let (turn, others) = last.split_last().map_or((2, &[][..]), |(turn, others)| (*turn, others));
            line(*axis, others, turn);
            for (axis, radices) in before.iter().rev() {
                line(*axis, radices, 1);
            }
        }
        let (middle, last, rows) = (passes.len() / 2, passes.len() - 1, axes[0].1.len());
        (passes[middle].entry, passes[middle].span) = (Entry::FourierTurn, 1);
        let (separated, joined) =
            if self.is_flat() { (Load::Rows, Store::Rows) } else { (Load::Layers, Store::Layers) };
        passes[0].load = self.load;
        passes[rows].load = separated;
        passes[last - rows].store = joined;
        passes[last].store = self.store;
        passes
    }

    fn kernel(&self, pass: Pass, number: usize) -> Kernel {
        let [width, height, depth] = self.mesh;
        let (length, lines, axis) = match pass.axis {
            Axis::Rows => (width, height * depth / 2, Lines::Rows),
            Axis::Columns if self.is_flat() => (height, self.columns(), Lines::Columns),
            Axis::Columns => (depth, self.columns() * height, Lines::Columns),
            Axis::Slices => (height, self.columns() * depth, Lines::Slices),
        };
        let radix = match pass.radix {
            2 => Radix::Two,
            4 => Radix::Four,
            6 => Radix::Six,
            8 => Radix::Eight,
            10 => Radix::Ten,
            12 => Radix::Twelve,
            16 => Radix::Sixteen,
            20 => Radix::Twenty,
            24 => Radix::TwentyFour,
            32 => Radix::ThirtyTwo,
            40 => Radix::Forty,
            _ => Radix::SixtyFour,
        };
        let shared = self.shared(pass.radix);
        let twists = pass.finished > 1;
        let choices = Choices::new()
            .with(radix)
            .with_if(twists && shared.is_none(), Twist::BetweenPasses)
            .with_if(twists && shared.is_some(), SharedTwist::BetweenPasses)
            .with(axis)
            .with(pass.load)
            .with(pass.store);
        let mut constants = vec![
            (Constant::Length, f64::from(length)),
            (Constant::Lines, f64::from(lines)),
            (Constant::Span, f64::from(pass.span)),
            (Constant::Roots, f64::from(self.roots())),
            (Constant::RowLength, f64::from(width)),
        ];
        let (columns, height) =
            ((Constant::WaveColumns, f64::from(self.columns())), (Constant::MeshHeight, f64::from(height)));
        if pass.load == Load::Layers || pass.store == Store::Layers {
            constants.extend([columns, height]);
        } else if axis == Lines::Slices {
            constants.push(columns);
        }
        if axis == Lines::Slices && pass.entry == Entry::FourierTurn {
            constants.push((Constant::MeshDepth, f64::from(depth)));
        }
        let swapped = vec![(Array::Waves, Array::WavesNext), (Array::WavesNext, Array::Waves)];
        // A small mesh has few butterflies, which are to be shared out all the same.
        let butterflies = u64::from(lines) * u64::from(length / pass.radix);
        let lanes = butterflies * shared.unwrap_or(1);
        let share = (1_u64 << (lanes / FEWEST_WORKGROUPS).max(1).ilog2()).max(FEWEST_LANES);
        let workgroup = self.workgroup.min(share).min(if shared.is_some() { MOST_SHARING } else { u64::MAX });
        constants.push((Constant::Workgroup, workgroup as f64));
        let entry = match pass.entry {
            Entry::FourierPass if shared.is_some() => Entry::FourierPassOfLanes,
            Entry::FourierTurn if shared.is_some() => Entry::FourierTurnOfLanes,
            entry => entry,
        };
        let name = self.names[usize::from(pass.axis != Axis::Rows)];
        Kernel::new(name, entry, choices, lanes.div_ceil(workgroup))
            .with(constants)
            .renamed(if number.is_multiple_of(2) { swapped } else { Vec::new() })
    }

    /// Lanes that share a butterfly; none where each lane has one, or several.
    fn shared(&self, radix: u32) -> Option<u64> {
        match radix {
            _ if !self.by_lanes || self.workgroup < FEWEST_LANES => None,
            16 => Some(4),
            32 | 64 => Some(8),
            _ => None,
        }
    }

    /// The buffers between passes, and the roots of unity; not the weights of [`waves`], which are `symbols`.
    pub(crate) fn buffers(&self) -> Vec<Buffer> {
        let [_, height, depth] = self.mesh;
        let bytes = 8 * u64::from(height) * u64::from(depth) * u64::from(self.columns());
        let mut buffers = vec![scratch(Array::Waves, bytes), scratch(Array::WavesNext, bytes)];
        if self.passes().iter().any(|pass| pass.finished > 1) {
            let roots = self.roots();
            buffers.push(table(Array::Roots, (0..roots).flat_map(|index| root(index, roots))));
        }
        buffers
    }

    /// The factor by which the field is larger when it comes back.
    pub(crate) fn gain(&self) -> f64 {
        // Rows that went through as one come apart twice as large.
        2.0 * self.mesh.iter().map(|nodes| f64::from(*nodes)).product::<f64>()
    }
}

/// Waves of a mesh up to the middle of every axis, in the order of their weights: those along x next to each other, then those along z.
pub(crate) fn waves([width, height, depth]: [u32; 3]) -> impl Iterator<Item = [u32; 3]> {
    let of_row = move |l, m| (0..=width / 2).map(move |k| [k, l, m]);
    (0..=height / 2).flat_map(move |l| (0..=depth / 2).flat_map(move |m| of_row(l, m)))
}

/// A buffer of numbers.
pub(crate) fn table(array: Array, values: impl Iterator<Item = f32>) -> Buffer {
    let bytes: Vec<u8> = values.flat_map(f32::to_ne_bytes).collect();
    Buffer { array, bytes: bytes.len() as u64, contents: Contents::Bytes(bytes) }
}

/// A buffer of zeros.
pub(crate) fn scratch(array: Array, bytes: u64) -> Buffer {
    Buffer { array, bytes, contents: Contents::Zeros }
}

/// exp(-2πi index/count).
fn root(index: u32, count: u32) -> [f32; 2] {
    let angle = TAU * f64::from(index) / f64::from(count);
    [angle.cos() as f32, -angle.sin() as f32]
}

fn least_common_multiple(a: u32, b: u32) -> u32 {
    let (mut divisor, mut rest) = (a, b);
    while rest > 0 {
        (divisor, rest) = (rest, divisor % rest);
    }
    a / divisor * b
}

/// The radices of the passes along a line: as few as possible, and as equal.
fn radices(length: u32) -> Vec<u32> {
    if length.is_power_of_two() {
        let bits = length.trailing_zeros();
        let passes = if length <= WHOLE_LINE { 1 } else { bits.div_ceil(LARGEST_RADIX.trailing_zeros()) };
        return (0..passes).map(|pass| 1 << ((bits + passes - 1 - pass) / passes)).collect();
    }
    if WHOLE.contains(&length) {
        return vec![length];
    }
    (2..8).find_map(|passes| in_passes(length, passes, LARGEST_RADIX)).unwrap_or_default()
}

/// Radices of so many passes with a product, none larger than one: the smallest that the largest can be.
fn in_passes(length: u32, passes: u32, most: u32) -> Option<Vec<u32>> {
    if passes == 1 {
        return (length <= most && IN_PASSES.contains(&length)).then(|| vec![length]);
    }
    let first = IN_PASSES.iter().rev().filter(|radix| **radix <= most && length.is_multiple_of(**radix));
    let mut found = first.filter_map(|first| {
        let rest = in_passes(length / first, passes - 1, *first)?;
        Some([&[*first], &rest[..]].concat())
    });
    found.next()
}

/// True if a line of some nodes can be transformed.
pub(crate) fn is_transformable(length: u32) -> bool {
    length >= 2 && length.is_multiple_of(2) && !radices(length).is_empty()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn radices_make_the_length_in_few_passes() {
        for bits in 1_u32..=16 {
            let radices = radices(1 << bits);
            assert_eq!(radices.iter().product::<u32>(), 1 << bits);
            let least = radices.iter().min().copied().unwrap_or_default();
            let most = radices.iter().max().copied().unwrap_or_default();
            assert!(most <= 2 * least, "as equal as can be: {radices:?}");
            // Kernels of up to 64 points that are a whole line, and of up to 32 that are not.
            let largest = if bits <= 6 { 64_u64 } else { 32 };
            assert!(u64::from(most) <= largest);
            assert!(largest.pow(radices.len() as u32 - 1) < 1 << bits, "a pass too many: {radices:?}");
        }
    }

    #[test]
    fn lengths_with_factors_of_three_and_five() {
        for (length, expected) in [
            (6, vec![6]),
            (20, vec![20]),
            (40, vec![40]),
            (48, vec![8, 6]),
            (60, vec![10, 6]),
            (80, vec![10, 8]),
            (96, vec![12, 8]),
            (120, vec![12, 10]),
            (160, vec![16, 10]),
            (200, vec![20, 10]),
            (240, vec![20, 12]),
            (400, vec![20, 20]),
            (480, vec![10, 8, 6]),
        ] {
            assert_eq!(radices(length), expected, "{length}");
        }
        for length in [0, 1, 3, 5, 7, 14, 15, 18, 30, 50, 90] {
            assert!(!is_transformable(length), "{length}");
        }
        for length in (2..=1024).filter(|length| is_transformable(*length)) {
            assert_eq!(radices(length).iter().product::<u32>(), length);
            // Both are rows that go through as one.
            assert!(radices(length).iter().all(|radix| radix.is_multiple_of(2)));
        }
    }
}
