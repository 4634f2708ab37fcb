//! The pictures of whole runs: one range of colours from the first to the last, the same bytes after a pause, and what the
//! scene may say about them.

use serde_json::{Value, json};

use crate::support::plotter::save;
use crate::support::program::{Place, bytes, fails, listing, mesoscope, picture, succeeds, succeeds_and_tells, text};

/// A gas that starts much hotter than its bath and cools: colours fitted to each picture would hide it.
fn cooling() -> Place {
    let velocities: Vec<[f64; 2]> = (0..200).map(|i| (f64::from(i) * 2.4).sin_cos()).map(|(x, y)| [x, y]).collect();
    Place::of(json!({
        "title": "a gas cools",
        "space": {"box": [12, 6]},
        "time": {"step": 0.02, "steps": 60},
        "temperature": 0.01,
        "particles": [
            {"species": "gas", "count": 200, "velocities": {"type": "listed", "velocities": velocities}},
        ],
        "interactions": [{"type": "dpd", "repulsion": 0, "friction": 20}],
        "output": {
            "energies": {"every": 10},
            "plot": {"width": 640},
            "snapshot": {"every": 20, "width": 400, "color": "speed"},
        },
    }))
}

/// The ticks below the colour bar, which stand in the lower third of the footer.
fn ticks(place: &Place, name: &str) -> Vec<u8> {
    let picture = picture(&place.path(name));
    let (width, height) = (picture.width(), picture.height());
    // Headings, footer and margins are in proportion to the longer side.
    let strip = height - width * 77 / 1200..height;
    let pixels: Vec<u8> =
        strip.flat_map(|y| (0..width * 2 / 3).map(move |x| (x, y))).map(|(x, y)| picture.get_pixel(x, y)[1]).collect();
    assert!(pixels.iter().filter(|light| **light < 140).count() > 20, "there are labels in {name}");
    pixels
}

#[test]
fn all_pictures_of_a_run_share_one_range_of_colours() {
    let place = cooling();
    let directory = place.argument("out");
    succeeds(&["run", &place.scene(), "--out", &directory, "--quiet"]);
    let names =
        ["snapshot-000001.png", "snapshot-000002.png", "snapshot-000003.png", "snapshot-000004.png", "snapshot.png"];
    let first = ticks(&place, "out/snapshot-000001.png");
    for name in &names[1..] {
        assert!(ticks(&place, &format!("out/{name}")) == first, "{name} has another scale");
    }
    // The last state, drawn again, has the range of the run, and the page the shape of the box.
    let last = bytes(&place.path("out/snapshot.png"));
    succeeds(&["plot", &directory]);
    assert!(bytes(&place.path("out/snapshot.png")) == last);
    let size = picture(&place.path("out/snapshot.png")).dimensions();
    assert!(size.0 == 400 && size.1 < 320, "{size:?}");
    succeeds(&["plot", &directory, "--set", "output.snapshot.range=[0, 3]"]);
    assert!(ticks(&place, "out/snapshot.png") != first, "the user's range");
}

