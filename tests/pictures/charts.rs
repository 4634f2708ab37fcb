//! Charts and snapshots, drawn on whatever adapter there is and examined pixel by pixel. Every picture is also left in
//! `target/tmp` for the eye.

use image::RgbaImage;
use mesoscope::families::EnergyChart;
use mesoscope::measure::statistics::Estimate;
use mesoscope::plot::{
    Averages, CellPicture, Chart, Panel, ParticlePicture, PlotError, Plotter, Scale, Series, SeriesStyle, ShownValues,
    diffusion_chart, energies_chart, radial_distribution_chart, vector_graphics,
};
use mesoscope::scene::{Headings, PlotStyle, Snapshot, SnapshotColor, Theme, UnitNames, VectorFormat};
use mesoscope::table::Table;
use mesoscope::tessellation::Tessellation;
use rand::{RngExt, SeedableRng, rngs::StdRng};
use std::time::Instant;

use crate::support::gpu;
use crate::support::plotter::{plotter, save};

const BLUE: [u8; 3] = [0x00, 0x72, 0xB2];
const ORANGE: [u8; 3] = [0xE6, 0x9F, 0x00];

fn chart_picture(name: &str, chart: &Chart, style: &PlotStyle) -> RgbaImage {
    save(name, plotter().draw_chart(chart, style).unwrap())
}

fn panel_chart(panel: Panel) -> Chart {
    Chart { title: "A title".into(), subtitle: "a subtitle".into(), panels: vec![panel] }
}

fn close(pixel: image::Rgba<u8>, colour: [u8; 3]) -> bool {
    (0..3).all(|channel| pixel[channel].abs_diff(colour[channel]) <= 12)
}

/// Smallest rectangle around the pixels of a colour: left, top, right, bottom.
fn bounds(picture: &RgbaImage, colour: [u8; 3]) -> Option<[u32; 4]> {
    let found = picture.enumerate_pixels().filter(|(_, _, pixel)| close(**pixel, colour));
    found.fold(None, |bounds, (x, y, _)| {
        let [left, top, right, bottom] = bounds.unwrap_or([x, y, x, y]);
        Some([left.min(x), top.min(y), right.max(x), bottom.max(y)])
    })
}

/// Area of the axes: the longest dark horizontal and vertical runs.
fn frame(picture: &RgbaImage) -> [u32; 4] {
    let dark = |x: u32, y: u32| close(*picture.get_pixel(x, y), [0x1A; 3]);
    let longest = |count: u32, length: u32, at: &dyn Fn(u32, u32) -> bool| {
        let mut best = (0, 0, 0);
        for line in 0..count {
            let mut start = 0;
            for position in 0..=length {
                if position == length || !at(line, position) {
                    if position - start > best.2 - best.1 {
                        best = (line, start, position);
                    }
                    start = position + 1;
                }
            }
        }
        best
    };
    let (bottom, _, right) = longest(picture.height(), picture.width(), &|y, x| dark(x, y));
    let (left, top, _) = longest(picture.width(), picture.height(), &dark);
    [left, top, right, bottom]
}

fn ink(picture: &RgbaImage, [left, top, right, bottom]: [u32; 4]) -> usize {
    let dark = |x, y| picture.get_pixel(x, y)[1] < 140;
    (top..bottom).map(|y| (left..right).filter(|x| dark(*x, y)).count()).sum()
}

fn noise(rng: &mut StdRng) -> f64 {
    (0..12).map(|_| rng.random::<f64>()).sum::<f64>() - 6.0
}

fn energies() -> Table {
    let columns = "step,time,kinetic_energy,potential_energy,total_energy,temperature,configurational_temperature,\
                   pressure,pressure_conservative";
    let mut rng = StdRng::seed_from_u64(7);
    let mut rows = Vec::new();
    let mut slow = 0.0;
    for step in 0..2000 {
        let time = f64::from(step) * 0.04 * 20.0;
        let decay = (-time / 25.0).exp();
        slow = 0.98 * slow + 0.002 * noise(&mut rng);
        let kinetic = 24_000.0 * (1.5 + 0.25 * decay + slow * 0.3 + 0.008 * noise(&mut rng));
        let potential = 24_000.0 * (4.55 + 0.9 * decay - slow + 0.01 * noise(&mut rng));
        let pressure = 23.6 + 3.0 * decay + 0.08 * noise(&mut rng);
        rows.push(vec![
            f64::from(step * 20),
            time,
            kinetic,
            potential,
            kinetic + potential,
            kinetic / 36_000.0,
            1.0 + 0.3 * decay + 0.012 * noise(&mut rng),
            pressure,
            pressure - 3.0 + 0.03 * noise(&mut rng),
        ]);
    }
    Table::new(columns.split(','), rows)
}

