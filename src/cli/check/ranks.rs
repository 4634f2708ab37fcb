//! What each of several ranks that share a scene has to do.

use mesoscope::families::{Checked, Model};
use mesoscope::numbers::{bytes, counted, grouped, prefixed};
use mesoscope::plan::{Division, Hardware};
use mesoscope::run::{Share, share_of};

/// Particle-steps a second of a graphics card, where no adapter says how many.
const SPEED: f64 = 1e9;

/// The rows of the overview. One rank takes so many seconds a step on this hardware, if that is known.
pub fn rows(
    scene: &Checked,
    division: Division,
    (step, hardware): (Option<f64>, Hardware),
) -> Vec<(&'static str, String)> {
    let dimension = scene.space.lengths.len();
    let share = share_of(scene, division, hardware);
    let product = |numbers: Vec<String>| numbers[..dimension].join(" × ");
    let parts = product(division.parts.map(|part| part.to_string()).to_vec());
    let length = |length: f64| format!("{length:.4}").trim_end_matches('0').trim_end_matches('.').to_owned();
    let lengths = product(share.lengths.map(length).to_vec());
    let peers = counted(share.peers as u64, "peer");
    let (count, most) = (grouped(division.ranks().into()), share.most);
    let (own, sent) = (grouped(share.own as u64), bytes(share.bytes as u64));
    let (around, shares, sends) = if let Some([nodes, all]) = share.nodes.map(|nodes| nodes.map(grouped)) {
        let work =
            format!("a rank advances about {own} particles, adds to {nodes} of {all} nodes, and smooths all of them");
        let sends = format!("{sent} a step and rank for the nodes, with {peers}, and particles that change the rank");
        (", of whole rows of cells".to_owned(), ("shares", work), sends)
    } else {
        let copies = grouped(share.copies as u64);
        let part = 100.0 * share.own / (share.own + share.copies).max(1.0);
        let work = format!(
            "a rank advances about {own} particles of its own and {copies} copies of others: {part:.0} % of its work is \
             its own"
        );
        let mut sends = format!("about {sent} a step and rank, with {peers}");
        if share.overlapped > 0.0 {
            sends = format!("{sends}, during which {:.0} % of its work goes on", 100.0 * share.overlapped);
        }
        (format!(" with {} around it", length(share.halo)), ("copies", work), sends)
    };
    vec![
        ("ranks", format!("{count} ({parts}), each {lengths}{around}; at most {most} fit")),
        shares,
        ("exchange", sends),
        ("speed", speed(scene.model(), &share, division.ranks(), step)),
    ]
}

/// How much faster than one rank the ranks are expected to be.
fn speed(model: &Model, share: &Share, ranks: u32, step: Option<f64>) -> String {
    let particles = model.particle_count() as f64;
    let (step, whose) = step.map_or((particles / SPEED, "a graphics card"), |step| (step, "this adapter"));
    let times = share.speed_up(ranks, step);
    format!(
        "about {times:.1} times that of one rank, an efficiency of {:.0} %: with {} particle-steps/s of one as of {whose}, an adapter \
         a rank, PCIe 4 and 100 Gb/s",
        100.0 * times / f64::from(ranks),
        prefixed(particles / step),
    )
}
