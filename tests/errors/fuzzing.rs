//! Scenes that nobody would write: shipped ones, mutated at random from a seed. Each is answered, right or wrong, without a
//! panic, in bounded time and memory, and one that is accepted has a model and a plan.

use std::sync::mpsc;
use std::time::Duration;

use mesoscope::plan::{self, Hardware, Options};
use mesoscope::run;
use mesoscope::run::Sizes;
use mesoscope::scene::{self, SceneError};
use rand::rngs::StdRng;
use rand::seq::IndexedRandom as _;
use rand::{RngExt as _, SeedableRng as _};
use serde_json::{Map, Value, json};

use crate::cost::{Cost, MEMORY, PATIENCE, measured};

/// The longest text.
const LONGEST: usize = 1 << 20;

/// What became of a text.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Answer {
    Accepted,
    Refused,
}

/// What `check` and the beginning of `run` do with a scene, short of an adapter.
fn answer(text: &str) -> Answer {
    let scene = match scene::parse("mutated", text, &[]) {
        Ok(scene) => scene,
        Err(error @ SceneError::SchemaMismatch { .. }) => panic!("{error}"),
        Err(error) => {
            assert!(!error.to_string().is_empty());
            return Answer::Refused;
        }
    };
    assert!(mesoscope::families::warnings(&scene).iter().all(|warning| !warning.message.is_empty()));
    let hardware = Hardware { subgroup_size: Some(8), serial_memory: true, ..Hardware::default() };
    for hardware in [Hardware::default(), hardware] {
        let plan = run::plan(&scene, hardware, Options::default());
        assert!(plan.bytes() >= plan.largest_buffer());
        // Whatever it says, it must not overflow.
        let _ = Sizes::of(&scene, &plan);
        if plan::check_precision(&scene, &plan).is_err() {
            return Answer::Refused;
        }
    }
    Answer::Accepted
}

/// A thread that answers texts one after the other; it is given up where it does not come back.
struct Worker {
    ask: mpsc::Sender<String>,
    told: mpsc::Receiver<(Result<Answer, String>, Cost)>,
}

impl Worker {
    fn new() -> Self {
        let (ask, asked) = mpsc::channel::<String>();
        let (tell, told) = mpsc::channel();
        let work = move || {
            for text in asked {
                let (answer, cost) = measured(|| answer(&text));
                let answer = answer.map_err(|panic| match panic.downcast_ref::<String>() {
                    Some(message) => message.clone(),
                    None => panic.downcast_ref::<&str>().map_or("a panic", |message| message).to_owned(),
                });
                if tell.send((answer, cost)).is_err() {
                    break;
                }
            }
        };
        std::thread::Builder::new().stack_size(2 << 20).spawn(work).unwrap();
        Self { ask, told }
    }

    /// The answer and what it cost, or what went wrong.
    fn answer(&self, text: &str) -> Result<(Answer, Cost), String> {
        self.ask.send(text.to_owned()).unwrap();
        // The others that are measured come first, if need be.
        match self.told.recv_timeout(3 * PATIENCE) {
            Err(_) => Err("no answer".to_owned()),
            Ok((Err(message), _)) => Err(message),
            Ok((Ok(_), cost)) if cost.time > PATIENCE => Err(format!("{:?}", cost.time)),
            Ok((Ok(_), cost)) if cost.memory > MEMORY => Err(format!("{} MB", cost.memory >> 20)),
            Ok((Ok(answer), cost)) => Ok((answer, cost)),
        }
    }
}

/// Answers to all texts; texts without one are kept in files.
#[track_caller]
fn answers(texts: impl IntoIterator<Item = (String, String)>) -> Vec<(Answer, Cost)> {
    let (mut found, mut failures) = (Vec::new(), Vec::new());
    let mut worker = Worker::new();
    for (name, text) in texts {
        match worker.answer(&text) {
            Ok(answer) => found.push(answer),
            Err(message) => {
                let path = std::env::temp_dir().join(format!("mesoscope-{}.json", name.replace(' ', "-")));
                std::fs::write(&path, &text).unwrap();
                failures.push(format!("{name} ({}): {message}", path.display()));
                worker = Worker::new();
            }
        }
    }
    assert!(failures.is_empty(), "{} of {}:\n{}", failures.len(), failures.len() + found.len(), failures.join("\n"));
    found
}

