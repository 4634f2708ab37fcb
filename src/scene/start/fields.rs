//! A start of water: from depth and velocities on the nodes of a mesh, of `.npz` and `NetCDF` files, or from the particles of an earlier run.

use super::{
    FileStart, KeptStart, Origin, Problems, Scene, SceneError, SpeciesNames, StateFile, StateFiles, StateVelocities,
    checkpoint, shared,
};
use crate::document::{Change, FilePlaces, MeshFields, OutsidePositions, ParticleGroup, Velocities, brief};
use crate::numbers::{counted, short};
use crate::state::State;
use crate::state_file::arrays::{Array, ArrayFile};
use crate::state_file::{self, Mistake, quoted};
use std::path::Path;
use std::sync::Arc;

/// The names of a field in a file: the one that runs write, and the letter of equations.
const DEPTH: [&str; 2] = ["depth", "h"];
const VELOCITY: [[&str; 2]; 2] = [["velocity_x", "u"], ["velocity_y", "v"]];

/// How far the mean depth of a file may be from 1, the mean of all scenes.
const MEAN: f64 = 1e-4;

/// Reads the fields of a scene on a mesh of so many nodes, and completes the scene by the checksum.
///
/// # Errors
/// [`SceneError::StateChanged`] if the file is not what it was.
pub(super) fn read(
    scene: &mut Scene,
    state: &StateFile,
    mesh: [u32; 2],
    path: &Path,
    files: &StateFiles,
) -> Result<Problems, SceneError> {
    let mut problems = Problems::default();
    check_scene(scene, state, &mut problems);
    let read = match checkpoint::of(path) {
        Some(checkpoint) => places_of_run(scene, &checkpoint, state, mesh).map_err(|mistake| vec![mistake]),
        None => fields(path, state, mesh.map(|nodes| nodes as usize), &scene.space.lengths)
            .map(|fields| (FilePlaces { fields: Some(Arc::new(fields)), ..FilePlaces::default() }, Vec::new())),
    };
    let (places, changes) = match read {
        Ok(read) => read,
        Err(mistakes) if files.known(state).is_some() => {
            let reason = mistakes.first().map(|mistake| mistake.found.clone()).unwrap_or_default();
            return Err(SceneError::StateChanged { path: path.to_path_buf(), reason });
        }
        Err(mistakes) => {
            super::refuse(state, mistakes, &mut problems);
            return Ok(problems);
        }
    };
    let checksum = checksum(&places);
    files.check(path, state, &checksum)?;
    super::adopt_checksum(scene, state, checksum, &mut problems);
    if !problems.is_empty() {
        return Ok(problems);
    }
    let names = SpeciesNames::of(scene);
    let of_nodes = places.fields.iter().flat_map(|fields| fields.velocity.iter().flatten().flatten());
    let components = of_nodes.chain(places.velocities.iter().flatten());
    let fastest = components.fold(0.0, |most: f64, part| most.max(part.abs()));
    let start = FileStart {
        copies: [1; 3],
        fastest: vec![fastest; names.count()],
        origin: Some(Origin::Anew),
        changes,
        places: Some(places),
        // The groups of the scene say how many particles there are.
        ..FileStart::default()
    };
    scene.kept = KeptStart::of(shared(start));
    Ok(problems)
}

/// What a scene of water with a file has to be, whatever the file says.
fn check_scene(scene: &Scene, state: &StateFile, problems: &mut Problems) {
    let keys = [
        ("replicate", !state.replicate.is_empty()),
        ("atom_style", state.atom_style.is_some()),
        ("outside", state.outside != OutsidePositions::Refuse),
    ];
    for (key, _) in keys.iter().filter(|(_, given)| *given) {
        let accepted = format!("no `{key}`: fields have a value on every node");
        problems.refuse(format!("state.{key}"), "in a scene that starts from fields", accepted);
    }
    for (index, group) in scene.particles.iter().enumerate() {
        let ParticleGroup { velocities, file_type, .. } = group;
        if *velocities != Velocities::Thermal {
            let accepted = "no `velocities`: `state.velocities` is `file`, `thermal` or `rest` for all particles";
            problems.refuse(format!("particles[{index}].velocities"), "beside a `state`", accepted);
        }
        if file_type.is_some() {
            let accepted = "no `type`: fields have no particles";
            problems.refuse(format!("particles[{index}].type"), "in a scene that starts from fields", accepted);
        }
    }
}

