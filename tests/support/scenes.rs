//! Scenes in a line: one of each kind, with changes.

use mesoscope::scene::{self, Checked, Scene};

/// Splitting with relaxation of the pair velocities in one stage.
pub const SPLITTING: &str = r#"integrator={"type":"splitting","relaxation":"mean-field"}"#;
/// The same in two stages.
pub const STAGED: &str = r#"integrator={"type":"splitting","relaxation":"two-stages"}"#;
/// Groot and Warren's integrator with λ = ½, whose friction sees the momenta themselves.
pub const GROOT_WARREN: &str = r#"integrator={"type":"groot-warren"}"#;
/// The same with predicted momenta.
pub const PREDICTED: &str = r#"integrator={"type":"groot-warren","lambda":0.65}"#;
/// Cotter and Reich's limit scheme.
pub const COTTER_REICH: &str = r#"integrator={"type":"cotter-reich"}"#;
/// Every integrator, each variant that has kernels of its own.
pub const INTEGRATORS: &[&str] = &[SPLITTING, GROOT_WARREN, PREDICTED, COTTER_REICH, STAGED];

/// Every step is reported.
pub const EVERY_STEP: &str = "output.energies.every=1";
/// Two species in the standard fluid, and the force that tells them apart.
pub const MIXTURE: &str =
    r#"particles=[{"species":"A","number_density":2},{"species":"B","number_density":1,"mass":2.5}]"#;
pub const MIXTURE_FORCE: &str = r#"interactions=[{"type":"dpd","repulsion":25,"friction":4.5,"pairs":[{"between":["A","B"],"repulsion":40,"friction":9}]}]"#;

/// Integrators of shallow water.
pub const GYRO: &str = r#"integrator={"type":"gyro"}"#;
pub const ROTATE: &str = r#"integrator={"type":"rotate"}"#;
/// White noise on the mesh of shallow water.
pub const WHITE: &str = r#"interactions.0.bath={"type":"white"}"#;

/// An internal energy for each Voronoi cell.
pub const ENERGY: &str = "interactions.0.energy={}";

/// A scene from its JSON text.
pub fn scene(text: &str) -> Checked {
    changed(text, &[])
}

/// A built-in scene with other values merged in, given as `path=value`.
pub fn built_in(name: &str, changes: &[&str]) -> Checked {
    let changes: Vec<String> = changes.iter().map(|change| (*change).to_owned()).collect();
    scene::load(name, &changes).unwrap_or_else(|error| panic!("{error}"))
}

/// A scene from its JSON text with other values merged in.
pub fn changed(text: &str, changes: &[&str]) -> Checked {
    let changes: Vec<String> = changes.iter().map(|change| (*change).to_owned()).collect();
    scene::parse("test", text, &changes).unwrap_or_else(|error| panic!("{error}"))
}

/// A scene with numbers in it changed, with any time step.
pub fn edited(scene: &Checked, change: impl FnOnce(&mut Scene)) -> Checked {
    let mut scene = scene.clone().into_scene();
    change(&mut scene);
    scene.check_but_step().unwrap_or_else(|error| panic!("{error}"))
}

/// The standard fluid of density 3 with other values merged in, given as `path=value`.
pub fn fluid(changes: &[&str]) -> Checked {
    let text = r#"{
        "title": "test", "space": {"box": [5, 5, 5]}, "time": {"step": 0.04, "steps": 1}, "temperature": 1.0,
        "particles": [{"species": "A", "number_density": 3}],
        "interactions": [{"type": "dpd", "repulsion": 25, "friction": 4.5}]
    }"#;
    changed(text, changes)
}

/// A small scene of shallow water with changes, given as `path=value`.
pub fn water(changes: &[&str]) -> Checked {
    let text = r#"{
        "title": "test", "space": {"box": [6.283185307179586, 6.283185307179586]},
        "time": {"step": 0.02, "steps": 1}, "temperature": 0.0,
        "particles": [{"species": "water", "count": 4096, "placement": {"type": "lattice"},
            "velocities": {"type": "geostrophic"}}],
        "interactions": [{"type": "shallow-water", "mesh": [16, 16], "wave_speed": 6.283185307179586,
            "rotation": 6.283185307179586, "smoothing": {"length": 0.8},
            "surface": [{"type": "wave", "periods": [1, 2], "amplitude": 0.05}]}]
    }"#;
    changed(text, changes)
}

/// Water at rest on a mesh of 16² nodes with the parameters of Cotter and Reich, with other values merged in.
pub fn still_water(changes: &[&str]) -> Checked {
    let text = r#"{
        "title": "test", "space": {"box": [6.283185307179586, 6.283185307179586]}, "time": {"step": 0.01, "steps": 1},
        "temperature": 0, "output": {"energies": {"every": 1}},
        "particles": [{"species": "water", "count": 1024, "placement": {"type": "lattice"},
            "velocities": {"type": "rest"}}],
        "interactions": [{"type": "shallow-water", "mesh": [16, 16], "wave_speed": 6.283185307179586,
            "rotation": 6.283185307179586, "smoothing": {"length": 1.5707963267948966}}]
    }"#;
    changed(text, changes)
}

/// The built-in shear flow, with other values merged in.
pub fn shear_flow(changes: &[&str]) -> Checked {
    built_in("shallow-water", changes)
}

/// Cells of unit mean volume and five molecules each, on a jittered lattice, with changes given as `path=value`.
pub fn cells(count: u32, changes: &[&str]) -> Checked {
    let edge = f64::from(count.max(1)).sqrt();
    let text = format!(
        r#"{{
        "title": "test", "space": {{"box": [{edge}, {edge}]}}, "time": {{"step": 0.02, "steps": 1}}, "temperature": 1.0,
        "particles": [{{"species": "A", "count": {count}, "mass": 5, "placement": {{"type": "lattice", "jitter": 0.25}}}}],
        "interactions": [{{"type": "voronoi"}}], "output": {{"energies": {{"every": 1}}}}
    }}"#
    );
    changed(&text, changes)
}

/// Independent oscillators: particles tied to where they start, with a bath on every coordinate.
pub fn oscillators(changes: &[&str]) -> Checked {
    let text = r#"{
        "title": "test", "space": {"box": [50, 50, 50]}, "time": {"step": 0.1, "steps": 1}, "temperature": 1.5,
        "particles": [{"species": "A", "count": 1000, "mass": 2}],
        "interactions": [{"type": "langevin", "bath": {"type": "memory", "rate": 1, "coupling": 20}},
            {"type": "tether", "stiffness": 10}],
        "output": {"energies": {"every": 1000000}}
    }"#;
    changed(text, changes)
}
