//! Charts as vector graphics: the shapes of a canvas as paths, in SVG and in PDF. Letters are outlines, so that they look alike everywhere.

use super::canvas::{Area, Canvas, Shape};
use super::palette::{Colour, encoded, linear};
use super::text::Letter;
use ab_glyph::OutlineCurve;
use pdf_writer::types::{LineCapStyle, LineJoinStyle};
use pdf_writer::{Content, Filter, Finish, Name, Pdf, Rect, Ref, TextStr};
use std::collections::{BTreeSet, HashMap};
use std::f64::consts::TAU;
use svg::Node as _;
use svg::node::element::path::Data;
use svg::node::element::{ClipPath, Definitions, Element, Group, Path as Drawn, Rectangle, Title};

/// Length of a pixel in points, 1/72 inch, and in millimetres: 300 of them are an inch.
const POINTS: f64 = 72.0 / 300.0;
const MILLIMETRES: f64 = 25.4 / 300.0;

/// One stroke or filling.
struct Path {
    commands: Vec<Command>,
    /// The width of a line with round ends and corners; none of what is filled.
    width: Option<f32>,
    colour: Colour,
    clip: Option<Area>,
}

/// A part of a path, in pixels from the upper left corner.
#[derive(Clone, Copy)]
enum Command {
    Move([f64; 2]),
    Line([f64; 2]),
    Cubic([[f64; 2]; 3]),
    Close,
}

/// A chart as SVG, with the title and a note that readers of the file find, and no picture shows.
pub(super) fn svg(canvas: &Canvas, title: &str, note: &str) -> String {
    let (width, height) = (canvas.width, canvas.height);
    let mut clips: Vec<Area> = Vec::new();
    for area in canvas.batches.iter().filter_map(|batch| batch.clip) {
        if !clips.contains(&area) {
            clips.push(area);
        }
    }
    let definitions = clips.iter().enumerate().fold(Definitions::new(), |definitions, (number, area)| {
        let [x, y, width, height] = [area.left, area.top, area.width(), area.height()].map(rounded);
        let inside = Rectangle::new().set("x", x).set("y", y).set("width", width).set("height", height);
        definitions.add(ClipPath::new().set("id", format!("area-{number}")).add(inside))
    });
    let mut drawn = Group::new();
    for path in paths(canvas) {
        let data = path.commands.iter().fold(Data::new(), |data, command| match *command {
            Command::Move([x, y]) => data.move_to((rounded(x), rounded(y))),
            Command::Line([x, y]) => data.line_to((rounded(x), rounded(y))),
            Command::Cubic(points) => {
                data.cubic_curve_to(points.as_flattened().iter().map(|part| rounded(*part)).collect::<Vec<f32>>())
            }
            Command::Close => data.close(),
        });
        let [r, g, b, alpha] = path.colour;
        let colour = format!("#{r:02x}{g:02x}{b:02x}");
        let mut element = Drawn::new().set("d", data);
        let opacity = (alpha < 255).then(|| rounded(f64::from(alpha) / 255.0));
        element = match path.width {
            Some(width) => element.set("stroke", colour).set("stroke-width", rounded(width.into())).set("fill", "none"),
            None => element.set("fill", colour),
        };
        if let Some(opacity) = opacity {
            element = element.set(if path.width.is_some() { "stroke-opacity" } else { "fill-opacity" }, opacity);
        }
        if let Some(number) = path.clip.and_then(|area| clips.iter().position(|clip| *clip == area)) {
            element = element.set("clip-path", format!("url(#area-{number})"));
        }
        drawn = drawn.add(element);
    }
    let [r, g, b, _] = canvas.inks.paper;
    let paper =
        Rectangle::new().set("width", width).set("height", height).set("fill", format!("#{r:02x}{g:02x}{b:02x}"));
    let drawn = drawn.set("stroke-linecap", "round").set("stroke-linejoin", "round");
    let size = |pixels: u32| format!("{:.2}mm", f64::from(pixels) * MILLIMETRES);
    let mut described = Element::new("metadata");
    described.append(svg::node::Text::new(note));
    let document = svg::Document::new()
        .set("viewBox", (0, 0, width, height))
        .set("width", size(width))
        .set("height", size(height))
        .add(Title::new(title))
        .add(described)
        .add(definitions)
        .add(paper)
        .add(drawn);
    format!("{document}\n")
}

/// Hundredths of a pixel.
fn rounded(value: f64) -> f32 {
    ((100.0 * value).round() / 100.0) as f32
}

