//! How far what a run draws is from that of a finer run, and from what is exact: fields on nodes, and the radial distribution function.

use super::measures::Measured;
use crate::families::{Checked, PictureKind};
use crate::output::{RunDirectory, files as run_files, read_npy, read_table};
use crate::scene::{AnalysisId, FieldFormat, FieldQuantity};
use crate::study::{StudyError, by_key, each_once};
use crate::table::Table;

/// How the names of these measures end.
pub(super) const DISTANCE: &str = "_distance";
pub(super) const FROM_EXACT: &str = "_from_exact";

/// Fields whose distances are one: the components of a vector.
const VELOCITY: [&str; 2] = ["velocity_x", "velocity_y"];

/// What the distance of a field is called by.
fn compared_as(field: &str) -> &str {
    if VELOCITY.contains(&field) { "velocity" } else { field }
}

/// The names of the distances of fields, each once.
pub(super) fn names(fields: impl Iterator<Item = FieldQuantity>, end: &str) -> Vec<String> {
    each_once(fields.map(|field| format!("{}{end}", compared_as(field.stem()))))
}

/// An array and its shape.
type Array = (Vec<usize>, Vec<f64>);

/// Σ(a-b)² and Σ(b-⟨b⟩)² of a field a and another b.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Squares {
    between: f64,
    scale: f64,
}

/// √(Σ(a-b)²/Σ(b-⟨b⟩)²) by name, over both components of a velocity, where all of them are compared.
fn distances_of(fields: Vec<(&str, Option<Squares>)>, end: &str, standard_error: Option<f64>) -> Vec<Measured> {
    let distance = |(name, parts): (&str, Vec<Option<Squares>>)| {
        let parts: Vec<Squares> = parts.into_iter().collect::<Option<_>>()?;
        let sum = |of: fn(&Squares) -> f64| parts.iter().map(of).sum::<f64>();
        let distance = (sum(|part| part.between) / sum(|part| part.scale)).sqrt();
        let measured = || Measured::from_one_sample(format!("{name}{end}"), distance, standard_error);
        distance.is_finite().then(measured)
    };
    let named = fields.into_iter().map(|(field, squares)| (compared_as(field), squares));
    by_key(named).into_iter().filter_map(distance).collect()
}

/// The distances of a run from a finer one at the same time, by name: √(Σ(a-b)²/Σ(b-⟨b⟩)²) for every field that both leave on common
/// nodes, and √(Σ(g-g')²/n) for radial distributions on the same bins.
pub(super) fn distances(run: &RunDirectory, finer: &RunDirectory) -> Result<Vec<Measured>, StudyError> {
    let mut fields = Vec::new();
    for field in run_files::FIELDS {
        let [own, other] = [run, finer].map(|place| place.file(&run_files::field(field, None, "npy")));
        if own.exists() && other.exists() {
            fields.push((field, on_common_nodes(&read_npy(&own)?, &read_npy(&other)?)));
        }
    }
    let mut found = distances_of(fields, DISTANCE, None);
    let name = AnalysisId::RadialDistribution.name();
    let [own, other] = [run, finer].map(|place| place.file(&format!("{name}.csv")));
    if own.exists() && other.exists() {
        let [own, other] = [read_table(&own)?, read_table(&other)?];
        // Of several pairs of species the curves of all; a pair without particles has none.
        let values = |table: &Table| -> Vec<f64> {
            let is_curve = |column: &&String| column.starts_with(name) && !column.ends_with("_error");
            table.columns.iter().filter(is_curve).flat_map(|column| table.values(column)).collect()
        };
        let (own_values, other_values) = (values(&own), values(&other));
        let differences = own_values.iter().zip(&other_values).map(|(a, b)| (a - b).powi(2));
        let squares: Vec<f64> = differences.filter(|square| square.is_finite()).collect();
        if own.columns == other.columns && own_values.len() == other_values.len() && !squares.is_empty() {
            let distance = (squares.iter().sum::<f64>() / squares.len() as f64).sqrt();
            found.push(Measured::from_one_sample(format!("{name}{DISTANCE}"), distance, None));
        }
    }
    Ok(found)
}

