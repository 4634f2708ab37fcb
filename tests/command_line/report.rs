//! Pages of runs and studies, completions and manual pages.

use std::fs;

use serde_json::{Value, json};

use crate::support::program::{Place, fails, succeeds};

fn fluid() -> Value {
    json!({
        "title": "<b>R&D</b> of a fluid",
        "space": {"box": [3, 3, 3]},
        "time": {"step": 0.02, "steps": 40},
        "temperature": 1,
        "particles": [{"species": "A<i>", "number_density": 3}],
        "interactions": [{"type": "dpd", "repulsion": 25, "friction": 4.5}],
        "output": {"energies": {"every": 5}, "plot": {"width": 320, "height": 240},
            "snapshot": {"width": 64, "height": 64, "every": 10},
            "diffusion": {"every": 2, "window": 8}},
    })
}

fn page(place: &Place, directories: &[&str]) -> String {
    let out = place.argument("page.html");
    let directories: Vec<String> = directories.iter().map(|name| place.argument(name)).collect();
    let mut arguments = vec!["report", "--force", "--out", &out];
    arguments.extend(directories.iter().map(String::as_str));
    succeeds(&arguments);
    fs::read_to_string(place.path("page.html")).unwrap()
}

#[test]
fn a_page_has_what_a_run_left_and_escapes_it() {
    let place = Place::of(fluid());
    place.run("run", &["--quiet"]);
    let text = page(&place, &["run"]);
    assert!(text.contains("<title>&lt;b&gt;R&amp;D&lt;&#x2f;b&gt; of a fluid</title>"), "{}", &text[..1200]);
    assert!(!text.contains("<b>") && !text.contains("A<i>") && !text.contains("<script"));
    let summary = place.summary("run");
    let temperature = &summary.means["temperature"];
    let [value, error] = ["value", "error"].map(|key| temperature[key].as_f64());
    let shown = mesoscope::numbers::with_error(value.unwrap(), error);
    assert!(shown.contains('±') && text.contains(&shown), "{shown}");
    // The charts, and snapshots at steps 0 to 40.
    assert_eq!(
        text.matches("data:image/png;base64,").count(),
        8,
        "energies, diffusion, snapshot, and five as it went on"
    );
    for said in
        ["81 in a box of 3 × 3 × 3", "mean after equilibration", "to the last bit: ", &summary.run_id.to_string()]
    {
        assert!(text.contains(said), "{said}");
    }
    // The sheet holds the same pictures below its texts.
    let sheet = place.argument("sheet.png");
    succeeds(&["report", &place.argument("run"), "--png", "--out", &sheet]);
    let sheet = image::open(place.path("sheet.png")).unwrap().into_rgb8();
    let energies = image::open(place.path("run/energies.png")).unwrap().into_rgb8();
    assert_eq!(sheet.width(), 1654);
    let ink = |rows: std::ops::Range<u32>| {
        let pixels = rows.flat_map(|row| (0..sheet.width()).map(move |column| (column, row)));
        pixels.filter(|(column, row)| sheet.get_pixel(*column, *row).0 != [255; 3]).count()
    };
    assert!(ink(0..90) == 0 && ink(90..150) > 1000, "the margin is blank, and the title is not");
    assert!(sheet.height() > 1000 + energies.height() && ink(sheet.height() - 80..sheet.height()) == 0);
    let out = place.argument("page.html");
    fails(&["report", &place.argument("run"), "--out", &out], 5, &["page.html` exists", "--force"]);
}

#[test]
fn a_page_says_what_is_missing() {
    let place = Place::of(fluid());
    place.run("run", &["--quiet"]);
    fs::write(place.path("run/energies.png"), b"no picture").unwrap();
    fs::remove_file(place.path("run/diffusion.csv")).unwrap();
    let text = page(&place, &["run"]);
    for said in ["Not all of it is here", "`energies` is damaged", "`diffusion.csv` is not there any more"] {
        assert!(text.contains(said), "{said}");
    }
    fs::remove_file(place.path("run/run.json")).unwrap();
    let text = page(&place, &["run"]);
    for said in ["the run has not ended, or was interrupted", "The last row of the table of energies"] {
        assert!(text.contains(said), "{said}");
    }
    fs::write(place.path("run/run.json"), b"{").unwrap();
    assert!(page(&place, &["run"]).contains("Not all of it is here"));
    fs::create_dir(place.path("empty")).unwrap();
    let (empty, none) = (place.argument("empty"), place.argument("none"));
    fails(&["report", &empty], 5, &["there is nothing to report in `", "none of the files in it"]);
    fails(&["report", &none], 5, &["there is no such directory", "accepted: the directory of a run, a sweep"]);
}

#[test]
fn a_page_may_be_of_several_studies() {
    let place = Place::of(fluid());
    let scene = place.scene();
    let [sweep, tradeoff] = ["sweep", "tradeoff"].map(|name| place.argument(name));
    let varied = "interactions.0.friction=2,9";
    succeeds(&["sweep", &scene, "--vary", varied, "--vary", "seed=1,2", "--out", &sweep, "--quiet"]);
    let choices = ["tradeoff", &scene, "--vary", "time.step=0.01,0.02", "--measure", "temperature"];
    succeeds(&[&choices[..], &["--target", "temperature=50%", "--out", &tradeoff, "--quiet"]].concat());
    let text = page(&place, &["sweep", "tradeoff"]);
    for said in ["interactions.0.friction = 2, 9", "Means over seeds", "The request", "Choose ", "<h2>Costs</h2>"] {
        assert!(text.contains(said), "{said}");
    }
    assert!(!text.contains("A<i>") && !text.contains("<b>"));
}

#[test]
fn shells_complete_and_manuals_tell() {
    let place = Place::of(fluid());
    for shell in ["bash", "zsh", "fish"] {
        let text = succeeds(&["completions", shell]);
        assert!(["tradeoff", "budget", "report"].iter().all(|word| text.contains(word)), "{shell}");
    }
    succeeds(&["man", &place.argument("man")]);
    let page = fs::read_to_string(place.path("man/mesoscope-run.1")).unwrap();
    assert!(page.contains("Ctrl") && page.contains("ranks"));
    fs::write(place.path("file"), b"").unwrap();
    fails(&["man", &place.argument("file/man")], 5, &["cannot write manual pages into", "choose another directory"]);
}