/// Particles, masses and velocities of an earlier run on the same mesh, whose scene may differ in all else that acts on
/// them, and what was changed between its steps.
fn places_of_run(
    scene: &mut Scene,
    checkpoint: &Path,
    state: &StateFile,
    mesh: [u32; 2],
) -> Result<(FilePlaces, Vec<Change>), Mistake> {
    state_file::only_frame(state.frame)?;
    let run = checkpoint::run(checkpoint, &|_| Ok(()))?;
    let theirs = &run.scene;
    match theirs.mesh() {
        Some(found) if found == mesh => {}
        Some([columns, rows]) => {
            let accepted = format!("a run on {} × {} nodes, the mesh of the scene", mesh[0], mesh[1]);
            return Err(Mistake::new("", format!("found a run on {columns} × {rows} nodes"), accepted));
        }
        None => return Err(Mistake::new("", "found a run without a mesh", "a run of the same kind of scene")),
    }
    if scene.space.lengths.is_empty() {
        scene.space.lengths.clone_from(&theirs.space.lengths);
    }
    if scene.space.lengths != theirs.space.lengths {
        let accepted = format!("a run in the box {:?} of the scene, or no `space`", scene.space.lengths);
        return Err(Mistake::new("", format!("found a run in the box {:?}", theirs.space.lengths), accepted));
    }
    let groups = |scene: &Scene| -> Vec<(bool, u64)> {
        scene.particles.iter().map(|group| (group.tracer, group.resolved_count(&scene.space))).collect()
    };
    let [own, other] = [groups(scene), groups(theirs)];
    if own != other {
        let numbers = |groups: &[(bool, u64)]| {
            let of_group = |(tracer, count): &(bool, u64)| format!("{count}{}", if *tracer { " tracers" } else { "" });
            groups.iter().map(of_group).collect::<Vec<_>>().join(", ")
        };
        let accepted = format!("groups as in the scene: {}", numbers(&own));
        return Err(Mistake::new("", format!("found groups of {}", numbers(&other)), accepted));
    }
    let velocities = if state.velocities == StateVelocities::File { run.velocities()? } else { Vec::new() };
    let State { positions, masses, .. } = run.state();
    let places = FilePlaces { positions, velocities, masses, ..FilePlaces::default() };
    Ok((places, run.changes))
}

/// The fields of a file, of which all mistakes are found.
fn fields(path: &Path, state: &StateFile, mesh: [usize; 2], lengths: &[f64]) -> Result<MeshFields, Vec<Mistake>> {
    let file = ArrayFile::open(path).map_err(|mistake| vec![mistake])?;
    let mut mistakes = wrong_box(&file, lengths);
    let names = file.names();
    let mut field = |known: [&str; 2]| {
        let read = if let Some(name) = known.iter().find(|name| names.contains(name)) {
            file.read(name).and_then(|array| on_nodes(array, name, state.frame, mesh))
        } else {
            let found = match &names[..] {
                [] => "the file has no arrays".to_owned(),
                _ => format!("its arrays are {}", quoted(names.iter().copied())),
            };
            let [name, letter] = known;
            Err(Mistake::new("", found, format!("an array `{name}` or `{letter}` among them")))
        };
        read.map_err(|mistake| mistakes.push(mistake)).ok()
    };
    let depth = field(DEPTH);
    let velocity = match state.velocities {
        StateVelocities::File => VELOCITY.map(&mut field),
        StateVelocities::Thermal | StateVelocities::Rest => [const { None }; 2],
    };
    if let Some(depth) = &depth {
        mistakes.extend(wrong_depth(depth, mesh[0]));
    }
    match depth {
        Some(depth) if mistakes.is_empty() => {
            let [along_x, along_y] = velocity;
            Ok(MeshFields { depth, velocity: along_x.zip(along_y).map(|(x, y)| [x, y]) })
        }
        _ => Err(mistakes),
    }
}

