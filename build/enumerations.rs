//! Rust made of the files: their texts, and enumerations of kernels, arrays, constants and variants.

use std::collections::BTreeMap;
use std::fmt::Write as _;

use crate::Files;
use crate::arrays::{ACCESSES, ARRAYS, Place};
use crate::wgsl::{self, first_sentence};

/// Name of a variant, number of its file, what it is.
type Variant<'a> = (&'a str, usize, String);

/// Names of an enumeration, with what each is.
type Names = BTreeMap<String, String>;

/// The module of everything.
pub fn generate(files: &Files, sources: &BTreeMap<String, String>) -> String {
    let mut code = String::new();
    let mut entries = Names::new();
    let mut slots: BTreeMap<&str, BTreeMap<&str, Vec<Variant<'_>>>> = BTreeMap::new();
    let _ = writeln!(code, "pub(super) static FILES: [(&str, &str); {}] = [", files.len());
    for (number, (file, text)) in files.iter().enumerate() {
        let _ = writeln!(code, "    ({file:?}, {text:?}),");
        entries.extend(wgsl::kernels(text));
        if let [domain, slot, variant] = file.split('/').collect::<Vec<_>>()[..] {
            slots.entry(domain).or_default().entry(slot).or_default().push((
                variant,
                number,
                first_sentence(text.trim_start()),
            ));
        }
    }
    code.push_str("];\n\n");
    let sources: Vec<(&String, &String)> = sources.iter().collect();
    let _ = writeln!(code, "pub(super) static SOURCES: [(&str, &str); {}] = {sources:?};\n", sources.len());
    number_slots(&mut code, files);
    enumerate(&mut code, "Entry", "The entry points of all kernels.", "function", &entries);
    let constants = constants(files);
    enumerate(&mut code, "Constant", "The constants that plans set.", "constant", &constants);
    enumerate_sums(&mut code, &constants);
    let purposes: Names = ARRAYS.iter().map(|array| (array.name.to_owned(), sentence(array.purpose))).collect();
    enumerate(&mut code, "Array", "The arrays of all kernels, in buffers and textures.", "variable", &purposes);
    describe_arrays(&mut code, files);
    for (domain, slots) in slots {
        let _ = writeln!(code, "/// Slots of `shaders/{domain}`.\npub mod {domain} {{\n    use super::Choice;\n");
        for (slot, variants) in slots {
            enumerate_variants(&mut code, domain, slot, &variants);
        }
        code.push_str("}\n\n");
    }
    code
}

/// The slot of every file by its number; pages have none.
fn number_slots(code: &mut String, files: &Files) {
    let slot = |file: &String| file.rsplit_once('/').map(|(slot, _)| slot.to_owned()).filter(|slot| slot.contains('/'));
    let slots: Vec<Option<String>> = files.keys().map(slot).collect();
    let number = |slot: &Option<String>| slots.iter().position(|known| known == slot).filter(|_| slot.is_some());
    let numbers: Vec<Option<usize>> = slots.iter().map(number).collect();
    let _ = writeln!(code, "pub(super) static SLOTS: [Option<u16>; {}] = {numbers:?};\n", files.len());
}

/// Constants with what is said of them where they are declared.
fn constants(files: &Files) -> Names {
    let mut names = Names::new();
    let mut places: BTreeMap<String, (String, Vec<&str>)> = BTreeMap::new();
    for (file, text) in files {
        for declared in wgsl::constants(text) {
            if let Some(comment) = declared.comment {
                names.entry(declared.name.clone()).or_insert(comment);
            }
            places.entry(declared.name).or_insert((declared.of, Vec::new())).1.push(file);
        }
    }
    for (name, (of, files)) in places {
        let files: Vec<String> = files.into_iter().map(|file| format!("`{file}`")).collect();
        let comment =
            names.remove(&name).map_or(String::new(), |comment| format!(": {}", comment.trim_end_matches('.')));
        let about = format!("`{name}: {of}` of {}{comment}.", files.join(", "));
        names.insert(name, about);
    }
    names
}

/// The sums of reports: the constants that hold their places.
fn enumerate_sums(code: &mut String, constants: &Names) {
    let sums: Names = constants
        .iter()
        .filter_map(|(name, about)| Some((name.strip_prefix("SUM_")?.to_lowercase(), about.clone())))
        .collect();
    enumerate(code, "Sum", "What reports sum, by the constants that hold the places.", "sum", &sums);
    code.push_str("impl Sum {\n    /// The constant that holds its place in a row of a report.\n    #[must_use]\n");
    code.push_str("    pub const fn constant(self) -> Constant {\n        match self {\n");
    for name in sums.keys() {
        let name = camel(name);
        let _ = writeln!(code, "            Self::{name} => Constant::Sum{name},");
    }
    code.push_str("        }\n    }\n}\n\n");
}

