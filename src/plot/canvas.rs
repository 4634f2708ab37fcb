//! The list of shapes that make up a picture, in the order in which they are painted. Pure data: no device needed.

use super::error::PlotError;
use super::palette::{Colour, Inks, inks};
use super::text::{CAPITAL_HEIGHT, LINE_HEIGHT, Typesetter, Weight};
use crate::scene::Theme;
use bytemuck::{Pod, Zeroable};

/// One quad of `shapes.wgsl`.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
pub(super) struct Shape {
    pub ends: [f32; 4],
    pub texels: [f32; 4],
    pub radius: f32,
    pub kind: u32,
    pub colour: Colour,
}

/// Kinds of shapes.
impl Shape {
    pub(super) const CAPSULE: u32 = 0;
    pub(super) const RECTANGLE: u32 = 1;
    pub(super) const POLYGON: u32 = 2;
    pub(super) const GLYPH: u32 = 3;
    pub(super) const TRIANGLE: u32 = 4;
}

/// A rectangle in pixels.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Area {
    pub left: f64,
    pub top: f64,
    pub right: f64,
    pub bottom: f64,
}

impl Area {
    /// The area with a centre, a width and a height.
    pub(super) fn around([x, y]: [f64; 2], size: [f64; 2]) -> Self {
        let [wide, high] = size.map(|side| 0.5 * side);
        Self { left: x - wide, top: y - high, right: x + wide, bottom: y + high }
    }

    /// The corners clockwise from the upper left one.
    pub(super) fn corners(&self) -> [[f64; 2]; 4] {
        [[self.left, self.top], [self.right, self.top], [self.right, self.bottom], [self.left, self.bottom]]
    }

    pub(super) fn width(&self) -> f64 {
        self.right - self.left
    }

    pub(super) fn height(&self) -> f64 {
        self.bottom - self.top
    }

    pub(super) fn centre(&self) -> [f64; 2] {
        [0.5 * (self.left + self.right), 0.5 * (self.top + self.bottom)]
    }

    pub(super) fn grown(&self, by: f64) -> Self {
        Self { left: self.left - by, top: self.top - by, right: self.right + by, bottom: self.bottom + by }
    }

    pub(super) fn contains(&self, point: [f64; 2]) -> bool {
        point[0] >= self.left && point[0] <= self.right && point[1] >= self.top && point[1] <= self.bottom
    }
}

/// Where the given point lies in a line of text.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Anchor {
    Start,
    Middle,
    End,
}

/// How a line of text is set.
#[derive(Debug, Clone, Copy)]
pub(super) struct Type {
    pub size: f64,
    pub weight: Weight,
    pub colour: Colour,
}

/// A line of the headings of a page.
pub(super) struct Heading {
    pub text: String,
    pub style: Type,
}

/// Shapes that share a clipping rectangle.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Batch {
    pub shapes: Vec<Shape>,
    pub clip: Option<Area>,
}

/// Shapes in painting order.
pub(super) struct Canvas {
    pub width: u32,
    pub height: u32,
    pub inks: Inks,
    pub batches: Vec<Batch>,
    /// Batches painted before the particles of a snapshot or the image of a field.
    pub background: usize,
    pub typesetter: Typesetter,
}

impl Canvas {
    /// # Errors
    /// [`PlotError::Font`] if an embedded font cannot be read.
    pub(super) fn new(width: u32, height: u32, theme: Theme) -> Result<Self, PlotError> {
        let typesetter = Typesetter::new()?;
        let batches = vec![Batch { shapes: Vec::new(), clip: None }];
        Ok(Self { width, height, inks: inks(theme), batches, background: 0, typesetter })
    }

    /// What follows is painted only inside this area.
    pub(super) fn clip(&mut self, clip: Option<Area>) {
        self.batches.push(Batch { shapes: Vec::new(), clip });
    }

    /// What follows is painted over the particles or the image.
    pub(super) fn end_of_background(&mut self) {
        self.background = self.batches.len();
        self.clip(None);
    }

    fn push(&mut self, shape: Shape) {
        if let Some(batch) = self.batches.last_mut() {
            batch.shapes.push(shape);
        }
    }

    /// A line with round ends; both ends the same make a disc.
    pub(super) fn line(&mut self, from: [f64; 2], to: [f64; 2], width: f64, colour: Colour) {
        let ends = [from[0] as f32, from[1] as f32, to[0] as f32, to[1] as f32];
        self.push(Shape { ends, texels: [0.0; 4], radius: 0.5 * width as f32, kind: Shape::CAPSULE, colour });
    }

    /// A filled disc.
    pub(super) fn disc(&mut self, centre: [f64; 2], radius: f64, colour: Colour) {
        self.line(centre, centre, 2.0 * radius, colour);
    }

    /// A filled rectangle.
    pub(super) fn rectangle(&mut self, area: Area, colour: Colour) {
        let ends = [area.left as f32, area.top as f32, area.right as f32, area.bottom as f32];
        self.push(Shape { ends, texels: [0.0; 4], radius: 0.0, kind: Shape::RECTANGLE, colour });
    }

