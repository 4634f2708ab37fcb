//! Circulation around material loops in a rotating frame.

use crate::state::Units;

/// The absolute circulation ∮ V·dX + f₀ A around a closed loop of points in order, with A the area that it goes round
/// counterclockwise.
///
/// With `dV/dt = f₀ (V_y, -V_x) - ∇Φ` every loop that moves with the flow keeps it (Kelvin's theorem): by Stokes' theorem
/// it is the integral of ζ + f₀ over the loop's inside. The points lie on a smooth curve, whose tangent is their central
/// difference of sixth order, `∮ V·dX = Σ V_j·(45 δ₁ - 9 δ₂ + δ₃)/60` with `δ_k = X_{j+k} - X_{j-k}`: as long as points
/// follow the curve closely the error falls with the sixth power of their distance. Fewer than seven points are the corners
/// of a polygon along which the velocity is linear, `Σ V_j·δ₁/2`.
/// Neighbours are joined the shortest way; a loop that goes round the box has no inside, and the answer is NaN.
///
/// `velocities` are in units of [`Units::momentum`], full-step ones, as a report gives them. Both lists are as long.
///
/// ```
/// use mesoscope::measure::circulation::circulation;
/// use mesoscope::state::Units;
///
/// // A square of edge 2 across a corner of the box, turning at angular velocity 3: twice that times the area.
/// let units = Units { dimension: 2, lengths: [10.0, 10.0, 1.0], gaps: [0.0; 3], momentum: 0.5 };
/// let corners = [[1.0, 1.0], [-1.0, 1.0], [-1.0, -1.0], [1.0, -1.0]];
/// let positions = corners.map(|[x, y]| units.fraction([x, y, 0.0]));
/// let velocities = corners.map(|[x, y]| [(-3.0 * y / 0.5) as i32, (3.0 * x / 0.5) as i32, 0]);
/// assert!((circulation(&units, &positions, &velocities, 0.0) - 24.0).abs() < 1e-6);
/// // In a rotating frame it has the frame's share as well.
/// assert!((circulation(&units, &positions, &velocities, 0.25) - 25.0).abs() < 1e-6);
/// ```
#[must_use]
pub fn circulation(units: &Units, positions: &[[u32; 3]], velocities: &[[i32; 3]], rotation: f64) -> f64 {
    let count = positions.len().min(velocities.len());
    // Where each point is from the first one, along the loop, in units of the box fraction.
    let mut places = Vec::with_capacity(count);
    let mut place = [0_i64; 2];
    for point in 0..count {
        places.push(place);
        for axis in 0..2 {
            place[axis] += i64::from(positions[(point + 1) % count][axis].wrapping_sub(positions[point][axis]) as i32);
        }
    }
    if place != [0, 0] {
        return f64::NAN;
    }
    let weights: &[i64] = if count < 7 { &[30] } else { &[45, -9, 1] };
    let scale = [0, 1].map(|axis| units.lengths[axis] / 4_294_967_296.0);
    let (mut sum, mut twice_area) = (0.0, 0.0);
    for (point, place) in places.iter().enumerate() {
        let along = [0, 1].map(|axis| {
            let difference =
                |by: usize| places[(point + by) % count][axis] - places[(point + count - by) % count][axis];
            let sixtieths: i64 = weights.iter().zip(1..).map(|(weight, by)| weight * difference(by)).sum();
            sixtieths as f64 / 60.0 * scale[axis]
        });
        let [x, y] = [0, 1].map(|axis| place[axis] as f64 * scale[axis]);
        let [u, v, _] = units.momentum(velocities[point]);
        sum += u * along[0] + v * along[1];
        twice_area += x * along[1] - y * along[0];
    }
    sum + 0.5 * rotation * twice_area
}

