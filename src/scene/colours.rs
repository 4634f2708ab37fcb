//! What pictures show by colour: ranges that have a length, of quantities that have a scale.

use super::{Problems, Scene, SnapshotColor};

/// Finds ranges of colours that cannot be shown.
pub(super) fn check(scene: &Scene, problems: &mut Problems) {
    let snapshot = &scene.output.snapshot;
    if let Some(range) = snapshot.range {
        let path = "output.snapshot.range";
        if snapshot.color == SnapshotColor::Species {
            let accepted = "no `range` for colours of species; with `\"color\": \"speed\"` colours are a scale";
            problems.refuse(path, "a range of colours", accepted);
        }
        check_range(path, range, problems);
    }
    let ranges = scene.output.fields.as_ref().map(|fields| &fields.ranges);
    for (name, range) in ranges.into_iter().flat_map(|ranges| {
        [
            ("depth", ranges.depth),
            ("potential_vorticity", ranges.potential_vorticity),
            ("vorticity", ranges.vorticity),
            ("speed", ranges.speed),
            ("velocity_x", ranges.velocity_x),
            ("velocity_y", ranges.velocity_y),
        ]
    }) {
        if let Some(range) = range {
            check_range(&format!("output.fields.ranges.{name}"), range, problems);
        }
    }
}

/// A scale of values beyond this would overflow in single precision.
const LARGEST: f64 = 1e30;

fn check_range(path: &str, [low, high]: [f64; 2], problems: &mut Problems) {
    let wide = high - low > 1e-9 * low.abs().max(high.abs());
    if !(wide && low.abs() <= LARGEST && high.abs() <= LARGEST) {
        let accepted = "the lowest value and a higher one, both within 1e30, such as [0, 4]";
        problems.refuse(path, format!("[{low}, {high}]"), accepted);
    }
}
