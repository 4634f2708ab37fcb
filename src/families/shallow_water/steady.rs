//! Flows in balance that are steady if they are computed exactly.
//!
//! Where the surface H varies along one direction alone, velocities in balance V = c₀²/f₀ (-∂H/∂y, ∂H/∂x) follow its level lines: nothing
//! carries the depth away, no particle accelerates along its way, and the slope of the surface holds the balance with the rotation.

use super::surface::Surface;
use crate::document::{FieldQuantity, ParticleGroup, SurfaceFeature, Velocities};
use crate::families::{Checked, ShallowWater};

/// A field on the nodes, which keeps the values of its start: the first index is that of x, as in the arrays of runs. None where the
/// flow is not steady, or not known to be.
pub(super) fn field(water: &ShallowWater, scene: &Checked, quantity: FieldQuantity) -> Option<Vec<f64>> {
    let model = scene.model();
    let lengths = [model.units.lengths[0], model.units.lengths[1]];
    let in_balance = |group: &ParticleGroup| group.tracer || group.velocities == Velocities::Geostrophic;
    let is_steady = water.bath.is_none()
        && water.rotation != 0.0
        && scene.particles.iter().all(in_balance)
        && vary_along_one_direction(&water.surface, lengths);
    if !is_steady {
        return None;
    }
    let surface = water.surface(lengths);
    let factor = water.wave_speed * water.wave_speed / water.rotation;
    let value = |point: [f64; 2]| {
        let depth = surface.smoothed(point);
        let vorticity = factor * laplacian(&surface, point);
        let [slope_x, slope_y] = surface.slope(point);
        match quantity {
            FieldQuantity::Depth => depth,
            FieldQuantity::Speed => factor.abs() * slope_x.hypot(slope_y),
            FieldQuantity::VelocityX => -factor * slope_y,
            FieldQuantity::VelocityY => factor * slope_x,
            FieldQuantity::Vorticity => vorticity,
            FieldQuantity::PotentialVorticity => (vorticity + water.rotation) / depth,
        }
    };
    let node = |axis: usize, index: u32| f64::from(index) * lengths[axis] / f64::from(water.mesh[axis]);
    let [columns, rows] = water.mesh;
    let places = (0..columns).flat_map(|k| (0..rows).map(move |l| [k, l]));
    Some(places.map(|[k, l]| value([node(0, k), node(1, l)])).collect())
}

/// ∇²H: what a length of 1 takes from H to the depth that smooths to it.
fn laplacian(surface: &Surface<'_>, point: [f64; 2]) -> f64 {
    surface.smoothed(point) - surface.unsmoothed(point, 1.0, 1)
}

