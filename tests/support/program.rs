//! The program as the tests start it: with arguments, in a directory with a scene, and what it leaves there.

use std::collections::HashSet;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

use mesoscope::output::{Summary, files, read_table};
use mesoscope::table::Table;
use serde_json::Value;
use tempfile::TempDir;

/// Commands that compute or draw, and so can be told which adapter to use.
const WITH_ADAPTER: [&str; 5] = ["run", "resume", "plot", "check", "sweep"];

/// Starts the program and waits for it; on the adapter of `MESOSCOPE_ADAPTER` unless the arguments name one.
pub fn mesoscope(arguments: &[&str]) -> Output {
    command(arguments).output().unwrap()
}

/// The program with its arguments, to be started.
pub fn command(arguments: &[&str]) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_mesoscope"));
    command.args(arguments);
    if let Ok(adapter) = std::env::var("MESOSCOPE_ADAPTER")
        && arguments.first().is_some_and(|first| WITH_ADAPTER.contains(first))
        && !arguments.contains(&"--adapter")
    {
        command.args(["--adapter", &adapter]);
    }
    command
}

pub fn text(bytes: &[u8]) -> &str {
    std::str::from_utf8(bytes).unwrap()
}

/// The program succeeds; returns what it says on standard output.
#[track_caller]
pub fn succeeds(arguments: &[&str]) -> String {
    succeeds_and_tells(arguments).0
}

/// The program succeeds; returns what it says on standard output and standard error.
#[track_caller]
pub fn succeeds_and_tells(arguments: &[&str]) -> (String, String) {
    let output = mesoscope(arguments);
    assert!(output.status.success(), "{arguments:?}: {}", text(&output.stderr));
    (text(&output.stdout).to_owned(), text(&output.stderr).to_owned())
}

/// The program fails with a code and a message that has all these parts.
#[track_caller]
pub fn fails(arguments: &[&str], code: i32, parts: &[&str]) -> String {
    let output = mesoscope(arguments);
    let message = text(&output.stderr);
    assert_eq!(output.status.code(), Some(code), "{arguments:?}: {message}");
    assert!(message.contains("error: ") && !message.contains("panicked"), "{message}");
    for part in parts {
        assert!(message.contains(part), "`{part}` is not in: {message}");
    }
    message.to_owned()
}

/// A directory for a scene and for what its runs leave.
pub struct Place {
    directory: TempDir,
    pub scene: Value,
}

impl Place {
    pub fn of(scene: Value) -> Self {
        Self { directory: tempfile::tempdir().unwrap(), scene }
    }

    /// The scene with another value, or one more.
    pub fn with(mut self, pointer: &str, value: Value) -> Self {
        let (parent, key) = pointer.rsplit_once('/').unwrap();
        self.scene.pointer_mut(parent).unwrap()[key] = value;
        self
    }

    /// The scene with a key less.
    pub fn without(mut self, pointer: &str) -> Self {
        let (parent, key) = pointer.rsplit_once('/').unwrap();
        self.scene.pointer_mut(parent).unwrap().as_object_mut().unwrap().remove(key);
        self
    }

    pub fn path(&self, name: &str) -> PathBuf {
        self.directory.path().join(name)
    }

    /// The path as an argument.
    pub fn argument(&self, name: &str) -> String {
        self.path(name).to_str().unwrap().to_owned()
    }

    /// Writes the scene to a file; returns its path as an argument.
    pub fn scene(&self) -> String {
        fs::write(self.path("scene.json"), self.scene.to_string()).unwrap();
        self.argument("scene.json")
    }

    /// Runs the scene into a directory of this name.
    #[track_caller]
    pub fn run(&self, out: &str, further: &[&str]) -> String {
        let (scene, out) = (self.scene(), self.argument(out));
        succeeds(&[&["run", &scene, "--out", &out], further].concat())
    }

    /// What a finished run says of itself.
    #[track_caller]
    pub fn summary(&self, out: &str) -> Summary {
        Summary::load(&self.path(out).join(files::SUMMARY)).unwrap()
    }

    /// A table of a run.
    #[track_caller]
    pub fn table(&self, out: &str, name: &str) -> Table {
        read_table(&self.path(out).join(name)).unwrap()
    }

