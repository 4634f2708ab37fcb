//! Whether a time step can be stable at all, before a run finds out.
//!
//! A scheme of the family of Cotter and Reich, doi:10.1209/epl/i2003-00621-8, is stable for a coupling function of constant
//! gradient on a mass m in a harmonic potential K while B + W < 4, where B = λₑdt²/m and W = K dt²/m. For many of them
//! λₑ∇h∇hᵀ and the Hessian of the potential add up to a matrix, of which the largest eigenvalue counts. Adding to it what is
//! left out here, springs, baths and neighbours that attract, only makes that larger: a part of it at 4 is certainly
//! unstable, and refused.

use super::model::bonded_particles;
use crate::document::{Bath, BondPotential, Integrator, Interaction, NumberedSpecies, Problems, Scene, Warning, brief};
use crate::families::limits::{at_step, largest_step};
use crate::families::speeds::{brief_step, round_down};
use crate::families::{
    Alike, Beyond, Bond, BondKind, Bonds, Checked, FREQUENCY_LIMIT, Limit, MOST_RELAXATION, Model, Particles, Species,
    TOLERANCE,
};

/// B + W beyond which nothing is stable.
const LIMIT: f64 = 4.0;

/// B + W from which on a warning is due: positions are a third off their temperature where there is no potential but this.
const CLEAN: f64 = 1.0;

/// The neighbours from which on the friction of a step is limited: one pair relaxes exactly at any friction, but many at once do not.
const NEIGHBOURS: f64 = 3.0;

/// Radians by which the stiffest crowd of neighbours oscillates in a step. Fluids have been seen to become unstable between
/// 1.8 and 2.4 of the estimate; that of ever more neighbours is 2.1, of waves in an even density.
const MOST_OSCILLATION: f64 = 2.5;

/// The same where forces depend on densities, of which the estimate knows less: such fluids have been seen to hold up to 3.4.
const MOST_MANY_BODY_OSCILLATION: f64 = 5.0;

/// Bonds that an estimate looks at: the largest eigenvalue of a part is not above that of the whole.
const MOST_BONDS: usize = 10_000;

/// Rounds of the power iteration for the largest eigenvalue, which comes from below.
const ROUNDS: usize = 40;

/// The strain of a white bath for each B: friction that sees a velocity predicted by λ is stable for 2λB + W < 4, and
/// for λ below a quarter for (1 - 2λ)B < 4.
fn strain_of_bath(model: &Model) -> f64 {
    match model.particles().integrator {
        Integrator::GrootWarren { lambda } => (2.0 * lambda).max(1.0 - 2.0 * lambda),
        _ => 1.0,
    }
}

/// The part of the bath's temperature that friction of particles and bonds leaves out or adds at the most, where it
/// sees velocities predicted by λ: ⟨v²⟩ = (kT/m) 2/(2 + (2λ - 1)(γdt/m + W)), in which γdt/m is B/2.
fn cold_by_prediction(strains: &[Strain], model: &Model) -> f64 {
    let Integrator::GrootWarren { lambda } = model.particles().integrator else { return 0.0 };
    let part = |strain: &Strain| {
        let rate = 0.5 * strain.bath / strain_of_bath(model) + strain.sum - strain.bath;
        1.0 - 2.0 / (2.0 + (2.0 * lambda - 1.0) * rate)
    };
    let bathed = strains.iter().filter(|strain| strain.bath > 0.0).map(part);
    bathed.fold(0.0, |most: f64, part| if part.abs() > most.abs() { part } else { most })
}

/// Warns of a temperature that a prediction makes wrong by more than is tolerated.
pub(crate) fn warn_of_prediction(scene: &Checked) -> Option<Warning> {
    let network = Network::of(scene);
    let cold = cold_by_prediction(&certain(scene, network.as_ref()), scene.model());
    (cold.abs() > TOLERANCE).then(|| {
        let (percent, way) = (100.0 * cold.abs(), if cold > 0.0 { "low" } else { "high" });
        let message = format!(
            "friction of particles or bonds sees predicted velocities, which makes their kinetic temperature \
             {percent:.1} % too {way}; `lambda` 0.5 or a smaller `time.step` does not"
        );
        Warning { path: "integrator.lambda".to_owned(), message }
    })
}

