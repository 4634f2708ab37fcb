//! How far what a run draws is from that of a finer run, and from what is exact: fields on nodes, and the radial distribution function.

use super::measures::Measured;
use crate::families::{Model, PictureKind};
use crate::output::{RunDirectory, files as run_files, read_npy, read_table};
use crate::scene::{AnalysisId, FieldQuantity, Scene};
use crate::study::StudyError;

/// How the names of these measures end.
pub(super) const DISTANCE: &str = "_distance";
pub(super) const FROM_EXACT: &str = "_from_exact";

/// An array and its shape.
type Array = (Vec<usize>, Vec<f64>);

/// The distances of a run from a finer one at the same time, by name: √(Σ(a-b)²/Σ(b-⟨b⟩)²) for every field that both leave on common
/// nodes, and √(Σ(g-g')²/n) for radial distributions on the same bins.
pub(super) fn distances(run: &RunDirectory, finer: &RunDirectory) -> Result<Vec<Measured>, StudyError> {
    let mut found = Vec::new();
    for field in run_files::FIELDS {
        let [own, other] = [run, finer].map(|place| place.file(&run_files::field(field, None, "npy")));
        if own.exists()
            && other.exists()
            && let Some(distance) = on_common_nodes(&read_npy(&own)?, &read_npy(&other)?)
        {
            found.push(measured(field, DISTANCE, distance));
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
            found.push(measured(name, DISTANCE, (squares / own.len() as f64).sqrt()));
        }
    }
    Ok(found)
}

fn measured(name: &str, end: &str, value: f64) -> Measured {
    let measure = format!("{name}{end}");
    Measured { measure, value, standard_error: None, fluctuates: false, from_few_samples: false }
}

/// Fields that say how far a flow is from another, whatever a scene draws.
const FLOW: [FieldQuantity; 2] = [FieldQuantity::Depth, FieldQuantity::Speed];

/// The fields that are compared at the end of a scene: those that it draws, its depth and its speed.
pub(super) fn compared(scene: &Scene, model: &Model) -> Vec<FieldQuantity> {
    if model.picture() != PictureKind::Fields {
        return Vec::new();
    }
    let mut fields = scene.output.fields.clone().unwrap_or_default().quantities;
    for field in FLOW {
        if !fields.contains(&field) {
            fields.push(field);
        }
    }
    fields
}

/// The scene, which leaves all fields that are compared.
pub(super) fn leaving_compared(scene: Scene) -> Scene {
    let quantities = compared(&scene, &Model::new(&scene));
    let mut scene = scene;
    if !quantities.is_empty() {
        scene.output.fields.get_or_insert_default().quantities = quantities;
    }
    scene
}

/// The names of the distances of a scene from an exact solution, if it has one.
pub(super) fn names_from_exact(scene: &Scene, model: &Model) -> impl Iterator<Item = String> {
    let is_known = |field: &FieldQuantity| model.physics().steady_field(*field, scene, model).is_some();
    compared(scene, model).into_iter().filter(is_known).map(|field| format!("{}{FROM_EXACT}", field.stem()))
}

/// The distances of the fields that a run has drawn from those of the steady flow that it starts with, measured as those from a
/// finer run.
pub(super) fn from_exact(scene: &Scene, run: &RunDirectory) -> Result<Vec<Measured>, StudyError> {
    let model = Model::new(scene);
    let mut found = Vec::new();
    for field in compared(scene, &model) {
        let Some(exact) = model.physics().steady_field(field, scene, &model) else { continue };
        let own = read_npy(&run.file(&run_files::field(field.stem(), None, "npy")))?;
        let exact = (own.0.clone(), exact);
        if let Some(distance) = on_common_nodes(&own, &exact) {
            found.push(Measured { standard_error: Some(0.0), ..measured(field.stem(), FROM_EXACT, distance) });
        }
    }
    Ok(found)
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
