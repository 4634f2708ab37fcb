//! Pictures of fields, drawn on whatever adapter there is and examined pixel by pixel, and array files. Every picture
//! is also left in `target/tmp` for the eye.

use image::RgbaImage;
use mesoscope::measure::Field;
use mesoscope::output::{OutputError, write_npy, write_npy_to};
use mesoscope::plot::{ColorMap, FieldPicture, Interpolation, PeriodicCurve, PlotError, Plotter};
use mesoscope::scene::{PlotStyle, Theme};
use std::f64::consts::TAU;
use std::path::Path;

use crate::support::gpu;
use crate::support::plotter::{plotter, save};

const LOWEST: [u8; 3] = [68, 1, 84];
const MIDDLE: [u8; 3] = [33, 144, 141];
const HIGHEST: [u8; 3] = [253, 231, 37];
const MISSING: [u8; 3] = [0x8C; 3];
const INK: [u8; 3] = [0x1A; 3];

fn draw(name: &str, picture: &FieldPicture<'_>, style: &PlotStyle) -> RgbaImage {
    let drawn = save(&format!("field-{name}"), plotter().draw_field(picture, style).unwrap());
    assert_eq!((drawn.width(), drawn.height()), (style.width, style.height.unwrap_or(drawn.height())));
    drawn
}

fn small() -> PlotStyle {
    PlotStyle { width: 800, height: Some(600), ..PlotStyle::default() }
}

fn close(pixel: [u8; 3], colour: [u8; 3], tolerance: u8) -> bool {
    (0..3).all(|channel| pixel[channel].abs_diff(colour[channel]) <= tolerance)
}

fn pixel(picture: &RgbaImage, [x, y]: [f64; 2]) -> [u8; 3] {
    let [red, green, blue, _] = picture.get_pixel(x.floor() as u32, y.floor() as u32).0;
    [red, green, blue]
}

/// Insides of the frames in a picture: left, top, right, bottom.
struct Frames {
    image: [f64; 4],
    bar: [f64; 4],
}

/// Runs of ink that are longer than most letters: row, first column and the one after the last.
fn runs(picture: &RgbaImage, ink: [u8; 3]) -> Vec<[u32; 3]> {
    let mut runs = Vec::new();
    for y in 0..picture.height() {
        let mut start = 0;
        for x in 0..=picture.width() {
            if x == picture.width() || !close(pixel(picture, [f64::from(x), f64::from(y)]), ink, 8) {
                if x - start >= 14 {
                    runs.push([y, start, x]);
                }
                start = x + 1;
            }
        }
    }
    runs
}

/// The inside of the frame whose rules above and below are among these runs; ticks may lengthen them.
fn inside(picture: &RgbaImage, ink: [u8; 3], rules: &[[u32; 3]]) -> [f64; 4] {
    let (top, bottom) = (rules[0][0], rules[rules.len() - 1][0]);
    let (left, right) =
        (rules.iter().map(|rule| rule[1]).min().unwrap(), rules.iter().map(|rule| rule[2]).max().unwrap());
    let upright = |x: &u32| (top..=bottom).all(|y| close(pixel(picture, [f64::from(*x), f64::from(y)]), ink, 8));
    let columns: Vec<u32> = (left..right).filter(upright).collect();
    let width = columns.len() as u32 / 2;
    let (first, last) = (columns[0], columns[columns.len() - 1]);
    [first + width, top + width, last + 1 - width, bottom + 1 - width].map(f64::from)
}

