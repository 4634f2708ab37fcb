//! A sheet of text and pictures, drawn without a device: it holds what is laid down on it from the top, however long
//! that becomes.

use super::error::PlotError;
use super::palette::{encoded, linear};
use super::text::{LINE_HEIGHT, Typesetter, Weight};
use image::{Rgb, RgbImage, imageops};

/// The ink of a text.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum SheetInk {
    Text,
    Faint,
    Mark,
}

/// How a text is set.
#[derive(Debug, Clone, Copy)]
pub(crate) struct SheetType {
    pub size: f64,
    pub is_bold: bool,
    pub ink: SheetInk,
}

/// A line of text with the start of its baseline.
struct Line {
    text: String,
    style: SheetType,
    place: [f64; 2],
}

/// A sheet under way.
pub(crate) struct Sheet {
    typesetter: Typesetter,
    width: u32,
    lines: Vec<Line>,
    pictures: Vec<(RgbImage, [u32; 2])>,
    rules: Vec<u32>,
}

/// The height of the highest pictures over the width they may have.
const HIGHEST: f64 = 1.6;

const PAPER: [u8; 3] = [255; 3];
const RULE: [u8; 3] = [217, 221, 227];

impl SheetType {
    fn weight(self) -> Weight {
        if self.is_bold { Weight::SemiBold } else { Weight::Regular }
    }
}

impl SheetInk {
    fn colour(self) -> [u8; 3] {
        match self {
            Self::Text => [27, 29, 33],
            Self::Faint => [92, 99, 112],
            Self::Mark => [138, 75, 0],
        }
    }
}

impl Sheet {
    /// A blank sheet of a width in pixels.
    ///
    /// # Errors
    /// [`PlotError::Font`] if an embedded font cannot be read.
    pub(crate) fn new(width: u32) -> Result<Self, PlotError> {
        let typesetter = Typesetter::new()?;
        Ok(Self { typesetter, width, lines: Vec::new(), pictures: Vec::new(), rules: Vec::new() })
    }

    /// Width of a line of text in pixels.
    pub(crate) fn width_of(&self, text: &str, style: SheetType) -> f64 {
        self.typesetter.width(text, style.weight(), style.size)
    }

    /// Lays down a text in lines no wider than `width`, below and right of `corner`. Returns the bottom of the last
    /// line.
    pub(crate) fn lay_text(&mut self, text: &str, style: SheetType, [left, top]: [f64; 2], width: f64) -> f64 {
        let text = self.with_breaks(text, style, width);
        let lines = self.typesetter.wrap(&text, style.weight(), style.size, width, usize::MAX);
        let height = LINE_HEIGHT * style.size;
        let count = lines.len() as f64;
        for (number, text) in lines.into_iter().enumerate() {
            self.lines.push(Line { text, style, place: [left, top + number as f64 * height + style.size] });
        }
        top + count * height
    }

    /// A text with spaces in words that are wider than a line, so that nothing of them is cut.
    fn with_breaks(&self, text: &str, style: SheetType, width: f64) -> String {
        let mut broken = String::new();
        for word in text.split_inclusive(char::is_whitespace) {
            let mut line = 0.0;
            let is_wide = self.width_of(word.trim_end(), style) > width;
            for letter in word.chars() {
                let own = if is_wide { self.width_of(letter.encode_utf8(&mut [0; 4]), style) } else { 0.0 };
                if line > 0.0 && line + own > width {
                    broken.push(' ');
                    line = 0.0;
                }
                line += own;
                broken.push(letter);
            }
        }
        broken
    }

    /// Lays down a picture in a width, not larger than it is and not much higher than wide. Returns its bottom.
    pub(crate) fn lay_picture(&mut self, picture: &RgbImage, [left, top]: [f64; 2], width: f64) -> f64 {
        let [own_width, own_height] = [picture.width(), picture.height()].map(|edge| f64::from(edge.max(1)));
        let scale = (width / own_width).min(HIGHEST * width / own_height).min(1.0);
        let (width, height) = (scale * own_width, scale * own_height);
        let size = [width, height].map(|edge| (edge.round() as u32).max(1));
        let scaled = imageops::resize(picture, size[0], size[1], imageops::FilterType::CatmullRom);
        self.pictures.push((scaled, [left, top].map(|place| place.round() as u32)));
        top + height
    }

    /// Lays down a thin line across the sheet.
    pub(crate) fn lay_rule(&mut self, top: f64) {
        self.rules.push(top.round() as u32);
    }

    /// The picture of the sheet, so high.
    ///
    /// # Errors
    /// [`PlotError::TypeTooLarge`] if the letters do not fit into their atlas.
    pub(crate) fn painted(mut self, height: f64) -> Result<RgbImage, PlotError> {
        let mut page = RgbImage::from_pixel(self.width, height.ceil().max(1.0) as u32, Rgb(PAPER));
        for top in self.rules {
            for (left, row) in (0..self.width).flat_map(|left| [(left, top), (left, top + 1)]) {
                if let Some(pixel) = page.get_pixel_mut_checked(left, row) {
                    *pixel = Rgb(RULE);
                }
            }
        }
        for (picture, [left, top]) in &self.pictures {
            imageops::replace(&mut page, picture, i64::from(*left), i64::from(*top));
        }
        let set: Vec<_> = self
            .lines
            .iter()
            .map(|line| (line, self.typesetter.set(&line.text, line.style.weight(), line.style.size)))
            .collect();
        let (atlas_width, _, coverage) = self.typesetter.atlas()?;
        for (line, glyphs) in set {
            let [left, baseline] = line.place.map(|place| place.round() as i64);
            let ink = line.style.ink.colour();
            for glyph in glyphs {
                for (x, y) in (0..glyph.size[1]).flat_map(|y| (0..glyph.size[0]).map(move |x| (x, y))) {
                    let texel = u64::from(glyph.texel[1] + y) * u64::from(atlas_width) + u64::from(glyph.texel[0] + x);
                    let part = f64::from(coverage.get(texel as usize).copied().unwrap_or(0)) / 255.0;
                    let [column, row] = [(left, 0, x), (baseline, 1, y)]
                        .map(|(start, axis, inner)| start + i64::from(glyph.offset[axis]) + i64::from(inner));
                    let (Ok(column), Ok(row)) = (u32::try_from(column), u32::try_from(row)) else { continue };
                    if let Some(Rgb(pixel)) = page.get_pixel_mut_checked(column, row) {
                        for (under, over) in pixel.iter_mut().zip(ink) {
                            let mixed = f64::from(linear(*under)) * (1.0 - part) + f64::from(linear(over)) * part;
                            *under = (255.0 * encoded(mixed)).round() as u8;
                        }
                    }
                }
            }
        }
        Ok(page)
    }
}