    /// Runs the scene, of 40 steps, as a `whole`, with other checkpoints and in three parts: the files are the same to the byte, but for what
    /// holds the scene itself or the time that the run took.
    #[track_caller]
    pub fn whole_again_and_in_parts(&self) {
        self.run("whole", &["--quiet"]);
        self.run("again", &["--quiet", "--set", "output.checkpoint.every=7"]);
        self.run("parts", &["--quiet", "--steps", "13"]);
        for steps in ["20", "40"] {
            succeeds(&["resume", &self.argument("parts"), "--steps", steps, "--quiet"]);
        }
        let whole = listing(&self.path("whole"));
        for other in ["again", "parts"] {
            assert_eq!(listing(&self.path(other)), whole);
            for name in whole.iter().filter(|name| *name != files::SUMMARY) {
                if other == "again" && name == files::CHECKPOINT {
                    continue; // It holds the scene, which differs.
                }
                // Of another scene the id is another.
                let read = |run| match other {
                    "again" => contents(&self.path(run), name),
                    _ => bytes(&self.path(run).join(name)),
                };
                assert!(read("whole") == read(other), "{name} of {other} differs: {}", self.scene);
            }
        }
        let [whole, parts] = ["whole", "parts"].map(|run| self.summary(run));
        assert_eq!((whole.means, whole.results), (parts.means, parts.results));
    }

    /// Removes files of the run `out` and lets `plot` write them again: the same bytes, which are returned.
    #[track_caller]
    pub fn draws_again(&self, names: &[&str]) -> Vec<Vec<u8>> {
        let out = self.path("out");
        let before: Vec<Vec<u8>> = names.iter().map(|name| bytes(&out.join(name))).collect();
        for name in names {
            fs::remove_file(out.join(name)).unwrap();
        }
        let said = succeeds(&["plot", &self.argument("out")]);
        for (name, before) in names.iter().zip(&before) {
            assert!(said.contains(name), "`{name}` is not in: {said}");
            assert!(bytes(&out.join(name)) == *before, "{name} changed");
        }
        before
    }
}

/// Names of directories and files, sorted.
pub fn listing(directory: &Path) -> Vec<String> {
    let mut names: Vec<String> =
        fs::read_dir(directory).unwrap().map(|entry| entry.unwrap().file_name().into_string().unwrap()).collect();
    names.sort();
    names
}

#[track_caller]
pub fn bytes(path: &Path) -> Vec<u8> {
    fs::read(path).unwrap_or_else(|error| panic!("{}: {error}", path.display()))
}

/// A file of a run without the id of the run, which follows from the whole scene: what the run has found and drawn.
#[track_caller]
pub fn contents(directory: &Path, name: &str) -> Vec<u8> {
    let mut found = bytes(&directory.join(name));
    let summary = String::from_utf8(bytes(&directory.join(mesoscope::output::files::SUMMARY))).unwrap();
    let id = summary.split_once(r#""run_id": ""#).unwrap().1.split('"').next().unwrap().to_owned();
    let place = |found: &[u8], part: &[u8]| found.windows(part.len()).position(|window| window == part);
    if let Some(at) = place(&found, b"tEXtrun_id") {
        // With its length before and its checksum behind it.
        let length = u32::from_be_bytes(found[at - 4..at].try_into().unwrap()) as usize;
        found.drain(at - 4..at + 4 + length + 4);
    }
    while let Some(at) = place(&found, id.as_bytes()) {
        found[at..at + id.len()].fill(0);
    }
    found
}

pub fn picture(path: &Path) -> image::RgbaImage {
    image::open(path).unwrap_or_else(|error| panic!("{}: {error}", path.display())).to_rgba8()
}

/// Width and height of a picture.
#[track_caller]
pub fn size(path: &Path) -> (u32, u32) {
    picture(path).dimensions()
}

/// Number of colours of a picture: whether it shows anything at all.
#[track_caller]
pub fn colours(path: &Path) -> usize {
    picture(path).pixels().collect::<HashSet<_>>().len()
}

/// All that a run leaves, apart from how long it took.
pub fn results(directory: &Path) -> Vec<(String, Vec<u8>)> {
    let contents = listing(directory).into_iter().map(|name| {
        let mut content = bytes(&directory.join(&name));
        if name == files::SUMMARY {
            let mut summary = Summary::load(&directory.join(name.as_str())).unwrap();
            (summary.wall_seconds, summary.particle_steps_per_second) = (0.0, 0.0);
            content = serde_json::to_vec(&summary).unwrap();
        }
        (name, content)
    });
    contents.collect()
}

/// Both directories have the same files, to the byte but for the time that the runs took.
#[track_caller]
pub fn assert_same(found: &Path, expected: &Path) {
    let [found, expected] = [found, expected].map(results);
    for ((name, content), (expected_name, expected)) in found.iter().zip(&expected) {
        assert_eq!(name, expected_name);
        assert!(
            content == expected,
            "{name} differs: {}",
            String::from_utf8_lossy(&content[..content.len().min(4000)])
        );
    }
    assert_eq!(found.len(), expected.len());
}
