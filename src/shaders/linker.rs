//! Linking by names: from the entry point of a kernel to the declarations that it reaches.
//!
//! A name that a declaration uses is resolved, in this order, by
//!
//! 1. the chosen variant of a slot that declares it,
//! 2. the caller's own page,
//! 3. the only page that declares it,
//!
//! else linking fails with the candidates. So a function in a page is the default that a chosen variant replaces, and nobody
//! keeps lists of files. Arrays are seen as the caller's own file declares them, else as the page of the table of arrays does.

use std::collections::{BTreeSet, HashMap, HashSet};

use super::words::{Word, words};

/// What a declaration declares.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Kind {
    /// The entry point of a kernel.
    Entry,
    /// A function.
    Function,
    /// A structure or an alias.
    Type,
    /// A constant, or one that the host sets.
    Constant,
    /// A variable of an invocation or a workgroup.
    Variable,
    /// An array in a buffer or a texture, without its number.
    Array,
}

/// One declaration of a page or a variant, with the comment above it.
#[derive(Debug, Clone)]
pub struct Declaration {
    /// What it declares.
    pub kind: Kind,
    /// Its name.
    pub name: &'static str,
    /// Its text.
    pub text: &'static str,
    /// The line in its file on which the text begins, from 1.
    pub line: u32,
    /// Names that it uses and does not declare itself.
    pub uses: Vec<&'static str>,
    /// Names that it declares for itself: parameters and variables of a function.
    pub locals: Vec<&'static str>,
}

/// A page or a variant.
#[derive(Debug)]
pub struct File {
    /// Path below `shaders`, without the extension: `domain/topic`, or `domain/slot/variant`.
    pub path: &'static str,
    /// The path of the file that holds it: its own, or that of a file which has variants of one name for several slots.
    pub source: &'static str,
    /// Its declarations, in order.
    pub declarations: Vec<Declaration>,
}

impl File {
    /// The slot `domain/slot` of a variant; nothing for a page.
    #[must_use]
    pub fn slot(&self) -> Option<&'static str> {
        let (slot, _) = self.path.rsplit_once('/')?;
        slot.contains('/').then_some(slot)
    }
}

/// All pages and variants, and where names are declared in them.
#[derive(Debug)]
pub struct Library {
    files: Vec<File>,
    by_name: HashMap<&'static str, Vec<(usize, usize)>>,
}

/// A declaration: number of its file, and its number there.
type Place = (usize, usize);

/// What an entry point has been found to reach.
struct Reached {
    names: HashMap<&'static str, Place>,
    /// Each after what it uses.
    in_order: Vec<Place>,
    seen: HashSet<Place>,
}

/// Why a kernel does not link: the place `file:line`, and the reason.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("shaders/{place}: {reason}")]
pub struct Unlinked {
    /// File and line.
    pub place: String,
    /// What is wrong there.
    pub reason: String,
}

/// A part of a linked text.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Part {
    /// Its first line in the text, from 1.
    pub begins: u32,
    /// The page or the variant that it is from.
    pub path: &'static str,
    /// The file that holds it.
    pub source: &'static str,
    /// Its first line there.
    pub line: u32,
}

/// The text of a kernel with the way back to the files.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct LinkedText {
    /// WGSL, with binding numbers.
    pub text: String,
    /// The parts, in order.
    pub parts: Vec<Part>,
}

impl Library {
    /// Reads files given as path and text.
    ///
    /// # Errors
    /// [`Unlinked`] where a file holds something that is no declaration.
    pub fn new(files: &[(&'static str, &'static str)]) -> Result<Self, Unlinked> {
        let mut library = Self { files: Vec::new(), by_name: HashMap::new() };
        for (number, &(path, text)) in files.iter().enumerate() {
            let declarations = declarations(path, text)?;
            for (index, declaration) in declarations.iter().enumerate() {
                library.by_name.entry(declaration.name).or_default().push((number, index));
            }
            library.files.push(File { path, source: path, declarations });
        }
        Ok(library)
    }

    /// The same files, some of which are parts of others, by their paths.
    pub(crate) fn with_sources(mut self, sources: &[(&'static str, &'static str)]) -> Self {
        for file in &mut self.files {
            let shared = sources.iter().find(|(path, _)| *path == file.path);
            file.source = shared.map_or(file.path, |(_, source)| source);
        }
        self
    }

