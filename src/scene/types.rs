//! The typed form of a scene file.

pub use crate::noise::Generator;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A simulation scene: everything a run needs to know.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Scene {
    /// Where an editor finds the schema of this file; ignored by the program.
    #[serde(rename = "$schema", default, skip_serializing_if = "Option::is_none")]
    pub schema: Option<String>,
    /// Version of the scene format.
    #[serde(default = "current_version")]
    #[schemars(range(min = 1, max = 1))]
    pub version: u32,
    /// One line that names the scene; it heads every plot.
    #[schemars(length(min = 1))]
    pub title: String,
    /// What the scene is for and what to expect of it.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub description: String,
    /// Seed of every random number in the run.
    #[serde(default)]
    pub seed: u64,
    /// The simulation box.
    pub space: Space,
    /// The clock.
    pub time: Time,
    /// Temperature kT of the heat bath, in units of energy. Zero leaves the noise out.
    #[schemars(range(min = 0.0))]
    pub temperature: f64,
    /// How the equations of motion are integrated.
    #[serde(default)]
    pub integrator: Integrator,
    /// How random numbers are made.
    #[serde(default)]
    pub noise: Noise,
    /// Groups of particles.
    #[schemars(length(max = 1024))]
    pub particles: Vec<ParticleGroup>,
    /// Forces between particles.
    #[serde(default)]
    #[schemars(length(max = 256))]
    pub interactions: Vec<Interaction>,
    /// What the run writes.
    #[serde(default)]
    pub output: Output,
}

fn current_version() -> u32 {
    1
}

/// An orthogonal periodic box.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Space {
    /// Edge lengths, one for each dimension of the scene: one, two or three.
    #[serde(rename = "box")]
    #[schemars(length(min = 1, max = 3), extend("items" = serde_json::json!({"type": "number", "exclusiveMinimum": 0})))]
    pub lengths: Vec<f64>,
}

/// Time step and duration.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Time {
    /// Time step.
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub step: f64,
    /// Number of steps.
    pub steps: u64,
    /// Steps at the start that averages and correlations leave out.
    #[serde(default)]
    pub equilibration: u64,
}

/// How the equations of motion are integrated.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(tag = "type", rename_all = "kebab-case", deny_unknown_fields)]
pub enum Integrator {
    /// Splitting A(½) B(½) O B(½) A(½) with the pair velocities relaxed at the half-drifted positions; one neighbour
    /// traversal a step. The default: both temperatures within about one
    /// per cent at a step of 0.04 in the standard fluid; with strong friction it runs cold. In Voronoi DPD O is friction
    /// and noise by Crank-Nicolson.
    Splitting {},
    /// Groot and Warren's modified velocity Verlet scheme, doi:10.1063/1.474784.
    GrootWarren {
        /// Weight λ of the predicted velocity that enters the friction.
        #[serde(default = "half")]
        #[schemars(range(min = 0.0, max = 1.0))]
        lambda: f64,
    },
    /// The Markov limit (18)-(21) of Cotter and Reich, doi:10.1209/epl/i2003-00621-8: friction from the discrete
    /// gradient of the coupling function. With memory, and for couplings other than pairs, their scheme (14)-(17): the
    /// default of scenes that have those.
    CotterReich {},
    /// Shallow water: kick(½) G kick(½), where G is the exact flow of free particles that the rotation bends into
    /// circles. Symplectic in its magnetic form, so that the circulation of material loops is kept at any time step.
    /// The default of scenes of shallow water.
    Gyro {},
    /// Shallow water: R(½) kick(½) drift kick(½) R(½) with R the rotation of velocities alone.
    Rotate {},
    /// Voronoi DPD: the explicit scheme of Euler, as printed by Flekkøy, Coveney and De Fabritiis,
    /// doi:10.1103/PhysRevE.62.2140. Hot by 2 % at a time step of 0.005 where `splitting` is right at 0.16.
    Euler {},
}

impl Integrator {
    /// The name in a scene.
    #[must_use]
    pub fn name(&self) -> &'static str {
        match self {
            Self::Splitting {} => "splitting",
            Self::GrootWarren { .. } => "groot-warren",
            Self::CotterReich {} => "cotter-reich",
            Self::Gyro {} => "gyro",
            Self::Rotate {} => "rotate",
            Self::Euler {} => "euler",
        }
    }
}

fn half() -> f64 {
    0.5
}

impl Default for Integrator {
    fn default() -> Self {
        Self::Splitting {}
    }
}

/// How random numbers are made.
#[derive(Debug, Clone, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Noise {
    /// The counter-based generator.
    #[serde(default)]
    pub generator: Generator,
    /// The distribution of the noise on a pair without memory; all other noise is Gaussian.
    #[serde(default)]
    pub distribution: Distribution,
}