/// The largest distance between neighbours on a closed loop of points. A loop is a curve to the flow as long as this is
/// below the spacing of the mesh.
///
/// ```
/// use mesoscope::{measure::circulation::largest_gap, state::Units};
///
/// let units = Units { dimension: 2, lengths: [8.0, 8.0, 1.0], gaps: [0.0; 3], momentum: 1.0 };
/// // A triangle across the edge of the box.
/// let corners = [[7.0, 1.0], [1.0, 1.0], [1.0, 2.5]].map(|[x, y]| units.fraction([x, y, 0.0]));
/// assert_eq!(largest_gap(&units, &corners), 2.5);
/// ```
#[must_use]
pub fn largest_gap(units: &Units, positions: &[[u32; 3]]) -> f64 {
    let next = positions.iter().cycle().skip(1);
    let gap = |(point, next): (&[u32; 3], &[u32; 3])| {
        let [x, y, _] = units.displacement(*next, *point);
        x.hypot(y)
    };
    positions.iter().zip(next).map(gap).fold(0.0, f64::max)
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::TAU;

    const UNITS: Units = Units { dimension: 2, lengths: [3.0, 5.0, 1.0], gaps: [0.0; 3], momentum: 1.0 / 67_108_864.0 };

    fn loop_of(count: usize, point: impl Fn(f64) -> ([f64; 2], [f64; 2])) -> (Vec<[u32; 3]>, Vec<[i32; 3]>) {
        let points = (0..count).map(|index| point(TAU * index as f64 / count as f64));
        points
            .map(|([x, y], velocity)| {
                let [u, v] = velocity.map(|component| (component / UNITS.momentum).round() as i32);
                (UNITS.fraction([x, y, 0.0]), [u, v, 0])
            })
            .unzip()
    }

    #[test]
    fn a_free_loop_in_a_rotating_frame_keeps_its_circulation_exactly() {
        let rotation = 2.3_f64;
        // Every point moves by the exact solution of dV/dt = f₀ (V_y, -V_x), through the edges of the box.
        let after = |time: f64| {
            let (sine, cosine) = (rotation * time).sin_cos();
            loop_of(40, |angle| {
                let [x, y] = [2.8 + 0.4 * angle.cos(), 0.2 + 0.3 * (angle + 0.2 * angle.sin()).sin()];
                let [u, v] = [0.3 + (2.0 * angle).sin(), 0.5 * angle.cos() - 0.2];
                let moved =
                    [x + (sine * u + (1.0 - cosine) * v) / rotation, y + (sine * v - (1.0 - cosine) * u) / rotation];
                (moved, [cosine * u + sine * v, cosine * v - sine * u])
            })
        };
        let of = |(positions, velocities): (Vec<_>, Vec<_>)| circulation(&UNITS, &positions, &velocities, rotation);
        let before = of(after(0.0));
        assert!(before.abs() > 0.1, "{before}");
        for time in [0.1, 0.5, 1.0, 2.0] {
            assert!((of(after(time)) - before).abs() < 1e-6, "{time}: {} {before}", of(after(time)));
        }
    }

    #[test]
    fn clockwise_loops_count_negative_and_gradients_nothing() {
        let (positions, velocities) = loop_of(2000, |angle| ([1.0 + 0.5 * angle.cos(), 0.5 * angle.sin()], [0.0; 2]));
        let area = TAU / 8.0;
        assert!((circulation(&UNITS, &positions, &velocities, 2.0) - 2.0 * area).abs() < 1e-5);
        let reversed: Vec<_> = positions.iter().rev().copied().collect();
        assert!((circulation(&UNITS, &reversed, &velocities, 2.0) + 2.0 * area).abs() < 1e-5);
        // V = ∇(x² y).
        let (positions, velocities) = loop_of(2000, |angle| {
            let [x, y] = [1.0 + 0.5 * angle.cos(), 0.5 * angle.sin()];
            ([x, y], [2.0 * x * y, x * x])
        });
        assert!(circulation(&UNITS, &positions, &velocities, 0.0).abs() < 1e-5);
    }

    #[test]
    fn the_error_falls_with_the_sixth_power_of_the_distance_of_points() {
        // A loop with lobes in a shear: ∮ -y² dx.
        let error = |count: usize| {
            let (positions, velocities) = loop_of(count, |angle| {
                let radius = 0.5 + 0.1 * (3.0 * angle).cos();
                let [x, y] = [radius * angle.cos(), radius * angle.sin() + 0.3];
                ([x, y], [-y * y, 0.0])
            });
            // 2 · .3 times the area, ½ ∮ r² dα = π (½² + ½ .1²), and ∮ ⅔ r³ sin α dα = 0 for the rest.
            circulation(&UNITS, &positions, &velocities, 0.0) - 0.6 * 0.5 * TAU * (0.25 + 0.005)
        };
        let [coarse, fine] = [error(24), error(48)];
        assert!(coarse.abs() > 1e-4 && fine.abs() > 1e-7, "{coarse} {fine}");
        assert!((coarse / fine).abs() > 30.0, "{coarse} {fine}");
        assert!(error(400).abs() < 1e-7);
    }

    #[test]
    fn what_is_no_loop_has_no_circulation() {
        assert_eq!(circulation(&UNITS, &[], &[], 1.0), 0.0);
        assert_eq!(circulation(&UNITS, &[[7, 8, 0]], &[[1, 2, 0]], 1.0), 0.0);
        let (positions, velocities) = loop_of(30, |angle| ([3.0 * angle / TAU, 1.0], [1.0, 0.0]));
        assert!(circulation(&UNITS, &positions, &velocities, 1.0).is_nan());
    }
}
