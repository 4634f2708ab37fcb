//! Numbers as text, for tables, messages and pictures.

use std::io::Write as _;

/// A value with its standard error to the second digit of the error; without an error, to four digits.
///
/// ```
/// use mesoscope::numbers::with_error;
///
/// assert_eq!(with_error(23.63512, Some(0.0213)), "23.635 ± 0.021");
/// assert_eq!(with_error(1234.5, Some(120.0)), "1234 ± 120");
/// assert_eq!(with_error(-1.2345e-7, Some(1.2e-9)), "(−1.235 ± 0.012)×10⁻⁷");
/// assert_eq!(with_error(1.23456, None), "1.235");
/// assert_eq!(with_error(1.0, Some(0.0)), "1");
/// ```
#[must_use]
pub fn with_error(value: f64, standard_error: Option<f64>) -> String {
    let Some(error) = standard_error.filter(|error| error.is_finite() && *error > 0.0 && value.is_finite()) else {
        return if value.is_finite() {
            short(format!("{value:.3e}").parse().unwrap_or(value))
        } else {
            "not known".to_owned()
        };
    };
    let largest = value.abs().max(error).log10().floor() as i32;
    let factor = if (-4..6).contains(&largest) { 0 } else { largest };
    let scale = 10_f64.powi(-factor.clamp(-300, 300));
    let (value, error) = (value * scale, error * scale);
    let decimals = (1.0 - error.log10().floor()).clamp(0.0, 12.0) as usize;
    let text = format!("{} ± {}", fixed(value, decimals), fixed(error, decimals));
    if factor == 0 { text } else { format!("({text})×10{}", superscript(factor)) }
}

/// A number with this many decimals and a minus sign as it is printed; never `−0`.
///
/// ```
/// assert_eq!(mesoscope::numbers::fixed(-0.25, 1), "−0.2");
/// assert_eq!(mesoscope::numbers::fixed(-0.01, 1), "0.0");
/// ```
#[must_use]
pub fn fixed(value: f64, decimals: usize) -> String {
    let text = format!("{value:.decimals$}");
    match text.strip_prefix('-') {
        Some(digits) if digits.chars().any(|c| c.is_ascii_digit() && c != '0') => format!("−{digits}"),
        Some(digits) => digits.to_owned(),
        None => text,
    }
}

/// A round number as short as it can be written.
///
/// ```
/// assert_eq!(mesoscope::numbers::short(0.05), "0.05");
/// assert_eq!(mesoscope::numbers::short(2e7), "2×10⁷");
/// ```
#[must_use]
pub fn short(value: f64) -> String {
    let exponent = value.abs().log10().floor() as i32;
    if value != 0.0 && !(-4..6).contains(&exponent) {
        return format!("{}×10{}", trimmed(&fixed(value / 10_f64.powi(exponent), 6)), superscript(exponent));
    }
    trimmed(&fixed(value, 6))
}

/// A number rounded to three digits, as short as it can be.
///
/// ```
/// use mesoscope::numbers::three_digits;
/// assert_eq!([0.132_629, 1.0, 288.54].map(three_digits), ["0.133", "1", "289"]);
/// ```
#[must_use]
pub fn three_digits(value: f64) -> String {
    short(format!("{value:.2e}").parse().unwrap_or(value))
}

/// A number to six digits, as in source code.
///
/// ```
/// assert_eq!(mesoscope::numbers::six_digits(1.25), "1.25");
/// assert_eq!(mesoscope::numbers::six_digits(1.0 / 3e9), "3.33333e-10");
/// ```
#[must_use]
pub fn six_digits(value: f64) -> String {
    let magnitude = value.abs();
    if value == value.trunc() && magnitude < 1e15 {
        format!("{value}")
    } else if (1e-3..1e6).contains(&magnitude) {
        format!("{value:.6}").trim_end_matches('0').to_owned()
    } else {
        format!("{value:.5e}")
    }
}

/// A decimal fraction without zeros at its end.
pub(crate) fn trimmed(text: &str) -> String {
    if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.').to_owned() } else { text.to_owned() }
}