/// The distribution of a pair's noise; both have zero mean and unit variance.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Distribution {
    /// Uniform on (-√3, √3): enough for a sum over many pairs and steps, and the cheapest (default). Long steps show what
    /// it lacks: it raises the configurational temperature of `groot-warren` by 0.003 at a step of 0.06.
    #[default]
    Uniform,
    /// Gaussian, by Box and Muller's transform; a step takes 7 to 17 % longer.
    Gaussian,
}

/// A group of particles of one species.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(transform = one_amount)]
pub struct ParticleGroup {
    /// Name of the species; groups of the same species share their mass.
    #[schemars(length(min = 1))]
    pub species: String,
    /// Number of particles; give this or `number_density`, or list `placement.positions`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub count: Option<u64>,
    /// Particles per unit volume (area in two dimensions); the count is rounded to the nearest integer.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = 0.0))]
    pub number_density: Option<f64>,
    /// Mass of one particle. Left out in shallow water, where the surface makes it.
    #[serde(default = "one")]
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub mass: f64,
    /// Shallow water: particles without mass, which drift along. The circulation of a tracer group on a circle is
    /// measured.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub tracer: bool,
    /// Whether the particles are held where they start.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub fixed: bool,
    /// Chains that the particles form, one after the other; left out, none.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub chain: Option<Chain>,
    /// Where the particles start.
    #[serde(default)]
    pub placement: Placement,
    /// How fast they start.
    #[serde(default)]
    pub velocities: Velocities,
}

fn one() -> f64 {
    1.0
}

/// Tells other readers of the schema that a group says in exactly one way how many particles it has.
fn one_amount(schema: &mut schemars::Schema) {
    let given = |key: &str| serde_json::json!({"required": [key], "properties": {key: {"type": "number"}}});
    let listed = serde_json::json!({
        "required": ["placement"],
        "properties": {"placement": {"properties": {"type": {"const": "listed"}}}},
    });
    schema.insert("if".to_owned(), listed);
    schema.insert("then".to_owned(), serde_json::json!({"properties": {"number_density": {"type": "null"}}}));
    schema.insert("else".to_owned(), serde_json::json!({"oneOf": [given("count"), given("number_density")]}));
}

/// Chains of particles with consecutive numbers; `bonds` and `angles` act along them.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Chain {
    /// Particles in a chain; those of the group are a whole number of chains.
    #[schemars(range(min = 2))]
    pub beads: u32,
    /// Distance of neighbours along a chain at the start.
    #[serde(default = "one")]
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub spacing: f64,
    /// Whether the last particle of a chain is bonded to the first.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub closed: bool,
}

/// Where the particles of a group start.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(tag = "type", rename_all = "kebab-case", deny_unknown_fields)]
pub enum Placement {
    /// Independent uniform positions.
    #[default]
    #[serde(rename_all = "kebab-case")]
    Random,
    /// The smallest nearly cubic (square) lattice that holds the group, filled evenly.
    Lattice {
        /// Largest random shift of a particle along each axis, as a part of the spacing. Not for chains.
        #[serde(default, skip_serializing_if = "is_zero")]
        #[schemars(range(min = 0.0, max = 1.0))]
        jitter: f64,
    },
    /// Positions listed one by one; each is taken modulo the box.
    Listed {
        /// One position per particle.
        positions: Vec<Vec<f64>>,
    },
    /// Evenly on a circle, counterclockwise; two dimensions only.
    Circle {
        /// Centre.
        center: [f64; 2],
        /// Radius.
        #[schemars(extend("exclusiveMinimum" = 0))]
        radius: f64,
    },
}

#[expect(clippy::trivially_copy_pass_by_ref, reason = "serde hands over references")]
fn is_zero(value: &f64) -> bool {
    *value == 0.0
}

impl Placement {
    /// Whether the particles start on a lattice, shifted or not.
    #[must_use]
    pub fn is_lattice(&self) -> bool {
        matches!(self, Self::Lattice { .. })
    }
}

/// A feature of the surface of shallow water, periodic in the box.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(tag = "type", rename_all = "kebab-case", deny_unknown_fields)]
pub enum SurfaceFeature {
    /// Two opposed fronts along x, amplitude·tanh(sin(η)/width) with η = y + meander·(sin 3x - sin 2x), where x and y
    /// run from 0 to 2π over the box. In balance a pair of jets, which is unstable.
    Front {
        /// Depth on the higher side.
        amplitude: f64,
        /// Width of the fronts.
        #[schemars(extend("exclusiveMinimum" = 0))]
        width: f64,
        /// Amplitude of the disturbance.
        #[serde(default)]
        meander: f64,
    },
    /// A hill (a hollow where negative), Gaussian near its centre: amplitude·exp(-Σ(1 - cos κ(x - x₀))/(κ·radius)²)
    /// with κ = 2π over the edge of the box. In balance a vortex.
    Bump {
        /// Centre.
        center: [f64; 2],
        /// Standard deviation.
        #[schemars(extend("exclusiveMinimum" = 0))]
        radius: f64,
        /// Height.
        amplitude: f64,
    },
    /// A plane wave amplitude·cos(2π(n₁x/L₁ + n₂y/L₂)).
    Wave {
        /// Periods across the box on each axis.
        periods: [i32; 2],
        /// Height.
        amplitude: f64,
    },
}

