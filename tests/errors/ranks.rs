//! Ranks that do not fit together: of other arithmetic, another version, or gone. They are threads that talk as processes do.

use std::path::PathBuf;
use std::sync::Mutex;
use std::thread;

use mesoscope::engine::{Engine, EngineError, RankReport, Stepper as _, Swap};
use mesoscope::gpu::adapters_by_turns;
use mesoscope::output::{Summary, files};
use mesoscope::plan::{Division, Options, Part};
use mesoscope::ranks::threads::{self, Links, Peers, Threads};
use mesoscope::ranks::{Channel, Processes, Team, computes_alike, serve, sharing};
use mesoscope::run::{self, Event, Outcome, Run, RunError};
use mesoscope::scene::Checked;
use tempfile::TempDir;

use crate::support::program::{results, text};
use crate::support::{GROOT_WARREN, adapter, fluid, gpu, hardware, start};

const TWO: Division = Division { parts: [1, 1, 2] };

fn scene() -> Checked {
    let output = r#"output={"energies":{"every":3},"checkpoint":{"every":10},"plot":{"width":320,"height":240}}"#;
    fluid(&[GROOT_WARREN, "space.box=[4,4,9]", "time.steps=30", output])
}

/// What is done to a message.
type Change = fn(&str) -> String;

/// One of two ranks.
struct Rank {
    channel: Mutex<Threads>,
    /// They share one run.
    peers: Mutex<Option<Peers>>,
    /// What becomes of the call to share a run that it hears, and of the lines of its answers.
    heard: Change,
    said: Change,
}

struct Line<'a>(&'a Rank);

impl Processes for Rank {
    fn count(&self) -> u32 {
        2
    }

    fn channel(&self) -> Box<dyn Channel + '_> {
        Box::new(Line(self))
    }

    fn peers(&self) -> Box<dyn Swap + '_> {
        Box::new(self.peers.lock().unwrap().take().expect("one run"))
    }
}

impl Channel for Line<'_> {
    fn count(&self) -> u32 {
        2
    }

    fn tell(&mut self, message: &[u8]) -> Result<(), String> {
        self.0.channel.lock().unwrap().tell(message)
    }

    fn keep_alive(&self) {}

    fn listen(&mut self) -> Result<Vec<u8>, String> {
        let message = self.0.channel.lock().unwrap().listen()?;
        let is_call = message.starts_with(b"{\"Share\"");
        Ok(if is_call { (self.0.heard)(text(&message)).into_bytes() } else { message })
    }

    fn answer(&mut self, message: &[u8]) -> Result<(), String> {
        let end = message.iter().position(|byte| *byte == b'\n').unwrap();
        let (line, rest) = message.split_at(end);
        let line = (self.0.said)(text(line));
        self.0.channel.lock().unwrap().answer(&[line.as_bytes(), rest].concat())
    }

    fn collect(&mut self) -> Result<Vec<Vec<u8>>, String> {
        self.0.channel.lock().unwrap().collect()
    }
}

fn rank(links: Links, [heard, said]: [Change; 2]) -> Rank {
    let Links { channel, peers } = links;
    Rank { channel: Mutex::new(channel), peers: Mutex::new(Some(peers)), heard, said }
}

/// Runs on two ranks, of which the second is changed; what comes of it, and the warnings on the way.
fn share(simulation: Run, changes: [Change; 2]) -> (Result<Outcome, RunError>, Vec<String>) {
    let mut links = threads::links(2).into_iter();
    let (first, second) = (links.next().unwrap(), links.next().unwrap());
    let other = thread::spawn(move || run::follow(&rank(second, changes), 1, &adapter()));
    let first = rank(first, [same, same]);
    let mut warnings = Vec::new();
    let ended = simulation.on_ranks(Some(TWO)).execute_among(Some(&first), &adapter(), &mut |event| {
        if let Event::Warned { warning } = event {
            warnings.push(warning.to_owned());
        }
    });
    run::dismiss(&first).unwrap();
    other.join().unwrap().unwrap();
    (ended, warnings)
}

fn same(message: &str) -> String {
    message.to_owned()
}

