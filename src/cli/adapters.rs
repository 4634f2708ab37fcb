//! `mesoscope adapters`: what this machine can run on, and whether it computes as it should.

use mesoscope::gpu::{AdapterChoice, AdapterDescription, Gpu, GpuError, Requirements, list_adapters, unseen_card};
use mesoscope::self_test::{self, Finding, Verdict};

use super::table::{aligned, labelled};
use super::{AdapterArgument, Failure, print};

/// List the adapters of this machine, the best first, or check one
#[derive(Debug, clap::Args)]
#[command(after_help = "\
Examples:
  mesoscope adapters
  mesoscope adapters --check                   whether the best adapter computes as it should, in ten seconds
  mesoscope adapters --check --adapter nvidia  the same for another adapter; paste the output into a bug report
  mesoscope run dpd-fluid --adapter 1          by number
  mesoscope run dpd-fluid --adapter nvidia     by part of the name")]
pub struct Arguments {
    /// Check an adapter: its arithmetic, a step of every family of models against the reference, its speed
    #[arg(long)]
    check: bool,
    #[command(flatten)]
    adapter: AdapterArgument,
}

/// Lists the adapters, or checks one.
pub fn execute(arguments: &Arguments) -> Result<(), Failure> {
    match (arguments.check, arguments.adapter.choice()) {
        (true, choice) => check(&choice),
        (false, AdapterChoice::Best) => list(),
        (false, _) => Err(Failure::usage("--adapter says which adapter to check; add --check, or leave it out")),
    }
}

fn list() -> Result<(), Failure> {
    let adapters = list_adapters();
    if adapters.is_empty() {
        return Err(GpuError::NoAdapter.into());
    }
    let header = ["", "NAME", "KIND", "BACKEND", "DRIVER"].map(str::to_owned).to_vec();
    let row = |(number, adapter): (usize, AdapterDescription)| {
        vec![number.to_string(), adapter.name, adapter.kind.name().to_owned(), adapter.backend, adapter.driver]
    };
    let warning = unseen_card(&adapters[0], &AdapterChoice::Best);
    let rows: Vec<Vec<String>> = std::iter::once(header).chain(adapters.into_iter().enumerate().map(row)).collect();
    print(&aligned(&rows, ""))?;
    if let Some(warning) = warning {
        super::line(&format!("warning: {warning}"));
    }
    Ok(())
}

/// Checks an adapter, and prints every finding as soon as there is one.
fn check(choice: &AdapterChoice) -> Result<(), Failure> {
    let gpu = Gpu::open(choice, Requirements::default())?;
    let AdapterDescription { name, kind, backend, driver } = gpu.description();
    let subgroups = gpu.subgroup_size().map_or("not used".to_owned(), |size| format!("of {size} lanes"));
    let memory = if gpu.serial_memory() { "lane by lane" } else { "usual" };
    let head = [
        ("mesoscope", env!("CARGO_PKG_VERSION").to_owned()),
        ("system", system()),
        ("adapter", format!("{name} ({}, {backend})", kind.name())),
        ("driver", driver.clone()),
        ("subgroups", format!("{subgroups}; memory {memory}")),
        ("takes", "some ten seconds, on a busy software adapter a minute".to_owned()),
    ];
    print(&format!("{}\n", labelled(head, "")))?;
    let mut counts = [0_usize; 2];
    let mut printed = Ok(());
    self_test::run(&gpu, &mut |finding| {
        match finding.verdict {
            Verdict::Passed => counts[0] += 1,
            Verdict::Failed => counts[1] += 1,
            Verdict::Noted => {}
        }
        if printed.is_ok() {
            printed = print(&line(&finding));
        }
    })?;
    printed?;
    gpu.health()?;
    let [passed, failed] = counts;
    print(&format!("\n{passed} checks passed, {failed} failed\n"))?;
    conclusion(name, failed)
}

/// An adapter that fails a check should not be used.
fn conclusion(name: &str, failed: usize) -> Result<(), Failure> {
    match failed {
        0 => Ok(()),
        _ => Err(Failure::no_adapter(format!(
            "results on the adapter `{name}` cannot be relied on; please report this with all of the above"
        ))),
    }
}

fn line(finding: &Finding) -> String {
    let verdict = match finding.verdict {
        Verdict::Passed => "ok    ",
        Verdict::Failed => "FAILED",
        Verdict::Noted => "      ",
    };
    format!("{verdict}  {:44}{}\n", finding.check, finding.found)
}

/// The operating system as it calls itself, where it does, and the processor's architecture.
fn system() -> String {
    let release = std::fs::read_to_string("/etc/os-release").unwrap_or_default();
    let name = release.lines().find_map(|line| line.strip_prefix("PRETTY_NAME="));
    let name = name.map_or(std::env::consts::OS, |name| name.trim_matches('"'));
    format!("{name}, {}", std::env::consts::ARCH)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_failed_check_fails_the_command() {
        assert!(conclusion("abacus", 0).is_ok());
        let failure = conclusion("abacus", 1).err().map(|failure| (failure.exit_code(), failure.to_string()));
        assert!(failure.is_some_and(|(code, message)| code == 3 && message.contains("`abacus` cannot be relied on")));
        let finding = |verdict| Finding { check: "sums".to_owned(), verdict, found: "wrong".to_owned() };
        assert!(line(&finding(Verdict::Failed)).starts_with("FAILED  sums "));
        assert!(line(&finding(Verdict::Passed)).starts_with("ok      sums "));
    }
}