/// How fast the particles of a group start.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(tag = "type", rename_all = "kebab-case", deny_unknown_fields)]
pub enum Velocities {
    /// Maxwell's distribution at the temperature of the scene; the net momentum of all thermal groups together is
    /// removed to the last bit.
    #[default]
    Thermal,
    /// At rest.
    Rest,
    /// Shallow water: in balance between rotation and the slope of the smoothed surface, V = (c₀²/f₀)(-∂H/∂y, ∂H/∂x).
    Geostrophic,
    /// Voronoi DPD: a transverse wave `u_x = amplitude sin(2π periods y/L)` on top of Maxwell's distribution.
    ShearWave {
        /// The largest velocity.
        amplitude: f64,
        /// Number of waves in the box.
        #[serde(default = "one_period")]
        #[schemars(range(min = 1, max = 64))]
        periods: u32,
    },
    /// Velocities listed one by one.
    Listed {
        /// One velocity per particle.
        velocities: Vec<Vec<f64>>,
    },
}

fn one_period() -> u32 {
    1
}

/// A force between particles.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(tag = "type", rename_all = "kebab-case", deny_unknown_fields)]
pub enum Interaction {
    /// Dissipative particle dynamics: soft repulsion a(1 - r/rc), friction and noise along the line of centres.
    Dpd(DpdInteraction),
    /// Friction and noise on every particle by itself: Langevin dynamics, with memory a generalised Langevin equation.
    Langevin(LangevinInteraction),
    /// A random force on every particle that is constant for random times.
    ColouredNoise(ColouredNoiseInteraction),
    /// A spring from every particle to where it started: V = K(r - r₀)²/2.
    Tether(TetherInteraction),
    /// Bonds along chains, or between listed particles: a potential, and friction and noise along the bond.
    Bonds(BondsInteraction),
    /// Stiffness of chains: V = k(1 + cos θ) for each angle θ between bonds, least where the chain is straight.
    Angles(AnglesInteraction),
    /// Harmonic chains of beads and of clusters side by side, with their particles; the only interaction of a scene.
    HarmonicChain(super::HarmonicChainInteraction),
    /// Rotating shallow water by the Hamiltonian particle-mesh method, with a heat bath on the mesh if asked for.
    ShallowWater(ShallowWaterInteraction),
    /// Voronoi DPD: particles that are the cells of a tessellation, with friction, noise and pressure at their faces.
    Voronoi(super::VoronoiInteraction),
}

/// Rotating shallow water on particles and a periodic mesh: Cotter and Reich, doi:10.1209/epl/i2003-00621-8.
///
/// The mean depth is 1; depth is measured in mass a mesh node.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ShallowWaterInteraction {
    /// Mesh nodes on each axis.
    #[schemars(extend("items" = serde_json::json!({"type": "integer", "minimum": 1, "maximum": 4096})))]
    pub mesh: [u32; 2],
    /// Order of the B-splines between particles and mesh: 1 linear, 2 quadratic, 3 cubic (default). A lower order is
    /// cheaper and rougher.
    #[serde(default = "cubic")]
    #[schemars(range(min = 1, max = 3))]
    pub spline_order: u32,
    /// Speed c₀ of gravity waves.
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub wave_speed: f64,
    /// Coriolis parameter f₀, of du/dt = f₀v, dv/dt = -f₀u: positive in the northern hemisphere. The equations as Cotter and
    /// Reich print them turn the other way, which is a negative value here. Zero leaves the rotation out.
    #[serde(default)]
    pub rotation: f64,
    /// The smoothing of the depth that drives the particles.
    #[serde(default)]
    pub smoothing: Smoothing,
    /// The smoothed surface at the start, as features that are added to a depth of 1; the masses of the particles follow
    /// from it. Left out, the water is flat.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    #[schemars(length(max = 100))]
    pub surface: Vec<SurfaceFeature>,
    /// A heat bath on every mesh node.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub bath: Option<MeshBath>,
}

fn cubic() -> u32 {
    3
}

/// The smoothing (1 - Λ²∇²)^-power of the depth.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Smoothing {
    /// Length Λ; zero leaves the smoothing out.
    #[schemars(range(min = 0.0))]
    pub length: f64,
    /// How often it is applied.
    #[schemars(range(min = 1, max = 2))]
    pub power: u32,
    /// How it is computed.
    pub solver: SmoothingSolver,
}