/// Numbers at the ends of ranges, and where something begins or ends.
const NUMBERS: [f64; 30] = [
    0.0,
    -0.0,
    -1.0,
    1.0,
    2.0,
    3.0,
    0.5,
    7.0,
    64.0,
    255.0,
    257.0,
    4096.0,
    1e-3,
    1e-8,
    1e-30,
    1e-45,
    1e-99,
    1e-300,
    5e-324,
    1e6,
    1e9,
    4e9,
    4_294_967_296.0,
    1e15,
    1.8e19,
    1e39,
    1e99,
    1e300,
    1.7e308,
    -1e300,
];

/// Words that stand where others should.
const WORDS: [&str; 12] =
    ["", "NaN", "inf", "-inf", "1", "null", "A", "water", "../../etc/passwd", "a\u{0}b", "\u{1F9EA}", "random"];

struct Mutator {
    random: StdRng,
    scenes: Vec<Value>,
}

impl Mutator {
    fn new(seed: u64) -> Self {
        let scenes = scene::builtin().iter().map(|builtin| serde_json::from_str(builtin.text).unwrap()).collect();
        Self { random: StdRng::seed_from_u64(seed), scenes }
    }

    /// A shipped scene with a few things changed, and sometimes its text damaged.
    fn text(&mut self) -> String {
        let mut scene = self.scene();
        for _ in 0..self.random.random_range(1..=6) {
            self.change(&mut scene);
        }
        let mut text = if self.random.random_bool(0.5) {
            scene.to_string()
        } else {
            serde_json::to_string_pretty(&scene).unwrap()
        };
        if self.random.random_bool(0.15) {
            text = self.damaged(text);
        }
        if text.len() > LONGEST { self.scene().to_string() } else { text }
    }

    fn scene(&mut self) -> Value {
        self.scenes.choose(&mut self.random).unwrap().clone()
    }

    /// All places of a document.
    fn places(value: &Value) -> Vec<String> {
        fn walk(value: &Value, path: &str, places: &mut Vec<String>) {
            places.push(path.to_owned());
            match value {
                Value::Array(list) => {
                    for (index, entry) in list.iter().enumerate().take(40) {
                        walk(entry, &format!("{path}/{index}"), places);
                    }
                }
                Value::Object(object) => {
                    for (key, entry) in object {
                        walk(entry, &format!("{path}/{}", key.replace('~', "~0").replace('/', "~1")), places);
                    }
                }
                _ => {}
            }
        }
        let mut places = Vec::new();
        walk(value, "", &mut places);
        places
    }

