//! Files of arrays of fields on a mesh.

use crate::families::pictures::{MeshPictures, ShownField};
use crate::output::{NetcdfFile, NetcdfValue, NetcdfVariable, OutputError, write_atomically, write_npy};
use crate::scene::{FieldFormat, FieldQuantity, Scene};
use std::path::Path;

/// Writes a file that holds these fields of a step, in the format that the scene asks for.
pub(super) fn write(
    path: &Path,
    held: &[FieldQuantity],
    pictures: &MeshPictures,
    scene: &Scene,
    step: u64,
    time: f64,
) -> Result<(), OutputError> {
    let format = scene.output.fields.as_ref().map(|asked| asked.format).unwrap_or_default();
    let mut fields = pictures.fields.iter().filter(|shown| held.contains(&shown.quantity));
    match format {
        FieldFormat::Netcdf => {
            let file = netcdf(&fields.collect::<Vec<_>>(), pictures, scene, step, time);
            write_atomically(path, |writer| file.write_to(writer))
        }
        FieldFormat::Npy => {
            let Some(ShownField { field, .. }) = fields.next() else { return Ok(()) };
            write_npy(path, &field.nodes, &field.values)
        }
    }
}

fn texts(all: &[(&str, &str)]) -> Vec<(String, NetcdfValue)> {
    all.iter().map(|(name, text)| ((*name).to_owned(), (*text).into())).collect()
}

/// A file of the fields of one time, by the CF conventions. All numbers are in units of the scene, which have no dimension.
fn netcdf(fields: &[&ShownField], pictures: &MeshPictures, scene: &Scene, step: u64, time: f64) -> NetcdfFile {
    let (nodes, lengths) = fields.first().map_or(([0; 2], [0.0; 2]), |shown| (shown.field.nodes, shown.field.lengths));
    let [columns, rows] = nodes;
    let program = format!("mesoscope {}", env!("CARGO_PKG_VERSION"));
    let source = format!("{program}: {}", pictures.method);
    let history = format!("step {step}, written by {program}");
    let mut attributes = texts(&[
        ("Conventions", "CF-1.11"),
        ("title", &scene.title),
        ("source", &source),
        ("history", &history),
        ("comment", "in units of the scene, which have no dimension; the mean depth is 1"),
    ]);
    attributes.extend(pictures.parameters.iter().map(|(name, value)| ((*name).to_owned(), (*value).into())));
    let coordinate = |name: &str, place: usize, axis: &str, long_name: &str, values: Vec<f64>| NetcdfVariable {
        name: name.to_owned(),
        dimensions: vec![place],
        attributes: texts(&[("long_name", long_name), ("units", "1"), ("axis", axis)]),
        values,
    };
    let nodes_along = |axis: usize| {
        let spacing = lengths[axis] / nodes[axis].max(1) as f64;
        (0..nodes[axis]).map(|node| node as f64 * spacing).collect()
    };
    let mut variables = vec![
        coordinate("time", 0, "T", "time in units of the scene", vec![time]),
        coordinate("y", 1, "Y", "y in length units", nodes_along(1)),
        coordinate("x", 2, "X", "x in length units", nodes_along(0)),
    ];
    variables.extend(fields.iter().map(|shown| {
        let described = &shown.described;
        let words = format!("in {}", described.unit.in_words(Some(2)));
        let mut attributes = texts(&[("long_name", described.meaning), ("units", "1"), ("comment", &words)]);
        attributes.extend(shown.standard_name.map(|name| ("standard_name".to_owned(), name.into())));
        // Of these the index of x runs fastest.
        let places = (0..rows).flat_map(|l| (0..columns).map(move |k| k * rows + l));
        NetcdfVariable {
            name: described.name.to_owned(),
            dimensions: vec![0, 1, 2],
            attributes,
            values: places.map(|place| shown.field.values[place]).collect(),
        }
    }));
    let dimensions =
        [("time", 1), ("y", rows), ("x", columns)].map(|(name, length)| (name.to_owned(), length)).to_vec();
    NetcdfFile { dimensions, attributes, variables }
}