/// Fields that say how far a flow is from another, whatever a scene draws.
const FLOW: [FieldQuantity; 3] = [FieldQuantity::Depth, FieldQuantity::VelocityX, FieldQuantity::VelocityY];

/// The fields that are compared at the end of a scene: those that it draws, its depth and its velocity.
pub(super) fn compared(scene: &Checked) -> Vec<FieldQuantity> {
    if scene.model().picture() != PictureKind::Fields {
        return Vec::new();
    }
    each_once(scene.output.fields.clone().unwrap_or_default().quantities.into_iter().chain(FLOW))
}

/// The scene, which leaves all fields that are compared.
pub(super) fn leaving_compared(scene: Checked) -> Checked {
    let quantities = compared(&scene);
    if quantities.is_empty() {
        return scene;
    }
    scene.changed(|scene| {
        let fields = scene.output.fields.get_or_insert_default();
        // They are compared from arrays of their own.
        (fields.quantities, fields.format) = (quantities, FieldFormat::Npy);
    })
}

/// The names of the distances of a scene from an exact solution, if it has one.
pub(super) fn names_from_exact(scene: &Checked) -> Vec<String> {
    let is_known = |field: &FieldQuantity| scene.model().physics().steady_field(*field, scene).is_some();
    names(compared(scene).into_iter().filter(is_known), FROM_EXACT)
}

/// The distances of the fields that a run has drawn from those of the steady flow that it starts with, measured as those from a
/// finer run.
pub(super) fn from_exact(scene: &Checked, run: &RunDirectory) -> Result<Vec<Measured>, StudyError> {
    let mut fields = Vec::new();
    for field in compared(scene) {
        let Some(exact) = scene.model().physics().steady_field(field, scene) else { continue };
        let own = read_npy(&run.file(&run_files::field(field.stem(), None, "npy")))?;
        let exact = (own.0.clone(), exact);
        fields.push((field.stem(), on_common_nodes(&own, &exact)));
    }
    Ok(distances_of(fields, FROM_EXACT, Some(0.0)))
}

/// The squares on the nodes that both meshes have; none where they are not multiples of each other.
fn on_common_nodes(own: &Array, other: &Array) -> Option<Squares> {
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
    let scale = other.iter().map(|value| (value - mean).powi(2)).sum();
    let between = own.iter().zip(&other).map(|(a, b)| (a - b).powi(2)).sum();
    Some(Squares { between, scale })
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
        assert_eq!(on_common_nodes(&coarse, &fine), Some(Squares { between: 0.0, scale: 20.0 }));
        // Differences of one on values that scatter by 5 in the mean square.
        let off = (vec![2, 2], vec![1.0, 3.0, 5.0, 7.0]);
        assert_eq!(on_common_nodes(&off, &fine), Some(Squares { between: 4.0, scale: 20.0 }));
        assert_eq!(on_common_nodes(&(vec![3, 2], vec![0.0; 6]), &fine), None);
        assert_eq!(on_common_nodes(&(vec![2], vec![0.0; 2]), &fine), None);
    }

    #[test]
    fn a_velocity_is_one_vector_whose_direction_counts() {
        let squares = |between, scale| Some(Squares { between, scale });
        let fields = vec![
            ("depth", squares(4.0, 16.0)),
            ("velocity_x", squares(0.0, 2.0)),
            ("velocity_y", squares(32.0, 6.0)),
            ("speed", squares(0.0, 0.0)),
        ];
        // A flow along y that is turned round has the same speed, and is twice its own size away.
        let found = |fields| -> Vec<(String, f64)> {
            let found = distances_of(fields, DISTANCE, None).into_iter();
            found.map(|found| (found.measure, found.value)).collect()
        };
        assert_eq!(found(fields), [("depth_distance".to_owned(), 0.5), ("velocity_distance".to_owned(), 2.0)]);
        assert_eq!(found(vec![("velocity_x", squares(1.0, 1.0)), ("velocity_y", None)]), []);
    }
}