    fn place<'a>(&mut self, value: &'a mut Value, wanted: impl Fn(&Value) -> bool) -> Option<&'a mut Value> {
        let places: Vec<String> =
            Self::places(value).into_iter().filter(|place| value.pointer(place).is_some_and(&wanted)).collect();
        let place = places.choose(&mut self.random)?;
        value.pointer_mut(place)
    }

    fn number(&mut self) -> Value {
        let number = *NUMBERS.choose(&mut self.random).unwrap();
        let whole = number.fract() == 0.0 && (0.0..1.8e19).contains(&number);
        if whole && self.random.random_bool(0.5) { (number as u64).into() } else { number.into() }
    }

    fn anything(&mut self) -> Value {
        match self.random.random_range(0..8) {
            0 => Value::Null,
            1 => self.random.random_bool(0.5).into(),
            2 => json!([]),
            3 => json!({}),
            4 => self.number(),
            5 => "x".repeat(self.random.random_range(0..5000)).into(),
            6 => vec![self.number(); 3].into(),
            _ => (*WORDS.choose(&mut self.random).unwrap()).into(),
        }
    }

    /// One change.
    fn change(&mut self, scene: &mut Value) {
        match self.random.random_range(0..16) {
            0..=4 => {
                let number = self.number();
                if let Some(place) = self.place(scene, Value::is_number) {
                    *place = number;
                }
            }
            5 => {
                let factor = 10_f64.powi(self.random.random_range(-12..=12));
                if let Some(place) = self.place(scene, Value::is_number) {
                    *place = json!(place.as_f64().unwrap() * factor);
                }
            }
            6 => {
                let other = self.anything();
                if let Some(place) = self.place(scene, |_| true) {
                    *place = other;
                }
            }
            7 | 8 => self.change_keys(scene),
            9 => self.nest(scene),
            10 | 11 => self.change_list(scene),
            12 | 13 => self.splice(scene),
            14 => {
                let other = self.scene();
                let interactions = other["interactions"].as_array().cloned().unwrap_or_default();
                let interaction = interactions.choose(&mut self.random).cloned();
                let list = scene.get_mut("interactions").and_then(Value::as_array_mut);
                if let (Some(list), Some(interaction)) = (list, interaction) {
                    list.push(interaction);
                }
            }
            _ => {
                let mut other = self.scene();
                let word = self.place(&mut other, Value::is_string).cloned();
                if let (Some(place), Some(word)) = (self.place(scene, Value::is_string), word) {
                    *place = word;
                }
            }
        }
    }

    /// Takes a key out, gives it another name, or adds one.
    fn change_keys(&mut self, scene: &mut Value) {
        let action = self.random.random_range(0..3);
        let (value, word) = (self.anything(), *WORDS.choose(&mut self.random).unwrap());
        let Some(Value::Object(object)) =
            self.place(scene, |value| value.as_object().is_some_and(|object| !object.is_empty()))
        else {
            return;
        };
        let keys: Vec<String> = object.keys().cloned().collect();
        let key = keys.choose(&mut self.random).unwrap();
        match action {
            0 => {
                object.remove(key);
            }
            1 => {
                let mut renamed = key.clone();
                renamed.pop();
                renamed.push_str(word);
                let value = object.remove(key).unwrap();
                object.insert(renamed, value);
            }
            _ => {
                object.insert(word.to_owned(), value);
            }
        }
    }

    fn nest(&mut self, scene: &mut Value) {
        let (depth, lists) = (self.random.random_range(1..120), self.random.random_bool(0.5));
        if let Some(place) = self.place(scene, |_| true) {
            let mut value = place.take();
            for _ in 0..depth {
                value = if lists { vec![value].into() } else { Map::from_iter([("type".to_owned(), value)]).into() };
            }
            *place = value;
        }
    }

    /// Makes a list longer or shorter; particle groups get species of their own.
    fn change_list(&mut self, scene: &mut Value) {
        let times = 10_f64.powf(self.random.random_range(0.0..4.3)) as usize;
        let shorter = self.random.random_bool(0.3);
        let own_species = self.random.random_bool(0.5);
        let Some(Value::Array(list)) = self.place(scene, Value::is_array) else { return };
        if shorter || list.is_empty() {
            list.pop();
            return;
        }
        let entry = list[0].clone();
        let size = entry.to_string().len() + 1;
        for number in 0..times.min(LONGEST / 2 / size) {
            let mut entry = entry.clone();
            if own_species && entry.get("species").is_some_and(Value::is_string) {
                entry["species"] = format!("s{number}").into();
            }
            list.push(entry);
        }
    }

    /// Puts a part of another scene in the place of one that has the same key.
    fn splice(&mut self, scene: &mut Value) {
        let other = self.scene();
        let places: Vec<String> = Self::places(scene);
        let place = places.choose(&mut self.random).unwrap();
        let key = place.rsplit('/').next().unwrap();
        let alike: Vec<String> =
            Self::places(&other).into_iter().filter(|place| place.rsplit('/').next() == Some(key)).collect();
        if let (Some(found), Some(target)) = (alike.choose(&mut self.random), scene.pointer_mut(place)) {
            *target = other.pointer(found).unwrap().clone();
        }
    }

    /// Bytes changed, taken out or said again.
    fn damaged(&mut self, text: String) -> String {
        let mut bytes = text.into_bytes();
        for _ in 0..self.random.random_range(1..4) {
            if bytes.is_empty() {
                break;
            }
            let at = self.random.random_range(0..bytes.len());
            let length = self.random.random_range(0..40).min(bytes.len() - at);
            match self.random.random_range(0..4) {
                0 => bytes[at] = *b"{}[],:\"0-e.\\\x00\xff ".choose(&mut self.random).unwrap(),
                1 => {
                    bytes.drain(at..at + length);
                }
                2 => {
                    let again = bytes[at..at + length].to_vec();
                    bytes.splice(at..at, again);
                }
                _ => bytes.truncate(at),
            }
        }
        String::from_utf8_lossy(&bytes).into_owned()
    }
}

