//! Whether a scene can be run with as many particles as a file or molecules have, before these are read or placed.

use super::super::semantics;
use crate::document::{Interaction, Placement, Problems, Scene, SceneError, number_of_copies};
use crate::families::{self, Checked, StepCheck};
use crate::numbers::counted;
use crate::state_file::{self, Mistake};
use std::cell::RefCell;

/// Decides whether a scene can be run. It has the particles of the whole one, but nothing that joins them and no analyses: what does not
/// fit without these does not fit with them.
pub type Fits<'a> = dyn Fn(&Checked) -> Result<(), SceneError> + 'a;

/// Particles that are read or placed in less time than an adapter takes to be asked.
const FEW: u64 = 1_000_000;

/// A scene whose particles are counted, and who decides of it.
pub(super) struct Weighing<'a> {
    scene: &'a Scene,
    fits: Option<&'a Fits<'a>>,
    /// Why the particles of a file were refused, if it was not the file's own mistake.
    pub refusal: RefCell<Option<SceneError>>,
}

impl<'a> Weighing<'a> {
    pub(super) fn of(scene: &'a Scene, fits: Option<&'a Fits<'a>>) -> Self {
        Self { scene, fits, refusal: RefCell::default() }
    }

    /// Decides of so many particles of a file.
    pub(super) fn file(&self, count: u64) -> Result<(), Mistake> {
        let copies = self.scene.state.as_ref().map_or(1, |state| number_of_copies(state.copies()));
        let mut counts = vec![0; self.scene.particles.len()];
        // A file may say at its end which species they are of, and where its box is.
        if let Some(first) = counts.first_mut() {
            *first = count.saturating_mul(copies);
        }
        self.decide(&counts).map_err(|refusal| {
            *self.refusal.borrow_mut() = Some(refusal);
            Mistake::new("", format!("found {}", counted(count, "particle")), "fewer")
        })
    }

    /// Decides of molecules that are right by themselves, for which so much memory is free.
    pub(super) fn molecules(&self, free: Option<u64>, problems: &mut Problems) -> Result<(), SceneError> {
        // The first group of a species has all beads of it.
        let mut counts = vec![0_u64; self.scene.particles.len()];
        for molecule in &self.scene.molecules {
            let copies = molecule.resolved_count(self.scene.space.volume());
            for bead in &molecule.beads {
                let count = &mut counts[super::group_of(self.scene, bead)];
                *count = count.saturating_add(copies);
            }
        }
        let all = counts.iter().copied().fold(0, u64::saturating_add);
        let Err(mistake) = state_file::fits_in_memory(all, free) else { return self.decide(&counts) };
        problems.add(super::MOLECULES, mistake.found, mistake.accepted);
        Ok(())
    }

    fn decide(&self, counts: &[u64]) -> Result<(), SceneError> {
        let all = counts.iter().copied().fold(0, u64::saturating_add);
        let Some(fits) = self.fits.filter(|_| all > FEW) else { return Ok(()) };
        let bare = bare(self.scene, counts);
        let mut problems = semantics::check(&bare);
        // Its mistakes are those of the scene, and will be said in its words.
        if !problems.is_empty() {
            return Ok(());
        }
        let bare = Checked::presumed(bare);
        families::check(&bare, StepCheck::Allow, &mut problems);
        if problems.is_empty() { fits(&bare) } else { Ok(()) }
    }
}

/// The scene with so many particles in its groups, placed anyhow, and nothing that joins them.
fn bare(scene: &Scene, counts: &[u64]) -> Scene {
    let mut bare = scene.clone();
    (bare.state, bare.molecules) = (None, Vec::new());
    for (group, count) in bare.particles.iter_mut().zip(counts) {
        (group.count, group.number_density) = (Some(*count), None);
        (group.chain, group.file_type) = (None, None);
        group.placement = Placement::Random;
    }
    if let Some(interactions) = bare.system.interactions_mut() {
        interactions.retain(|one| !matches!(one, Interaction::Bonds(_) | Interaction::Angles(_)));
    }
    bare.output = scene.output.energies_alone();
    if bare.space.lengths.is_empty() {
        // A thin gas, which needs no more than a fluid.
        let edge = counts.iter().map(|count| *count as f64).sum::<f64>().cbrt();
        bare.space.lengths = vec![edge; 3];
    }
    bare
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    use crate::plan::{Hardware, Options};
    use crate::scene;
    use crate::scene::builtin;

    /// What is refused without bonds would not fit with them.
    #[test]
    fn a_bare_scene_needs_no_more_than_the_whole() {
        let mut weighed = 0;
        for builtin in builtin() {
            let scene = scene::parse(builtin.name, builtin.text, &[]).unwrap();
            if scene.molecules.is_empty() {
                continue;
            }
            weighed += 1;
            let counts: Vec<u64> = scene.particles.iter().map(|group| group.count.unwrap()).collect();
            let bare = bare(&scene, &counts);
            let mut problems = semantics::check(&bare);
            let bare = Checked::presumed(bare);
            families::check(&bare, StepCheck::Refuse, &mut problems);
            assert!(problems.is_empty(), "{}", builtin.name);
            let largest = |scene: &Checked| {
                let (hardware, options) = (Hardware::default(), Options::default());
                let plan = crate::run::plan(scene, hardware, options);
                (plan.particles, plan.largest_buffer())
            };
            let (whole, bare) = (largest(&scene), largest(&bare));
            assert!(bare.0 == whole.0 && bare.1 <= whole.1, "{}: {bare:?} {whole:?}", builtin.name);
        }
        assert!(weighed > 1);
    }

    /// Nine million beads are refused before the first is placed, which would take a minute and gigabytes.
    #[test]
    fn molecules_are_counted_before_they_are_placed() {
        let set = ["molecules.0.count=900000", "space.box=[150,150,150]"].map(str::to_owned);
        let refused = RefCell::new(Vec::new());
        let fits = |scene: &Checked| {
            refused.borrow_mut().push(scene.particles.iter().map(|group| group.count.unwrap()).sum::<u64>());
            Err(SceneError::TooManyParticles { reason: "no room".to_owned() })
        };
        let copolymer = scene::WrittenScene::read("diblock-copolymer").unwrap();
        let error = copolymer.clone().with(&set).check_fitting(&fits).unwrap_err();
        assert_eq!((error.to_string().as_str(), refused.borrow().as_slice()), ("no room", &[9_000_000][..]));
        // What is done in no time is not worth asking.
        assert!(copolymer.check_fitting(&fits).is_ok());
        let mut problems = Problems::default();
        let scene = scene::load("diblock-copolymer", &[]).unwrap();
        Weighing::of(&scene, None).molecules(Some(1000), &mut problems).unwrap();
        let mistakes: Vec<String> = problems.iter().map(ToString::to_string).collect();
        assert!(mistakes[0].contains(" particles, which take at least "), "{mistakes:?}");
    }
}
