//! The tessellation of the device, by itself and against the one in float64.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

mod support;

use mesoscope::engine::{Engine, EngineError};
use mesoscope::plan::Options;
use mesoscope::scene::Scene;
use mesoscope::state::State;
use support::{engine, gpu, scene, start};

/// A scene of cells with so many particles in a box.
fn cells(lengths: [f64; 2], count: usize) -> Scene {
    let [x, y] = lengths;
    scene(&format!(
        r#"{{"title": "cells", "space": {{"box": [{x}, {y}]}}, "time": {{"step": 0.01, "steps": 1}}, "temperature": 1,
        "particles": [{{"species": "A", "count": {count}}}], "interactions": [{{"type": "voronoi"}}]}}"#
    ))
}

/// What the device found about a cell.
struct Cell {
    place: [u32; 2],
    id: u32,
    volume: f64,
    faces: Vec<Face>,
}

#[derive(Debug, Clone, Copy)]
struct Face {
    neighbour: usize,
    /// Displacement to the neighbour in units of 2⁻³² of the box.
    away: [i64; 2],
    length: f64,
    offset: f64,
}

/// The cells of some places, in the order of the device.
fn tessellate(lengths: [f64; 2], places: &[[u32; 2]], options: Options) -> Result<Vec<Cell>, EngineError> {
    let scene = cells(lengths, places.len());
    let (_, mut state) = start(&scene);
    for (position, place) in state.positions.iter_mut().zip(places) {
        *position = [place[0], place[1], 0];
    }
    state.masses = vec![1; places.len()];
    let mut engine = engine(&scene, &state, options);
    engine.reported()?;
    Ok(read(&mut engine, places.len()))
}

fn read(engine: &mut Engine<'_>, count: usize) -> Vec<Cell> {
    let particles = engine.words("particles").unwrap();
    let counts = engine.words("face_counts").unwrap();
    let words = engine.words("face_words").unwrap();
    let lengths = engine.words("face_lengths").unwrap();
    let offsets = engine.words("face_offsets").unwrap();
    let volumes = engine.words("volumes").unwrap();
    let place = |slot: usize| [particles[8 * slot], particles[8 * slot + 1]];
    let real = |word: u32| f64::from(f32::from_bits(word));
    let face = |slot: usize, face: usize| {
        let element = face * count + slot;
        let word = words[element];
        let neighbour = (word & 0x0fff_ffff) as usize;
        let code = i64::from(word >> 28);
        let boxes = [code % 3 - 1, code / 3 - 1];
        let away = std::array::from_fn(|axis| {
            let steps = place(neighbour)[axis].wrapping_sub(place(slot)[axis]) as i32;
            i64::from(steps) + (boxes[axis] << 32)
        });
        Face { neighbour, away, length: real(lengths[element]), offset: real(offsets[element]) }
    };
    (0..count)
        .map(|slot| Cell {
            place: place(slot),
            id: particles[8 * slot + 3],
            volume: real(volumes[slot]),
            faces: (0..counts[slot] as usize).map(|index| face(slot, index)).collect(),
        })
        .collect()
}

/// Random places, different for each seed.
fn random(count: usize, seed: u64) -> Vec<[u32; 2]> {
    use rand::{RngExt, SeedableRng};
    let mut random = rand::rngs::StdRng::seed_from_u64(seed);
    (0..count).map(|_| [random.random(), random.random()]).collect()
}

/// Volumes fill the box, faces close every cell, and are seen from both sides.
#[track_caller]
fn assert_consistent(what: &str, lengths: [f64; 2], cells: &[Cell]) {
    let area: f64 = cells.iter().map(|cell| cell.volume).sum();
    let expected = lengths[0] * lengths[1];
    println!("{what}: area {area} of {expected}");
    let mut seen = std::collections::HashMap::new();
    for (slot, cell) in cells.iter().enumerate() {
        for face in &cell.faces {
            let known = seen.insert((slot, face.neighbour, face.away), *face);
            assert!(known.is_none(), "{what}: cell {slot} has two faces with {}", face.neighbour);
        }
    }
    let mut lost = 0;
    for ((slot, neighbour, away), face) in &seen {
        let back = (*neighbour, *slot, [-away[0], -away[1]]);
        let Some(other) = seen.get(&back) else {
            lost += 1;
            if lost < 10 {
                println!("{what}: {slot} has a face with {neighbour} at {away:?}, not seen from there: {face:?}");
            }
            continue;
        };
        let _ = other;
    }
    assert_eq!(lost, 0, "{what}");
    assert!((area / expected - 1.0).abs() < 1e-6, "{what}: area {area} of {expected}");
}

#[test]
fn random_cells() {
    let lengths = [100.0, 100.0];
    for (count, seed) in [(1, 1), (2, 2), (3, 3), (5, 4), (9, 5), (100, 6), (10_000, 7)] {
        let cells = tessellate(lengths, &random(count, seed), Options::default()).unwrap();
        let faces: usize = cells.iter().map(|cell| cell.faces.len()).sum();
        println!("{count}: {faces}");
        assert_consistent(&format!("{count} cells"), lengths, &cells);
    }
}
