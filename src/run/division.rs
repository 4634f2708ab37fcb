//! How the box of a scene is divided among ranks, if it can be.

use super::RunError;
use super::plan::plan;
use crate::families::{Checked, Model};
use crate::numbers::grouped;
use crate::plan::{Division, Domain, Hardware, Options, PARTICLE_WORDS, Part, PlannedPart, Sampler, SamplerId};
use crate::scene::AnalysisId;

/// The most ranks that are looked for.
const MOST: u32 = 4096;

/// What the first of several ranks measures, of the particles of all.
const GATHERED: [AnalysisId; 3] = [AnalysisId::ChainSizes, AnalysisId::Diffusion, AnalysisId::Viscosity];

/// What a user asks for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Ranks {
    /// So many, however the box is best divided.
    Count(u32),
    /// So many on each axis.
    Parts([u32; 3]),
}

/// The division of a scene's box among ranks: as asked, or with the fewest copies of particles.
///
/// ```
/// use mesoscope::run::{Ranks, divide};
/// use mesoscope::scene;
///
/// let scene = scene::load("dpd-fluid", &["output={}".to_owned()])?;
/// // Divided on two axes a rank has fewer copies of others here than divided on three.
/// assert_eq!(divide(&scene, Ranks::Count(8))?.parts, [1, 2, 4]);
/// let error = divide(&scene, Ranks::Count(7)).unwrap_err().to_string();
/// assert!(error.contains("6 ranks fit"), "{error}");
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// [`RunError::Unshared`] with everything that hinders, or [`RunError::Undividable`] with how many fit.
pub fn divide(scene: &Checked, asked: Ranks) -> Result<Division, RunError> {
    let model = scene.model();
    let refuse = |reasons: Vec<String>| Err(RunError::Undividable { reasons });
    let mut reasons: Vec<String> = Vec::new();
    for reason in scene.of_stages().iter().flat_map(hindrances) {
        if !reasons.contains(&reason) {
            reasons.push(reason);
        }
    }
    if !reasons.is_empty() {
        return Err(RunError::Unshared { reasons });
    }
    let dimension = model.units.dimension;
    let halos: Vec<_> = scene.of_stages().iter().map(halo).collect();
    let (with_bonds, halo) = halos.into_iter().fold((0.0, 0.0), |(a, b): (f64, f64), (c, d)| (a.max(c), b.max(d)));
    let reach = model.physics().reach(model);
    let most = most_parts(model, halo);
    let needed = format!(
        "each has to be wider than {:.4}, and with {halo:.4} more on both sides, of which its rank knows the particles, narrower than the box",
        halo + reach
    );
    let thin = |(axis, part): (usize, u32)| {
        let (name, most) = (["x", "y", "z"][axis], most[axis]);
        match model.physics().rows() {
            Some(_) if axis == 1 => {
                format!("{part} parts along y: the mesh has {most} rows of cells, and a part whole ones")
            }
            Some(_) => {
                format!("{part} parts along {name}: parts are rows of cells of the mesh, one above the other along y")
            }
            None => format!("{part} parts along {name} are too thin: {needed}; at most {most} fit"),
        }
    };
    match asked {
        Ranks::Parts(parts) => {
            let beyond = (0..dimension).filter(|&axis| parts[axis] > most[axis]);
            let reasons: Vec<String> = beyond.map(|axis| thin((axis, parts[axis]))).collect();
            if reasons.is_empty() { Ok(Division { parts }) } else { refuse(reasons) }
        }
        Ranks::Count(count) => {
            let room = most.iter().fold(1_u32, |room, most| room.saturating_mul(*most));
            let best = |count: u32| {
                if count > room {
                    return None;
                }
                let fit = divisions(count, dimension, most).into_iter();
                fit.map(|parts| Division { parts }).min_by(|a, b| {
                    let copies = |division: &Division| division.domain(0).with_halo(&model.units, with_bonds).share();
                    copies(a).total_cmp(&copies(b))
                })
            };
            best(count).map_or_else(
                || {
                    let fits = (1..=count.min(MOST).min(room)).rev().find(|fewer| best(*fewer).is_some()).unwrap_or(1);
                    if model.physics().rows().is_some() {
                        return refuse(vec![thin((1, count))]);
                    }
                    refuse(vec![format!(
                        "no division of the box into {} parts fits: {needed}; {} ranks fit",
                        grouped(count.into()),
                        grouped(fits.into())
                    )])
                },
                Ok,
            )
        }
    }
}

