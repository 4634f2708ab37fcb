//! Friction and noise between cells, -η(l/r)(U + (U·e)e) and √(2kΘη l/r)(√2 e dW₁ + t dW₂) with 1/Θ = (1/Tₖ + 1/Tₗ)/2:
//! Flekkøy, Coveney and De Fabritiis, doi:10.1103/PhysRevE.62.2140, (39) and (62).

use super::faces::{Cells, Face, dot};
use crate::families::Voronoi;

/// Where conjugate gradients end.
const TOLERANCE: f64 = 1e-12;
/// Iterations without which there is no end.
const MOST_ITERATIONS: u64 = 10_000;

/// Velocities that friction sees, and how they were found.
pub(super) struct Solution {
    pub(super) velocities: Vec<[f64; 2]>,
    pub(super) iterations: u64,
    /// Relative to the right-hand side.
    pub(super) residual: f64,
}

/// What friction gives to k in a time, from velocities.
pub(super) fn impulse(cells: &Voronoi, face: &Face, velocities: &[[f64; 2]], time: f64) -> [f64; 2] {
    let relative = face.relative(velocities);
    let normal = dot(relative, face.normal);
    let rate = time * cells.viscosity * face.length / face.distance;
    [0, 1].map(|axis| -rate * (relative[axis] + normal * face.normal[axis]))
}

/// What noise gives to k in a time.
pub(super) fn random_impulse(cells: &Voronoi, now: &Cells, face: &Face, deviates: [f64; 3], time: f64) -> [f64; 2] {
    let [k, l] = [face.k, face.l].map(|cell| now.temperatures[cell]);
    let temperature = if k + l > 0.0 { 2.0 * k * l / (k + l) } else { 0.0 };
    let strength = (2.0 * temperature * cells.viscosity * time * face.length / face.distance).sqrt();
    let along = 2.0_f64.sqrt() * deviates[0];
    [0, 1].map(|axis| strength * (along * face.normal[axis] + deviates[1] * face.tangent[axis]))
}

/// The mean Ū of the velocities before and after friction and noise in a time, which friction by Crank and Nicolson sees:
/// 2M(Ū - U) = -dt G Ū + J, with G the friction of all faces.
///
/// Solved by conjugate gradients for (2M + dt G) Ū = 2MU + J, preconditioned by each cell's own block of the matrix.
pub(super) fn solve(cells: &Voronoi, now: &Cells, faces: &[Face], random: &[[f64; 2]], time: f64) -> Solution {
    let count = now.masses.len();
    let apply = |vector: &[[f64; 2]]| {
        let mut product: Vec<[f64; 2]> =
            (0..count).map(|cell| vector[cell].map(|v| 2.0 * now.masses[cell] * v)).collect();
        for face in faces {
            let impulse = impulse(cells, face, vector, time);
            for axis in 0..2 {
                product[face.k][axis] -= impulse[axis];
                product[face.l][axis] += impulse[axis];
            }
        }
        product
    };
    let mut right: Vec<[f64; 2]> =
        (0..count).map(|cell| now.velocities[cell].map(|velocity| 2.0 * now.masses[cell] * velocity)).collect();
    for (face, random) in faces.iter().zip(random) {
        for axis in 0..2 {
            right[face.k][axis] += random[axis];
            right[face.l][axis] -= random[axis];
        }
    }
    let blocks = own_blocks(cells, now, faces, time);
    let precondition = |vector: &[[f64; 2]]| -> Vec<[f64; 2]> {
        vector.iter().zip(&blocks).map(|(vector, block)| divide(*vector, *block)).collect()
    };

    let mut velocities = now.velocities.clone();
    let mut residual = combine(&right, -1.0, &apply(&velocities));
    let scale = product(&right, &right).sqrt();
    let mut preconditioned = precondition(&residual);
    let mut direction = preconditioned.clone();
    let mut weight = product(&residual, &preconditioned);
    let mut iterations = 0;
    while product(&residual, &residual).sqrt() > TOLERANCE * scale && iterations < MOST_ITERATIONS {
        let image = apply(&direction);
        let step = weight / product(&direction, &image);
        velocities = combine(&velocities, step, &direction);
        residual = combine(&residual, -step, &image);
        preconditioned = precondition(&residual);
        let next = product(&residual, &preconditioned);
        direction = combine(&preconditioned, next / weight, &direction);
        weight = next;
        iterations += 1;
    }
    let residual = if scale > 0.0 { product(&residual, &residual).sqrt() / scale } else { 0.0 };
    Solution { velocities, iterations, residual }
}

/// The xx, xy and yy elements of each cell's own block of 2M + dt G.
fn own_blocks(cells: &Voronoi, now: &Cells, faces: &[Face], time: f64) -> Vec<[f64; 3]> {
    let mut blocks: Vec<[f64; 3]> = now.masses.iter().map(|mass| [2.0 * mass, 0.0, 2.0 * mass]).collect();
    for face in faces {
        let rate = time * cells.viscosity * face.length / face.distance;
        let [x, y] = face.normal;
        for cell in [face.k, face.l] {
            blocks[cell][0] += rate * (1.0 + x * x);
            blocks[cell][1] += rate * x * y;
            blocks[cell][2] += rate * (1.0 + y * y);
        }
    }
    blocks
}

fn divide([x, y]: [f64; 2], [xx, xy, yy]: [f64; 3]) -> [f64; 2] {
    let determinant = xx * yy - xy * xy;
    [(yy * x - xy * y) / determinant, (xx * y - xy * x) / determinant]
}

fn product(a: &[[f64; 2]], b: &[[f64; 2]]) -> f64 {
    a.iter().zip(b).map(|(a, b)| dot(*a, *b)).sum()
}

/// a + factor b.
fn combine(a: &[[f64; 2]], factor: f64, b: &[[f64; 2]]) -> Vec<[f64; 2]> {
    a.iter().zip(b).map(|(a, b)| [a[0] + factor * b[0], a[1] + factor * b[1]]).collect()
}
