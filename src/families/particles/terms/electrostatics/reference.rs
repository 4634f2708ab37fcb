//! Electrostatics in float64: the same mesh, with splines, sums over waves and differences in other ways than on the device.

use super::mesh::{self, Stencil};
use super::{Electrostatics, direct, exclusions};
use crate::families::Model;
use crate::families::particles::reference::{AXES, Configuration, Images, Kicks, Moment, Pair, Potential, dot, round};
use crate::families::particles::terms::ReferenceTerm;
use crate::state::State;
use rustfft::num_complex::Complex;
use rustfft::{FftDirection, FftPlanner};
use std::cmp::Ordering;
use std::f64::consts::TAU;

/// What charges make of a mesh.
struct Solved {
    /// Numbers and charges of particles.
    charged: Vec<(usize, f64)>,
    /// The force on each of them.
    forces: Vec<[f64; 3]>,
    energy: f64,
    /// As a tensor xx, yy, zz, xy, xz, yz.
    virial: [f64; 6],
    laplacian: f64,
}

/// The cardinal spline of a number of points: the n-fold convolution of a unit box with itself, from its truncated powers.
fn spline(x: f64, points: u32) -> f64 {
    let power = points as i32 - 1;
    let mut binomial = 1.0;
    let mut sum = 0.0;
    for k in 0..=points {
        let rest = x - f64::from(k);
        let sign = if k % 2 == 0 { 1.0 } else { -1.0 };
        if rest > 0.0 {
            sum += sign * binomial * rest.powi(power);
        }
        binomial *= f64::from(points - k) / f64::from(k + 1);
    }
    sum / (1..points).map(f64::from).product::<f64>()
}

impl Electrostatics {
    fn node(&self, at: [usize; 3]) -> usize {
        let [width, height, _] = self.mesh.map(|nodes| nodes as usize);
        at[0] + width * (at[1] + height * at[2])
    }

    /// Nodes and weights of a place.
    fn weights(&self, position: [u32; 3]) -> Vec<(usize, f64)> {
        let points = self.order as usize;
        let along = [0, 1, 2].map(|axis| {
            let nodes = f64::from(self.mesh[axis]);
            let place = f64::from(position[axis]) / 2_f64.powi(32) * nodes;
            let first = place.floor() as i64 - points as i64 / 2 + 1;
            (0..points)
                .map(|index| {
                    let node = first + index as i64;
                    let weight = spline(place - node as f64 + 0.5 * points as f64, self.order);
                    (node.rem_euclid(i64::from(self.mesh[axis])) as usize, weight)
                })
                .collect::<Vec<_>>()
        });
        let mut all = Vec::with_capacity(points * points * points);
        for (z, of_z) in &along[2] {
            for (y, of_y) in &along[1] {
                for (x, of_x) in &along[0] {
                    all.push((self.node([*x, *y, *z]), of_x * of_y * of_z));
                }
            }
        }
        all
    }

    /// Transforms a field along all axes.
    fn transform(&self, field: &mut [Complex<f64>], direction: FftDirection) {
        let mut stride = 1;
        for nodes in self.mesh.map(|nodes| nodes as usize) {
            let transform = FftPlanner::new().plan_fft(nodes, direction);
            let mut line = vec![Complex::default(); nodes];
            for first in (0..field.len()).filter(|index| index / stride % nodes == 0) {
                for (place, value) in line.iter_mut().enumerate() {
                    *value = field[first + place * stride];
                }
                transform.process(&mut line);
                for (place, value) in line.iter().enumerate() {
                    field[first + place * stride] = *value;
                }
            }
            stride *= nodes;
        }
    }

    fn solve(&self, model: &Model, state: &State) -> Solved {
        let charged: Vec<(usize, f64)> = (state.species.iter().enumerate())
            .map(|(particle, species)| (particle, model.species[*species as usize].charge))
            .filter(|(_, charge)| *charge != 0.0)
            .collect();
        match self.largest_wave {
            Some(largest) => self.solve_one_by_one(largest, charged, model.units.lengths, state),
            None => self.solve_on_mesh(charged, model.units.lengths, state),
        }
    }