/// A chart as a page of PDF, with the title and a note as its subject.
pub(super) fn pdf(canvas: &Canvas, title: &str, note: &str) -> Vec<u8> {
    let [catalog, pages, page, contents, about] = [1, 2, 3, 4, 5].map(Ref::new);
    let point = |[x, y]: [f64; 2]| [x * POINTS, (f64::from(canvas.height) - y) * POINTS].map(rounded);
    let mut content = Content::new();
    let fraction = |part: u8| f32::from(part) / 255.0;
    let [r, g, b, _] = canvas.inks.paper.map(fraction);
    let [right, top] = [canvas.width, canvas.height].map(|pixels| (f64::from(pixels) * POINTS) as f32);
    content.set_fill_rgb(r, g, b).rect(0.0, 0.0, right, top).fill_nonzero();
    content.set_line_cap(LineCapStyle::RoundCap).set_line_join(LineJoinStyle::RoundJoin);
    let mut opacities = BTreeSet::new();
    for path in paths(canvas) {
        content.save_state();
        if let Some(area) = path.clip {
            let [[left, bottom], [right, top]] = [[area.left, area.bottom], [area.right, area.top]].map(point);
            content.rect(left, bottom, right - left, top - bottom).clip_nonzero().end_path();
        }
        let [r, g, b, _] = path.colour.map(fraction);
        opacities.insert(path.colour[3]);
        content.set_parameters(Name(opacity(path.colour[3]).as_bytes()));
        match path.width {
            Some(width) => content.set_stroke_rgb(r, g, b).set_line_width(rounded(f64::from(width) * POINTS)),
            None => content.set_fill_rgb(r, g, b),
        };
        for command in &path.commands {
            match *command {
                Command::Move(at) => {
                    let [x, y] = point(at);
                    content.move_to(x, y)
                }
                Command::Line(at) => {
                    let [x, y] = point(at);
                    content.line_to(x, y)
                }
                Command::Cubic(points) => {
                    let [[x1, y1], [x2, y2], [x3, y3]] = points.map(point);
                    content.cubic_to(x1, y1, x2, y2, x3, y3)
                }
                Command::Close => content.close_path(),
            };
        }
        if path.width.is_some() {
            content.stroke()
        } else {
            content.fill_nonzero()
        };
        content.restore_state();
    }
    let mut pdf = Pdf::new();
    pdf.catalog(catalog).pages(pages);
    pdf.pages(pages).kids([page]).count(1);
    pdf.document_info(about).title(TextStr(title)).subject(TextStr(note));
    let mut described = pdf.page(page);
    described.media_box(Rect::new(0.0, 0.0, right, top)).parent(pages).contents(contents);
    let mut resources = described.resources();
    let mut states = resources.ext_g_states();
    for alpha in opacities {
        let part = fraction(alpha);
        states
            .insert(Name(opacity(alpha).as_bytes()))
            .start::<pdf_writer::writers::ExtGraphicsState<'_>>()
            .stroking_alpha(part)
            .non_stroking_alpha(part);
    }
    states.finish();
    resources.finish();
    described.finish();
    let packed = miniz_oxide::deflate::compress_to_vec_zlib(&content.finish(), 6);
    pdf.stream(contents, &packed).filter(Filter::FlateDecode);
    pdf.finish()
}

/// A colour whose opacity makes the same of the paper as in pictures: these blend light, and vector graphics blend its codes.
fn on_paper(colour: Colour, paper: Colour) -> Colour {
    let part = f64::from(colour[3]) / 255.0;
    let distances = (0..3).map(|channel| {
        let [own, under] = [colour, paper].map(|colour| f64::from(linear(colour[channel])));
        let blended = encoded(part * own + (1.0 - part) * under);
        let [own, under] = [colour, paper].map(|colour| f64::from(colour[channel]) / 255.0);
        [blended - under, own - under]
    });
    let [sum, square] = distances.fold([0.0; 2], |sums, [blended, own]| [sums[0] + blended * own, sums[1] + own * own]);
    let alpha = if square > 0.0 && colour[3] < 255 { (255.0 * sum / square).round() as u8 } else { colour[3] };
    [colour[0], colour[1], colour[2], alpha]
}

/// The name of an opacity.
fn opacity(alpha: u8) -> String {
    format!("opacity{alpha}")
}

