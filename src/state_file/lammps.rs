//! LAMMPS data files: <https://docs.lammps.org/read_data.html>.
//!
//! Atoms of the styles that [`AtomStyle`] knows, with or without image flags; Masses, Velocities, Bonds, Angles and labels of types. Other
//! sections are skipped, and named. Atoms are put in the order of their ids, as LAMMPS writes them in any.

use super::atom_style::{AtomStyle, HYBRID};
use super::lines::Lines;
use super::tally::Tally;
use super::{
    CHARGE, FORMATS, Fits, Links, Mistake, Mistakes, NumbersOfSpecies, ParticleFile, box_mistake, shortened, triclinic,
    vector,
};
use crate::state::MOST_PARTICLES;
use std::collections::HashMap;
use std::fs::File;

/// Sections, as far as they are read.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Section {
    Masses,
    Atoms,
    Velocities,
    Bonds,
    Angles,
    /// The types of this number: atoms, bonds, angles.
    Labels(usize),
}

/// Sections that are read, and what the header counts their lines as.
const READ: [(&str, Section, &str); 8] = [
    ("Masses", Section::Masses, "atom types"),
    ("Atoms", Section::Atoms, "atoms"),
    ("Velocities", Section::Velocities, "atoms"),
    ("Bonds", Section::Bonds, "bonds"),
    ("Angles", Section::Angles, "angles"),
    ("Atom Type Labels", Section::Labels(0), "atom types"),
    ("Bond Type Labels", Section::Labels(1), "bond types"),
    ("Angle Type Labels", Section::Labels(2), "angle types"),
];

const SKIPPED: &str = "\
    Dihedrals, Impropers, Ellipsoids, Lines, Triangles, Bodies, Dihedral Type Labels, Improper Type Labels, Pair \
    Coeffs, PairIJ Coeffs, Bond Coeffs, Angle Coeffs, Dihedral Coeffs, Improper Coeffs, BondBond Coeffs, BondAngle \
    Coeffs, MiddleBondTorsion Coeffs, EndBondTorsion Coeffs, AngleTorsion Coeffs, AngleAngleTorsion Coeffs, \
    BondBond13 Coeffs, AngleAngle Coeffs, CMAP";

/// The most types that a file may announce.
const MOST_TYPES: u64 = 1 << 20;

/// Bounds of the box, axis by axis.
const BOUNDS: [&str; 3] = ["xlo xhi", "ylo yhi", "zlo zhi"];

/// Whether it is such a file: a number of atoms and bounds of a box follow the title, which may be a number.
pub(super) fn is_one(start: &[u8]) -> bool {
    let text = String::from_utf8_lossy(start);
    let has = |count: usize, names: &[&str]| {
        text.lines().skip(1).any(|line| {
            let words: Vec<&str> = uncommented(line).split_ascii_whitespace().collect();
            let Some((numbers, name)) = words.split_at_checked(count) else { return false };
            numbers.iter().all(|word| word.parse::<f64>().is_ok()) && names.contains(&name.join(" ").as_str())
        })
    };
    has(1, &["atoms"]) && (has(2, &BOUNDS) || has(3, &["avec"]))
}

/// A line without its comment.
fn uncommented(line: &str) -> &str {
    line.split('#').next().unwrap_or_default().trim()
}

/// What the header announces.
#[derive(Debug, Default)]
struct Header {
    /// Numbers of atoms, of atom types and so on, by these words.
    counts: HashMap<&'static str, u64>,
    bounds: [Option<[f64; 2]>; 3],
    unused: Vec<String>,
}

impl Header {
    fn count(&self, name: &str) -> u64 {
        self.counts.get(name).copied().unwrap_or(0)
    }
}

/// Names of types: labels, where the file has them.
#[derive(Debug, Default)]
struct Types {
    /// Places by label, and labels by place.
    labels: HashMap<String, u32>,
    labelled: HashMap<u32, String>,
    count: u32,
}

impl Types {
    /// The place of a type that is named by its number or label.
    fn place(&self, word: &str) -> Option<u32> {
        match word.parse::<u32>() {
            Ok(number) => number.checked_sub(1).filter(|place| *place < self.count),
            Err(_) => self.labels.get(word).copied(),
        }
    }

    fn names(&self) -> Vec<String> {
        let name = |place: u32| self.labelled.get(&place).cloned().unwrap_or_else(|| (place + 1).to_string());
        (0..self.count).map(name).collect()
    }
}

/// An atom as it is read.
struct Atom {
    id: u64,
    kind: u32,
    position: [f64; 3],
    image: Option<[i32; 3]>,
}

