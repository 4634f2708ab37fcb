//! Chemical symbols, the names of species in files of programs that know nothing else.

/// The symbols of all elements by their number, from 1.
const SYMBOLS: [&str; 118] = [
    "H", "He", "Li", "Be", "B", "C", "N", "O", "F", "Ne", "Na", "Mg", "Al", "Si", "P", "S", "Cl", "Ar", "K", "Ca",
    "Sc", "Ti", "V", "Cr", "Mn", "Fe", "Co", "Ni", "Cu", "Zn", "Ga", "Ge", "As", "Se", "Br", "Kr", "Rb", "Sr", "Y",
    "Zr", "Nb", "Mo", "Tc", "Ru", "Rh", "Pd", "Ag", "Cd", "In", "Sn", "Sb", "Te", "I", "Xe", "Cs", "Ba", "La", "Ce",
    "Pr", "Nd", "Pm", "Sm", "Eu", "Gd", "Tb", "Dy", "Ho", "Er", "Tm", "Yb", "Lu", "Hf", "Ta", "W", "Re", "Os", "Ir",
    "Pt", "Au", "Hg", "Tl", "Pb", "Bi", "Po", "At", "Rn", "Fr", "Ra", "Ac", "Th", "Pa", "U", "Np", "Pu", "Am", "Cm",
    "Bk", "Cf", "Es", "Fm", "Md", "No", "Lr", "Rf", "Db", "Sg", "Bh", "Hs", "Mt", "Ds", "Rg", "Cn", "Nh", "Fl", "Mc",
    "Lv", "Ts", "Og",
];

/// What stands for an atom of no element.
const UNKNOWN: &str = "X";

/// A symbol for every species: its own name where that is one, else the next that no species is named by; `X` if all are
/// taken.
pub(crate) fn symbols(names: &[&str]) -> Vec<&'static str> {
    let own = |name: &str| SYMBOLS.iter().copied().find(|symbol| *symbol == name);
    let mut free = SYMBOLS.iter().copied().filter(|symbol| !names.contains(symbol));
    names.iter().map(|name| own(name).or_else(|| free.next()).unwrap_or(UNKNOWN)).collect()
}

/// The symbol of an element by its number.
pub(super) fn symbol(number: u32) -> Option<&'static str> {
    SYMBOLS.get(number.checked_sub(1)? as usize).copied()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn elements_keep_their_names_and_all_others_get_one() {
        assert_eq!(symbols(&["A", "H", "B", "water", "Na"]), ["He", "H", "B", "Li", "Na"]);
        assert_eq!(symbols(&["h", "NA", ""]), ["H", "He", "Li"]);
        let many: Vec<String> = (0..130).map(|number| format!("species {number}")).collect();
        let many: Vec<&str> = many.iter().map(String::as_str).collect();
        let found = symbols(&many);
        assert_eq!((found[0], found[117], found[118]), ("H", "Og", "X"));
        assert_eq!([0, 1, 6, 118, 119].map(symbol), [None, Some("H"), Some("C"), Some("Og"), None]);
    }
}
