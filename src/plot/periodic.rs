//! Shapes in a periodic box, and their images that show there too.

/// By how much to move what reaches from a place to another along each axis, and is no longer than the box, so that a
/// part of it is in the box: not at all, and where it stands out to the other side.
pub(super) fn images(reach: [[f64; 2]; 2], lengths: [f64; 2]) -> Vec<[f64; 2]> {
    let [along_x, along_y] = [0, 1].map(|axis| {
        let ([low, high], length) = (reach[axis], lengths[axis]);
        let seen = move |shift: &f64| high + shift > 0.0 && low + shift < length;
        std::iter::once(0.0).chain([-length, length].into_iter().filter(seen))
    });
    along_x.flat_map(|x| along_y.clone().map(move |y| [x, y])).collect()
}

/// A segment, in fractions of the box.
pub(super) type Segment = ([f64; 2], [f64; 2]);

/// The segments of a curve: every one starts in the box, in fractions of it, and takes the shortest way to the next
/// point; where it leaves the box there are further images of it, which come in again on the other side.
pub(super) fn segments(points: &[[f64; 2]], closed: bool, lengths: [f64; 2]) -> Vec<Segment> {
    let following = points.iter().skip(1).chain(points.first().filter(|_| closed));
    let mut segments = Vec::new();
    for (from, to) in points.iter().zip(following) {
        let begin = [0, 1].map(|axis| (from[axis] / lengths[axis]).rem_euclid(1.0));
        let way = [0, 1].map(|axis| (to[axis] - from[axis]) / lengths[axis]).map(|way| way - way.round());
        if begin.iter().chain(&way).all(|value| value.is_finite()) {
            let end = [begin[0] + way[0], begin[1] + way[1]];
            let reach = [0, 1].map(|axis| [begin[axis].min(end[axis]), begin[axis].max(end[axis])]);
            let moved = |[x, y]: [f64; 2]| ([begin[0] + x, begin[1] + y], [end[0] + x, end[1] + y]);
            segments.extend(images(reach, [1.0; 2]).into_iter().map(moved));
        }
    }
    segments
}

#[cfg(test)]
mod tests {
    use super::*;

    const LENGTHS: [f64; 2] = [8.0, 4.0];

    #[test]
    fn a_segment_within_the_box_stays_one() {
        assert_eq!(segments(&[[2.0, 1.0], [4.0, 1.0]], false, LENGTHS), [([0.25, 0.25], [0.5, 0.25])]);
        assert_eq!(segments(&[[2.0, 1.0], [4.0, 1.0]], true, LENGTHS).len(), 2);
        assert_eq!(segments(&[[2.0, 1.0]], false, LENGTHS), []);
        assert_eq!(segments(&[], true, LENGTHS), []);
    }

    #[test]
    fn a_segment_across_an_edge_comes_in_again_on_the_other_side() {
        let expected = [([0.875, 0.25], [1.125, 0.25]), ([-0.125, 0.25], [0.125, 0.25])];
        // The same points, wrapped into the box and not.
        assert_eq!(segments(&[[7.0, 1.0], [1.0, 1.0]], false, LENGTHS), expected);
        assert_eq!(segments(&[[7.0, 1.0], [9.0, 5.0]], false, LENGTHS), expected);
        assert_eq!(segments(&[[7.0, 3.5], [1.0, 0.5]], false, LENGTHS).len(), 4, "across a corner");
    }

    #[test]
    fn what_is_not_finite_is_a_gap() {
        let points = [[1.0, 1.0], [2.0, 1.0], [f64::NAN, 1.0], [4.0, 1.0], [5.0, 1.0]];
        assert_eq!(segments(&points, false, LENGTHS).len(), 2);
    }
}
