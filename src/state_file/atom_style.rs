//! Styles of the atoms of a LAMMPS data file: which columns a line has, <https://docs.lammps.org/read_data.html>.

use super::{Mistake, quoted, shortened};
use std::fmt;

/// A column of a line of an atom; a place has three.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Column {
    Id,
    Kind,
    Place,
    Molecule,
    Charge,
    Density,
}

use Column::{Charge, Density, Id, Kind, Molecule, Place};

/// The styles that are read, with their columns.
const READ: [(&str, &[Column]); 7] = [
    ("atomic", &[Id, Kind, Place]),
    ("bond", &[Id, Molecule, Kind, Place]),
    ("angle", &[Id, Molecule, Kind, Place]),
    ("molecular", &[Id, Molecule, Kind, Place]),
    ("charge", &[Id, Kind, Charge, Place]),
    ("full", &[Id, Molecule, Kind, Charge, Place]),
    ("mdpd", &[Id, Kind, Density, Place]),
];

/// Other styles, of atoms that have more than a scene can hold.
const UNREAD: &str = "\
    amoeba apip body bpm/sphere dielectric dipole dpd edpd electron ellipsoid line mesont oxdna peri rheo \
    rheo/thermal smd sph sphere sphere/temp spin tdpd template tri wavepacket meso";

/// The style of which others are made.
pub(super) const HYBRID: &str = "hybrid";

/// What a line of an atom has.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct AtomStyle {
    pub(super) name: String,
    pub(super) columns: Vec<Column>,
}

/// The words of a line by what they are.
pub(super) struct Words<'a, 'b> {
    pub id: &'a str,
    pub kind: &'a str,
    pub charge: Option<&'a str>,
    pub position: &'b [&'a str],
    /// Three, or none.
    pub images: &'b [&'a str],
}

impl fmt::Display for AtomStyle {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str(&self.name)
    }
}

impl AtomStyle {
    /// The style of a name, which for `hybrid` are several.
    pub(crate) fn of(name: &str) -> Result<Self, Mistake> {
        let words: Vec<&str> = name.split_ascii_whitespace().collect();
        let columns = |word: &str| READ.iter().find(|(known, _)| *known == word).map(|(_, columns)| *columns);
        let unread = |word: &str| {
            let accepted = format!(
                "the styles {}, and `{HYBRID}` of these: others have more than a place, a type and a charge",
                quoted(READ.into_iter().map(|(name, _)| name))
            );
            Mistake::new("", format!("found atoms of the style `{}`", shortened(word)), accepted)
        };
        match words.as_slice() {
            [HYBRID] => {
                let accepted = "`atom_style` in `state` with all of them, in the order of the input script, such as \"hybrid full mdpd\"";
                Err(Mistake::new("", "found atoms of the style `hybrid`, and not which styles it is made of", accepted))
            }
            [HYBRID, parts @ ..] => {
                let mut all = vec![Id, Kind, Place];
                for part in parts {
                    for column in columns(part).ok_or_else(|| unread(part))? {
                        // What several styles have is there once.
                        if !all.contains(column) {
                            all.push(*column);
                        }
                    }
                }
                Ok(Self { name: words.join(" "), columns: all })
            }
            [word] => {
                Ok(Self { name: (*word).to_owned(), columns: columns(word).ok_or_else(|| unread(word))?.to_vec() })
            }
            _ => Err(unread(name)),
        }
    }

    /// The style that a comment names, if it does: a word alone may be one that is not known here, unless the scene has said which it is.
    pub(super) fn in_comment(comment: &str, is_given: bool) -> Option<&str> {
        let word = comment.split_ascii_whitespace().next()?;
        // The package KOKKOS has the same under names of its own.
        let first = word.strip_suffix("/kk").unwrap_or(word);
        if first == HYBRID {
            return Some(comment);
        }
        let is_known = READ.iter().any(|(name, _)| *name == first) || UNREAD.split(' ').any(|name| name == first);
        (is_known || word == comment && !is_given).then_some(first)
    }

    /// The only style with lines of so many columns: others may have as many as `atomic` has with images.
    pub(super) fn of_columns(count: usize) -> Result<Self, Mistake> {
        if count == 5 {
            return Self::of("atomic");
        }
        let width = |columns: &[Column]| columns.iter().map(|column| column.width()).sum();
        let fits = |columns: &[Column]| [0, 3].contains(&count.wrapping_sub(width(columns)));
        let fitting = READ.into_iter().filter(|(_, columns)| fits(columns));
        let names: Vec<&str> = fitting.map(|(name, _)| name).collect();
        let example = names.first().unwrap_or(&"full");
        let among = match names.as_slice() {
            [] => String::new(),
            [only] => format!(", as `{only}` has, and others"),
            names => format!(", as {} have, and others", quoted(names.iter().copied())),
        };
        let accepted = format!(
            "`\"atom_style\": \"{example}\"` in `state`, or `Atoms # {example}` in the file, with the style that its lines are of"
        );
        Err(Mistake::new("", format!("found `Atoms` without a style, and {count} columns{among}"), accepted))
    }

