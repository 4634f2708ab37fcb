//! The words of a WGSL text: what looks like a name, outside comments, and what stands around it.

/// A word and what stands around it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[allow(clippy::struct_excessive_bools)]
pub(crate) struct Word<'a> {
    /// The word.
    pub text: &'a str,
    /// Whether a dot precedes it: a member or a swizzle.
    pub member: bool,
    /// Whether it is the name of an attribute, or an argument of one that names no constant: sizes of workgroups do.
    pub attribute: bool,
    /// Whether a colon follows it: a member of a structure, a parameter, or a variable with its type.
    pub typed: bool,
    /// Whether `&` precedes it.
    pub referenced: bool,
    /// Whether it stands in angle brackets that follow `var`.
    pub in_template: bool,
}

/// The words of a text, in order.
pub(crate) fn words(text: &str) -> impl Iterator<Item = Word<'_>> {
    let bytes = text.as_bytes();
    let starts = |byte: u8| byte.is_ascii_alphabetic() || byte == b'_';
    let continues = |byte: u8| byte.is_ascii_alphanumeric() || byte == b'_';
    let (mut at, mut before, mut in_attribute, mut sizes) = (0, None, 0_u32, false);
    let (mut after_var, mut in_template) = (false, false);
    std::iter::from_fn(move || {
        while at < bytes.len() {
            let byte = bytes[at];
            if byte == b'/' && bytes.get(at + 1) == Some(&b'/') {
                at = text[at..].find('\n').map_or(text.len(), |length| at + length);
                continue;
            }
            if byte.is_ascii_digit() {
                // A number with its suffix, 0xffu and 1e-5f included.
                while at < bytes.len() && (continues(bytes[at]) || bytes[at] == b'.') {
                    at += 1;
                }
                after_var = false;
                before = Some(b'0');
                continue;
            }
            if starts(byte) {
                let begin = at;
                while at < bytes.len() && continues(bytes[at]) {
                    at += 1;
                }
                let rest = text[at..].trim_start().as_bytes();
                let word = Word {
                    text: &text[begin..at],
                    member: before == Some(b'.'),
                    attribute: before == Some(b'@') || in_attribute > 0 && !sizes,
                    typed: rest.first() == Some(&b':') && in_attribute == 0,
                    referenced: before == Some(b'&'),
                    in_template,
                };
                if word.attribute {
                    sizes = word.text == "workgroup_size";
                }
                // The arguments of an attribute follow its name.
                before = if before == Some(b'@') { before } else { Some(b'a') };
                after_var = word.text == "var";
                return Some(word);
            }
            match byte {
                b'(' if before == Some(b'@') || in_attribute > 0 => in_attribute += 1,
                b')' if in_attribute > 0 => in_attribute -= 1,
                b'<' if after_var => in_template = true,
                b'>' => in_template = false,
                _ => {}
            }
            if !byte.is_ascii_whitespace() {
                before = Some(byte);
                after_var = false;
            }
            at += 1;
        }
        None
    })
}

#[cfg(test)]
mod tests {
    use super::words;

    #[test]
    fn words_are_names_outside_comments_and_numbers() {
        let text = "// not this.\n@group(0) var<storage> a: vec2<f32>; /* */ b.xy += 0xffu * &c[1e-5f]; // nor this";
        let found: Vec<&str> = words(text).map(|word| word.text).collect();
        assert_eq!(found, ["group", "var", "storage", "a", "vec2", "f32", "b", "xy", "c"]);
        let is = |name: &str| words(text).find(|word| word.text == name);
        assert!(is("group").is_some_and(|word| word.attribute) && is("storage").is_some_and(|word| word.in_template));
        assert!(is("a").is_some_and(|word| word.typed) && is("xy").is_some_and(|word| word.member));
        assert!(is("c").is_some_and(|word| word.referenced) && !is("b").is_some_and(|word| word.referenced));
    }

    #[test]
    fn sizes_of_workgroups_name_constants() {
        let text = "@compute @workgroup_size(LANES) fn f(@builtin(workgroup_id) group: vec3<u32>) {}";
        let names = |attribute| words(text).filter(move |word| word.attribute == attribute).map(|word| word.text);
        assert_eq!(names(true).collect::<Vec<_>>(), ["compute", "workgroup_size", "builtin", "workgroup_id"]);
        assert_eq!(names(false).collect::<Vec<_>>(), ["LANES", "fn", "f", "group", "vec3", "u32"]);
    }
}
