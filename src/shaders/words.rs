//! The words of a WGSL text: what looks like a name, outside comments, and what stands around it.

/// A word and what stands around it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Word<'a> {
    /// The word.
    pub text: &'a str,
    /// Whether a dot precedes it: a member or a swizzle.
    pub member: bool,
    /// Whether `@` precedes it, or it is an argument of an attribute.
    pub attribute: bool,
    /// Whether a colon follows it: a member of a structure, a parameter, or a variable with its type.
    pub typed: bool,
    /// Whether `&` precedes it.
    pub referenced: bool,
    /// Whether it stands in angle brackets that follow `var`.
    pub in_template: bool,
}

/// The words of a text, in order.
pub fn words(text: &str) -> impl Iterator<Item = Word<'_>> {
    let bytes = text.as_bytes();
    let starts = |byte: u8| byte.is_ascii_alphabetic() || byte == b'_';
    let continues = |byte: u8| byte.is_ascii_alphanumeric() || byte == b'_';
    let (mut at, mut before, mut in_attribute, mut after_var, mut in_template) = (0, None, 0_u32, false, false);
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
                    attribute: before == Some(b'@') || in_attribute > 0,
                    typed: rest.first() == Some(&b':') && in_attribute == 0,
                    referenced: before == Some(b'&'),
                    in_template,
                };
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
