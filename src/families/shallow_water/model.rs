//! Rotating shallow water by the Hamiltonian particle-mesh method, doi:10.1209/epl/i2003-00621-8.

use super::layout::LARGEST_MASS;
use crate::document::{
    BathRate, MeshBath, Placement, Scene, ShallowWaterInteraction, Smoothing, SurfaceFeature, Velocities,
    WaterIntegrator,
};
use crate::families::BathStep;
use crate::families::shallow_water::surface::Surface;
use crate::plan::Rows;
use std::f64::consts::PI;
use std::ops::Range;

/// Particles that carry water, the mesh on which their depth is formed, and the bath on its nodes.
///
/// Lengths are those of the scene, but for depth, which is mass a node, and masses, whose sum is the number of nodes,
/// so that the mean depth is 1. The node (k, l) is at (k Δx, l Δy) and has the index k + l·nₓ.
#[derive(Debug, Clone, PartialEq)]
pub struct ShallowWater {
    /// Integrator.
    pub integrator: WaterIntegrator,
    /// Mesh nodes on each axis.
    pub mesh: [u32; 2],
    /// Order of the B-splines, 1 to 3.
    pub spline_order: u32,
    /// Speed c₀ of gravity waves.
    pub wave_speed: f64,
    /// Coriolis parameter f₀ of du/dt = f₀v, dv/dt = -f₀u.
    pub rotation: f64,
    /// Smoothing of the depth.
    pub smoothing: Smoothing,
    /// Features of the smoothed surface at the start.
    pub surface: Vec<SurfaceFeature>,
    /// Whether it starts still: an even surface, and particles with thermal velocities.
    pub starts_still: bool,
    /// Bath step on every node, coupled to its depth; the bath variable and its noise are scaled by 1/c₀.
    pub bath: Option<BathStep>,
    /// Value of one unit of integer mass; a power of two.
    pub mass_unit: f64,
    /// Particles that carry water; they are numbered before all tracers.
    pub carriers: u64,
    /// Groups of particles without mass, in order of their numbers.
    pub tracers: Vec<Tracers>,
}

/// A group of particles without mass.
#[derive(Debug, Clone, PartialEq)]
pub struct Tracers {
    /// Name of the species.
    pub name: String,
    /// Number of particles.
    pub count: u64,
    /// Whether they form a closed loop, in order.
    pub closed: bool,
}

/// Units of mass that fit the largest sum, and how many times the mean a cell may hold.
const MASS_RANGE: f64 = 2_147_483_648.0;
const CROWDING: f64 = 128.0;
/// The largest depth at the start, in units of the mean.
pub(crate) const LARGEST_DEPTH: f64 = 4.0;
/// What a flow that gathers its water may add to the stiffness of the mesh: .07 of it has been enough.
const MARGIN: f64 = 0.93;

impl ShallowWater {
    pub(crate) fn new(interaction: &ShallowWaterInteraction, integrator: WaterIntegrator, scene: &Scene) -> Self {
        let count = |tracer: bool| {
            let groups = scene.particles.iter().filter(move |group| group.tracer == tracer);
            groups.map(|group| group.resolved_count(&scene.space))
        };
        let carriers: u64 = count(false).sum();
        let mut waters = scene.particles.iter().filter(|group| !group.tracer);
        let starts_still = scene.state.is_none()
            && interaction.surface.is_empty()
            && waters.all(|group| matches!(group.velocities, Velocities::Thermal));
        let tracers = scene.particles.iter().filter(|group| group.tracer).zip(count(true));
        let nodes = f64::from(interaction.mesh[0]) * f64::from(interaction.mesh[1]);
        let heaviest = LARGEST_DEPTH * nodes / carriers.max(1) as f64;
        let mass_unit = (CROWDING / MASS_RANGE).max(heaviest / LARGEST_MASS).log2().ceil().exp2();
        Self {
            integrator,
            mesh: interaction.mesh,
            spline_order: interaction.spline_order,
            wave_speed: interaction.wave_speed,
            rotation: interaction.rotation,
            smoothing: interaction.smoothing.clone(),
            surface: interaction.surface.clone(),
            starts_still,
            bath: interaction.bath.as_ref().map(|bath| bath_step(bath, interaction, scene.time.step)),
            mass_unit,
            carriers,
            tracers: tracers
                .map(|(group, count)| Tracers {
                    name: group.species.clone(),
                    count,
                    closed: matches!(group.placement, Placement::Circle { .. }),
                })
                .collect(),
        }
    }