/// Whether all features vary along the same direction, and any of them varies.
fn vary_along_one_direction(features: &[SurfaceFeature], lengths: [f64; 2]) -> bool {
    let direction = |feature: &SurfaceFeature| match *feature {
        SurfaceFeature::Wave { periods, .. } => {
            Some([f64::from(periods[0]) / lengths[0], f64::from(periods[1]) / lengths[1]])
        }
        SurfaceFeature::Front { meander: 0.0, .. } => Some([0.0, 1.0 / lengths[1]]),
        SurfaceFeature::Front { .. } | SurfaceFeature::Bump { .. } => None,
    };
    let amplitude = |feature: &SurfaceFeature| match *feature {
        SurfaceFeature::Wave { amplitude, periods } if periods != [0, 0] => amplitude,
        SurfaceFeature::Wave { .. } => 0.0,
        SurfaceFeature::Front { amplitude, .. } | SurfaceFeature::Bump { amplitude, .. } => amplitude,
    };
    let varying: Option<Vec<[f64; 2]>> =
        features.iter().filter(|feature| amplitude(feature) != 0.0).map(direction).collect();
    let Some([first, others @ ..]) = varying.as_deref() else { return false };
    let parallel = |other: &[f64; 2]| {
        let across = first[0] * other[1] - first[1] * other[0];
        across.abs() <= 1e-12 * first[0].hypot(first[1]) * other[0].hypot(other[1])
    };
    others.iter().all(parallel)
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use crate::scene;
    use std::f64::consts::TAU;

    fn depth(surface: &str, further: &[&str]) -> Option<Vec<f64>> {
        let changes = [&format!("interactions.0.surface={surface}")[..], "interactions.0.mesh=[8,16]"];
        let small = ["particles.0.count=1024", "interactions.0.smoothing.length=0.8"];
        let all = changes.iter().chain(&small).chain(further).map(|change| (*change).to_owned());
        let scene = scene::load("shallow-water", &all.collect::<Vec<_>>()).unwrap();
        field(scene.model().shallow_water().unwrap(), &scene, FieldQuantity::Depth)
    }

    #[test]
    fn flows_along_one_direction_are_steady_and_others_are_not() {
        let wave = |periods: &str| format!(r#"{{"type":"wave","periods":{periods},"amplitude":0.01}}"#);
        let (x, oblique, twice) = (wave("[1,0]"), wave("[1,2]"), wave("[2,4]"));
        let front = r#"{"type":"front","amplitude":0.01,"width":0.5}"#;
        let bump = r#"{"type":"bump","center":[1,1],"radius":0.5,"amplitude":0.01}"#;
        for (features, steady) in [
            (format!("[{x}]"), true),
            (format!("[{oblique},{twice}]"), true),
            (format!("[{front}]"), true),
            (format!("[{},{front}]", wave("[0,3]")), true),
            (format!("[{x},{oblique}]"), false),
            (format!("[{x},{front}]"), false),
            (format!("[{bump}]"), false),
            ("[]".to_owned(), false),
            (r#"[{"type":"front","amplitude":0.01,"width":0.5,"meander":0.1}]"#.to_owned(), false),
        ] {
            assert_eq!(depth(&features, &[]).is_some(), steady, "{features}");
        }
        let at_rest = r#"particles.0.velocities={"type":"rest"}"#;
        assert_eq!(depth(&format!("[{x}]"), &[at_rest]), None);
        let noisy = [r#"interactions.0.bath={"type":"white"}"#, "temperature=0.001"];
        assert_eq!(depth(&format!("[{x}]"), &noisy), None);
    }

    #[test]
    fn a_wave_has_its_known_fields() {
        let scene = scene::load(
            "shallow-water",
            &[
                "interactions.0.mesh=[8,16]",
                "particles.0.count=1024",
                "interactions.0.smoothing.length=0.8",
                r#"interactions.0.surface=[{"type":"wave","periods":[1,0],"amplitude":0.1}]"#,
            ]
            .map(str::to_owned),
        )
        .unwrap();
        let water = scene.model().shallow_water().unwrap();
        let of = |quantity| field(water, &scene, quantity).unwrap();
        let [depth, speed, vorticity, potential] =
            [FieldQuantity::Depth, FieldQuantity::Speed, FieldQuantity::Vorticity, FieldQuantity::PotentialVorticity]
                .map(of);
        let [along_x, along_y] = [FieldQuantity::VelocityX, FieldQuantity::VelocityY].map(of);
        let factor = water.wave_speed.powi(2) / water.rotation;
        let scale = 0.1 * factor.abs();
        for k in 0..8 {
            let (sine, cosine) = (TAU * f64::from(k) / 8.0).sin_cos();
            // x is the slow index; y changes nothing.
            for l in [0, 5] {
                let node = 16 * k as usize + l;
                assert!((depth[node] - 1.0 - 0.1 * cosine).abs() < 1e-12);
                assert!((speed[node] - scale * sine.abs()).abs() < 1e-8 * scale);
                // V = c₀²/f₀ (-∂H/∂y, ∂H/∂x).
                assert!(along_x[node].abs() < 1e-8 * scale);
                assert!((along_y[node] + 0.1 * factor * sine).abs() < 1e-8 * scale);
                assert!((vorticity[node] + 0.1 * factor * cosine).abs() < 1e-8 * scale);
                let exact = (water.rotation - 0.1 * factor * cosine) / (1.0 + 0.1 * cosine);
                assert!((potential[node] - exact).abs() < 1e-8 * scale);
            }
        }
    }
}