impl Default for Smoothing {
    fn default() -> Self {
        Self { length: 0.0, power: 1, solver: SmoothingSolver::default() }
    }
}

/// How the smoothing is computed: a fixed symmetric positive operator on the mesh in any case, so that energy is kept.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(tag = "type", rename_all = "kebab-case", deny_unknown_fields)]
pub enum SmoothingSolver {
    /// By fast Fourier transform, to rounding (default). Mesh edges are powers of two.
    Fft {
        /// What stands for the Laplacian.
        #[serde(default)]
        symbol: LaplacianSymbol,
    },
    /// By a Chebyshev polynomial of the five-point Laplacian, started from zero and so positive at any length. For any
    /// mesh. The rougher its tolerance, the cheaper; `fft` was cheaper still on all meshes that it takes.
    Chebyshev {
        /// Bound on the relative error of every Fourier mode of (1 - Λ²∇²)⁻¹.
        #[serde(default = "millionth")]
        #[schemars(extend("exclusiveMinimum" = 0, "exclusiveMaximum" = 1))]
        tolerance: f64,
    },
}

fn millionth() -> f64 {
    1e-6
}

impl Default for SmoothingSolver {
    fn default() -> Self {
        Self::Fft { symbol: LaplacianSymbol::default() }
    }
}

/// What stands for the Laplacian in Fourier space.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum LaplacianSymbol {
    /// The five-point difference: -Σ (2 sin(kΔx/2)/Δx)² (default).
    #[default]
    FivePoint,
    /// The exact derivative: -k².
    Spectral,
}

/// A heat bath on every mesh node, coupled to the depth there: equation (26) of Cotter and Reich,
/// doi:10.1209/epl/i2003-00621-8.
///
/// It acts on the mesh, through which the water flows, and so slows a uniform flow down too: it is not Galilean
/// invariant.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(tag = "type", rename_all = "kebab-case", deny_unknown_fields)]
pub enum MeshBath {
    /// Exponential memory with coupling λ = εΛ² and rate α = εc₀/Λ.
    Memory {
        /// Strength ε. At fixed λ/α, a large value is the limit without memory.
        #[schemars(range(min = 0.0))]
        epsilon: f64,
        /// The scheme of the bath step.
        #[serde(default)]
        scheme: BathScheme,
        /// Where the rate comes from.
        #[serde(default)]
        rate: BathRate,
    },
    /// White noise and friction γ = Λ³/c₀, the limit without memory: equations (18)-(21).
    White {},
}

/// The heat bath of a coupling function h: doi:10.1209/epl/i2003-00621-8.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(tag = "type", rename_all = "kebab-case", deny_unknown_fields)]
pub enum Bath {
    /// Friction and noise without memory: the force -∇h (γ dh/dt + √(2kTγ) dW/dt).
    White {
        /// Temperature kT of this bath; left out, that of the scene.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        #[schemars(range(min = 0.0))]
        temperature: Option<f64>,
    },
    /// Exponential memory: the force -s∇h with ds = -αs dt + λ dh + √(2kTλα) dW, where λ = αγ. For a fast bath the limit
    /// without memory.
    Memory {
        /// Rate α at which the bath forgets.
        #[schemars(range(min = 0.0))]
        rate: f64,
        /// Coupling λ, in place of a friction: what a bath that never forgets (α = 0) is given by.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        #[schemars(range(min = 0.0))]
        coupling: Option<f64>,
        /// The scheme of the bath step.
        #[serde(default)]
        scheme: BathScheme,
        /// Temperature kT of this bath; left out, that of the scene.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        #[schemars(range(min = 0.0))]
        temperature: Option<f64>,
    },
}

impl Default for Bath {
    fn default() -> Self {
        Self::White { temperature: None }
    }
}

impl Bath {
    /// Whether this is the bath of a scene that does not mention one.
    #[must_use]
    pub fn is_plain(&self) -> bool {
        *self == Self::default()
    }

    /// The temperature of the bath in a scene of a temperature.
    #[must_use]
    pub fn temperature(&self, scene: f64) -> f64 {
        match self {
            Self::White { temperature } | Self::Memory { temperature, .. } => temperature.unwrap_or(scene),
        }
    }
}

/// The scheme of a bath step with memory.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum BathScheme {
    /// Equation (16) of Cotter and Reich, stable for any rate (default).
    #[default]
    CotterReich,
    /// Their symmetric variant, the implicit midpoint rule.
    Symmetric,
    /// The exact Ornstein-Uhlenbeck step.
    Exponential,
}

/// Where the rate of a mesh bath comes from.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum BathRate {
    /// α = εc₀/Λ (default): then γ = λ/α = Λ³/c₀, as the paper says.
    #[default]
    WaveSpeed,
    /// α = εΛ/c₀, as the paper prints it.
    Printed,
}

