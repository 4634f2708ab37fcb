//! Which top module may use which: only those below it.

use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};

/// The modules of the library, from the bottom up.
const LAYERS: [&str; 29] = [
    "printable",
    "host_memory",
    "numbers",
    "quantity",
    "table",
    "prediction",
    "noise",
    "state",
    "state_file",
    "tessellation",
    "shaders",
    "gpu",
    "document",
    "plan",
    "families",
    "scene",
    "engine",
    "ranks",
    "measure",
    "output",
    "plot",
    "run",
    "self_test",
    "study",
    "sweep",
    "tradeoff",
    "stability",
    "report",
    "calibration",
];

/// Rust files of a directory and those below it.
fn files(directory: &Path, found: &mut Vec<PathBuf>) {
    let mut entries: Vec<PathBuf> =
        fs::read_dir(directory).into_iter().flatten().flatten().map(|entry| entry.path()).collect();
    entries.sort();
    for path in entries {
        if path.is_dir() {
            files(&path, found);
        } else if path.extension().is_some_and(|extension| extension == "rs") {
            found.push(path);
        }
    }
}

/// Top modules that code names, without those of its tests and comments.
fn named(text: &str) -> BTreeSet<&str> {
    let code = text.split("#[cfg(test)]").next().unwrap_or_default();
    let lines = code.lines().filter(|line| !line.trim_start().starts_with("//"));
    let names = lines.flat_map(|line| line.split("crate::").skip(1));
    names.filter_map(|rest| rest.split(|letter: char| !letter.is_ascii_lowercase() && letter != '_').next()).collect()
}

#[test]
fn modules_use_only_those_below_them() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("src");
    let height = |module: &str| LAYERS.iter().position(|layer| *layer == module);
    let mut found = Vec::new();
    files(&root, &mut found);
    let mut upward = BTreeSet::new();
    for path in found {
        let place = path.strip_prefix(&root).unwrap_or(&path).to_string_lossy().replace('\\', "/");
        let module = place.split(['/', '.']).next().unwrap_or_default();
        let Some(own) = height(module) else {
            // The command line is a program of its own.
            assert!(
                ["cli", "main", "lib", "layers", "prelude"].contains(&module),
                "`{module}` belongs into the list of layers"
            );
            continue;
        };
        let text = fs::read_to_string(&path).unwrap_or_default();
        upward.extend(
            named(&text)
                .into_iter()
                .filter(|name| height(name).is_some_and(|other| other > own))
                .map(|name| (place.clone(), name.to_owned())),
        );
    }
    assert!(upward.is_empty(), "arrows that point upward: {upward:#?}");
}

/// Code outside the folders of families and the types of a scene that names one of them by its name: names of scenes, the
/// self-test of every family, and a path that users of the library have. This list may only become shorter.
const NAMING: [&str; 3] = ["measure/mod.rs", "scene/builtin.rs", "self_test/families.rs"];

#[test]
fn families_are_named_in_their_folders_and_the_registry_only() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("src");
    let mut found = Vec::new();
    files(&root, &mut found);
    let mut naming = Vec::new();
    for path in found {
        let place = path.strip_prefix(&root).unwrap_or(&path).to_string_lossy().replace('\\', "/");
        if place.starts_with("document/") || place.starts_with("families/") || place == "layers.rs" {
            continue;
        }
        let text = fs::read_to_string(&path).unwrap_or_default();
        let code = text.split("#[cfg(test)]").next().unwrap_or_default();
        let lines = code.lines().filter(|line| !line.trim_start().starts_with("//"));
        let code = lines.collect::<String>().to_lowercase().replace(['_', '-', ' '], "");
        if code.contains("voronoi") || code.contains("shallowwater") {
            naming.push(place);
        }
    }
    assert_eq!(naming, NAMING);
}
