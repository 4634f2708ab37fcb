//! Numbers with their errors, as they stand in legends and subtitles.

use super::ticks::{number, short_number, superscript};

/// A value with its standard error to the second digit of the error; without an error, to four digits.
///
/// ```
/// use mesoscope::plot::with_error;
/// assert_eq!(with_error(23.63512, Some(0.0213)), "23.635 ± 0.021");
/// assert_eq!(with_error(-1.2345e-7, Some(1.2e-9)), "(−1.235 ± 0.012)×10⁻⁷");
/// assert_eq!(with_error(1.23456, None), "1.235");
/// ```
#[must_use]
pub fn with_error(value: f64, standard_error: Option<f64>) -> String {
    let Some(error) = standard_error.filter(|error| error.is_finite() && *error > 0.0 && value.is_finite()) else {
        return if value.is_finite() {
            short_number(format!("{value:.3e}").parse().unwrap_or(value))
        } else {
            "not known".to_owned()
        };
    };
    let largest = value.abs().max(error).log10().floor() as i32;
    let factor = if (-4..6).contains(&largest) { 0 } else { largest };
    let scale = 10_f64.powi(-factor.clamp(-300, 300));
    let (value, error) = (value * scale, error * scale);
    let decimals = (1.0 - error.log10().floor()).clamp(0.0, 12.0) as usize;
    let text = format!("{} ± {}", number(value, decimals), number(error, decimals));
    if factor == 0 { text } else { format!("({text})×10{}", superscript(factor)) }
}
