//! Lines of text: metrics, wrapping, and the glyphs they need rasterised into one atlas.

use super::error::PlotError;
use ab_glyph::{Font, FontRef, GlyphId, OutlineCurve, PxScale, ScaleFont};
use std::collections::HashMap;

/// Height of a capital letter in units of the type size.
pub(super) const CAPITAL_HEIGHT: f64 = 0.727;
/// Distance of two lines of text in units of the type size.
pub(super) const LINE_HEIGHT: f64 = 1.3;

const ATLAS_WIDTH: u32 = 2048;
const ATLAS_MAXIMUM_HEIGHT: u32 = 8192;
/// Size of an index or exponent relative to its base.
const SCRIPT_SIZE: f64 = 0.7;

const REGULAR: &[u8] = include_bytes!("../../assets/fonts/Inter-Regular.otf");

/// Stroke weight of the type.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub(super) enum Weight {
    Regular,
    SemiBold,
}

/// A glyph in the atlas and where it goes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct PlacedGlyph {
    /// Corner of the glyph's texture, in pixels right of and below the start of the baseline; in the atlas, of its own.
    pub offset: [i32; 2],
    /// Corner in the atlas.
    pub texel: [u32; 2],
    /// Size in the atlas.
    pub size: [u32; 2],
}

/// The outline of a glyph.
pub(super) struct Letter {
    /// In units of the font from the start of its baseline, upwards.
    pub curves: Vec<OutlineCurve>,
    /// Pixels of a unit.
    pub scale: f64,
    /// Corner of its texture, in pixels right of and below the start of its baseline.
    pub corner: [f64; 2],
}

/// Sets lines of text and collects the glyphs they use.
pub(super) struct Typesetter {
    /// The fonts of the weights, in their order.
    fonts: [FontRef<'static>; 2],
    entries: HashMap<(Weight, GlyphId, u32), Option<PlacedGlyph>>,
    /// One byte of coverage per texel, rows of [`ATLAS_WIDTH`].
    coverage: Vec<u8>,
    shelf: [u32; 2],
    shelf_height: u32,
    full: bool,
}

impl Typesetter {
    /// # Errors
    /// [`PlotError::Font`] if an embedded font cannot be read.
    pub(super) fn new() -> Result<Self, PlotError> {
        let read = |bytes: &'static [u8]| FontRef::try_from_slice(bytes).map_err(|e| PlotError::Font(e.to_string()));
        Ok(Self {
            fonts: [read(REGULAR)?, read(include_bytes!("../../assets/fonts/Inter-SemiBold.otf"))?],
            entries: HashMap::new(),
            coverage: Vec::new(),
            shelf: [0, 0],
            shelf_height: 0,
            full: false,
        })
    }

    fn font(&self, weight: Weight) -> &FontRef<'static> {
        &self.fonts[weight as usize]
    }

    /// The scale at which one em is `size` pixels.
    fn scale(&self, weight: Weight, size: f64) -> PxScale {
        let font = self.font(weight);
        let em = font.units_per_em().unwrap_or(1000.0);
        PxScale::from(size as f32 * font.height_unscaled() / em)
    }