/// Parameters of a DPD interaction.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct DpdInteraction {
    /// Range rc of all pair forces.
    #[serde(default = "one")]
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub cutoff: f64,
    /// Exponent of the friction weight ω = (1 - r/rc)^exponent; 2 is the standard choice.
    #[serde(default = "two")]
    #[schemars(range(min = 0.0))]
    pub weight_exponent: f64,
    /// Repulsion a of every pair of species not listed in `pairs`; all zero leaves the conservative force out.
    #[serde(default)]
    pub repulsion: f64,
    /// Friction γ of every pair of species not listed in `pairs`; the noise follows from σ² = 2γkT.
    #[serde(default)]
    #[schemars(range(min = 0.0))]
    pub friction: f64,
    /// Pairs of species with coefficients of their own.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    #[schemars(length(max = 32896))]
    pub pairs: Vec<DpdPair>,
    /// The heat bath of every pair, coupled to φ(r) with φ' = √ω.
    #[serde(default, skip_serializing_if = "Bath::is_plain")]
    pub bath: Bath,
    /// Margin of the neighbour list beyond the cutoff, where the scene needs a list: with memory, or beside couplings
    /// other than pairs. A wide one is built less often and holds more pairs; no result but the noise depends on it.
    #[serde(default = "default_skin")]
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub skin: f64,
}

fn default_skin() -> f64 {
    0.3
}

/// Friction and noise on every particle by itself, coupled to its coordinates.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct LangevinInteraction {
    /// Friction γ of every species not listed in `species`, a force per velocity.
    #[serde(default)]
    #[schemars(range(min = 0.0))]
    pub friction: f64,
    /// Species with a friction of their own.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    #[schemars(length(max = 256))]
    pub species: Vec<SpeciesFriction>,
    /// The heat bath of every coordinate.
    #[serde(default, skip_serializing_if = "Bath::is_plain")]
    pub bath: Bath,
}

/// The friction of one species.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct SpeciesFriction {
    /// The species.
    pub name: String,
    /// Friction γ.
    #[schemars(range(min = 0.0))]
    pub friction: f64,
}

/// A random force on every particle that stays constant for random times: the dynamics of Borreguero, Ellero and Adams.
/// It acts on particles one by one, so that momentum is not conserved.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ColouredNoiseInteraction {
    /// Mean square α of the force.
    #[schemars(range(min = 0.0))]
    pub strength: f64,
    /// Correlation time: ε of `kangaroo` and `literal`, τ of `short`.
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub time: f64,
    /// The process.
    #[serde(default)]
    pub process: NoiseProcess,
}

/// How a coloured noise jumps.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum NoiseProcess {
    /// Random directions held for ε/φ with φ = √U: zero mean, isotropic and stationary, with an algebraic tail
    /// C(t) = α(1 - t/2ε) up to ε and αε/2t beyond (default).
    #[default]
    Kangaroo,
    /// The same with exponentially distributed holding times of mean ε/φ: C(t) = α(ε/t)(1 - exp(-t/ε)).
    KangarooExponential,
    /// Holding times of mean τ whatever the direction: C(t) = α exp(-t/τ).
    Short,
    /// As the paper prints it, equations (8) and (9): two dimensions only. Its mean is not zero and it ages.
    Literal,
}

/// A spring from every particle to where it started.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct TetherInteraction {
    /// Spring constant K.
    #[schemars(range(min = 0.0))]
    pub stiffness: f64,
}

/// Bonds along chains, or between listed particles.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct BondsInteraction {
    /// Species whose chains are bonded; left out, all chains.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(length(max = 256))]
    pub species: Option<Vec<String>>,
    /// Pairs of particle numbers to bond, in place of chains.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub pairs: Vec<[u32; 2]>,
    /// The potential; left out, none.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub potential: Option<BondPotential>,
    /// Friction γ along the bond.
    #[serde(default)]
    #[schemars(range(min = 0.0))]
    pub friction: f64,
    /// The heat bath of every bond, coupled to its length.
    #[serde(default, skip_serializing_if = "Bath::is_plain")]
    pub bath: Bath,
    /// Whether bonded particles are spared each other's repulsion.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub exclude_repulsion: bool,
}

/// The potential of a bond of length r.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(tag = "type", rename_all = "kebab-case", deny_unknown_fields)]
pub enum BondPotential {
    /// V = K(r - r₀)²/2.
    Harmonic {
        /// Spring constant K.
        #[schemars(range(min = 0.0))]
        stiffness: f64,
        /// Length r₀ at rest.
        #[serde(default)]
        #[schemars(range(min = 0.0))]
        length: f64,
    },
    /// Finitely extensible: V = -K R²/2 ln(1 - (r - r₀)²/R²), doi:10.1063/1.458541 with r₀ = 0.
    Fene {
        /// Spring constant K.
        #[schemars(range(min = 0.0))]
        stiffness: f64,
        /// Largest extension R.
        #[schemars(extend("exclusiveMinimum" = 0))]
        extent: f64,
        /// Length r₀ at rest.
        #[serde(default)]
        #[schemars(range(min = 0.0))]
        length: f64,
    },
}