fn of_fluid() -> EnergyChart {
    EnergyChart { temperature: Some(1.0), ..EnergyChart::of("particle", 24_000, 3) }
}

#[test]
fn energies_are_drawn_the_same_twice_and_on_both_papers() {
    let mut chart = energies_chart(
        "DPD fluid at density 3: energies of a standard run",
        &energies(),
        &of_fluid(),
        &Averages::default(),
    );
    chart.subtitle.push_str(", ρ = 3, a = 25, γ = 4.5, Δt = 0.04");
    assert_eq!(chart.panels.len(), 3);
    let light = chart_picture("energies", &chart, &PlotStyle::default());
    assert_eq!((light.width(), light.height()), (1600, 1200));
    assert_eq!(light, plotter().draw_chart(&chart, &PlotStyle::default()).unwrap());
    let dark = chart_picture("energies-dark", &chart, &PlotStyle { theme: Theme::Dark, ..PlotStyle::default() });
    assert_eq!(light.get_pixel(1, 1).0, [255; 4]);
    assert!(dark.get_pixel(1, 1).0[..3].iter().all(|channel| *channel < 40));
    // Margins stay clear, and there is ink in the title and in the labels at the left and below.
    assert_eq!(ink(&light, [0, 0, 1600, 12]) + ink(&light, [0, 0, 12, 1200]) + ink(&light, [1588, 0, 1600, 1200]), 0);
    assert!(ink(&light, [12, 12, 1500, 60]) > 1000);
    assert!(ink(&light, [12, 150, 60, 1000]) > 1000);
    assert!(ink(&light, [700, 1150, 1000, 1190]) > 500);
}

#[test]
fn small_wide_and_enlarged_pictures() {
    let chart = energies_chart("DPD fluid", &energies(), &of_fluid(), &Averages::default());
    for (width, height, scale) in
        [(320, 240, 1.0), (1600, 400, 1.0), (800, 2000, 1.0), (1600, 1200, 1.6), (640, 480, 8.0)]
    {
        let style = PlotStyle { width, height: Some(height), scale, ..PlotStyle::default() };
        let picture = chart_picture(&format!("energies-{width}x{height}-{scale}"), &chart, &style);
        assert_eq!((picture.width(), picture.height()), (width, height));
        assert!(ink(&picture, [0, 0, width, height]) > 500);
    }
}

#[test]
fn a_line_lies_where_its_axes_say() {
    let mut panel = Panel::new("x (units)", "y (units)").with(Series::line("line", vec![[0.0, 0.0], [10.0, 1.0]]));
    panel.x.range = Some([0.0, 10.0]);
    panel.y.range = Some([0.0, 1.0]);
    let picture = chart_picture("line", &panel_chart(panel), &PlotStyle::default());
    let [left, top, right, bottom] = frame(&picture);
    assert!(right - left > 1200 && bottom - top > 800, "the axes span the picture");
    for percent in [5_u32, 30, 50, 77, 95] {
        let (x, y) = (left + (right - left) * percent / 100, bottom - (bottom - top) * percent / 100);
        let near = |dy: i64| close(*picture.get_pixel(x, (i64::from(y) + dy) as u32), BLUE);
        assert!((-3..=3).any(near), "no line at {percent} %");
        assert!(!near(-12) && !near(12), "the line is too thick at {percent} %");
    }
}

#[test]
fn a_logarithmic_axis_straightens_a_power_law_and_owns_up_to_what_it_lacks() {
    let points: Vec<[f64; 2]> = (-5..=200).map(|i| [f64::from(i), f64::from(i).powi(2)]).collect();
    let mut panel = Panel::new("t (time units)", "⟨x²⟩ (length units²)").with(Series::line("line", points));
    panel.x.scale = Scale::Log;
    panel.y.scale = Scale::Log;
    let picture = chart_picture("log", &panel_chart(panel.clone()), &PlotStyle::default());
    // From (1, 1) at one corner to (200, 40 000) at the other: half of both logarithms lies at half of both axes.
    let [left, top, right, bottom] = bounds(&picture, BLUE).unwrap();
    let (x, y) = (u32::midpoint(left, right), u32::midpoint(top, bottom));
    assert!((y - 4..=y + 4).any(|y| close(*picture.get_pixel(x, y), BLUE)));
    panel.series[0].points.retain(|point| point[0] > 0.0);
    let without = plotter().draw_chart(&panel_chart(panel), &PlotStyle::default()).unwrap();
    let subtitle = [30, 70, 1500, 115];
    assert!(ink(&picture, subtitle) > ink(&without, subtitle) + 500, "the subtitle says what was left out");
}