/// What puts the most strain on a time step.
#[derive(Debug, Clone)]
struct Strain {
    /// B + W.
    sum: f64,
    /// The part B of a bath.
    bath: f64,
    /// The interaction it belongs to.
    place: usize,
    /// What is strained, in words.
    what: String,
}

/// Refuses a time step that is certainly unstable.
pub(crate) fn check(scene: &Checked, problems: &mut Problems) {
    let step = scene.time.step;
    let network = Network::of(scene);
    let Some(worst) = strongest(&certain(scene, network.as_ref())) else { return };
    if worst.sum < LIMIT {
        return;
    }
    let sum = if worst.sum < 1e6 { format!("{:.4}", worst.sum) } else { brief(worst.sum) };
    let found = format!("{step}, at which B + W is {sum} for {}", worst.what);
    let share = |step: f64| {
        let other = at_step(scene, step);
        strongest(&certain(&other, network.as_ref())).map_or(0.0, |strain| strain.sum) / LIMIT
    };
    let largest = largest_step([step, worst.sum / LIMIT], 1e-6, &share);
    let mut accepted = format!(
        "at most {}, so that B + W = (λₑ + K)dt²/m stays below {LIMIT}, beyond which no scheme is stable",
        two_digits(largest.unwrap_or(0.0))
    );
    let spring = worst.sum - worst.bath;
    if worst.bath > 0.0 && spring < LIMIT {
        let share = (LIMIT - spring) / worst.bath;
        let (key, value) = bath_strength(&scene.interactions()[worst.place]);
        if value > 0.0 {
            let most = two_digits(share * value);
            accepted = format!("{accepted}; or a {key} of at most {most} in interactions[{}]", worst.place);
        }
    }
    problems.refuse("time.step", found, accepted);
}

/// Refuses a time step in which the friction of pairs that do not relax is certainly unstable, B being 2Γ dt on average for a mean
/// friction rate Γ, of which half is certain, or in which repulsion certainly throws neighbours apart.
pub(crate) fn check_pairs(scene: &Checked, problems: &mut Problems) {
    let model = scene.model();
    let particles = model.particles();
    let Some(force) = particles.pair_force.as_ref() else { return };
    let step = scene.time.step;
    // Particles of a gas meet now and then.
    let meets = model.most_neighbours(force) >= NEIGHBOURS;
    let advice = |most: f64, beyond: &str, reliable: f64, less: &str| {
        let most = two_digits(most);
        format!("at most {most}, beyond which {beyond}, and {reliable:.2e} for reliable results; or less {less}")
    };
    let (rate, index) = model.largest_friction_rate(force);
    let (splits, staged) = (particles.splits(), particles.relaxes_in_two_stages());
    let most = if splits { MOST_RELAXATION } else { LIMIT };
    // A pair alone relaxes exactly in one stage only.
    if !force.remembers() && rate * step >= most && (meets || !splits || staged) {
        let (name, times) = (&model.species[index].name, brief(rate * step));
        let found = format!("{step}, in which friction relaxes the velocities of `{name}` {times} times over");
        let beyond = if staged { "no step was measured" } else { "no such step is stable" };
        problems.refuse("time.step", found, advice(most / rate, beyond, model.friction_limit() / rate, "friction"));
    }
    let (frequency, index) = model.largest_repulsion_frequency(force);
    let most = if force.many_body.is_some() { MOST_MANY_BODY_OSCILLATION } else { MOST_OSCILLATION };
    if frequency * step >= most && meets {
        let (name, angle) = (&model.species[index].name, brief(frequency * step));
        let found = format!("{step}, in which crowds of `{name}` oscillate by {angle} radians in their repulsion");
        let accepted = advice(most / frequency, "no such step is stable", FREQUENCY_LIMIT / frequency, "repulsion");
        problems.refuse("time.step", found, accepted);
    }
}

