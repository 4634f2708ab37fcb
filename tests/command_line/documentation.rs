//! README, the pages of `docs` and their neighbours: examples are correct and run as they stand there, links lead somewhere.
//!
//! `CONTRIBUTING.md`, "Documentation", says what each kind of fence stands for.

use std::collections::HashSet;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

use mesoscope::plan::{Hardware, Options};
use mesoscope::run::plan;
use mesoscope::scene::{self, WrittenScene};
use mesoscope::sweep::Sweep;
use serde_json::Value;

const README: &str = "README.md";
const SUMMARY: &str = "docs/SUMMARY.md";
/// Lines of README, and of a page.
const LONGEST_README: usize = 150;
const LONGEST_PAGE: usize = 250;

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

/// A document: its path from the root, with slashes, and its text.
struct Document {
    path: String,
    text: String,
}

impl Document {
    fn read(path: &str) -> Self {
        let text = std::fs::read_to_string(root().join(path)).expect(path);
        Self { path: path.to_owned(), text }
    }

    /// All fenced blocks.
    fn blocks(&self) -> Vec<Block> {
        let mut blocks: Vec<Block> = Vec::new();
        let mut open = false;
        for (index, line) in self.text.lines().enumerate() {
            match line.strip_prefix("```") {
                Some(_) if open => open = false,
                Some(kind) => {
                    let place = format!("{}:{}", self.path, index + 1);
                    blocks.push(Block { place, kind: kind.to_owned(), text: String::new() });
                    open = true;
                }
                None if open => {
                    let block = blocks.last_mut().unwrap();
                    block.text.push_str(line);
                    block.text.push('\n');
                }
                None => {}
            }
        }
        assert!(!open, "{}: a fence is not closed", self.path);
        blocks
    }

    /// The lines outside of fences, with their numbers.
    fn prose(&self) -> impl Iterator<Item = (usize, &str)> {
        let mut open = false;
        self.text.lines().enumerate().filter_map(move |(index, line)| {
            let fence = line.starts_with("```");
            open ^= fence;
            (!open && !fence).then_some((index + 1, line))
        })
    }

    /// Targets of links and pictures, with the numbers of their lines.
    fn links(&self) -> Vec<(usize, String)> {
        let targets = |line: &str| -> Vec<String> {
            line.split("](").skip(1).map(|rest| rest.split(')').next().unwrap().to_owned()).collect()
        };
        self.prose().flat_map(|(number, line)| targets(line).into_iter().map(move |link| (number, link))).collect()
    }

    /// The anchors that forges make of its headings.
    fn anchors(&self) -> HashSet<String> {
        let mut anchors: HashSet<String> = HashSet::new();
        for (_, line) in self.prose() {
            let level = line.chars().take_while(|letter| *letter == '#').count();
            if !(1..=6).contains(&level) || !line[level..].starts_with(' ') {
                continue;
            }
            let kept = |letter: &char| letter.is_alphanumeric() || [' ', '-', '_'].contains(letter);
            let heading: String = line[level..].trim().to_lowercase().chars().filter(kept).collect();
            let slug = heading.replace(' ', "-");
            let numbered = (1..).map(|number| format!("{slug}-{number}"));
            let anchor =
                std::iter::once(slug.clone()).chain(numbered).find(|anchor| !anchors.contains(anchor)).unwrap();
            anchors.insert(anchor);
        }
        anchors
    }
}

/// A fenced block: where it begins, what stands behind the fence, what is in it.
struct Block {
    place: String,
    kind: String,
    text: String,
}

impl Block {
    /// The commands of a shell, with lines that a backslash continues joined and comments left out.
    fn commands(&self) -> Vec<Vec<String>> {
        let text = self.text.replace("\\\n", " ");
        text.lines().map(words).filter(|words| !words.is_empty()).collect()
    }
}

/// The words of a command as a shell reads them; single quotes only.
fn words(command: &str) -> Vec<String> {
    let (mut words, mut quoted) = (vec![String::new()], false);
    for letter in command.chars() {
        match letter {
            '\'' => quoted = !quoted,
            '#' if !quoted && words.last().unwrap().is_empty() => break,
            ' ' if !quoted => words.push(String::new()),
            _ => words.last_mut().unwrap().push(letter),
        }
    }
    assert!(!quoted, "a quote is not closed: {command}");
    words.retain(|word| !word.is_empty());
    words
}