#[test]
fn a_gap_is_a_gap_and_a_lone_point_a_dot() {
    let points =
        vec![[0.0, 0.5], [3.0, 0.5], [4.0, f64::NAN], [5.0, 0.5], [6.0, f64::INFINITY], [8.0, 0.5], [10.0, 0.5]];
    let mut panel = Panel::new("x", "y").with(Series::line("line", points));
    panel.x.range = Some([0.0, 10.0]);
    panel.y.range = Some([0.0, 1.0]);
    let picture = chart_picture("gap", &panel_chart(panel), &PlotStyle::default());
    let [left, top, right, bottom] = frame(&picture);
    let drawn = |tenths: u32| {
        let (x, y) = (left + (right - left) * tenths / 100, u32::midpoint(top, bottom));
        (y - 4..=y + 4).any(|y| close(*picture.get_pixel(x, y), BLUE))
    };
    assert!(drawn(15) && drawn(50) && drawn(90));
    assert!(!drawn(40) && !drawn(60) && !drawn(45));
}

#[test]
fn a_million_points_keep_their_extremes() {
    let mut points: Vec<[f64; 2]> = (0..1_000_000).map(|i| [f64::from(i), f64::from(i % 100) * 1e-3]).collect();
    points[400_000][1] = 1.0;
    points[700_000][1] = -1.0;
    let mut panel = Panel::new("step", "value").with(Series::line("line", points));
    panel.y.range = Some([-1.2, 1.2]);
    let start = Instant::now();
    let picture = chart_picture("million", &panel_chart(panel), &PlotStyle::default());
    println!("a million points: {:?}", start.elapsed());
    let [_, top, _, bottom] = frame(&picture);
    let [_, highest, _, lowest] = bounds(&picture, BLUE).unwrap();
    let height = f64::from(bottom - top);
    assert!((f64::from(highest - top) / height - 0.2 / 2.4).abs() < 0.01);
    assert!((f64::from(bottom - lowest) / height - 0.2 / 2.4).abs() < 0.01);
}

#[test]
fn odd_data_is_drawn_without_complaint() {
    let cases: [(&str, Vec<[f64; 2]>); 10] = [
        ("none", vec![]),
        ("one", vec![[3.0, 7.0]]),
        ("constant", (0..50).map(|i| [f64::from(i), 23.635]).collect()),
        ("zero", (0..50).map(|i| [f64::from(i), 0.0]).collect()),
        ("nan", vec![[f64::NAN, f64::NAN]; 5]),
        ("huge", vec![[0.0, -1e308], [1.0, 1e308]]),
        ("tiny", vec![[0.0, 1e-310], [1e-308, 3e-305], [2e-308, 1e-305]]),
        ("large", (0..100).map(|i| [f64::from(i) * 1e6, f64::from(i * i) * 4.2e4]).collect()),
        ("offset", (0..100).map(|i| [f64::from(i), 1_234_567.0 + (f64::from(i) * 0.2).sin() * 1e-3]).collect()),
        ("negative", (0..100).map(|i| [f64::from(i) - 50.0, -1e-6 * f64::from(i)]).collect()),
    ];
    for (name, points) in cases {
        for scale in [Scale::Linear, Scale::Log] {
            for style in [SeriesStyle::Line, SeriesStyle::Markers, SeriesStyle::LineMarkers, SeriesStyle::Band] {
                let errors = points.iter().map(|point| point[1].abs() * 0.1).collect();
                let series = Series { style, ..Series::line("series", points.clone()).with_errors(errors) };
                let mut panel = Panel::new("Time (time units)", "Quantity (units)").with(series);
                panel.y.scale = scale;
                let chart = panel_chart(panel);
                let size = PlotStyle { width: 800, height: Some(600), ..PlotStyle::default() };
                let picture = chart_picture(&format!("odd-{name}-{scale:?}-{style:?}"), &chart, &size);
                assert!(ink(&picture, [0, 0, 800, 60]) > 100, "{name} {scale:?} {style:?} has no title");
                // Thin lines are not pure blue in a small picture.
                let drawn = picture.pixels().any(|pixel| pixel[2] > pixel[0].saturating_add(60));
                let expected = match (name, scale) {
                    ("none" | "nan", _) | ("zero" | "negative", Scale::Log) => Some(false),
                    ("one" | "constant" | "large" | "offset", _) => Some(true),
                    _ => None,
                };
                assert!(expected.is_none_or(|expected| expected == drawn), "{name} {scale:?} {style:?}: {drawn}");
            }
        }
    }
    let empty = chart_picture("odd-no-panels", &Chart::default(), &PlotStyle::default());
    assert!(ink(&empty, [0, 0, 1600, 1200]) > 100, "it says that there is no data");
}