    /// Width of a line of text in pixels.
    pub(super) fn width(&self, text: &str, weight: Weight, size: f64) -> f64 {
        let width = |run: &Run<'_>| {
            let font = self.font(weight).as_scaled(self.scale(weight, size * run.size));
            run.text.chars().map(|c| f64::from(font.h_advance(glyph_of(font.font, c)))).sum::<f64>()
        };
        runs(text).iter().map(width).sum()
    }

    /// Rasterises what is missing and returns the glyphs of a line of text.
    pub(super) fn set(&mut self, text: &str, weight: Weight, size: f64) -> Vec<PlacedGlyph> {
        let mut placed = Vec::new();
        let mut pen = 0.0_f64;
        for run in runs(text) {
            let run_size = (size * run.size).max(1.0);
            let scale = self.scale(weight, run_size);
            let baseline = (-run.rise * size).round() as i32;
            for character in run.text.chars() {
                let (glyph, advance) = {
                    let font = self.font(weight).as_scaled(scale);
                    let glyph = glyph_of(font.font, character);
                    (glyph, f64::from(font.h_advance(glyph)))
                };
                if let Some(entry) = self.entry(weight, glyph, scale) {
                    let offset = [pen.round() as i32 + entry.offset[0], baseline + entry.offset[1]];
                    placed.push(PlacedGlyph { offset, ..entry });
                }
                pen += advance;
            }
        }
        placed
    }

    fn entry(&mut self, weight: Weight, glyph: GlyphId, scale: PxScale) -> Option<PlacedGlyph> {
        let key = (weight, glyph, scale.y.to_bits());
        if let Some(entry) = self.entries.get(&key) {
            return *entry;
        }
        let outlined = self.font(weight).outline_glyph(glyph.with_scale(scale));
        let entry = outlined.and_then(|outlined| {
            let bounds = outlined.px_bounds();
            let size = [bounds.width().ceil() as u32, bounds.height().ceil() as u32];
            let texel = self.reserve(size)?;
            outlined.draw(|x, y, coverage| {
                let index = (texel[1] + y) as usize * ATLAS_WIDTH as usize + (texel[0] + x) as usize;
                if let Some(byte) = self.coverage.get_mut(index) {
                    *byte = (coverage.clamp(0.0, 1.0) * 255.0).round() as u8;
                }
            });
            Some(PlacedGlyph { offset: [bounds.min.x as i32, bounds.min.y as i32], texel, size })
        });
        self.entries.insert(key, entry);
        entry
    }

    /// Finds room for a glyph on the current shelf of the atlas or starts a new one.
    fn reserve(&mut self, size: [u32; 2]) -> Option<[u32; 2]> {
        if self.shelf[0] + size[0] > ATLAS_WIDTH {
            self.shelf = [0, self.shelf[1] + self.shelf_height];
            self.shelf_height = 0;
        }
        let bottom = self.shelf[1] + size[1];
        if size[0] > ATLAS_WIDTH || bottom > ATLAS_MAXIMUM_HEIGHT {
            self.full = true;
            return None;
        }
        let texel = self.shelf;
        self.shelf[0] += size[0];
        self.shelf_height = self.shelf_height.max(size[1]);
        let needed = bottom as usize * ATLAS_WIDTH as usize;
        if self.coverage.len() < needed {
            self.coverage.resize(needed, 0);
        }
        Some(texel)
    }

    /// The atlas: width, height, and one byte of coverage per texel.
    ///
    /// # Errors
    /// [`PlotError::TypeTooLarge`] if the glyphs did not fit.
    pub(super) fn atlas(&self) -> Result<(u32, u32, &[u8]), PlotError> {
        if self.full {
            return Err(PlotError::TypeTooLarge);
        }
        Ok((ATLAS_WIDTH, (self.coverage.len() / ATLAS_WIDTH as usize) as u32, &self.coverage))
    }

    /// The outlines of the glyphs in the atlas, by their corners there.
    pub(super) fn letters(&self) -> HashMap<[u32; 2], Letter> {
        let letter = |(&(weight, glyph, scale), placed): (&(Weight, GlyphId, u32), &Option<PlacedGlyph>)| {
            let (font, placed) = (self.font(weight), (*placed)?);
            let curves = font.outline(glyph)?.curves;
            let scale = f64::from(f32::from_bits(scale) / font.height_unscaled());
            Some((placed.texel, Letter { curves, scale, corner: placed.offset.map(f64::from) }))
        };
        self.entries.iter().filter_map(letter).collect()
    }

    /// Breaks a text at spaces into at most `lines` lines no wider than `width`; what does not fit ends in an ellipsis.
    pub(super) fn wrap(&self, text: &str, weight: Weight, size: f64, width: f64, lines: usize) -> Vec<String> {
        let mut wrapped: Vec<String> = Vec::new();
        let mut line = String::new();
        for word in text.split_whitespace() {
            let longer = if line.is_empty() { word.to_owned() } else { format!("{line} {word}") };
            if line.is_empty() || wrapped.len() + 1 >= lines || self.width(&longer, weight, size) <= width {
                line = longer;
            } else {
                wrapped.push(std::mem::replace(&mut line, word.to_owned()));
            }
        }
        if !line.is_empty() {
            wrapped.push(line);
        }
        wrapped.into_iter().map(|line| self.shorten(&line, weight, size, width)).collect()
    }

    /// Cuts a line that is too wide and ends it in an ellipsis.
    pub(super) fn shorten(&self, text: &str, weight: Weight, size: f64, width: f64) -> String {
        if self.width(text, weight, size) <= width {
            return text.to_owned();
        }
        let characters: Vec<char> = text.chars().collect();
        let fits = |count: usize| {
            let head: String = characters[..count].iter().collect();
            self.width(&format!("{}…", head.trim_end()), weight, size) <= width
        };
        // Widths grow with every letter, so halving finds the longest head that fits.
        let (mut low, mut high) = (0, characters.len());
        while low < high {
            let middle = (low + high).div_ceil(2);
            if fits(middle) {
                low = middle;
            } else {
                high = middle - 1;
            }
        }
        let head: String = characters[..low].iter().collect();
        format!("{}…", head.trim_end())
    }
}