    /// Number of mesh nodes.
    #[must_use]
    pub fn nodes(&self) -> u64 {
        u64::from(self.mesh[0]) * u64::from(self.mesh[1])
    }

    /// Rows of cells of the mesh.
    pub(super) fn rows(&self) -> Rows {
        Rows { count: self.mesh[1], centred: self.spline_order == 2 }
    }

    /// Name and particle numbers of every group of tracers that form a closed loop.
    pub(crate) fn closed_loops(&self) -> impl Iterator<Item = (&str, Range<usize>)> {
        let mut first = self.carriers as usize;
        let ranges = self.tracers.iter().map(move |group| {
            let range = first..first + group.count as usize;
            first = range.end;
            (group, range)
        });
        ranges.filter(|(group, _)| group.closed).map(|(group, range)| (group.name.as_str(), range))
    }

    /// The surface at the start in a box with these edges.
    pub(crate) fn surface(&self, lengths: [f64; 2]) -> Surface<'_> {
        Surface::new(&self.surface, lengths)
    }

    /// The smaller distance between neighbouring nodes in a box with these edges.
    pub(crate) fn spacing(&self, lengths: [f64; 3]) -> f64 {
        (lengths[0] / f64::from(self.mesh[0])).min(lengths[1] / f64::from(self.mesh[1]))
    }

    /// Integer mass of all particles: 1 for every node.
    #[must_use]
    pub fn total_mass(&self) -> u64 {
        if self.carriers == 0 { 0 } else { (self.nodes() as f64 / self.mass_unit).round() as u64 }
    }

    /// Integer mass that a node holds on average.
    pub(crate) fn mean_mass(&self) -> i64 {
        if self.carriers == 0 { 0 } else { (1.0 / self.mass_unit).round() as i64 }
    }

    /// How far a particle of unit velocity goes in a step, ahead and to the side: the path of a drift that turns with the rotation
    /// bends by the whole angle, one that the rotation is apart from is straight.
    pub(super) fn path(&self, time_step: f64) -> [f64; 2] {
        let angle = self.rotation * time_step;
        if self.rotation == 0.0 || self.integrator != (WaterIntegrator::Gyro {}) {
            [time_step, 0.0]
        } else {
            [angle.sin() / self.rotation, (1.0 - angle.cos()) / self.rotation]
        }
    }

    /// The share p of the limit of stability that a time step takes, for water that is spread evenly: it is stable for p < 1.
    /// Water at random places has a limit of its own, below 1: see [`clean_share`](Self::clean_share).
    ///
    /// Kicks by the smoothed depth and by the bath are oscillators of one mode of the mesh each, with (W + B)/4 < 1 as
    /// the limit. Their stiffness is the largest eigenvalue of ∫∇ψ·∇ψ over the smoothing, and over the coupling of the
    /// bath. With rotation the drift of [`WaterIntegrator::Gyro`] turns a particle by θ = f₀ dt, which leaves less room: the limit
    /// is then (W + B)/4 < (θ/2) cot(θ/2) for θ < π, from the trace 1 + 2 cos θ - (W + B) sin(θ)/θ of one step. From half a
    /// turn on p is infinite.
    ///
    /// ```
    /// use mesoscope::scene;
    ///
    /// let model = scene::load("shallow-water", &[])?.model().clone();
    /// let water = model.shallow_water().ok_or("no shallow water")?;
    /// let [x, y, _] = model.units.lengths;
    /// let share = water.stability([x, y], model.time_step);
    /// assert!(share > 0.0 && share < 1.0);
    /// // Kicks grow with the square of the step.
    /// assert!((water.stability([x, y], 2.0 * model.time_step) / share - 4.0).abs() < 0.1);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    #[must_use]
    pub fn stability(&self, lengths: [f64; 2], time_step: f64) -> f64 {
        self.kicks(lengths, time_step) / self.room(time_step)
    }

    /// The share p up to which steps are stable wherever chance and flow put the particles.
    ///
    /// Where more particles are than elsewhere the mesh is stiffer. For random places the largest eigenvalue of
    /// Σ m ∇ψ·∇ψ exceeds that of water spread evenly by a factor that depends on the number n of particles a cell: on 64²
    /// nodes, without smoothing or under white noise, 2.9, 1.7, 1.28 and 1.09 for cubic splines and n = 1, 4, 16 and 64,
    /// 3.8, 1.9, 1.32 and 1.08 for linear ones; smoothing lowers it. The factor here is above all of these.
    ///
    /// ```
    /// use mesoscope::scene;
    ///
    /// let share = |name: &str| {
    ///     let model = scene::load(name, &[])?.model().clone();
    ///     Ok::<_, scene::SceneError>(model.shallow_water().map_or(0.0, |water| water.clean_share()))
    /// };
    /// // 16 particles a cell, and 4.
    /// assert!((share("shallow-water")? - 0.70).abs() < 0.01);
    /// assert!((share("shallow-water-equilibrium")? - 0.52).abs() < 0.01);
    /// # Ok::<(), scene::SceneError>(())
    /// ```
    #[must_use]
    pub fn clean_share(&self) -> f64 {
        let crowd = self.carriers.max(1) as f64 / self.nodes() as f64;
        let (spread, alone) = if self.spline_order == 3 { (1.1, 1.0) } else { (1.3, 1.7) };
        MARGIN / (1.0 + spread / crowd.sqrt() + alone / crowd)
    }

    /// The part of (W + B)/4 that is left to a stable step by the drift before it.
    fn room(&self, time_step: f64) -> f64 {
        let half_turn = 0.5 * (self.rotation * time_step).abs();
        if self.integrator != (WaterIntegrator::Gyro {}) || half_turn < 1e-6 {
            return 1.0;
        }
        // Steps of more than half a turn find room here and there, which is not counted on.
        if half_turn < 0.5 * PI { half_turn / half_turn.tan() } else { 0.0 }
    }

    /// (W + B)/4 of the stiffest mode.
    fn kicks(&self, lengths: [f64; 2], time_step: f64) -> f64 {
        const SAMPLES: u32 = 64;
        let spacing = [lengths[0] / f64::from(self.mesh[0]), lengths[1] / f64::from(self.mesh[1])];
        let coupling = self.bath.as_ref().map_or(0.0, |bath| bath.coupling);
        let mut largest: f64 = 0.0;
        for k in 0..=SAMPLES {
            for l in 0..=SAMPLES {
                let angles = [k, l].map(|index| PI * f64::from(index) / f64::from(SAMPLES));
                let [(mass_x, stiff_x), (mass_y, stiff_y)] =
                    angles.map(|angle| spline_symbols(self.spline_order, angle));
                let gradient = stiff_x * mass_y / spacing[0].powi(2) + mass_x * stiff_y / spacing[1].powi(2);
                let laplacian: f64 =
                    (0..2).map(|axis| (2.0 * (0.5 * angles[axis]).sin() / spacing[axis]).powi(2)).sum();
                let smoothing = (1.0 + self.smoothing.length.powi(2) * laplacian).powi(-(self.smoothing.power as i32));
                largest = largest.max(gradient * (smoothing + coupling));
            }
        }
        0.25 * (time_step * self.wave_speed).powi(2) * largest
    }

    /// A time step that takes no more than a clean share of the limit of stability, from one that takes more.
    pub(crate) fn advisable_step(&self, lengths: [f64; 2], time_step: f64) -> f64 {
        let kicks = self.kicks(lengths, time_step);
        // Without memory or with little, the coupling of the bath itself depends on the step: kicks are between dt and dt².
        let order = if self.bath.is_some() { 1 } else { 2 };
        let clean = |share: f64| {
            let step = share * time_step;
            (self.rotation * step).abs() < PI && kicks * share.powi(order) <= self.clean_share() * self.room(step)
        };
        let mut share = 1.0;
        while !clean(share) && share > f64::MIN_POSITIVE {
            share *= 0.5;
        }
        let mut above = 2.0 * share;
        for _ in 0..40 {
            let middle = 0.5 * (share + above);
            if clean(middle) { share = middle } else { above = middle }
        }
        share * time_step
    }
}