    /// Sums waves up to a wave number, each with its opposite.
    fn solve_one_by_one(&self, largest: f64, charged: Vec<(usize, f64)>, lengths: [f64; 3], state: &State) -> Solved {
        let [width, decrease] = self.cloud.slope();
        let mut solved = self.by_themselves(charged, lengths);
        for wave in direct::waves(largest, lengths) {
            let number = [0, 1, 2].map(|axis| TAU * f64::from(wave[axis]) / lengths[axis]);
            let phase = |particle: usize| {
                let turns = [0, 1, 2].map(|axis| f64::from(state.positions[particle][axis]) / 2_f64.powi(32));
                Complex::cis(TAU * dot(turns, wave.map(f64::from)))
            };
            let sum: Complex<f64> = solved.charged.iter().map(|(particle, charge)| charge * phase(*particle)).sum();
            let weight = direct::weight(self, wave, lengths);
            let own = 0.5 * weight * sum.norm_sqr();
            let square = dot(number, number);
            solved.energy += own;
            solved.laplacian -= 2.0 * square * own;
            for (component, [a, b]) in AXES.into_iter().enumerate() {
                let pull = number[a] * number[b] * (2.0 / square + width / (1.0 + decrease * square));
                solved.virial[component] += own * (f64::from(u8::from(a == b)) - pull);
            }
            for ((particle, charge), force) in solved.charged.iter().zip(&mut solved.forces) {
                let slope = (sum.conj() * phase(*particle)).im;
                for axis in 0..3 {
                    force[axis] += charge * weight * number[axis] * slope;
                }
            }
        }
        solved
    }

    /// Charges without waves: their energies and curvatures by themselves.
    fn by_themselves(&self, charged: Vec<(usize, f64)>, lengths: [f64; 3]) -> Solved {
        Solved {
            forces: vec![[0.0; 3]; charged.len()],
            charged,
            energy: -self.own_energy(),
            virial: [0.0; 6],
            laplacian: self.own_laplacian(lengths.iter().product::<f64>()),
        }
    }

    fn solve_on_mesh(&self, charged: Vec<(usize, f64)>, lengths: [f64; 3], state: &State) -> Solved {
        let volume = lengths.iter().product::<f64>();
        let places: Vec<_> = charged.iter().map(|(particle, _)| self.weights(state.positions[*particle])).collect();
        let nodes = self.mesh.iter().map(|nodes| *nodes as usize).product();
        let mut field = vec![Complex::default(); nodes];
        for ((_, charge), weights) in charged.iter().zip(&places) {
            for (node, weight) in weights {
                field[*node].re += charge * weight;
            }
        }
        self.transform(&mut field, FftDirection::Forward);
        let mut solved = self.by_themselves(charged, lengths);
        let [width, decrease] = self.cloud.slope();
        let table = mesh::Waves::new(self, lengths);
        for (index, wave) in field.iter_mut().enumerate() {
            let [columns, rows, _] = self.mesh.map(|nodes| nodes as usize);
            let at = [index % columns, index / columns % rows, index / (columns * rows)];
            let folded = [0, 1, 2].map(|axis| (at[axis] as u32).min(self.mesh[axis] - at[axis] as u32));
            let number = [0, 1, 2].map(|axis| TAU * f64::from(folded[axis]) / lengths[axis]);
            let square = dot(number, number);
            // Waves in the middle of an axis are of both signs.
            let sign = |axis: usize| match (2 * at[axis]).cmp(&(self.mesh[axis] as usize)) {
                Ordering::Less => 1.0,
                Ordering::Equal => 0.0,
                Ordering::Greater => -1.0,
            };
            let weight = table.wave(folded);
            let own = 0.5 * weight.energy / volume * wave.norm_sqr();
            solved.energy += own;
            for (component, [a, b]) in AXES.into_iter().enumerate().filter(|_| square > 0.0) {
                let (isotropic, signs) = if a == b { (1.0, 1.0) } else { (0.0, sign(a) * sign(b)) };
                let pull = signs * number[a] * number[b] * (2.0 / square + width / (1.0 + decrease * square));
                solved.virial[component] += own * (isotropic - pull);
            }
            solved.laplacian -= 2.0 * square * own;
            *wave *= weight.potential / volume;
        }
        self.transform(&mut field, FftDirection::Inverse);
        for ((force, (_, charge)), weights) in solved.forces.iter_mut().zip(&solved.charged).zip(&places) {
            for (node, weight) in weights {
                for (axis, sum) in force.iter_mut().enumerate() {
                    *sum -= charge * weight * self.difference(&field, *node, axis, lengths[axis]);
                }
            }
        }
        solved
    }