    /// All files.
    #[must_use]
    pub fn files(&self) -> &[File] {
        &self.files
    }

    fn declaration(&self, (file, index): Place) -> &Declaration {
        &self.files[file].declarations[index]
    }

    /// A failure at a declaration.
    fn unlinked(&self, at: Place, reason: String) -> Unlinked {
        Unlinked { place: format!("{}.wgsl:{}", self.files[at.0].source, self.declaration(at).line), reason }
    }

    /// Whether two declarations are the same but for comments and spaces.
    fn alike(&self, a: Place, b: Place) -> bool {
        let code = |place: Place| -> String {
            let lines = self.declaration(place).text.lines().map(|line| line.split("//").next().unwrap_or_default());
            lines.flat_map(str::split_whitespace).collect()
        };
        code(a) == code(b)
    }

    fn number(&self, path: &str) -> Option<usize> {
        self.files.iter().position(|file| file.path == path)
    }

    /// Names with more than one meaning: a page's function may be replaced by variants of slots; any other name is declared by
    /// one page or by variants of one slot. Arrays may be seen in more than one way.
    #[must_use]
    pub fn ambiguous(&self) -> Vec<String> {
        let mut complaints = Vec::new();
        for (name, places) in &self.by_name {
            let kinds: BTreeSet<u8> = places.iter().map(|place| self.declaration(*place).kind as u8).collect();
            if kinds == BTreeSet::from([Kind::Array as u8]) {
                continue;
            }
            let pages = places.iter().filter(|(file, _)| self.files[*file].slot().is_none()).count();
            let slots: BTreeSet<_> = places.iter().filter_map(|(file, _)| self.files[*file].slot()).collect();
            if kinds.len() > 1 && kinds.contains(&(Kind::Function as u8)) || pages > 1 || pages == 0 && slots.len() > 1
            {
                let places: Vec<&str> = places.iter().map(|(file, _)| self.files[*file].path).collect();
                complaints.push(format!("`{name}` is declared by {}", places.join(", ")));
            }
        }
        complaints.sort_unstable();
        complaints
    }

    /// Parameters and variables of functions that have the name of something that the library declares.
    #[must_use]
    pub fn shadows(&self) -> Vec<String> {
        let all = self.files.iter().flat_map(|file| file.declarations.iter().map(move |own| (file.source, own)));
        let functions = all.filter(|(_, own)| matches!(own.kind, Kind::Function | Kind::Entry));
        functions
            .flat_map(|(path, own)| {
                let known = own.locals.iter().filter(|local| self.by_name.contains_key(*local));
                known.map(move |local| format!("{path}.wgsl:{}: `{local}` in `{}`", own.line, own.name))
            })
            .collect()
    }

    /// Which declaration a name stands for, used in a file; nothing if the library does not know it.
    fn resolve(&self, name: &str, user: Place, chosen: &[usize]) -> Result<Option<Place>, Unlinked> {
        let Some(candidates) = self.by_name.get(name) else { return Ok(None) };
        let failure = |reason: String| self.unlinked(user, reason);
        let list =
            |places: &[Place]| places.iter().map(|(file, _)| self.files[*file].path).collect::<Vec<_>>().join(", ");
        let own = candidates.iter().find(|(file, _)| *file == user.0).copied();
        // An array is seen as the user declares it, else as a page does: what a variant sees is its own affair.
        let is_array = |place: &Place| self.declaration(*place).kind == Kind::Array;
        let on_page = || candidates.iter().find(|(file, _)| self.files[*file].slot().is_none()).copied();
        if let Some(array) = own.or_else(on_page).filter(is_array) {
            return Ok(Some(array));
        }
        let of_chosen: Vec<Place> = candidates.iter().filter(|(file, _)| chosen.contains(file)).copied().collect();
        match of_chosen[..] {
            [place] => return Ok(Some(place)),
            [] => {}
            // A variant knows its own.
            _ => {
                if let Some(own) = own.filter(|own| of_chosen.contains(own)) {
                    return Ok(Some(own));
                }
                if of_chosen.iter().all(|place| self.alike(*place, of_chosen[0])) {
                    return Ok(Some(of_chosen[0]));
                }
                return Err(failure(format!("`{name}` is declared by several chosen variants: {}", list(&of_chosen))));
            }
        }
        if own.is_some() {
            return Ok(own);
        }
        let pages: Vec<Place> =
            candidates.iter().filter(|(file, _)| self.files[*file].slot().is_none()).copied().collect();
        match pages[..] {
            [place] => Ok(Some(place)),
            [] => Err(failure(format!("no variant that declares `{name}` is chosen; there are {}", list(candidates)))),
            _ => Err(failure(format!("`{name}` is declared by several pages: {}", list(&pages)))),
        }
    }

