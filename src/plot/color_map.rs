//! From the values of a field to colours.

use super::palette::{Colour, encoded, linear, scale_colour};
use super::ticks::{AxisMap, LARGEST};
use crate::plot::Scale;

/// Colours of a map: neighbours differ by less than can be seen.
const COLOURS: usize = 1024;

/// How values become colours.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub enum ColorMap {
    /// From dark blue to yellow, evenly lighter: for quantities with a smallest and a largest value (default).
    #[default]
    Sequential,
    /// From nearly white at the centre to blue below and red above, evenly darker on both sides: for quantities with a
    /// sign. Equal distances from the centre are equally dark.
    Diverging {
        /// The value of the nearly white colour.
        centre: f64,
    },
}

/// The values that a colour bar shows and the colours they have.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct ColorScale {
    /// Values at both ends of the bar.
    pub bar: AxisMap,
    /// Values at both ends of the map, of which the bar may show a part.
    map: AxisMap,
    /// The colours of the whole map.
    pub colours: Vec<Colour>,
}

impl ColorScale {
    /// The scale for values between these extrema, or for a given range; one that is empty or not finite counts as
    /// left out.
    pub(super) fn new(map: ColorMap, range: Option<[f64; 2]>, extrema: Option<[f64; 2]>) -> Self {
        let given = AxisMap::given(Scale::Linear, range);
        let extrema = extrema.map(|extrema| extrema.map(|value| value.clamp(-LARGEST, LARGEST)));
        match map {
            ColorMap::Sequential => {
                let bar = given.unwrap_or_else(|| AxisMap::around(extrema.unwrap_or([0.0, 1.0]), 0.0));
                Self { bar, map: bar, colours: table(scale_colour) }
            }
            ColorMap::Diverging { centre } => {
                let centre = if centre.is_finite() { centre.clamp(-LARGEST, LARGEST) } else { 0.0 };
                let ends = given.map(|given| [given.low, given.high]).or(extrema);
                let [low, high] = ends.unwrap_or([centre - 1.0, centre + 1.0]);
                let reach = (high - centre).abs().max((low - centre).abs());
                let map = AxisMap::around([centre - reach, centre + reach], 0.0);
                Self { bar: given.unwrap_or(map), map, colours: table(diverging_colour) }
            }
        }
    }

    /// Where a value lies in the map: 0 and 1 are its ends. None for what is not finite.
    pub(super) fn fraction(&self, value: f64) -> Option<f64> {
        value.is_finite().then(|| self.map.fraction(value.clamp(-LARGEST, LARGEST))).flatten()
    }

    /// Where both ends of the bar lie in the map.
    pub(super) fn limits(&self) -> [f64; 2] {
        [self.bar.low, self.bar.high].map(|value| self.map.fraction(value).unwrap_or(0.0).clamp(0.0, 1.0))
    }

    /// The colour at a fraction of the bar.
    pub(super) fn bar_colour(&self, fraction: f64) -> Colour {
        let [low, high] = self.limits();
        let index = (low + fraction.clamp(0.0, 1.0) * (high - low)) * (COLOURS - 1) as f64;
        self.colours.get(index.round() as usize).copied().unwrap_or([0, 0, 0, 255])
    }
}

fn table(colour: fn(f64) -> Colour) -> Vec<Colour> {
    (0..COLOURS).map(|index| colour(index as f64 / (COLOURS - 1) as f64)).collect()
}

/// Hues of the two arms in Oklab, in radians.
const BLUE_HUE: f64 = 4.50;
const RED_HUE: f64 = 0.48;
/// Lightness in Oklab at the centre and at both ends.
const CENTRE_LIGHTNESS: f64 = 0.965;
const END_LIGHTNESS: f64 = 0.34;

/// Colour of a fraction of a scale of two arms: lightness falls evenly from the centre, and chroma rises and falls
/// along a parabola that stays within sRGB.
fn diverging_colour(fraction: f64) -> Colour {
    let arm = 2.0 * fraction.clamp(0.0, 1.0) - 1.0;
    let fall = arm.abs() * (CENTRE_LIGHTNESS - END_LIGHTNESS);
    let chroma = (0.6 - 0.65 * fall) * fall;
    let hue = if arm < 0.0 { BLUE_HUE } else { RED_HUE };
    srgb_from_oklab([CENTRE_LIGHTNESS - fall, chroma * hue.cos(), chroma * hue.sin()])
}

/// Björn Ottosson's Oklab (2020), in which equal distances look about equally different.
pub(super) fn srgb_from_oklab([lightness, a, b]: [f64; 3]) -> Colour {
    let cones = [
        lightness + 0.396_337_777_4 * a + 0.215_803_757_3 * b,
        lightness - 0.105_561_345_8 * a - 0.063_854_172_8 * b,
        lightness - 0.089_484_177_5 * a - 1.291_485_548_0 * b,
    ]
    .map(|root| root * root * root);
    let channel = |weights: [f64; 3]| {
        let light: f64 = weights.iter().zip(cones).map(|(weight, cone)| weight * cone).sum();
        let light = light.clamp(0.0, 1.0);
        (255.0 * encoded(light)).round() as u8
    };
    [
        channel([4.076_741_662_1, -3.307_711_591_3, 0.230_969_929_2]),
        channel([-1.268_438_004_6, 2.609_757_401_1, -0.341_319_396_5]),
        channel([-0.004_196_086_3, -0.703_418_614_7, 1.707_614_701_0]),
        255,
    ]
}