/// Warns of a time step near the edge.
pub(crate) fn warn(scene: &Checked) -> Option<Warning> {
    let Strain { sum, what, .. } = strongest(&at_times(scene)).filter(|strain| strain.sum > CLEAN)?;
    let verdict = if sum >= LIMIT {
        format!("{LIMIT} is the limit of stability, which is passed at times")
    } else {
        format!("{LIMIT} is the limit of stability, and up to {CLEAN} is advisable")
    };
    // Stiffness goes with the square of the step, friction with a lower power.
    let safe = two_digits(scene.time.step * (CLEAN / sum).min(1.0));
    let message = format!("B + W = (λₑ + K)dt²/m is {sum:.3} for {what}: {verdict}; a step of {safe} is safe");
    Some(Warning { path: "time.step".to_owned(), message })
}

/// The laws that bound the time step, those of what is there at times included.
pub(super) fn limits(particles: &Particles, scene: &Checked) -> Vec<Limit> {
    let model = scene.model();
    let step = scene.time.step;
    let strains = at_times(scene);
    let strain = strongest(&strains).map_or(0.0, |strain| strain.sum);
    let pairs = particles.pair_force.as_ref();
    let friction = pairs.map_or(0.0, |force| model.largest_friction_rate(force).0);
    let frequency = pairs.map_or(0.0, |force| model.largest_repulsion_frequency(force).0);
    let mut limits = vec![
        Limit { law: "B + W = 4", share: strain / LIMIT, beyond: Beyond::Unstable },
        Limit { law: "oscillation ω dt = 2", share: 0.5 * frequency * step, beyond: Beyond::Unstable },
    ];
    let biased = |law, share| Limit { law, share, beyond: Beyond::Biased };
    match model.relaxation() {
        Some(errors) => {
            let output = &scene.output;
            let of_viscosity = output.viscosity.is_some() || output.stress.is_some();
            // Transport that a scene does not measure bounds nothing of its results.
            let laws = [
                (true, "1 % of the temperature, by friction in one stage", errors.cold),
                (of_viscosity, "1 % of the viscosity, by friction that a step weakens", errors.viscosity),
                (output.diffusion.is_some(), "1 % of diffusion, by friction in two stages", errors.slow),
                (true, "1 % of the temperature, by repulsion", errors.hot),
            ];
            let measured = laws.into_iter().filter(|(is_measured, ..)| *is_measured);
            limits.extend(measured.map(|(_, law, error)| biased(law, error / TOLERANCE)));
        }
        None => limits.push(biased("friction Γ dt = 1/4", friction * step / model.friction_limit())),
    }
    let cold = cold_by_prediction(&strains, model).abs();
    if cold > 0.0 {
        limits.push(biased("1 % of the temperature, by a prediction", cold / TOLERANCE));
    }
    limits
}

fn strongest(strains: &[Strain]) -> Option<Strain> {
    strains.iter().max_by(|a, b| a.sum.total_cmp(&b.sum)).cloned()
}

/// The key that sets the strength of a bath, and its value.
fn bath_strength(interaction: &Interaction) -> (&'static str, f64) {
    match interaction.bath() {
        Some((Bath::Memory { coupling: Some(coupling), .. }, _)) => ("coupling", *coupling),
        bath => ("friction", bath.map_or(0.0, |(_, friction)| friction)),
    }
}

/// Parts of the matrix that are there at all times.
fn certain(scene: &Checked, network: Option<&Network>) -> Vec<Strain> {
    let model = scene.model();
    let mut strains = of_particles(scene);
    strains.extend(of_pairs_on_average(scene));
    if let Some(bonds) = model.particles().bonds.as_ref() {
        strains.extend(of_single_bonds(scene, bonds));
        let line = model.units.dimension == 1;
        // Without a length at rest a spring is as stiff across as along.
        let isotropic = |kind: &BondKind| match kind.potential {
            Some(BondPotential::Harmonic { stiffness, length: 0.0 }) => [stiffness, 0.0],
            _ => [0.0; 2],
        };
        let stiffness = |kind: &BondKind| if line { stiffnesses(model, kind) } else { isotropic(kind) };
        strains.extend(network.and_then(|network| network.strain(model, bonds, &stiffness)));
    }
    strains
}

/// The same with the matrix as it may be: chains that are straight, two particles in one place.
fn at_times(scene: &Checked) -> Vec<Strain> {
    let (model, network) = (scene.model(), Network::of(scene));
    let mut strains = certain(scene, network.as_ref());
    let bonds = model.particles().bonds.as_ref().zip(network);
    strains.extend(bonds.and_then(|(bonds, network)| network.strain(model, bonds, &|kind| stiffnesses(model, kind))));
    strains
}

