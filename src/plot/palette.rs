//! Colours of paper, ink, series and scales; all sRGB.

use crate::scene::Theme;

/// A colour in sRGB with straight alpha.
pub(super) type Colour = [u8; 4];

/// Paper and inks of a theme.
#[derive(Debug, Clone, Copy)]
pub(super) struct Inks {
    pub paper: Colour,
    pub ink: Colour,
    /// Secondary text.
    pub muted: Colour,
    pub grid: Colour,
    /// Data that stand back.
    pub faint: Colour,
    /// Lines of one chart, most distinct first: colours that stay apart for colour-blind readers.
    pub series: [Colour; 7],
    /// The first species of a snapshot; areas bear lighter colours than lines do.
    pub species: [Colour; 8],
    /// The part of the scale that lines take: its other end would be lost on the paper.
    pub line_scale: [f64; 2],
}

const fn rgb(hex: u32) -> Colour {
    [(hex >> 16) as u8, (hex >> 8) as u8, hex as u8, 255]
}

// The eight colours of Okabe and Ito (2008), chosen for all common kinds of colour vision.
const ORANGE: Colour = rgb(0x00E6_9F00);
const SKY: Colour = rgb(0x0056_B4E9);
const GREEN: Colour = rgb(0x0000_9E73);
const YELLOW: Colour = rgb(0x00F0_E442);
const BLUE: Colour = rgb(0x0000_72B2);
const VERMILION: Colour = rgb(0x00D5_5E00);
const PURPLE: Colour = rgb(0x00CC_79A7);
/// In the place of their black. Grey is for all species together.
const BROWN: Colour = rgb(0x008B_5E3C);

/// The colours of a theme.
pub(super) fn inks(theme: Theme) -> Inks {
    let species = [BLUE, ORANGE, GREEN, PURPLE, SKY, VERMILION, YELLOW, BROWN];
    match theme {
        Theme::Light => Inks {
            paper: rgb(0x00FF_FFFF),
            ink: rgb(0x001A_1A1A),
            muted: rgb(0x0055_5555),
            grid: rgb(0x00E3_E3E3),
            faint: rgb(0x00AD_ADAD),
            series: [BLUE, VERMILION, rgb(0x001A_1A1A), GREEN, PURPLE, ORANGE, SKY],
            species,
            line_scale: [0.0, 0.86],
        },
        Theme::Dark => Inks {
            paper: rgb(0x0014_161A),
            ink: rgb(0x00EC_ECEC),
            muted: rgb(0x00A8_ACB3),
            grid: rgb(0x0034_373D),
            faint: rgb(0x0069_6E77),
            series: [SKY, ORANGE, rgb(0x00EC_ECEC), GREEN, PURPLE, YELLOW, VERMILION],
            species: [SKY, ORANGE, GREEN, PURPLE, BLUE, VERMILION, YELLOW, BROWN],
            line_scale: [0.28, 1.0],
        },
    }
}

/// The same colour, let through by `alpha` of 255.
pub(super) fn with_alpha(colour: Colour, alpha: u8) -> Colour {
    [colour[0], colour[1], colour[2], alpha]
}

/// Knots of a dark-blue to yellow scale whose lightness rises evenly.
const SPEED_KNOTS: [[f64; 3]; 9] = [
    [68.0, 1.0, 84.0],
    [71.0, 44.0, 122.0],
    [59.0, 81.0, 139.0],
    [44.0, 113.0, 142.0],
    [33.0, 144.0, 141.0],
    [39.0, 173.0, 129.0],
    [92.0, 200.0, 99.0],
    [170.0, 220.0, 50.0],
    [253.0, 231.0, 37.0],
];

/// Colour of a fraction of a perceptually uniform scale; fractions outside [0, 1] take the nearest end.
pub(super) fn scale_colour(fraction: f64) -> Colour {
    let last = SPEED_KNOTS.len() - 1;
    let position = if fraction.is_nan() { 0.0 } else { fraction.clamp(0.0, 1.0) * last as f64 };
    let knot = (position as usize).min(last - 1);
    let weight = position - knot as f64;
    let channel = |index: usize| {
        (SPEED_KNOTS[knot][index] + weight * (SPEED_KNOTS[knot + 1][index] - SPEED_KNOTS[knot][index])).round() as u8
    };
    [channel(0), channel(1), channel(2), 255]
}

/// Linear-light value of an sRGB channel.
pub(super) fn linear(channel: u8) -> f32 {
    let value = f32::from(channel) / 255.0;
    if value <= 0.04045 { value / 12.92 } else { ((value + 0.055) / 1.055).powf(2.4) }
}

/// The code of an intensity of light in sRGB, both of 0 to 1.
pub(super) fn encoded(light: f64) -> f64 {
    if light <= 0.003_130_8 { 12.92 * light } else { 1.055 * light.powf(1.0 / 2.4) - 0.055 }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn lightness(colour: Colour) -> f64 {
        let y = 0.2126 * linear(colour[0]) + 0.7152 * linear(colour[1]) + 0.0722 * linear(colour[2]);
        116.0 * f64::from(y).cbrt() - 16.0
    }

    #[test]
    fn the_speed_scale_gets_evenly_lighter() {
        let steps: Vec<f64> = (0..=16).map(|step| lightness(scale_colour(f64::from(step) / 16.0))).collect();
        let mean = (steps[16] - steps[0]) / 16.0;
        for pair in steps.windows(2) {
            let rise = pair[1] - pair[0];
            assert!(rise > 0.4 * mean && rise < 1.8 * mean, "uneven step {rise} (mean {mean})");
        }
    }

    #[test]
    fn the_ends_and_nan_are_defined() {
        assert_eq!(scale_colour(-3.0), scale_colour(0.0));
        assert_eq!(scale_colour(7.0), [253, 231, 37, 255]);
        assert_eq!(scale_colour(f64::NAN), scale_colour(0.0));
    }
}