    /// Links the kernel with an entry point and chosen variants, given by their paths.
    ///
    /// # Errors
    /// [`Unlinked`] if there is no such entry or variant, or a name cannot be resolved.
    pub fn link(&self, entry: &str, choices: &[&str]) -> Result<LinkedText, Unlinked> {
        let nowhere = |reason: String| Unlinked { place: "README.md".to_owned(), reason };
        let start = (self.by_name.get(entry).into_iter().flatten())
            .find(|place| self.declaration(**place).kind == Kind::Entry)
            .ok_or_else(|| nowhere(format!("there is no kernel `{entry}`")))?;
        let chosen: Vec<usize> = (choices.iter())
            .map(|path| self.number(path).ok_or_else(|| nowhere(format!("there is no variant `{path}`"))))
            .collect::<Result<_, _>>()?;
        let mut reached = Reached { names: HashMap::new(), in_order: Vec::new(), seen: HashSet::new() };
        self.reach(*start, &chosen, &mut reached)?;
        Ok(self.text(&reached.in_order))
    }

    /// Adds what a declaration uses, and then the declaration: naga evaluates sizes of arrays in the order of the text.
    fn reach(&self, user: Place, chosen: &[usize], reached: &mut Reached) -> Result<(), Unlinked> {
        reached.seen.insert(user);
        for name in &self.declaration(user).uses {
            let Some(place) = self.resolve(name, user, chosen)? else { continue };
            let known = *reached.names.entry(name).or_insert(place);
            if known != place && !self.alike(known, place) {
                let (here, elsewhere) = (self.files[place.0].path, self.files[known.0].path);
                let reason = format!("`{name}` is that of {here} here and that of {elsewhere} elsewhere in the kernel");
                return Err(self.unlinked(user, reason));
            }
            if !reached.seen.contains(&known) {
                self.reach(known, chosen, reached)?;
            }
        }
        reached.in_order.push(user);
        Ok(())
    }

    /// The text of some declarations. Arrays get their numbers, and elements that the kernel changes atomically are atomics.
    fn text(&self, reached: &[Place]) -> LinkedText {
        let mut atomics: BTreeSet<&str> = BTreeSet::new();
        for place in reached {
            let found = words(self.declaration(*place).text).collect::<Vec<_>>();
            for window in found.windows(2) {
                if window[0].text.starts_with("atomic") && window[1].referenced {
                    atomics.insert(window[1].text);
                }
            }
        }
        let mut linked = LinkedText { text: String::new(), parts: Vec::new() };
        let (mut lines, mut number) = (0, 0);
        for &(file, index) in reached {
            let declaration = &self.files[file].declarations[index];
            let File { path, source, .. } = self.files[file];
            linked.parts.push(Part { begins: lines + 1, path, source, line: declaration.line });
            if declaration.kind == Kind::Array {
                let text = if atomics.contains(declaration.name) {
                    declaration
                        .text
                        .replace("array<u32>", "array<atomic<u32>>")
                        .replace("array<i32>", "array<atomic<i32>>")
                } else {
                    declaration.text.to_owned()
                };
                // After the comments above it; the one beside it may speak of variables too.
                let at = if text.starts_with("var") { 0 } else { text.find("\nvar").map_or(0, |at| at + 1) };
                linked.text.push_str(&text[..at]);
                linked.text.extend(["@group(0) @binding(", &number.to_string(), ") "]);
                linked.text.push_str(&text[at..]);
                number += 1;
            } else {
                linked.text.push_str(declaration.text);
            }
            if !linked.text.ends_with('\n') {
                linked.text.push('\n');
            }
            lines += declaration.text.lines().count() as u32;
        }
        linked
    }
}