#[test]
fn many_series_and_styles() {
    let mut panel = Panel::new("Distance r (r_{c})", "A long name of a quantity that was measured (k_{B}T)");
    for number in 0..7 {
        let shift = f64::from(number);
        let points = (0..200).map(|i| [f64::from(i) * 0.05, (f64::from(i) * 0.03 + shift).sin() + shift]).collect();
        panel = panel.with(Series::line(&format!("series {}", number + 1), points));
    }
    let mut second = Panel::new("Distance r (r_{c})", "Value");
    let points: Vec<[f64; 2]> = (1..12).map(|i| [f64::from(i), f64::from(i).ln()]).collect();
    second = second
        .with(Series::markers("measured", points.clone()).with_errors(vec![0.2; 11]))
        .with(Series {
            style: SeriesStyle::LineMarkers,
            ..Series::line("joined", points.iter().map(|p| [p[0], p[1] - 1.0]).collect())
        })
        .with(Series {
            style: SeriesStyle::Band,
            ..Series::line("band", points.iter().map(|p| [p[0], p[1] + 1.0]).collect()).with_errors(vec![0.3; 11])
        })
        .with_reference("theory", 2.0);
    let chart = Chart {
        title:
            "A very long title that has to be broken into more than one line because it says far too much about it all"
                .into(),
        subtitle: "seven series".into(),
        panels: vec![panel, second],
    };
    let picture = chart_picture("many", &chart, &PlotStyle { height: Some(1600), ..PlotStyle::default() });
    assert!(bounds(&picture, BLUE).is_some());
}

/// The numbers of a path of SVG.
fn numbers(data: &str) -> Vec<f64> {
    data.split(|c: char| c.is_ascii_alphabetic() || c == ',' || c == ' ').filter_map(|part| part.parse().ok()).collect()
}