/// The most parts of each axis.
fn most_parts(model: &Model, halo: f64) -> [u32; 3] {
    if let Some(rows) = model.physics().rows() {
        return [1, rows.count, 1];
    }
    let reach = model.physics().reach(model);
    let mut most: [u32; 3] = std::array::from_fn(|axis| Division::most_parts(&model.units, halo, reach, axis));
    if model.particles().shear.is_some() {
        // What crosses a boundary that shears goes on anywhere along x.
        most[0] = 1;
    }
    most
}

/// Whether the parts of a division are wide enough for what their ranks have to know of each other.
pub(super) fn fits(model: &Model, part: &PlannedPart) -> bool {
    let most = most_parts(model, part.close);
    (0..3).all(|axis| part.part.division.parts[axis] <= most[axis])
}

/// What the first rank of a division has.
fn first_part(scene: &Checked, division: Division, hardware: Hardware) -> Option<PlannedPart> {
    let options = Options { part: Some(Part { division, rank: 0 }), ..Options::default() };
    plan(scene, hardware, options).part
}

/// How far around its part a rank knows the particles, and how far it would without bonds.
fn halo(scene: &Checked) -> (f64, f64) {
    let alone = Division { parts: [1; 3] };
    first_part(scene, alone, Hardware::default()).map_or((0.0, 0.0), |part| (part.halo, part.close))
}

/// Why several ranks cannot share a scene: the reasons that its family gives, else the analyses that need one device.
fn hindrances(scene: &Checked) -> Vec<String> {
    let reasons = scene.model().physics().unshared(scene);
    if !reasons.is_empty() {
        return reasons;
    }
    let plan = plan(scene, Hardware::default(), Options::default());
    let is_whole = |sampler: &Sampler| sampler.whole.len() == sampler.quantities;
    let on_one = |sampler: &Sampler| match sampler.id {
        SamplerId::Observables | SamplerId::Analysis(AnalysisId::RadialDistribution) => None,
        SamplerId::Analysis(id) if GATHERED.contains(&id) || is_whole(sampler) => None,
        SamplerId::Analysis(id) => Some(format!("`{}` is measured on one device", id.path())),
    };
    plan.samplers.iter().filter_map(on_one).collect()
}

/// All ways to divide a box of this many dimensions into so many parts, of which only so many fit along each axis.
fn divisions(count: u32, dimension: usize, most: [u32; 3]) -> Vec<[u32; 3]> {
    let divisors =
        |number: u32, most: u32| (1..=number.min(most)).filter(move |divisor| number.is_multiple_of(*divisor));
    let mut found = Vec::new();
    for z in divisors(count, most[2]) {
        for y in divisors(count / z, most[1]) {
            let x = count / z / y;
            if x > most[0] {
                continue;
            }
            if dimension == 3 || z == 1 && (dimension == 2 || y == 1) {
                found.push([x, y, z]);
            }
        }
    }
    // Rows along x stay whole where that costs no more.
    found.sort_by_key(|[x, y, _]| (*x, *y));
    found
}

/// What one of the ranks that share a scene has to do.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Share {
    /// Lengths of its part of the box.
    pub lengths: [f64; 3],
    /// How far around its part it knows the particles.
    pub halo: f64,
    /// Its own particles, if they are spread evenly.
    pub own: f64,
    /// Copies of particles of other ranks, on average over steps.
    pub copies: f64,
    /// The ranks that it exchanges particles with.
    pub peers: usize,
    /// Bytes of these copies, and of what it adds on the nodes of a mesh, that it sends in a step.
    pub bytes: f64,
    /// Nodes of the mesh that it adds to, and all of them, if there is a mesh.
    pub nodes: Option<[u64; 2]>,
    /// The part of the arithmetic of a step that every rank does for itself, as if it were alone.
    pub undivided: f64,
    /// The part of the arithmetic of a step that goes on during an exchange.
    pub overlapped: f64,
    /// How often it waits for other ranks in a step.
    pub exchanges: u32,
    /// The most ranks that fit.
    pub most: u32,
}

/// Seconds that an exchange takes however little it brings, and bytes a second from a device to its host (PCI Express 4, in each
/// direction) and from host to host (100 Gb/s).
const FIXED: f64 = 150e-6;
const TO_HOST: f64 = 22e9;
const BETWEEN_HOSTS: f64 = 12.5e9;

