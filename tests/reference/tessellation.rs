//! The tessellation of the device: against the one in float64, by itself where that is in doubt, and whatever the order in
//! which the particles come.

use std::collections::{BTreeMap, HashMap};

use mesoscope::engine::{Engine, EngineError};
use mesoscope::plan::Options;
use mesoscope::scene::Checked;
use mesoscope::shaders::Array;
use mesoscope::state::State;
use mesoscope::tessellation::{Tessellation, part_coincident};

use crate::support::{engine, scene, start};

type Places = Vec<[u32; 3]>;

/// A scene of cells with so many particles in a box.
fn cells(lengths: [f64; 2], count: usize) -> Checked {
    let [x, y] = lengths;
    scene(&format!(
        r#"{{"title": "cells", "space": {{"box": [{x}, {y}]}}, "time": {{"step": 0.0001, "steps": 1}}, "temperature": 1,
        "particles": [{{"species": "A", "count": {count}}}], "interactions": [{{"type": "voronoi"}}]}}"#
    ))
}

/// The same with its particles in some places.
fn placed(lengths: [f64; 2], places: &Places) -> (Checked, State) {
    let scene = cells(lengths, places.len());
    let (_, mut state) = start(&scene);
    state.positions.clone_from(places);
    state.masses = vec![1; places.len()];
    (scene, state)
}

/// What the device found about a cell.
#[derive(Debug, Clone, PartialEq)]
struct Cell {
    place: [u32; 2],
    volume: f64,
    faces: Vec<Face>,
}

#[derive(Debug, Clone, Copy, PartialEq)]
struct Face {
    /// The number of the particle behind it.
    neighbour: usize,
    /// Which of its images is there.
    image: u32,
    /// Displacement to it in units of 2⁻³² of the box.
    away: [i64; 2],
    length: f64,
    offset: f64,
}

/// The cells of some places in order of the particles' numbers.
fn tessellate(lengths: [f64; 2], places: &Places, options: Options) -> Result<Vec<Cell>, EngineError> {
    let (scene, state) = placed(lengths, places);
    let mut engine = engine(&scene, &state, options);
    engine.reported()?;
    Ok(read(&mut engine, places.len()))
}

/// The same with as much room as it takes.
fn tessellate_all(lengths: [f64; 2], places: &Places) -> Vec<Cell> {
    let mut options = Options::default();
    loop {
        match tessellate(lengths, places, options) {
            Ok(cells) => return cells,
            Err(EngineError::Crowded { .. }) if options.list_growth < 2 => options.list_growth += 1,
            Err(error) => panic!("{error}"),
        }
    }
}

/// Where the particles and the faces of their cells are.
const GEOMETRY: [Array; 6] =
    [Array::Particles, Array::FaceCounts, Array::FaceWords, Array::FaceLengths, Array::FaceOffsets, Array::Volumes];

fn read(engine: &mut Engine<'_>, count: usize) -> Vec<Cell> {
    let [particles, counts, words, lengths, offsets, volumes] = GEOMETRY.map(|array| engine.words(array).unwrap());
    let place = |slot: usize| [particles[8 * slot], particles[8 * slot + 1]];
    let number = |slot: usize| particles[8 * slot + 3] as usize;
    let real = |word: u32| f64::from(f32::from_bits(word));
    let face = |slot: usize, face: usize| {
        let element = face * count + slot;
        let word = words[element];
        let (neighbour, image) = ((word & 0x0fff_ffff) as usize, word >> 28);
        let boxes = [i64::from(image % 3) - 1, i64::from(image / 3) - 1];
        let away = std::array::from_fn(|axis| {
            let separation = place(slot)[axis].wrapping_sub(place(neighbour)[axis]) as i32;
            (boxes[axis] << 32) - i64::from(separation)
        });
        Face {
            neighbour: number(neighbour),
            image,
            away,
            length: real(lengths[element]),
            offset: real(offsets[element]),
        }
    };
    let mut cells = vec![Cell { place: [0, 0], volume: f64::NAN, faces: Vec::new() }; count];
    for slot in 0..count {
        let faces = (0..counts[slot] as usize).map(|index| face(slot, index)).collect();
        cells[number(slot)] = Cell { place: place(slot), volume: real(volumes[slot]), faces };
    }
    cells
}