/// Part of an edge to which coordinates of nodes, in single precision perhaps, have to span it.
const SPAN: f64 = 1e-5;

/// Coordinates of nodes that span another box than that of the scene. Longitudes, latitudes and numbers of nodes are no lengths.
fn wrong_box(file: &ArrayFile, lengths: &[f64]) -> Vec<Mistake> {
    let names = file.names().into_iter();
    let wrong = names.filter_map(|name| {
        let length = *lengths.get(axis(name).filter(|_| name.starts_with(['x', 'X', 'y', 'Y']))?)?;
        let Array { values, .. } = file.read(name).ok().filter(|array| array.dimensions == [name])?;
        let (first, last) = (values.first()?, values.last()?);
        let span = (last - first).abs() * values.len() as f64 / values.len().checked_sub(1)? as f64;
        // NaN is no length.
        let fits = (span / length - 1.0).abs() <= SPAN;
        let found = format!("found nodes that span {}", short(span));
        let accepted =
            format!("nodes that span {length}, the edge of the box of the scene; or a file without coordinates");
        (!fits).then(|| Mistake::new(format!("array `{name}`"), found, accepted))
    });
    wrong.collect()
}

/// The place of a node in words.
fn node(index: usize, columns: usize) -> String {
    format!("node ({}, {})", index % columns, index / columns)
}

/// The values of a frame, those of neighbours along x next to each other.
fn on_nodes(array: Array, name: &str, frame: i64, mesh: [usize; 2]) -> Result<Vec<f64>, Mistake> {
    let place = format!("array `{name}`");
    let [columns, rows] = mesh;
    let Array { shape, dimensions, values } = array;
    let Some((frames, nodes)) = shape.len().checked_sub(2).filter(|before| *before <= 1).map(|at| shape.split_at(at))
    else {
        let accepted = format!("two dimensions of {columns} and {rows} nodes, or three with that of time before them");
        return Err(Mistake::new(place, format!("found {}", counted(shape.len() as u64, "dimension")), accepted));
    };
    let x_first = match dimensions.get(dimensions.len().saturating_sub(2)..) {
        // Without names the order is that of the arrays of runs.
        None | Some([]) => true,
        Some(named) => match named.iter().map(|name| axis(name)).collect::<Vec<_>>()[..] {
            [Some(0), Some(1)] => true,
            [Some(1), Some(0)] => false,
            _ => {
                let accepted =
                    "dimensions whose names begin with y and x (or lat and lon, j and i), which tell the axes apart";
                let found = format!("its dimensions are {}", quoted(named.iter().map(String::as_str)));
                return Err(Mistake::new(place, found, accepted));
            }
        },
    };
    let expected = if x_first { [columns, rows] } else { [rows, columns] };
    if nodes != expected {
        let [first, second] = expected;
        let order = if x_first { "along x and y" } else { "along y and x" };
        let accepted = format!("{first} × {second} nodes {order}, those of the mesh of the scene");
        return Err(Mistake::new(place, format!("found {} × {} nodes", nodes[0], nodes[1]), accepted));
    }
    let frames = frames.first().copied().unwrap_or(1);
    let chosen = if frame < 0 { frame + frames as i64 } else { frame };
    let Some(chosen) = usize::try_from(chosen).ok().filter(|chosen| *chosen < frames) else {
        let (last, all) = (frames.saturating_sub(1), counted(frames as u64, "frame"));
        let accepted = match frames {
            0 => "a file with a frame".to_owned(),
            _ => format!("0 to {last}, or -1 to -{frames} from the end: the array has {all}"),
        };
        return Err(Mistake::new(place, format!("found frame {frame}"), accepted));
    };
    let values = &values[chosen * columns * rows..][..columns * rows];
    let at = |index: usize| if x_first { index % columns * rows + index / columns } else { index };
    let values: Vec<f64> = (0..values.len()).map(|index| values[at(index)]).collect();
    let mut strange = values.iter().enumerate().filter(|(_, value)| !value.is_finite());
    if let Some((index, value)) = strange.next() {
        let more = match strange.count() {
            0 => String::new(),
            1 => ", and on another".to_owned(),
            others => format!(", and on {others} others"),
        };
        let found = format!("found {value} on {}{more}", node(index, columns));
        return Err(Mistake::new(place, found, "a finite number on every node"));
    }
    Ok(values)
}

