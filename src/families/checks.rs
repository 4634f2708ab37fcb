//! What can be told only of a scene without any other mistake: whether its time step can be stable, and its start.

use std::collections::HashSet;

use super::particles::scene::checks as couplings;
use super::particles::stability;
use super::start;
use super::voronoi::scene::{LIGHTEST, voronoi};
use crate::families::{Model, Voronoi};
use crate::scene::{BondPotential, InitialMasses, Interaction, Problem, Problems, Scene, SceneError};
use crate::state::State;

/// Particles up to which a start is tried where a scene is checked; a start of more is looked at when a run makes it.
const MOST_TRIED: u64 = 20_000;

/// All problems of a scene that makes sense otherwise.
pub(crate) fn check(scene: &Scene, problems: &mut Problems) {
    let needs_model = couplings::is_coupled(scene);
    if !needs_model && !has_requirements(scene) {
        return;
    }
    let model = Model::new(scene);
    if has_requirements(scene) && model.particle_count() <= MOST_TRIED {
        check_state(scene, &model, &start::initial_state(scene, &model), problems);
    }
    if needs_model {
        stability::check(scene, &model, problems);
    }
}

/// Refuses a start of more particles than a check of the scene tries.
///
/// ```
/// use mesoscope::families::Model;
/// use mesoscope::scene::{self, placement};
///
/// // Springs that reach no further than 0.9 beside chains of spacing 1.
/// let spring = r#"interactions.1.potential={"type":"fene","stiffness":30,"extent":0.9,"length":0}"#;
/// let set = [spring.to_owned(), "particles.0.count=40000".to_owned(), "space.box=[40,40,40]".to_owned()];
/// let scene = scene::load("polymer-melt", &set)?;
/// let model = Model::new(&scene);
/// let refusal = families::check_start(&scene, &model, &start::initial_state(&scene, &model)).unwrap_err();
/// assert!(refusal.to_string().contains("potential.extent: found 0.9, and a distance of "));
/// # Ok::<(), scene::SceneError>(())
/// ```
///
/// # Errors
/// [`SceneError::Invalid`] where bonds are longer than they can be, or masses beyond what integers hold.
pub fn check_start(scene: &Scene, model: &Model, state: &State) -> Result<(), SceneError> {
    let mut problems = Problems::default();
    if model.particle_count() > MOST_TRIED {
        check_state(scene, model, state, &mut problems);
    }
    if problems.is_empty() {
        return Ok(());
    }
    let (problems, more) = problems.into_parts();
    Err(SceneError::Invalid { name: scene.title.clone(), problems, more })
}

/// Whether some starts of the scene would be refused.
fn has_requirements(scene: &Scene) -> bool {
    let finite = |interaction: &Interaction| match interaction {
        Interaction::Bonds(bonds) => matches!(bonds.potential, Some(BondPotential::Fene { .. })),
        _ => false,
    };
    scene.interactions.iter().any(finite)
        || voronoi(scene).is_some_and(|voronoi| voronoi.initial_masses != InitialMasses::Equal)
}

fn check_state(scene: &Scene, model: &Model, state: &State, problems: &mut Problems) {
    check_extents(scene, model, state, problems);
    if let Some(cells) = model.voronoi() {
        check_masses(scene, cells, &state.masses, problems);
    }
}

/// A bond of finite extent cannot start longer than it can be.
fn check_extents(scene: &Scene, model: &Model, state: &State, problems: &mut Problems) {
    let Some(bonds) = model.bonds() else { return };
    let finite = |kind: u32| match bonds.kinds[kind as usize].potential {
        Some(BondPotential::Fene { extent, length, .. }) => Some((extent, length)),
        _ => None,
    };
    if (0..bonds.kinds.len()).all(|kind| finite(kind as u32).is_none()) {
        return;
    }
    let places: Vec<usize> = (0..scene.interactions.len())
        .filter(|index| matches!(scene.interactions[*index], Interaction::Bonds(_)))
        .collect();
    let mut told = HashSet::new();
    for bond in bonds.iter() {
        let Some((extent, length)) = finite(bond.kind) else { continue };
        let [a, b] = bond.ends.map(|end| state.positions[end as usize]);
        let distance = model.units.displacement(a, b).iter().map(|part| part * part).sum::<f64>().sqrt();
        if (distance - length).abs() >= extent && told.insert(bond.kind) {
            let path = format!("interactions[{}].potential.extent", places[bond.kind as usize]);
            let found = format!(
                "found {extent}, and a distance of {distance:.6} between particles {} and {} at the start",
                bond.ends[0], bond.ends[1]
            );
            let accepted = format!(
                "more than {:.6}, by which that bond starts off its length {length}; or a start with shorter bonds",
                (distance - length).abs()
            );
            problems.push(Problem::new(path, found, accepted));
        }
    }
}

/// Masses that follow from the volumes of cells have to be such as the integers can hold.
fn check_masses(scene: &Scene, cells: &Voronoi, masses: &[u32], problems: &mut Problems) {
    let Some(voronoi) = voronoi(scene).filter(|voronoi| voronoi.initial_masses != InitialMasses::Equal) else { return };
    let [low, high] = [LIGHTEST * 2_f64.powi(24), f64::from(u32::MAX)];
    // What is beyond the range of integers is at its end.
    let fits = |mass: u32| f64::from(mass) >= low && mass < u32::MAX;
    let Some(cell) = masses.iter().position(|mass| !fits(*mass)) else { return };
    let name = if voronoi.initial_masses == InitialMasses::UniformDensity { "density" } else { "pressure" };
    let mass = f64::from(masses[cell]) * cells.mass_unit;
    let most = if masses[cell] == u32::MAX { " or more" } else { "" };
    let found =
        format!("found `uniform-{name}`, with a mass of {mass:.3e}{most} by the volume of the cell of particle {cell}");
    let accepted = format!(
        "masses between {:.1e} and {:.1e}: a more even placement, as a lattice, or `equal` masses",
        low * cells.mass_unit,
        high * cells.mass_unit
    );
    let path = scene.interactions.iter().position(|interaction| matches!(interaction, Interaction::Voronoi(_)));
    problems.push(Problem::new(format!("interactions[{}].initial_masses", path.unwrap_or(0)), found, accepted));
}