/// Divides a file into declarations.
fn declarations(path: &str, text: &'static str) -> Result<Vec<Declaration>, Unlinked> {
    let mut declarations = Vec::new();
    let (mut begin, mut depth, mut line, mut begin_line) = (0, 0_u32, 1, 1);
    let bytes = text.as_bytes();
    let mut at = 0;
    while at < bytes.len() {
        match bytes[at] {
            b'/' if bytes.get(at + 1) == Some(&b'/') => {
                while at < bytes.len() && bytes[at] != b'\n' {
                    at += 1;
                }
                continue;
            }
            b'\n' => line += 1,
            b'{' | b'(' => depth += 1,
            b')' => depth = depth.saturating_sub(1),
            byte @ (b'}' | b';') => {
                if byte == b'}' {
                    depth = depth.saturating_sub(1);
                }
                if depth == 0 {
                    // With the comment that follows on the same line.
                    let end = text[at..].find('\n').map_or(text.len(), |length| at + length + 1);
                    let blank = text[begin..].len() - text[begin..].trim_start_matches('\n').len();
                    let declaration = declaration(&text[begin + blank..end], begin_line + blank as u32);
                    declarations.push(declaration.ok_or_else(|| Unlinked {
                        place: format!("{path}.wgsl:{begin_line}"),
                        reason: "this is no declaration".to_owned(),
                    })?);
                    begin = end;
                    line += 1;
                    begin_line = line;
                    at = end;
                    continue;
                }
            }
            _ => {}
        }
        at += 1;
    }
    Ok(declarations)
}

