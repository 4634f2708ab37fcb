//! How long to measure: options of every benchmark, and runs that take turns.

use super::Failure;
use super::timed::Run;

/// Options of every benchmark.
#[derive(Debug, clap::Args)]
pub struct Timing {
    /// Short and rough: three rounds of a tenth of a second, which prove nothing
    #[arg(long, conflicts_with_all = ["rounds", "seconds"])]
    pub quick: bool,
    /// Rounds [default: 5 to 11, as the benchmark needs]
    #[arg(long)]
    rounds: Option<usize>,
    /// Seconds of each measurement on the device [default: .4 to 1]
    #[arg(long)]
    seconds: Option<f64>,
    /// Passed by cargo
    #[arg(long, hide = true)]
    bench: bool,
}

/// Rounds in which all that is compared takes turns.
#[derive(Debug, Clone, Copy)]
pub struct Turns {
    /// Their number.
    pub rounds: usize,
    /// Seconds of a turn.
    pub seconds: f64,
}

impl Timing {
    /// What was asked for, or else these rounds of so many seconds.
    pub fn or(&self, rounds: usize, seconds: f64) -> Turns {
        let usual = if self.quick { Turns { rounds: 3, seconds: 0.1 } } else { Turns { rounds, seconds } };
        Turns { rounds: self.rounds.unwrap_or(usual.rounds), seconds: self.seconds.unwrap_or(usual.seconds) }
    }
}

impl Turns {
    /// The same in no more than so many rounds.
    pub fn at_most(self, rounds: usize) -> Self {
        Self { rounds: self.rounds.min(rounds), ..self }
    }

    /// The same with shorter turns.
    pub fn half(self) -> Self {
        Self { seconds: 0.5 * self.seconds, ..self }
    }

    /// Particle-steps a second of each run, round by round.
    pub fn rates(self, runs: &mut [&mut Run<'_>]) -> Result<Vec<Vec<f64>>, Failure> {
        let mut rates = vec![Vec::new(); runs.len()];
        for _ in 0..self.rounds {
            for (run, rates) in runs.iter_mut().zip(&mut rates) {
                rates.push(run.rate(self.seconds)?);
            }
        }
        Ok(rates)
    }
}