fn frames_in(picture: &RgbaImage, ink: [u8; 3]) -> Frames {
    let runs = runs(picture, ink);
    // Ticks stand out of the image to the left and below, and out of the bar to the right.
    let longest = runs.iter().max_by_key(|[_, start, end]| end - start).unwrap();
    let of_image: Vec<[u32; 3]> = runs.iter().copied().filter(|run| run[2] == longest[2]).collect();
    let image = inside(picture, ink, &of_image);
    let mut of_bar: Vec<[u32; 3]> = Vec::new();
    for start in longest[2]..picture.width() {
        let alike: Vec<[u32; 3]> = runs.iter().copied().filter(|run| run[1] == start).collect();
        let extent = |runs: &[[u32; 3]]| if runs.is_empty() { 0 } else { runs[runs.len() - 1][0] - runs[0][0] };
        if extent(&alike) > extent(&of_bar) {
            of_bar = alike;
        }
    }
    Frames { image, bar: inside(picture, ink, &of_bar) }
}

fn frames(picture: &RgbaImage) -> Frames {
    frames_in(picture, INK)
}

impl Frames {
    /// The pixel at fractions of the image, from the left and from below.
    fn at(&self, [x, y]: [f64; 2]) -> [f64; 2] {
        let [left, top, right, bottom] = self.image;
        [(left + x * (right - left)).min(right - 0.5), (bottom - y * (bottom - top)).clamp(top + 0.5, bottom - 0.5)]
    }

    /// Width over height of the image.
    fn aspect(&self) -> f64 {
        let [left, top, right, bottom] = self.image;
        (right - left) / (bottom - top)
    }
}

fn front(nodes: [usize; 2]) -> Field {
    Field::from_function("potential vorticity", "potential vorticity q (f_{0}/H_{0})", nodes, [TAU; 2], |[x, y]| {
        ((y + 0.1 * ((3.0 * x).sin() - (2.0 * x).sin())).sin() / 0.5).tanh()
    })
}

#[test]
fn a_front_as_it_is_published() {
    let field = front([64, 64]);
    let picture = FieldPicture {
        title: "Rotating shallow water: a shear front",
        subtitle: "t = 0, 64 × 64 nodes, 65,536 particles",
        axes: ["x (length units)", "y (length units)"],
        ..FieldPicture::new(&field)
    };
    let light = draw("front", &picture, &PlotStyle::default());
    assert_eq!(light, plotter().draw_field(&picture, &PlotStyle::default()).unwrap(), "the same bytes twice");
    let another = Plotter::new(gpu()).unwrap();
    assert_eq!(light, another.draw_field(&picture, &PlotStyle::default()).unwrap());
    assert!((frames(&light).aspect() - 1.0).abs() < 2e-3);
    let margins = |picture: &RgbaImage| {
        let (width, height) = picture.dimensions();
        picture
            .enumerate_pixels()
            .filter(|(x, y, _)| *x < 12 || *y < 12 || *x >= width - 12 || *y >= height - 12)
            .count()
            - picture
                .enumerate_pixels()
                .filter(|(x, y, pixel)| {
                    (*x < 12 || *y < 12 || *x >= width - 12 || *y >= height - 12) && **pixel == *picture.get_pixel(0, 0)
                })
                .count()
    };
    assert_eq!(margins(&light), 0, "nothing runs into the edges of the picture");

    // A material loop around the front, and one that drifts over an edge.
    let loops: Vec<Vec<[f64; 2]>> = [[3.0, 3.0, 1.2], [6.0, 1.0, 0.8]]
        .iter()
        .map(|[x, y, radius]| {
            (0..400)
                .map(|i| f64::from(i) * TAU / 400.0)
                .map(|angle| [x + radius * angle.cos(), (y + radius * angle.sin()).rem_euclid(TAU)])
                .collect()
        })
        .collect();
    let curves: Vec<PeriodicCurve<'_>> = loops.iter().map(|points| PeriodicCurve { points, closed: true }).collect();
    let signed = FieldPicture { map: ColorMap::Diverging { centre: 0.0 }, curves: &curves, ..picture };
    let drawn = draw("front-loops", &signed, &PlotStyle::default());
    let place = frames(&drawn);
    for [x, y] in [[4.2, 3.0], [1.8, 3.0], [3.0, 4.2], [6.8 - TAU, 1.0], [5.2, 1.0], [6.0, 0.2], [6.0, 1.8]] {
        let [column, row] = place.at([x / TAU, y / TAU]);
        let white =
            (-3..=3).any(|i| (-3..=3).any(|j| pixel(&drawn, [column + f64::from(i), row + f64::from(j)]) == [255; 3]));
        assert!(white, "the loop passes through {x}, {y}");
    }
    let dark = PlotStyle { theme: Theme::Dark, ..PlotStyle::default() };
    let drawn = draw("front-dark", &picture, &dark);
    assert!(drawn.get_pixel(0, 0).0[..3].iter().all(|channel| *channel < 40));
    let place = frames_in(&drawn, [0xEC; 3]);
    assert_eq!(pixel(&drawn, place.at([0.5, 0.25])), pixel(&light, frames(&light).at([0.5, 0.25])), "the same map");
}

