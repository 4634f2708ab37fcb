//! Processes started by `mpirun` that share a run: the bytes of one, and an end for everything that goes wrong. With
//! `make test-mpi`, which installs an MPI library where there is none.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

use std::fs;
use std::io::Write as _;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Output, Stdio};
use std::sync::{Mutex, MutexGuard, PoisonError};
use std::thread;
use std::time::{Duration, Instant};

use mesoscope::output::{Summary, files};
use rand::{RngExt as _, SeedableRng as _, rngs::StdRng};
use tempfile::TempDir;

/// Seconds until a rank counts as lost, where one is stopped: more than a loaded machine takes for any step, file or picture.
const PATIENCE: u64 = 10;
/// Everything has to have ended by then: the patience twice, the turns of all ranks, and what a loaded machine needs.
const END: Duration = Duration::from_secs(90);
/// Faults of each kind.
const FAULTS: usize = 10;
/// What a run leaves that has to be the same.
const FILES: [&str; 4] = ["energies.csv", "checkpoint.bin", "snapshot.png", "radial_distribution.csv"];

/// Processes of a launcher that wait keep a core each busy: one test at a time.
fn alone() -> MutexGuard<'static, ()> {
    static TURN: Mutex<()> = Mutex::new(());
    TURN.lock().unwrap_or_else(PoisonError::into_inner)
}

/// A run of some scene in a directory of its own.
struct Run {
    place: TempDir,
    arguments: Vec<String>,
}

impl Run {
    fn of(steps: u64, more: &[&str]) -> Self {
        let place = tempfile::tempdir().unwrap();
        let steps = steps.to_string();
        let fixed = ["run", "dpd-fluid", "--steps", &steps, "--set", "space.box=[8.5,8.5,8.5]", "--quiet"];
        let output = r#"output={"energies":{"every":3},"radial_distribution":{"every":10,"range":1.5},"checkpoint":{"every":20}}"#;
        let set = ["--set", "time.equilibration=0", "--set", output];
        let arguments = [&fixed[..], &set, more].concat().into_iter().map(str::to_owned).collect();
        Self { place, arguments }
    }

    fn directory(&self, name: &str) -> PathBuf {
        self.place.path().join(name)
    }

    fn command(&self, ranks: u32, name: &str) -> Command {
        let mut command = launcher(ranks);
        command.arg(env!("CARGO_BIN_EXE_mesoscope")).args(&self.arguments).arg("--out").arg(self.directory(name));
        command
    }

    /// Resumes without a launcher, and compares what is there at the end with an undisturbed run.
    #[track_caller]
    fn resumes_like(&self, name: &str, undisturbed: &str) {
        self.resumes_by(Command::new(env!("CARGO_BIN_EXE_mesoscope")), name, undisturbed);
    }

    #[track_caller]
    fn resumes_by(&self, mut program: Command, name: &str, undisturbed: &str) {
        let directory = self.directory(name);
        assert!(directory.join("checkpoint.bin").exists(), "no checkpoint");
        let ended = program.arg("resume").arg(&directory).output().unwrap();
        assert!(ended.status.success(), "{}", said(&ended));
        self.same(name, undisturbed);
    }

    #[track_caller]
    fn same(&self, one: &str, other: &str) {
        self.same_files(&FILES, one, other);
    }

    #[track_caller]
    fn same_files(&self, files: &[&str], one: &str, other: &str) {
        for file in files {
            let [one, other] = [one, other].map(|name| fs::read(self.directory(name).join(file)).unwrap());
            assert!(!one.is_empty() && one == other, "{file}");
        }
    }
}

fn launcher(ranks: u32) -> Command {
    let mut command = Command::new("mpirun");
    command.args(["--allow-run-as-root", "--oversubscribe", "-n", &ranks.to_string()]);
    command.stdout(Stdio::piped()).stderr(Stdio::piped());
    command
}

/// The same with less patience.
fn impatient(mut command: Command) -> Command {
    command.env("MESOSCOPE_PATIENCE", PATIENCE.to_string());
    command
}