/// So many texts from a seed.
fn mutated(seed: u64, count: usize) -> impl Iterator<Item = (String, String)> {
    let mut mutator = Mutator::new(seed);
    (0..count).map(move |number| (format!("seed {seed} text {number}"), mutator.text()))
}

#[track_caller]
fn report(found: &[(Answer, Cost)]) {
    let accepted = found.iter().filter(|(answer, _)| *answer == Answer::Accepted).count();
    let slowest = found.iter().map(|(_, cost)| cost.time).max().unwrap();
    let largest = found.iter().map(|(_, cost)| cost.memory).max().unwrap();
    let slow = found.iter().filter(|(_, cost)| cost.time > Duration::from_secs(1)).count();
    println!(
        "{} scenes: {accepted} accepted; slowest {slowest:.2?}, {slow} over a second; most memory {} MB",
        found.len(),
        largest >> 20
    );
    // Mutations that nothing survives, or that change nothing, would try nothing.
    assert!(accepted > found.len() / 50 && accepted < found.len() / 2, "{accepted} of {} accepted", found.len());
}

#[test]
fn a_few_mutated_scenes_are_answered() {
    report(&answers(mutated(1, 200)));
}

#[test]
#[ignore = "minutes; part of make validate"]
fn thousands_of_mutated_scenes_are_answered() {
    for seed in 2..12 {
        report(&answers(mutated(seed, 2000)));
    }
}

/// Writes the texts of a seed into a directory, for a program of another version: `MESOSCOPE_SCENES=directory`.
#[test]
#[ignore = "writes files where it is told to"]
fn mutated_scenes_are_written() {
    let Ok(directory) = std::env::var("MESOSCOPE_SCENES") else { return };
    for (name, text) in mutated(1, 2000) {
        std::fs::write(format!("{directory}/{}.json", name.replace(' ', "-")), text).unwrap();
    }
}

/// A shipped scene with changes as on the command line.
fn changed(name: &str, overrides: &[(&str, Value)]) -> String {
    let builtin = scene::builtin().iter().find(|builtin| builtin.name == name).unwrap();
    let mut scene: Value = serde_json::from_str(builtin.text).unwrap();
    for (place, value) in overrides {
        *scene.pointer_mut(place).unwrap_or_else(|| panic!("{place}")) = value.clone();
    }
    scene.to_string()
}

/// Mistakes that further checks stumbled over, and sizes that were made before they were looked at.
#[test]
fn sizes_and_known_mistakes_cost_nothing() {
    let group = |index: usize| json!({"species": format!("s{index}"), "count": 3});
    let groups: Vec<Value> = (0..20_000).map(group).collect();
    let refused = [
        changed("edpd-fluid", &[("/space/box", json!([10, 10, 10, 10]))]),
        changed("edpd-fluid", &[("/space/box", json!([]))]),
        changed("coloured-noise", &[("/time/step", json!(-1))]),
        changed("voronoi-dpd", &[("/space/box", json!([16, 0]))]),
        changed("harmonic-chain", &[("/interactions/0/pulse/clusters", json!(10_000_000))]),
        changed("dpd-fluid", &[("/particles", groups.into())]),
        changed("dpd-fluid", &[("/interactions/0/cutoff", json!(5e-324))]),
        changed("dpd-fluid", &[("/particles/0/number_density", json!(1e300))]),
    ];
    let accepted = [
        changed(
            "polymer-melt",
            &[("/particles/0/count", json!(1_000_000_000)), ("/space/box", json!([700, 700, 700]))],
        ),
        changed(
            "polymer-melt",
            &[
                ("/particles/0/count", json!(4_000_000_000_u64)),
                ("/particles/0/chain/beads", json!(4_000_000_000_u64)),
                ("/space/box", json!([1500, 1500, 1500])),
            ],
        ),
        changed(
            "harmonic-chain",
            &[
                ("/interactions/0/pulse/clusters", json!(65_536)),
                ("/interactions/0/cluster_size", json!(256)),
                ("/interactions/0/spacing", json!(100)),
                ("/space/box", json!([100_000])),
            ],
        ),
        changed("dpd-fluid", &[("/particles/0/number_density", json!(400_000)), ("/time/step", json!(1e-6))]),
        changed("voronoi-energy", &[("/particles/0/count", json!(200_000_000))]),
    ];
    let count = refused.len();
    let texts = refused.into_iter().chain(accepted).enumerate();
    let found = answers(texts.map(|(number, text)| (format!("size {number}"), text)));
    for (number, (answer, cost)) in found.iter().enumerate() {
        println!("{number}: {answer:?} {:?} {} kB", cost.time, cost.memory >> 10);
        assert_eq!(*answer == Answer::Refused, number < count, "{number}");
    }
}