#[test]
fn x_runs_to_the_right_and_y_upwards() {
    // A peak off every symmetry.
    let peak = |[x, y]: [f64; 2]| (-((x - 1.5) / 0.5).powi(2) - ((y - 0.25) / 0.2).powi(2)).exp();
    let field = Field::from_function("peak", "height", [64, 32], [6.0, 2.0], peak);
    let drawn = draw("peak", &FieldPicture::new(&field), &small());
    let place = frames(&drawn);
    assert!((place.aspect() - 3.0).abs() < 0.02, "{}", place.aspect());
    assert!(close(pixel(&drawn, place.at([0.25, 0.125])), HIGHEST, 3));
    for other in [[0.75, 0.125], [0.25, 0.875], [0.75, 0.875], [0.125, 0.75]] {
        assert!(close(pixel(&drawn, place.at(other)), LOWEST, 3), "{other:?}");
    }
}

#[test]
fn nodes_have_the_colours_of_their_values() {
    // Every node the colour of its rank, and a cell of its own: the first ones lie on the edges, half on either side.
    let nodes = [5, 3];
    let values: Vec<f64> = (0..15).map(f64::from).collect();
    let field = Field { name: "rank".into(), label: "rank".into(), nodes, lengths: [5.0, 3.0], values };
    let picture = FieldPicture { interpolation: Interpolation::Nearest, ..FieldPicture::new(&field) };
    let drawn = draw("nearest", &picture, &small());
    let place = frames(&drawn);
    let colour_on_bar = |value: f64| {
        let [left, top, right, bottom] = place.bar;
        pixel(&drawn, [0.5 * (left + right), (bottom - value / 14.0 * (bottom - top)).clamp(top + 0.5, bottom - 0.5)])
    };
    for kx in 0..5 {
        for ky in 0..3 {
            let expected = colour_on_bar(field.at(kx, ky));
            for offset in [[0.0, 0.0], [0.4, 0.4], [-0.4, 0.4], [0.4, -0.4], [-0.4, -0.4]] {
                let along = |k: usize, axis: usize| ((k as f64 + offset[axis]) / nodes[axis] as f64).rem_euclid(1.0);
                let found = pixel(&drawn, place.at([along(kx, 0), along(ky, 1)]));
                assert!(close(found, expected, 3), "node {kx} {ky} at {offset:?}: {found:?}, not {expected:?}");
            }
        }
    }
    assert!(close(colour_on_bar(0.0), LOWEST, 2));
    assert!(close(colour_on_bar(14.0), HIGHEST, 2));
    assert!(close(colour_on_bar(7.0), MIDDLE, 3));
}