fn said(output: &Output) -> String {
    format!("{}{}", String::from_utf8_lossy(&output.stdout), String::from_utf8_lossy(&output.stderr))
}

/// The process of a rank whose arguments name a directory.
fn rank(directory: &Path, number: usize) -> Option<u32> {
    let variable = format!("OMPI_COMM_WORLD_RANK={number}");
    let processes = fs::read_dir("/proc").unwrap().flatten().filter_map(|entry| {
        let id: u32 = entry.file_name().to_str()?.parse().ok()?;
        let holds = |file: &str, wanted: &[u8]| {
            fs::read(entry.path().join(file))
                .is_ok_and(|bytes| bytes.split(|byte| *byte == 0).any(|word| word == wanted))
        };
        let found = holds("cmdline", directory.as_os_str().as_encoded_bytes()) && holds("environ", variable.as_bytes());
        found.then_some(id)
    });
    processes.max()
}

/// How often a run says that something is wrong.
fn errors(output: &Output) -> usize {
    said(output).matches("error: ").count()
}

fn signal(kind: &str, process: u32) {
    assert!(Command::new("kill").args([kind, &process.to_string()]).status().unwrap().success());
}

/// Waits for the end of all ranks, of which nothing may remain.
#[track_caller]
fn ends(mut child: Child, directory: &Path) -> Output {
    let begun = Instant::now();
    while child.try_wait().unwrap().is_none() {
        assert!(begun.elapsed() < END, "some rank hangs");
        thread::sleep(Duration::from_millis(20));
    }
    let output = child.wait_with_output().unwrap();
    thread::sleep(Duration::from_millis(200));
    let left: Vec<u32> = (0..8).filter_map(|number| rank(directory, number)).collect();
    assert!(left.is_empty(), "processes remain: {left:?}");
    output
}

/// Waits until a run has a checkpoint, and a moment more.
#[track_caller]
fn under_way(run: &Run, name: &str, child: &mut Child, moment: Duration) {
    let begun = Instant::now();
    while !run.directory(name).join("checkpoint.bin").exists() {
        assert!(begun.elapsed() < END && child.try_wait().unwrap().is_none(), "no checkpoint");
        thread::sleep(Duration::from_millis(5));
    }
    thread::sleep(moment);
}

#[test]
fn processes_leave_the_bytes_of_one() {
    let _turn = alone();
    for integrator in ["splitting", "groot-warren", "cotter-reich"] {
        let run = Run::of(60, &["--set", &format!("integrator.type={integrator}")]);
        for ranks in [1, 2, 4, 8] {
            let name = format!("ranks-{ranks}");
            let output = run.command(ranks, &name).output().unwrap();
            assert!(output.status.success(), "{}", said(&output));
            run.same("ranks-1", &name);
        }
    }
}

/// Shallow water, whose ranks all exchange with each other, twice a step.
#[test]
fn processes_share_water() {
    let _turn = alone();
    for bath in ["null", r#"{"type":"memory","epsilon":1}"#] {
        let output = r#"output={"energies":{"every":3},"fields":{"quantities":["depth"]},"checkpoint":{"every":20}}"#;
        let bath = format!("interactions.0.bath={bath}");
        let set = ["temperature=1e-3", "interactions.0.mesh=[32,32]", "particles.0.count=16384", &bath, output];
        let set = set.iter().flat_map(|change| ["--set", change]);
        let arguments = ["run", "shallow-water", "--steps", "50", "--quiet"].into_iter().chain(set);
        let run = Run { place: tempfile::tempdir().unwrap(), arguments: arguments.map(str::to_owned).collect() };
        for ranks in [1, 2, 3, 4] {
            let name = format!("ranks-{ranks}");
            let output = run.command(ranks, &name).output().unwrap();
            assert!(output.status.success(), "{}", said(&output));
            run.same_files(&["energies.csv", "checkpoint.bin", "depth.png"], "ranks-1", &name);
        }
    }
}

