//! Pictures of a field: what is shown, and its layout: the image of the box with axes, and the colour bar.

use super::canvas::{Anchor, Area, Canvas, Heading, Type};
use super::chart_layout::Sizes;
use super::color_map::{ColorMap, ColorScale};
use super::error::PlotError;
use super::field_renderer::{FieldScene, Image};
use super::palette::{Colour, linear};
use super::periodic::segments;
use super::text::{CAPITAL_HEIGHT, LINE_HEIGHT, Weight};
use super::ticks::{AxisMap, Ticks, ticks, ticks_along};
use crate::measure::Field;
use crate::numbers::grouped;
use crate::scene::PlotStyle;

/// A field, how it is coloured, and what to write beside it.
///
/// The box keeps its proportions; x runs to the right and y upwards. In every text `_{…}` sets an index and `^{…}` an
/// exponent.
#[derive(Debug, Clone, Copy)]
pub struct FieldPicture<'a> {
    /// The field; its label stands beside the colour bar.
    pub field: &'a Field,
    /// One line that says what is shown; may be empty.
    pub title: &'a str,
    /// Conditions, in smaller type; may be empty.
    pub subtitle: &'a str,
    /// Labels of the x and the y axis, each with its unit in parentheses.
    pub axes: [&'a str; 2],
    /// How values become colours.
    pub map: ColorMap,
    /// Values at both ends of the colour bar, so that several pictures share one; left out, they follow from the field.
    /// What lies beyond takes the colour of the end, and the bar ends in an arrowhead there. A range that is empty or
    /// not finite counts as left out.
    pub range: Option<[f64; 2]>,
    /// What is drawn between the nodes.
    pub interpolation: Interpolation,
    /// Lines over the image.
    pub curves: &'a [PeriodicCurve<'a>],
}

impl<'a> FieldPicture<'a> {
    /// A field without title or curves, with axes x and y in length units, smooth, on a sequential map that fits it.
    #[must_use]
    pub fn new(field: &'a Field) -> Self {
        Self {
            field,
            title: "",
            subtitle: "",
            axes: ["x (length units)", "y (length units)"],
            map: ColorMap::Sequential,
            range: None,
            interpolation: Interpolation::Smooth,
            curves: &[],
        }
    }
}

/// What is drawn between the nodes of a field. Where several nodes share a pixel, it shows their mean.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Interpolation {
    /// A smooth surface through the values of the nodes (default), as [`Field::cubic_at`] has it.
    #[default]
    Smooth,
    /// The value of the nearest node.
    Nearest,
}

/// A line in the periodic box, such as a loop of material.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PeriodicCurve<'a> {
    /// Points in units of length, inside the box or in any of its images. From each point the line takes the shortest
    /// way to the next; where it leaves the box it comes in again on the other side. A point that is not finite is a
    /// gap.
    pub points: &'a [[f64; 2]],
    /// Whether the last point is joined to the first.
    pub closed: bool,
}

const NEAREST: u32 = 0;
const LINEAR: u32 = 1;
const CUBIC: u32 = 2;
/// What `field.wgsl` takes for a node without a value.
const NO_VALUE: f32 = -1e30;
/// Fractions beyond this are all the same to a picture.
const FARTHEST: f64 = 1e6;
/// Neutral, and no colour of a map.
const MISSING: Colour = [0x8C, 0x8C, 0x8C, 255];
const CURVE: Colour = [255, 255, 255, 255];
const CURVE_RIM: Colour = [0x1A, 0x1A, 0x1A, 255];

/// Lays out a picture of a field: the place of its image, and the shapes around and over it.
///
/// # Errors
/// [`PlotError::Input`] if the parts of the field do not fit together; [`PlotError::Font`].
pub(super) fn lay_out(picture: &FieldPicture<'_>, style: &PlotStyle) -> Result<(Canvas, FieldScene), PlotError> {
    let field = picture.field;
    field.check().map_err(|error| PlotError::Input(error.to_string()))?;
    let scale = ColorScale::new(picture.map, picture.range, field.extrema());
    let style = &PlotStyle { height: Some(page_height(style, field.lengths)), ..style.clone() };
    let mut layout = Layout {
        canvas: Canvas::new(style.width, style.height(), style.theme)?,
        picture,
        sizes: Sizes::new(style, 1),
        axes: field.lengths.map(|high| AxisMap::linear(0.0, high)),
        scale,
    };
    let place = layout.draw();
    let scene = layout.scene(&place);
    Ok((layout.canvas, scene))
}

