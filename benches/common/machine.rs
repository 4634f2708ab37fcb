//! What the numbers were measured on.

use std::process::Command;
use std::time::{Duration, SystemTime, UNIX_EPOCH};

use mesoscope::gpu::AdapterDescription;

/// A list of what a reader needs to judge the numbers, with a line about what is measured for comparison.
pub fn describe(adapter: &AdapterDescription, peer: &str) -> String {
    let cores = std::thread::available_parallelism().map_or(1, usize::from);
    let mut lines = vec![
        format!("- date: {}", date()),
        format!(
            "- adapter: {} ({}, {}), driver {}",
            adapter.name,
            adapter.kind.name(),
            adapter.backend,
            adapter.driver
        ),
        format!("- processor: {}, {cores} cores, {}", processor(), widest_vectors()),
    ];
    let version = env!("CARGO_PKG_VERSION");
    lines.push(format!("- mesoscope {version}, wgpu {}, {}", locked("wgpu"), compiler()));
    lines.push(format!("- {peer}"));
    lines.join("\n")
}

/// How much of the processor others use while the benchmark waits for a second, in words, where the system tells.
pub fn others() -> Option<String> {
    let before = processor_time()?;
    std::thread::sleep(Duration::from_secs(1));
    let after = processor_time()?;
    let share = 100.0 * (1.0 - (after.0 - before.0) / (after.1 - before.1));
    let warning = if share > 5.0 { ": **busy, do not trust the numbers**" } else { "" };
    Some(format!("{share:.0} % of the processor{warning}"))
}

/// Idle time and all time of all cores since the system started, in its own units.
fn processor_time() -> Option<(f64, f64)> {
    let text = std::fs::read_to_string("/proc/stat").ok()?;
    let times: Vec<f64> =
        text.lines().next()?.split_whitespace().skip(1).take(8).filter_map(|time| time.parse().ok()).collect();
    // User, nice, system, idle, waiting for disks, and more.
    Some((times.get(3)? + times.get(4)?, times.iter().sum()))
}

fn processor() -> String {
    let known = std::fs::read_to_string("/proc/cpuinfo").ok().and_then(|text| {
        let line = text.lines().find(|line| line.starts_with("model name"))?;
        Some(line.split_once(':')?.1.trim().to_owned())
    });
    known
        .or_else(|| answer("sysctl", &["-n", "machdep.cpu.brand_string"]))
        .unwrap_or_else(|| std::env::consts::ARCH.to_owned())
}

/// The widest vectors that a software adapter may compile for: they decide what it costs to put them together.
#[cfg(target_arch = "x86_64")]
fn widest_vectors() -> &'static str {
    match (std::is_x86_feature_detected!("avx512f"), std::is_x86_feature_detected!("avx2")) {
        (true, _) => "AVX-512",
        (false, true) => "AVX2",
        (false, false) => "neither AVX2 nor AVX-512",
    }
}

#[cfg(not(target_arch = "x86_64"))]
fn widest_vectors() -> &'static str {
    std::env::consts::ARCH
}

fn compiler() -> String {
    answer("rustc", &["--version"]).unwrap_or_else(|| "rustc unknown".to_owned())
}

fn answer(program: &str, arguments: &[&str]) -> Option<String> {
    let output = Command::new(program).args(arguments).output().ok()?;
    let text = String::from_utf8(output.stdout).ok()?.trim().to_owned();
    (output.status.success() && !text.is_empty()).then_some(text)
}

/// The version of a dependency in Cargo.lock.
fn locked(package: &str) -> &'static str {
    let lock = include_str!("../../Cargo.lock");
    lock.split_once(&format!("name = \"{package}\"\nversion = \""))
        .and_then(|(_, rest)| rest.split_once('"'))
        .map_or("unknown", |(version, _)| version)
}

/// Today in UTC, year-month-day.
fn date() -> String {
    let mut days = SystemTime::now().duration_since(UNIX_EPOCH).map_or(0, |elapsed| elapsed.as_secs() / 86_400);
    let leap = |year: u64| year.is_multiple_of(4) && !year.is_multiple_of(100) || year.is_multiple_of(400);
    let mut year = 1970;
    while days >= 365 + u64::from(leap(year)) {
        days -= 365 + u64::from(leap(year));
        year += 1;
    }
    let mut month = 1;
    for length in [31, 28 + u64::from(leap(year)), 31, 30, 31, 30, 31, 31, 30, 31, 30, 31] {
        if days < length {
            break;
        }
        days -= length;
        month += 1;
    }
    format!("{year}-{month:02}-{:02}", days + 1)
}