/// The axis that a dimension runs along, by its name.
fn axis(name: &str) -> Option<usize> {
    let name = name.to_lowercase();
    match name.chars().next()? {
        'x' | 'i' => Some(0),
        'y' | 'j' => Some(1),
        'l' if name.starts_with("lon") => Some(0),
        'l' if name.starts_with("lat") => Some(1),
        _ => None,
    }
}

/// What keeps a finite depth from being one of water.
fn wrong_depth(depth: &[f64], columns: usize) -> Vec<Mistake> {
    let place = "the depth";
    let mean = depth.iter().sum::<f64>() / depth.len().max(1) as f64;
    let mut mistakes = Vec::new();
    let least = depth.iter().enumerate().min_by(|a, b| a.1.total_cmp(b.1));
    if let Some((index, least)) = least.filter(|(_, least)| **least <= 0.0) {
        let found = format!("found {} on {}, the lowest", brief(*least), node(index, columns));
        mistakes.push(Mistake::new(place, found, "a depth above 0 on every node"));
    } else if (mean - 1.0).abs() > MEAN {
        let accepted = format!(
            "a mean of 1, to {MEAN}: divide the depth by {mean} if that is how deep the water is, and velocities by the unit that follows"
        );
        mistakes.push(Mistake::new(place, format!("found a mean of {}", brief(mean)), accepted));
    }
    mistakes
}