/// Vector graphics have what the picture of a chart has, in the same places: curves run through its pixels, and letters lie on its ink.
#[test]
fn vector_graphics_lie_on_the_picture() {
    let points: Vec<[f64; 2]> = (0..60).map(|x| [f64::from(x), (f64::from(x) * 0.2).sin()]).collect();
    let panel = Panel::new("Time (time units)", "Speed (length units/time unit)").with(Series::line("wave", points));
    let units = UnitNames { time: Some("τ".to_owned()), ..UnitNames::default() };
    let style = PlotStyle { units, headings: Headings::Conditions, ..PlotStyle::default() };
    let chart = panel_chart(panel);
    let picture = chart_picture("vector", &chart, &style);
    let files = VectorFormat::ALL.map(|format| vector_graphics(&chart, &style, format, "run_id r1").unwrap());
    assert_eq!(files, VectorFormat::ALL.map(|format| vector_graphics(&chart, &style, format, "run_id r1").unwrap()));
    for (file, end) in files.iter().zip(["svg", "pdf"]) {
        std::fs::write(format!("{}/vector.{end}", env!("CARGO_TARGET_TMPDIR")), file).unwrap();
    }
    let text = String::from_utf8(files[0].clone()).unwrap();
    assert!(text.contains("run_id r1") && text.contains(r#"viewBox="0 0 1600 1200""#) && text.contains("135.47mm"));
    // What is left out of the picture is still the title of the document.
    assert_eq!(text.matches("A title").count(), 1);
    let (mut curves, mut outlines, mut moves) = (0, 0, 1);
    for event in svg::read(&text).unwrap() {
        let svg::parser::Event::Tag("path", _, attributes) = event else { continue };
        moves += attributes["d"].matches('M').count();
        let numbers = numbers(&attributes["d"]);
        let near = |x: f64, y: f64, is_shown: &dyn Fn(image::Rgba<u8>) -> bool| {
            let (x, y) = (x.round() as u32, y.round() as u32);
            (x.saturating_sub(2)..=x + 2)
                .any(|x| (y.saturating_sub(2)..=y + 2).any(|y| is_shown(*picture.get_pixel(x, y))))
        };
        if attributes.get("stroke").is_some_and(|stroke| **stroke == *"#0072b2") && numbers.len() > 8 {
            curves += 1;
            assert!(numbers.len() >= 100, "{} numbers", numbers.len());
            for point in numbers.chunks_exact(2) {
                assert!(near(point[0], point[1], &|pixel| close(pixel, BLUE)), "{point:?}");
            }
        }
        if attributes["d"].contains('C') {
            outlines += 1;
            let inked =
                numbers.chunks_exact(2).filter(|point| near(point[0], point[1], &|pixel| pixel[1] < 200)).count();
            assert!(10 * inked > 9 * (numbers.len() / 2), "{inked} of {}", numbers.len() / 2);
        }
    }
    // The curve, and letters of two inks.
    assert!(curves == 1 && outlines >= 2, "{curves} {outlines}");
    let pdf = &files[1];
    assert!(pdf.starts_with(b"%PDF-1.7") && pdf.trim_ascii_end().ends_with(b"%%EOF"));
    let begin = pdf.windows(6).position(|bytes| bytes == b"stream").unwrap() + 7;
    let content = miniz_oxide::inflate::decompress_to_vec_zlib(&pdf[begin..]).unwrap();
    let content = String::from_utf8(content).unwrap();
    // The same paths, and the area that clips the curve.
    let found = content.lines().filter(|line| line.ends_with(" m")).count();
    assert_eq!(found + 1, moves);
}

#[test]
fn ready_made_charts() {
    let r: Vec<f64> = (0..100).map(|i| (f64::from(i) + 0.5) * 0.03).collect();
    let g = r
        .iter()
        .map(|r| [*r, 1.0 - (-(r / 0.45_f64).powi(3)).exp() * 1.0 + 0.17 * (-(r - 0.87_f64).powi(2) / 0.03).exp()])
        .collect();
    chart_picture("g", &radial_distribution_chart("DPD fluid", vec![Series::line("g(r)", g)]), &PlotStyle::default());
    let lag: Vec<f64> = (0..200).map(|i| f64::from(i) * 0.05).collect();
    let msd: Vec<f64> = lag.iter().map(|t| 6.0 * 0.3 * (t - 0.3 * (1.0 - (-t / 0.3).exp()))).collect();
    let vacf: Vec<f64> = lag.iter().map(|t| 3.0 * (-t / 0.3_f64).exp() - 0.02 * (-(t - 2.0).powi(2)).exp()).collect();
    let columns = ["time", "mean_squared_displacement", "velocity_autocorrelation"];
    let rows = (0..lag.len()).map(|i| vec![lag[i], msd[i], vacf[i]]).collect();
    let [einstein, kubo] =
        [(0.3, 0.01), (0.29, 0.03)].map(|(value, error)| Some(Estimate::new(value, Some(error), 20)));
    let chart = diffusion_chart("DPD fluid", &Table::new(columns, rows), 3, einstein, kubo);
    let picture = chart_picture("correlation", &chart, &PlotStyle::default());
    assert_eq!(chart.panels.len(), 2);
    assert!(bounds(&picture, BLUE).is_some());
}

#[test]
fn what_cannot_be_drawn_is_refused() {
    let limit = gpu().device().limits().max_texture_dimension_2d;
    let style = PlotStyle { width: limit + 1, ..PlotStyle::default() };
    assert!(matches!(plotter().draw_chart(&Chart::default(), &style), Err(PlotError::Size { .. })));
    let series = Series::line("short", vec![[0.0, 0.0]; 3]).with_errors(vec![1.0]);
    let chart = panel_chart(Panel::new("x", "y").with(series));
    assert!(matches!(plotter().draw_chart(&chart, &PlotStyle::default()), Err(PlotError::Input(_))));
    let names = ["A".to_owned()];
    let wrong = ParticlePicture { species: &[0, 0], ..particle(&[[1.0; 3]], &names) };
    let snapshot = Snapshot::default();
    assert!(matches!(plotter().draw_particles(&wrong, &snapshot, Theme::Light), Err(PlotError::Input(_))));
    let unnamed = ParticlePicture { species: &[3], ..particle(&[[1.0; 3]], &names) };
    assert!(matches!(plotter().draw_particles(&unnamed, &snapshot, Theme::Light), Err(PlotError::Input(_))));
}

/// A page of this size whatever the box.
fn square() -> Snapshot {
    Snapshot { width: Some(1200), height: Some(1200), ..Snapshot::default() }
}

fn particle<'a>(positions: &'a [[f64; 3]], names: &'a [String]) -> ParticlePicture<'a> {
    ParticlePicture {
        dimension: 2,
        lengths: [10.0, 10.0, 0.0],
        positions,
        species: &[0],
        species_names: names,
        speeds: None,
        bonds: &[],
        radius: 1.0,
        title: "",
        subtitle: "",
    }
}

/// A rod joins bonded particles the shortest way, half in the colour of each.
#[test]
fn bonds_are_drawn_the_shortest_way() {
    let names = ["water".to_owned(), "oil".to_owned()];
    let is_coloured = |pixel: &image::Rgba<u8>| {
        let [red, green, blue, _] = pixel.0;
        red.max(green).max(blue) - red.min(green).min(blue) > 40
    };
    for (x, between) in [([3.5, 6.5], true), ([1.5, 8.5], false)] {
        let positions = x.map(|x| [x, 5.0, 0.0]);
        let bonds = [[0, 1]];
        let picture = ParticlePicture { bonds: &bonds, species: &[0, 1], radius: 0.8, ..particle(&positions, &names) };
        let drawn = plotter().draw_particles(&picture, &square(), Theme::Light).unwrap();
        let bare =
            plotter().draw_particles(&ParticlePicture { bonds: &[], ..picture }, &square(), Theme::Light).unwrap();
        save(&format!("bond-{between}"), drawn.clone());
        let changed: Vec<(u32, u32)> = drawn
            .enumerate_pixels()
            .filter(|(x, y, pixel)| bare.get_pixel(*x, *y) != *pixel)
            .map(|(x, y, _)| (x, y))
            .collect();
        assert!(changed.len() > 500, "{}", changed.len());
        assert!(changed.iter().any(|(x, y)| is_coloured(drawn.get_pixel(*x, *y))));
        let (least, most) =
            (changed.iter().map(|(x, _)| *x).min().unwrap(), changed.iter().map(|(x, _)| *x).max().unwrap());
        // Between the two, or from both to the edges of the box; the middle of the box is that of the picture.
        let in_the_middle = changed.iter().any(|(x, _)| x.abs_diff(600) < 20);
        assert_eq!(in_the_middle, between);
        assert_eq!(most - least < 400, between, "{least} {most}");
    }
    let none = ParticlePicture { bonds: &[[0, 7]], ..particle(&[[1.0; 3]], &names) };
    let refused = plotter().draw_particles(&none, &square(), Theme::Light);
    assert!(
        matches!(refused, Err(PlotError::Input(message)) if message.contains("a bond of 0 and 7 among 1 particles"))
    );
}

#[test]
fn a_particle_in_the_middle_of_the_box_is_in_the_middle_of_the_view() {
    let names = ["water".to_owned()];
    for dimension in [2, 3] {
        let positions = [[5.0, 5.0, 2.0]];
        let picture = ParticlePicture { dimension, lengths: [10.0, 10.0, 4.0], ..particle(&positions, &names) };
        let picture = plotter().draw_particles(&picture, &square(), Theme::Light).unwrap();
        let picture = save(&format!("one-{dimension}"), picture);
        // Below the view are the legend and the scale bar: look for the disc above them.
        let view = image::imageops::crop_imm(&picture, 0, 0, 1200, 1085).to_image();
        let coloured = |pixel: &image::Rgba<u8>| pixel[2] > pixel[0].saturating_add(12);
        let disc: Vec<(u32, u32)> =
            view.enumerate_pixels().filter(|(_, _, p)| coloured(p)).map(|(x, y, _)| (x, y)).collect();
        // Edges of the box cross the disc, so its extent is more telling than its mean.
        let middle = |pick: fn(&(u32, u32)) -> u32| {
            let (low, high) = (disc.iter().map(pick).min().unwrap(), disc.iter().map(pick).max().unwrap());
            f64::from(low + high + 1) / 2.0
        };
        let (x, y) = (middle(|p| p.0), middle(|p| p.1));
        assert!((x - 600.0).abs() < 1.0, "{dimension} dimensions: disc at {x}");
        let outline = {
            // Lengths beside the edges are in the secondary ink.
            let dark = |x: u32, y: u32| view.get_pixel(x, y)[0] < 60;
            let rows: Vec<u32> =
                (0..1085).filter(|y| (0..1200).any(|x| dark(x, *y) && !coloured(view.get_pixel(x, *y)))).collect();
            f64::from(rows[0] + rows[rows.len() - 1]) / 2.0
        };
        assert!((y - outline).abs() < 3.0, "{dimension} dimensions: disc at height {y}, box at {outline}");
        if dimension == 2 {
            let width = (2.0 * (disc.len() as f64 / std::f64::consts::PI).sqrt()).round();
            let edge = {
                let row: Vec<u32> = (0..1200).filter(|x| view.get_pixel(*x, 300)[0] < 100).collect();
                f64::from(row[row.len() - 1] - row[0])
            };
            assert!(
                (width / edge - 0.2).abs() < 0.005,
                "a disc of radius 1 in a box of 10 is a fifth of it: {width}/{edge}"
            );
        }
    }
}

#[test]
fn the_nearer_particle_hides_the_farther() {
    let names = ["near".to_owned(), "far".to_owned()];
    // Along the line of sight of a viewer at azimuth −62° and elevation 20°.
    let sight = [0.4412, -0.8297, 0.3420];
    let at = |distance: f64| [0, 1, 2].map(|axis| 5.0 + distance * sight[axis]);
    for order in [[0, 1], [1, 0]] {
        let places = [at(3.0), at(-3.0)];
        let positions = order.map(|index| places[index]);
        let species = order.map(|index| index as u32);
        let picture =
            ParticlePicture { dimension: 3, lengths: [10.0; 3], species: &species, ..particle(&positions, &names) };
        let picture = save("occlusion", plotter().draw_particles(&picture, &square(), Theme::Light).unwrap());
        let view = image::imageops::crop_imm(&picture, 0, 0, 1200, 1085).to_image();
        let (blue, orange) = view.pixels().fold((0, 0), |(blue, orange), p| {
            (blue + usize::from(p[2] > p[0].saturating_add(60)), orange + usize::from(p[0] > p[2].saturating_add(60)))
        });
        assert!(blue > 2000 && orange < blue / 100, "order {order:?}: {blue} {orange}");
    }
}

#[test]
fn a_demixed_mixture_in_two_dimensions() {
    let mut rng = StdRng::seed_from_u64(3);
    let (mut positions, mut species) = (Vec::new(), Vec::new());
    for _ in 0..4800 {
        let (x, y): (f64, f64) = (rng.random::<f64>() * 40.0, rng.random::<f64>() * 30.0);
        let wave = (x * 0.31).sin() + (y * 0.42 + 1.0).cos() + 0.6 * (0.2 * x + 0.3 * y).sin();
        positions.push([x, y, 0.0]);
        species.push(u32::from(wave > 0.0));
    }
    let names = ["oil".to_owned(), "water".to_owned()];
    let speeds: Vec<f64> = positions.iter().map(|_| noise(&mut rng).hypot(noise(&mut rng))).collect();
    let picture = ParticlePicture {
        dimension: 2,
        lengths: [40.0, 30.0, 0.0],
        positions: &positions,
        species: &species,
        species_names: &names,
        speeds: Some(&speeds),
        bonds: &[],
        radius: 0.33,
        title: "Binary mixture",
        subtitle: "t = 200 time units",
    };
    let by_species = save("mixture", plotter().draw_particles(&picture, &Snapshot::default(), Theme::Light).unwrap());
    assert_eq!(by_species, plotter().draw_particles(&picture, &Snapshot::default(), Theme::Light).unwrap());
    assert!(bounds(&by_species, BLUE).is_some() && bounds(&by_species, ORANGE).is_some());
    save("mixture-dark", plotter().draw_particles(&picture, &Snapshot::default(), Theme::Dark).unwrap());
    let style = Snapshot { color: SnapshotColor::Speed, ..Snapshot::default() };
    let by_speed = save("speed", plotter().draw_particles(&picture, &style, Theme::Light).unwrap());
    assert!(bounds(&by_speed, ORANGE).is_none());
    assert!(matches!(
        plotter().draw_particles(&ParticlePicture { speeds: None, ..picture }, &style, Theme::Light),
        Err(PlotError::Input(_))
    ));
    for (width, height) in [(64, 64), (300, 900), (2400, 800)] {
        let style = Snapshot { width: Some(width), height: Some(height), ..Snapshot::default() };
        save(&format!("mixture-{width}x{height}"), plotter().draw_particles(&picture, &style, Theme::Light).unwrap());
    }
}

#[test]
fn a_box_of_24_000_particles() {
    let mut rng = StdRng::seed_from_u64(5);
    let positions: Vec<[f64; 3]> = (0..24_000).map(|_| [0; 3].map(|_| rng.random::<f64>() * 20.0)).collect();
    let names = ["fluid".to_owned()];
    let picture = ParticlePicture {
        dimension: 3,
        lengths: [20.0; 3],
        positions: &positions,
        species: &vec![0; positions.len()],
        species_names: &names,
        speeds: None,
        bonds: &[],
        radius: 0.33,
        title: "DPD fluid at density 3",
        subtitle: "t = 80 time units",
    };
    let start = Instant::now();
    let drawn = plotter().draw_particles(&picture, &square(), Theme::Light).unwrap();
    println!("24 000 particles: {:?}", start.elapsed());
    let drawn = save("fluid", drawn);
    assert_eq!(drawn, plotter().draw_particles(&picture, &square(), Theme::Light).unwrap());
    let middle = drawn.get_pixel(600, 550);
    assert!(middle[2] > middle[0], "the middle of the box is full of blue particles");
    save("fluid-dark", plotter().draw_particles(&picture, &square(), Theme::Dark).unwrap());
}

#[test]
fn an_empty_box() {
    let names = ["water".to_owned()];
    for dimension in [2, 3] {
        let picture = ParticlePicture { dimension, lengths: [10.0, 5.0, 3.0], species: &[], ..particle(&[], &names) };
        let picture = plotter().draw_particles(&picture, &square(), Theme::Light).unwrap();
        let picture = save(&format!("empty-{dimension}"), picture);
        assert!(ink(&picture, [0, 0, 1200, 1000]) > 1000, "the edges of the box are there");
    }
}

#[test]
fn a_picture_larger_than_a_tile_has_no_seams() {
    // One large sphere across the borders of tiles: its colour changes smoothly everywhere.
    let names = ["water".to_owned()];
    let positions = [[5.0, 5.0, 5.0]];
    let picture = ParticlePicture { dimension: 3, lengths: [10.0; 3], radius: 4.0, ..particle(&positions, &names) };
    let style = Snapshot { width: Some(3000), height: Some(3000), ..Snapshot::default() };
    let picture = plotter().draw_particles(&picture, &style, Theme::Light).unwrap();
    for (x, y) in [(1100_u32, 1300_u32), (1300, 1100), (1100, 1024), (1024, 1100), (1500, 1500)] {
        for step in 0..300 {
            for (dx, dy) in [(0, 1), (1, 0)] {
                let (a, b) = (
                    picture.get_pixel(x + dx * step, y + dy * step),
                    picture.get_pixel(x + dx * (step + 1), y + dy * (step + 1)),
                );
                let jump = (0..3).map(|c| a[c].abs_diff(b[c])).max().unwrap();
                assert!(jump <= 4, "a seam at {x} {y} + {step}: {a:?} {b:?}");
            }
        }
    }
}

#[test]
fn starting_cold_is_quick_enough_to_go_unnoticed() {
    let gpu = gpu();
    let start = Instant::now();
    let plotter = Plotter::new(gpu).unwrap();
    let built = start.elapsed();
    let chart = panel_chart(Panel::new("x", "y").with(Series::line("line", vec![[0.0, 0.0], [1.0, 1.0]])));
    let picture = plotter.draw_chart(&chart, &PlotStyle::default()).unwrap();
    // Printed, not asserted: a loaded machine must not fail a test.
    println!("pipelines {built:?}, with one chart {:?}", start.elapsed());
    assert!(bounds(&picture, BLUE).is_some());
}

/// Colours of cells by value: the box is filled with them, cells at an edge show on both sides, and faces are lines.
#[test]
fn cells_fill_the_box() {
    // A square lattice centred on the edges of the box; one column has the highest value.
    let positions: Vec<[f64; 2]> = (0..64).map(|site| [f64::from(site % 8), f64::from(site / 8)]).collect();
    let tessellation = Tessellation::new([8.0, 8.0], &positions);
    let values: Vec<f64> = (0..64).map(|site| if site % 8 == 0 { 1.0 } else { 0.0 }).collect();
    let names = ["A".to_owned()];
    let picture = CellPicture {
        lengths: [8.0, 8.0],
        positions: &positions,
        tessellation: &tessellation,
        species: &[0; 64],
        species_names: &names,
        shown: Some(ShownValues { label: "value (units)", values: &values }),
        title: "Cells",
        subtitle: "",
    };
    let (yellow, violet, white) = ([253, 231, 37], [68, 1, 84], [255; 3]);
    save("cells-captioned", plotter().draw_cells(&picture, &Snapshot::default(), Theme::Light).unwrap());
    // Too small for a caption, and with it for a colour bar.
    let style = Snapshot { width: Some(190), height: Some(190), ..Snapshot::default() };
    let drawn = save("cells", plotter().draw_cells(&picture, &style, Theme::Light).unwrap());
    let [left, top, right, bottom] = bounds(&drawn, yellow).unwrap().map(f64::from);
    let side = (right - left + 1.0) / 8.0;
    let at = |x: f64, y: f64| *drawn.get_pixel((left + x * side) as u32, (bottom - y * side) as u32);
    assert!(((right - left) - (bottom - top)).abs() <= 2.0 && side > 21.0, "{left} {top} {right} {bottom}");
    for row in 0..8 {
        let y = f64::from(row) + 0.1;
        // Half a cell at each edge, and lines half way between the columns.
        assert!(close(at(0.25, y), yellow) && close(at(7.75, y), yellow), "row {row}: {:?}", at(0.25, y));
        for column in 1..8 {
            assert!(close(at(f64::from(column), y), violet), "{row} {column}");
        }
        let brightest = (-3..=3).map(|offset| at(0.5 + f64::from(offset) / side, y)[2]).max().unwrap();
        assert!(brightest > 100, "no line of {white:?} in row {row}: {brightest}");
    }
    // By species there is no scale.
    let species = CellPicture { shown: None, ..picture };
    let drawn = plotter().draw_cells(&species, &style, Theme::Light).unwrap();
    assert!(close(*drawn.get_pixel(90, 100), BLUE) || close(*drawn.get_pixel(100, 90), BLUE));
    let wrong = CellPicture { species: &[0; 3], ..picture };
    assert!(matches!(plotter().draw_cells(&wrong, &style, Theme::Light), Err(PlotError::Input(_))));
}