fn inverse_mass(model: &Model, species: usize) -> f64 {
    let species = &model.species[species];
    if species.fixed { 0.0 } else { 1.0 / species.mass }
}

/// Springs and baths on single particles.
fn of_particles(scene: &Checked) -> Vec<Strain> {
    let model = scene.model();
    let particles = model.particles();
    let place = scene.places_of("langevin").chain(scene.places_of("tether")).next().unwrap_or(0);
    let spring = particles.tethers.map_or(0.0, |tethers| tethers.stiffness);
    // A bath that relaxes exactly puts no strain on the step.
    let bath = particles.position_bath.as_ref().filter(|_| !particles.relaxes_particles());
    let species = model.species.iter().enumerate().filter(|(_, species)| species.count > 0);
    let strain = |(index, species): (usize, &Species)| {
        let bath = bath.map_or(0.0, |bath| bath.steps[index].coupling) * strain_of_bath(model);
        let scale = model.time_step * model.time_step * inverse_mass(model, index);
        let what = format!("every `{}` of mass {}", species.name, species.mass);
        Strain { sum: scale * (bath + spring), bath: scale * bath, place, what }
    };
    species.map(strain).collect()
}

/// λₑ of pairs: the mean of all eigenvalues for evenly spread particles, Σ λₑρ\[ω\]/(d·m). The largest is several times
/// as large, but particles that repel each other keep away from where ω is largest: half of the mean is certain.
fn of_pairs_on_average(scene: &Checked) -> Vec<Strain> {
    let model = scene.model();
    let (step, particles) = (model.time_step, model.particles());
    let force = particles.pair_force.as_ref().filter(|_| particles.integrator == Integrator::CotterReich {});
    let Some(force) = force else { return Vec::new() };
    let place = scene.places_of("dpd").next().unwrap_or(0);
    let species = model.species.iter().enumerate().filter(|(_, species)| species.count > 0);
    let strain = |(index, species): (usize, &Species)| {
        let others = model.densities(index).map(|(other, density)| {
            let weight = force.weight_volume(index, other, model.units.dimension);
            force.bath_step(index, other, step).coupling * density * weight
        });
        let mean = others.sum::<f64>() * step * step * inverse_mass(model, index) / model.units.dimension as f64;
        let what = format!("the bath of pairs of `{}` with their neighbours", species.name);
        Strain { sum: 0.5 * mean, bath: 0.5 * mean, place, what }
    };
    species.map(strain).collect()
}

/// K and λₑ of a kind of bonds; K at rest, the least of a bond that is finitely extensible.
fn stiffnesses(model: &Model, kind: &BondKind) -> [f64; 2] {
    let spring = match kind.potential {
        Some(BondPotential::Harmonic { stiffness, .. } | BondPotential::Fene { stiffness, .. }) => stiffness,
        None => 0.0,
    };
    // A bath that relaxes exactly puts no strain on the step.
    let bath = kind.bath.filter(|_| !model.particles().relaxes_bonds());
    [spring, bath.map_or(0.0, |bath| bath.coupling * strain_of_bath(model))]
}

/// The interaction that each kind of bonds comes from.
fn places(scene: &Scene, bonds: &Bonds) -> Vec<usize> {
    match scene.places_of("harmonic-chain").next() {
        Some(place) => vec![place; bonds.kinds.len()],
        None => scene.places_of("bonds").collect(),
    }
}

/// The species of all particles.
fn numbered_species<'a>(scene: &'a Scene, model: &Model) -> NumberedSpecies<'a> {
    let side_by_side = model.species.iter().filter(|_| model.particles().side_by_side);
    NumberedSpecies::new(scene).with(side_by_side.map(|species| species.count))
}