/// The paths of all shapes. What follows each other with one colour is one path: lines that go on have corners and no seams, and so have
/// triangles side by side.
fn paths(canvas: &Canvas) -> Vec<Path> {
    let letters = canvas.typesetter.letters();
    let mut found: Vec<Path> = Vec::new();
    for batch in &canvas.batches {
        for (place, shape) in batch.shapes.iter().enumerate() {
            let (commands, width) = of_shape(shape, &letters);
            let colour = on_paper(shape.colour, canvas.inks.paper);
            let like = |before: &Path| before.colour == colour && before.width == width && before.clip == batch.clip;
            // Lines that do not go on may cross, which would show where they are translucent.
            let (first, rest) = (commands.first().copied(), commands.get(1..).unwrap_or_default());
            match (found.last_mut().filter(|before| place > 0 && like(before)), first) {
                (Some(before), Some(Command::Move(start))) if width.is_some() => match before.commands.last() {
                    Some(Command::Line(end)) if *end == start => before.commands.extend(rest),
                    _ if colour[3] == 255 => before.commands.extend(commands),
                    _ => found.push(Path { commands, width, colour, clip: batch.clip }),
                },
                (Some(before), _) => before.commands.extend(commands),
                _ => found.push(Path { commands, width, colour, clip: batch.clip }),
            }
        }
    }
    found
}

/// The path of a shape, and the width of its line, if it is one.
fn of_shape(shape: &Shape, letters: &HashMap<[u32; 2], Letter>) -> (Vec<Command>, Option<f32>) {
    let [a, b, c, d] = shape.ends.map(f64::from);
    let closed = |corners: &[[f64; 2]]| {
        let lines = corners.iter().skip(1).map(|corner| Command::Line(*corner));
        corners.first().map(|first| Command::Move(*first)).into_iter().chain(lines).chain([Command::Close]).collect()
    };
    match shape.kind {
        Shape::CAPSULE => (vec![Command::Move([a, b]), Command::Line([c, d])], Some(2.0 * shape.radius)),
        Shape::RECTANGLE => (closed(&[[a, b], [c, b], [c, d], [a, d]]), None),
        Shape::POLYGON => {
            let corner = |number: u32| {
                let angle = c + TAU * f64::from(number) / d;
                [a + f64::from(shape.radius) * angle.cos(), b + f64::from(shape.radius) * angle.sin()]
            };
            (closed(&(0..d as u32).map(corner).collect::<Vec<_>>()), None)
        }
        Shape::TRIANGLE => {
            let mut corners = [[a, b], [c, d], [f64::from(shape.texels[0]), f64::from(shape.texels[1])]];
            let [[x1, y1], [x2, y2], [x3, y3]] = corners;
            // All the same way round, so that they fill one area.
            if (x2 - x1) * (y3 - y1) < (x3 - x1) * (y2 - y1) {
                corners.swap(1, 2);
            }
            (closed(&corners), None)
        }
        _ => (letter(shape, letters), None),
    }
}

/// The outline of a letter.
fn letter(shape: &Shape, letters: &HashMap<[u32; 2], Letter>) -> Vec<Command> {
    let [x, y, along_x, along_y] = shape.ends.map(f64::from);
    let texel = [shape.texels[0] as u32, shape.texels[1] as u32];
    let Some(Letter { curves, scale, corner: [right, below] }) = letters.get(&texel) else { return Vec::new() };
    // From the corner of its texels to the start of its baseline; curves have y upwards.
    let place = |point: ab_glyph::Point| {
        let (forth, down) = (f64::from(point.x) * scale - right, -f64::from(point.y) * scale - below);
        [x + along_x * forth - along_y * down, y + along_y * forth + along_x * down]
    };
    let mut commands = Vec::new();
    let mut last = None;
    for curve in curves {
        let (start, end, command) = match curve {
            OutlineCurve::Line(a, b) => (*a, *b, Command::Line(place(*b))),
            OutlineCurve::Quad(a, b, c) => {
                let towards = |end: ab_glyph::Point| {
                    place(ab_glyph::point(end.x + (b.x - end.x) * 2.0 / 3.0, end.y + (b.y - end.y) * 2.0 / 3.0))
                };
                (*a, *c, Command::Cubic([towards(*a), towards(*c), place(*c)]))
            }
            OutlineCurve::Cubic(a, b, c, d) => (*a, *d, Command::Cubic([place(*b), place(*c), place(*d)])),
        };
        if last != Some(start) {
            if last.is_some() {
                commands.push(Command::Close);
            }
            commands.push(Command::Move(place(start)));
        }
        commands.push(command);
        last = Some(end);
    }
    commands.push(Command::Close);
    commands
}
