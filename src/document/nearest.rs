//! "Did you mean": the accepted name closest to what was written.

/// Common symbols that people write for a key that is spelled out here.
const SYMBOLS: [(&str, &str); 11] = [
    ("a", "repulsion"),
    ("density", "number_density"),
    ("dt", "step"),
    ("gamma", "friction"),
    ("kt", "temperature"),
    ("n", "count"),
    ("nsteps", "steps"),
    ("r_c", "cutoff"),
    ("rc", "cutoff"),
    ("rho", "number_density"),
    ("timestep", "step"),
];

/// The longest word that is compared; the time grows with the product of two lengths.
const LONGEST: usize = 64;

/// The most candidates that are compared.
const MOST: usize = 512;

/// The candidate most similar to `word`, if any is similar.
pub(crate) fn nearest<'a>(word: &str, candidates: impl IntoIterator<Item = &'a str>) -> Option<String> {
    if word.len() > LONGEST {
        return None;
    }
    let word = word.to_lowercase();
    let mut best = (0.0, None);
    for candidate in candidates.into_iter().filter(|candidate| candidate.len() <= LONGEST).take(MOST) {
        let symbols = SYMBOLS.iter().filter(|(_, key)| *key == candidate).map(|(symbol, _)| *symbol);
        // A symbol of two letters with a slip is another symbol.
        let meant = symbols.filter(|symbol| symbol.len() > 2 || *symbol == word).map(|symbol| likeness(&word, symbol));
        let likeness = meant.fold(likeness(&word, &candidate.to_lowercase()), f64::max);
        if likeness > best.0 {
            best = (likeness, Some(candidate));
        }
    }
    best.1.filter(|_| best.0 >= 0.8).map(str::to_owned)
}

/// From 0, nothing in common, to 1, the same.
fn likeness(word: &str, name: &str) -> f64 {
    // One slip in a short name is a small likeness, but a likely slip.
    let one_slip = word.len() > 2 && strsim::damerau_levenshtein(word, name) == 1;
    strsim::jaro_winkler(word, name).max(if one_slip { 0.9 } else { 0.0 })
}