    fn difference(&self, potential: &[Complex<f64>], node: usize, axis: usize, length: f64) -> f64 {
        let Stencil { weights, divisor } = Stencil::new(self.order);
        let count = self.mesh[axis] as usize;
        let stride = [1, self.mesh[0], self.mesh[0] * self.mesh[1]][axis] as usize;
        let place = node / stride % count;
        let at = |place: usize| potential[node - node / stride % count * stride + place % count * stride].re;
        let sum: f64 = (1..4).map(|off| weights[off - 1] * (at(place + off) - at(place + count - off))).sum();
        sum / divisor * count as f64 / length
    }
}

impl Electrostatics {
    /// The pairs that bonds exclude, with what is taken back.
    fn excluded(&self, model: &Model, images: &Images<'_>, state: &State) -> Vec<(Pair, Potential)> {
        let bonds = exclusions::excluding(model);
        let pairs = bonds.into_iter().flat_map(|bonds| exclusions::excluded_pairs(self, bonds));
        let taken = pairs.map(|([first, second], product)| {
            let pair = Pair::of(images, &state.positions, first as usize, second as usize);
            let potential = Potential::of_excluded_clouds(self.strength * product, self.cloud, pair.distance);
            (pair, potential)
        });
        taken.collect()
    }
}

impl ReferenceTerm for Electrostatics {
    /// Half kicks; what they add up to is taken back in whole units.
    fn kick(&self, moment: &Moment<'_>, kicks: &mut Kicks) {
        let (model, state) = (moment.model, moment.state);
        let solved = self.solve(model, state);
        let mut all = [0; 3];
        for ((particle, _), force) in solved.charged.iter().zip(&solved.forces) {
            let mut impulse = [0; 3];
            round(&mut impulse, force.map(|component| 0.5 * model.time_step * component), model.units.momentum);
            for axis in 0..3 {
                all[axis] += impulse[axis];
                kicks.both[*particle][axis] += impulse[axis];
            }
        }
        let count = solved.charged.len() as i64;
        let turn = model.clock(state.step) as u32;
        for (rank, (particle, _)) in (0..).zip(&solved.charged) {
            for (axis, sum) in all.iter().enumerate() {
                let place = i64::from(turn.wrapping_add(rank) % count as u32);
                kicks.both[*particle][axis] -= sum.div_euclid(count) + i64::from(place < sum.rem_euclid(count));
            }
        }
        kicks.virials.total += solved.virial[..3].iter().sum::<f64>();
        kicks.virials.of_waves = solved.virial;
        for (pair, potential) in self.excluded(model, &moment.images, state) {
            kicks.push_apart(model, &pair, potential.force(), 0.0);
        }
    }

    fn observe(&self, sums: &mut Configuration<'_>) {
        let solved = self.solve(sums.model, sums.state);
        sums.potential += solved.energy;
        sums.electrostatic += solved.energy;
        sums.virial += solved.virial[..3].iter().sum::<f64>();
        let of_square = solved.laplacian / self.squares();
        for ((particle, charge), force) in solved.charged.iter().zip(&solved.forces) {
            for axis in 0..3 {
                sums.gradients[*particle][axis] -= force[axis];
            }
            sums.laplacians[*particle] += charge * charge * of_square;
        }
        for (pair, potential) in self.excluded(sums.model, sums.images, sums.state) {
            sums.electrostatic += potential.energy;
            sums.add(&pair, &potential);
        }
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]

