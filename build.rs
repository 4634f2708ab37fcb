//! Finds the shaders: every page and variant below `shaders`, the kernels in them, and an enumeration for every slot.

use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::path::{Path, PathBuf};
use std::{env, fs, io};

#[path = "build/radices.rs"]
mod radices;

/// Folders whose files are whole shaders by themselves.
const WHOLE: [&str; 2] = ["plot", "check"];

/// An array that kernels come to by functions, so that it lies in a buffer or in a texture.
struct Array {
    name: &'static str,
    purpose: &'static str,
    element: Element,
    /// The function that loads an element, and the one that stores one, if kernels do that.
    load: Option<&'static str>,
    store: Option<&'static str>,
}

/// What an array holds.
#[derive(Clone, Copy)]
enum Element {
    Word,
    Words,
    Complex,
    /// Four real numbers that kernels only read.
    Entry,
}

const fn array(
    name: &'static str,
    purpose: &'static str,
    element: Element,
    load: Option<&'static str>,
    store: Option<&'static str>,
) -> Array {
    Array { name, purpose, element, load, store }
}

const ARRAYS: [Array; 10] = [
    array("cells", "Where each cell begins", Element::Word, Some("cell_at"), Some("put_cell")),
    array("coefficients", "The table of pairs of species", Element::Entry, Some("coefficient_entry"), None),
    array(
        "memories",
        "What the bath of every listed pair remembers",
        Element::Words,
        Some("pair_memory"),
        Some("put_pair_memory"),
    ),
    array(
        "memories_next",
        "The same for the list that is being made",
        Element::Words,
        Some("next_pair_memory"),
        Some("put_next_pair_memory"),
    ),
    array(
        "neighbours",
        "The number of a particle's pairs, then its pairs, one row of particles after the other",
        Element::Word,
        Some("neighbour_word"),
        Some("put_neighbour_word"),
    ),
    array(
        "neighbours_next",
        "The same of the list that is being made",
        Element::Word,
        Some("next_neighbour_word"),
        Some("put_next_neighbour_word"),
    ),
    array(
        "order",
        "Where the particles lie in the order of their cells",
        Element::Word,
        Some("index_in_order"),
        Some("set_order"),
    ),
    array("ranks", "Place of each particle in its cell", Element::Word, Some("rank_of"), Some("put_rank")),
    array("waves", "The depth in Fourier space", Element::Complex, Some("wave_at"), None),
    array("waves_next", "The same after this pass", Element::Complex, None, Some("put_wave")),
];

impl Array {
    /// The variants for a buffer and for a texture.
    fn variants(&self) -> [(String, String); 2] {
        let (name, purpose) = (self.name, self.purpose);
        let (of, format, load, store, access) = match self.element {
            Element::Word => ("u32", "r32uint", "LOADED.x", "vec4<u32>(value)", "read_write"),
            Element::Words => ("vec2<u32>", "rg32uint", "LOADED.xy", "vec4<u32>(value, 0u, 0u)", "read_write"),
            Element::Complex => (
                "vec2<f32>",
                "rg32uint",
                "bitcast<vec2<f32>>(LOADED.xy)",
                "vec4<u32>(bitcast<vec2<u32>>(value), 0u, 0u)",
                "read_write",
            ),
            Element::Entry => ("vec4<f32>", "rgba32uint", "bitcast<vec4<f32>>(LOADED)", "", "read"),
        };
        let load = load.replace("LOADED", &format!("textureLoad({name}, texel(index))"));
        let mut buffer = format!("// {purpose}, in a buffer.\nvar<storage, {access}> {name}: array<{of}>;\n\n");
        let mut texture =
            format!("// {purpose}, in a texture.\nvar {name}: texture_storage_2d<{format}, read_write>;\n\n");
        if let Some(function) = self.load {
            let _ = writeln!(buffer, "fn {function}(index: u32) -> {of} {{ return {name}[index]; }}");
            let _ = writeln!(texture, "fn {function}(index: u32) -> {of} {{ return {load}; }}");
        }
        if let Some(function) = self.store {
            let _ = writeln!(buffer, "fn {function}(index: u32, value: {of}) {{ {name}[index] = value; }}");
            let _ = writeln!(
                texture,
                "fn {function}(index: u32, value: {of}) {{ textureStore({name}, texel(index), {store}); }}"
            );
        }
        [(format!("arrays/{name}/buffer"), buffer), (format!("arrays/{name}/texture"), texture)]
    }
}

fn main() -> io::Result<()> {
    println!("cargo::rerun-if-changed=shaders");
    let root = PathBuf::from(env::var_os("CARGO_MANIFEST_DIR").unwrap_or_default()).join("shaders");
    let mut paths = Vec::new();
    find(&root, &root, &mut paths)?;
    let mut files: BTreeMap<String, String> =
        ARRAYS.iter().flat_map(Array::variants).chain(radices::variants()).collect();
    for path in paths {
        let text = fs::read_to_string(root.join(format!("{path}.wgsl")))?;
        files.insert(path, text);
    }
    let code = generate(&files);
    fs::write(PathBuf::from(env::var_os("OUT_DIR").unwrap_or_default()).join("shaders.rs"), code)
}

/// Name of a variant, number of its file, what it is.
type Variant<'a> = (&'a str, usize, String);