/// As a driver does that rounds another way: forces differ in the last digits that count.
fn stiffer(call: &str) -> String {
    let stiffer = call.replace("\"repulsion\":25.0", "\"repulsion\":25.00001");
    assert_ne!(stiffer, call);
    stiffer
}

/// Says that it computes something else.
fn unlike(answer: &str) -> String {
    let Some((before, after)) = answer.split_once("\"arithmetic\":") else { return answer.to_owned() };
    let digits = after.find(|letter: char| !letter.is_ascii_digit()).unwrap();
    format!("{before}\"arithmetic\":7{}", &after[digits..])
}

/// Says the same, and that it is on another machine with another number of adapters.
fn elsewhere(answer: &str) -> String {
    unlike(answer).replacen("\"host\":\"", "\"host\":\"not-", 1).replacen("\"adapters\":", "\"adapters\":1", 1)
}

fn newer(call: &str) -> String {
    call.replacen(concat!("\"version\":\"", env!("CARGO_PKG_VERSION")), "\"version\":\"99", 1)
}

/// A directory with the results of an earlier run.
fn with_results() -> (TempDir, PathBuf) {
    let place = tempfile::tempdir().unwrap();
    let directory = place.path().join("results");
    let (ended, warnings) = share(Run::start(scene(), &directory), [same, same]);
    let summary = ended.unwrap().summary;
    let shared = summary.ranks.unwrap();
    let host = &shared.ranks[0].host;
    assert!(
        shared.alike && warnings == Vec::from_iter(sharing(2, adapters_by_turns(&adapter()), host)),
        "{warnings:?}"
    );
    assert!(!summary.warnings.iter().any(|warning| warning.contains("ranks")), "{:?}", summary.warnings);
    assert!(shared.slowest_over_mean >= 1.0 && shared.slowest_over_mean <= 2.0, "{shared:?}");
    for rank in &shared.ranks {
        assert!(!rank.host.is_empty() && rank.arithmetic == shared.ranks[0].arithmetic, "{rank:?}");
        assert!(rank.seconds_computing > 0.0 && rank.seconds_exchanging >= rank.seconds_waiting, "{rank:?}");
    }
    assert!(summary.conserved_exactly.contains(&"total momentum, to the last bit".to_owned()));
    (place, directory)
}

#[track_caller]
fn refused(ended: Result<Outcome, RunError>, parts: &[&str]) {
    let Err(error @ RunError::Engine(_)) = ended else { panic!("{ended:?}") };
    let message = error.to_string();
    for part in parts {
        assert!(message.contains(part), "`{part}` is not in: {message}");
    }
}

/// Whatever is wrong with another rank is found before an earlier run is replaced.
#[test]
fn ranks_that_cannot_take_part_cost_no_earlier_run_its_files() {
    let (_place, directory) = with_results();
    let before = results(&directory);
    let refuse = |changes: [Change; 2], parts: &[&str]| {
        let (ended, _) = share(Run::replace(scene(), &directory), changes);
        refused(ended, parts);
        assert!(results(&directory) == before, "{parts:?}");
    };
    refuse([newer, same], &["rank 1: is of version", "the first of 99"]);
    refuse(
        [same, unlike],
        &["the ranks compute differently", "\n  rank 0 on ", "\n  rank 1 on ", ": 00000007", "`--mixed`"],
    );
    // Where nothing may be replaced they are not even called.
    let alone = rank(threads::links(2).remove(0), [same, same]);
    let simulation = Run::start(scene(), &directory).on_ranks(Some(TWO));
    let ended = simulation.execute_among(Some(&alone), &adapter(), &mut |_| {});
    assert!(matches!(ended, Err(RunError::Output(_))), "{ended:?}");
    assert!(results(&directory) == before);
}

/// Ranks that seem to compute alike and do not: total momentum shows it, and the run ends with who they are.
#[test]
fn ranks_that_lose_momentum_are_refused() {
    let place = tempfile::tempdir().unwrap();
    let directory = place.path().join("out");
    let (ended, _) = share(Run::start(scene(), &directory), [stiffer, same]);
    refused(ended, &["total momentum along ", "should be constant to the last bit, but at step 3", "\n  rank 1 on "]);
    assert!(directory.join(files::CHECKPOINT).exists() && !directory.join(files::SUMMARY).exists());
}

