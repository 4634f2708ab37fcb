//! Stiff angles: V = k(1 + cos θ), θ the angle between the arms to both neighbours, π where a chain is straight.

use super::push;
use crate::families::particles::reference::pairs::dot;
use crate::families::particles::reference::shear::Images;
use crate::families::particles::reference::stress::Virials;
use crate::families::{Angle, Angles, Model};
use crate::state::State;

/// An angle where it is, with arms from its middle to its ends.
pub(in crate::families::particles::reference) struct Corner {
    /// Unit vectors along the arms.
    directions: [[f64; 3]; 2],
    /// Lengths of the arms.
    lengths: [f64; 2],
    /// cos θ.
    cosine: f64,
}

impl Corner {
    /// None where an arm has no length: then there is no angle, and no force.
    pub fn of(images: &Images<'_>, angle: &Angle, positions: &[[u32; 3]]) -> Option<Self> {
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
    pub fn energy(&self) -> f64 {
        1.0 + self.cosine
    }

    /// ∇cos θ at both ends; at the middle it is minus their sum.
    pub fn gradients(&self) -> [[f64; 3]; 2] {
        [0, 1].map(|arm: usize| {
            let (own, other) = (self.directions[arm], self.directions[1 - arm]);
            std::array::from_fn(|axis| (other[axis] - self.cosine * own[axis]) / self.lengths[arm])
        })
    }

    /// ∇²cos θ at the first end, the middle and the last end in d dimensions.
    ///
    /// As a function of the direction of one arm, cos θ is a spherical harmonic of degree 1: ∇²cos θ = -(d - 1) cos θ/a²
    /// for an arm of length a. Moving the middle moves both arms, which adds twice the mixed derivative
    /// (d - 2 + cos²θ)/(ab).
    pub fn laplacians(&self, dimension: usize) -> [f64; 3] {
        let dimension = dimension as f64;
        let [first, last] = self.lengths.map(|length| -(dimension - 1.0) * self.cosine / (length * length));
        let mixed = (dimension - 2.0 + self.cosine * self.cosine) / (self.lengths[0] * self.lengths[1]);
        [first, first + last + 2.0 * mixed, last]
    }
}

/// Adds the half kicks of all angles, of which those of the ends are rounded and the middle gets minus their sum, and the virials.
pub(in crate::families::particles::reference) fn kick(
    model: &Model,
    angles: &Angles,
    state: &State,
    kick: &mut [[i64; 3]],
    virials: &mut Virials,
) {
    let images = Images::of_step(model, state.step);
    for angle in angles.iter() {
        let Some(corner) = Corner::of(&images, &angle, &state.positions) else { continue };
        let stiffness = angles.stiffness[angle.kind as usize];
        for (arm, gradient) in corner.arms().into_iter().zip(corner.gradients()) {
            virials.add_arm(angle.ends[1] as usize, arm, gradient.map(|slope| -stiffness * slope));
        }
        for (gradient, end) in corner.gradients().iter().zip([angle.ends[0], angle.ends[2]]) {
            let mut impulse = [0; 3];
            push(&mut impulse, gradient.map(|slope| -0.5 * model.time_step * stiffness * slope), model.units.momentum);
            for axis in 0..3 {
                kick[end as usize][axis] += impulse[axis];
                kick[angle.ends[1] as usize][axis] -= impulse[axis];
            }
        }
    }
}
