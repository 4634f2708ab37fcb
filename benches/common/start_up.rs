//! The time that a small run takes from its first moment to its last.

use std::process::{Command, Stdio};
use std::time::Instant;

use mesoscope::gpu::Gpu;

use super::statistics::spread;
use crate::Failure;

/// The whole process of a small run: pipelines, 100 steps, tables and pictures.
pub fn in_words(gpu: &Gpu) -> Result<String, Failure> {
    let directory = tempfile::tempdir()?;
    let mut times = Vec::new();
    for _ in 0..6 {
        let begun = Instant::now();
        let status = Command::new(env!("CARGO_BIN_EXE_mesoscope"))
            .args(["run", "dpd-fluid", "--set", "space.box=[5,5,5]", "--set", "output.radial_distribution=null"])
            .args(["--steps", "100", "--set", "time.equilibration=0", "--quiet", "--force"])
            .args(["--adapter", &gpu.description().name])
            .arg("--out")
            .arg(directory.path().join("run"))
            .stdout(Stdio::null())
            .status()?;
        if !status.success() {
            return Err(format!("`mesoscope run` failed: {status}").into());
        }
        times.push(begun.elapsed().as_secs_f64());
    }
    // The first one filled the caches of the driver.
    let warm = &times[1..];
    Ok(format!(
        "A run of 375 particles and 100 steps, with its table and both pictures, whole process: {} s warm ({:.2} s at first).\n",
        spread(warm, 2),
        times[0]
    ))
}