/// Random places, different for each seed.
fn random(count: usize, seed: u64) -> Places {
    use rand::{RngExt, SeedableRng};
    let mut random = rand::rngs::StdRng::seed_from_u64(seed);
    (0..count).map(|_| [random.random(), random.random(), 0]).collect()
}

/// Random places in a part of the box of this size around its middle.
fn blob(count: usize, size: f64, seed: u64) -> Places {
    let shrunk = |fraction: u32| (1 << 31) + ((f64::from(fraction) - 2_f64.powi(31)) * size) as i64;
    random(count, seed).iter().map(|place| [shrunk(place[0]) as u32, shrunk(place[1]) as u32, 0]).collect()
}

/// A lattice of rows, every other one shifted by a part of the distance in the row.
fn lattice(columns: u64, rows: u64, shift: f64) -> Places {
    let along = |row: u64, column: u64| {
        let turns = (column as f64 + if row % 2 == 1 { shift } else { 0.0 }) / columns as f64;
        (turns * 2_f64.powi(32)).round() as u64 as u32
    };
    let place = |row: u64, column: u64| [along(row, column), ((row << 32) / rows) as u32, 0];
    (0..rows).flat_map(|row| (0..columns).map(move |column| place(row, column))).collect()
}

fn face_count(cells: &[Cell]) -> usize {
    cells.iter().map(|cell| cell.faces.len()).sum()
}

/// Both ends see every face once and alike, the cells close, and they fill the box.
#[track_caller]
fn assert_consistent(what: &str, lengths: [f64; 2], cells: &[Cell]) {
    let unit = lengths.map(|length| length / 2_f64.powi(32));
    let area = lengths[0] * lengths[1];
    let spacing = (area / cells.len() as f64).sqrt();
    let mut seen = HashMap::new();
    for (number, cell) in cells.iter().enumerate() {
        let mut closed = [0.0; 2];
        for face in &cell.faces {
            let known = seen.insert((number, face.neighbour, face.away), *face);
            assert!(known.is_none(), "{what}: cell {number} has the same face twice: {face:?}");
            let away = [0, 1].map(|axis| face.away[axis] as f64 * unit[axis]);
            let distance = away[0].hypot(away[1]);
            assert!(distance > 0.0 && face.length >= 0.0, "{what}: cell {number} has {face:?}");
            for axis in 0..2 {
                closed[axis] += face.length * away[axis] / distance;
            }
        }
        // A corner is known to some 10⁻⁶ of the size of its cell, which may be as large as the box.
        let size = cell.faces.iter().map(|face| face.length).fold(spacing, f64::max);
        let open = closed[0].hypot(closed[1]);
        assert!(open < 1e-5 * size, "{what}: the faces of cell {number} leave {open} open: {cell:?}");
    }
    for ((number, neighbour, away), face) in &seen {
        let back = seen.get(&(*neighbour, *number, [-away[0], -away[1]]));
        assert!(back.is_some(), "{what}: only {number} sees its face with {neighbour}: {face:?}");
    }
    let found: f64 = cells.iter().map(|cell| cell.volume).sum();
    assert!((found / area - 1.0).abs() < 1e-6, "{what}: the area of the cells is {found} of {area}");
}

/// The faces of the device are those in float64, but for such as are too short to matter.
#[track_caller]
fn assert_like_reference(
    what: &str,
    lengths: [f64; 2],
    places: &Places,
    cells: &[Cell],
    shortest: f64,
    tolerance: f64,
) {
    let reference = Tessellation::of_fractions(lengths, places);
    let (mut largest, mut worst_volume, mut compared) = (0.0_f64, 0.0_f64, 0);
    for (number, (cell, expected)) in cells.iter().zip(&reference.cells).enumerate() {
        let found: BTreeMap<_, _> = cell.faces.iter().map(|face| ((face.neighbour, face.image), face)).collect();
        let wanted: BTreeMap<_, _> =
            expected.faces.iter().map(|face| ((face.neighbour, face.image_code()), face)).collect();
        for (name, face) in &wanted {
            let Some(other) = found.get(name) else {
                assert!(face.length <= shortest, "{what}: cell {number} lacks {face:?}");
                continue;
            };
            let difference = (face.length - other.length).abs().max((face.offset - other.offset).abs());
            largest = largest.max(difference);
            compared += 1;
            assert!(difference <= tolerance, "{what}: cell {number} has {other:?}, expected {face:?}");
        }
        for (name, face) in &found {
            let none = !wanted.contains_key(name) && face.length > shortest;
            assert!(!none, "{what}: cell {number} has {face:?} beyond the expected");
        }
        worst_volume = worst_volume.max((cell.volume - expected.volume).abs());
    }
    println!("{what}: {compared} faces, lengths and offsets within {largest:.2e}, volumes within {worst_volume:.2e}");
    assert!(worst_volume <= tolerance, "{what}: a volume is off by {worst_volume}");
}