/// Things in rows, each as full as the room of its number allows; every thing has a width.
pub(super) fn in_rows<T>(
    things: impl IntoIterator<Item = (T, f64)>,
    room: impl Fn(usize) -> f64,
) -> Vec<Vec<(T, f64)>> {
    let mut rows: Vec<Vec<(T, f64)>> = Vec::new();
    let mut used = f64::INFINITY;
    for (thing, width) in things {
        if rows.is_empty() || used + width > room(rows.len() - 1) {
            rows.push(Vec::new());
            used = 0.0;
        }
        used += width;
        if let Some(row) = rows.last_mut() {
            row.push((thing, width));
        }
    }
    rows
}

/// Characters that the font lacks, and the nearest that it has.
const SUBSTITUTES: [(&[char], char); 14] = [
    (&['⟨', '〈', '⟪'], '‹'),
    (&['⟩', '〉', '⟫'], '›'),
    (&['⋅', '∙', '•', '∗'], '·'),
    (&['∕', '⁄'], '/'),
    (&['∼', '∿'], '~'),
    (&['′', '＇'], '\''),
    (&['″', '＂'], '"'),
    (&['ϵ'], 'ε'),
    (&['ϕ'], 'φ'),
    (&['ϑ'], 'θ'),
    (&['ℓ'], 'l'),
    (&['∆'], 'Δ'),
    (&['‐', '‑', '‒', '―'], '–'),
    (&['\t', '\u{a0}', '\u{2002}', '\u{2003}', '\u{2009}', '\u{202f}', '\u{3000}'], ' '),
];

/// Stands for a character that the font has nothing like.
const HOLLOW_BOX: char = '□';

/// The glyph of a character, or of the nearest that the font has.
fn known_glyph(font: &FontRef<'static>, character: char) -> Option<GlyphId> {
    let substitute = SUBSTITUTES.iter().find(|(characters, _)| characters.contains(&character)).map(|(_, near)| *near);
    [Some(character), substitute].into_iter().flatten().map(|c| font.glyph_id(c)).find(|glyph| glyph.0 != 0)
}

/// The glyph of a character, or of the nearest that the font has; a hollow box stands for all others.
fn glyph_of(font: &FontRef<'static>, character: char) -> GlyphId {
    known_glyph(font, character).unwrap_or_else(|| font.glyph_id(HOLLOW_BOX))
}

/// The characters of a text that pictures show as hollow boxes, each once, in their order: the font that they are set in has
/// the letters of European languages, Greek and the common signs of mathematics.
///
/// ```
/// use mesoscope::plot::missing_glyphs;
/// assert_eq!(missing_glyphs("Ménage à trois: ⟨α²⟩ ≈ ½ ± 10⁻³"), "");
/// assert_eq!(missing_glyphs("水 and 水, ok 🙂"), "水🙂");
/// ```
#[must_use]
pub fn missing_glyphs(text: &str) -> String {
    if text.is_ascii() {
        return String::new();
    }
    // The font is part of the program; one that cannot be read has no glyph at all.
    let font = FontRef::try_from_slice(REGULAR).ok();
    let mut missing = String::new();
    for character in text.chars().filter(|character| !character.is_control()) {
        let known = font.as_ref().is_some_and(|font| known_glyph(font, character).is_some());
        if !known && !missing.contains(character) {
            missing.push(character);
        }
    }
    missing
}