/// All files of a folder that end like one of these, by their paths from the root.
fn files(folder: &Path, extensions: &[&str]) -> Vec<String> {
    let mut found = Vec::new();
    let mut folders = vec![folder.to_owned()];
    while let Some(folder) = folders.pop() {
        for entry in std::fs::read_dir(folder).unwrap() {
            let path = entry.unwrap().path();
            if path.is_dir() {
                folders.push(path);
            } else if path.extension().is_some_and(|extension| extensions.contains(&extension.to_str().unwrap())) {
                let parts: Vec<_> =
                    path.strip_prefix(root()).unwrap().iter().map(|part| part.to_str().unwrap()).collect();
                found.push(parts.join("/"));
            }
        }
    }
    found.sort();
    found
}

/// What stands next to README and is in the book too.
const NEXT_TO_README: [&str; 3] = ["ARCHITECTURE.md", "CONTRIBUTING.md", "CHANGELOG.md"];

/// The pages of `docs` in the order of reading.
fn pages() -> Vec<String> {
    let links = Document::read(SUMMARY).links().into_iter().map(|(_, link)| link);
    links.filter(|link| !link.starts_with("../")).map(|link| format!("docs/{link}")).collect()
}

/// README, then the pages in the order of reading, then what stands next to README.
fn documents() -> Vec<Document> {
    let others = NEXT_TO_README[..2].iter().map(|path| (*path).to_owned());
    let paths = [README.to_owned()].into_iter().chain(pages()).chain(others);
    paths.map(|path| Document::read(&path)).collect()
}

/// The blocks of a kind in all documents.
fn blocks(kind: &str) -> Vec<Block> {
    let all = documents().into_iter().flat_map(|document| document.blocks());
    all.filter(|block| block.kind.split([' ', ',']).next() == Some(kind)).collect()
}

fn mesoscope(directory: &Path, arguments: &[&str]) -> Output {
    let program = env!("CARGO_BIN_EXE_mesoscope");
    let output = Command::new(program).current_dir(directory).args(arguments).output().expect("the program starts");
    let errors = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "mesoscope {arguments:?}: {errors}");
    output
}

#[test]
fn every_page_is_in_the_book_once_and_none_is_too_long() {
    let mut listed = pages();
    listed.sort();
    let mut found = files(&root().join("docs"), &["md"]);
    found.retain(|path| path != SUMMARY);
    assert_eq!(listed, found);
    for document in documents() {
        let most = if document.path == README { LONGEST_README } else { LONGEST_PAGE };
        let lines = document.text.lines().count();
        assert!(lines <= most, "{}: {lines} lines, of at most {most}", document.path);
    }
}

#[test]
fn every_fence_says_what_becomes_of_it() {
    let known = ["console", "sh", "json", "rust", "rust,no_run", "python", "text"];
    for document in documents() {
        for Block { place, kind, .. } in document.blocks() {
            let fragment = kind.strip_prefix("json over ").is_some_and(|name| WrittenScene::read(name).is_ok());
            assert!(fragment || known.contains(&kind.as_str()), "{place}: `{kind}` is none of {known:?}");
        }
    }
}

#[test]
fn links_lead_to_files_and_headings() {
    let mut complaints = Vec::new();
    let book = Document::read(".ci/book.sh").text;
    let read = [README].into_iter().chain(NEXT_TO_README).chain(["shaders/README.md"]).map(str::to_owned);
    for path in read.chain(files(&root().join("docs"), &["md"])) {
        let document = Document::read(&path);
        for (line, link) in document.links() {
            if link.contains("://") {
                continue;
            }
            let (target, anchor) = link.split_once('#').unwrap_or((&link, ""));
            let folder = Path::new(&path).parent().unwrap();
            let file = if target.is_empty() { PathBuf::from(&path) } else { folder.join(target) };
            let exists = root().join(&file).exists();
            let is_there =
                anchor.is_empty() || exists && Document::read(file.to_str().unwrap()).anchors().contains(anchor);
            // The script names the files next to README and the folders that it gathers.
            let mut parts = Vec::new();
            for part in file.iter().map(|part| part.to_str().unwrap()) {
                if part == ".." {
                    parts.pop();
                } else {
                    parts.push(part);
                }
            }
            let gathered = book.contains(parts[0]);
            if !exists || !is_there || !gathered {
                complaints.push(format!("{path}:{line}: {link}"));
            }
        }
    }
    assert!(complaints.is_empty(), "links lead nowhere:\n{}", complaints.join("\n"));
}