/// Height of the page: where the style leaves it out, one on which the image of a flat box, or of a tall one, fills the
/// width.
fn page_height(style: &PlotStyle, [wide, high]: [f64; 2]) -> u32 {
    if let Some(height) = style.height {
        return height;
    }
    let width = f64::from(style.width);
    let label = 0.02 * style.scale * width;
    // Ticks, labels and the colour bar beside the image; headings and the axis above and below it.
    let filled = (width - 11.5 * label).max(0.3 * width) * high / wide + 7.5 * label;
    let most = 0.75 * width * (high / wide).clamp(1.0, 2.0);
    2 * (0.5 * filled.clamp(0.35 * width, most)).round() as u32
}

struct Layout<'a> {
    canvas: Canvas,
    picture: &'a FieldPicture<'a>,
    sizes: Sizes,
    axes: [AxisMap; 2],
    scale: ColorScale,
}

/// Where everything goes; all of it in whole pixels.
struct Place {
    image: Area,
    /// The colour bar without its arrowheads.
    bar: Area,
    /// Edges of the whole group.
    left: f64,
    right: f64,
    /// Top of the headings.
    top: f64,
    x_ticks: Ticks,
    y_ticks: Ticks,
    bar_ticks: Ticks,
}

impl Layout<'_> {
    fn text_style(&self) -> Type {
        Type { size: self.sizes.label, weight: Weight::Regular, colour: self.canvas.inks.ink }
    }

    fn width(&self, text: &str) -> f64 {
        self.canvas.typesetter.width(text, Weight::Regular, self.sizes.label)
    }

    fn draw(&mut self) -> Place {
        let margin = 1.6 * self.sizes.gap;
        let headings = self.headings(margin);
        let place = self.place(&headings, margin);
        self.canvas.end_of_background();
        self.curves(&place);
        self.frame(place.image);
        self.x_axis(&place);
        self.y_axis(&place);
        self.colour_bar(&place);
        let setter = &self.canvas.typesetter;
        let widths = headings.iter().map(|Heading { text, style }| setter.width(text, style.weight, style.size));
        let widest = widths.fold(0.0, f64::max);
        let left = place.left.min(f64::from(self.canvas.width) - margin - widest).max(margin);
        self.canvas.write_headings(&headings, [left, place.top]);
        place
    }

    fn headings(&self, margin: f64) -> Vec<Heading> {
        let mut notes = vec![self.picture.subtitle.to_owned()];
        let missing = self.picture.field.values.iter().filter(|value| !value.is_finite()).count();
        if missing > 0 {
            let (nodes, are) = if missing == 1 { ("node", "is") } else { ("nodes", "are") };
            notes.push(format!("{} {nodes} without a value {are} grey", grouped(missing as u64)));
        }
        let width = f64::from(self.canvas.width) - 2.0 * margin;
        let Sizes { title, label, .. } = self.sizes;
        self.canvas.headings(self.picture.title, notes, [title, label], 3, width)
    }

    fn widest(&self, ticks: &Ticks) -> f64 {
        ticks.major.iter().map(|(_, text)| self.width(text)).fold(0.0, f64::max)
    }

    fn tick_length(&self) -> f64 {
        0.8 * self.sizes.gap
    }

    fn bar_width(&self) -> f64 {
        (1.15 * self.sizes.label).round().max(2.0)
    }

    /// Space that the arrowheads at both ends of the bar take; kept free in every picture of a series.
    fn arrowhead(&self) -> f64 {
        if self.picture.range.is_some() { (0.87 * self.bar_width()).ceil() + 1.0 } else { 0.0 }
    }

    /// The largest image of the box that leaves room for everything else, in the middle of the picture.
    fn place(&self, headings: &[Heading], margin: f64) -> Place {
        let guess = [self.canvas.width, self.canvas.height].map(|side| 0.7 * f64::from(side));
        // The ticks depend on the image's size, and its size on the widths of their labels.
        let mut place = self.place_with(headings, margin, guess, guess[1]);
        for _ in 0..2 {
            let image = [place.image.width(), place.image.height()];
            place = self.place_with(headings, margin, image, place.bar.height());
        }
        place
    }

    /// The same with ticks for an image of a size and a bar of a height.
    fn place_with(&self, headings: &[Heading], margin: f64, image: [f64; 2], bar_height: f64) -> Place {
        let Sizes { label, gap, .. } = self.sizes;
        let upwards = |height: f64| ((height / (1.55 * label)) as usize).clamp(2, 9);
        let x_ticks = ticks_along(&self.axes[0], image[0], label, 2, |text| self.width(text));
        let y_ticks = ticks(&self.axes[1], upwards(image[1]));
        let bar_ticks = ticks(&self.scale.bar, upwards(bar_height));
        let line = LINE_HEIGHT * label;
        let text_line = |text: &str| if text.is_empty() { 0.0 } else { line + gap };
        let beside_ticks = self.rule() + self.tick_length() + 0.6 * gap;
        let half_capital = 0.5 * CAPITAL_HEIGHT * label;
        let multiplied = y_ticks.multiplier.is_some() || bar_ticks.multiplier.is_some();
        let above = headings.iter().map(|heading| LINE_HEIGHT * heading.style.size).sum::<f64>()
            + if headings.is_empty() { 0.0 } else { gap }
            + half_capital
            + if multiplied { line + 0.5 * gap } else { 0.0 };
        let below = beside_ticks + CAPITAL_HEIGHT * label + text_line(self.picture.axes[0]);
        let left = text_line(self.picture.axes[1]) + self.widest(&y_ticks) + beside_ticks;
        let bar = self.bar_width() + beside_ticks + self.widest(&bar_ticks) + text_line(&self.picture.field.label);
        let page = [self.canvas.width, self.canvas.height].map(|side| f64::from(side) - 2.0 * margin);
        let lengths = self.picture.field.lengths;
        let high = (page[1] - above - below).max(4.0);
        let fit = |between: f64| {
            let wide = (page[0] - left - between - bar).max(4.0);
            let image = if lengths[0] / lengths[1] * high <= wide {
                [lengths[0] / lengths[1] * high, high]
            } else {
                [wide, lengths[1] / lengths[0] * wide]
            };
            // Beside a flat image the bar is higher than it, or its ticks would have no room.
            let image = image.map(|side| side.round().max(1.0));
            ([wide, high], image, image[1].max(high.min(9.0 * label)).round())
        };
        let mut between = 2.4 * gap;
        let (mut room, mut image, mut bar_height) = fit(between);
        if bar_height > image[1] {
            // There it must keep clear of the last label of the x axis.
            let last = x_ticks.major.last().map_or(0.0, |(_, text)| self.width(text));
            between = between.max(0.5 * last + 1.6 * gap);
            (room, image, bar_height) = fit(between);
        }
        let group_left = (margin + 0.5 * (room[0] - image[0])).max(0.0).floor();
        let group_top = (margin + 0.5 * (room[1] - bar_height)).max(0.0).floor();
        let corner = [(group_left + left).round(), (group_top + above + 0.5 * (bar_height - image[1])).round()];
        let bar_left = (corner[0] + image[0] + between).round();
        let bar_top = (group_top + above).round();
        let inset = self.arrowhead().min(0.25 * bar_height).floor();
        Place {
            image: Area { left: corner[0], top: corner[1], right: corner[0] + image[0], bottom: corner[1] + image[1] },
            bar: Area {
                left: bar_left,
                top: bar_top + inset,
                right: bar_left + self.bar_width(),
                bottom: bar_top + bar_height - inset,
            },
            left: group_left,
            right: corner[0] + image[0] + between + bar,
            top: group_top,
            x_ticks,
            y_ticks,
            bar_ticks,
        }
    }

    fn curves(&mut self, place: &Place) {
        let image = place.image;
        let pixel = |[x, y]: [f64; 2]| [image.left + x * image.width(), image.bottom - y * image.height()];
        let curves = self.picture.curves;
        let segments: Vec<_> =
            curves.iter().flat_map(|curve| segments(curve.points, curve.closed, self.picture.field.lengths)).collect();
        let width = 0.9 * self.sizes.line;
        self.canvas.clip(Some(image));
        // The dark rim keeps the line visible on light colours.
        for (width, colour) in [(2.2 * width, CURVE_RIM), (width, CURVE)] {
            for (from, to) in &segments {
                self.canvas.line(pixel(*from), pixel(*to), width, colour);
            }
        }
        self.canvas.clip(None);
    }

    /// Width of a rule in whole pixels.
    fn rule(&self) -> f64 {
        self.sizes.rule.round().max(1.0)
    }

    /// Rules around an area, outside it.
    fn frame(&mut self, area: Area) {
        let rule = self.rule();
        let around = area.grown(0.5 * rule);
        let ends = area.grown(rule);
        for x in [around.left, around.right] {
            self.canvas.vertical_rule(x, ends.top, ends.bottom, rule, self.canvas.inks.ink);
        }
        for y in [around.top, around.bottom] {
            self.canvas.horizontal_rule(ends.left, ends.right, y, rule, self.canvas.inks.ink);
        }
    }

    /// Ticks by place and length, the long ones with their labels; no label overlaps the one before it.
    fn marks(ticks: &Ticks, place: impl Fn(f64) -> f64, extent: impl Fn(&str) -> f64) -> Vec<(f64, Option<String>)> {
        let mut marks = Vec::new();
        let mut taken: Option<(f64, f64)> = None;
        for (value, text) in ticks.all() {
            let at = place(value);
            let half = 0.5 * text.map_or(0.0, &extent);
            let free = text.is_some() && taken.is_none_or(|(low, high)| at - half > high || at + half < low);
            if free {
                taken = Some((at - half, at + half));
            }
            marks.push((at, text.map(|text| if free { text.to_owned() } else { String::new() })));
        }
        marks
    }

    fn x_axis(&mut self, place: &Place) {
        let Sizes { label, gap, .. } = self.sizes;
        let (area, style, rule) = (place.image, self.text_style(), self.rule());
        let foot = area.bottom + rule;
        let fraction = |value| self.axes[0].fraction(value).unwrap_or(0.0);
        let at = |value| area.left + fraction(value) * area.width();
        let marks = Self::marks(&place.x_ticks, at, |text| self.width(text) + 0.3 * label);
        let baseline = foot + self.tick_length() + 0.6 * gap + CAPITAL_HEIGHT * label;
        for (x, text) in marks {
            let length = if text.is_some() { self.tick_length() } else { 0.45 * gap };
            self.canvas.vertical_rule(x, foot, foot + length, rule, style.colour);
            self.canvas.text(text.as_deref().unwrap_or(""), [x, baseline], Anchor::Middle, style);
        }
        let baseline = baseline + 0.8 * gap + CAPITAL_HEIGHT * label + 0.2 * label;
        // Under a narrow image the label may stand out on both sides.
        let middle = area.centre()[0];
        let room = 2.0 * (middle - place.left).min(place.right - middle);
        let mut text = self.picture.axes[0].to_owned();
        if let Some(multiplier) = &place.x_ticks.multiplier {
            let beside = 2.0 * (area.right - middle - self.width(multiplier) - gap);
            if self.width(&text) <= beside {
                self.canvas.text(multiplier, [area.right, baseline], Anchor::End, style);
            } else {
                text = format!("{multiplier} {text}");
            }
        }
        let text = self.canvas.typesetter.shorten(&text, style.weight, label, room);
        self.canvas.text(&text, [middle, baseline], Anchor::Middle, style);
    }

    /// Ticks on the side of an area where their labels end, which is the left one, or start.
    fn side_ticks(&mut self, ticks: &Ticks, axis: AxisMap, area: Area, anchor: Anchor) {
        let Sizes { label, gap, .. } = self.sizes;
        let (style, rule, long) = (self.text_style(), self.rule(), self.tick_length());
        let (foot, outward) = if anchor == Anchor::End { (area.left - rule, -1.0) } else { (area.right + rule, 1.0) };
        let at = |value| area.bottom - axis.fraction(value).unwrap_or(0.0) * area.height();
        for (y, text) in Self::marks(ticks, at, |_| label) {
            let end = foot + outward * if text.is_some() { long } else { 0.45 * gap };
            self.canvas.horizontal_rule(foot.min(end), foot.max(end), y, rule, style.colour);
            let beside = [foot + outward * long + outward * 0.6 * gap, y];
            self.canvas.text_centred(text.as_deref().unwrap_or(""), beside, anchor, style);
        }
    }

    fn y_axis(&mut self, place: &Place) {
        let Sizes { label, gap, .. } = self.sizes;
        let (area, style, rule) = (place.image, self.text_style(), self.rule());
        let foot = area.left - rule;
        self.side_ticks(&place.y_ticks, self.axes[1], area, Anchor::End);
        if let Some(multiplier) = &place.y_ticks.multiplier {
            self.canvas.text(multiplier, [foot - self.tick_length(), area.top - 0.8 * gap], Anchor::Start, style);
        }
        let room = area.height().max(place.bar.height());
        let text = self.canvas.typesetter.shorten(self.picture.axes[1], style.weight, label, room);
        let baseline = place.left + CAPITAL_HEIGHT * label;
        self.canvas.text_upwards(&text, [baseline, area.centre()[1]], Anchor::Middle, style);
    }

    fn colour_bar(&mut self, place: &Place) {
        let Sizes { label, gap, .. } = self.sizes;
        let (bar, style, rule) = (place.bar, self.text_style(), self.rule());
        self.arrowheads(bar);
        let rows = bar.height().max(1.0) as u32;
        for row in 0..rows {
            let top = bar.top + f64::from(row);
            let colour = self.scale.bar_colour(1.0 - (f64::from(row) + 0.5) / f64::from(rows));
            self.canvas.rectangle(Area { left: bar.left, top, right: bar.right, bottom: top + 1.0 }, colour);
        }
        self.frame(bar);
        let foot = bar.right + rule;
        self.side_ticks(&place.bar_ticks, self.scale.bar, bar, Anchor::Start);
        let name = &self.picture.field.label;
        let labels_end = foot + self.tick_length() + 0.6 * gap + self.widest(&place.bar_ticks);
        if let Some(multiplier) = &place.bar_ticks.multiplier {
            // Over the label of the last tick, which may stand at the very top.
            let above = self.arrowhead().max(0.5 * CAPITAL_HEIGHT * label) + 0.8 * gap;
            let left = bar.left.min(place.right - self.width(multiplier));
            self.canvas.text(multiplier, [left, bar.top - above], Anchor::Start, style);
        }
        let room = bar.height() + 2.0 * self.arrowhead();
        let text = self.canvas.typesetter.shorten(name, style.weight, label, room);
        let baseline = labels_end + gap + 0.95 * label;
        self.canvas.text_upwards(&text, [baseline, bar.centre()[1]], Anchor::Middle, style);
    }

    /// Arrowheads where values lie beyond the ends of the bar.
    fn arrowheads(&mut self, bar: Area) {
        let Some([lowest, highest]) = self.picture.field.extrema() else { return };
        let range = self.scale.bar;
        let ends = [(highest > range.high, bar.top, -1.0, 1.0), (lowest < range.low, bar.bottom, 1.0, 0.0)];
        let drawn = |(beyond, ..): &(bool, f64, f64, f64)| *beyond && self.picture.range.is_some();
        for (_, base, direction, fraction) in ends.into_iter().filter(drawn) {
            let radius = bar.width() / 3.0_f64.sqrt();
            let centre = [bar.centre()[0], base + direction * 0.5 * radius];
            let angle = direction * std::f64::consts::FRAC_PI_2;
            self.canvas.polygon(centre, radius + 2.0 * self.rule(), 3, angle, self.canvas.inks.ink);
            self.canvas.polygon(centre, radius, 3, angle, self.scale.bar_colour(fraction));
        }
    }

    fn scene(&self, place: &Place) -> FieldScene {
        let field = self.picture.field;
        let image = place.image;
        let pixels = [image.width(), image.height()];
        let nodes_per_pixel = [0, 1].map(|axis| field.nodes[axis] as f64 / pixels[axis]);
        let interpolation = match self.picture.interpolation {
            Interpolation::Nearest => NEAREST,
            // So many nodes in a pixel that their mean needs nothing between them.
            Interpolation::Smooth if nodes_per_pixel.iter().all(|nodes| *nodes >= 2.0) => NEAREST,
            Interpolation::Smooth if nodes_per_pixel.iter().all(|nodes| *nodes <= 1.0) => CUBIC,
            Interpolation::Smooth => LINEAR,
        };
        let fraction = |value: &f64| match self.scale.fraction(*value) {
            Some(fraction) => fraction.clamp(-FARTHEST, FARTHEST) as f32,
            None => NO_VALUE,
        };
        let [red, green, blue, _] = MISSING.map(linear);
        let image = Image {
            area: [image.left, image.top, pixels[0], pixels[1]].map(|pixels| pixels as f32),
            nodes: field.nodes.map(|nodes| nodes as i32),
            samples: nodes_per_pixel.map(|nodes| nodes.ceil().max(1.0) as i32),
            limits: self.scale.limits().map(|limit| limit as f32),
            interpolation,
            padding: 0,
            missing: [red, green, blue, 1.0],
        };
        let fractions = field.values.iter().map(fraction).collect();
        FieldScene { image, fractions, table: self.scale.colours.clone() }
    }
}
