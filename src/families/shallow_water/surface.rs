//! The surface of shallow water at the start: features of the smoothed depth, and the depth that smooths to them.

use crate::document::SurfaceFeature;
use std::f64::consts::TAU;

/// A periodic surface 1 + Σ features over a box.
///
/// ```
/// use mesoscope::{families::shallow_water::surface::Surface, scene::SurfaceFeature};
///
/// let wave = [SurfaceFeature::Wave { periods: [1, 0], amplitude: 0.1 }];
/// let surface = Surface::new(&wave, [std::f64::consts::TAU, 3.0]);
/// assert!((surface.smoothed([0.0, 0.0]) - 1.1).abs() < 1e-12);
/// assert!((surface.slope([1.0, 0.0])[0] + 0.1 * 1_f64.sin()).abs() < 1e-9);
/// // A length of ½ smooths a wave of wave number 1 by 1 + ½².
/// assert!((surface.unsmoothed([0.0, 0.0], 0.5, 1) - 1.0 - 0.1 * 1.25).abs() < 1e-9);
/// ```
#[derive(Debug, Clone, Copy)]
pub struct Surface<'a> {
    features: &'a [SurfaceFeature],
    lengths: [f64; 2],
}

/// Weights of f(x ± jδ), j = 0…4, in the second derivative at x, with an error of order δ⁸.
const SECOND: [f64; 5] = [-205.0 / 72.0, 8.0 / 5.0, -1.0 / 5.0, 8.0 / 315.0, -1.0 / 560.0];
/// Weights of f(x + jδ) - f(x - jδ), j = 1…4, in the first derivative.
const FIRST: [f64; 4] = [4.0 / 5.0, -1.0 / 5.0, 4.0 / 105.0, -1.0 / 280.0];
/// Steps of the differences for each length over which a feature changes.
const STEPS_PER_LENGTH: f64 = 30.0;

fn is_wave(feature: &SurfaceFeature) -> bool {
    matches!(feature, SurfaceFeature::Wave { .. })
}

/// (1 - Λ²∇²)^power of a function, with differences of this step.
fn sharpened(function: &dyn Fn([f64; 2]) -> f64, [x, y]: [f64; 2], step: f64, length: f64, power: u32) -> f64 {
    if power == 0 || length == 0.0 {
        return function([x, y]);
    }
    let inner = |x: f64, y: f64| sharpened(function, [x, y], step, length, power - 1);
    let middle = inner(x, y);
    let mut laplacian = 2.0 * SECOND[0] * middle;
    for (weight, distance) in SECOND.iter().zip([0.0, step, 2.0 * step, 3.0 * step, 4.0 * step]).skip(1) {
        laplacian += weight
            * (inner(x + distance, y) + inner(x - distance, y) + inner(x, y + distance) + inner(x, y - distance));
    }
    middle - length * length * laplacian / (step * step)
}

impl<'a> Surface<'a> {
    /// The surface of some features over a box with these edges.
    #[must_use]
    pub fn new(features: &'a [SurfaceFeature], lengths: [f64; 2]) -> Self {
        Self { features, lengths }
    }

    /// Whether there are no features.
    pub(crate) fn is_flat(&self) -> bool {
        self.features.is_empty()
    }

    /// The smoothed depth H at a point.
    #[must_use]
    pub fn smoothed(&self, point: [f64; 2]) -> f64 {
        1.0 + self.features.iter().map(|feature| self.feature(feature, point)).sum::<f64>()
    }

    /// The depth (1 - Λ²∇²)^power H that smooths to H: exact of waves, with differences of eighth order of other features.
    #[must_use]
    pub fn unsmoothed(&self, point: [f64; 2], length: f64, power: u32) -> f64 {
        let waves = self.features.iter().filter(|feature| is_wave(feature)).map(|wave| {
            let factor = 1.0 + length * length * self.squared_wave_number(wave);
            factor.powi(power as i32) * self.feature(wave, point)
        });
        let waves: f64 = waves.sum();
        if self.features.iter().all(is_wave) {
            return 1.0 + waves;
        }
        let others = |point| {
            let others = self.features.iter().filter(|feature| !is_wave(feature));
            1.0 + others.map(|feature| self.feature(feature, point)).sum::<f64>()
        };
        waves + sharpened(&others, point, self.step(), length, power)
    }

    /// Evaluations of features that [`Self::unsmoothed`] takes.
    pub(super) fn terms_of_depth(&self, power: u32) -> f64 {
        let points = (1 + 4 * FIRST.len()) as f64;
        let each = |feature| if is_wave(feature) { 1.0 } else { points.powi(power as i32) };
        self.features.iter().map(each).sum()
    }

    /// Evaluations of features that [`Self::slope`] takes.
    pub(super) fn terms_of_slope(&self) -> f64 {
        (4 * FIRST.len() * self.features.len()) as f64
    }

    /// Of a wave; other features have no one wave number.
    fn squared_wave_number(&self, feature: &SurfaceFeature) -> f64 {
        let SurfaceFeature::Wave { periods, .. } = feature else { return 0.0 };
        (0..2).map(|axis| (f64::from(periods[axis]) * TAU / self.lengths[axis]).powi(2)).sum()
    }

