//! What `check` says of shallow water.

use super::plan::smoothing::iterations;
use super::{WaterLayout, waves};
use crate::document::{BathRate, LaplacianSymbol, MeshBath, Scene, SmoothingSolver};
use crate::families::ShallowWater;
use crate::numbers::{counted_in_groups, grouped, six_digits};
use crate::plan::Plan;

/// The particles, with their number.
pub(super) fn particles(water: &ShallowWater, count: u64) -> String {
    if water.carriers == count {
        return grouped(count);
    }
    let tracers = counted_in_groups(count - water.carriers, "tracer");
    format!("{} of water and {tracers},", grouped(water.carriers))
}

/// What a scene of shallow water does on its mesh.
pub(super) fn mesh(water: &ShallowWater, scene: &Scene, plan: &Plan, nodes: &str) -> Vec<(&'static str, String)> {
    let lengths = [scene.space.lengths[0], scene.space.lengths[1]];
    let per_node = water.carriers as f64 / water.nodes() as f64;
    let order = water.spline_order;
    let smoothing = &water.smoothing;
    let solver = match smoothing.solver {
        SmoothingSolver::Fft { symbol: LaplacianSymbol::FivePoint } => "fft, five-point".to_owned(),
        SmoothingSolver::Fft { symbol: LaplacianSymbol::Spectral } => "fft, spectral".to_owned(),
        SmoothingSolver::Chebyshev { tolerance } => {
            let count = iterations(water, lengths, tolerance);
            format!("chebyshev, tolerance {tolerance}, {count} iterations")
        }
    };
    let cells = [0, 1].map(|axis| smoothing.length * f64::from(water.mesh[axis]) / lengths[axis]);
    let smoothing = if smoothing.length == 0.0 {
        "none".to_owned()
    } else {
        let (length, power) = (smoothing.length, smoothing.power);
        let length = if length < 1e-3 { format!("{length:.3e}") } else { format!("{length:.4}") };
        format!("{solver}, length {length} ({:.2} × {:.2} cells), power {power}", cells[0], cells[1])
    };
    let storage = match plan.layout.of::<WaterLayout>().and_then(|layout| layout.bins) {
        Some(bins) => format!("a bin of {} particles for every cell", bins.capacity),
        None => "sorted by cell in every step".to_owned(),
    };
    let mut rows = vec![
        ("mesh", format!("{nodes} nodes, splines of order {order}, {per_node:.1} particles a node")),
        ("storage", storage),
        ("smoothing", smoothing),
    ];
    match scene.system.shallow_water().and_then(|asked| asked.bath.as_ref()) {
        Some(MeshBath::White {}) => rows.push(("bath", "white".to_owned())),
        Some(MeshBath::Memory { epsilon, scheme, rate }) => {
            let rate = if *rate == BathRate::Printed { ", rate as printed" } else { "" };
            rows.push(("bath", format!("memory, epsilon {epsilon}, {scheme}{rate}")));
        }
        None => {}
    }
    rows.push(("waves", waves::in_words(water, lengths)));
    let share = water.stability(lengths, scene.time.step);
    let clean = water.clean_share();
    rows.push((
        "stability",
        format!(
            "the stiffest wave takes p = {} of the limit of water spread evenly; at random places up to {} is stable",
            six_digits(share),
            if clean < 0.01 { six_digits(clean) } else { format!("{clean:.2}") }
        ),
    ));
    rows
}