#[test]
fn between_nodes_the_image_is_the_cubic_surface() {
    let field = Field::from_function("waves", "value", [16, 12], [4.0, 3.0], |[x, y]| {
        (TAU * x / 4.0).sin() + 0.5 * (TAU * (2.0 * y / 3.0 + x / 4.0)).cos()
    });
    let picture = FieldPicture { range: Some([-2.0, 2.0]), ..FieldPicture::new(&field) };
    let drawn = draw("waves", &picture, &small());
    let place = frames(&drawn);
    let [left, top, right, bottom] = place.image;
    let [_, bar_top, bar_right, bar_bottom] = place.bar;
    let mut seen = std::collections::HashSet::new();
    for column in (left as u32..right as u32).step_by(17) {
        for row in (top as u32..bottom as u32).step_by(13) {
            let fraction_x = (f64::from(column) + 0.5 - left) / (right - left);
            let fraction_y = (bottom - f64::from(row) - 0.5) / (bottom - top);
            let value = field.cubic_at([4.0 * fraction_x, 3.0 * fraction_y]);
            let height = (value + 2.0) / 4.0 * (bar_bottom - bar_top);
            let expected = pixel(&drawn, [bar_right - 2.0, (bar_bottom - height).floor()]);
            let found = pixel(&drawn, [f64::from(column), f64::from(row)]);
            assert!(close(found, expected, 3), "{column} {row}: {found:?}, not {expected:?}");
            seen.insert(found);
        }
    }
    assert!(seen.len() > 100, "the picture has many colours: {}", seen.len());
}

#[test]
fn a_diverging_map_is_white_at_its_centre() {
    let field = Field::from_function("tilt", "deviation", [64, 8], [8.0, 4.0], |[x, _]| 3.0 + (TAU * x / 8.0).sin());
    let map = ColorMap::Diverging { centre: 3.0 };
    let drawn = draw("diverging", &FieldPicture { map, ..FieldPicture::new(&field) }, &small());
    let place = frames(&drawn);
    let [red, white, blue] = [0.25, 0.5, 0.75].map(|x| pixel(&drawn, place.at([x, 0.5])));
    assert!(red[0] > red[2].saturating_add(60) && blue[2] > blue[0].saturating_add(60), "{red:?} {blue:?}");
    assert!(white.iter().all(|channel| *channel > 225), "{white:?}");
    // Only part of the lower arm is on the bar; equal distances from the centre stay equally dark.
    let range = Some([2.5, 4.0]);
    let drawn = draw("diverging-range", &FieldPicture { map, range, ..FieldPicture::new(&field) }, &small());
    let place = frames(&drawn);
    assert!(close(pixel(&drawn, place.at([0.25, 0.5])), red, 6));
    let [left, top, right, bottom] = place.bar;
    let third = pixel(&drawn, [0.5 * (left + right), bottom - (bottom - top) / 3.0]);
    assert!(third.iter().all(|channel| *channel > 225), "{third:?}");
    let end = pixel(&drawn, [0.5 * (left + right), bottom - 0.5]);
    assert!(close(pixel(&drawn, place.at([0.75, 0.5])), end, 3), "beyond the range: the colour of the end");
    // Arrowheads of the colour of the end, below the bar only.
    assert!(close(pixel(&drawn, [0.5 * (left + right), bottom + 6.0]), end, 3));
    assert_eq!(pixel(&drawn, [0.5 * (left + right), top - 6.0]), [255; 3]);
}

#[test]
fn a_shared_range_keeps_every_frame_of_a_series_alike() {
    let at = |strength: f64| Field::from_function("h", "depth", [32, 32], [2.0, 2.0], |[x, _]| strength * x);
    let picture = |field: &Field| {
        let picture = FieldPicture { range: Some([0.0, 1.0]), title: "depth", ..FieldPicture::new(field) };
        plotter().draw_field(&picture, &small()).unwrap()
    };
    let (weak, strong) = (picture(&at(0.2)), picture(&at(5.0)));
    assert_eq!((frames(&weak).image, frames(&weak).bar), (frames(&strong).image, frames(&strong).bar));
    assert!(close(pixel(&strong, frames(&strong).at([0.8, 0.5])), HIGHEST, 1));
}