    use crate::families::Checked;
    use crate::families::reference::Reference;
    use serde_json::{Value, json};

    fn charges(lengths: [f64; 3], positions: &Value, charges: &[f64], more: &Value) -> Reference {
        let groups = positions.as_array().unwrap().iter().zip(charges).enumerate().map(|(index, (position, charge))| {
            json!({"species": format!("S{index}"), "charge": charge, "placement": {"type": "listed", "positions": [position]},
                "velocities": {"type": "rest"}})
        });
        let mut electrostatics = json!({"type": "electrostatics", "bjerrum_length": 1.0, "spacing": 0.5});
        electrostatics.as_object_mut().unwrap().extend(more.as_object().unwrap().clone());
        if more.get("decay").is_none() {
            electrostatics["width"] = json!(0.5842);
        }
        let scene = serde_json::from_value(json!({
            "title": "test", "space": {"box": lengths}, "time": {"step": 0.01, "steps": 1}, "temperature": 1.0,
            "integrator": {"type": "cotter-reich"}, "particles": groups.collect::<Vec<_>>(), "interactions": [electrostatics],
        }))
        .unwrap();
        let scene = Checked::presumed(scene);
        Reference::new(scene.model().clone(), crate::families::initial_state(&scene))
    }

    /// Two opposite charges in a periodic cube of 10: forces and energies of Ewald sums.
    #[test]
    fn forces_are_those_of_ewald_sums() {
        let gaussian = [(0.5, 0.209_405), (1.0, 0.305_322), (2.0, 0.210_959), (3.0, 0.094_572), (5.0, 0.0)];
        let slater = [(0.5, 0.268_757), (1.0, 0.280_642), (2.0, 0.169_930), (3.0, 0.085_726), (5.0, 0.0)];
        // The spectrum of Slater's charges has no end.
        for (more, values, tolerance) in
            [(json!({"spacing": 0.3}), gaussian, 1e-4), (json!({"decay": 0.929, "spacing": 0.15}), slater, 6e-4)]
        {
            for (distance, expected) in values {
                let places = json!([[2.3, 4.1, 7.7], [2.3 + distance, 4.1, 7.7]]);
                let mut reference = charges([10.0; 3], &places, &[1.0, -1.0], &more);
                assert_eq!(reference.state().momenta[0][0], 0);
                let scale = reference.model().units.momentum / 0.005;
                reference.step().unwrap();
                let force = f64::from(reference.state().momenta[0][0]) * scale;
                assert!((force - expected).abs() < tolerance, "{more} {distance}: {force}");
            }
        }
    }

    /// Energy of an ion of rock salt, without that of charges by themselves.
    #[test]
    fn energies_are_those_of_rock_salt() {
        for (spacing, expected) in [(1.0, -0.482_804), (1.5, -0.470_190), (2.0, -0.414_940), (3.0, -0.290_979)] {
            let edge = 4;
            let places: Vec<Vec<f64>> = (0..edge * edge * edge)
                .map(|index| {
                    [index % edge, index / edge % edge, index / edge / edge].map(|at| f64::from(at) * spacing).to_vec()
                })
                .collect();
            let signs: Vec<f64> = (0..edge * edge * edge)
                .map(|index| if (index + index / edge + index / edge / edge) % 2 == 0 { 1.0 } else { -1.0 })
                .collect();
            let length = f64::from(edge) * spacing;
            let reference = charges([length; 3], &json!(places), &signs, &json!({"spacing": 0.35}));
            let energy = reference.observe().unwrap().potential_energy / f64::from(edge * edge * edge);
            assert!((energy - expected).abs() < 2e-4, "{spacing}: {energy}");
        }
    }
}
