//! The flow of shallow water on the nodes of its mesh.

use super::reference::mesh_splines;
use crate::families::{Model, ShallowWater};
use crate::state::Reported;

/// Velocities on the nodes of a mesh, and what follows from them: Σ m V ψ / Σ m ψ over the particles that the B-splines
/// of a node reach.
///
/// All fields are lists over the nodes, with node (k, l), at (k Δx, l Δy), in place k + l·nₓ. Derivatives are central
/// differences across two spacings.
///
/// ```
/// use mesoscope::{measure::MeshFlow, scene};
///
/// let small = ["interactions.0.mesh=[16,16]", "interactions.0.smoothing.length=0.8", "particles.0.count=1024"];
/// let scene = scene::load("shallow-water", &small.map(str::to_owned))?;
/// let model = scene.model();
/// let mut state = mesoscope::state::Reported::from(mesoscope::families::initial_state(&scene));
/// state.momenta.fill([3_000_000, 4_000_000, 0]);
/// let water = model.shallow_water().ok_or("no shallow water")?;
/// let flow = MeshFlow::new(model, water, &state);
/// let speed = 5e6 * model.units.momentum;
/// assert!(flow.speed().iter().all(|found| (found / speed - 1.0).abs() < 1e-12));
/// assert!(flow.vorticity().iter().all(|found| found.abs() < 1e-9 * speed));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct MeshFlow {
    mesh: [usize; 2],
    spacing: [f64; 2],
    rotation: f64,
    /// Mass in units of the mean depth, and velocity.
    nodes: Vec<[f64; 3]>,
}

impl MeshFlow {
    /// The flow of the particles of a state, whose velocities are taken as they are: full-step ones, as a report gives
    /// them.
    #[must_use]
    pub fn new(model: &Model, water: &ShallowWater, state: &Reported) -> Self {
        let mesh = water.mesh.map(|nodes| nodes as usize);
        let mut nodes = vec![[0.0; 3]; mesh[0] * mesh[1]];
        let particles = state.positions.iter().zip(&state.momenta).zip(&state.masses);
        for ((position, velocity), units) in particles.take(water.carriers as usize) {
            let mass = f64::from(*units) * water.mass_unit;
            let [u, v, _] = model.units.momentum(*velocity);
            let [along_x, along_y] = mesh_splines(water, *position);
            for (row, weight_y) in along_y.nodes.iter().zip(along_y.weights) {
                for (column, weight_x) in along_x.nodes.iter().zip(along_x.weights) {
                    let share = mass * weight_x * weight_y;
                    let node = &mut nodes[column + row * mesh[0]];
                    *node = [node[0] + share, node[1] + share * u, node[2] + share * v];
                }
            }
        }
        for [mass, u, v] in &mut nodes {
            // Where there is no water, nothing flows.
            if *mass > 0.0 {
                [*u, *v] = [*u / *mass, *v / *mass];
            }
        }
        let spacing = [0, 1].map(|axis| model.units.lengths[axis] / mesh[axis] as f64);
        Self { mesh, spacing, rotation: water.rotation, nodes }
    }

    /// The mass on each node, which is the depth before any smoothing.
    #[must_use]
    pub fn masses(&self) -> Vec<f64> {
        self.nodes.iter().map(|[mass, _, _]| *mass).collect()
    }

    /// The magnitude of the velocity.
    #[must_use]
    pub fn speed(&self) -> Vec<f64> {
        self.nodes.iter().map(|[_, u, v]| u.hypot(*v)).collect()
    }

    /// The components of the velocity, along x and along y.
    pub(crate) fn velocity(&self) -> [Vec<f64>; 2] {
        [1, 2].map(|component| self.nodes.iter().map(|node| node[component]).collect())
    }

