//! `shaders/README.md`, the index of the library, is made of the files: this test fails when it is stale. With `MESOSCOPE_RECORD=1` it
//! writes it anew.

use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::path::Path;

use mesoscope::shaders::{Declaration, File, Kind, library};

const HEAD: &str = "# The library of shaders

A **page**, `domain/topic.wgsl`, holds one topic whole: kernels beside their functions. A **variant**, `domain/slot/variant`, is one of
several that provide the same functions; the plan of a scene chooses among them (`src/families/*/plan`). It has a file of its own, or lies in the file of
the topic that it belongs to, after a line `// == domain/slot/variant`: all of shear is in `external/shear.wgsl`. A kernel is an entry point and its choices.

The linker follows names from the entry point: to the chosen variant that declares a name, else to the caller's own file, else to the only
page that has it. So a function of a page is the default that a chosen variant replaces, and one name has one meaning everywhere.
`mesoscope check SCENE --shader KERNEL` prints what comes of it. Numbers in capitals are constants that the plan sets.

Arrays are described in one table, [build/arrays.rs](../build/arrays.rs), from which their declarations and both forms of the functions
for what may lie in a buffer or in textures are made: the domain `arrays`, and the slots `particles` and `tidied` of `water`. Such arrays
lie in buffers, unless the plan says otherwise (`src/plan/serial_memory.rs`, and the plans of pairs and of shallow water). A file that
sees an array otherwise than the table says declares what it sees. The butterflies of
Fourier transforms are made by `build/radices.rs`. `plot` and `check` hold whole shaders for pictures and for
`mesoscope adapters --check`.

This page is made by `MESOSCOPE_RECORD=1 cargo test --test shaders index`.
";

/// Variants by slot.
type Slots<'a> = BTreeMap<&'a str, Vec<&'a File>>;

fn index() -> String {
    let shaders = Path::new(env!("CARGO_MANIFEST_DIR")).join("shaders");
    let mut text = HEAD.to_owned();
    let mut domains: BTreeMap<&str, (Vec<&File>, Slots<'_>)> = BTreeMap::new();
    for file in library().unwrap().files() {
        let domain = domains.entry(file.path.split('/').next().unwrap_or_default()).or_default();
        match file.slot() {
            None => domain.0.push(file),
            Some(slot) => domain.1.entry(slot).or_default().push(file),
        }
    }
    for (domain, (pages, slots)) in domains {
        let _ = write!(text, "\n## {domain}\n");
        if !pages.is_empty() {
            text.push_str("\n| page | what it holds | kernels |\n|---|---|---|\n");
        }
        for page in pages {
            let kernels: Vec<String> = (page.declarations.iter())
                .filter(|declaration| declaration.kind == Kind::Entry)
                .map(|declaration| format!("`{}`", declaration.name))
                .collect();
            let topic = page.path.rsplit('/').next().unwrap_or_default();
            let topic = linked_name(&shaders, page.source, topic);
            let _ = writeln!(text, "| {topic} | {} | {} |", about(page), kernels.join(", "));
        }
        if slots.is_empty() {
            continue;
        }
        let _ = write!(text, "\n| slot | provides | variants |\n|---|---|---|\n");
        for (slot, variants) in slots {
            let provided = provided(&variants);
            let variants: Vec<String> = (variants.iter())
                .map(|file| {
                    let name = file.path.rsplit('/').next().unwrap_or_default();
                    linked_name(&shaders, file.source, name)
                })
                .collect();
            let name = slot.rsplit('/').next().unwrap_or_default();
            let _ = writeln!(text, "| {name} | {} | {} |", provided.join(", "), variants.join(", "));
        }
    }
    text
}

/// The name of a file, with a link if it is one.
fn linked_name(shaders: &Path, path: &str, name: &str) -> String {
    let written = shaders.join(format!("{path}.wgsl")).exists();
    if written { format!("[{name}]({path}.wgsl)") } else { format!("{name} (generated)") }
}

/// The first sentence of a file.
fn about(file: &File) -> String {
    let text = file.declarations.first().map_or("", |declaration| declaration.text);
    let comment: Vec<&str> = text
        .lines()
        .take_while(|line| line.starts_with("//"))
        .map(|line| line.trim_start_matches('/').trim())
        .collect();
    let comment = comment.join(" ");
    let end = comment.find(". ").map_or(comment.len(), |end| end + 1);
    comment[..end].replace('|', "\\|")
}

/// Functions, types and constants that more than one variant has, or the only one, and that others use.
fn provided(variants: &[&File]) -> Vec<String> {
    let kinds = [Kind::Function, Kind::Type, Kind::Constant];
    let of = |file: &File| -> Vec<&'static str> {
        let all = file.declarations.iter().filter(|declaration| kinds.contains(&declaration.kind));
        all.map(|declaration| declaration.name).collect()
    };
    let users: Vec<(&File, &Declaration)> = (library().unwrap().files().iter())
        .flat_map(|file| file.declarations.iter().map(move |declaration| (file, declaration)))
        .collect();
    let used = |name: &str| {
        let outside = |file: &File| variants.iter().all(|variant| variant.path != file.path);
        users.iter().any(|(file, declaration)| outside(file) && declaration.uses.contains(&name))
    };
    let mut names: Vec<&str> = variants.iter().flat_map(|file| of(file)).filter(|name| used(name)).collect();
    names.sort_unstable();
    names.dedup();
    names.into_iter().map(|name| format!("`{name}`")).collect()
}

#[test]
fn the_index_is_that_of_the_files() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("shaders/README.md");
    let now = index();
    if std::env::var_os("MESOSCOPE_RECORD").is_some() {
        std::fs::write(&path, &now).unwrap();
    }
    let written = std::fs::read_to_string(&path).unwrap();
    assert!(written == now, "shaders/README.md is stale: run this test with MESOSCOPE_RECORD=1");
}