/// The same where it is allowed: what the run says of itself is true, also after others have gone on with it.
#[test]
fn mixed_ranks_are_told_of_and_claim_nothing() {
    let place = tempfile::tempdir().unwrap();
    let directory = place.path().join("out");
    let simulation = Run::start(scene(), &directory).mixed();
    // Of adapters nothing is told: each rank has a machine to itself.
    let (ended, warnings) = share(simulation, [stiffer, elsewhere]);
    let summary = ended.unwrap().summary;
    assert!(matches!(&warnings[..], [warning] if warning.contains("conserved to rounding only")), "{warnings:?}");
    assert!(!summary.ranks.as_ref().unwrap().alike);
    assert_eq!(summary.ranks.as_ref().unwrap().ranks[1].arithmetic, "00000007");
    honest(&summary);
    let longer = Run::resume(&directory, Some(40)).unwrap();
    let summary = longer.execute(&adapter(), &mut |_| {}).unwrap().summary;
    assert!(summary.ranks.is_none());
    honest(&summary);
}

/// That momentum is not said to be kept to the last bit, and no driver blamed.
#[track_caller]
fn honest(summary: &Summary) {
    let (kept, lost, warnings) = (&summary.conserved_exactly, &summary.not_conserved, summary.warnings.join("\n"));
    assert_eq!(kept[..], ["mass"], "{kept:?}");
    assert!(
        lost.iter().any(|lost| lost.starts_with("total momentum: on ranks of several kinds changed by")),
        "{lost:?}"
    );
    assert!(warnings.contains("not all ranks of this run compute alike") && !warnings.contains("defect"), "{warnings}");
}

/// A team whose second rank introduces itself as something else, or panics when it is told to advance.
fn team(arithmetic: u32, panics: bool) -> Result<Team<'static>, EngineError> {
    let scene = scene();
    let (_, state) = start(&scene);
    let engine = move |rank, peers: Peers| {
        let options = Options { part: Some(Part { division: TWO, rank }), ..Options::default() };
        let plan = run::plan(&scene, hardware(), options);
        Engine::of_part(gpu(), plan, Box::new(peers)).unwrap()
    };
    let introduction = |arithmetic| RankReport {
        host: "here".to_owned(),
        adapter: "some".to_owned(),
        adapters: 1,
        arithmetic,
        ..RankReport::default()
    };
    let mut links = threads::links(2).into_iter();
    let (first, second) = (links.next().unwrap(), links.next().unwrap());
    let first_engine = engine(0, first.peers);
    thread::spawn(move || {
        let Links { mut channel, peers } = second;
        let mut engine = engine(1, peers);
        if panics {
            let told = channel.listen().unwrap();
            panic!("after {} bytes, as a test asks", told.len());
        }
        let _ = serve(&mut engine, introduction(arithmetic), &mut channel, &|_| Err("no other numbers".to_owned()));
    });
    Team::new(first_engine, introduction(1), Box::new(first.channel), &state)
}

#[test]
fn ranks_that_introduce_themselves_as_unlike_are_refused_unless_mixed() {
    let alike = team(1, false).unwrap();
    assert!(computes_alike(alike.ranks()));
    alike.check_alike().unwrap();
    let mixed = team(2, false).unwrap();
    assert!(!computes_alike(mixed.ranks()));
    assert_eq!(mixed.ranks()[1].arithmetic, 2);
    let refused = mixed.check_alike().unwrap_err().to_string();
    let expected = "from the same state they get\n  rank 0 on here, some: 00000001\n  rank 1 on here, some: 00000002\n";
    assert!(refused.contains(expected) && refused.contains("`--mixed`"), "{refused}");
}

/// A thread that panics is missed at once.
#[test]
fn a_rank_that_panics_is_told_of() {
    assert_eq!(team(1, true).err().unwrap().to_string(), "rank 1 has ended");
}