/// An exponent in raised digits.
///
/// ```
/// assert_eq!(mesoscope::numbers::superscript(-12), "⁻¹²");
/// ```
#[must_use]
pub fn superscript(exponent: i32) -> String {
    exponent
        .to_string()
        .chars()
        .map(|character| match character {
            '-' => '⁻',
            '1' => '¹',
            '2' => '²',
            '3' => '³',
            digit => char::from_u32(0x2070 + digit.to_digit(10).unwrap_or(0)).unwrap_or(digit),
        })
        .collect()
}

/// A whole number with its digits in groups of three if they are more than four.
///
/// ```
/// assert_eq!(mesoscope::numbers::grouped(1234), "1234");
/// assert_eq!(mesoscope::numbers::grouped(1_234_567), "1,234,567");
/// ```
#[must_use]
pub fn grouped(number: u64) -> String {
    let digits = number.to_string();
    if digits.len() < 5 {
        return digits;
    }
    let mut text = String::new();
    for (index, digit) in digits.chars().enumerate() {
        if index > 0 && (digits.len() - index).is_multiple_of(3) {
            text.push(',');
        }
        text.push(digit);
    }
    text
}

/// So many of something, in the singular where it is one.
///
/// ```
/// assert_eq!(mesoscope::numbers::counted(1, "particle"), "1 particle");
/// assert_eq!(mesoscope::numbers::counted(0, "particle"), "0 particles");
/// ```
#[must_use]
pub fn counted(count: u64, noun: &str) -> String {
    format!("{count} {noun}{}", if count == 1 { "" } else { "s" })
}

/// The same with digits in groups of three.
///
/// ```
/// assert_eq!(mesoscope::numbers::counted_in_groups(24_000, "particle"), "24,000 particles");
/// ```
#[must_use]
pub fn counted_in_groups(count: u64, noun: &str) -> String {
    format!("{} {noun}{}", grouped(count), if count == 1 { "" } else { "s" })
}

/// A rate with three digits and the prefix of its unit.
///
/// ```
/// assert_eq!(mesoscope::numbers::prefixed(7_041_000.0), "7.04 M");
/// assert_eq!(mesoscope::numbers::prefixed(999_999.0), "1.00 M");
/// assert_eq!(mesoscope::numbers::prefixed(70.0), "70.0");
/// assert_eq!(mesoscope::numbers::prefixed(125_000.0), "125 k");
/// ```
#[must_use]
pub fn prefixed(value: f64) -> String {
    let scales = [(1e12, " T"), (1e9, " G"), (1e6, " M"), (1e3, " k")];
    // Half a unit of the last digit early, so that 999 999 becomes 1 M and not 1000 k.
    let (scale, prefix) = scales.into_iter().find(|(scale, _)| value >= 0.9995 * scale).unwrap_or((1.0, ""));
    let scaled = value / scale;
    let digits = if scaled >= 99.95 {
        0
    } else if scaled >= 9.995 {
        1
    } else {
        2
    };
    format!("{scaled:.digits$}{prefix}")
}

/// A number of bytes.
///
/// ```
/// assert_eq!(mesoscope::numbers::bytes(512), "512 B");
/// assert_eq!(mesoscope::numbers::bytes(1 << 20), "1.0 MiB");
/// ```
#[must_use]
pub fn bytes(count: u64) -> String {
    match count {
        0..1024 => format!("{count} B"),
        1024..1_048_576 => format!("{:.1} KiB", count as f64 / 1024.0),
        1_048_576..1_073_741_824 => format!("{:.1} MiB", count as f64 / 1_048_576.0),
        _ => format!("{:.2} GiB", count as f64 / 1_073_741_824.0),
    }
}

/// Appends the shortest digits that read back as the same `f64`; nothing for what is not finite.
pub(crate) fn push_exact(text: &mut Vec<u8>, value: f64) {
    let magnitude = value.abs();
    let written = if !value.is_finite() {
        Ok(())
    } else if magnitude == 0.0 || (1e-5..1e16).contains(&magnitude) {
        write!(text, "{value}")
    } else {
        write!(text, "{value:e}")
    };
    // Writing to memory does not fail.
    debug_assert!(written.is_ok());
}
