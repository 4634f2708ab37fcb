//! The order of versions of the program: that of Semantic Versioning 2.0.0, paragraph 11.

use std::cmp::Ordering;

/// A version; what follows `+` has no part in the order.
#[derive(Debug, PartialEq, Eq)]
pub(super) struct Version<'a> {
    numbers: [u64; 3],
    /// What follows `-`, between its dots; empty for a release.
    before: Vec<&'a str>,
}

impl<'a> Version<'a> {
    /// Reads `major.minor.patch`, with or without `-pre.release` and `+build`.
    pub(super) fn parse(text: &'a str) -> Option<Self> {
        let version = text.split_once('+').map_or(text, |(version, _)| version);
        let (numbers, before) = version.split_once('-').map_or((version, None), |(numbers, pre)| (numbers, Some(pre)));
        let number = |part: &str| is_number(part).then(|| part.parse().ok()).flatten();
        let numbers = numbers.split('.').map(number).collect::<Option<Vec<u64>>>()?.try_into().ok()?;
        let before: Vec<&str> = before.map(|before| before.split('.').collect()).unwrap_or_default();
        let is_identifier = |part: &&str| {
            !part.is_empty() && part.chars().all(|letter| letter.is_ascii_alphanumeric() || letter == '-')
        };
        before.iter().all(is_identifier).then_some(Self { numbers, before })
    }

    /// Whether it comes after another.
    pub(super) fn is_later(&self, other: &Self) -> bool {
        let pre_releases = || match (self.before.is_empty(), other.before.is_empty()) {
            (true, true) => Ordering::Equal,
            (true, false) => Ordering::Greater,
            (false, true) => Ordering::Less,
            (false, false) => {
                let mut pairs = self.before.iter().zip(&other.before).map(|(one, other)| order(one, other));
                pairs.find(|order| order.is_ne()).unwrap_or_else(|| self.before.len().cmp(&other.before.len()))
            }
        };
        self.numbers.cmp(&other.numbers).then_with(pre_releases).is_gt()
    }
}

fn is_number(text: &str) -> bool {
    !text.is_empty() && text.bytes().all(|digit| digit.is_ascii_digit())
}

/// Numbers come before words.
fn order(one: &str, other: &str) -> Ordering {
    match (is_number(one), is_number(other)) {
        (true, true) => one.len().cmp(&other.len()).then_with(|| one.cmp(other)),
        (one_is, other_is) => other_is.cmp(&one_is).then_with(|| one.cmp(other)),
    }
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
                assert_eq!(one.is_later(other), place > other_place, "{} {}", order[place], order[other_place]);
            }
        }
        assert_eq!(Version::parse("1.0.0+one"), Version::parse("1.0.0+other"));
        for text in ["latest", "", "1", "1.0", "1.0.0.0", "1.0.x", "+1.0.0", "1.0.0-", "1.0.0-a..b", "-1.0.0"] {
            assert_eq!(Version::parse(text), None, "{text}");
        }
    }
}
