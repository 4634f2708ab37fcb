//! Makes Rust of the shaders and the table of arrays: every page and variant below `shaders`, and enumerations of kernels, arrays,
//! constants and the variants of every slot.

mod accessors;
mod arrays;
mod check;
mod enumerations;
mod radices;
mod splines;
mod wgsl;

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::{env, fs, io};

/// Folders whose files are whole shaders by themselves.
const WHOLE: [&str; 2] = ["plot", "check"];

/// Texts of pages and variants by their paths below `shaders`, without extensions.
type Files = BTreeMap<String, String>;

/// The mark of a variant that lies in the file of another topic: its path follows.
const MARK: &str = "// == ";

fn main() -> io::Result<()> {
    println!("cargo::rerun-if-changed=shaders");
    let root = PathBuf::from(env::var_os("CARGO_MANIFEST_DIR").unwrap_or_default()).join("shaders");
    let (mut written, mut sources) = (Files::new(), BTreeMap::new());
    find(&root, &root, &mut written, &mut sources)?;
    if let Err(reason) = check::arrays(&written) {
        println!("cargo::error={reason}");
        return Ok(());
    }
    let mut files = written;
    files.extend(accessors::files());
    files.extend(radices::variants());
    files.extend(splines::variants());
    let code = enumerations::generate(&files, &sources);
    fs::write(PathBuf::from(env::var_os("OUT_DIR").unwrap_or_default()).join("shaders.rs"), code)
}

/// Reads the files below the root; `sources` has the files of variants that share one.
fn find(root: &Path, folder: &Path, files: &mut Files, sources: &mut BTreeMap<String, String>) -> io::Result<()> {
    for entry in fs::read_dir(folder)? {
        let path = entry?.path();
        let below = path.strip_prefix(root).unwrap_or(&path).to_string_lossy().replace('\\', "/");
        if path.is_dir() {
            if !WHOLE.contains(&below.as_str()) {
                find(root, &path, files, sources)?;
            }
        } else if let Some(page) = below.strip_suffix(".wgsl") {
            let text = fs::read_to_string(&path)?;
            for (path, text) in divided(page, &text) {
                if path != page {
                    sources.insert(path.clone(), page.to_owned());
                }
                files.insert(path, text);
            }
        }
    }
    Ok(())
}

/// A page and the variants that lie in its file, each from the line on that it has in the file. A page of comments alone is none.
fn divided(page: &str, text: &str) -> Files {
    let mut path = page;
    let mut parts = Files::new();
    for (number, line) in text.lines().enumerate() {
        if let Some(variant) = line.strip_prefix(MARK) {
            path = variant.trim();
        } else {
            let part = parts.entry(path.to_owned()).or_insert_with(|| "\n".repeat(number));
            *part += line;
            part.push('\n');
        }
    }
    let says_nothing = |text: &String| text.lines().all(|line| line.is_empty() || line.starts_with("//"));
    if parts.len() > 1 && parts.get(page).is_some_and(says_nothing) {
        parts.remove(page);
    }
    parts
}
