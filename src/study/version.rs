//! The order of versions of the program: that of Semantic Versioning 2.0.0, paragraph 11.

/// A version; what follows `+` has no part in the order.
#[derive(Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct Version<'a> {
    numbers: [u64; 3],
    /// A release comes after all that precede it.
    is_release: bool,
    /// The identifiers that follow `-`, between its dots.
    before: Vec<Identifier<'a>>,
}

/// A part of what precedes a release: numbers come before words.
#[derive(Debug, PartialEq, Eq, PartialOrd, Ord)]
enum Identifier<'a> {
    /// A number of any length, which comes first.
    Number(usize, &'a str),
    Word(&'a str),
}

impl<'a> Version<'a> {
    /// Reads `major.minor.patch`, with or without `-pre.release` and `+build`.
    pub(super) fn parse(text: &'a str) -> Option<Self> {
        let version = text.split_once('+').map_or(text, |(version, _)| version);
        let (numbers, before) = version.split_once('-').map_or((version, None), |(numbers, pre)| (numbers, Some(pre)));
        let number = |part: &str| is_number(part).then(|| part.parse().ok()).flatten();
        let numbers = numbers.split('.').map(number).collect::<Option<Vec<u64>>>()?.try_into().ok()?;
        let identifier = |part: &'a str| {
            let is_one = !part.is_empty() && part.chars().all(|letter| letter.is_ascii_alphanumeric() || letter == '-');
            let known = if is_number(part) { Identifier::Number(part.len(), part) } else { Identifier::Word(part) };
            is_one.then_some(known)
        };
        let parts = before.into_iter().flat_map(|before| before.split('.'));
        Some(Self { numbers, is_release: before.is_none(), before: parts.map(identifier).collect::<Option<_>>()? })
    }
}

fn is_number(text: &str) -> bool {
    !text.is_empty() && text.bytes().all(|digit| digit.is_ascii_digit())
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    #[test]
    fn versions_have_an_order() {
        let order = [
            "0.9.1",
            "0.10.0",
            "0.99.99",
            "1.0.0-alpha",
            "1.0.0-alpha.1",
            "1.0.0-alpha.beta",
            "1.0.0-beta.2",
            "1.0.0-beta.11",
            "1.0.0-rc.1",
            "1.0.0",
            "1.0.1-rc.1+build.5",
        ];
        let versions = order.map(|text| Version::parse(text).unwrap());
        for (place, one) in versions.iter().enumerate() {
            for (other_place, other) in versions.iter().enumerate() {
                assert_eq!(one > other, place > other_place, "{} {}", order[place], order[other_place]);
            }
        }
        assert_eq!(Version::parse("1.0.0+one"), Version::parse("1.0.0+other"));
        for text in ["latest", "", "1", "1.0", "1.0.0.0", "1.0.x", "+1.0.0", "1.0.0-", "1.0.0-a..b", "-1.0.0"] {
            assert_eq!(Version::parse(text), None, "{text}");
        }
    }
}