/// A species that is shown alone keeps its colour, and its bonds; nothing is left of the other.
#[test]
fn a_picture_shows_the_species_that_are_asked_for() {
    let place = Place::of(json!({
        "title": "two species",
        "space": {"box": [8, 8]},
        "time": {"step": 0.01, "steps": 1},
        "temperature": 1,
        "particles": [
            {"species": "A", "count": 60, "chain": {"beads": 2}}, {"species": "B", "count": 60, "chain": {"beads": 2}},
        ],
        "interactions": [{"type": "bonds", "potential": {"type": "harmonic", "stiffness": 9}}],
        "output": {"energies": {"every": 1}, "plot": {"width": 320, "height": 240}, "snapshot": {"width": 300}},
    }));
    let directory = place.argument("out");
    succeeds(&["run", &place.scene(), "--out", &directory, "--quiet"]);
    let coloured = |species: &str| {
        succeeds(&["plot", &directory, "--set", &format!("output.snapshot.species={species}")]);
        // Discs are shaded, letters and bonds are grey.
        let mut counts = [0, 0];
        for pixel in picture(&place.path("out/snapshot.png")).pixels() {
            let (red, blue) = (i32::from(pixel[0]), i32::from(pixel[2]));
            counts[0] += i32::from(blue > red + 60);
            counts[1] += i32::from(red > blue + 60);
        }
        counts
    };
    let [all, first, second] = [r#"["B","A"]"#, r#"["A"]"#, r#"["B"]"#].map(coloured);
    assert!(all[0] > 5000 && all[1] > 5000, "{all:?}");
    assert!(
        first[0] >= all[0] && first[1] == 0 && second[0] == 0 && second[1] >= all[1],
        "{first:?} {second:?} {all:?}"
    );
    let refusal = "output.snapshot.species[0]: found \"C\"; accepted: a species of some particle group: A, B";
    fails(&["plot", &directory, "--set", r#"output.snapshot.species=["C"]"#], 2, &[refusal]);
}

/// Two layers of particles, of which a slice holds one, seen from all sides; and no picture at all.
#[test]
fn a_slice_and_a_side_of_a_box_are_drawn_or_nothing_is() {
    let layer = |species: &str, z: f64| {
        let places: Vec<[f64; 3]> = (0..64).map(|i| [f64::from(i % 8) + 0.5, f64::from(i / 8) + 0.5, z]).collect();
        json!({"species": species, "placement": {"type": "listed", "positions": places}, "velocities": {"type": "rest"}})
    };
    let place = Place::of(json!({
        "title": "two layers",
        "space": {"box": [8, 8, 4]},
        "time": {"step": 0.01, "steps": 1},
        "temperature": 0,
        "particles": [layer("low", 0.25), layer("high", 2.5)],
        "interactions": [{"type": "dpd", "repulsion": 0, "friction": 1}],
        "output": {"energies": {"every": 1}, "plot": {"width": 320, "height": 240}, "snapshot": null},
    }));
    let directory = place.argument("out");
    succeeds(&["run", &place.scene(), "--out", &directory, "--quiet"]);
    assert!(!place.path("out/snapshot.png").exists(), "null is no picture");
    let coloured = |settings: &[&str]| {
        let sets = settings.iter().flat_map(|setting| ["--set", setting]);
        let arguments: Vec<&str> =
            ["plot", &directory, "--set", "output.snapshot.width=300"].into_iter().chain(sets).collect();
        succeeds(&arguments);
        let picture = picture(&place.path("out/snapshot.png"));
        let mut counts = [0, 0];
        // Blue and orange above the legend.
        for (_, _, pixel) in picture.enumerate_pixels().filter(|(_, y, _)| *y < picture.height() * 3 / 4) {
            let (red, blue) = (i32::from(pixel[0]), i32::from(pixel[2]));
            counts[0] += i32::from(blue > red + 40);
            counts[1] += i32::from(red > blue + 40);
        }
        (picture.dimensions(), counts)
    };
    let (_, both) = coloured(&[]);
    assert!(both[0] > 300 && both[1] > 300, "{both:?}");
    let slice = |z: f64| format!(r#"output.snapshot.slice={{"axis":"z","position":{z},"thickness":1}}"#);
    let (_, high) = coloured(&[&slice(2.25)]);
    assert!(high[0] == 0 && high[1] > 300, "{high:?}");
    // The box repeats itself: its top is next to its bottom.
    let (_, low) = coloured(&[&slice(3.9)]);
    assert!(low[0] > 300 && low[1] == 0, "{low:?}");
    // From above the upper layer hides the lower one; from the side both are rows, on a wider page.
    let (square, above) = coloured(&["output.snapshot.view=z"]);
    assert!(above[0] == 0 && above[1] > 300, "{above:?}");
    let (wide, aside) = coloured(&["output.snapshot.view=y"]);
    assert!(aside[0] > 100 && aside[1] > 100 && wide.1 < square.1, "{aside:?} {wide:?} {square:?}");
    assert_eq!(coloured(&["output.snapshot.view=x"]).0, wide);
}

#[test]
fn slices_and_views_are_checked() {
    let slice = |position: f64, thickness: f64| {
        format!(r#"output.snapshot.slice={{"axis":"y","position":{position},"thickness":{thickness}}}"#)
    };
    let bounds = [
        "output.snapshot.slice.position: found 21; accepted: a place along y in the box: 0 to 20",
        "output.snapshot.slice.thickness: found 30; accepted: at most 20",
    ];
    fails(&["check", "dpd-fluid", "--set", &slice(21.0, 30.0)], 2, &bounds);
    fails(
        &["check", "dpd-fluid", "--set", &slice(-1.0, 0.0)],
        2,
        &["slice.position: found -1", "slice.thickness: found 0"],
    );
    fails(&["check", "dpd-fluid", "--set", "output.snapshot.view=front"], 2, &[r#"accepted: "corner", "x", "y", "z""#]);
    for flat in ["dpd-fluid-2d", "voronoi-dpd"] {
        fails(&["check", flat, "--set", &slice(1.0, 1.0)], 2, &["no `slice` of a box that has not three dimensions"]);
        fails(
            &["check", flat, "--set", "output.snapshot.view=x"],
            2,
            &["no `view` of a box that has not three dimensions"],
        );
    }
    fails(
        &["check", "shallow-water", "--set", "output.snapshot.view=x"],
        2,
        &["no `output.snapshot` in shallow water"],
    );
    for name in ["shallow-water", "voronoi-dpd", "dpd-fluid"] {
        let output = mesoscope(&["check", name, "--set", "output.snapshot=null"]);
        assert!(output.status.success() && !text(&output.stdout).contains("snapshot.png"), "{}", text(&output.stderr));
    }
}

#[test]
fn a_run_that_paused_has_the_same_pictures() {
    let whole = cooling();
    succeeds(&["run", &whole.scene(), "--out", &whole.argument("out"), "--quiet"]);
    let paused = cooling();
    let directory = paused.argument("out");
    succeeds(&["run", &paused.scene(), "--out", &directory, "--quiet", "--steps", "30"]);
    succeeds(&["resume", &directory, "--steps", "60", "--quiet"]);
    let names = listing(&whole.path("out"));
    assert!(names.iter().filter(|name| name.starts_with("snapshot")).count() == 5, "{names:?}");
    for name in names.iter().filter(|name| name.contains(".png")) {
        let name = format!("out/{name}");
        assert!(bytes(&whole.path(&name)) == bytes(&paused.path(&name)), "{name} differs");
    }
}

#[test]
fn ranges_of_colours_are_checked() {
    for (pointer, value, parts) in [
        ("/output/snapshot/range", json!([2, 2]), &["output.snapshot.range: found [2, 2]", "a higher one"][..]),
        ("/output/snapshot/range", json!([3, 1]), &["found [3, 1]"]),
        ("/output/snapshot/range", json!([1]), &["output.snapshot.range"]),
        ("/output/snapshot/range", json!([0, 1e39]), &["within 1e30"]),
    ] {
        let place = cooling().with(pointer, value);
        fails(&["check", &place.scene()], 2, parts);
    }
    let species = cooling().with("/output/snapshot", json!({"range": [0, 1]}));
    fails(&["check", &species.scene()], 2, &["no `range` for colours of species"]);
    let set = "output.fields={\"ranges\":{\"depth\":[1,1]}}";
    fails(&["check", "shallow-water", "--set", set], 2, &["output.fields.ranges.depth"]);
    let output = mesoscope(&["check", "shallow-water", "--set", "output.fields={\"ranges\":{\"depth\":[0.8,1.2]}}"]);
    assert!(output.status.success(), "{}", text(&output.stderr));
}

#[test]
fn sizes_of_chains_are_printed_and_plotted_and_missing_letters_named() {
    let scene: Value = json!({
        "title": "Rings of 水 ∇",
        "space": {"box": [5, 5, 5]},
        "time": {"step": 0.02, "steps": 20},
        "temperature": 1,
        "particles": [{"species": "trimer", "count": 30, "chain": {"beads": 3, "spacing": 0.8}}],
        "interactions": [
            {"type": "dpd", "repulsion": 10, "friction": 4.5},
            {"type": "bonds", "potential": {"type": "harmonic", "stiffness": 4}},
        ],
        "output": {"energies": {"every": 5}, "chain_sizes": {"every": 2}, "plot": {"width": 400}, "snapshot": {"width": 100}},
    });
    let place = Place::of(scene);
    let (said, warned) = succeeds_and_tells(&["run", &place.scene(), "--out", &place.argument("out")]);
    for part in
        ["end-to-end distance² of `trimer` (3 beads)", "gyration radius² of `trimer` (3 beads)", "chain_sizes.png"]
    {
        assert!(said.contains(part), "`{part}` is not in: {said}");
    }
    assert!(warned.contains("水∇"), "{warned}");
    assert_eq!(picture(&place.path("out/chain_sizes.png")).width(), 400);
}

/// A rod knows no copy of the box that is displaced: a bond across boundaries that shear is left out, and one beside them is drawn.
#[test]
fn bonds_across_boundaries_that_shear_are_left_out() {
    for (across, upper) in [(true, 5.8), (false, 0.6)] {
        // The copy above is displaced by 2, so that the ends are .4 apart in both.
        let x = if across { 5.0 } else { 1.0 };
        let place = Place::of(json!({
            "title": "a bond",
            "space": {"box": [6, 6], "shear": {"rate": 0.001, "gradient": "y", "displacement": 2}},
            "time": {"step": 0.01, "steps": 1},
            "temperature": 0,
            "particles": [{"species": "A", "chain": {"beads": 2, "spacing": 0.4},
                "placement": {"type": "listed", "positions": [[x, 0.2], [1, upper]]}, "velocities": {"type": "rest"}}],
            "interactions": [
                {"type": "dpd", "repulsion": 0, "friction": 0},
                {"type": "bonds", "potential": {"type": "harmonic", "stiffness": 1, "length": 0.4}},
            ],
            "output": {"energies": {"every": 1}, "plot": {"width": 400},
                "snapshot": {"width": 300, "height": 300, "radius": 0.1}},
        }));
        place.run("with", &["--quiet"]);
        place.run("without", &["--quiet", "--set", "output.snapshot.bonds=false"]);
        let [with, without] = ["with", "without"].map(|run| picture(&place.path(&format!("{run}/snapshot.png"))));
        assert_eq!(with == without, across);
        // It pulls all the same: at its length at rest it has no energy, and as long as the box it would have some.
        let energy = place.table("with", "energies.csv").column("potential_energy").unwrap();
        assert!(energy.iter().all(|energy| energy.abs() < 1e-3), "{energy:?}");
    }
}

/// Pixels inside a picture that have a colour of the chart.
fn pixels(place: &Place, name: &str, colour: [u8; 3]) -> usize {
    let near = |pixel: &&image::Rgba<u8>| (0..3).all(|channel| pixel[channel].abs_diff(colour[channel]) <= 24);
    picture(&place.path(name)).pixels().filter(near).count()
}

/// The stress over time, its autocorrelation and its profile: every component has a line of its own, tables hold what is drawn, and a
/// run that is drawn again has the same pictures.
#[test]
fn the_stress_is_drawn_and_in_tables() {
    let place = Place::of(json!({
        "title": "a fluid under its stress",
        "space": {"box": [3, 4, 6]},
        "time": {"step": 0.02, "steps": 600, "equilibration": 100},
        "temperature": 1,
        "particles": [{"species": "A", "number_density": 3}],
        "interactions": [{"type": "dpd", "repulsion": 25, "friction": 4.5}],
        "output": {
            "energies": {"every": 10},
            "stress": {"every": 1, "window": 40, "normal": "z"},
            "profiles": {"axis": "z", "bins": 6, "every": 5, "quantities": ["density", "stress"]},
            "plot": {"width": 640, "height": 480},
            "snapshot": {"width": 100, "height": 80},
        },
    }));
    place.run("out", &["--quiet"]);
    // Blue and vermilion are the first two lines of a panel; the third is black as frames are.
    let inks = [[0x00, 0x72, 0xb2], [0xd5, 0x5e, 0x00]];
    for (name, lines) in [("stress.png", 2), ("stress_correlation.png", 1), ("profiles.png", 2)] {
        let drawn =
            save(&format!("run-{}", name.trim_end_matches(".png")), picture(&place.path(&format!("out/{name}"))));
        let name = format!("out/{name}");
        assert_eq!(drawn.dimensions(), (640, 480), "{name}");
        for ink in &inks[..lines] {
            let found = pixels(&place, &name, *ink);
            assert!(found > 60, "{name}: {found} pixels of {ink:x?}");
        }
    }
    let names = ["stress.png", "stress_correlation.png", "profiles.png"].map(|name| format!("out/{name}"));
    let drawn = names.each_ref().map(|name| bytes(&place.path(name)));
    succeeds(&["plot", &place.argument("out")]);
    assert!(names.each_ref().map(|name| bytes(&place.path(name))) == drawn);
    // Each sample is the sum of its parts.
    let table = place.table("out", "stress.csv");
    let of = |name: &str| table.column(name).unwrap();
    for component in ["xx", "yy", "zz", "xy", "xz", "yz"] {
        let parts = ["kinetic", "conservative", "frictional"].map(|part| of(&format!("{part}_{component}")));
        for (row, whole) in of(&format!("pressure_{component}")).iter().enumerate() {
            let sum: f64 = parts.iter().map(|part| part[row]).sum();
            assert!((whole - sum).abs() < 1e-4, "{component} of row {row}: {whole} {sum}");
        }
    }
    assert_eq!(of("time").len(), 501);
    let correlation = place.table("out", "stress_correlation.csv");
    assert_eq!(correlation.column("time").unwrap().len(), 41);
    assert!(correlation.column("viscosity").unwrap().last().unwrap().is_finite());
    let profile = place.table("out", "profiles.csv");
    let mut trace = 0.0;
    for component in ["xx", "yy", "zz", "xy", "xz", "yz"] {
        let [values, errors] = ["", "_error"].map(|end| profile.column(&format!("pressure_{component}{end}")).unwrap());
        assert!(
            values.len() == 6 && errors.iter().all(|error| *error > 0.0 && *error < 10.0),
            "{component}: {errors:?}"
        );
        if component.as_bytes()[0] == component.as_bytes()[1] {
            trace += values.iter().sum::<f64>() / 18.0;
        }
    }
    // The pressure of this fluid is 23.6; some 100 independent samples of a box this small are right to 2 %.
    assert!((trace / 23.65 - 1.0).abs() < 0.06, "{trace}");
}