/// Stiffness of chains, or of listed triples.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct AnglesInteraction {
    /// Species whose chains are stiff; left out, all chains.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(length(max = 256))]
    pub species: Option<Vec<String>>,
    /// Triples of particle numbers, the middle of the angle in the middle, in place of chains.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub triples: Vec<[u32; 3]>,
    /// Stiffness k.
    pub stiffness: f64,
}

fn two() -> f64 {
    2.0
}

/// Coefficients of one pair of species.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct DpdPair {
    /// The two species; the same name twice for a species with itself.
    pub between: [String; 2],
    /// Repulsion a; left out, that of the interaction.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub repulsion: Option<f64>,
    /// Friction γ; left out, that of the interaction.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = 0.0))]
    pub friction: Option<f64>,
}

/// What the run measures and writes. Everything optional is off, and free, unless it is asked for.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Output {
    /// The table of energies.
    #[serde(default)]
    pub energies: Energies,
    /// The look of the plots.
    #[serde(default)]
    pub plot: PlotStyle,
    /// Pictures of the particles.
    #[serde(default)]
    pub snapshot: Snapshot,
    /// Checkpoints to resume from.
    #[serde(default)]
    pub checkpoint: Checkpoint,
    /// Positions and velocities for other tools.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub trajectory: Option<Trajectory>,
    /// The radial distribution function g(r).
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub radial_distribution: Option<RadialDistribution>,
    /// Mean squared displacement and velocity autocorrelation.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub diffusion: Option<Diffusion>,
    /// Sizes of chains: distance of the ends and radius of gyration.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub chain_sizes: Option<ChainSizes>,
    /// Shear viscosity from the decay of transverse momentum waves.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub viscosity: Option<Viscosity>,
    /// Tables and plots of harmonic chains.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub chain: Option<super::ChainOutput>,
    /// Normalised autocorrelations of velocities and forces, each quantity at most once.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    #[schemars(length(max = 16))]
    pub autocorrelations: Vec<Autocorrelation>,
    /// Histograms of velocities and accelerations, each quantity at most once.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    #[schemars(length(max = 16))]
    pub histograms: Vec<Histogram>,
    /// How many neighbours Voronoi cells have, as a table and a plot.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub neighbours: Option<Neighbours>,
    /// The decay of the shear wave that Voronoi cells start with, and the shear viscosity that follows from it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub shear_wave: Option<ShearWave>,
    /// Fields on the mesh of shallow water, as pictures and arrays; left out, depth and potential vorticity at the end.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub fields: Option<Fields>,
}

/// The histogram of the numbers of neighbours of Voronoi cells, after equilibration.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Neighbours {
    /// Steps between two samples.
    #[schemars(range(min = 1))]
    pub every: u64,
}

/// The decay of the wave of `velocities` of type `shear-wave`, after equilibration.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ShearWave {
    /// Steps between two samples: long against the time in which friction relaxes a single cell, short against the
    /// decay of the wave.
    #[schemars(range(min = 1))]
    pub every: u64,
}

/// Fields on the mesh, as pictures and arrays.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Fields {
    /// Steps between two numbered pictures and arrays; zero writes them only at the end.
    pub every: u64,
    /// Which fields.
    #[schemars(length(max = 16))]
    pub quantities: Vec<FieldQuantity>,
    /// Ranges of colours.
    pub ranges: FieldRanges,
}

impl Default for Fields {
    fn default() -> Self {
        let quantities = vec![FieldQuantity::Depth, FieldQuantity::PotentialVorticity];
        Self { every: 0, quantities, ranges: FieldRanges::default() }
    }
}

/// The lowest and the highest value on the scale of colours of each field, of all pictures of the run. What is left out
/// follows from the first of several numbered pictures, or fits the only one.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct FieldRanges {
    /// Of the depth, in mean depths.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub depth: Option<[f64; 2]>,
    /// Of the potential vorticity.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub potential_vorticity: Option<[f64; 2]>,
    /// Of the vorticity.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub vorticity: Option<[f64; 2]>,
    /// Of the speed of the flow.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub speed: Option<[f64; 2]>,
}

