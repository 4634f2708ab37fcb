//! What an adapter and its driver do to the arithmetic that results rest on: a few seconds of checks for a machine nobody has
//! tried, and what to paste into a report if one fails.

mod arithmetic;
mod compute;
mod families;
mod functions;
mod random;
mod speed;

use crate::gpu::{Gpu, GpuError};

pub use families::distances_from_reference;
pub use functions::{Function, FunctionError, errors_of_functions};

/// How a check ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Verdict {
    /// As it should be.
    Passed,
    /// Results on this adapter cannot be relied on.
    Failed,
    /// Neither right nor wrong: what this driver does where it is free to.
    Noted,
}

/// What a check has found.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Finding {
    /// What was checked.
    pub check: String,
    /// How it ended.
    pub verdict: Verdict,
    /// What was found, in words and numbers.
    pub found: String,
}

impl Finding {
    fn new(check: impl Into<String>, passed: bool, found: impl Into<String>) -> Self {
        let verdict = if passed { Verdict::Passed } else { Verdict::Failed };
        Self { check: check.into(), verdict, found: found.into() }
    }

    fn noted(check: impl Into<String>, found: impl Into<String>) -> Self {
        Self { check: check.into(), verdict: Verdict::Noted, found: found.into() }
    }
}

/// Checks an adapter, and hands over what each check has found as soon as it is known: the functions of its arithmetic, whether
/// mirrored expressions come out alike, one step of every family of models against the reference in double precision with the
/// sums that must not change, and the speed of the standard fluid. Takes about ten seconds on two cores. A check that needs more than
/// `gpu` was opened with opens the adapter again; where it does not allow that, the finding is noted as not possible.
///
/// ```no_run
/// use mesoscope::gpu::{AdapterChoice, Gpu, Requirements};
/// use mesoscope::self_test::{self, Verdict};
///
/// let gpu = Gpu::open(&AdapterChoice::Best, Requirements::default())?;
/// let mut failed = 0;
/// self_test::run(&gpu, &mut |finding| failed += usize::from(finding.verdict == Verdict::Failed))?;
/// assert_eq!(failed, 0);
/// # Ok::<(), mesoscope::gpu::GpuError>(())
/// ```
///
/// # Errors
/// [`GpuError`] if the adapter refuses the kernels of the arithmetic; whatever fails in a simulation is a finding.
pub fn run(gpu: &Gpu, report: &mut dyn FnMut(Finding)) -> Result<(), GpuError> {
    for error in errors_of_functions(gpu)? {
        report(error.finding());
    }
    let (contraction, contracts) = arithmetic::contraction(gpu)?;
    report(contraction);
    families::check(gpu, contracts, report);
    report(speed::of_the_standard_fluid(gpu));
    Ok(())
}
