//! Bonds beside pairs: one body of tests for the float64 reference and the device.

use mesoscope::plan::Options;

use crate::support::{
    Device, GROOT_WARREN, Implementation, Measured, SPLITTING, equilibrium, fluid, reference_of_particles, start,
};

/// Springs of no length at rest share the energy of heat: d/2 kT each, whatever their particles do beside it, where no repulsion
/// acts. Both integrators err by a share of γ dt: without repulsion `splitting` by some -.5 γ dt, `groot-warren` by .8 γ dt.
#[test]
fn springs_share_the_energy_of_heat() {
    // The smaller box is for the slower reference.
    for (integrator, edge, dimers, device) in
        [(SPLITTING, 5, 187_u32, false), (SPLITTING, 10, 1500, true), (GROOT_WARREN, 10, 1500, true)]
    {
        let scene = fluid(&[
            &format!("space.box=[{edge},{edge},{edge}]"),
            &format!(r#"particles=[{{"species":"A","count":{},"chain":{{"beads":2,"spacing":0.5}}}}]"#, 2 * dimers),
            r#"interactions=[{"type":"dpd","friction":1},
                    {"type":"bonds","potential":{"type":"harmonic","stiffness":4}}]"#,
            integrator,
            "time.step=0.01",
            "output.energies.every=20",
        ]);
        let (model, state) = start(&scene);
        let mut run: Box<dyn Implementation> = if device {
            Box::new(Device::from_state(&scene, &state, Options::default()))
        } else {
            reference_of_particles(model, state)
        };
        run.step(400);
        let series = run.series(20, 400);
        let largest_error = if device { 0.006 } else { 0.014 };
        let what = format!("{} {integrator}", run.name());
        let energies: Vec<f64> = series.iter().map(|row| row.potential_energy / (1.5 * f64::from(dimers))).collect();
        Measured::of(&energies).assert(&format!("{what}: energy of springs"), 1.0, 0.01, largest_error);
        let [kinetic, configurational, _] = equilibrium(&series);
        kinetic.assert(&format!("{what}: kinetic temperature"), 1.0, 0.01, largest_error);
        configurational.assert(&format!("{what}: configurational temperature"), 1.0, 0.01, largest_error);
    }
}
