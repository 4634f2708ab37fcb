//! What each of several ranks that share a scene has to do.

use mesoscope::families::Model;
use mesoscope::numbers::{bytes, grouped};
use mesoscope::plan::Division;
use mesoscope::run::{Share, share_of};
use mesoscope::scene::Scene;

/// The rows of the overview.
pub fn rows(scene: &Scene, model: &Model, division: Division) -> Vec<(&'static str, String)> {
    let dimension = scene.space.lengths.len();
    let Share { lengths, halo, own, copies, peers, bytes: sent, most } = share_of(scene, model, division);
    let product = |numbers: Vec<String>| numbers[..dimension].join(" × ");
    let parts = product(division.parts.map(|part| part.to_string()).to_vec());
    let brief = |length: f64| format!("{length:.4}").trim_end_matches('0').trim_end_matches('.').to_owned();
    let lengths = product(lengths.map(brief).to_vec());
    let halo = brief(halo);
    let count = division.ranks();
    vec![
        (
            "ranks",
            format!("{} ({parts}), each {lengths} with {halo} around it; at most {most} fit", grouped(count.into())),
        ),
        (
            "copies",
            format!(
                "a rank advances about {} particles of its own and {} copies of others: {:.0} % of its work is its own",
                grouped(own as u64),
                grouped(copies as u64),
                100.0 * own / (own + copies).max(1.0)
            ),
        ),
        (
            "exchange",
            format!(
                "about {} a step and rank, with {peers} {}",
                bytes(sent as u64),
                if peers == 1 { "peer" } else { "peers" }
            ),
        ),
    ]
}