/// Everything that has been read of a file.
struct Reader<'a> {
    lines: Lines,
    header: Header,
    mistakes: Mistakes,
    /// The style of atoms where the file does not say it.
    style: Option<&'a AtomStyle>,
    /// A line that begins the next section.
    ahead: Option<(&'static str, String)>,
    kinds: [Types; 3],
    masses: Vec<Option<f64>>,
    charges: NumbersOfSpecies,
    atoms: Vec<Atom>,
    velocities: Vec<(u64, [f64; 3])>,
    bonds: Vec<([u64; 2], u32)>,
    angles: Vec<([u64; 3], u32)>,
}

pub(super) fn read(
    file: File,
    length: u64,
    style: Option<&AtomStyle>,
    fits: &Fits<'_>,
) -> Result<ParticleFile, Mistakes> {
    let mut reader = Reader {
        lines: Lines::of(file),
        header: Header::default(),
        mistakes: Mistakes::default(),
        style,
        ahead: None,
        kinds: Default::default(),
        masses: Vec::new(),
        charges: NumbersOfSpecies::new(CHARGE),
        atoms: Vec::new(),
        velocities: Vec::new(),
        bonds: Vec::new(),
        angles: Vec::new(),
    };
    reader.read_header(length)?;
    fits(reader.header.count("atoms"))?;
    reader.read_sections()?;
    reader.finish()
}

/// The name of a section and the comment behind it, if a line is one.
fn section_of(line: &str) -> Option<(&'static str, String)> {
    let name = uncommented(line);
    // Most lines are of numbers.
    if !name.starts_with(|letter: char| letter.is_ascii_uppercase()) {
        return None;
    }
    let comment = line.split_once('#').map_or(String::new(), |(_, comment)| comment.trim().to_owned());
    let known = READ.iter().map(|(name, ..)| *name).chain(SKIPPED.split(", ")).find(|known| *known == name);
    known.map(|name| (name, comment))
}

