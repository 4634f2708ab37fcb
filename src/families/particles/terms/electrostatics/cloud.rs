//! The densities of charges, by what two of them do to each other.

use std::f64::consts::{PI, SQRT_2};

/// The density of a charge. Energies are over kT lB, for two unit charges of one density.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Cloud {
    /// e^(-r²/2σ²): the energy erf(r/2σ)/r, σ being the width.
    Gaussian { width: f64 },
    /// The energy [1 - (1 + βr) e^(-2βr)]/r, β being the decay: that of two clouds β² e^(-2βr)/πr, which the literature writes for charges of Slater.
    Slater { decay: f64 },
}

impl Cloud {
    /// The standard deviation of its density along each axis.
    pub(crate) fn width(self) -> f64 {
        match self {
            Self::Gaussian { width } => width,
            Self::Slater { decay } => 1.0 / (SQRT_2 * decay),
        }
    }

    /// The inverse of the energy of two in one place.
    pub(crate) fn contact_length(self) -> f64 {
        match self {
            Self::Gaussian { width } => width * PI.sqrt(),
            Self::Slater { decay } => 1.0 / decay,
        }
    }

    /// The inverse of the length by which kernels measure distances of two.
    pub(crate) fn scale(self) -> f64 {
        match self {
            Self::Gaussian { width } => 0.5 / width,
            Self::Slater { decay } => decay,
        }
    }

    /// The spectrum of the energy at the square of a wave number, over that of point charges, 4π/k².
    pub(crate) fn spectrum(self, square: f64) -> f64 {
        match self {
            Self::Gaussian { width } => (-square * width * width).exp(),
            Self::Slater { decay } => (1.0 + 0.25 * square / (decay * decay)).powi(-2),
        }
    }

    /// The square root of that: the spectrum of one.
    pub(crate) fn spectrum_of_one(self, number: f64) -> f64 {
        match self {
            Self::Gaussian { width } => (-0.5 * (number * width).powi(2)).exp(),
            Self::Slater { decay } => 1.0 / (1.0 + 0.25 * (number / decay).powi(2)),
        }
    }

    /// A and b of minus twice the logarithmic derivative of the spectrum by the square of a wave number, a/(1 + b k²).
    pub(crate) fn slope(self) -> [f64; 2] {
        match self {
            Self::Gaussian { width } => [2.0 * width * width, 0.0],
            Self::Slater { decay } => [1.0 / (decay * decay), 0.25 / (decay * decay)],
        }
    }

    /// A spectrum beyond which waves add nothing to forces.
    pub(crate) fn negligible(self) -> f64 {
        match self {
            Self::Gaussian { .. } => 1e-12,
            Self::Slater { .. } => 1e-4,
        }
    }

    /// The inverse of minus the Laplacian of the energy of two in one place, over 4π.
    pub(crate) fn volume(self) -> f64 {
        match self {
            Self::Gaussian { width } => 8.0 * PI.powf(1.5) * width.powi(3),
            Self::Slater { decay } => PI / decay.powi(3),
        }
    }

    /// The stiffness of the attraction of two opposite ones in one place.
    pub(crate) fn stiffness(self) -> f64 {
        4.0 * PI / (3.0 * self.volume())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Contact values and volumes are integrals of the spectrum over all waves, and slopes are its derivatives.
    #[test]
    fn clouds_are_those_of_their_spectrum() {
        for cloud in [Cloud::Gaussian { width: 0.6 }, Cloud::Slater { decay: 0.929 }] {
            let (steps, largest): (u32, f64) = (400_000, 400.0);
            let width = largest / f64::from(steps);
            let integral = |power: i32| -> f64 {
                let numbers = (0..steps).map(|index| (f64::from(index) + 0.5) * width);
                numbers.map(|number| number.powi(power) * cloud.spectrum(number * number) * width).sum()
            };
            assert!((2.0 / PI * integral(0) * cloud.contact_length() - 1.0).abs() < 1e-6, "{cloud:?}");
            // The tail of Slater's clouds beyond the largest falls as its inverse.
            let density = integral(2) / (2.0 * PI * PI);
            assert!((density * cloud.volume() - 1.0).abs() < 0.01, "{cloud:?} {density}");
            for square in [0.3_f64, 2.0, 9.0] {
                let derivative = (cloud.spectrum(square + 1e-5).ln() - cloud.spectrum(square - 1e-5).ln()) / 2e-5;
                let [at_zero, decrease] = cloud.slope();
                assert!((derivative + 0.5 * at_zero / (1.0 + decrease * square)).abs() < 1e-8, "{cloud:?} {square}");
                assert!((cloud.spectrum_of_one(square.sqrt()).powi(2) / cloud.spectrum(square) - 1.0).abs() < 1e-12);
            }
        }
    }
}