    /// What its lines have that no scene uses, in words.
    pub(super) fn unused(&self) -> Vec<String> {
        let noun = |column: &Column| match column {
            Density => Some("densities".to_owned()),
            _ => None,
        };
        self.columns.iter().filter_map(noun).collect()
    }

    /// What a line of it has to be.
    pub(super) fn accepted(&self) -> String {
        let names = self.columns.iter().map(|column| match column {
            Id => "an id",
            Kind => "a type",
            Place => "a position",
            Molecule => "a molecule",
            Charge => "a charge",
            Density => "a density",
        });
        format!("{} (style `{}`), and three images or none", names.collect::<Vec<_>>().join(", "), self.name)
    }

    /// Divides a line; none where it has not these columns, or what no scene uses is not what it should be.
    pub(super) fn split<'a, 'b>(&self, words: &'b [&'a str]) -> Option<Words<'a, 'b>> {
        let mut found = Words { id: "", kind: "", charge: None, position: &[], images: &[] };
        let mut rest = words;
        for column in &self.columns {
            let (here, after) = rest.split_at_checked(column.width())?;
            match column {
                Id => found.id = here[0],
                Kind => found.kind = here[0],
                Place => found.position = here,
                Molecule => _ = here[0].parse::<i64>().ok()?,
                Charge | Density => {
                    here[0].parse::<f64>().ok().filter(|number| number.is_finite())?;
                    if *column == Charge {
                        found.charge = Some(here[0]);
                    }
                }
            }
            rest = after;
        }
        found.images = rest;
        [0, 3].contains(&rest.len()).then_some(found)
    }
}

impl Column {
    fn width(self) -> usize {
        if self == Place { 3 } else { 1 }
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    /// <https://docs.lammps.org/read_data.html>: values that are not standard follow the place, style by style, each once.
    #[test]
    fn hybrid_styles_have_their_columns_behind_the_place() {
        let line = ["7", "2", "1.5", "2.5", "3.5", "-0.25", "11", "0.125", "0", "-1", "2"];
        let style = AtomStyle::of("hybrid charge full mdpd").unwrap();
        let words = style.split(&line).unwrap();
        assert_eq!((words.id, words.kind, words.position, words.charge), ("7", "2", &line[2..5], Some("-0.25")));
        assert_eq!(words.images, ["0", "-1", "2"]);
        assert_eq!(style.unused(), ["densities"]);
        assert!(style.split(&line[..8]).unwrap().images.is_empty());
        for count in [7, 9, 10] {
            assert!(style.split(&line[..count]).is_none(), "{count}");
        }
        // A molecule has no fraction.
        assert!(AtomStyle::of("hybrid full mdpd").unwrap().split(&line[..8]).is_none());
    }

    #[test]
    fn styles_are_known_by_their_names_and_never_guessed() {
        let full = AtomStyle::of("full").unwrap();
        let line = ["1", "4", "2", "0.5", "1", "2", "3"];
        assert_eq!(full.split(&line).map(|words| (words.kind, words.position.len())), Some(("2", 3)));
        assert_eq!(
            full.accepted(),
            "an id, a molecule, a type, a charge, a position (style `full`), and three images or none"
        );
        for is_given in [false, true] {
            let named = |comment| AtomStyle::in_comment(comment, is_given);
            assert_eq!(["full of atoms", "hybrid full mdpd"].map(named), [Some("full"), Some("hybrid full mdpd")]);
            assert_eq!(named("angle/kk"), Some("angle"));
            assert_eq!(["", "all of them", "mine"].map(named), [None, None, (!is_given).then_some("mine")]);
        }
        assert_eq!(AtomStyle::of_columns(5).unwrap().name, "atomic");
        for (count, names) in [
            (6, "`bond`, `angle`, `molecular`, `charge`, `mdpd` have"),
            (7, "`full` has"),
            (8, "`atomic` has"),
            (9, "`bond`, `angle`, `molecular`, `charge`, `mdpd` have"),
            (10, "`full` has"),
        ] {
            let mistake = AtomStyle::of_columns(count).unwrap_err();
            assert_eq!(
                mistake.found,
                format!("found `Atoms` without a style, and {count} columns, as {names}, and others")
            );
            assert!(mistake.accepted.starts_with("`\"atom_style\": \""), "{}", mistake.accepted);
        }
        assert_eq!(AtomStyle::of_columns(12).unwrap_err().found, "found `Atoms` without a style, and 12 columns");
        for (name, found) in [
            ("body", "found atoms of the style `body`"),
            ("hybrid full sphere", "found atoms of the style `sphere`"),
            ("hybrid", "found atoms of the style `hybrid`, and not which styles it is made of"),
            ("", "found atoms of the style ``"),
        ] {
            assert_eq!(AtomStyle::of(name).unwrap_err().found, found);
        }
    }
}