impl Reader<'_> {
    fn refuse(&mut self, found: String, accepted: impl Into<String>) {
        let place = self.lines.place();
        self.mistakes.push(Mistake::new(place, found, accepted));
    }

    fn read_header(&mut self, length: u64) -> Result<(), Mistakes> {
        // The first line is a title.
        self.lines.next()?;
        while let Some(line) = self.lines.next()? {
            if let Some(section) = section_of(line) {
                self.ahead = Some(section);
                break;
            }
            let text = uncommented(line).to_owned();
            if !text.is_empty() {
                self.header_line(&text, length);
            }
            if self.mistakes.are_enough() {
                break;
            }
        }
        for (axis, name) in BOUNDS.into_iter().enumerate() {
            let named = |mistake: Mistake| Mistake { found: format!("{} (`{name}`)", mistake.found), ..mistake };
            self.mistakes.extend(match self.header.bounds[axis] {
                None => Some(Mistake::new("", format!("no `{name}` in the header"), "the bounds of the box")),
                Some([low, high]) => box_mistake(&[high - low]).map(named),
            });
        }
        for (types, name) in self.kinds.iter_mut().zip(["atom types", "bond types", "angle types"]) {
            types.count = self.header.count(name) as u32;
        }
        std::mem::take(&mut self.mistakes).refuse()
    }

    fn header_line(&mut self, text: &str, length: u64) {
        let words: Vec<&str> = text.split_ascii_whitespace().collect();
        let first_word = words.iter().position(|word| word.parse::<f64>().is_err()).unwrap_or(words.len());
        let (numbers, name) = (&words[..first_word], words[first_word..].join(" "));
        let numbers: Vec<f64> = numbers.iter().filter_map(|word| word.parse().ok()).collect();
        let axis = BOUNDS.iter().position(|bounds| *bounds == name);
        if let (Some(axis), [low, high]) = (axis, numbers.as_slice()) {
            self.header.bounds[axis] = Some([*low, *high]);
            return;
        }
        match (name.as_str(), numbers.as_slice()) {
            ("xy xz yz", [0.0, 0.0, 0.0]) | ("abc origin", _) => return,
            ("xy xz yz", _) | ("avec" | "bvec" | "cvec", [_, _, _]) => {
                let mistake = triclinic(self.lines.place(), text);
                return self.mistakes.push(mistake);
            }
            _ => {}
        }
        let found = format!("found `{}`", shortened(text));
        let [count] = numbers.as_slice() else {
            return self.refuse(found, "a line of the header, or a section that LAMMPS knows");
        };
        // A line has at least a few digits and its end.
        let (most, limit) = if name.ends_with("types") {
            (MOST_TYPES as f64, format!("up to {MOST_TYPES}"))
        } else {
            ((length / 4).min(MOST_PARTICLES) as f64, format!("no more than fit in a file of {length} bytes"))
        };
        if !(*count >= 0.0 && count.fract() == 0.0 && *count <= most) {
            return self.refuse(found, format!("a whole number, {limit}"));
        }
        let count = *count as u64;
        // Types of what is not read, and room for what may be added, are neither.
        if let Some((_, _, known)) = READ.iter().find(|(_, _, known)| *known == name) {
            self.header.counts.insert(known, count);
        } else if count > 0
            && ["dihedrals", "impropers", "ellipsoids", "lines", "triangles", "bodies"].contains(&name.as_str())
        {
            self.header.unused.push(format!("its {count} {name}"));
        }
    }

    /// The next line that is not empty, without its comment; none where a section begins or the file ends.
    fn body_line(&mut self) -> Result<Option<String>, Mistakes> {
        while let Some(line) = self.lines.next()? {
            // Labels may be anything, and yet a section is known by its whole line.
            if let Some(section) = section_of(line) {
                self.ahead = Some(section);
                break;
            }
            let text = uncommented(line);
            if !text.is_empty() {
                return Ok(Some(text.to_owned()));
            }
        }
        Ok(None)
    }

    fn read_sections(&mut self) -> Result<(), Mistakes> {
        let mut seen: Vec<&str> = Vec::new();
        while let Some((name, comment)) = self.ahead.take() {
            let known = READ.iter().find(|(known, ..)| *known == name);
            if seen.contains(&name) && known.is_some() {
                self.refuse(format!("found the section `{name}` again"), "every section once");
                break;
            }
            seen.push(name);
            if let Some((_, section, counted)) = known {
                self.read_section(*section, [name, &comment], self.header.count(counted))?;
            } else {
                self.header.unused.push(format!("the section `{name}`"));
                while self.body_line()?.is_some() {}
            }
            if self.mistakes.are_enough() {
                break;
            }
        }
        for (name, counted) in [("Atoms", "atoms"), ("Bonds", "bonds"), ("Angles", "angles")] {
            let count = self.header.count(counted);
            if count > 0 && !seen.contains(&name) && self.mistakes.is_empty() {
                let found = format!("no section `{name}`, and {count} of them in the header");
                self.mistakes.push(Mistake::new("", found, "a whole file"));
            }
        }
        Ok(())
    }

    /// Reads so many lines of a section with its name and the comment behind it.
    fn read_section(&mut self, section: Section, [name, comment]: [&str; 2], count: u64) -> Result<(), Mistakes> {
        let mut style = None;
        if section == Section::Atoms {
            style = self.announced(comment).map_err(|mistake| self.refusal(mistake))?;
        }
        for line in 0..count {
            let Some(text) = self.body_line()? else {
                let found = format!("the section `{name}` ends after {line} of {count} lines");
                self.refuse(found, "as many lines as the header announces");
                return Ok(());
            };
            let words: Vec<&str> = text.split_ascii_whitespace().collect();
            if section == Section::Atoms && style.is_none() {
                style = Some(AtomStyle::of_columns(words.len()).map_err(|mistake| self.refusal(mistake))?);
            }
            if let Err(accepted) = self.read_line(section, style.as_ref(), &words) {
                self.refuse(format!("found `{}`", shortened(&text)), accepted);
                if self.mistakes.are_enough() {
                    return Ok(());
                }
            }
        }
        self.header.unused.extend(style.iter().flat_map(AtomStyle::unused));
        if self.ahead.is_none()
            && let Some(text) = self.body_line()?
        {
            let found = format!("found `{}` after {count} lines of `{name}`", shortened(&text));
            self.refuse(found, "as many lines as the header announces, and a section that LAMMPS knows");
            while self.body_line()?.is_some() {}
        }
        Ok(())
    }

    /// Takes a line of a section, where atoms have a style; else says what would be accepted.
    fn read_line(&mut self, section: Section, style: Option<&AtomStyle>, words: &[&str]) -> Result<(), String> {
        match section {
            Section::Masses => {
                let [kind, mass] = words else { return Err("a type and its mass".to_owned()) };
                let mass = mass.parse::<f64>().ok().filter(|mass| mass.is_finite() && *mass > 0.0);
                let place = self.kinds[0].place(kind).ok_or_else(|| self.accepted_type(0))?;
                self.masses.resize(self.kinds[0].count as usize, None);
                if let Some(known) = self.masses[place as usize] {
                    return Err(format!("every type once: type {} has the mass {known}", place + 1));
                }
                self.masses[place as usize] = Some(mass.ok_or("a mass greater than zero")?);
            }
            Section::Atoms => style.map_or(Ok(()), |style| self.read_atom(style, words))?,
            Section::Velocities => {
                let read = || {
                    let [id, velocity @ ..] = words else { return None };
                    Some((id.parse().ok()?, vector(velocity, |word| word.parse().ok())?))
                };
                self.velocities.push(read().ok_or("an id and three numbers")?);
            }
            Section::Bonds => self.bonds.push(self.link(1, words, "a number, a type and two ids")?),
            Section::Angles => self.angles.push(self.link(2, words, "a number, a type and three ids")?),
            Section::Labels(of) => {
                let types = &mut self.kinds[of];
                let [number, label] = words else { return Err("a number of a type and its label".to_owned()) };
                let place = number.parse().ok().and_then(|number: u32| number.checked_sub(1));
                let place = place.filter(|place| *place < types.count).ok_or("a number of a type")?;
                if types.labels.insert((*label).to_owned(), place).is_some()
                    || types.labelled.insert(place, (*label).to_owned()).is_some()
                {
                    return Err("every label and every type once".to_owned());
                }
            }
        }
        Ok(())
    }

    /// The atoms that a bond or an angle joins, and its type.
    fn link<const LENGTH: usize>(
        &self,
        of: usize,
        words: &[&str],
        accepted: &str,
    ) -> Result<([u64; LENGTH], u32), String> {
        let [_, kind, ends @ ..] = words else { return Err(accepted.to_owned()) };
        let kind = self.kinds[of].place(kind).ok_or_else(|| self.accepted_type(of))?;
        let ids = ends.get(..LENGTH).and_then(|ends| vector(ends, |word| word.parse().ok()));
        Ok((ids.ok_or(accepted)?, kind))
    }

    fn accepted_type(&self, of: usize) -> String {
        let types = &self.kinds[of];
        let labels = if types.labels.is_empty() { "" } else { ", or a label" };
        format!("a type from 1 to {}{labels}", types.count)
    }

    /// The style of atoms that the comment behind the name of their section says, else the one that the scene says, if any does.
    fn announced(&self, comment: &str) -> Result<Option<AtomStyle>, Mistake> {
        match (AtomStyle::in_comment(comment, self.style.is_some()), self.style) {
            (None, given) => Ok(given.cloned()),
            // LAMMPS writes nothing of the styles that a hybrid one is made of.
            (Some(HYBRID), Some(given)) if given.name.starts_with(HYBRID) => Ok(Some(given.clone())),
            (Some(named), given) => {
                let style = AtomStyle::of(named)?;
                let other = given.filter(|given| given.columns != style.columns);
                let Some(other) = other else { return Ok(Some(style)) };
                let found = format!("found atoms of the style `{named}`, and the `atom_style` \"{other}\" in `state`");
                Err(Mistake::new("", found, "the style that the file says, or no `atom_style`"))
            }
        }
    }

    /// All mistakes, with one more in the last line.
    fn refusal(&mut self, mistake: Mistake) -> Mistakes {
        self.refuse(mistake.found, mistake.accepted);
        std::mem::take(&mut self.mistakes)
    }

    fn read_atom(&mut self, style: &AtomStyle, words: &[&str]) -> Result<(), String> {
        let atom = style.split(words).ok_or_else(|| style.accepted())?;
        let id = atom.id.parse::<u64>().map_err(|_| style.accepted())?;
        let kind = self.kinds[0].place(atom.kind).ok_or_else(|| self.accepted_type(0))?;
        let position = vector(atom.position, |word| word.parse().ok()).ok_or_else(|| style.accepted())?;
        // There are three, or none.
        let image = (!atom.images.is_empty()).then(|| vector(atom.images, |word| word.parse().ok()));
        let accepted = "images, whole numbers from -2147483648 to 2147483647";
        let image = image.map(|image| image.ok_or(accepted)).transpose()?;
        // A style has finite numbers.
        if let Some(charge) = atom.charge.and_then(|word| word.parse().ok()) {
            self.charges.add(kind as usize, charge, || id.to_string());
        }
        self.atoms.push(Atom { id, kind, position, image });
        Ok(())
    }

    /// Velocities of the atoms with these ids, and what keeps them from being used.
    fn velocities(&self, ids: &[u64]) -> (Vec<[f64; 3]>, Vec<Mistake>) {
        if self.velocities.is_empty() {
            return (Vec::new(), Vec::new());
        }
        let mut velocities = vec![None; ids.len()];
        let (mut strange, mut again) = (Tally::default(), Tally::default());
        for (id, velocity) in &self.velocities {
            match ids.binary_search(id).map(|place| &mut velocities[place]) {
                Ok(known @ None) => *known = Some(*velocity),
                Ok(Some(_)) => again.add(|| id.to_string()),
                Err(_) => strange.add(|| id.to_string()),
            }
        }
        let missing = ids.iter().zip(&velocities).filter(|(_, velocity)| velocity.is_none());
        let missing: Tally = missing.map(|(id, _)| id).collect();
        let accepted =
            "one line for every atom of the section `Atoms`; or `velocities` that are \"thermal\" or \"rest\"";
        let found = [
            strange.phrase("atom").map(|atoms| format!("found velocities of {atoms}, not in `Atoms`")),
            again.phrase("atom").map(|atoms| format!("found more than one velocity of {atoms}")),
            missing.phrase("atom").map(|atoms| format!("found no velocity of {atoms}")),
        ];
        let mistakes = found.into_iter().flatten().map(|found| Mistake::new("", found, accepted)).collect();
        (velocities.into_iter().map(Option::unwrap_or_default).collect(), mistakes)
    }

    fn finish(mut self) -> Result<ParticleFile, Mistakes> {
        // What a line that is refused should have said is missing elsewhere.
        std::mem::take(&mut self.mistakes).refuse()?;
        self.atoms.sort_by_key(|atom| atom.id);
        let pairs = self.atoms.windows(2);
        let again: Tally = pairs.filter(|pair| pair[0].id == pair[1].id).map(|pair| pair[0].id).collect();
        self.mistakes.extend(again.mistake("atom", "more than once", "an id of its own for every atom"));
        let numbers: Vec<u64> = self.atoms.iter().map(|atom| atom.id).collect();
        let place = |id: u64| numbers.binary_search(&id).ok();
        let (velocities, velocity_mistakes) = self.velocities(&numbers);
        let bonds = links(&self.kinds[1], &self.bonds, "bond", &place, &mut self.mistakes);
        let angles = links(&self.kinds[2], &self.angles, "angle", &place, &mut self.mistakes);
        let with_images = self.atoms.iter().filter(|atom| atom.image.is_some()).count();
        if with_images > 0 && with_images < self.atoms.len() {
            let found = format!("found images of {with_images} of {} atoms", self.atoms.len());
            self.mistakes.push(Mistake::new("", found, "images of all atoms, or of none"));
        }
        if self.atoms.is_empty() && self.mistakes.is_empty() && self.header.count("atoms") > 0 {
            self.mistakes.push(Mistake::new("", "there are no atoms", FORMATS));
        }
        self.mistakes.refuse()?;
        self.masses.resize(self.kinds[0].count as usize, None);
        let (charges, charge_mistakes) = self.charges.finish(&self.kinds[0].names());
        let bounds = self.header.bounds.map(Option::unwrap_or_default);
        Ok(ParticleFile {
            species: self.kinds[0].names(),
            labelled: !self.kinds[0].labels.is_empty(),
            types: self.atoms.iter().map(|atom| atom.kind).collect(),
            masses: self.masses,
            charges,
            charge_mistakes,
            origin: bounds.map(|[low, _]| low),
            lengths: Some(bounds.map(|[low, high]| high - low)),
            positions: self.atoms.iter().map(|atom| atom.position).collect(),
            velocities,
            velocity_mistakes,
            images: self.atoms.iter().filter_map(|atom| atom.image).collect(),
            bonds,
            angles,
            unused: self.header.unused,
            numbers,
            ..ParticleFile::default()
        })
    }
}

/// Bonds or angles by type, with places in place of ids.
fn links<const LENGTH: usize>(
    types: &Types,
    all: &[([u64; LENGTH], u32)],
    noun: &str,
    place: &impl Fn(u64) -> Option<usize>,
    mistakes: &mut Mistakes,
) -> Vec<Links<LENGTH>> {
    let mut missing = Tally::default();
    let mut found: Vec<Links<LENGTH>> =
        types.names().into_iter().map(|name| Links { name, members: Vec::new() }).collect();
    for (ids, kind) in all {
        let places = ids.map(place);
        if places.contains(&None) {
            missing.add(|| ids.map(|id| id.to_string()).join("-"));
        } else {
            found[*kind as usize].members.push(places.map(|place| place.unwrap_or(0) as u32));
        }
    }
    mistakes.extend(missing.mistake(noun, "of atoms that are not there", "ids of the section `Atoms`"));
    found
}
