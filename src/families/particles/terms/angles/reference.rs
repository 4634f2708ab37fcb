//! Angles in float64: V = k(1 + cos θ), θ the angle between the arms to both neighbours, π where a chain is straight.

use super::Angles;
use crate::families::Angle;
use crate::families::particles::reference::{Configuration, Images, Kicks, Moment, dot, round};
use crate::families::particles::terms::ReferenceTerm;

/// An angle where it is, with arms from its middle to its ends.
struct Corner {
    /// Unit vectors along the arms.
    directions: [[f64; 3]; 2],
    /// Lengths of the arms.
    lengths: [f64; 2],
    /// cos θ.
    cosine: f64,
}

impl Corner {
    /// None where an arm has no length: then there is no angle, and no force.
    fn of(images: &Images<'_>, angle: &Angle, positions: &[[u32; 3]]) -> Option<Self> {
        let [first, middle, last] = angle.ends.map(|end| positions[end as usize]);
        let arms = [first, last].map(|end| images.displacement(end, middle).0);
        let lengths = arms.map(|arm| dot(arm, arm).sqrt());
        if lengths.contains(&0.0) {
            return None;
        }
        let directions = [0, 1].map(|arm: usize| arms[arm].map(|component| component / lengths[arm]));
        Some(Self { directions, lengths, cosine: dot(directions[0], directions[1]) })
    }

    /// The arms from the middle to the ends.
    fn arms(&self) -> [[f64; 3]; 2] {
        [0, 1].map(|arm: usize| self.directions[arm].map(|component| component * self.lengths[arm]))
    }

    /// V/k = 1 + cos θ.
    fn energy(&self) -> f64 {
        1.0 + self.cosine
    }

    /// ∇cos θ at both ends; at the middle it is minus their sum.
    fn gradients(&self) -> [[f64; 3]; 2] {
        [0, 1].map(|arm: usize| {
            let (own, other) = (self.directions[arm], self.directions[1 - arm]);
            std::array::from_fn(|axis| (other[axis] - self.cosine * own[axis]) / self.lengths[arm])
        })
    }

    /// ∇²cos θ at the first end, the middle and the last end in d dimensions.
    ///
    /// As a function of the direction of one arm, cos θ is a spherical harmonic of degree 1:
    /// ∇²cos θ = -(d - 1) cos θ/a² for an arm of length a. Moving the middle moves both arms, which adds twice the mixed
    /// derivative (d - 2 + cos²θ)/(ab).
    fn laplacians(&self, dimension: usize) -> [f64; 3] {
        let dimension = dimension as f64;
        let [first, last] = self.lengths.map(|length| -(dimension - 1.0) * self.cosine / (length * length));
        let mixed = (dimension - 2.0 + self.cosine * self.cosine) / (self.lengths[0] * self.lengths[1]);
        [first, first + last + 2.0 * mixed, last]
    }
}

impl ReferenceTerm for Angles {
    /// Half kicks: those of the ends are rounded, and the middle gets minus their sum.
    fn kick(&self, moment: &Moment<'_>, kicks: &mut Kicks) {
        let model = moment.model;
        for angle in self.iter() {
            let Some(corner) = Corner::of(&moment.images, &angle, &moment.state.positions) else { continue };
            let stiffness = self.stiffness[angle.kind as usize];
            for (arm, gradient) in corner.arms().into_iter().zip(corner.gradients()) {
                kicks.virials.add_arm(angle.ends[1] as usize, arm, gradient.map(|slope| -stiffness * slope));
            }
            for (gradient, end) in corner.gradients().iter().zip([angle.ends[0], angle.ends[2]]) {
                let mut impulse = [0; 3];
                round(
                    &mut impulse,
                    gradient.map(|slope| -0.5 * model.time_step * stiffness * slope),
                    model.units.momentum,
                );
                for axis in 0..3 {
                    kicks.both[end as usize][axis] += impulse[axis];
                    kicks.both[angle.ends[1] as usize][axis] -= impulse[axis];
                }
            }
        }
    }

    fn observe(&self, sums: &mut Configuration<'_>) {
        for angle in self.iter() {
            let stiffness = self.stiffness[angle.kind as usize];
            let Some(corner) = Corner::of(sums.images, &angle, &sums.state.positions) else { continue };
            sums.potential += stiffness * corner.energy();
            let [first, last] = corner.gradients();
            let middle = std::array::from_fn(|axis| -first[axis] - last[axis]);
            let derivatives = [first, middle, last].into_iter().zip(corner.laplacians(sums.dimension));
            for (end, (gradient, laplacian)) in angle.ends.iter().zip(derivatives) {
                sums.laplacians[*end as usize] += stiffness * laplacian;
                for axis in 0..3 {
                    sums.gradients[*end as usize][axis] += stiffness * gradient[axis];
                }
            }
        }
    }
}
