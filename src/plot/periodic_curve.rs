//! Lines in a periodic box, as segments inside one image of it.

/// A segment, in fractions of the box.
pub(super) type Segment = ([f64; 2], [f64; 2]);

/// The segments of a curve: every one starts in the box, in fractions of it, and takes the shortest way to the next
/// point; where it leaves the box there are further images of it, which come in again on the other side.
pub(super) fn segments(points: &[[f64; 2]], closed: bool, lengths: [f64; 2]) -> Vec<Segment> {
    let following = points.iter().skip(1).chain(points.first().filter(|_| closed));
    points.iter().zip(following).flat_map(|(from, to)| images(*from, *to, lengths)).collect()
}

fn images(from: [f64; 2], to: [f64; 2], lengths: [f64; 2]) -> Vec<Segment> {
    let start = [0, 1].map(|axis| (from[axis] / lengths[axis]).rem_euclid(1.0));
    let way = [0, 1].map(|axis| {
        let way = (to[axis] - from[axis]) / lengths[axis];
        way - way.round()
    });
    if start.iter().chain(&way).any(|value| !value.is_finite()) {
        return Vec::new();
    }
    // The box and, where the segment ends outside it, the neighbour that holds the end.
    let shifts = [0, 1].map(|axis| {
        let end = start[axis] + way[axis];
        let outside = if end < 0.0 {
            Some(1.0)
        } else if end > 1.0 {
            Some(-1.0)
        } else {
            None
        };
        [Some(0.0), outside]
    });
    let mut images = Vec::new();
    for shift_x in shifts[0].into_iter().flatten() {
        for shift_y in shifts[1].into_iter().flatten() {
            let begin = [start[0] + shift_x, start[1] + shift_y];
            images.push((begin, [begin[0] + way[0], begin[1] + way[1]]));
        }
    }
    images
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