#[test]
fn a_hundred_thousand_random_cells() {
    let lengths = [316.0, 316.5];
    let places = random(100_000, 1);
    let cells = tessellate(lengths, &places, Options::default()).unwrap();
    assert_consistent("random cells", lengths, &cells);
    // Triangles of a periodic plane: as many faces as three times the cells, each seen from both sides.
    assert_eq!(face_count(&cells), 600_000);
    assert_like_reference("random cells", lengths, &places, &cells, 0.0, 4e-6);
    // Shares of cells with so many neighbours, Poisson-Voronoi: known to four digits from long simulations (Calka 2003,
    // doi:10.1239/aap/1051201647, and later ones), within four standard errors of a share of 10⁵ correlated cells.
    let share = |faces: usize| cells.iter().filter(|cell| cell.faces.len() == faces).count() as f64 / 1e5;
    for (faces, expected) in [(3, 0.0113), (4, 0.1068), (5, 0.2594), (6, 0.2947), (7, 0.1988), (8, 0.0900), (9, 0.0296)]
    {
        let found = share(faces);
        let error = (expected * (1.0 - expected) / 1e5_f64).sqrt();
        println!("{faces} faces: {found:.4}, expected {expected:.4} ± {error:.4}");
        assert!((found - expected).abs() < 4.0 * error + 2e-4, "{faces} faces: {found}, expected {expected} ± {error}");
    }
}

#[test]
fn few_cells_border_themselves() {
    for (turn, lengths) in [[10.0, 10.0], [10.0, 3.0], [0.7, 2.0]].into_iter().enumerate() {
        // Up to three cells in every box, more of them in one box each: every number of cells compiles kernels of its own.
        for count in (1..=9).filter(|count| *count <= 3 || count % 3 == turn) {
            let (scene, mut state) = placed(lengths, &random(count, 0));
            let mut engine = engine(&scene, &state, Options::default());
            for seed in 0..10 {
                let places = random(count, 100 * count as u64 + seed);
                let what = format!("{count} cells in {lengths:?}, seed {seed}");
                state.positions.clone_from(&places);
                engine.upload(&state).unwrap();
                engine.reported().unwrap();
                let cells = read(&mut engine, count);
                assert_consistent(&what, lengths, &cells);
                assert_like_reference(&what, lengths, &places, &cells, 1e-5, 2e-6 * lengths[0].max(lengths[1]));
                // One cell is a rectangle: its neighbours are lattice points.
                assert_eq!(face_count(&cells), if count == 1 { 4 } else { 6 * count }, "{what}");
            }
        }
    }
}

#[test]
fn lattices_have_no_faces_without_length() {
    for (lengths, columns, rows) in [
        ([16.0, 16.0], 16, 16),
        ([10.0, 10.0], 10, 10),
        ([30.0, 7.0], 30, 7),
        ([3.0, 3.0], 3, 3),
        ([2.0, 2.0], 2, 2),
        ([2.0, 1.0], 2, 1),
    ] {
        let places = lattice(columns, rows, 0.0);
        let cells = tessellate(lengths, &places, Options::default()).unwrap();
        let what = format!("square lattice of {columns} by {rows}");
        assert_consistent(&what, lengths, &cells);
        // Thirds and tenths of a box are no whole numbers of 2⁻³²: their corners are not met by exactly four cells.
        if columns.is_power_of_two() && rows.is_power_of_two() {
            assert!(cells.iter().all(|cell| cell.faces.len() == 4), "{what}: {} faces", face_count(&cells));
        }
        for cell in &cells {
            let long = cell.faces.iter().filter(|face| face.length > 1e-5);
            assert_eq!(long.count(), 4, "{what}: {cell:?}");
        }
    }
    let lengths = [16.0, 8.0 * 3.0_f64.sqrt()];
    let cells = tessellate(lengths, &lattice(16, 16, 0.5), Options::default()).unwrap();
    assert_consistent("hexagonal lattice", lengths, &cells);
    assert!(cells.iter().all(|cell| cell.faces.len() == 6));
    let side = 1.0 / 3.0_f64.sqrt();
    for face in cells.iter().flat_map(|cell| &cell.faces) {
        assert!((face.length - side).abs() < 1e-6 && face.offset.abs() < 1e-6, "{face:?}");
    }
}

