//! The Pareto front of cost and error.

/// Whether each of these pairs of cost and error is on the front: no other costs at most as much and errs at most as much, and
/// is better in one. Pairs that are not finite never are.
pub(super) fn front(choices: &[[f64; 2]]) -> Vec<bool> {
    let known = |pair: &[f64; 2]| pair.iter().all(|value| value.is_finite());
    let dominates = |a: &[f64; 2], b: &[f64; 2]| a[0] <= b[0] && a[1] <= b[1] && a != b;
    choices.iter().map(|own| known(own) && !choices.iter().any(|other| known(other) && dominates(other, own))).collect()
}

#[cfg(test)]
mod tests {
    use super::front;

    /// Worked out by hand: (2, 2) dominates (3, 3), (3, 1) dominates (4, 1).
    #[test]
    fn dominated_choices_are_not_on_the_front() {
        let choices =
            [[1.0, 5.0], [2.0, 2.0], [3.0, 3.0], [4.0, 1.0], [3.0, 1.0], [f64::NAN, 0.0], [0.5, f64::INFINITY]];
        assert_eq!(front(&choices), [true, true, false, false, true, false, false]);
        assert_eq!(front(&[[1.0, 1.0], [1.0, 1.0]]), [true, true]);
        assert!(front(&[]).is_empty());
    }
}