fn checksum(places: &FilePlaces) -> String {
    let mut sum = crc32fast::Hasher::new();
    if let Some(fields) = &places.fields {
        for values in std::iter::once(&fields.depth).chain(fields.velocity.iter().flatten()) {
            sum.update(bytemuck::cast_slice(values));
        }
    }
    sum.update(bytemuck::cast_slice(&places.positions));
    sum.update(bytemuck::cast_slice(&places.masses));
    sum.update(bytemuck::cast_slice(&places.velocities));
    format!("{:08x}", sum.finalize())
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use crate::families::reference::ShallowWaterReference;
    use crate::families::shallow_water::flow::MeshFlow;
    use crate::families::{Checked, initial_state};
    use crate::output::{NetcdfFile, NetcdfVariable, write_npy_to};
    use crate::scene::{self, SceneError};
    use crate::state::Reported;
    use std::io::Write;
    use std::path::Path;

    const COLUMNS: usize = 16;
    const ROWS: usize = 8;

    fn scene(file: &str, further: &[&str]) -> Result<Checked, SceneError> {
        let state = format!(r#"state={{"file":"{file}"}}"#);
        let water = r#"particles=[{"species":"water","count":2048,"placement":{"type":"lattice"}}]"#;
        let changes = ["space.box=[6,3]", "interactions.0.mesh=[16,8]", "interactions.0.smoothing.length=0.8"];
        let start = ["interactions.0.surface=[]", water, &state];
        let all = changes.iter().chain(&start).chain(further).map(|change| (*change).to_owned());
        scene::load("shallow-water", &all.collect::<Vec<_>>())
    }

    /// Depth and velocities of a flow on the nodes, x first.
    fn flow() -> [Vec<f64>; 3] {
        let water = r#"particles=[{"species":"water","count":2048,"placement":{"type":"lattice"},
            "velocities":{"type":"geostrophic"}}]"#;
        let bump = r#"interactions.0.surface=[{"type":"bump","center":[2,1],"radius":0.6,"amplitude":0.05}]"#;
        let changes =
            ["space.box=[6,3]", "interactions.0.mesh=[16,8]", "interactions.0.smoothing.length=0.8", water, bump];
        let scene = scene::load("shallow-water", &changes.map(str::to_owned)).unwrap();
        let mut reference = ShallowWaterReference::new(scene.model().clone(), initial_state(&scene)).unwrap();
        reference.run(60).unwrap();
        let water = scene.model().shallow_water().unwrap();
        let flow = MeshFlow::new(scene.model(), water, &reference.reported_state().unwrap());
        let [u, v] = flow.velocity();
        [reference.depth(), u, v].map(|field| transposed(&field, COLUMNS))
    }

    fn transposed(field: &[f64], columns: usize) -> Vec<f64> {
        let rows = field.len() / columns;
        (0..field.len()).map(|index| field[index / rows + index % rows * columns]).collect()
    }

    fn write_npz(path: &Path, shape: &[usize], arrays: &[(&str, Vec<f64>)]) {
        let mut archive = rawzip::ZipArchiveWriter::new(std::fs::File::create(path).unwrap());
        for (name, values) in arrays {
            let name = format!("{name}.npy");
            let entry = archive.new_file(&name);
            let entry = entry.compression_method(rawzip::CompressionMethod::STORE);
            let (mut entry, config) = entry.start().unwrap();
            let mut writer = config.wrap(&mut entry);
            write_npy_to(&mut writer, shape, values).unwrap();
            writer.flush().unwrap();
            let (_, descriptor) = writer.finish().unwrap();
            entry.finish(descriptor).unwrap();
        }
        archive.finish().unwrap();
    }

    fn write_netcdf(path: &Path, order: [&str; 2], arrays: &[(&str, Vec<f64>)], frames: usize) {
        let length = |name: &str| if name == "x" { COLUMNS } else { ROWS };
        let dimensions = vec![
            ("time".to_owned(), frames),
            (order[0].to_owned(), length(order[0])),
            (order[1].to_owned(), length(order[1])),
        ];
        let variable = |(name, values): &(&str, Vec<f64>)| NetcdfVariable {
            name: (*name).to_owned(),
            dimensions: vec![0, 1, 2],
            attributes: Vec::new(),
            values: values.clone(),
        };
        let file = NetcdfFile { dimensions, attributes: Vec::new(), variables: arrays.iter().map(variable).collect() };
        file.write_to(&mut std::fs::File::create(path).unwrap()).unwrap();
    }

    /// How far the fields of a start are from those of a file, x first.
    fn distances(scene: &Checked, fields: &[Vec<f64>; 3]) -> [f64; 3] {
        let model = scene.model();
        let state = initial_state(scene);
        assert_eq!(
            state.masses.iter().map(|mass| u64::from(*mass)).sum::<u64>(),
            model.shallow_water().unwrap().total_mass()
        );
        let flow = MeshFlow::new(model, model.shallow_water().unwrap(), &Reported::from(state.clone()));
        let depth = ShallowWaterReference::new(model.clone(), state).unwrap().depth();
        let [u, v] = flow.velocity();
        let found = [depth, u, v].map(|field| transposed(&field, COLUMNS));
        std::array::from_fn(|place| {
            let apart = found[place].iter().zip(&fields[place]).map(|(found, asked)| (found - asked).abs());
            apart.fold(0.0, f64::max)
        })
    }

    /// Depth and velocities of the start are those of the file, whatever its format and order, and with particles at random places too.
    #[test]
    fn water_starts_with_the_fields_of_a_file() {
        let directory = tempfile::tempdir().unwrap();
        let fields = flow();
        let largest = |field: &[f64]| field.iter().fold(0.0, |most: f64, value| most.max(value.abs()));
        assert!(largest(&fields[1]) > 0.05 && largest(&fields[2]) > 0.05);
        let place = |name: &str| directory.path().join(name);
        let text = |name: &str| place(name).display().to_string();
        let by_letters = ["h", "u", "v"].into_iter().zip(fields.clone()).collect::<Vec<_>>();
        write_npz(&place("f.npz"), &[COLUMNS, ROWS], &by_letters);
        let by_names = ["depth", "velocity_x", "velocity_y"].into_iter().zip(fields.clone()).collect::<Vec<_>>();
        write_netcdf(&place("x.nc"), ["x", "y"], &by_names, 1);
        let other_order = |field: &Vec<f64>| transposed(field, ROWS);
        let two: Vec<_> = by_names
            .iter()
            .map(|(name, field)| (*name, [vec![7.0; COLUMNS * ROWS], other_order(field)].concat()))
            .collect();
        write_netcdf(&place("y.nc"), ["y", "x"], &two, 2);
        let starts = ["f.npz", "x.nc", "y.nc"].map(|name| scene(&text(name), &[]).unwrap());
        for start in &starts {
            let [depth, u, v] = distances(start, &fields);
            assert!(depth < 3e-7 && u < 1e-6 && v < 1e-6, "{depth} {u} {v}");
            assert_eq!(initial_state(start), initial_state(&starts[0]));
        }
        assert_eq!(starts[0].state.as_ref().unwrap().checksum, starts[2].state.as_ref().unwrap().checksum);
        let [depth, u, v] =
            distances(&scene(&text("f.npz"), &[r#"particles.0.placement={"type":"random"}"#]).unwrap(), &fields);
        assert!(depth < 1e-6 && u < 1e-5 && v < 1e-5, "{depth} {u} {v}");
        // Without velocities of the file.
        let still = scene(&text("f.npz"), &[r#"state.velocities="rest""#]).unwrap();
        assert!(
            distances(&still, &fields)[0] < 3e-7
                && initial_state(&still).momenta.iter().all(|momentum| *momentum == [0; 3])
        );
        let hot = scene(&text("f.npz"), &[r#"state.velocities="thermal""#, "temperature=0.01"]).unwrap();
        let squares = |scene: &Checked| {
            let momenta = initial_state(scene).momenta;
            momenta
                .iter()
                .flat_map(|momentum| scene.model().units.momentum(*momentum))
                .map(|part| part * part)
                .sum::<f64>()
        };
        // ⟨V²⟩ = 2kT/m with masses of 1/16 on average, which vary.
        assert!((squares(&hot) / 2048.0 / 0.32 - 1.0).abs() < 0.1, "{}", squares(&hot));
        // Another frame of the same file.
        let error = scene(&text("y.nc"), &["state.frame=0"]).unwrap_err().to_string();
        assert!(error.contains("the depth: found a mean of 7"), "{error}");
    }

    /// Coordinates of nodes say how large the box of fields is.
    #[test]
    fn fields_of_another_box_are_refused() {
        let directory = tempfile::tempdir().unwrap();
        let path = directory.path().join("f.nc");
        let [depth, u, v] = flow().map(|field| transposed(&field, ROWS));
        let variable = |name: &str, dimensions: &[usize], values: Vec<f64>| NetcdfVariable {
            name: name.to_owned(),
            dimensions: dimensions.to_vec(),
            attributes: Vec::new(),
            values,
        };
        for (edges, expected) in [
            ([6.0, 3.0], None),
            ([6.0, 3.01], Some("array `y`: found nodes that span 3.01; accepted: nodes that span 3, the edge")),
            ([6000.0, 3.0], Some("array `x`: found nodes that span 6000; accepted: nodes that span 6, the edge")),
            ([f64::NAN, 3.0], Some("array `x`: found nodes that span NaN")),
        ] {
            let along = |edge: f64, count: usize| (0..count).map(|node| node as f64 * edge / count as f64).collect();
            let variables = vec![
                variable("x", &[2], along(edges[0], COLUMNS)),
                variable("y", &[1], along(edges[1], ROWS)),
                variable("h", &[0, 1, 2], depth.clone()),
                variable("u", &[0, 1, 2], u.clone()),
                variable("v", &[0, 1, 2], v.clone()),
            ];
            let dimensions = [("time", 1), ("y", ROWS), ("x", COLUMNS)].map(|(name, length)| (name.to_owned(), length));
            let file = NetcdfFile { dimensions: dimensions.to_vec(), attributes: Vec::new(), variables };
            file.write_to(&mut std::fs::File::create(&path).unwrap()).unwrap();
            let found = scene(&path.display().to_string(), &[]).err().map(|error| error.to_string());
            match (expected, found) {
                (None, None) => {}
                (Some(expected), Some(found)) => assert!(found.contains(expected), "{found}"),
                (expected, found) => assert_eq!(expected, found.as_deref()),
            }
        }
        // Fields do not say how large the box is where the scene does not.
        let (text, water) =
            (path.display().to_string(), r#"{"species":"water","count":2048,"placement":{"type":"lattice"}}"#);
        let document = format!(
            r#"{{"title":"t","time":{{"step":0.01,"steps":1}},"temperature":0,"particles":[{water}],"state":{{"file":"{text}"}},
                "interactions":[{{"type":"shallow-water","mesh":[16,8],"spline_order":3,"wave_speed":1,"rotation":1,
                    "smoothing":{{"length":0.8}}}}],
                "integrator":{{"type":"gyro"}},"output":{{"energies":{{"every":1}}}}}}"#
        );
        let error = scene::parse("t", &document, &[]).unwrap_err().to_string();
        assert!(error.contains("space.box: found 0 edges; accepted: two edges"), "{error}");
    }

    /// A run goes on without the file.
    #[test]
    fn what_a_run_keeps_of_a_start_fits_it() {
        let directory = tempfile::tempdir().unwrap();
        let path = directory.path().join("f.npz");
        write_npz(&path, &[COLUMNS, ROWS], &["h", "u", "v"].into_iter().zip(flow()).collect::<Vec<_>>());
        let scene = scene(&path.display().to_string(), &[]).unwrap();
        let kept = scene.start().unwrap();
        let restored = super::FileStart::from_bytes(&kept.to_bytes()).unwrap();
        assert!(restored.fits(&scene) && restored.places.is_none());
        let again =
            scene.clone().changed(|scene| scene.kept = super::KeptStart::of(std::sync::Arc::new(restored.clone())));
        assert_eq!(again.model(), scene.model());
        assert!(scene.model().units.momentum > 0.0);
    }

    /// With another rotation, bath and time step the particles, their masses and the velocities of the last report are those of the run before.
    #[test]
    fn water_goes_on_with_changes() {
        let directory = tempfile::tempdir().unwrap();
        let name = directory.path().display().to_string();
        let loops = r#"particles=[{"species":"water","count":2048,"placement":{"type":"lattice"},"velocities":{"type":"geostrophic"}},
            {"species":"loop","tracer":true,"count":40,"placement":{"type":"circle","center":[2,1],"radius":0.5}}]"#;
        let wave = r#"interactions.0.surface=[{"type":"wave","periods":[1,1],"amplitude":0.05}]"#;
        let changes =
            ["space.box=[6,3]", "interactions.0.mesh=[16,8]", "interactions.0.smoothing.length=0.8", loops, wave];
        let first = scene::load("shallow-water", &changes.map(str::to_owned)).unwrap();
        let mut reference = ShallowWaterReference::new(first.model().clone(), initial_state(&first)).unwrap();
        reference.run(7).unwrap();
        let path = directory.path().join(crate::output::files::CHECKPOINT);
        crate::output::checkpoint::save(&path, crate::output::Id::of_run(&first), &first, reference.state(), &[], &[])
            .unwrap();
        let tracers = r#"particles=[{"species":"water","count":2048,"placement":{"type":"lattice"}},
            {"species":"loop","tracer":true,"count":40,"placement":{"type":"circle","center":[2,1],"radius":0.5}}]"#;
        let bath = r#"interactions.0.bath={"type":"memory","epsilon":1}"#;
        let further = [tracers, "interactions.0.rotation=1", "time.step=0.01", "temperature=0.001", bath];
        let second = scene(&name, &further).unwrap();
        let (state, reported) = (initial_state(&second), reference.reported_state().unwrap());
        assert_eq!((&state.positions, &state.masses, state.step), (&reported.positions, &reported.masses, 0));
        assert_eq!((state.species.len(), state.node_bath.len()), (2088, 128));
        let unit = |scene: &Checked| scene.model().units.momentum;
        for (found, asked) in state.momenta.iter().zip(&reported.momenta) {
            for axis in 0..2 {
                let apart = f64::from(found[axis]) * unit(&second) - f64::from(asked[axis]) * unit(&first);
                assert!(apart.abs() <= 0.5 * unit(&second), "{apart}");
            }
        }
        assert!(state.momenta.iter().any(|momentum| momentum[0].abs() > 1000));
        assert_ne!(second.model().seed, first.model().seed);
        assert_eq!(second.model().shallow_water().unwrap().closed_loops().count(), 1);
        for (further, expected) in [
            (
                &[tracers, "interactions.0.mesh=[8,8]"][..],
                "found a run on 16 × 8 nodes; accepted: a run on 8 × 8 nodes",
            ),
            (&[tracers, "space.box=[6,6]"], "found a run in the box [6.0, 3.0]"),
            (&[], "found groups of 2048, 40 tracers; accepted: groups as in the scene: 2048"),
            (&[tracers, "state.frame=3"], "found frame 3"),
        ] {
            let error = scene(&name, further).unwrap_err().to_string();
            assert!(error.contains(expected), "{error}");
        }
    }

    #[test]
    fn what_is_wrong_with_fields_is_said_at_once() {
        let directory = tempfile::tempdir().unwrap();
        let path = directory.path().join("wrong.npz");
        let name = path.display().to_string();
        let [h, u, v] = flow();
        let errors = |shape: &[usize], arrays: &[(&str, Vec<f64>)], further: &[&str]| {
            write_npz(&path, shape, arrays);
            scene(&name, further).unwrap_err().to_string()
        };
        let mut strange = u.clone();
        (strange[ROWS + 3], strange[9]) = (f64::NAN, f64::INFINITY);
        let found =
            errors(&[COLUMNS, ROWS], &[("h", h.clone()), ("u", strange), ("w", v.clone())], &["state.replicate=[2]"]);
        for expected in [
            "3 mistakes",
            "state.replicate: found in a scene that starts from fields",
            "array `u`: found inf on node (1, 1), and on another; accepted: a finite number on every node",
            "its arrays are `h`, `u`, `w`; accepted: an array `velocity_y` or `v` among them",
        ] {
            assert!(found.contains(expected), "{found}");
        }
        let all = |h: &[f64]| [("h", h.to_vec()), ("u", u.clone()), ("v", v.clone())];
        let mut dry = h.clone();
        dry[ROWS + 2] = -0.5;
        let doubled: Vec<f64> = h.iter().map(|depth| 2.0 * depth).collect();
        // Finer than any mass of particles can have it.
        let rough: Vec<f64> =
            (0..h.len()).map(|index| if (index / ROWS + index).is_multiple_of(2) { 1.9 } else { 0.1 }).collect();
        for (shape, depth, expected) in [
            (&[ROWS, COLUMNS][..], &h, "array `h`: found 8 × 16 nodes; accepted: 16 × 8 nodes along x and y"),
            (&[COLUMNS * ROWS], &h, "array `h`: found 1 dimension; accepted: two dimensions of 16 and 8 nodes"),
            (&[COLUMNS, ROWS], &dry, "the depth: found -0.500 on node (1, 2), the lowest; accepted: a depth above 0"),
            (&[COLUMNS, ROWS], &doubled, "the depth: found a mean of 2.000; accepted: a mean of 1"),
            (&[COLUMNS, ROWS], &rough, "a depth on the nodes that no masses and velocities of these particles have"),
        ] {
            let found = errors(shape, &all(depth), &[]);
            assert!(found.contains(expected), "{found}");
        }
        let wave = r#"interactions.0.surface=[{"type":"wave","periods":[1,0],"amplitude":0.1}]"#;
        let found = errors(&[COLUMNS, ROWS], &all(&h), &[wave, r#"particles.0.velocities={"type":"rest"}"#]);
        assert!(found.contains("particles[0].velocities: found beside a `state`"), "{found}");
        let found = errors(&[COLUMNS, ROWS], &all(&h), &[wave]);
        assert!(found.contains("interactions[0].surface: found beside a `state`"), "{found}");
        let found = errors(&[COLUMNS, ROWS], &all(&h), &["state.frame=2"]);
        assert!(found.contains("array `h`: found frame 2; accepted: 0 to 0"), "{found}");
        let found = errors(&[COLUMNS, ROWS], &all(&h), &[r#"state.checksum="00000000""#]);
        assert!(found.contains("state.checksum: found \"00000000\""), "{found}");
    }
}
