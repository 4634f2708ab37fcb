//! What each of several ranks that share a scene has to do.

use mesoscope::families::Model;
use mesoscope::numbers::{bytes, grouped};
use mesoscope::plan::Division;
use mesoscope::run::share_of;
use mesoscope::scene::Scene;

/// The rows of the overview.
pub fn rows(scene: &Scene, model: &Model, division: Division) -> Vec<(&'static str, String)> {
    let dimension = scene.space.lengths.len();
    let share = share_of(scene, model, division);
    let product = |numbers: Vec<String>| numbers[..dimension].join(" × ");
    let parts = product(division.parts.map(|part| part.to_string()).to_vec());
    let length = |length: f64| format!("{length:.4}").trim_end_matches('0').trim_end_matches('.').to_owned();
    let lengths = product(share.lengths.map(length).to_vec());
    let peers = format!("{} {}", share.peers, if share.peers == 1 { "peer" } else { "peers" });
    let (count, most) = (grouped(division.ranks().into()), share.most);
    let (own, sent) = (grouped(share.own as u64), bytes(share.bytes as u64));
    if let Some([nodes, all]) = share.nodes.map(|nodes| nodes.map(grouped)) {
        let work =
            format!("a rank advances about {own} particles, adds to {nodes} of {all} nodes, and smooths all of them");
        let sends = format!("{sent} a step and rank for the nodes, with {peers}, and particles that change the rank");
        return vec![
            ("ranks", format!("{count} ({parts}), each {lengths}, of whole rows of cells; at most {most} fit")),
            ("shares", work),
            ("exchange", sends),
        ];
    }
    let (halo, copies) = (length(share.halo), share.copies);
    vec![
        ("ranks", format!("{count} ({parts}), each {lengths} with {halo} around it; at most {most} fit")),
        (
            "copies",
            format!(
                "a rank advances about {own} particles of its own and {} copies of others: {:.0} % of its work is its own",
                grouped(copies as u64),
                100.0 * share.own / (share.own + copies).max(1.0)
            ),
        ),
        ("exchange", format!("about {sent} a step and rank, with {peers}")),
    ]
}
