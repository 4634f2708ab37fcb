//! Answers to arguments that are right for another command or another program.

use std::path::Path;

use mesoscope::output::files;
use mesoscope::printable;
use mesoscope::scene::builtin;
use mesoscope::study::Kind;

use super::Failure;

/// Directories with a run or a study that a message names.
const NAMED: usize = 5;

/// Refuses the place of a run or a study that is no directory, with those that are at hand.
pub fn check_directory(directory: &Path) -> Result<(), Failure> {
    if directory.is_dir() {
        return Ok(());
    }
    let shown = printable::path(directory);
    let is = if directory.exists() { "is a file, not the directory of a run" } else { "is no directory" };
    let above = directory.parent().filter(|above| !above.as_os_str().is_empty()).unwrap_or(Path::new("."));
    let at_hand = results_in(above);
    let name = directory.to_str().filter(|name| builtin().iter().any(|scene| scene.name == *name));
    let advice = match (name, at_hand.as_slice()) {
        (Some(name), _) => format!("`mesoscope run {name}` makes one"),
        (None, []) => "give the directory that `mesoscope run` or a study wrote".to_owned(),
        (None, names) => format!("results are in {}", names.join(", ")),
    };
    Err(Failure::input_output(format!("`{shown}` {is}\nhint: {advice}")))
}

/// Directories with results, those that were written to last first.
fn results_in(above: &Path) -> Vec<String> {
    let entries = std::fs::read_dir(above).into_iter().flatten().flatten();
    let results = entries.map(|entry| entry.path()).filter(|path| is_run(path) || Kind::of(path).is_some());
    let mut found: Vec<_> = results.map(|path| (path.metadata().and_then(|data| data.modified()).ok(), path)).collect();
    found.sort();
    let shown = |path: &Path| format!("`{}`", printable::path(path.strip_prefix(".").unwrap_or(path)));
    found.iter().rev().take(NAMED).map(|(_, path)| shown(path)).collect()
}

fn is_run(directory: &Path) -> bool {
    directory.join(files::CHECKPOINT).exists() || directory.join(files::SUMMARY).exists()
}

/// The remedy where a name is neither a file nor a built-in scene.
pub fn of_scene(name: &str) -> String {
    let path = Path::new(name);
    let usual = "`mesoscope scenes` says what each is for";
    if path.is_dir() {
        let shown = printable::path(path);
        return match Kind::of(path).filter(|_| !is_run(path)) {
            Some(kind) => {
                format!("`{shown}` is the directory of a {}: {} {}", kind.noun, kind.resuming(path), kind.resumed)
            }
            None if is_run(path) => {
                format!("`{shown}` is the directory of a run: `mesoscope resume {shown} --steps N` continues it")
            }
            None => format!("`{shown}` is a directory: give a scene file in it"),
        };
    }
    let lower = name.to_lowercase();
    if ["lj", "lennard-jones", "lennardjones", "wca"].iter().any(|model| lower.trim_end_matches(".json") == *model) {
        return format!("there are no hard cores here, particles repel each other softly; {usual}");
    }
    let end = path.extension().and_then(|end| end.to_str());
    let is_script = lower.starts_with("in.") || end.is_some_and(|end| ["lmp", "lammps", "in", "py"].contains(&end));
    if is_script {
        return format!("scripts of other programs are not read: a scene is a JSON file; {usual}");
    }
    usual.to_owned()
}