/// Files of tests that documents and comments name, as they move.
#[test]
fn files_of_tests_that_are_named_are_there() {
    let folders = ["docs", "src", "shaders", "tests"].map(|folder| files(&root().join(folder), &["md", "rs", "wgsl"]));
    let read = ["README.md", "ARCHITECTURE.md", "CONTRIBUTING.md"].map(str::to_owned);
    let (mut named, mut complaints) = (0, Vec::new());
    for file in folders.into_iter().flatten().chain(read) {
        for rest in Document::read(&file).text.split(concat!("`", "tests/")).skip(1) {
            let path = format!("tests/{}", rest.split('`').next().unwrap());
            named += 1;
            if !root().join(&path).exists() {
                complaints.push(format!("{file}: {path}"));
            }
        }
    }
    assert!(named > 10, "{named}");
    assert!(complaints.is_empty(), "no such files:\n{}", complaints.join("\n"));
}

#[test]
fn programs_are_compiled_and_their_scenes_are_correct() {
    let library = Document::read("src/lib.rs").text;
    for document in documents() {
        let programs: Vec<Block> =
            document.blocks().into_iter().filter(|block| block.kind.starts_with("rust")).collect();
        let compiled = library.contains(&format!("include_str!(\"../{}\")", document.path));
        assert_eq!(compiled, !programs.is_empty(), "{}: src/lib.rs compiles what has programs", document.path);
        for Block { place, text, .. } in programs {
            for load in text.split("scene::load(").skip(1) {
                let call = load.split_once(")?").unwrap().0;
                let mut texts = call.split('"').skip(1).step_by(2);
                let (name, changes) = (texts.next().unwrap(), texts.map(str::to_owned).collect::<Vec<_>>());
                if let Err(error) = scene::load(name, &changes) {
                    panic!("{place}: scene::load({call}): {error}");
                }
            }
        }
    }
    assert!(!blocks("rust").is_empty());
}

#[test]
fn commands_run() {
    // In one directory and in the order of reading, as somebody would try them; one that is named twice runs once.
    let directory = tempfile::tempdir().unwrap();
    let mut seen = HashSet::new();
    let all = blocks("console").into_iter().flat_map(|block| block.commands());
    let commands: Vec<Vec<String>> = all.filter(|command| seen.insert(command.clone())).collect();
    assert!(commands.len() >= 12, "found only {commands:?}");
    // `adapter_check` runs this one.
    let long = ["adapters", "--check"];
    for command in commands.iter().filter(|command| command[1..] != long) {
        assert_eq!(command[0], "mesoscope");
        let mut arguments: Vec<&str> = command[1..].iter().map(String::as_str).collect();
        // Fewer steps of fewer particles, or this would take minutes.
        if arguments.first() == Some(&"run") {
            arguments.extend(["--steps", "40"]);
            if arguments[1].starts_with("dpd") {
                arguments.extend(["--set", "space.box=[6,6,6]", "--set", "time.equilibration=20"]);
                arguments.extend(["--set", "output.radial_distribution.every=10"]);
            }
            if arguments[1].starts_with("edpd") {
                arguments.extend(["--set", "time.equilibration=0", "--set", "output.diffusion.window=4"]);
            }
        }
        let steps = arguments.iter().position(|argument| *argument == "--steps");
        if arguments.first() == Some(&"stability") {
            arguments.extend(["--bisections", "0", "--steps", "240"]);
        }
        if arguments.first() == Some(&"sweep") {
            arguments[steps.expect("steps of a variant") + 1] = "40";
        }
        if arguments.first() == Some(&"resume") {
            let steps = steps.expect("steps to go on to") + 1;
            let shipped: u64 = scene::load("dpd-fluid", &[]).unwrap().time.steps;
            assert!(arguments[steps].parse::<u64>().unwrap() > shipped, "nothing would be left to do");
            arguments[steps] = "60";
        }
        mesoscope(directory.path(), &arguments);
    }
    for file in [
        "dpd-fluid/energies.png",
        "dpd-fluid/run.json",
        "fine/energies.csv",
        "shallow-water/depth.npy",
        "dpd-fluid-sweep/sweep.csv",
    ] {
        assert!(directory.path().join(file).exists(), "{file} is missing");
    }
}

