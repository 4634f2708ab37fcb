//! Heat baths with exponential memory: the family of schemes of Cotter and Reich, doi:10.1209/epl/i2003-00621-8.

use crate::document::{Bath, BathScheme};

/// One step of a bath variable s that is coupled to a function h of the positions,
///
/// s' = e s + λₑ (1 + e)/2 (h(r') - h(r)) + √(kT λₑ (1 - e²)) ξ, ξ ~ N(0, 1).
///
/// Every scheme is one choice of e and λₑ. Without coupling, ⟨s²⟩ = kT λₑ.
///
/// ```
/// use mesoscope::{families::BathStep, scene::BathScheme};
///
/// let step = BathStep::with_memory(BathScheme::Exponential, 3.0, 2.0, 0.1);
/// assert!((step.persistence - (-0.2_f64).exp()).abs() < 1e-12);
/// // The noise makes up for what is forgotten: without coupling the variance stays kT λₑ.
/// let variance = step.deviation(1.5).powi(2);
/// assert!((step.persistence.powi(2) * variance + step.noise(1.5).powi(2) - variance).abs() < 1e-12);
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BathStep {
    /// The part e of s that one step leaves.
    pub persistence: f64,
    /// The coupling λₑ of the discrete step.
    pub coupling: f64,
    /// The coupling λ of the continuous bath; infinite without memory.
    pub continuous_coupling: f64,
}

impl BathStep {
    /// The step of a bath as the scene gives it, for a friction.
    #[must_use]
    pub fn of(bath: &Bath, friction: f64, time_step: f64) -> Self {
        match *bath {
            Bath::White { .. } => Self::without_memory(friction, time_step),
            Bath::Memory { rate, coupling, scheme, .. } => {
                Self::with_memory(scheme, coupling.unwrap_or(rate * friction), rate, time_step)
            }
        }
    }

    /// Whether the bath has a memory.
    pub(crate) fn remembers(&self) -> bool {
        self.continuous_coupling.is_finite()
    }

    /// The step of a bath ds = -αs dt + λ dh + √(2kTλα) dW.
    #[must_use]
    pub fn with_memory(scheme: BathScheme, coupling: f64, rate: f64, time_step: f64) -> Self {
        let a = rate * time_step;
        let (persistence, factor) = match scheme {
            BathScheme::CotterReich => (1.0 / (1.0 + a), 1.0 / (1.0 + 0.5 * a)),
            BathScheme::Symmetric => ((1.0 - 0.5 * a) / (1.0 + 0.5 * a), 1.0),
            BathScheme::Exponential => ((-a).exp(), if a > 1e-8 { (0.5 * a).tanh() / (0.5 * a) } else { 1.0 }),
        };
        // What single precision cannot hold is forgotten within a step.
        let persistence = if persistence.abs() < f64::from(f32::MIN_POSITIVE) { 0.0 } else { persistence };
        Self { persistence, coupling: coupling * factor, continuous_coupling: coupling }
    }

    /// The step of white noise with a friction: the limit of a fast bath at λ/α = γ.
    pub(crate) fn without_memory(friction: f64, time_step: f64) -> Self {
        Self { persistence: 0.0, coupling: 2.0 * friction / time_step, continuous_coupling: f64::INFINITY }
    }

    /// The step of this bath where it is coupled to nothing.
    pub(crate) fn uncoupled(self) -> Self {
        let continuous_coupling = if self.remembers() { 0.0 } else { self.continuous_coupling };
        Self { coupling: 0.0, continuous_coupling, ..self }
    }

    /// λₑ (1 + e)/2: what a change of h adds to s.
    pub(crate) fn response(&self) -> f64 {
        0.5 * self.coupling * (1.0 + self.persistence)
    }

    /// √(kT λₑ (1 - e²)): the standard deviation of the noise of one step.
    #[must_use]
    pub fn noise(&self, temperature: f64) -> f64 {
        (temperature * self.coupling * (1.0 - self.persistence * self.persistence)).max(0.0).sqrt()
    }

    /// √(kT λₑ): the standard deviation of s at rest.
    #[must_use]
    pub fn deviation(&self, temperature: f64) -> f64 {
        (temperature * self.coupling).sqrt()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn schemes_agree_for_small_steps_and_memory_ends_in_the_limit_of_none() {
        for scheme in [BathScheme::CotterReich, BathScheme::Symmetric, BathScheme::Exponential] {
            let step = BathStep::with_memory(scheme, 3.0, 2.0, 1e-6);
            assert!((step.persistence - 1.0 + 2e-6).abs() < 1e-11, "{scheme:?}");
            assert!((step.coupling - 3.0).abs() < 1e-5, "{scheme:?}");
        }
        let limit = BathStep::without_memory(1.5, 0.01);
        for scheme in [BathScheme::CotterReich, BathScheme::Exponential] {
            let fast = BathStep::with_memory(scheme, 1.5e12, 1e12, 0.01);
            assert!(fast.persistence < 1e-9);
            assert!((fast.coupling / limit.coupling - 1.0).abs() < 1e-9, "{scheme:?}");
        }
        // e^-2000 is none that single precision could hold.
        assert_eq!(BathStep::with_memory(BathScheme::Exponential, 3.0, 2e5, 0.01).persistence, 0.0);
        let none = BathStep::with_memory(BathScheme::Exponential, 3.0, 0.0, 0.01);
        assert_eq!((none.persistence, none.coupling, none.noise(1.0)), (1.0, 3.0, 0.0));
    }
}