/// Iterations of Chebyshev's polynomial for 1 - Λ²∇², with Λ²/Δx² of each axis given, that leave of no mode more than
/// `tolerance`; at least 1, and without bound as the lengths grow.
pub(crate) fn chebyshev_iterations(stiffness: [f64; 2], tolerance: f64) -> f64 {
    let radius = (2.0 * (stiffness[0] + stiffness[1])).max(f64::MIN_POSITIVE);
    ((1.0 / tolerance).acosh() / (1.0 / radius + 1.0).acosh()).ceil().max(1.0)
}

/// Fourier symbols of ∫ψψ and of ∫ψ'ψ' of B-splines on a unit mesh, at an angle a node.
pub(super) fn spline_symbols(order: u32, angle: f64) -> (f64, f64) {
    let linear = (4.0 + 2.0 * angle.cos()) / 6.0;
    let quadratic = (66.0 + 52.0 * angle.cos() + 2.0 * (2.0 * angle).cos()) / 120.0;
    let cubic = (2416.0 + 2382.0 * angle.cos() + 240.0 * (2.0 * angle).cos() + 2.0 * (3.0 * angle).cos()) / 5040.0;
    let difference = 2.0 - 2.0 * angle.cos();
    match order {
        1 => (linear, difference),
        2 => (quadratic, difference * linear),
        _ => (cubic, difference * quadratic),
    }
}

