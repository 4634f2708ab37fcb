//! What `Cargo.toml` says of the compiler is what its dependencies ask for.

use std::collections::{BTreeMap, BTreeSet};
use std::process::Command;

use serde_json::Value;

/// The numbers of a version, as they compare: `1.95` is `1.95.0`.
fn numbers(version: &str) -> [u64; 3] {
    let mut parts = version.split('.').map(|part| part.parse().unwrap());
    std::array::from_fn(|_| parts.next().unwrap_or(0))
}

#[test]
fn the_compiler_that_is_asked_for_builds_every_dependency() {
    let triple = Command::new(std::env::var("RUSTC").unwrap_or_else(|_| "rustc".to_owned())).arg("-vV").output();
    let triple = String::from_utf8(triple.unwrap().stdout).unwrap();
    let host = triple.lines().find_map(|line| line.strip_prefix("host: ")).unwrap();
    // Dependencies of other platforms may not have been downloaded.
    let output = Command::new(env!("CARGO"))
        .args(["metadata", "--locked", "--offline", "--format-version", "1", "--filter-platform", host])
        .current_dir(env!("CARGO_MANIFEST_DIR"))
        .output()
        .unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let metadata: Value = serde_json::from_slice(&output.stdout).unwrap();
    let used: Vec<&Value> = metadata["resolve"]["nodes"].as_array().unwrap().iter().map(|node| &node["id"]).collect();
    let packages = metadata["packages"].as_array().unwrap();
    let asking = packages.iter().filter(|package| used.contains(&&package["id"]));
    let asking = asking.filter(|package| package["name"] != env!("CARGO_PKG_NAME"));
    let most = asking
        .filter_map(|package| Some((numbers(package["rust_version"].as_str()?), package["name"].as_str()?)))
        .max()
        .unwrap();
    let ours = numbers(env!("CARGO_PKG_RUST_VERSION"));
    assert!(ours >= most.0, "rust-version in Cargo.toml is {ours:?}, and {} needs {:?}", most.1, most.0);
}

/// All packages of the workspace can be made, and installed from: `make validate` compiles them too.
#[test]
fn the_workspace_can_be_packaged() {
    let place = tempfile::tempdir().unwrap();
    let output = Command::new(env!("CARGO"))
        .args(["package", "--workspace", "--no-verify", "--allow-dirty", "--offline", "--locked", "--target-dir"])
        .arg(place.path())
        .current_dir(env!("CARGO_MANIFEST_DIR"))
        .output()
        .unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let version = env!("CARGO_PKG_VERSION");
    for name in ["mesoscope", "mesoscope-python", "mesoscope-shader-modules"] {
        assert!(place.path().join(format!("package/{name}-{version}.crate")).exists(), "{name}");
    }
}

/// A package that is published has what the program is compiled with, and the licences.
#[test]
fn the_package_has_what_it_needs() {
    let output = Command::new(env!("CARGO"))
        .args(["package", "--list", "--allow-dirty", "--offline", "--locked", "--package", env!("CARGO_PKG_NAME")])
        .current_dir(env!("CARGO_MANIFEST_DIR"))
        .output()
        .unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let listed = String::from_utf8(output.stdout).unwrap().replace('\\', "/");
    let files: Vec<&str> = listed.lines().collect();
    let scenes = mesoscope::scene::builtin().iter().map(|scene| format!("assets/scenes/{}.json", scene.name));
    let others = [
        "LICENSE-APACHE",
        "LICENSE-MIT",
        "assets/fonts/OFL.txt",
        "assets/report/page.html",
        "build/main.rs",
        "shaders/README.md",
    ];
    for file in scenes.chain(others.map(str::to_owned)) {
        assert!(files.contains(&file.as_str()), "the package lacks {file}");
    }
}

/// Dependencies of the Python package have the features that they have for the tests, so that they are compiled once for both.
#[test]
fn the_wheel_is_built_with_what_the_tests_are() {
    let features = |selection: &[&str]| {
        let output = Command::new(env!("CARGO"))
            .args(["tree", "--locked", "--offline", "--format", "{p}|{f}", "--prefix", "none", "--no-dedupe"])
            .args(selection)
            .current_dir(env!("CARGO_MANIFEST_DIR"))
            .output()
            .unwrap();
        assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
        let mut found = BTreeMap::<String, BTreeSet<String>>::new();
        // Members of the workspace are apart by blank lines.
        let text = String::from_utf8(output.stdout).unwrap();
        for (package, features) in text.lines().filter_map(|line| line.split_once('|')) {
            // With MPI the library itself is another one.
            if !package.starts_with("mesoscope v") {
                found.entry(package.to_owned()).or_default().insert(features.to_owned());
            }
        }
        found
    };
    let mut of_tests = vec!["--edges", "normal,build,dev", "--workspace"];
    if cfg!(feature = "mpi") {
        of_tests.extend(["--features", "mesoscope/mpi"]);
    }
    let tests = features(&of_tests);
    for (package, found) in features(&["--edges", "normal,build", "--package", "mesoscope-python"]) {
        assert!(
            found.is_subset(&tests[&package]),
            "{package}: {found:?} for the wheel, {:?} for tests",
            tests[&package]
        );
    }
}
