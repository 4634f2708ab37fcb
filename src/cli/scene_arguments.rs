//! The arguments that name a scene and change it.

use mesoscope::families::Checked;
use mesoscope::scene::{Fits, SceneError, WrittenScene};

use super::heading;

/// Which scene, and what to change in it.
#[derive(Debug, clap::Args)]
pub struct SceneArguments {
    /// A scene file, or the name of a built-in scene (see `mesoscope scenes`)
    pub scene: String,

    /// Change one value of the scene; may be repeated. The path is as in messages: `time.step=0.02`,
    /// `particles.0.count=1000`, `integrator.type=groot-warren`. The value is JSON, or else text
    #[arg(long, help_heading = heading::SCENE, value_name = "PATH=VALUE")]
    pub set: Vec<String>,

    /// Number of steps. Where that is fewer than the scene has, equilibration and the windows of correlations that do
    /// not fit are shortened, and it is said which; `--set time.steps=N` leaves them as they are
    #[arg(long, help_heading = heading::RUNNING, value_name = "N", value_parser = whole_number, allow_negative_numbers = true)]
    pub steps: Option<u64>,

    /// Seed of the random numbers; short for `--set seed=N`
    #[arg(long, help_heading = heading::SCENE, value_name = "N")]
    pub seed: Option<u64>,
}

impl SceneArguments {
    /// The scene as further commands take it, with its changes.
    pub fn as_argument(&self) -> String {
        let seed = self.seed.map(|seed| format!("seed={seed}"));
        let changes = self.set.iter().cloned().chain(seed);
        let changes: Vec<String> = changes.map(|change| format!(" --set {}", quoted(&change))).collect();
        quoted(&self.scene) + &changes.concat()
    }

    /// The scene with all changes applied, checked.
    /// `fits` decides of many particles before they are read or placed.
    pub fn load(&self, fits: &Fits<'_>) -> Result<Checked, SceneError> {
        let mut overrides = self.set.clone();
        overrides.extend(self.seed.map(|seed| format!("seed={seed}")));
        WrittenScene::read(&self.scene)?.with(&overrides).for_steps(self.steps).check_fitting(fits)
    }
}

/// A text as one word of a POSIX shell.
fn quoted(text: &str) -> String {
    let is_plain = |symbol: char| symbol.is_alphanumeric() || "-_./=,:+@%".contains(symbol);
    if !text.is_empty() && text.chars().all(is_plain) {
        text.to_owned()
    } else {
        format!("'{}'", text.replace('\'', r"'\''"))
    }
}

/// A number of steps, as scenes may write it: `1000` or `1e3`.
pub fn whole_number(text: &str) -> Result<u64, String> {
    let written = text.parse::<f64>().ok().filter(|number| number.fract() == 0.0 && (0.0..9e15).contains(number));
    text.parse()
        .ok()
        .or(written.map(|number| number as u64))
        .ok_or_else(|| "accepted: a whole number, zero or positive".to_owned())
}