/// The inverse of [`srgb_from_oklab`].
pub(super) fn oklab(colour: Colour) -> [f64; 3] {
    let light = [0, 1, 2].map(|channel| f64::from(linear(colour[channel])));
    let cone = |weights: [f64; 3]| (0..3).map(|i| weights[i] * light[i]).sum::<f64>().cbrt();
    let cones = [
        cone([0.412_221_470_8, 0.536_332_536_3, 0.051_445_992_9]),
        cone([0.211_903_498_2, 0.680_699_545_1, 0.107_396_956_6]),
        cone([0.088_302_461_9, 0.281_718_837_6, 0.629_978_700_5]),
    ];
    let mixed = |weights: [f64; 3]| (0..3).map(|i| weights[i] * cones[i]).sum::<f64>();
    [
        mixed([0.210_454_255_3, 0.793_617_785_0, -0.004_072_046_8]),
        mixed([1.977_998_495_1, -2.428_592_205_0, 0.450_593_709_9]),
        mixed([0.025_904_037_1, 0.782_771_766_2, -0.808_675_766_0]),
    ]
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    /// CIELAB, which had no part in the making of the scale.
    fn lab(colour: Colour) -> [f64; 3] {
        let light = [0, 1, 2].map(|channel| f64::from(linear(colour[channel])));
        let sum = |weights: [f64; 3]| (0..3).map(|i| weights[i] * light[i]).sum::<f64>();
        let [x, y, z] = [
            sum([0.4124, 0.3576, 0.1805]) / 0.9505,
            sum([0.2126, 0.7152, 0.0722]),
            sum([0.0193, 0.1192, 0.9505]) / 1.089,
        ]
        .map(|value| if value > 0.008_856 { value.cbrt() } else { 7.787 * value + 16.0 / 116.0 });
        [116.0 * y - 16.0, 500.0 * (x - y), 200.0 * (y - z)]
    }

    #[test]
    fn the_arms_of_the_diverging_scale_darken_evenly_and_alike() {
        let colours: Vec<[f64; 3]> = (0..=32).map(|step| lab(diverging_colour(f64::from(step) / 32.0))).collect();
        let mean = (colours[16][0] - colours[0][0]) / 16.0;
        assert!(mean > 3.5, "there is contrast: {mean}");
        for step in 1..=16 {
            for side in [16 + step, 16 - step] {
                let inner = if side > 16 { side - 1 } else { side + 1 };
                let fall = colours[inner][0] - colours[side][0];
                assert!((fall / mean - 1.0).abs() < 0.35, "uneven step {fall} at {side} (mean {mean})");
            }
            let difference = colours[16 + step][0] - colours[16 - step][0];
            assert!(difference.abs() < 4.0, "arms differ by {difference} at {step}");
        }
        let [blue, white, red] = [0, 16, 32].map(|step| colours[step]);
        assert!(white[1].abs() < 2.0 && white[2].abs() < 2.0 && blue[2] < -30.0 && red[1] > 30.0, "{blue:?} {red:?}");
    }

    #[test]
    fn the_diverging_scale_is_never_cut_off_at_the_edge_of_srgb() {
        for step in 0..=100 {
            let colour = diverging_colour(f64::from(step) / 100.0);
            assert!(colour[..3].iter().all(|channel| (1..255).contains(channel)), "{colour:?} at {step}");
        }
    }

    #[test]
    fn ranges() {
        let sequential = |range, extrema| ColorScale::new(ColorMap::Sequential, range, extrema);
        let ends = |scale: &ColorScale| [scale.bar.low, scale.bar.high];
        assert_eq!(ends(&sequential(None, Some([1.0, 3.0]))), [1.0, 3.0]);
        assert_eq!(ends(&sequential(Some([0.0, 2.0]), Some([1.0, 3.0]))), [0.0, 2.0]);
        for wrong in [[2.0, 2.0], [3.0, 1.0], [f64::NAN, 1.0], [0.0, f64::INFINITY]] {
            assert_eq!(ends(&sequential(Some(wrong), Some([1.0, 3.0]))), [1.0, 3.0], "{wrong:?}");
        }
        assert_eq!(ends(&sequential(None, None)), [0.0, 1.0]);
        assert_eq!(ends(&sequential(None, Some([0.0, 0.0]))), [-1.0, 1.0]);
        let constant = sequential(None, Some([5.0, 5.0])).fraction(5.0).unwrap();
        assert!((constant - 0.5).abs() < 1e-12, "{constant}");
        assert_eq!(sequential(None, Some([5.0, 6.0])).fraction(f64::NAN), None);

        let diverging = |range, extrema| ColorScale::new(ColorMap::Diverging { centre: 1.0 }, range, extrema);
        assert_eq!(ends(&diverging(None, Some([0.5, 4.0]))), [-2.0, 4.0]);
        let lopsided = diverging(Some([0.0, 4.0]), Some([0.5, 4.0]));
        assert_eq!(ends(&lopsided), [0.0, 4.0]);
        assert_eq!(lopsided.fraction(1.0), Some(0.5));
        assert_eq!(lopsided.limits()[1], 1.0);
        assert!((lopsided.limits()[0] - 1.0 / 3.0).abs() < 1e-12);
        let constant = diverging(None, Some([1.0, 1.0])).fraction(1.0).unwrap();
        assert!((constant - 0.5).abs() < 1e-12, "{constant}");
        assert_eq!(diverging(None, None).fraction(1.0), Some(0.5));

        // The widest ranges that there are.
        for map in [ColorMap::Sequential, ColorMap::Diverging { centre: f64::MAX }] {
            let scale = ColorScale::new(map, None, Some([f64::MIN, f64::MAX]));
            let fractions = [f64::MIN, 0.0, f64::MAX].map(|value| scale.fraction(value).unwrap());
            assert!(fractions.iter().all(|fraction| (0.0..=1.0).contains(fraction)), "{fractions:?}");
        }
    }
}