/// Paths below the root, without extensions.
fn find(root: &Path, folder: &Path, files: &mut Vec<String>) -> io::Result<()> {
    for entry in fs::read_dir(folder)? {
        let path = entry?.path();
        let below = path.strip_prefix(root).unwrap_or(&path).to_string_lossy().replace('\\', "/");
        if path.is_dir() {
            if !WHOLE.contains(&below.as_str()) {
                find(root, &path, files)?;
            }
        } else if let Some(page) = below.strip_suffix(".wgsl") {
            files.push(page.to_owned());
        }
    }
    Ok(())
}

fn generate(files: &BTreeMap<String, String>) -> String {
    let mut code = String::new();
    let mut entries: BTreeMap<String, String> = BTreeMap::new();
    let mut slots: BTreeMap<&str, BTreeMap<&str, Vec<Variant<'_>>>> = BTreeMap::new();
    let _ = writeln!(code, "pub(super) static FILES: [(&str, &str); {}] = [", files.len());
    for (number, (file, text)) in files.iter().enumerate() {
        let _ = writeln!(code, "    ({file:?}, {text:?}),");
        for (name, comment) in kernels(text) {
            entries.insert(name, comment);
        }
        if let [domain, slot, variant] = file.split('/').collect::<Vec<_>>()[..] {
            slots.entry(domain).or_default().entry(slot).or_default().push((variant, number, first_sentence(text)));
        }
    }
    code.push_str("];\n\n");
    enumerate_kernels(&mut code, &entries);
    for (domain, slots) in slots {
        let _ = writeln!(code, "/// Slots of `shaders/{domain}`.\npub mod {domain} {{\n    use super::Choice;\n");
        for (slot, variants) in slots {
            enumerate_variants(&mut code, domain, slot, &variants);
        }
        code.push_str("}\n\n");
    }
    code
}

fn enumerate_kernels(code: &mut String, entries: &BTreeMap<String, String>) {
    code.push_str(
        "/// The entry points of all kernels.\n#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]\n",
    );
    code.push_str("pub enum Entry {\n");
    for (name, comment) in entries {
        let _ = writeln!(code, "    /// {comment}\n    {},", camel(name));
    }
    code.push_str("}\n\nimpl Entry {\n    /// All of them.\n    pub const ALL: &'static [Self] = &[\n");
    for name in entries.keys() {
        let _ = writeln!(code, "        Self::{},", camel(name));
    }
    code.push_str("    ];\n\n    /// The name of the function.\n    #[must_use]\n    pub const fn name(self) -> &'static str {\n        match self {\n");
    for name in entries.keys() {
        let _ = writeln!(code, "            Self::{} => {name:?},", camel(name));
    }
    code.push_str("        }\n    }\n}\n\n");
}

fn enumerate_variants(code: &mut String, domain: &str, slot: &str, variants: &[Variant<'_>]) {
    let name = camel(slot);
    let _ = writeln!(
        code,
        "    /// Variants of the slot `{domain}/{slot}`.\n    #[derive(Debug, Clone, Copy, PartialEq, Eq)]\n    pub enum {name} {{"
    );
    for (variant, _, comment) in variants {
        let _ = writeln!(code, "        /// {comment}\n        {},", camel(variant));
    }
    let _ = writeln!(
        code,
        "    }}\n\n    impl From<{name}> for Choice {{\n        fn from(variant: {name}) -> Self {{\n            Self(match variant {{"
    );
    for (variant, number, _) in variants {
        let _ = writeln!(code, "                {name}::{} => {number},", camel(variant));
    }
    code.push_str("            })\n        }\n    }\n\n");
}

/// Kernels of a file, with the first sentence of the comment above each.
fn kernels(text: &str) -> Vec<(String, String)> {
    let mut found = Vec::new();
    let mut rest = text;
    while let Some(at) = rest.find("@compute") {
        let before = text.len() - rest.len() + at;
        rest = &rest[at..];
        let name =
            rest.split_once("fn ").and_then(|(_, rest)| rest.split_once('(')).map_or("", |(name, _)| name.trim());
        found.push((name.to_owned(), comment_above(&text[..before]).unwrap_or_else(|| first_sentence(text))));
        rest = &rest["@compute".len()..];
    }
    found
}

/// The comment that ends where a text ends.
fn comment_above(text: &str) -> Option<String> {
    let lines: Vec<&str> = text.trim_end().lines().rev().take_while(|line| line.starts_with("//")).collect();
    (!lines.is_empty()).then(|| first_sentence(&lines.into_iter().rev().collect::<Vec<_>>().join("\n")))
}

/// The first sentence of the comment with which a text begins.
fn first_sentence(text: &str) -> String {
    let comment =
        text.lines().take_while(|line| line.starts_with("//")).map(|line| line.trim_start_matches('/').trim());
    let comment = comment.collect::<Vec<_>>().join(" ");
    let end = comment.find(". ").map_or(comment.len(), |end| end + 1);
    let sentence = comment[..end].trim().replace('[', "\\[").replace(']', "\\]").replace('<', "\\<");
    if sentence.is_empty() { "Without a comment.".to_owned() } else { sentence }
}

/// `discrete_gradient` as `DiscreteGradient`.
fn camel(name: &str) -> String {
    let capital = |word: &str| word[..1].to_uppercase() + &word[1..];
    name.split('_').map(capital).collect()
}