/// Every bond by itself, on the reduced mass of its ends.
fn of_single_bonds(scene: &Checked, bonds: &Bonds) -> Vec<Strain> {
    let model = scene.model();
    let members = numbered_species(scene, model);
    let (step, places) = (model.time_step, places(scene, bonds));
    let mut largest = vec![0.0_f64; bonds.kinds.len()];
    for (kind, alike) in bonds.alike() {
        let inverse = match alike {
            Alike::Species(species) => 2.0 * inverse_mass(model, species),
            Alike::Ended(species, ends) => {
                let inverse = inverse_mass(model, species);
                (2.0 * inverse).max(inverse + inverse_mass(model, ends))
            }
            Alike::Listed(pairs) => {
                let inverse = |end: &u32| inverse_mass(model, members.of(*end).unwrap_or(0));
                pairs.iter().map(|ends| ends.iter().map(inverse).sum::<f64>()).fold(0.0, f64::max)
            }
        };
        largest[kind as usize] = largest[kind as usize].max(inverse);
    }
    let strain = |(kind, inverse): (usize, &f64)| {
        let [spring, bath] = stiffnesses(model, &bonds.kinds[kind]).map(|value| value * step * step * inverse);
        let what = format!("the bonds of interactions[{}], of reduced mass {}", places[kind], 1.0 / inverse);
        Strain { sum: spring + bath, bath, place: places[kind], what }
    };
    largest.iter().enumerate().filter(|(_, inverse)| **inverse > 0.0).map(strain).collect()
}

/// The first bonds of a scene, and of their particles the numbers and inverse masses.
struct Network {
    /// Places of the ends among the particles, and the kind.
    bonds: Vec<([usize; 2], usize)>,
    particles: Vec<u32>,
    inverse_masses: Vec<f64>,
    /// The interaction that they come from.
    place: usize,
}

impl Network {
    fn of(scene: &Checked) -> Option<Self> {
        let model = scene.model();
        let bonds = model.particles().bonds.as_ref()?;
        let members = numbered_species(scene, model);
        let seen: Vec<Bond> = bonds.iter().take(MOST_BONDS).collect();
        let particles = bonded_particles(&seen);
        let place_of = |end: u32| particles.partition_point(|particle| *particle < end);
        Some(Self {
            bonds: seen.iter().map(|bond| (bond.ends.map(place_of), bond.kind as usize)).collect(),
            inverse_masses: particles.iter().map(|end| inverse_mass(model, members.of(*end).unwrap_or(0))).collect(),
            particles,
            place: *places(scene, bonds).first()?,
        })
    }

    /// All bonds together as if they were in one line, by power iteration. `stiffness` gives K and λₑ of a kind.
    fn strain(&self, model: &Model, bonds: &Bonds, stiffness: &dyn Fn(&BondKind) -> [f64; 2]) -> Option<Strain> {
        let (step, kinds): (f64, Vec<[f64; 2]>) = (model.time_step, bonds.kinds.iter().map(stiffness).collect());
        if kinds.iter().all(|[spring, bath]| spring + bath == 0.0) {
            return None;
        }
        let roots: Vec<f64> = self.inverse_masses.iter().map(|inverse| inverse.sqrt() * step).collect();
        let product = |vector: &[f64], part: usize| {
            let mut result = vec![0.0; vector.len()];
            for &([a, b], kind) in &self.bonds {
                let [spring, bath] = kinds[kind];
                let pull = [spring + bath, bath][part] * (roots[a] * vector[a] - roots[b] * vector[b]);
                result[a] += roots[a] * pull;
                result[b] -= roots[b] * pull;
            }
            result
        };
        let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
        // Neighbours against each other, and not quite in order: near the stiffest mode of a chain and of all others.
        let first = |id: &u32| (if id.is_multiple_of(2) { 1.0 } else { -1.0 }) * (1.0 + 0.1 * f64::from(*id).sin());
        let mut vector: Vec<f64> = self.particles.iter().map(first).collect();
        for _ in 0..ROUNDS {
            vector = product(&vector, 0);
            let length = dot(&vector, &vector).sqrt();
            if length == 0.0 {
                return None;
            }
            vector = vector.iter().map(|component| component / length).collect();
        }
        let [sum, bath] = [0, 1].map(|part| dot(&vector, &product(&vector, part)));
        Some(Strain { sum, bath, place: self.place, what: "all bonds together".to_owned() })
    }
}

/// The largest number of two digits below `value`: at the edge itself nothing is stable.
fn two_digits(value: f64) -> String {
    let value = if value.is_finite() { value } else { 0.0 };
    brief_step(round_down(value * (1.0 - 1e-9), 2))
}