/// A phrase as a sentence.
fn sentence(phrase: &str) -> String {
    let mut letters = phrase.chars();
    let first: String = letters.next().into_iter().flat_map(char::to_uppercase).collect();
    first + letters.as_str() + "."
}

/// An enumeration of names.
fn enumerate(code: &mut String, name: &str, about: &str, noun: &str, names: &Names) {
    let _ = writeln!(
        code,
        "/// {about}\n#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]\npub enum {name} {{"
    );
    for (name, comment) in names {
        let _ = writeln!(code, "    /// {comment}\n    {},", camel(name));
    }
    let _ = writeln!(code, "}}\n\nimpl {name} {{\n    /// All of them.\n    pub const ALL: &'static [Self] = &[");
    for name in names.keys() {
        let _ = writeln!(code, "        Self::{},", camel(name));
    }
    let _ = writeln!(
        code,
        "    ];\n\n    /// The name of the {noun}.\n    #[must_use]\n    pub const fn name(self) -> &'static str {{\n        match self {{"
    );
    for name in names.keys() {
        let _ = writeln!(code, "            Self::{} => {name:?},", camel(name));
    }
    let _ = writeln!(
        code,
        "        }}\n    }}\n\n    /// The {noun} of a name.\n    #[must_use]\n    pub fn named(name: &str) -> Option<Self> {{\n        match name {{"
    );
    for name in names.keys() {
        let _ = writeln!(code, "            {name:?} => Some(Self::{}),", camel(name));
    }
    code.push_str("            _ => None,\n        }\n    }\n}\n\n");
}

/// What the table says of the arrays, and where they lie unless a plan says otherwise.
fn describe_arrays(code: &mut String, files: &Files) {
    code.push_str("impl Array {\n    /// What it is for.\n    #[must_use]\n    pub const fn purpose(self) -> &'static str {\n        match self {\n");
    for array in ARRAYS {
        let _ = writeln!(code, "            Self::{} => {:?},", camel(array.name), array.purpose);
    }
    code.push_str("        }\n    }\n\n    /// Words of a texel, where it lies in a texture: one, two or four; none of what lies in buffers only.\n");
    code.push_str("    #[must_use]\n    pub const fn texel_words(self) -> u32 {\n        match self {\n");
    let words: BTreeMap<&str, u32> = files.values().flat_map(|text| wgsl::texel_words(text)).collect();
    for count in [1, 2, 4] {
        let names =
            words.iter().filter(|(_, words)| **words == count).map(|(name, _)| format!("Self::{}", camel(name)));
        let _ = writeln!(code, "            {} => {count},", names.collect::<Vec<_>>().join(" | "));
    }
    code.push_str("            _ => 0,\n        }\n    }\n\n    /// The variant by which kernels find it in a texture, of those that they find in a buffer by default.\n");
    code.push_str("    pub(crate) const fn in_texture(self) -> Option<Choice> {\n        Some(Choice(match self {\n");
    let number = |slot: &str, variant: &str| files.keys().position(|file| *file == format!("{slot}/{variant}"));
    let mut in_buffers = Vec::new();
    for access in ACCESSES.iter().filter(|access| access.slot == format!("arrays/{}", access.array)) {
        for (variant, place) in access.places {
            match place {
                Place::Buffer | Place::ReadBuffer => {
                    in_buffers.extend(number(access.slot, variant).map(|number| format!("Choice({number})")));
                }
                Place::Texture => {
                    if let Some(number) = number(access.slot, variant) {
                        let _ = writeln!(code, "            Self::{} => {number},", camel(access.array));
                    }
                }
                Place::Textures(_) => {}
            }
        }
    }
    let _ = writeln!(
        code,
        "            _ => return None,\n        }}))\n    }}\n}}\n\npub(super) static IN_BUFFERS: [Choice; {}] = [{}];\n",
        in_buffers.len(),
        in_buffers.join(", ")
    );
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
        "    }}\n\n    impl {name} {{\n        /// All of them.\n        pub const ALL: &'static [Self] = &["
    );
    for (variant, _, _) in variants {
        let _ = writeln!(code, "            Self::{},", camel(variant));
    }
    let _ = writeln!(
        code,
        "        ];\n    }}\n\n    impl From<{name}> for Choice {{\n        fn from(variant: {name}) -> Self {{\n            Self(match variant {{"
    );
    for (variant, number, _) in variants {
        let _ = writeln!(code, "                {name}::{} => {number},", camel(variant));
    }
    code.push_str("            })\n        }\n    }\n\n");
}

/// `discrete_gradient` as `DiscreteGradient`, and `CELLS_X` as `CellsX`.
fn camel(name: &str) -> String {
    let capital = |word: &str| word[..1].to_uppercase() + &word[1..].to_lowercase();
    name.split('_').map(capital).collect()
}
