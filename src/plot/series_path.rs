//! From points of a series to line segments in pixels: gaps, thinning, clipping, dashes.

use super::canvas::Area;

/// A connected piece of a line, in pixels.
pub(super) type Run = Vec<[f64; 2]>;

/// Splits points into connected runs at every point that has no place in the panel.
pub(super) fn runs(points: &[[f64; 2]], place: impl Fn([f64; 2]) -> Option<[f64; 2]>) -> Vec<Run> {
    let finite = |pixel: &[f64; 2]| pixel.iter().all(|coordinate| coordinate.is_finite());
    let pixels: Vec<Option<[f64; 2]>> = points.iter().map(|point| place(*point).filter(finite)).collect();
    let pieces = pixels.split(Option::is_none).filter(|piece| !piece.is_empty());
    pieces.map(|piece| piece.iter().flatten().copied().collect()).collect()
}

/// Keeps the first, lowest, highest and last of all neighbouring points in one pixel column: the picture stays the same.
pub(super) fn thinned(run: &[[f64; 2]]) -> Run {
    let mut kept = Run::new();
    for group in run.chunk_by(|a, b| a[0].floor() == b[0].floor()) {
        let length = group.len();
        if length <= 4 {
            kept.extend_from_slice(group);
        } else {
            let by_height = |a: &usize, b: &usize| group[*a][1].total_cmp(&group[*b][1]);
            // The first of several that are as low or as high.
            let low = (0..length).min_by(by_height).unwrap_or_default();
            let high = (0..length).rev().max_by(by_height).unwrap_or_default();
            let mut chosen = vec![0, low, high, length - 1];
            chosen.sort_unstable();
            chosen.dedup();
            kept.extend(chosen.into_iter().map(|index| group[index]));
        }
    }
    kept
}

/// Length of a run in pixels, inside an area.
pub(super) fn length(run: &[[f64; 2]], area: &Area) -> f64 {
    run.windows(2).filter_map(|pair| clipped(pair[0], pair[1], area)).map(|(from, to)| distance(from, to)).sum()
}

fn distance(a: [f64; 2], b: [f64; 2]) -> f64 {
    (b[0] - a[0]).hypot(b[1] - a[1])
}

/// The part of a segment inside an area, by Liang and Barsky's parameters.
pub(super) fn clipped(from: [f64; 2], to: [f64; 2], area: &Area) -> Option<([f64; 2], [f64; 2])> {
    let (mut enter, mut leave) = (0.0_f64, 1.0_f64);
    let step = [to[0] - from[0], to[1] - from[1]];
    for (axis, low, high) in [(0, area.left, area.right), (1, area.top, area.bottom)] {
        if step[axis] == 0.0 {
            if from[axis] < low || from[axis] > high {
                return None;
            }
            continue;
        }
        let (a, b) = ((low - from[axis]) / step[axis], (high - from[axis]) / step[axis]);
        enter = enter.max(a.min(b));
        leave = leave.min(a.max(b));
    }
    let at = |t: f64| [from[0] + t * step[0], from[1] + t * step[1]];
    (enter <= leave).then(|| (at(enter), at(leave)))
}

/// Segments of a run inside an area, cut into dashes: lengths drawn and skipped in turn, in pixels. No lengths at all
/// make a solid line.
pub(super) fn segments(run: &[[f64; 2]], area: &Area, dashes: &[f64]) -> Vec<([f64; 2], [f64; 2])> {
    let mut segments = Vec::new();
    if run.len() == 1 && area.contains(run[0]) {
        segments.push((run[0], run[0]));
    }
    let period: f64 = dashes.iter().sum();
    let mut travelled = 0.0;
    for pair in run.windows(2) {
        let whole = distance(pair[0], pair[1]);
        let Some((from, to)) = clipped(pair[0], pair[1], area) else {
            travelled += whole;
            continue;
        };
        if dashes.is_empty() || period <= 0.0 {
            segments.push((from, to));
            continue;
        }
        let inside = distance(from, to);
        let start = travelled + distance(pair[0], from);
        let at = |s: f64| {
            let t = if inside > 0.0 { s / inside } else { 0.0 };
            [from[0] + t * (to[0] - from[0]), from[1] + t * (to[1] - from[1])]
        };
        // Position within the pattern at the start of this segment, then one dash or gap after the other.
        let mut phase = start.rem_euclid(period);
        let mut index = 0;
        while phase >= dashes[index] && index + 1 < dashes.len() {
            phase -= dashes[index];
            index += 1;
        }
        let mut done = 0.0;
        while done < inside {
            let next = (done + dashes[index] - phase).min(inside);
            if index.is_multiple_of(2) {
                segments.push((at(done), at(next)));
            }
            if next <= done && dashes[index] > phase {
                break;
            }
            done = next;
            phase = 0.0;
            index = (index + 1) % dashes.len();
        }
        travelled += whole;
    }
    segments
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    const AREA: Area = Area { left: 0.0, top: 0.0, right: 100.0, bottom: 100.0 };

    #[test]
    fn thinning_keeps_extremes_and_ends() {
        let mut run: Run = (0..100_000).map(|i| [f64::from(i) * 1e-3, 50.0 + f64::from(i % 7)]).collect();
        run[54_321][1] = -1e3;
        run[77_777][1] = 1e3;
        let thin = thinned(&run);
        assert!(thin.len() <= 400);
        assert!(thin.contains(&run[54_321]) && thin.contains(&run[77_777]));
        assert_eq!((thin[0], thin[thin.len() - 1]), (run[0], run[99_999]));
        assert!(thin.windows(2).all(|pair| pair[0][0] <= pair[1][0]), "order is kept");
    }

    #[test]
    fn a_point_without_a_place_is_a_gap() {
        let points = [[0.0, 1.0], [1.0, 2.0], [2.0, f64::NAN], [3.0, 1.0]];
        let pieces = runs(&points, |p| p[1].is_finite().then_some(p));
        assert_eq!(pieces.iter().map(Vec::len).collect::<Vec<_>>(), [2, 1]);
    }

    #[test]
    fn clipping_keeps_the_line() {
        let (from, to) = clipped([-1e9, -1e9], [1e9, 1e9], &AREA).unwrap();
        assert!((from[0] - from[1]).abs() < 1e-6 && from[0].abs() < 1e-6 && (to[0] - 100.0).abs() < 1e-6);
        assert!(clipped([-5.0, 0.0], [-5.0, 100.0], &AREA).is_none());
    }

    #[test]
    fn dashes_cover_their_share_of_the_length() {
        let run: Run = (0..=100).map(|i| [f64::from(i), 50.0]).collect();
        let drawn: f64 = segments(&run, &AREA, &[6.0, 4.0]).iter().map(|(a, b)| distance(*a, *b)).sum();
        assert!((drawn - 60.0).abs() < 1e-6, "{drawn}");
        let solid: f64 = segments(&run, &AREA, &[]).iter().map(|(a, b)| distance(*a, *b)).sum();
        assert!((solid - 100.0).abs() < 1e-9);
    }
}