    /// The vorticity ζ = ∂v/∂x - ∂u/∂y.
    #[must_use]
    pub fn vorticity(&self) -> Vec<f64> {
        let [columns, rows] = self.mesh;
        let places = (0..rows).flat_map(|l| (0..columns).map(move |k| (k, l)));
        places
            .map(|(k, l)| {
                let node = |k: usize, l: usize| self.nodes[k % columns + l % rows * columns];
                let across_x = node(k + 1, l)[2] - node(k + columns - 1, l)[2];
                let across_y = node(k, l + 1)[1] - node(k, l + rows - 1)[1];
                0.5 * across_x / self.spacing[0] - 0.5 * across_y / self.spacing[1]
            })
            .collect()
    }

    /// The potential vorticity (ζ + f₀)/h over a smoothed depth h on the same nodes.
    pub(crate) fn potential_vorticity(&self, depth: &[f64]) -> Vec<f64> {
        self.vorticity().iter().zip(depth).map(|(vorticity, depth)| (vorticity + self.rotation) / depth).collect()
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]

    use super::*;
    use crate::families::initial_state;
    use crate::scene;
    use std::f64::consts::TAU;

    fn start(mesh: [u32; 2], count: u32) -> (Model, Reported) {
        let text = format!(
            r#"{{"title": "test", "space": {{"box": [3, 5]}}, "time": {{"step": 0.1, "steps": 1}}, "temperature": 0,
            "particles": [{{"species": "water", "count": {count}, "placement": {{"type": "lattice"}},
                "velocities": {{"type": "rest"}}}},
                {{"species": "dye", "tracer": true, "count": 50, "velocities": {{"type": "rest"}}}}],
            "interactions": [{{"type": "shallow-water", "mesh": [{}, {}], "wave_speed": 4, "rotation": 0.5}}]}}"#,
            mesh[0], mesh[1]
        );
        let scene = scene::parse("test", &text, &[]).unwrap();
        (scene.model().clone(), initial_state(&scene).into())
    }

    #[test]
    fn a_shear_and_a_swirl_have_their_vorticity() {
        let (model, mut state) = start([24, 40], 48 * 80);
        let water = model.shallow_water().cloned().unwrap();
        // u = sin(y'), v = 2 cos(x'), and tracers that would spoil it.
        let carriers = water.carriers as usize;
        for (particle, position) in state.positions.clone().into_iter().enumerate() {
            let [x, y, _] = model.units.position(position);
            let flow = [(TAU * y / 5.0).sin(), 2.0 * (TAU * x / 3.0).cos()];
            let flow = if particle < carriers { flow } else { [100.0, 100.0] };
            state.momenta[particle] = [flow[0], flow[1], 0.0].map(|v| (v / model.units.momentum).round() as i32);
        }
        let flow = MeshFlow::new(&model, &water, &state);
        let (speed, vorticity) = (flow.speed(), flow.vorticity());
        let [along_x, along_y] = flow.velocity();
        let potential = flow.potential_vorticity(&vec![2.0; 960]);
        assert_eq!(flow.masses().len(), 960);
        for node in 0..960 {
            let [x, y] = [TAU * f64::from(node % 24) / 24.0, TAU * f64::from(node / 24) / 40.0];
            let node = node as usize;
            assert!((flow.masses()[node] - 1.0).abs() < 1e-3);
            // Splines and differences smooth a wave of many spacings by a per cent or two.
            let (exact, tolerance) = (-2.0 * TAU / 3.0 * x.sin() - TAU / 5.0 * y.cos(), 0.03 * TAU);
            assert!((vorticity[node] - exact).abs() < tolerance, "node {node}: {} {exact}", vorticity[node]);
            assert!((speed[node] - y.sin().hypot(2.0 * x.cos())).abs() < 0.05, "node {node}");
            assert!(
                (along_x[node] - y.sin()).abs() < 0.05 && (along_y[node] - 2.0 * x.cos()).abs() < 0.05,
                "node {node}"
            );
            assert!((potential[node] - 0.5 * (vorticity[node] + 0.5)).abs() < 1e-12);
        }
    }

    #[test]
    fn without_water_nothing_flows() {
        let (model, state) = start([4, 4], 0);
        let flow = MeshFlow::new(&model, model.shallow_water().unwrap(), &state);
        assert_eq!(flow.speed(), [0.0; 16]);
        assert_eq!(flow.vorticity(), [0.0; 16]);
    }
}
