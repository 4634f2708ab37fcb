//! Makes Rust of the shaders and the table of arrays: every page and variant below `shaders`, and enumerations of kernels, arrays,
//! constants and the variants of every slot.

mod accessors;
mod arrays;
mod check;
mod enumerations;
mod radices;
mod wgsl;

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::{env, fs, io};

/// Folders whose files are whole shaders by themselves.
const WHOLE: [&str; 2] = ["plot", "check"];

/// Texts of pages and variants by their paths below `shaders`, without extensions.
type Files = BTreeMap<String, String>;

fn main() -> io::Result<()> {
    println!("cargo::rerun-if-changed=shaders");
    let root = PathBuf::from(env::var_os("CARGO_MANIFEST_DIR").unwrap_or_default()).join("shaders");
    let mut written = Files::new();
    find(&root, &root, &mut written)?;
    if let Err(reason) = check::arrays(&written) {
        println!("cargo::error={reason}");
        return Ok(());
    }
    let mut files = written;
    files.extend(accessors::files());
    files.extend(radices::variants());
    let code = enumerations::generate(&files);
    fs::write(PathBuf::from(env::var_os("OUT_DIR").unwrap_or_default()).join("shaders.rs"), code)
}

/// Reads the files below the root.
fn find(root: &Path, folder: &Path, files: &mut Files) -> io::Result<()> {
    for entry in fs::read_dir(folder)? {
        let path = entry?.path();
        let below = path.strip_prefix(root).unwrap_or(&path).to_string_lossy().replace('\\', "/");
        if path.is_dir() {
            if !WHOLE.contains(&below.as_str()) {
                find(root, &path, files)?;
            }
        } else if let Some(page) = below.strip_suffix(".wgsl") {
            files.insert(page.to_owned(), fs::read_to_string(&path)?);
        }
    }
    Ok(())
}