    /// A filled regular polygon; `angle` is that of its first corner, clockwise from the right.
    pub(super) fn polygon(&mut self, centre: [f64; 2], radius: f64, sides: u32, angle: f64, colour: Colour) {
        let ends = [centre[0] as f32, centre[1] as f32, angle as f32, sides as f32];
        self.push(Shape { ends, texels: [0.0; 4], radius: radius as f32, kind: Shape::POLYGON, colour });
    }

    /// A filled triangle. Its edges are not smoothed, so that triangles side by side show no seam.
    pub(super) fn triangle(&mut self, [a, b, c]: [[f64; 2]; 3], colour: Colour) {
        let ends = [a[0] as f32, a[1] as f32, b[0] as f32, b[1] as f32];
        let texels = [c[0] as f32, c[1] as f32, 0.0, 0.0];
        self.push(Shape { ends, texels, radius: 0.0, kind: Shape::TRIANGLE, colour });
    }

    /// A horizontal rule whose edges fall on pixel edges.
    pub(super) fn horizontal_rule(&mut self, from: f64, to: f64, y: f64, width: f64, colour: Colour) {
        let (top, bottom) = snapped(y, width);
        self.rectangle(Area { left: from, top, right: to, bottom }, colour);
    }

    /// A vertical rule whose edges fall on pixel edges.
    pub(super) fn vertical_rule(&mut self, x: f64, from: f64, to: f64, width: f64, colour: Colour) {
        let (left, right) = snapped(x, width);
        self.rectangle(Area { left, top: from, right, bottom: to }, colour);
    }

    /// A line of text on the baseline through `at`.
    pub(super) fn text(&mut self, text: &str, at: [f64; 2], anchor: Anchor, style: Type) {
        let start = at[0] - self.shift(text, anchor, style);
        self.glyphs(text, [start.round(), at[1].round()], [1.0, 0.0], style);
    }

    /// A line of text read upwards, on the vertical baseline through `at`.
    pub(super) fn text_upwards(&mut self, text: &str, at: [f64; 2], anchor: Anchor, style: Type) {
        let start = at[1] + self.shift(text, anchor, style);
        self.glyphs(text, [at[0].round(), start.round()], [0.0, -1.0], style);
    }

    /// A line of text whose capitals are centred on the height of `at`.
    pub(super) fn text_centred(&mut self, text: &str, at: [f64; 2], anchor: Anchor, style: Type) {
        self.text(text, [at[0], at[1] + 0.5 * CAPITAL_HEIGHT * style.size], anchor, style);
    }

    /// The headings of a page in lines of a width: a title of two lines at most, and notes below it; `sizes` are those
    /// of the two, `most` is the number of lines that notes may take.
    pub(super) fn headings(
        &self,
        title: &str,
        mut notes: Vec<String>,
        sizes: [f64; 2],
        most: usize,
        width: f64,
    ) -> Vec<Heading> {
        notes.retain(|note| !note.is_empty());
        let lines = |text: &str, style: Type, most: usize| {
            let lines = self.typesetter.wrap(text, style.weight, style.size, width, most);
            lines.into_iter().map(move |text| Heading { text, style })
        };
        let bold = Type { size: sizes[0], weight: Weight::SemiBold, colour: self.inks.ink };
        let muted = Type { size: sizes[1], weight: Weight::Regular, colour: self.inks.muted };
        lines(title, bold, 2).chain(lines(&notes.join("; "), muted, most)).collect()
    }

    /// Writes headings from a place down; returns where they end.
    pub(super) fn write_headings(&mut self, headings: &[Heading], [left, top]: [f64; 2]) -> f64 {
        headings.iter().fold(top, |y, Heading { text, style }| {
            self.text(text, [left, y + CAPITAL_HEIGHT * style.size], Anchor::Start, *style);
            y + LINE_HEIGHT * style.size
        })
    }

    fn shift(&self, text: &str, anchor: Anchor, style: Type) -> f64 {
        let width = self.typesetter.width(text, style.weight, style.size);
        match anchor {
            Anchor::Start => 0.0,
            Anchor::Middle => 0.5 * width,
            Anchor::End => width,
        }
    }

    fn glyphs(&mut self, text: &str, start: [f64; 2], along: [f64; 2], style: Type) {
        let down = [-along[1], along[0]];
        for glyph in self.typesetter.set(text, style.weight, style.size) {
            let [right, below] = glyph.offset.map(f64::from);
            let corner = [0, 1].map(|axis| (start[axis] + along[axis] * right + down[axis] * below) as f32);
            self.push(Shape {
                ends: [corner[0], corner[1], along[0] as f32, along[1] as f32],
                texels: [glyph.texel[0], glyph.texel[1], glyph.size[0], glyph.size[1]].map(|texel| texel as f32),
                radius: 0.0,
                kind: Shape::GLYPH,
                colour: style.colour,
            });
        }
    }
}

/// The pixel edges between which a rule of about this width lies, centred as nearly as possible.
fn snapped(centre: f64, width: f64) -> (f64, f64) {
    let width = width.round().max(1.0);
    let low = (centre - 0.5 * width).round();
    (low, low + width)
}