/// What a text declares.
fn declaration(text: &'static str, line: u32) -> Option<Declaration> {
    let all: Vec<Word<'static>> = words(text).collect();
    let head = all.iter().position(|word| {
        matches!(word.text, "fn" | "struct" | "alias" | "const" | "override" | "var") && !word.member && !word.attribute
    })?;
    let keyword = all[head].text;
    // `var<storage, read_write> name`: what is in angle brackets is no name.
    let named = all[head + 1..].iter().position(|word| !word.in_template)? + head + 1;
    let name = all[named].text;
    let entry = all[..head].iter().any(|word| word.attribute && word.text == "compute");
    let space: Vec<&str> = all[head + 1..named].iter().map(|word| word.text).collect();
    let kind = match keyword {
        "fn" if entry => Kind::Entry,
        "fn" => Kind::Function,
        "struct" | "alias" => Kind::Type,
        "var" if space.contains(&"storage") => Kind::Array,
        "var" if all.iter().any(|word| word.text.starts_with("texture_storage")) => Kind::Array,
        "var" => Kind::Variable,
        _ => Kind::Constant,
    };
    // Members of structures, parameters and variables of functions.
    let own = |index: usize| match keyword {
        "struct" => all[index].typed,
        "fn" => all[index].typed || matches!(all[index - 1].text, "let" | "var" | "const") && index > named,
        _ => false,
    };
    let locals: BTreeSet<&str> =
        (head + 1..all.len()).filter(|index| own(*index)).map(|index| all[index].text).collect();
    let used = |word: &&Word<'static>| !(word.member || word.attribute || word.typed && keyword == "struct");
    let mut uses: Vec<&str> = Vec::new();
    for word in all.iter().filter(used).map(|word| word.text) {
        if word != name && !(locals.contains(word) && keyword != "struct") && !uses.contains(&word) {
            uses.push(word);
        }
    }
    Some(Declaration { kind, name, text, line, uses, locals: locals.into_iter().collect() })
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::{Kind, Library};

    const KERNEL: &str = "// A kernel.\n@compute @workgroup_size(WORKGROUP)\nfn kernel(@builtin(workgroup_id) workgroup: vec3<u32>) {\n    \
        let size = 1u; // of nothing\n    if (counts[0] == size) { store(law(workgroup.x)); }\n}\n";

    fn library(files: &[(&'static str, &'static str)]) -> Library {
        let common = [
            ("core/kernel", KERNEL),
            ("core/size", "override WORKGROUP: u32;\n"),
            ("core/law", "// Off.\nfn law(a: u32) -> u32 { return 0u; }\n"),
            ("core/arrays", "var<storage, read_write> counts: array<u32>; // of cells\n"),
            ("core/store", "fn store(a: u32) { atomicAdd(&counts[a], 1u); }\n"),
        ];
        Library::new(&[&common[..], files].concat()).unwrap()
    }

    #[test]
    fn names_are_those_of_chosen_variants_then_of_the_file_then_of_the_only_page() {
        let on = ("core/law/on", "struct Law { size: u32 }\nfn law(a: u32) -> u32 { return Law(a).size; }\n");
        let library = library(&[on]);
        let off = library.link("kernel", &[]).unwrap();
        assert!(off.text.contains("return 0u;") && !off.text.contains("struct Law"), "{}", off.text);
        let chosen = library.link("kernel", &["core/law/on"]).unwrap();
        assert!(!chosen.text.contains("return 0u;") && chosen.text.contains("struct Law"), "{}", chosen.text);
        // Elements that are changed atomically are atomics, and arrays are numbered.
        assert!(
            off.text.contains("@group(0) @binding(0) var<storage, read_write> counts: array<atomic<u32>>;"),
            "{}",
            off.text
        );
        let law = off.parts.iter().find(|part| part.path == "core/law").unwrap();
        assert_eq!((law.line, off.text.lines().nth(law.begins as usize - 1)), (1, Some("// Off.")));
    }

    #[test]
    fn an_array_is_seen_as_its_page_declares_it_but_by_a_file_that_sees_it_otherwise() {
        let pairs = (
            "core/pairs/on",
            "var<storage, read_write> counts: array<vec2<u32>>;\n\
            fn law(a: u32) -> u32 { return a; }\nfn pair(a: u32) -> vec2<u32> { return counts[a]; }\n",
        );
        let page = library(&[pairs]).link("kernel", &["core/pairs/on"]).unwrap();
        assert!(
            page.text.contains("counts: array<atomic<u32>>;") && !page.text.contains("vec2<u32>>"),
            "{}",
            page.text
        );
        let both = (
            "core/pairs/on",
            "var<storage, read_write> counts: array<vec2<u32>>;\n\
            fn law(a: u32) -> u32 { return counts[a].x; }\n",
        );
        let error = library(&[both]).link("kernel", &["core/pairs/on"]).unwrap_err();
        assert!(error.reason.contains("`counts` is that of core/"), "{}", error.reason);
    }

    #[test]
    fn what_is_not_unique_is_refused() {
        let twice = library(&[("core/other", "fn law(a: u32) -> u32 { return 2u; }\n")]);
        assert_eq!(twice.ambiguous(), ["`law` is declared by core/law, core/other"]);
        assert!(twice.link("kernel", &[]).unwrap_err().reason.contains("several pages: core/law, core/other"));
        let slots = library(&[("core/a/one", "const A: u32 = 1u;"), ("core/b/one", "const A: u32 = 2u;")]);
        assert_eq!(slots.ambiguous(), ["`A` is declared by core/a/one, core/b/one"]);
        let none = library(&[]).link("kernel", &["core/law/on"]).unwrap_err();
        assert_eq!(none.reason, "there is no variant `core/law/on`");
        assert!(Library::new(&[("core/text", "nothing to declare;")]).is_err());
    }

    #[test]
    fn declarations_know_their_kinds_and_their_own_names() {
        let library = library(&[("core/more", "var<private> sum: vec2<f32>;\nfn more(p: u32) { var sum_of = p; }\n")]);
        let of = |name: &str| {
            let all = library.files().iter().flat_map(|file| &file.declarations);
            all.into_iter().find(|own| own.name == name).unwrap()
        };
        assert_eq!(
            [of("kernel").kind, of("counts").kind, of("sum").kind, of("WORKGROUP").kind],
            [Kind::Entry, Kind::Array, Kind::Variable, Kind::Constant]
        );
        assert_eq!(of("more").locals, ["p", "sum_of"]);
        assert_eq!(of("kernel").locals, ["size", "workgroup"]);
        assert!(of("kernel").uses.contains(&"law") && of("kernel").uses.contains(&"WORKGROUP"));
        assert!(!of("kernel").uses.contains(&"size") && !of("kernel").uses.contains(&"nothing"));
    }
}