#[test]
fn constant_fields_and_nodes_without_a_value() {
    for value in [0.0, 1.0, -4e-12, 1e300, -7e299, f64::MIN_POSITIVE] {
        let field = Field::from_function("constant", "value", [16, 16], [1.0, 1.0], |_| value);
        for map in [ColorMap::Sequential, ColorMap::Diverging { centre: value }] {
            let drawn = draw("constant", &FieldPicture { map, ..FieldPicture::new(&field) }, &small());
            let centre = pixel(&drawn, frames(&drawn).at([0.5, 0.5]));
            match map {
                ColorMap::Sequential => assert!(close(centre, MIDDLE, 4), "{value}: {centre:?}"),
                ColorMap::Diverging { .. } => assert!(centre.iter().all(|channel| *channel > 225), "{centre:?}"),
            }
        }
    }
    for interpolation in [Interpolation::Smooth, Interpolation::Nearest] {
        let mut field = front([32, 32]);
        for (kx, ky, value) in [(8, 8, f64::NAN), (0, 24, f64::INFINITY), (31, 24, f64::NEG_INFINITY)] {
            field.values[kx * 32 + ky] = value;
        }
        let picture = FieldPicture { interpolation, title: "Holes", ..FieldPicture::new(&field) };
        let drawn = draw(&format!("holes-{interpolation:?}"), &picture, &small());
        let place = frames(&drawn);
        for [kx, ky] in [[8.0, 8.0], [0.2, 24.0], [31.0, 24.0], [31.8, 24.0], [8.3, 7.7]] {
            assert_eq!(pixel(&drawn, place.at([kx / 32.0, ky / 32.0])), MISSING, "{interpolation:?} {kx} {ky}");
        }
        for [kx, ky] in [[8.0, 9.0], [9.0, 8.0], [1.0, 24.0], [30.0, 24.0], [31.0, 25.0], [16.0, 16.0]] {
            let found = pixel(&drawn, place.at([kx / 32.0, ky / 32.0]));
            assert!(!close(found, MISSING, 8), "{interpolation:?} {kx} {ky} is {found:?}");
        }
        // A hole changes nothing farther away than the two nodes that a smooth surface reaches.
        let whole = front([32, 32]);
        let whole = FieldPicture { field: &whole, range: field.extrema(), ..picture };
        let with_holes = FieldPicture { range: field.extrema(), ..picture };
        let [whole, with_holes] = [whole, with_holes].map(|p| plotter().draw_field(&p, &small()).unwrap());
        // The note below the title moves the image: compare fractions of it.
        let at = |drawn: &RgbaImage, spot| pixel(drawn, frames(drawn).at(spot));
        assert!(close(at(&whole, [0.5, 0.6]), at(&with_holes, [0.5, 0.6]), 12));
    }
    let empty = Field::from_function("nothing", "value", [8, 8], [1.0, 1.0], |_| f64::NAN);
    let drawn = draw("nothing", &FieldPicture::new(&empty), &small());
    assert_eq!(pixel(&drawn, frames(&drawn).at([0.3, 0.7])), MISSING);
}

