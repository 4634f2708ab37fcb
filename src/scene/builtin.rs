//! The scenes inside the program.

/// A built-in scene.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub struct Builtin {
    /// The name that [`super::load`] takes.
    pub name: &'static str,
    /// The scene as JSON text.
    pub text: &'static str,
}

/// What `mesoscope tradeoff` found of some of them: its summaries.
pub(crate) const CALIBRATIONS: [&str; 15] = [
    include_str!("../../assets/calibration/binary-mixture.json"),
    include_str!("../../assets/calibration/couette.json"),
    include_str!("../../assets/calibration/diblock-copolymer.json"),
    include_str!("../../assets/calibration/dpd-fluid.json"),
    include_str!("../../assets/calibration/dpd-fluid-2d.json"),
    include_str!("../../assets/calibration/dpd-fluid-two-stages.json"),
    include_str!("../../assets/calibration/drop.json"),
    include_str!("../../assets/calibration/edpd-fluid.json"),
    include_str!("../../assets/calibration/langevin-gas.json"),
    include_str!("../../assets/calibration/poiseuille.json"),
    include_str!("../../assets/calibration/polymer-melt.json"),
    include_str!("../../assets/calibration/shallow-water.json"),
    include_str!("../../assets/calibration/surfactants.json"),
    include_str!("../../assets/calibration/voronoi-dpd.json"),
    include_str!("../../assets/calibration/voronoi-dpd-paper.json"),
];

macro_rules! builtin {
    ($($name:literal),* $(,)?) => {
        &[$(Builtin { name: $name, text: include_str!(concat!("../../assets/scenes/", $name, ".json")) }),*]
    };
}

/// The built-in scenes, the main one first.
///
/// ```
/// use mesoscope::scene;
///
/// assert_eq!(scene::builtin()[0].name, "dpd-fluid");
/// for builtin in scene::builtin() {
///     let scene = scene::load(builtin.name, &[])?;
///     assert!(!scene.description.is_empty(), "{}", builtin.name);
/// }
/// # Ok::<(), scene::SceneError>(())
/// ```
#[must_use]
pub fn builtin() -> &'static [Builtin] {
    builtin![
        "dpd-fluid",
        "dpd-fluid-2d",
        "binary-mixture",
        "ideal-dissipative-gas",
        "coloured-noise",
        "shallow-water",
        "shallow-water-memory",
        "shallow-water-equilibrium",
        "jet-instability",
        "edpd-fluid",
        "langevin-gas",
        "gle-oscillator",
        "polymer-melt",
        "harmonic-chain",
        "voronoi-dpd",
        "voronoi-energy",
        "voronoi-shear",
        "poiseuille",
        "couette",
        "shear",
        "diblock-copolymer",
        "surfactants",
        "drop",
        "salt-water",
        "polyelectrolyte",
        "ionic-surfactants",
        "polarisable-water"
    ]
}