struct Run<'a> {
    text: &'a str,
    /// Relative to the type size.
    size: f64,
    /// Height of the baseline above that of the line, relative to the type size.
    rise: f64,
}

/// Splits `r_{c}` and `10^{4}` into runs; an unclosed brace is plain text.
fn runs(text: &str) -> Vec<Run<'_>> {
    let mut runs = Vec::new();
    let mut rest = text;
    while let Some(start) = [rest.find("_{"), rest.find("^{")].into_iter().flatten().min() {
        let Some(length) = rest[start + 2..].find('}') else { break };
        runs.push(Run { text: &rest[..start], size: 1.0, rise: 0.0 });
        let rise = if rest[start..].starts_with('_') { -0.18 } else { 0.36 };
        runs.push(Run { text: &rest[start + 2..start + 2 + length], size: SCRIPT_SIZE, rise });
        rest = &rest[start + 3 + length..];
    }
    runs.push(Run { text: rest, size: 1.0, rise: 0.0 });
    runs
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    #[test]
    fn scripts_are_smaller_and_shifted() {
        let parts = runs("r_{c} ×10^{4} open_{");
        let texts: Vec<&str> = parts.iter().map(|run| run.text).collect();
        assert_eq!(texts, ["r", "c", " ×10", "4", " open_{"]);
        assert!(parts[1].rise < 0.0 && parts[3].rise > 0.0 && parts[1].size < 1.0);
    }

    #[test]
    fn wrapped_lines_fit_and_lose_no_word() {
        let setter = Typesetter::new().unwrap();
        let text = "energy per particle in units of the thermal energy";
        let lines = setter.wrap(text, Weight::Regular, 32.0, 300.0, 9);
        assert!(lines.len() > 2);
        assert_eq!(lines.join(" "), text);
        assert!(lines.iter().all(|line| setter.width(line, Weight::Regular, 32.0) <= 300.0));
        let cut = setter.wrap(text, Weight::Regular, 32.0, 300.0, 2);
        assert_eq!(cut.len(), 2);
        assert!(cut[1].ends_with('…'));
        assert!(setter.width(&cut[1], Weight::Regular, 32.0) <= 300.0);
    }

    #[test]
    fn the_signs_of_physics_are_in_the_font() {
        let setter = Typesetter::new().unwrap();
        for sign in "ABCxyz0189−×·±≈≤≥√∞†⁰¹²³⁴⁵⁶⁷⁸⁹⁻₀₁₂αβγδελμνρστφωΔΣΩ→°½äöüéñ–—…()[]/‹›□".chars()
        {
            for weight in [Weight::Regular, Weight::SemiBold] {
                assert_ne!(setter.font(weight).glyph_id(sign), GlyphId(0), "no glyph for {sign}");
            }
        }
    }

    #[test]
    fn every_substitute_is_in_the_font_and_every_box_is_named() {
        let setter = Typesetter::new().unwrap();
        for (characters, near) in SUBSTITUTES {
            assert_ne!(setter.fonts[0].glyph_id(near), GlyphId(0), "{near}");
            for character in characters {
                assert_eq!(missing_glyphs(&character.to_string()), "", "{character}");
            }
        }
        let hollow = setter.fonts[0].glyph_id(HOLLOW_BOX);
        for character in "∇水ملح🙂זé√α".chars() {
            let boxed = glyph_of(&setter.fonts[0], character) == hollow;
            assert_eq!(missing_glyphs(&character.to_string()).contains(character), boxed, "{character}");
        }
    }

    #[test]
    fn digits_are_tabular() {
        let setter = Typesetter::new().unwrap();
        let widths = [setter.width("1111", Weight::Regular, 32.0), setter.width("8888", Weight::Regular, 32.0)];
        assert_eq!(widths[0], widths[1]);
    }
}