impl FieldRanges {
    /// The range of a field, if it is given.
    ///
    /// ```
    /// use mesoscope::scene::{FieldQuantity, FieldRanges};
    /// let ranges = FieldRanges { depth: Some([0.8, 1.2]), ..FieldRanges::default() };
    /// assert_eq!(ranges.of(FieldQuantity::Depth), Some([0.8, 1.2]));
    /// assert_eq!(ranges.of(FieldQuantity::Speed), None);
    /// ```
    #[must_use]
    pub fn of(&self, quantity: FieldQuantity) -> Option<[f64; 2]> {
        match quantity {
            FieldQuantity::Depth => self.depth,
            FieldQuantity::PotentialVorticity => self.potential_vorticity,
            FieldQuantity::Vorticity => self.vorticity,
            FieldQuantity::Speed => self.speed,
        }
    }
}

/// A field on the mesh of shallow water.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum FieldQuantity {
    /// The smoothed depth h.
    Depth,
    /// The potential vorticity (ζ + f₀)/h with ζ = ∂v/∂x - ∂u/∂y.
    PotentialVorticity,
    /// The vorticity ζ.
    Vorticity,
    /// The speed of the flow.
    Speed,
}

/// The table of energies.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Energies {
    /// Steps between two rows.
    #[schemars(range(min = 1))]
    pub every: u64,
}

impl Default for Energies {
    fn default() -> Self {
        Self { every: 20 }
    }
}

/// The look of the plots.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct PlotStyle {
    /// Width of a plot in pixels.
    #[schemars(range(min = 320, max = 8192))]
    pub width: u32,
    /// Height of a plot in pixels; left out, three quarters of the width, and for fields what the shape of the box asks for.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = 240, max = 8192))]
    pub height: Option<u32>,
    /// Factor on every type size and line width.
    #[schemars(range(min = 0.25, max = 8.0))]
    pub scale: f64,
    /// Light or dark.
    pub theme: Theme,
}

impl Default for PlotStyle {
    fn default() -> Self {
        Self { width: 1600, height: None, scale: 1.0, theme: Theme::Light }
    }
}

impl PlotStyle {
    /// Height of a plot in pixels.
    ///
    /// ```
    /// use mesoscope::scene::PlotStyle;
    /// assert_eq!(PlotStyle { width: 800, ..PlotStyle::default() }.height(), 600);
    /// assert_eq!(PlotStyle { height: Some(500), ..PlotStyle::default() }.height(), 500);
    /// ```
    #[must_use]
    pub fn height(&self) -> u32 {
        self.height.unwrap_or(self.width * 3 / 4)
    }
}

/// Colours of paper and ink.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Theme {
    /// Dark ink on white (default).
    #[default]
    Light,
    /// Light ink on near-black.
    Dark,
}

/// Pictures of the particles.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Snapshot {
    /// Steps between two numbered pictures `snapshot-<number>.png`; zero writes only `snapshot.png` at the end.
    pub every: u64,
    /// Width of a picture in pixels; left out, what the shape of the box asks for.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = 64, max = 8192))]
    pub width: Option<u32>,
    /// Height of a picture in pixels; left out, what the shape of the box asks for. Without both the longer side has 1200.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = 64, max = 8192))]
    pub height: Option<u32>,
    /// Radius of the drawn discs in units of length; left out, a third of the cutoff.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub radius: Option<f64>,
    /// What the colour of a particle shows; left out, the species, or the density of Voronoi cells of one species.
    pub color: SnapshotColor,
    /// The lowest and the highest value on the scale of colours, of all pictures of the run; left out, they follow from the
    /// first picture and the temperature of the scene.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub range: Option<[f64; 2]>,
}

/// What the colour of a particle shows.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum SnapshotColor {
    /// The species.
    #[default]
    Species,
    /// The speed, on a perceptually uniform scale.
    Speed,
    /// Mass by volume; of Voronoi cells only.
    Density,
    /// The temperature inside; of Voronoi cells with internal energies only.
    Temperature,
}

/// Checkpoints to resume from.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Checkpoint {
    /// Steps between two checkpoints; each replaces the last. The end of the run is always one.
    #[schemars(range(min = 1))]
    pub every: u64,
    /// Minutes after which there is another checkpoint, wherever the run then is.
    #[schemars(range(min = 1))]
    pub minutes: u32,
}

impl Default for Checkpoint {
    fn default() -> Self {
        Self { every: 10_000, minutes: 10 }
    }
}

/// Positions and velocities for other tools.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Trajectory {
    /// Steps between two frames.
    #[schemars(range(min = 1))]
    pub every: u64,
    /// The file format.
    #[serde(default)]
    pub format: TrajectoryFormat,
}

/// The format of a trajectory.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum TrajectoryFormat {
    /// HOOMD's binary GSD, `trajectory.gsd` (default).
    #[default]
    Gsd,
    /// Extended XYZ text, `trajectory.xyz`.
    ExtendedXyz,
}