/// What follows each use of an option.
fn values(command: &[String], option: &str) -> Vec<String> {
    command.windows(2).filter(|pair| pair[0] == option).map(|pair| pair[1].clone()).collect()
}

#[test]
fn long_commands_are_correct() {
    let makefile = Document::read("Makefile").text;
    for block in blocks("sh") {
        for command in block.commands() {
            let place = format!("{}: {}", block.place, command.join(" "));
            match command[0].as_str() {
                "mesoscope" => check_command(&command[1..], &place),
                "make" => assert!(makefile.contains(&format!("\n{}:", command[1])), "{place}: no such target"),
                "cargo" => {
                    for test in values(&command, "--test") {
                        let sources = ["/main.rs", ".rs"].map(|end| root().join(format!("tests/{test}{end}")));
                        assert!(sources.iter().any(|source| source.exists()), "{place}: no such test");
                    }
                }
                other => panic!("{place}: nobody knows whether `{other}` works"),
            }
        }
    }
}

/// The options exist, and what is to be simulated is correct.
fn check_command(command: &[String], place: &str) {
    let help = mesoscope(root(), &[command[0].as_str(), "--help"]);
    let help = String::from_utf8_lossy(&help.stdout);
    for option in command.iter().filter(|word| word.starts_with("--")) {
        assert!(help.contains(option.as_str()), "{place}: `{option}` is unknown");
    }
    let set = values(command, "--set");
    let steps = values(command, "--steps").first().map(|steps| steps.parse().unwrap());
    match command[0].as_str() {
        "run" | "check" => {
            let scene = WrittenScene::read(&command[1]).unwrap().with(&set).for_steps(steps);
            scene.check().unwrap_or_else(|error| panic!("{place}: {error}"));
        }
        "sweep" => {
            let (vary, also) = (values(command, "--vary"), values(command, "--also"));
            Sweep::load(&command[1], &set, steps, &vary, &also).unwrap_or_else(|error| panic!("{place}: {error}"));
        }
        _ => {}
    }
}

#[test]
fn scenes_and_their_parts_are_correct() {
    let blocks = blocks("json");
    assert!(blocks.len() >= 8);
    for Block { place, kind, text } in blocks {
        let text = match kind.strip_prefix("json over ") {
            None => text,
            Some(name) => {
                let mut scene: Value = serde_json::from_str(&WrittenScene::read(name).unwrap().text).unwrap();
                let part: Value = serde_json::from_str(&text).unwrap_or_else(|error| panic!("{place}: {error}"));
                for (key, value) in part.as_object().unwrap() {
                    scene[key] = value.clone();
                }
                scene.to_string()
            }
        };
        let scene = scene::parse(&place, &text, &[]).unwrap_or_else(|error| panic!("{error}"));
        let _ = plan(&scene, Hardware::default(), Options::default());
    }
}

#[test]
fn the_scene_of_the_readme_runs() {
    let readme = Document::read(README).blocks();
    let scenes: Vec<&Block> = readme.iter().filter(|block| block.kind == "json").collect();
    assert_eq!(scenes.len(), 1);
    let directory = tempfile::tempdir().unwrap();
    std::fs::write(directory.path().join("mine.json"), &scenes[0].text).unwrap();
    mesoscope(directory.path(), &["run", "mine.json", "--quiet"]);
    assert!(directory.path().join("mine/energies.png").exists());
}

#[test]
fn the_pictures_of_the_readme_are_small() {
    let links = Document::read(README).links();
    let pictures: Vec<&str> =
        links.iter().map(|(_, link)| link.as_str()).filter(|link| link.starts_with("assets/")).collect();
    assert!(pictures.len() >= 4);
    let bytes: u64 = pictures.iter().map(|path| std::fs::metadata(root().join(path)).expect(path).len()).sum();
    assert!(bytes < 2_000_000, "the gallery has {bytes} bytes");
}
