//! The arguments that name a scene and change it.

use mesoscope::scene::{self, Scene, SceneError};

/// Which scene, and what to change in it.
#[derive(Debug, clap::Args)]
pub struct SceneArguments {
    /// A scene file, or the name of a built-in scene (see `mesoscope scenes`)
    pub scene: String,

    /// Change one value of the scene; may be repeated. The path is as in messages: `time.step=0.02`,
    /// `particles.0.count=1000`, `integrator.type=groot-warren`. The value is JSON, or else text
    #[arg(long, value_name = "PATH=VALUE")]
    pub set: Vec<String>,

    /// Number of steps; short for `--set time.steps=N`
    #[arg(long, value_name = "N")]
    pub steps: Option<u64>,
}

impl SceneArguments {
    /// The scene with all changes applied, checked.
    pub fn load(&self) -> Result<Scene, SceneError> {
        let mut overrides = self.set.clone();
        overrides.extend(self.steps.map(|steps| format!("time.steps={steps}")));
        scene::load(&self.scene, &overrides)
    }
}