#[test]
fn meshes_and_boxes_of_all_shapes() {
    let shapes: [([usize; 2], [f64; 2]); 9] = [
        ([4, 4], [1.0, 1.0]),
        ([1, 1], [1.0, 1.0]),
        ([64, 64], [10.0, 1.0]),
        ([64, 64], [1.0, 10.0]),
        ([7, 500], [3.0, 2.0]),
        ([2000, 5], [2.0, 3.0]),
        ([96, 64], [6e6, 4e6]),
        ([64, 64], [3e-9, 3e-9]),
        ([33, 65], [400.0, 1.0]),
    ];
    for (nodes, lengths) in shapes {
        let field = Field::from_function("wave", "height h (H_{0})", nodes, lengths, |[x, y]| {
            1e6 + 1e-2 * ((TAU * x / lengths[0]).sin() + 0.5 * (TAU * y / lengths[1]).cos())
        });
        let picture = FieldPicture {
            title: "Waves",
            subtitle: "of a kind",
            axes: ["x (length units)", "y (length units)"],
            ..FieldPicture::new(&field)
        };
        let name = format!("shape-{}x{}-{}x{}", nodes[0], nodes[1], lengths[0], lengths[1]);
        let drawn = draw(&name, &picture, &small());
        if lengths[0] / lengths[1] < 100.0 {
            let place = frames(&drawn);
            let pixels = (place.image[2] - place.image[0]).min(place.image[3] - place.image[1]);
            let error = place.aspect() / (lengths[0] / lengths[1]) - 1.0;
            assert!(error.abs() < 1.1 / pixels, "{name}: {}", place.aspect());
            if nodes[0] >= 64 {
                let [high, low] = [[0.25, 0.0], [0.75, 0.5]].map(|at| pixel(&drawn, place.at(at)));
                assert!(close(high, HIGHEST, 12) && close(low, LOWEST, 12), "{name}: {high:?} {low:?}");
            }
        }
    }
    let field = front([64, 64]);
    let picture = FieldPicture { title: "A shear front", subtitle: "small", ..FieldPicture::new(&field) };
    for (width, height, scale) in
        [(1, 1, 1.0), (40, 30, 1.0), (320, 240, 1.0), (320, 240, 8.0), (2400, 600, 1.0), (600, 1600, 2.0)]
    {
        let style = PlotStyle { width, height: Some(height), scale, ..PlotStyle::default() };
        draw(&format!("size-{width}x{height}-{scale}"), &picture, &style);
    }
}

#[test]
fn many_nodes_in_a_pixel_show_their_mean() {
    // A checkerboard finer than the pixels, brighter on the right: neither colour of the board is seen.
    let values: Vec<f64> = (0..4096 * 4096)
        .map(|index| {
            let (kx, ky) = (index / 4096, index % 4096);
            f64::from(((kx + ky) % 2) as u32) + if kx < 2048 { 0.0 } else { 1.0 }
        })
        .collect();
    let field = Field { name: "board".into(), label: "board".into(), nodes: [4096, 4096], lengths: [1.0, 1.0], values };
    for interpolation in [Interpolation::Smooth, Interpolation::Nearest] {
        let picture = FieldPicture { interpolation, ..FieldPicture::new(&field) };
        let start = std::time::Instant::now();
        let drawn = draw("board", &picture, &small());
        // Printed, not asserted: a loaded machine must not fail a test.
        println!("4096 x 4096 nodes: {:?}", start.elapsed());
        let place = frames(&drawn);
        let [left, top, right, bottom] = place.bar;
        for (x, value) in [(0.2, 0.5), (0.31, 0.5), (0.7, 1.5), (0.83, 1.5)] {
            let expected = pixel(&drawn, [0.5 * (left + right), bottom - value / 2.0 * (bottom - top)]);
            let found = pixel(&drawn, place.at([x, 0.4]));
            assert!(close(found, expected, 12), "{x}: {found:?}, not {expected:?}");
        }
    }
}

#[test]
fn what_cannot_be_drawn_is_refused() {
    let field = Field::from_function("h", "depth", [4, 4], [1.0, 1.0], |_| 1.0);
    let refused = |field: &Field| match plotter().draw_field(&FieldPicture::new(field), &small()) {
        Err(PlotError::Input(message)) => message,
        other => panic!("{other:?}"),
    };
    assert_eq!(
        refused(&Field { values: vec![1.0; 15], ..field.clone() }),
        "the field `h` has 15 values for 4 x 4 nodes"
    );
    assert!(refused(&Field { lengths: [1.0, 0.0], ..field.clone() }).contains("edges must be positive"));
    assert!(refused(&Field { nodes: [0, 4], values: Vec::new(), ..field.clone() }).contains("one at least"));
    let limit = gpu().device().limits().max_texture_dimension_2d as usize;
    let long = Field { nodes: [limit + 1, 1], values: vec![0.0; limit + 1], ..field.clone() };
    assert!(refused(&long).contains(&limit.to_string()));
    let style = PlotStyle { width: limit as u32 + 1, ..PlotStyle::default() };
    assert!(matches!(plotter().draw_field(&FieldPicture::new(&field), &style), Err(PlotError::Size { .. })));
}