/// Long texts of one kind: whatever is right or wrong a hundred thousand times is looked at once each.
#[test]
fn long_texts_take_no_longer_than_they_are() {
    let fluid = |place: &str, value: String| {
        let builtin = scene::builtin()[0].text;
        let mut scene: Value = serde_json::from_str(builtin).unwrap();
        let (parent, key) = place.rsplit_once('/').unwrap();
        let parent = scene.pointer_mut(parent).unwrap().as_object_mut().unwrap();
        parent.insert(key.to_owned(), "HERE".into());
        scene.to_string().replace("\"HERE\"", &value)
    };
    let repeated = |what: &str| what.repeat(LONGEST / what.len() - 2000 / what.len());
    let list = |entry: &str| format!("[{}{entry}]", repeated(&format!("{entry},")));
    let long = "k".repeat(500_000);
    let species = (0..400).map(|index| format!(r#"{{"species":"sp{index}","count":2}}"#)).collect::<Vec<_>>().join(",");
    let pairs = (0..10_000)
        .map(|index| format!(r#"{{"between":["sq{index}","sp1"],"friction":2}}"#))
        .collect::<Vec<_>>()
        .join(",");
    let texts = [
        fluid("/particles", list("[1]")),
        fluid("/particles", list("{}")),
        fluid("/particles", list(r#"{"a":1}"#)),
        fluid("/space/box", list("1")),
        fluid("/space/box", list("\"1\"")),
        fluid("/particles/0/placement", format!(r#"{{"type":"listed","positions":{}}}"#, list("[1,2]"))),
        fluid("/particles/0/placement", format!(r#"{{"type":"listed","positions":{}}}"#, list("[1,2,3]"))),
        fluid("/particles/0/velocities", format!(r#"{{"type":"listed","velocities":{}}}"#, list("[]"))),
        fluid("/interactions", list(r#"{"type":"bonds"}"#)),
        fluid("/interactions", list(r#"{"type":"dpd"}"#)),
        fluid("/interactions", format!(r#"[{{"type":"bonds","pairs":{}}}]"#, list("[0,1]"))),
        fluid("/interactions", format!(r#"[{{"type":"angles","triples":{}}}]"#, list("[0,1]"))),
        fluid("/output", format!(r#"{{"histograms":{}}}"#, list(r#"{"quantity":"speed","every":1}"#))),
        fluid("/output", format!("{{{}\"z\":1}}", repeated("\"a\":1,"))),
        fluid("/output", format!("{{\"{long}\":{{{}\"z\":1}}}}", "\"a\":1,".repeat(80_000))),
        fluid("/title", format!("\"{long}\"")),
        fluid("/particles/0/species", format!("\"{long}\"")),
        fluid("/particles", format!("[{species}]")).replace("\"friction\":4.5", &format!("\"pairs\":[{pairs}]")),
        "[".repeat(LONGEST),
        "{\"a\":".repeat(100_000),
    ];
    let found = answers(texts.into_iter().enumerate().map(|(number, text)| (format!("long {number}"), text)));
    for (number, (answer, cost)) in found.iter().enumerate() {
        println!("{number}: {answer:?} {:?} {} MB", cost.time, cost.memory >> 20);
    }
}
