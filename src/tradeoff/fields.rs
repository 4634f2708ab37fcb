//! How far what a run draws is from that of a finer run: fields on nodes, and the radial distribution function.

use super::error::TradeoffError;
use super::measures::Measured;
use crate::output::{RunDirectory, files as run_files, read_npy, read_table};
use crate::scene::AnalysisId;

/// How the names of these measures end.
pub(super) const DISTANCE: &str = "_distance";

/// An array and its shape.
type Array = (Vec<usize>, Vec<f64>);

/// The distances of a run from a finer one at the same time, by name: √(Σ(a-b)²/Σ(b-⟨b⟩)²) for every field that both leave on common
/// nodes, and √(Σ(g-g')²/n) for radial distributions on the same bins.
pub(super) fn distances(run: &RunDirectory, finer: &RunDirectory) -> Result<Vec<Measured>, TradeoffError> {
    let mut found = Vec::new();
    for field in run_files::FIELDS {
        let [own, other] = [run, finer].map(|place| place.file(&run_files::field(field, None, "npy")));
        if own.exists()
            && other.exists()
            && let Some(distance) = on_common_nodes(&read_npy(&own)?, &read_npy(&other)?)
        {
            found.push(measured(field, distance));
        }
    }
    let name = AnalysisId::RadialDistribution.name();
    let [own, other] = [run, finer].map(|place| place.file(&format!("{name}.csv")));
    if own.exists() && other.exists() {
        let [own, other] = [read_table(&own)?, read_table(&other)?];
        if let (Some(own), Some(other)) = (own.column(name), other.column(name))
            && own.len() == other.len()
            && !own.is_empty()
        {
            let squares: f64 = own.iter().zip(&other).map(|(a, b)| (a - b).powi(2)).sum();
            found.push(measured(name, (squares / own.len() as f64).sqrt()));
        }
    }
    Ok(found)
}

fn measured(name: &str, value: f64) -> Measured {
    Measured { measure: format!("{name}{DISTANCE}"), value, standard_error: None, fluctuates: false }
}

/// The distance on the nodes that both meshes have; none where they are not multiples of each other.
fn on_common_nodes(own: &Array, other: &Array) -> Option<f64> {
    let ([own_shape, other_shape], dimensions) = ([&own.0, &other.0], own.0.len());
    if dimensions != other_shape.len() || own_shape.contains(&0) || other_shape.contains(&0) {
        return None;
    }
    let common: Vec<usize> = own_shape.iter().zip(other_shape).map(|(a, b)| *a.min(b)).collect();
    let nests = |shape: &[usize]| shape.iter().zip(&common).all(|(length, common)| length % common == 0);
    if !nests(own_shape) || !nests(other_shape) {
        return None;
    }
    let [own, other] = [own, other].map(|array| sampled(array, &common));
    let mean = other.iter().sum::<f64>() / other.len() as f64;
    let scale: f64 = other.iter().map(|value| (value - mean).powi(2)).sum();
    let squares: f64 = own.iter().zip(&other).map(|(a, b)| (a - b).powi(2)).sum();
    let distance = (squares / scale).sqrt();
    distance.is_finite().then_some(distance)
}

/// The values of an array on every node of a coarser mesh, the last index fastest.
fn sampled((shape, values): &Array, common: &[usize]) -> Vec<f64> {
    let count: usize = common.iter().product();
    let value = |number: usize| {
        let (mut rest, mut place, mut stride) = (number, 0, 1);
        for (length, coarse) in shape.iter().zip(common).rev() {
            place += rest % coarse * (length / coarse) * stride;
            rest /= coarse;
            stride *= length;
        }
        values.get(place).copied().unwrap_or(f64::NAN)
    };
    (0..count).map(value).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn fields_are_compared_on_the_nodes_that_both_have() {
        let coarse = (vec![2, 2], vec![0.0, 2.0, 4.0, 6.0]);
        let fine = (vec![4, 2], vec![0.0, 2.0, 9.0, 9.0, 4.0, 6.0, 9.0, 9.0]);
        assert_eq!(on_common_nodes(&coarse, &fine), Some(0.0));
        // Differences of one on values that scatter by 5 in the mean square.
        let off = (vec![2, 2], vec![1.0, 3.0, 5.0, 7.0]);
        let distance = on_common_nodes(&off, &fine).unwrap_or(0.0);
        assert!((distance - (1.0_f64 / 5.0).sqrt()).abs() < 1e-15);
        assert_eq!(on_common_nodes(&(vec![3, 2], vec![0.0; 6]), &fine), None);
        assert_eq!(on_common_nodes(&(vec![2], vec![0.0; 2]), &fine), None);
    }
}