/// Points with whole coordinates on a circle: exactly on it.
fn circle(unit: i64) -> Places {
    let radius_squared = 5_i64.pow(2) * 13_i64.pow(2) * 17_i64.pow(2);
    let radius = radius_squared.isqrt();
    let mut places = Vec::new();
    for x in -radius..=radius {
        let y = (radius_squared - x * x).isqrt();
        if x * x + y * y == radius_squared {
            places.push([x, y]);
            if y > 0 {
                places.push([x, -y]);
            }
        }
    }
    let middle = 1_i64 << 31;
    places.iter().map(|[x, y]| [(middle + unit * x) as u32, (middle + unit * y) as u32, 0]).collect()
}

#[test]
fn many_points_on_a_circle() {
    let ring = circle(1_100_000);
    assert_eq!(ring.len(), 108, "lattice points on the circle");
    let lengths = [5.0, 5.0];
    // Cells of the ring meet in its middle, all in one point.
    let cells = tessellate_all(lengths, &ring);
    assert_consistent("ring", lengths, &cells);
    for cell in &cells {
        assert!(cell.faces.len() >= 3);
    }
    let mut wheel = ring;
    wheel.push([1 << 31, 1 << 31, 0]);
    let found = tessellate(lengths, &wheel, Options::default());
    assert!(matches!(found, Err(EngineError::Crowded { step: 0 })), "108 faces in room for 24");
    let cells = tessellate_all(lengths, &wheel);
    assert_consistent("wheel", lengths, &cells);
    assert_eq!(cells[108].faces.len(), 108);
}

#[test]
fn close_and_coincident_particles() {
    let lengths = [20.0, 20.0];
    let (scene, mut state) = placed(lengths, &random(400, 0));
    let mut engine = engine(&scene, &state, Options::default());
    for distance in [0_u32, 1, 2, 3, 10, 100] {
        let mut places = random(400, 50 + u64::from(distance));
        for pair in 0..100 {
            let [x, y, _] = places[pair];
            let turn = pair as u32 % 4;
            let [dx, dy] = [[1, 0], [0, 1], [1, 1], [3, u32::MAX]][turn as usize];
            places[100 + pair] =
                [x.wrapping_add(distance.wrapping_mul(dx)), y.wrapping_add(distance.wrapping_mul(dy)), 0];
        }
        state.positions.clone_from(&places);
        engine.upload(&state).unwrap();
        engine.reported().unwrap();
        let cells = read(&mut engine, 400);
        let what = format!("pairs {distance} units apart");
        assert_consistent(&what, lengths, &cells);
        assert_eq!(face_count(&cells), 2400, "{what}");
        part_coincident(&mut places);
        assert_like_reference(&what, lengths, &places, &cells, 1e-5, 4e-6);
    }
    // All in the same place, and lines and squares of units.
    // More would keep a software adapter in loops for longer than it allows.
    for count in [2, 9, 30] {
        let what = format!("{count} in one place");
        let cells = tessellate_all(lengths, &vec![[77, 4_000_000_000, 0]; count]);
        assert_consistent(&what, lengths, &cells);
        assert!(cells.iter().all(|cell| cell.volume > 0.0), "{what}");
    }
    for (columns, rows) in [(40_u32, 1), (1, 40), (7, 7)] {
        let places: Places =
            (0..columns * rows).map(|index| [(index % columns).wrapping_sub(3), index / columns, 0]).collect();
        let cells = tessellate_all(lengths, &places);
        assert_consistent(&format!("{columns} by {rows} units"), lengths, &cells);
    }
}