/// Bonds that are longer than expected let all processes go back for wider halos.
#[test]
fn bonded_processes_leave_the_bytes_of_one() {
    let _turn = alone();
    let chains = r#"particles=[{"species":"A","count":1200,"chain":{"beads":10,"spacing":1.9}}]"#;
    let forces = r#"interactions=[{"type":"dpd","repulsion":25,"friction":4.5},{"type":"angles","stiffness":2},
        {"type":"bonds","potential":{"type":"harmonic","stiffness":900,"length":0.5}}]"#;
    let run =
        Run::of(60, &["--set", chains, "--set", forces, "--set", "time.step=0.002", "--set", "space.box=[5,5,18]"]);
    for ranks in [1, 2, 4] {
        let name = format!("ranks-{ranks}");
        let output = run.command(ranks, &name).output().unwrap();
        assert!(output.status.success(), "{}", said(&output));
        let summary = Summary::load(&run.directory(&name).join("run.json")).unwrap();
        assert!(summary.ranks.is_none_or(|shared| shared.halo > 3.0));
        run.same("ranks-1", &name);
    }
}

#[test]
fn what_cannot_be_shared_is_told_once() {
    let _turn = alone();
    for (more, ranks, code, expected) in [
        (&["--ranks", "1,2,2"][..], 3, 2, "`--ranks` asks for 4 ranks, and the launcher has started 3 copies"),
        (&["--set", r#"output.stress={"every":10}"#], 2, 2, "`stress` in output.stress: on one rank only"),
        (&["--set", "time.stop=1"], 2, 2, "unknown key"),
        (&[], 7, 2, "4 ranks fit"),
        (&["--adapter", "nothing of this name"], 2, 3, "nothing of this name"),
        // In one pass over pairs, whose halo leaves four parts of the box.
        (&["--set", "time.step=0.16", "--set", "integrator.type=groot-warren"], 4, 4, "unstable"),
    ] {
        let run = Run::of(200, more);
        let output = ends(run.command(ranks, "out").spawn().unwrap(), &run.directory("out"));
        assert_eq!(output.status.code(), Some(code), "{}", said(&output));
        assert_eq!(errors(&output), 1, "{}", said(&output));
        assert!(said(&output).contains(expected), "{}", said(&output));
    }
}

/// A rank without an adapter: one message, and nothing of an earlier run is lost, though it might be replaced.
#[test]
fn a_rank_without_an_adapter_ends_all() {
    let _turn = alone();
    let run = Run::of(200, &["--force"]);
    let earlier = run.command(1, "out").output().unwrap();
    assert!(earlier.status.success(), "{}", said(&earlier));
    let mut command = launcher(1);
    let program = env!("CARGO_BIN_EXE_mesoscope");
    let directory = run.directory("out");
    let files = || -> Vec<(PathBuf, Vec<u8>)> {
        let paths = fs::read_dir(&directory).unwrap().map(|entry| entry.unwrap().path());
        paths.map(|path| (path.clone(), fs::read(path).unwrap())).collect()
    };
    let before = files();
    command.arg(program).args(&run.arguments).arg("--out").arg(&directory);
    command.args([
        ":",
        "-n",
        "1",
        "-x",
        "VK_DRIVER_FILES=/nonexistent.json",
        "-x",
        "VK_ICD_FILENAMES=/nonexistent.json",
    ]);
    command.arg(program).args(&run.arguments).arg("--out").arg(&directory);
    let output = ends(command.spawn().unwrap(), &directory);
    assert_eq!(output.status.code(), Some(3), "{}", said(&output));
    assert!(said(&output).contains("rank 1: ") && errors(&output) == 1, "{}", said(&output));
    assert!(before.len() > 4 && files() == before, "the earlier run is not what it was");
}

/// More ranks than adapters on a machine: a warning, once.
#[test]
fn ranks_that_share_an_adapter_are_told_of() {
    let _turn = alone();
    let mut run = Run::of(20, &["--adapter", "0"]);
    run.arguments.retain(|argument| argument != "--quiet");
    let output = run.command(2, "out").output().unwrap();
    assert!(output.status.success(), "{}", said(&output));
    let host = fs::read_to_string("/proc/sys/kernel/hostname").unwrap();
    let expected = format!("warning: 2 ranks share 1 adapter of {}: they take turns on it", host.trim());
    let warnings = said(&output).matches(&expected).count();
    assert_eq!(warnings, 1, "{}", said(&output));
}

/// A rank that panics ends all, with its message and its code, whichever it is.
#[test]
fn a_panic_of_a_rank_ends_all() {
    let _turn = alone();
    let run = Run::of(200, &[]);
    for panicking in [0, 2] {
        let mut command = run.command(3, "out");
        command.env("MESOSCOPE_TEST_PANIC", panicking.to_string());
        let output = ends(command.spawn().unwrap(), &run.directory("out"));
        assert_eq!(output.status.code(), Some(101), "{}", said(&output));
        assert_eq!(said(&output).matches("asked to panic").count(), 1, "{}", said(&output));
        assert_eq!(errors(&output), 0, "{}", said(&output));
    }
}

/// The first rank stops while it writes a checkpoint, and nobody waits for a command of its.
#[test]
#[ignore = "minutes"]
fn a_first_rank_that_stops_while_it_writes_ends_all() {
    let _turn = alone();
    let run = Run::of(100_000, &["--set", "output.checkpoint.every=1"]);
    let directory = run.directory("out");
    let mut child = impatient(run.command(4, "out")).spawn().unwrap();
    under_way(&run, "out", &mut child, Duration::ZERO);
    let first = rank(&directory, 0).unwrap();
    let begun = Instant::now();
    // What it writes has another name until it is complete.
    while !is_writing(&directory) {
        signal("-CONT", first);
        assert!(begun.elapsed() < END, "nothing is written");
        thread::sleep(Duration::from_micros(300));
        signal("-STOP", first);
    }
    let output = ends(child, &directory);
    assert_eq!(output.status.code(), Some(3), "{}", said(&output));
    assert!(said(&output).contains(&format!("rank 0 has not answered for {PATIENCE} s")), "{}", said(&output));
    assert_eq!(errors(&output), 1, "{}", said(&output));
    let mut resume = Command::new(env!("CARGO_BIN_EXE_mesoscope"));
    let resumed = resume.arg("resume").arg(&directory).args(["--steps", "1"]).output().unwrap();
    assert!(resumed.status.success(), "{}", said(&resumed));
}

/// Whether a process, which is stopped, has not finished writing a file.
fn is_writing(directory: &Path) -> bool {
    let names = fs::read_dir(directory).unwrap().map(|entry| entry.unwrap().file_name());
    names.filter_map(|name| name.into_string().ok()).any(|name| files::of_temporary(&name).is_some())
}

/// Four processes whose launcher gets a signal once there is a checkpoint: the name of their directory, and what they leave.
fn told_under_way<'k>(run: &Run, kind: &'k str) -> (&'k str, Output) {
    let name = kind.trim_start_matches('-');
    let mut child = run.command(4, name).spawn().unwrap();
    under_way(run, name, &mut child, Duration::from_millis(100));
    signal(kind, child.id());
    (name, ends(child, &run.directory(name)))
}

/// What a launcher leaves when it is interrupted can be resumed, also by processes.
#[test]
#[ignore = "minutes"]
fn an_interrupted_launcher_leaves_a_checkpoint() {
    let _turn = alone();
    let run = Run::of(3000, &[]);
    assert!(run.command(1, "undisturbed").output().unwrap().status.success());
    for kind in ["-INT", "-TERM"] {
        let (name, output) = told_under_way(&run, kind);
        assert!(!output.status.success(), "{}", said(&output));
        // Whatever a process had written beyond its checkpoint.
        let table = fs::OpenOptions::new().append(true).open(run.directory(name).join("energies.csv"));
        table.unwrap().write_all(b"2997,1,2,3\n2999,1").unwrap();
        let mut processes = launcher(2);
        processes.arg(env!("CARGO_BIN_EXE_mesoscope"));
        run.resumes_by(processes, name, "undisturbed");
    }
}

/// The disk of the first rank is full, once tables have room and pictures have not: files of more than 12 KiB are refused (24 blocks of 512 bytes). What others do is
/// to no avail, and everything ends.
#[test]
fn a_full_disk_of_the_first_rank_ends_all_and_the_run_resumes() {
    let _turn = alone();
    let run = Run::of(60, &["--set", "space.box=[4,4,16]", "--set", "particles.0.number_density=0.75"]);
    assert!(run.command(1, "undisturbed").output().unwrap().status.success());
    let program = env!("CARGO_BIN_EXE_mesoscope");
    let mut command = launcher(1);
    // Memory that processes share is made of files, too, and is not what is tried here.
    command.args(["--mca", "btl", "tcp,self"]);
    command.args(["sh", "-c", r#"trap '' XFSZ; ulimit -f 24; exec "$@""#, "sh", program]);
    command.args(&run.arguments).arg("--out").arg(run.directory("full"));
    command.args([":", "-n", "1", program]).args(&run.arguments).arg("--out").arg(run.directory("full"));
    let output = ends(command.spawn().unwrap(), &run.directory("full"));
    assert_eq!(output.status.code(), Some(5), "{}", said(&output));
    assert!(said(&output).contains("File too large") && errors(&output) == 1, "{}", said(&output));
    run.resumes_like("full", "undisturbed");
}

/// Some rank is killed or stopped at some moment.
#[test]
#[ignore = "minutes"]
fn the_loss_of_a_rank_ends_all_and_the_run_resumes() {
    let _turn = alone();
    let run = Run::of(3000, &[]);
    let undisturbed = run.command(1, "undisturbed").output().unwrap();
    assert!(undisturbed.status.success(), "{}", said(&undisturbed));
    let mut random = StdRng::seed_from_u64(11);
    for number in 0..2 * FAULTS {
        let kind = ["-KILL", "-STOP"][number % 2];
        let name = format!("fault-{number}");
        let directory = run.directory(&name);
        let mut child = impatient(run.command(4, &name)).spawn().unwrap();
        under_way(&run, &name, &mut child, Duration::from_millis(random.random_range(0..600)));
        let lost = random.random_range(0..4);
        if let Some(process) = rank(&directory, lost) {
            signal(kind, process);
        }
        let output = ends(child, &directory);
        // Of what is killed the launcher tells, as of any program.
        let (code, errors_told, told) = match kind {
            "-STOP" => (3, 1, format!("rank {lost} has not answered for {PATIENCE} s")),
            _ => (137, 0, "exited on signal 9".to_owned()),
        };
        assert_eq!(output.status.code(), Some(code), "{kind} {lost}: {}", said(&output));
        assert_eq!(errors(&output), errors_told, "{kind} {lost}: {}", said(&output));
        assert_eq!(said(&output).matches(&told).count(), 1, "{kind} {lost}: {}", said(&output));
        run.resumes_like(&name, "undisturbed");
        fs::remove_dir_all(&directory).unwrap();
    }
}

/// The warning of a batch system saves and stops, as it does for one process.
#[test]
#[ignore = "minutes"]
fn warnings_before_the_end_of_a_job_save_and_stop() {
    let _turn = alone();
    let run = Run::of(3000, &[]);
    assert!(run.command(1, "undisturbed").output().unwrap().status.success());
    for warning in ["-USR1", "-USR2"] {
        let (name, output) = told_under_way(&run, warning);
        assert_eq!(output.status.code(), Some(130), "{}", said(&output));
        assert!(said(&output).contains("interrupted at step"), "{}", said(&output));
        run.resumes_like(name, "undisturbed");
    }
}