/// Of the time that the arithmetic of a step is thought to take, what passes over pairs do; the rest sorts particles and comes before or after.
const PASSES: f64 = 0.8;

impl Share {
    /// How many times as fast as one rank so many are, if that takes so many seconds a step: with an adapter each, PCI Express 4 and a
    /// network of 100 Gb/s. Copies to hosts and from them overlap with nothing.
    ///
    /// ```
    /// use mesoscope::run::Share;
    ///
    /// // A million particles of a rank, in a cube with a halo of one cutoff, at a billion particle-steps/s.
    /// let share = Share { own: 1e6, copies: 8.9e4, bytes: 2.8e6, exchanges: 1, ..Share::default() };
    /// let efficiency = |share: Share| share.speed_up(8, 8e-3) / 8.0;
    /// assert!((efficiency(share) - 0.58).abs() < 0.01, "{}", efficiency(share));
    /// // If its device computes in the meantime, only the copies are left of the exchange.
    /// let overlapping = Share { overlapped: 0.5, ..share };
    /// assert!((efficiency(overlapping) - 0.74).abs() < 0.01, "{}", efficiency(overlapping));
    /// ```
    #[must_use]
    pub fn speed_up(&self, ranks: u32, seconds: f64) -> f64 {
        let part = (1.0 - self.undivided) / f64::from(ranks) * (self.own + self.copies) / self.own.max(1.0);
        let between = f64::from(self.exchanges) * FIXED + self.bytes / BETWEEN_HOSTS;
        let hidden = between.min(PASSES * self.overlapped * part * seconds);
        let exchange = self.bytes * 2.0 / TO_HOST + between - hidden;
        seconds / (seconds * (part + self.undivided) + exchange)
    }
}

/// What each rank of a division has to do, on hardware of a kind and without a device.
///
/// ```
/// use mesoscope::plan::Hardware;
/// use mesoscope::run::{Ranks, divide, share_of};
/// use mesoscope::scene;
///
/// let scene = scene::load("dpd-fluid", &["output={}".to_owned()])?;
/// let division = divide(&scene, Ranks::Parts([1, 1, 2]))?;
/// let share = share_of(&scene, division, Hardware::default());
/// assert_eq!((share.own, share.halo, share.peers), (12_000.0, 2.0, 1));
/// assert!((share.copies - 2.0 * 2.0 / 20.0 * 24_000.0).abs() < 1.0);
/// // Two of its ten layers of cells, of fourteen with the copies, hold nothing that others may need; the last of two visits of pairs.
/// assert!((share.overlapped - 0.5 * 2.0 / 14.0).abs() < 0.01, "{}", share.overlapped);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[must_use]
pub fn share_of(scene: &Checked, division: Division, hardware: Hardware) -> Share {
    let model = scene.model();
    let (units, planned) = (&model.units, first_part(scene, division, hardware));
    let Some(part) = &planned else { return Share::default() };
    let PlannedPart { halo, close, domains, wider, peers, shared, .. } = part;
    let particles = |domain: Option<&Domain>| domain.map_or(0.0, Domain::share) * *shared as f64;
    let (own, needed) = (particles(domains.first()), particles(domains.get(1)));
    // Now and then more of them.
    let sampled = wider.as_ref().map_or(0.0, |wider| particles(wider.domains.get(1)) - needed);
    let every = scene.output.radial_distribution.as_ref().map_or(1, |asked| asked.every.max(1));
    let copies = if part.has_halo() { needed - own + sampled / every as f64 } else { 0.0 };
    let summed = planned.as_ref().map_or(0, PlannedPart::summed_bytes);
    Share {
        lengths: std::array::from_fn(|axis| units.lengths[axis] / f64::from(division.parts[axis])),
        halo: *halo,
        own,
        copies,
        peers: peers.len(),
        bytes: 4.0 * f64::from(PARTICLE_WORDS) * copies + summed as f64,
        undivided: model.physics().undivided(),
        overlapped: planned.as_ref().map_or(0.0, |planned| planned.overlapped),
        // What is summed on a mesh is exchanged in mid-step.
        exchanges: if summed > 0 { 2 } else { 1 },
        nodes: model.physics().rows().map(|_| [summed / 4 / peers.len().max(1) as u64, model.physics().nodes()]),
        most: most_parts(model, *close).into_iter().product(),
    }
}