#[test]
fn strips_and_clusters() {
    for (lengths, count) in [([100.0, 0.5], 1000), ([0.5, 100.0], 300), ([1000.0, 0.01], 1000), ([1000.0, 0.01], 7)] {
        let places = random(count, 9);
        let what = format!("{count} in {lengths:?}");
        let cells = tessellate_all(lengths, &places);
        assert_consistent(&what, lengths, &cells);
        assert_eq!(face_count(&cells), 6 * count, "{what}");
    }
    let lengths = [30.0, 40.0];
    let half = [blob(300, 1e-3, 1), random(300, 2)].concat();
    for (what, places) in
        [("all in a corner", blob(200, 1e-2, 3)), ("half in a blob", half), ("dense", blob(100, 1e-6, 4))]
    {
        let cells = tessellate_all(lengths, &places);
        assert_consistent(what, lengths, &cells);
        assert_eq!(face_count(&cells), 6 * places.len(), "{what}");
    }
}

/// dV/dt = Σ l [e·U/2 + (c·U)/r] for differences U of velocities: the coefficient of the second term is twice that
/// printed in the article.
#[test]
fn volumes_change_as_the_faces_say() {
    let lengths = [30.0, 30.0];
    let places = random(900, 12);
    let velocities = blob(900, 1.0, 13);
    // Integer velocities in units of the box, of up to a ten-thousandth of it: a three-hundredth of a cell.
    let velocity = |number: usize, axis: usize| (i64::from(velocities[number][axis]) - (1 << 31)) / 10_000;
    let moved = |way: i64| -> Places {
        let along =
            |number: usize, axis: usize| (i64::from(places[number][axis]) + way * velocity(number, axis)) as u32;
        (0..900).map(|number| [along(number, 0), along(number, 1), 0]).collect()
    };
    let [before, now, after] = [-1, 0, 1].map(|way| tessellate(lengths, &moved(way), Options::default()).unwrap());
    let unit = lengths[0] / 2_f64.powi(32);
    let (mut difference, mut scale) = (0.0, 0.0);
    for (number, cell) in now.iter().enumerate() {
        let rate: f64 = cell
            .faces
            .iter()
            .map(|face| {
                let separation = face.away.map(|component| -(component as f64) * unit);
                let distance = separation[0].hypot(separation[1]);
                let e = separation.map(|component| component / distance);
                let t = [-e[1], e[0]];
                let u = [0, 1].map(|axis| (velocity(number, axis) - velocity(face.neighbour, axis)) as f64 * unit);
                let along = |direction: [f64; 2]| direction[0] * u[0] + direction[1] * u[1];
                face.length * (0.5 * along(e) + face.offset * along(t) / distance)
            })
            .sum();
        let expected = 0.5 * (after[number].volume - before[number].volume);
        difference += (rate - expected).powi(2);
        scale += expected.powi(2);
    }
    let relative = (difference / scale).sqrt();
    println!("rates of change of volumes: {relative:.2e} of their root mean square");
    assert!(relative < 1e-3);
}

#[test]
fn neither_order_nor_workgroups_change_a_bit() {
    let lengths = [40.0, 30.0];
    // Coincident ones among them, for parting goes by number.
    let mut places = random(1200, 21);
    for number in 0..20 {
        places[1000 + number] = places[number % 5];
    }
    let (scene, state) = placed(lengths, &places);
    let words = |options: Options, order: &[usize]| -> Vec<Vec<u32>> {
        let mut engine = engine(&scene, &state, options);
        engine.upload_in_order(&state, order).unwrap();
        engine.reported().unwrap();
        GEOMETRY.map(|array| engine.words(array).unwrap()).to_vec()
    };
    let in_order: Vec<usize> = (0..1200).collect();
    let shuffled: Vec<usize> = (0..1200).map(|index| index * 7 % 1200).collect();
    let expected = words(Options::default(), &in_order);
    let all = [
        (Options::default(), &shuffled),
        (Options { workgroup_size: Some(16), ..Options::default() }, &in_order),
        (Options { workgroup_size: Some(256), many_level_scan: true, ..Options::default() }, &shuffled),
    ];
    for (options, order) in all {
        let found = words(options, order);
        for ((array, expected), found) in GEOMETRY.iter().zip(&expected).zip(&found) {
            assert!(expected == found, "{} with {options:?}", array.name());
        }
    }
}