/// What an array file holds, read by its specification alone.
fn read_npy(bytes: &[u8]) -> (Vec<usize>, Vec<f64>) {
    assert_eq!(&bytes[..8], b"\x93NUMPY\x01\x00");
    let length = usize::from(u16::from_le_bytes([bytes[8], bytes[9]]));
    let (header, data) = bytes[10..].split_at(length);
    assert_eq!((10 + length) % 64, 0, "the data are aligned");
    let header = std::str::from_utf8(header).unwrap();
    assert!(header.ends_with('\n') && header.is_ascii());
    let dictionary = header.trim_end().strip_prefix('{').and_then(|rest| rest.strip_suffix('}')).unwrap();
    let value_of = |key: &str| dictionary.split_once(&format!("'{key}': ")).unwrap().1;
    assert!(value_of("descr").starts_with("'<f8',"));
    assert!(value_of("fortran_order").starts_with("False,"));
    let shape = value_of("shape").strip_prefix('(').and_then(|rest| rest.split_once(')')).unwrap().0;
    let shape: Vec<usize> =
        shape.split(',').map(str::trim).filter(|text| !text.is_empty()).map(|text| text.parse().unwrap()).collect();
    assert!(shape.len() != 1 || value_of("shape").contains(",)"), "a tuple of one needs its comma");
    let values = data.chunks_exact(8).map(|bytes| f64::from_le_bytes(bytes.try_into().unwrap())).collect();
    assert_eq!(data.len() % 8, 0);
    (shape, values)
}

#[test]
fn arrays_keep_their_shape_and_every_bit() {
    let folder = tempfile::tempdir().unwrap();
    let special = [f64::NAN, f64::INFINITY, -0.0, f64::MIN_POSITIVE / 8.0, f64::MAX, 0.1];
    let field = front([130, 127]);
    let cases: [(Vec<usize>, Vec<f64>); 5] = [
        (field.nodes.to_vec(), field.values.clone()),
        (vec![2, 3], special.to_vec()),
        (vec![6], special.to_vec()),
        (vec![], vec![2.5]),
        (vec![0, 4], vec![]),
    ];
    for (shape, values) in cases {
        let path = folder.path().join("field.npy");
        write_npy(&path, &shape, &values).unwrap();
        let (found_shape, found) = read_npy(&std::fs::read(&path).unwrap());
        assert_eq!(found_shape, shape);
        let bits = |values: &[f64]| values.iter().map(|value| value.to_bits()).collect::<Vec<_>>();
        assert_eq!(bits(&found), bits(&values));
        assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 1, "no temporary file is left");
    }
    // x first: the value of node (2, 5) is where `array[2, 5]` looks for it.
    let path = Path::new(env!("CARGO_TARGET_TMPDIR")).join("front.npy");
    write_npy(&path, &field.nodes, &field.values).unwrap();
    let (shape, values) = read_npy(&std::fs::read(&path).unwrap());
    assert_eq!(values[2 * shape[1] + 5], field.at(2, 5));
}

#[test]
fn an_array_that_does_not_fill_its_shape_is_refused_and_leaves_what_was_there() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("depth.npy");
    write_npy(&path, &[2, 2], &[1.0; 4]).unwrap();
    let before = std::fs::read(&path).unwrap();
    for shape in [[3, 2], [2, 1], [usize::MAX, 2]] {
        let error = write_npy(&path, &shape, &[1.0; 4]).unwrap_err();
        assert!(matches!(&error, OutputError::Io { .. }));
        assert!(error.to_string().contains("4 values do not fill an array of shape"), "{error}");
    }
    assert_eq!(std::fs::read(&path).unwrap(), before);
    assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 1);
    assert!(write_npy_to(&mut Vec::new(), &vec![1; 30_000], &[1.0]).is_err(), "a header has at most 65,535 bytes");
}