fn bath_step(bath: &MeshBath, interaction: &ShallowWaterInteraction, time_step: f64) -> BathStep {
    let (length, speed) = (interaction.smoothing.length, interaction.wave_speed);
    match *bath {
        MeshBath::White {} => BathStep::without_memory(length.powi(3) / speed, time_step),
        MeshBath::Memory { epsilon, scheme, rate } => {
            let rate = epsilon
                * match rate {
                    BathRate::WaveSpeed => speed / length,
                    BathRate::Printed => length / speed,
                };
            BathStep::with_memory(scheme, epsilon * length.powi(2), rate, time_step)
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn splines_are_a_partition_of_unity_and_cubic_ones_as_stiff_as_measured() {
        for order in 1..=3 {
            let (mass, stiffness) = spline_symbols(order, 0.0);
            assert!((mass - 1.0).abs() < 1e-15 && stiffness == 0.0);
        }
        let water = ShallowWater {
            integrator: WaterIntegrator::default(),
            mesh: [64, 64],
            spline_order: 3,
            wave_speed: 1.0,
            rotation: 0.0,
            smoothing: Smoothing::default(),
            surface: Vec::new(),
            starts_still: true,
            bath: None,
            mass_unit: 1.0,
            carriers: 65_536,
            tracers: Vec::new(),
        };
        // 4p/dt² in units of c₀²/Δx², without smoothing.
        let stiffness = 4.0 * water.stability([64.0, 64.0], 1.0);
        assert!((stiffness - 1.1).abs() < 0.05, "{stiffness}");
    }
}
