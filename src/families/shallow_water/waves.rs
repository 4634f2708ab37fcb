//! How much slower waves are on the mesh than in the equations of shallow water.
//!
//! Water that is spread evenly has on the nodes the depth of an oscillator, ω² = c₀² A(k) S(k), with the symbol A of the smoothing and that of
//! spreading and gathering by splines of order p, S = Σ (k + G)² ψ̂(k + G)² over the waves k + G that look alike on the nodes. ψ̂ is
//! sinc(kΔx/2) to the power p + 1. For quadratic and cubic splines the first wave is all but alone: c₀² is lower by sinc(kΔx/2) to the power
//! 2p + 2, which is sinc⁸ for cubic ones. For linear splines the others make up for a part, and what is left is sinc².

use super::model::spline_symbols;
use crate::document::{LaplacianSymbol, SmoothingSolver, SurfaceFeature};
use crate::families::ShallowWater;
use crate::numbers::three_digits;
use std::f64::consts::TAU;

/// Parts of the phase speed c₀ that a wave keeps.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Kept {
    /// On the mesh, by splines.
    pub mesh: f64,
    /// By the smoothing.
    pub smoothing: f64,
}

/// What is left of the speed of a plane wave of so many periods along each edge of a box.
pub(super) fn kept(water: &ShallowWater, lengths: [f64; 2], periods: [f64; 2]) -> Kept {
    let spacing = [0, 1].map(|axis| lengths[axis] / f64::from(water.mesh[axis]));
    let angles = [0, 1].map(|axis| TAU * periods[axis] / f64::from(water.mesh[axis]));
    let squared = |number: [f64; 2]| number[0].powi(2) + number[1].powi(2);
    let exact = squared([angles[0] / spacing[0], angles[1] / spacing[1]]);
    let [(mass_x, stiff_x), (mass_y, stiff_y)] = angles.map(|angle| spline_symbols(water.spline_order, angle));
    let on_mesh = stiff_x * mass_y / spacing[0].powi(2) + mass_x * stiff_y / spacing[1].powi(2);
    let is_spectral = water.smoothing.solver == SmoothingSolver::Fft { symbol: LaplacianSymbol::Spectral };
    let laplacian =
        if is_spectral { exact } else { squared([0, 1].map(|axis| 2.0 * (0.5 * angles[axis]).sin() / spacing[axis])) };
    let smoothing = (1.0 + water.smoothing.length.powi(2) * laplacian).powi(-(water.smoothing.power as i32));
    Kept { mesh: (on_mesh / exact).sqrt(), smoothing: smoothing.sqrt() }
}

/// The fewest nodes a wavelength with which the mesh takes no more than a part of the phase speed of waves along an axis.
pub(super) fn nodes_for(order: u32, part: f64) -> u32 {
    let lost = |nodes: u32| {
        let angle = TAU / f64::from(nodes);
        1.0 - (spline_symbols(order, angle).1 / (angle * angle)).sqrt()
    };
    (2..1000).find(|nodes| lost(*nodes) <= part).unwrap_or(u32::MAX)
}

