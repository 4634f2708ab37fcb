//! What pictures show: ranges of colours that have a length, of quantities that have a scale, and slices within the
//! box.

use super::{FieldQuantity, Problems, Scene, SnapshotColor, SnapshotSlice, SnapshotView};

/// Finds ranges of colours and parts of the box that cannot be shown.
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
    if let Some(slice) = snapshot.slice {
        check_slice(slice, scene, problems);
    }
    if snapshot.view != SnapshotView::Corner && scene.space.lengths.len() != 3 {
        let accepted = "no `view` of a box that has not three dimensions, which is seen from above";
        problems.refuse("output.snapshot.view", "a side of the box", accepted);
    }
    for quantity in FieldQuantity::ALL {
        if let Some(range) = scene.output.fields.as_ref().and_then(|fields| fields.ranges.of(quantity)) {
            check_range(&format!("output.fields.ranges.{}", quantity.stem()), range, problems);
        }
    }
}

/// A slice lies in a box of three dimensions and is no thicker than that.
fn check_slice(slice: SnapshotSlice, scene: &Scene, problems: &mut Problems) {
    let path = "output.snapshot.slice";
    let [_, _, _] = scene.space.lengths[..] else {
        let accepted = "no `slice` of a box that has not three dimensions, whose particles are all seen";
        return problems.refuse(path, "a part of the box", accepted);
    };
    let (axis, length) = (slice.axis, scene.space.lengths[slice.axis as usize]);
    if slice.position > length {
        let accepted = format!("a place along {axis} in the box: 0 to {length}");
        problems.refuse(format!("{path}.position"), slice.position, accepted);
    }
    if slice.thickness > length {
        let accepted = format!("at most {length}, the length of the box along {axis}");
        problems.refuse(format!("{path}.thickness"), slice.thickness, accepted);
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
