//! The same flow computed otherwise: storage, splines, solvers, and particles that crowd.

use mesoscope::gpu::Gpu;
use mesoscope::plan::{Hardware, Options, Storage, Traversal};

use crate::Failure;
use crate::common::statistics::{grouped, ratios, spread};
use crate::common::timed::Run;
use crate::common::timing::Turns;
use crate::flow::{Flow, Start};

struct Alternative {
    name: &'static str,
    changes: &'static [&'static str],
    options: fn() -> Options,
    start: Start,
}

const fn scene(name: &'static str, changes: &'static [&'static str]) -> Alternative {
    Alternative { name, changes, options: Options::default, start: Start::Even }
}

const fn planned(name: &'static str, options: fn() -> Options, start: Start) -> Alternative {
    Alternative { name, changes: &[], options, start }
}

fn sorted() -> Options {
    Options { storage: Some(Storage::Sorted), ..Options::default() }
}

fn bins() -> Options {
    Options { storage: Some(Storage::Bins), ..Options::default() }
}

fn cell_by_cell() -> Options {
    Options { traversal: Some(Traversal::Rows), ..Options::default() }
}

fn buffers() -> Options {
    Options { serial_memory: Some(false), ..Options::default() }
}

const ALTERNATIVES: [Alternative; 14] = [
    planned("storage: sorted", sorted, Start::Even),
    planned("storage: bins", bins, Start::Even),
    planned("cell by cell, without subgroups of eight", cell_by_cell, Start::Even),
    planned("buffers where software adapters have textures", buffers, Start::Even),
    scene("splines of order 1", &["interactions[0].spline_order=1"]),
    scene("splines of order 2", &["interactions[0].spline_order=2"]),
    scene("spectral symbol", &[r#"interactions[0].smoothing.solver={"type":"fft","symbol":"spectral"}"#]),
    scene("`chebyshev` to 1e-1", &[r#"interactions[0].smoothing.solver={"type":"chebyshev","tolerance":1e-1}"#]),
    scene("`chebyshev` to 1e-2", &[r#"interactions[0].smoothing.solver={"type":"chebyshev","tolerance":1e-2}"#]),
    scene("`chebyshev` to 1e-3", &[r#"interactions[0].smoothing.solver={"type":"chebyshev","tolerance":1e-3}"#]),
    scene("`chebyshev` to 1e-6", &[r#"interactions[0].smoothing.solver={"type":"chebyshev","tolerance":1e-6}"#]),
    scene("no smoothing", &["interactions[0].smoothing.length=0"]),
    planned("half of all particles in 1/16 of the cells, sorted", sorted, Start::Clustered),
    planned("half of all particles in 1/16 of the cells, bins", bins, Start::Clustered),
];

/// Bytes of the largest buffer in any alternative for a size.
pub fn largest_buffer(size: crate::flow::Size) -> Result<u64, Failure> {
    let mut largest = 0;
    for alternative in &ALTERNATIVES {
        largest = largest.max(
            crate::flow::plan_of(size, alternative.changes, Hardware::default(), (alternative.options)())?
                .largest_buffer(),
        );
    }
    Ok(largest)
}

pub fn compare(gpu: &Gpu, flows: &[Flow], rounds: Turns) -> Result<(), Failure> {
    println!(
        "\n### Alternatives\n\nMedian (least–most) of rounds in which the default and the alternative take turns; default: \
         splines of order 3, `fft` with the five-point symbol, particles on a lattice."
    );
    for flow in flows {
        println!("\nMesh {}², {} particles.\n", flow.size.mesh, grouped(flow.size.particles));
        println!("| alternative | ms a step | × default |");
        println!("|:--|--:|--:|");
        let mut default = flow.run(gpu, &[], Options::default(), Start::Even)?;
        let mut all = Vec::new();
        let mut rows = Vec::new();
        for alternative in &ALTERNATIVES {
            let (row, mut times) = match turns(gpu, flow, alternative, &mut default, rounds) {
                Ok([own, reference]) => {
                    (format!("{} | {}", spread(&own, 2), spread(&ratios(&own, &reference), 2)), reference)
                }
                Err(reason) => (format!("{reason} | –"), Vec::new()),
            };
            rows.push(format!("| {} | {row} |", alternative.name));
            all.append(&mut times);
        }
        println!("| default | {} | 1 |", spread(&all, 2));
        for row in rows {
            println!("{row}");
        }
    }
    Ok(())
}

/// Milliseconds a step of the alternative and of the default, round by round.
fn turns<'a>(
    gpu: &'a Gpu,
    flow: &Flow,
    alternative: &Alternative,
    default: &mut Run<'a>,
    rounds: Turns,
) -> Result<[Vec<f64>; 2], Failure> {
    let mut run = flow.run(gpu, alternative.changes, (alternative.options)(), alternative.start)?;
    let rates = rounds.rates(&mut [&mut run, default])?;
    Ok([0, 1].map(|place: usize| rates[place].iter().map(|rate| flow.milliseconds(*rate)).collect()))
}
