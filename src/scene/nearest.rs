//! "Did you mean": the accepted name closest to what was written.

/// Symbols of the field that people write for a key that is spelled out here.
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

/// The candidate most like `word`, if any is like it at all.
pub(super) fn nearest<'a>(word: &str, candidates: impl IntoIterator<Item = &'a str>) -> Option<String> {
    let word = word.to_lowercase();
    let mut best = (0.0, None);
    for candidate in candidates {
        let symbols = SYMBOLS.iter().filter(|(_, key)| *key == candidate).map(|(symbol, _)| *symbol);
        let likeness =
            symbols.map(|symbol| likeness(&word, symbol)).fold(likeness(&word, &candidate.to_lowercase()), f64::max);
        if likeness > best.0 {
            best = (likeness, Some(candidate));
        }
    }
    best.1.filter(|_| best.0 >= 0.8).map(str::to_owned)
}

/// From 0, nothing in common, to 1, the same.
fn likeness(word: &str, name: &str) -> f64 {
    // One slip in a short name is a small likeness, but a likely slip; in a symbol of two letters it is another one.
    if word.len().min(name.len()) < 3 {
        return f64::from(u8::from(word == name));
    }
    let one_slip = strsim::damerau_levenshtein(word, name) == 1;
    strsim::jaro_winkler(word, name).max(if one_slip { 0.9 } else { 0.0 })
}