/// The radial distribution function g(r).
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct RadialDistribution {
    /// Steps between two samples.
    #[schemars(range(min = 1))]
    pub every: u64,
    /// Largest distance, at most half the shortest box edge.
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub range: f64,
    /// Number of bins.
    #[serde(default = "hundred_bins")]
    #[schemars(range(min = 1, max = 4096))]
    pub bins: u32,
}

fn hundred_bins() -> u32 {
    100
}

/// Mean squared displacement and velocity autocorrelation.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Diffusion {
    /// Steps between two samples.
    #[schemars(range(min = 1))]
    pub every: u64,
    /// Samples in one window; each window starts from a new origin and the windows are averaged.
    #[schemars(range(min = 2, max = 1_000_000))]
    pub window: u64,
}

/// Sizes of the chains of each group: squared distance of the ends and squared radius of gyration.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ChainSizes {
    /// Steps between two samples.
    #[schemars(range(min = 1))]
    pub every: u64,
}

/// Shear viscosity from the decay of the longest transverse momentum waves.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Viscosity {
    /// Steps between two samples.
    #[schemars(range(min = 1))]
    pub every: u64,
    /// Largest lag of the correlation, in samples.
    #[schemars(range(min = 8, max = 100_000))]
    pub window: u64,
}

/// The normalised autocorrelation ⟨A(0)·A(t)⟩ / ⟨A(0)²⟩ of a vector that every particle has.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Autocorrelation {
    /// What is correlated.
    pub quantity: CorrelatedQuantity,
    /// Steps between two samples.
    #[schemars(range(min = 1))]
    pub every: u64,
    /// Samples in one window; each window starts from a new origin and the windows are averaged.
    #[schemars(range(min = 2, max = 1_000_000))]
    pub window: u64,
    /// The curve fitted to it.
    #[serde(default)]
    pub fit: DecayFit,
    /// What velocities are relative to; left out, the box where momentum is conserved, else the centre of mass.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub frame: Option<Frame>,
}

/// A vector that every particle has and that can be correlated with itself.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum CorrelatedQuantity {
    /// The velocity, where the temperature is measured.
    Velocity,
    /// The change of momentum around the report over the time it takes: all forces, friction and noise included.
    /// With `splitting` it is that of the whole step, two half kicks and the relaxation between them.
    Force,
}

/// A curve fitted to a decay in time t.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum DecayFit {
    /// None (default).
    #[default]
    None,
    /// a exp(-bt).
    Exponential,
    /// a exp(-(bt)^c).
    StretchedExponential,
    /// exp(-at/2) \[cos Ωt + (a/2Ω) sin Ωt\], a damped oscillation, or overdamped where Ω² < 0.
    DampedOscillation,
}

/// What velocities are relative to.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Frame {
    /// The box.
    Box,
    /// The centre of mass of all particles at the same step.
    CentreOfMass,
}

/// A histogram over particles and steps, normalised to a probability density.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Histogram {
    /// What is counted.
    pub quantity: CountedQuantity,
    /// Steps between two samples.
    #[schemars(range(min = 1))]
    pub every: u64,
    /// Number of bins.
    #[serde(default = "hundred_bins")]
    #[schemars(range(min = 1, max = 1024))]
    pub bins: u32,
    /// Largest magnitude: components are counted from minus to plus this, speeds from zero. Left out, six times the
    /// thermal scale: of velocity √(kT/m), of acceleration √(kT/m) √(ω² + min(2Γ/dt, 4/dt²)) with the frequency ω of
    /// the repulsion and the rate Γ of the friction in the mean field of neighbours. What is beyond is counted apart.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub range: Option<f64>,
    /// The component that is counted; left out, all of them alike.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub axis: Option<Axis>,
    /// What velocities are relative to; left out, the box where momentum is conserved, else the centre of mass.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub frame: Option<Frame>,
}

/// What a histogram counts.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum CountedQuantity {
    /// Components of the velocity, where the temperature is measured.
    Velocity,
    /// The magnitude of the velocity.
    Speed,
    /// Components of the acceleration: the force that `autocorrelations` correlate over the mass.
    Acceleration,
}

/// An axis of the box.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Axis {
    /// The first.
    X,
    /// The second.
    Y,
    /// The third.
    Z,
}

impl FieldQuantity {
    /// What the names of its files begin with.
    #[must_use]
    pub fn stem(self) -> &'static str {
        match self {
            Self::Depth => "depth",
            Self::PotentialVorticity => "potential_vorticity",
            Self::Vorticity => "vorticity",
            Self::Speed => "speed",
        }
    }
}

impl CorrelatedQuantity {
    /// The name in a scene.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Velocity => "velocity",
            Self::Force => "force",
        }
    }
}

impl CountedQuantity {
    /// The name in a scene.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Velocity => "velocity",
            Self::Speed => "speed",
            Self::Acceleration => "acceleration",
        }
    }
}
