//! What files of WGSL declare, and the comments on it.

/// Something that a file declares.
pub struct Declared {
    /// Its name.
    pub name: String,
    /// The type that follows the name, if one does.
    pub of: String,
    /// The first sentence of the comment on it, if it has one.
    pub comment: Option<String>,
}

/// Kernels of a file, with the comment above each, or else that of the file.
pub fn kernels(text: &str) -> Vec<(String, String)> {
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

/// Constants of a file that the host sets, with the comment after each or above it.
pub fn constants(text: &str) -> Vec<Declared> {
    let mut found = Vec::new();
    let mut before = 0;
    for line in text.lines() {
        if let Some((name, rest)) = line.strip_prefix("override ").and_then(|rest| rest.split_once(':')) {
            let (of, rest) = rest.split_once(';').unwrap_or((rest, ""));
            let of = of.split('=').next().unwrap_or_default().trim().to_owned();
            let after = rest.trim_start().strip_prefix("//").map(|comment| escaped(comment.trim()));
            // A comment above several constants is on all of them, and that with which a file begins on the file.
            let next = text[before..].lines().nth(1).unwrap_or_default();
            let alone = text[..before].contains("\n\n") && !text[..before].ends_with("\n\n");
            let above = || comment_above(&text[..before]).filter(|_| alone && !next.starts_with("override "));
            found.push(Declared { name: name.trim().to_owned(), of, comment: after.or_else(above) });
        }
        before += line.len() + 1;
    }
    found
}

/// Names and types of the arrays in buffers and textures that a file declares.
pub fn arrays(text: &str) -> impl Iterator<Item = (&str, &str)> {
    text.lines().filter_map(|line| {
        let (head, of) = line.strip_prefix("var")?.split_once(':')?;
        let (space, name) = head.rsplit_once(' ')?;
        let (of, _) = of.trim_start().split_once(';')?;
        (of.starts_with("texture_storage") || space.starts_with("<storage")).then_some((name, of))
    })
}

/// Words of a texel of the textures that a file declares.
pub fn texel_words(text: &str) -> impl Iterator<Item = (&str, u32)> {
    text.lines().filter_map(|line| {
        let (name, format) = line.strip_prefix("var ")?.split_once(": texture_storage_2d<")?;
        let words = [("r32", 1), ("rg32", 2), ("rgba32", 4)];
        words.into_iter().find(|(start, _)| format.starts_with(&format!("{start}uint"))).map(|(_, words)| (name, words))
    })
}

/// The comment that ends where a text ends.
fn comment_above(text: &str) -> Option<String> {
    let lines: Vec<&str> = text.trim_end().lines().rev().take_while(|line| line.starts_with("//")).collect();
    (!lines.is_empty()).then(|| first_sentence(&lines.into_iter().rev().collect::<Vec<_>>().join("\n")))
}

/// The first sentence of the comment with which a text begins.
pub fn first_sentence(text: &str) -> String {
    let comment =
        text.lines().take_while(|line| line.starts_with("//")).map(|line| line.trim_start_matches('/').trim());
    let comment = comment.collect::<Vec<_>>().join(" ");
    let end = comment.find(". ").map_or(comment.len(), |end| end + 1);
    let sentence = escaped(comment[..end].trim());
    if sentence.is_empty() { "Without a comment.".to_owned() } else { sentence }
}

/// A comment as documentation.
fn escaped(comment: &str) -> String {
    comment.replace('[', "\\[").replace(']', "\\]").replace('<', "\\<")
}
