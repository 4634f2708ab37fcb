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
    let meaning = SYMBOLS.iter().find(|(symbol, _)| *symbol == word).map(|(_, key)| *key);
    let mut best = (0.0, None);
    for candidate in candidates {
        if meaning == Some(candidate) {
            return Some(candidate.to_owned());
        }
        let lower = candidate.to_lowercase();
        // One slip in a short name is a small likeness, but a likely slip.
        let one_slip = word.len() > 2 && strsim::damerau_levenshtein(&word, &lower) == 1;
        let likeness = strsim::jaro_winkler(&word, &lower).max(if one_slip { 0.9 } else { 0.0 });
        if likeness > best.0 {
            best = (likeness, Some(candidate));
        }
    }
    best.1.filter(|_| best.0 >= 0.8).map(str::to_owned)
}
