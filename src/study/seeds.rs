//! Seeds of independent runs of one scene.

use super::error::StudyError;

/// The key of a scene that makes samples of its runs.
pub(crate) const SEED: &str = "seed";

/// The most independent runs of one scene: of more, the error of their mean is known to a few per cent anyway.
pub const MOST_SEEDS: u32 = 1024;

/// The most runs of a study, all seeds counted.
pub(super) const MOST_RUNS: usize = 4096;

/// Refuses numbers of seeds that no study of so many scenes has, and a key `seed` that is varied beside them.
pub(crate) fn check_seeds<'k>(
    seeds: u32,
    scenes: usize,
    keys: impl IntoIterator<Item = &'k str>,
) -> Result<(), StudyError> {
    if !(1..=MOST_SEEDS).contains(&seeds) {
        let accepted = format!("accepted: 1 to {MOST_SEEDS}, the independent runs of each scene");
        return Err(StudyError::mistake(format!("{seeds} seeds; {accepted}")));
    }
    if seeds > 1 && keys.into_iter().any(|key| key == SEED) {
        return Err(StudyError::mistake(format!("`{SEED}` cannot be varied where each scene runs with {seeds} seeds")));
    }
    if scenes.saturating_mul(seeds as usize) > MOST_RUNS {
        let mistake = format!("{scenes} scenes with {seeds} seeds each; accepted: at most {MOST_RUNS} runs in all");
        return Err(StudyError::mistake(mistake));
    }
    Ok(())
}

/// The seed that is `further` places after another one.
pub(crate) fn following(seed: u64, further: u32) -> u64 {
    seed.wrapping_add(u64::from(further))
}

/// The override that gives a scene the seed that is `further` places after its own; none for its own.
pub(crate) fn further_seed(own: u64, further: u32) -> Option<String> {
    (further > 0).then(|| format!("{SEED}={}", following(own, further)))
}