    /// The slope of the smoothed depth.
    #[must_use]
    pub fn slope(&self, point: [f64; 2]) -> [f64; 2] {
        if self.is_flat() {
            return [0.0; 2];
        }
        let step = self.step();
        std::array::from_fn(|axis| {
            let at = |distance: f64| {
                let mut moved = point;
                moved[axis] += distance;
                self.smoothed(moved)
            };
            let differences = FIRST.iter().zip(1..).map(|(weight, j)| {
                let distance = f64::from(j) * step;
                weight * (at(distance) - at(-distance))
            });
            differences.sum::<f64>() / step
        })
    }

    fn feature(&self, feature: &SurfaceFeature, [x, y]: [f64; 2]) -> f64 {
        let [x, y] = [x / self.lengths[0] * TAU, y / self.lengths[1] * TAU];
        match *feature {
            SurfaceFeature::Front { amplitude, width, meander } => {
                let eta = y + meander * ((3.0 * x).sin() - (2.0 * x).sin());
                amplitude * (eta.sin() / width).tanh()
            }
            SurfaceFeature::Bump { center, radius, amplitude } => {
                let term = |angle: f64, axis: usize| {
                    let wave = TAU / self.lengths[axis];
                    (1.0 - (angle - wave * center[axis]).cos()) / (wave * radius).powi(2)
                };
                amplitude * (-term(x, 0) - term(y, 1)).exp()
            }
            SurfaceFeature::Wave { periods, amplitude } => {
                amplitude * (f64::from(periods[0]) * x + f64::from(periods[1]) * y).cos()
            }
        }
    }

    /// The step of differences: small against the shortest length over which a feature changes.
    fn step(&self) -> f64 {
        let shortest = self.lengths[0].min(self.lengths[1]);
        let length = |feature: &SurfaceFeature| match *feature {
            // Widths of a front are in radians of the box; the tanh itself changes twice as fast, and a meander lets it
            // change up to five times its amplitude faster along x than along y.
            SurfaceFeature::Front { width, meander, .. } => {
                0.5 * width.min(1.0) / (5.0 * meander.abs()).max(1.0) * shortest / TAU
            }
            SurfaceFeature::Bump { radius, .. } => radius,
            SurfaceFeature::Wave { periods, .. } => {
                shortest / (TAU * f64::from(periods[0].unsigned_abs().max(periods[1].unsigned_abs()).max(1)))
            }
        };
        self.features.iter().map(length).fold(shortest, f64::min) / STEPS_PER_LENGTH
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const BOX: [f64; 2] = [3.0, 5.0];

    #[test]
    fn a_wave_has_its_known_derivatives() {
        let features = [SurfaceFeature::Wave { periods: [2, -1], amplitude: 0.3 }];
        let surface = Surface::new(&features, BOX);
        let wave = [2.0 * TAU / BOX[0], -TAU / BOX[1]];
        let point = [0.7, 1.9];
        let phase = wave[0] * point[0] + wave[1] * point[1];
        let squared = wave[0] * wave[0] + wave[1] * wave[1];
        assert!((surface.smoothed(point) - 1.0 - 0.3 * phase.cos()).abs() < 1e-14);
        for axis in 0..2 {
            assert!((surface.slope(point)[axis] + 0.3 * wave[axis] * phase.sin()).abs() < 1e-10);
        }
        for power in [1, 2] {
            let factor = (1.0 + 0.04 * squared).powi(power);
            let exact = 1.0 + 0.3 * phase.cos() * factor;
            let found = surface.unsmoothed(point, 0.2, power.unsigned_abs());
            assert!((found - exact).abs() < 1e-13, "power {power}: {found} instead of {exact}");
            // What holds of waves holds of differences, which the other features take.
            let found = sharpened(&|point| surface.smoothed(point), point, surface.step(), 0.2, power.unsigned_abs());
            assert!((found - exact).abs() < 1e-7, "differences, power {power}: {found} instead of {exact}");
        }
    }

    /// The numbers are those of derivatives with 40 digits.
    #[test]
    fn a_steep_meander_has_its_known_derivatives() {
        let features = [SurfaceFeature::Front { amplitude: 0.1, width: 0.5, meander: 4.0 }];
        let surface = Surface::new(&features, [TAU, TAU]);
        for (point, exact) in
            [([0.3, 1.1], 1.079_930_010_422_5), ([2.0, 0.4], 5.099_558_206_738_46), ([3.3, 5.0], 2.453_854_933_295_7)]
        {
            let found = surface.unsmoothed(point, 0.4, 1);
            assert!((found - exact).abs() < 1e-8, "{point:?}: {found} instead of {exact}");
        }
    }

    #[test]
    fn every_feature_is_periodic() {
        let features = [
            SurfaceFeature::Front { amplitude: 0.1, width: 0.5, meander: 0.1 },
            SurfaceFeature::Bump { center: [2.9, 0.1], radius: 0.3, amplitude: -0.2 },
            SurfaceFeature::Wave { periods: [1, 3], amplitude: 0.05 },
        ];
        let surface = Surface::new(&features, BOX);
        let [a, b] = [[0.4, 4.8], [0.4 - 2.0 * BOX[0], 4.8 + BOX[1]]].map(|point| surface.unsmoothed(point, 0.1, 1));
        assert!((a - b).abs() < 1e-9);
        // At its centre a bump has its whole height.
        let bump = Surface::new(&features[1..2], BOX);
        assert!((bump.smoothed([2.9 - BOX[0], 0.1]) - 0.8).abs() < 1e-12);
    }
}
