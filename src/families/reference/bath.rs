//! The law of a heat bath, whatever it is coupled to.

use crate::families::BathStep;

/// s' = e s + λₑ(1 + e)/2 Δh + √(kTλₑ(1 - e²)) ξ: equation (16) of Cotter and Reich, doi:10.1209/epl/i2003-00621-8.
pub(crate) fn advanced(step: &BathStep, temperature: f64, before: f64, change: f64, gaussian: f64) -> f64 {
    let (e, coupling) = (step.persistence, step.coupling);
    let noise = (temperature * coupling * (1.0 - e * e)).max(0.0).sqrt();
    e * before + 0.5 * coupling * (1.0 + e) * change + noise * gaussian
}

/// k such steps at once while h is the same, but for the last of them, which it changes: what was `memory` = e s - c h,
/// c = λₑ(1 + e)/2, makes s = eᵏ⁻¹ memory + c h + √(kTλₑ(1 - e²ᵏ)) ξ where h was zero in between.
pub(crate) fn recalled(
    step: &BathStep,
    temperature: f64,
    memory: f64,
    steps: u32,
    coupling: f64,
    gaussian: f64,
) -> f64 {
    let e = step.persistence;
    let sign = if e < 0.0 && steps.is_multiple_of(2) { -1.0 } else { 1.0 };
    let kept = sign * e.abs().powf(f64::from(steps) - 1.0);
    // 1 - e²ᵏ with all its digits for a slow bath.
    let renewed = -(2.0 * f64::from(steps) * e.abs().ln()).exp_m1();
    kept * memory
        + 0.5 * step.coupling * (1.0 + e) * coupling
        + (temperature * step.coupling * renewed).sqrt() * gaussian
}

/// A bath at the report point, and what the state keeps of it: a bath with memory goes on from there, but is what it is at step 0;
/// one without has no past, whatever is kept.
pub(crate) fn at_report(
    step: &BathStep,
    temperature: f64,
    clock: u64,
    kept: Option<&mut u32>,
    change: f64,
    gaussian: f64,
) -> f64 {
    let Some(kept) = kept.filter(|_| step.remembers()) else {
        return advanced(step, temperature, 0.0, change, gaussian);
    };
    let before = f64::from(f32::from_bits(*kept));
    let value = if clock == 0 { before } else { advanced(step, temperature, before, change, gaussian) };
    *kept = (value as f32).to_bits();
    value
}

/// s²/2λ, the energy of a bath; none without memory or coupling.
pub(crate) fn energy(step: &BathStep, square: f64) -> Option<f64> {
    (step.remembers() && step.continuous_coupling > 0.0).then(|| square / (2.0 * step.continuous_coupling))
}

/// Sums over baths with memory.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct BathSums {
    /// Their number.
    pub count: u64,
    /// Σ s².
    pub squares: f64,
    /// Σ s²/2λ.
    pub energy: f64,
}

impl BathSums {
    /// Adds a bath in, if it remembers and is coupled at all.
    pub(crate) fn add(&mut self, step: &BathStep, value: f64) {
        if let Some(energy) = energy(step, value * value) {
            self.count += 1;
            self.squares += value * value;
            self.energy += energy;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::BathScheme;

    /// Steps one by one without noise, and their variance, against all at once.
    #[test]
    fn many_steps_apart_are_one() {
        for (rate, scheme) in [
            (0.1, BathScheme::CotterReich),
            (5.0, BathScheme::Symmetric),
            (1e3, BathScheme::Exponential),
            (0.0, BathScheme::Symmetric),
        ] {
            let step = BathStep::with_memory(scheme, 2.0, rate, 1.0);
            let c = step.response();
            for steps in 1..6 {
                // In contact at h = -0.3, then apart at h = 0, then in contact at h = -0.7.
                let (mut s, mut variance, mut h) = (1.7, 0.0, -0.3);
                let memory = step.persistence * s - c * h;
                for index in 1..=steps {
                    let next = if index == steps { -0.7 } else { 0.0 };
                    s = advanced(&step, 0.0, s, next - h, 0.0);
                    variance = step.persistence.powi(2) * variance + advanced(&step, 1.5, 0.0, 0.0, 1.0).powi(2);
                    h = next;
                }
                let found = recalled(&step, 0.0, memory, steps, -0.7, 0.0);
                assert!((found - s).abs() < 1e-12, "{scheme:?} {steps}: {found} {s}");
                let noise = recalled(&step, 1.5, 0.0, steps, 0.0, 1.0);
                assert!((noise.powi(2) - variance).abs() < 1e-12, "{scheme:?} {steps}: {noise}");
            }
        }
    }
}