/// What `check` says of waves: of the shortest that the surface of the scene has, or of how many nodes they need.
pub(super) fn in_words(water: &ShallowWater, lengths: [f64; 2]) -> String {
    let waves = water.surface.iter().filter_map(|feature| match feature {
        SurfaceFeature::Wave { periods, .. } if *periods != [0, 0] => Some(periods.map(f64::from)),
        _ => None,
    });
    let nodes = |periods: [f64; 2]| {
        let along = [0, 1].map(|axis| periods[axis] / f64::from(water.mesh[axis]));
        1.0 / along[0].hypot(along[1])
    };
    let percent = |part: f64| format!("{} %", three_digits(100.0 * (1.0 - part)));
    let smoothed = |kept: Kept| match water.smoothing.length {
        0.0 => String::new(),
        _ => format!(", and by {} by the smoothing", percent(kept.smoothing)),
    };
    if let Some(periods) = waves.min_by(|a, b| nodes(*a).total_cmp(&nodes(*b))) {
        let kept = kept(water, lengths, periods);
        let (nodes, mesh, smoothing) = (three_digits(nodes(periods)), percent(kept.mesh), smoothed(kept));
        return format!(
            "the shortest of the surface has {nodes} nodes a wavelength and is slowed by {mesh} by the mesh{smoothing}"
        );
    }
    let [hundredth, thousandth] = [0.01, 0.001].map(|part| nodes_for(water.spline_order, part));
    let smoothing = smoothed(kept(water, lengths, [f64::from(water.mesh[0]) / f64::from(hundredth), 0.0]));
    format!("{hundredth} nodes a wavelength are slowed by 1 % by the mesh{smoothing}; {thousandth} by 0.1 %")
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use crate::families::initial_state;
    use crate::families::reference::ShallowWaterReference;
    use crate::scene;

    /// The frequency of the reference, whose steps of a linear oscillator fulfil h(t + dt) + h(t - dt) = (2 - ω²dt²) h(t) exactly.
    #[test]
    fn waves_are_as_slow_as_they_are_said_to_be() {
        for (order, length, power, solver, periods) in [
            (1, 0.0, 1, r#"{"type":"fft"}"#, "[2,0]"),
            (2, 0.0, 1, r#"{"type":"fft"}"#, "[2,0]"),
            (3, 0.0, 1, r#"{"type":"fft"}"#, "[2,0]"),
            (3, 0.0, 1, r#"{"type":"fft"}"#, "[0,4]"),
            (3, 0.5, 1, r#"{"type":"fft"}"#, "[2,1]"),
            (3, 0.5, 2, r#"{"type":"fft","symbol":"spectral"}"#, "[1,3]"),
        ] {
            let changes = [
                "interactions.0.mesh=[16,16]".to_owned(),
                "particles.0.count=4096".to_owned(),
                r#"particles.0.velocities={"type":"rest"}"#.to_owned(),
                "interactions.0.rotation=0".to_owned(),
                format!("interactions.0.spline_order={order}"),
                format!(r#"interactions.0.smoothing={{"length":{length},"power":{power},"solver":{solver}}}"#),
                format!(r#"interactions.0.surface=[{{"type":"wave","periods":{periods},"amplitude":1e-4}}]"#),
                "time.step=0.01".to_owned(),
            ];
            let scene = scene::load("shallow-water", &changes).unwrap();
            let (model, state) = (scene.model().clone(), initial_state(&scene));
            let water = model.shallow_water().unwrap().clone();
            let lengths = [model.units.lengths[0], model.units.lengths[1]];
            let [m, n] = serde_json::from_str::<[f64; 2]>(periods).unwrap();
            let mut reference = ShallowWaterReference::new(model, state).unwrap();
            let amplitude = |reference: &ShallowWaterReference| -> f64 {
                let depth = reference.depth();
                let phase = |node: usize| TAU * (m * (node % 16) as f64 + n * (node / 16) as f64) / 16.0;
                depth.iter().enumerate().map(|(node, depth)| (depth - 1.0) * phase(node).cos()).sum()
            };
            let mut heights = vec![amplitude(&reference)];
            for _ in 0..60 {
                reference.run(1).unwrap();
                heights.push(amplitude(&reference));
            }
            let [mut curvature, mut square] = [0.0; 2];
            for three in heights.windows(3) {
                curvature += three[1] * (2.0 * three[1] - three[0] - three[2]);
                square += three[1] * three[1];
            }
            let frequency = (curvature / square).sqrt() / 0.01;
            let Kept { mesh, smoothing } = kept(&water, lengths, [m, n]);
            let exact = water.wave_speed * (TAU * m / lengths[0]).hypot(TAU * n / lengths[1]);
            let found = frequency / exact;
            // A lattice of 16 particles a cell is not yet water spread evenly to quadratic splines: a sum over it takes 0.0227 of the loss more.
            let (part, tolerance) = if order == 2 { (1.0227, 3e-3) } else { (1.0, 2e-3) };
            let exact = (1.0 - part * (1.0 - mesh)) * smoothing;
            assert!(
                (found / exact - 1.0).abs() < tolerance * (1.0 - mesh),
                "{order} {periods}: {found} {mesh} {smoothing}"
            );
            // To leading order of the angle of a node the loss is 1/24, 3/24 or 4/24 of its square.
            let angle = TAU * m.hypot(n) / 16.0;
            if n == 0.0 {
                assert!(
                    (1.0 - mesh - [1.0, 3.0, 4.0][order as usize - 1] / 24.0 * angle * angle).abs()
                        < 0.4 * angle.powi(4),
                    "{mesh}"
                );
            }
        }
        assert_eq!(
            [1, 2, 3].map(|order| [0.01, 0.001].map(|part| nodes_for(order, part))),
            [[13, 41], [23, 71], [26, 82]]
        );
    }
}
