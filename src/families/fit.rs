//! Whether a state is one of the scene that a plan was made for.

use super::Model;
use crate::plan::{LARGEST_MASS, Layout, Listed, Plan};
use crate::state::State;

impl Plan {
    /// What a state has that a run of this model would not have left, if there is anything: arrays that are missing, too
    /// long or too many, species that are not those of the model, pairs of particles that do not exist.
    ///
    /// ```
    /// use mesoscope::families::Model;
    /// use mesoscope::plan::{Hardware, Options, plan};
    /// use mesoscope::{families::initial_state, scene};
    ///
    /// let scene = scene::load("langevin-gas", &["interactions.1.bath={\"type\":\"memory\",\"rate\":1}".to_owned()])?;
    /// let model = Model::new(&scene);
    /// let plan = plan(&model, 0, &scene.output, Hardware::default(), Options::default());
    /// let mut state = initial_state(&scene, &model);
    /// assert_eq!(plan.misfit(&state, &model), None);
    /// state.position_baths.pop();
    /// let particles = state.len();
    /// let problem = format!("its `position_baths` have {} elements instead of {particles}", particles - 1);
    /// assert_eq!(plan.misfit(&state, &model), Some(problem));
    /// # Ok::<(), scene::SceneError>(())
    /// ```
    #[must_use]
    pub fn misfit(&self, state: &State, model: &Model) -> Option<String> {
        let mut arrays = self.layout.lengths(state, self.paths.are_followed()).into_iter();
        arrays
            .find(|array| !array.fits())
            .map(|array| array.problem())
            .or_else(|| self.layout.wrong_content(state, model))
    }
}

impl Layout {
    /// What every array has, and what it should have.
    fn lengths(&self, state: &State, followed: bool) -> [Array; 12] {
        let count = state.len();
        let begun = state.step > 0;
        let all_if = |asked: bool| if asked { count } else { 0 };
        let (mut predicts, mut masses, mut energies, mut nodes) = (false, false, false, 0);
        let (mut remembers, mut baths, mut bonds, mut holds, mut tethers) = (false, false, 0, false, false);
        match *self {
            Self::Particles { predicted, .. } => predicts = predicted,
            Self::Water { bath_nodes, .. } => (masses, nodes) = (true, bath_nodes),
            Self::Cells { energies: kept } => (masses, energies) = (true, kept),
            Self::Coupled { predicted, listed, position_baths, bond_baths, holds: noise, tethers: tied, .. } => {
                predicts = predicted;
                remembers = matches!(listed, Some(Listed { memory: true, .. }));
                (baths, bonds, holds, tethers) = (position_baths, bond_baths, noise, tied);
            }
        }
        // What is made in the first step may be missing before it.
        let later = |name, found, expected| Array { name, found, expected, optional: !begun };
        let always = |name, found, expected| Array { name, found, expected, optional: false };
        [
            later("predicted", state.predicted.len(), all_if(predicts)),
            always("masses", state.masses.len(), all_if(masses)),
            always("energies", state.energies.len(), all_if(energies)),
            later("node_masses", state.node_masses.len(), nodes),
            always("node_bath", state.node_bath.len(), nodes),
            later("anchors", state.anchors.len(), all_if(remembers)),
            // There are as many pairs as there are.
            always("pair_baths", state.pair_baths.len(), if remembers { state.pair_baths.len() } else { 0 }),
            always("position_baths", state.position_baths.len(), all_if(baths)),
            always("bond_baths", state.bond_baths.len(), bonds),
            always("holds", state.holds.len(), all_if(holds)),
            always("tethers", state.tethers.len(), all_if(tethers)),
            later("images", state.images.len(), all_if(followed)),
        ]
    }

    fn wrong_content(&self, state: &State, model: &Model) -> Option<String> {
        let mut counts = vec![0_u64; model.species.len()];
        for species in &state.species {
            match counts.get_mut(*species as usize) {
                Some(count) => *count += 1,
                None => return Some(format!("a particle is of species {species}, and there are {}", counts.len())),
            }
        }
        if let Some(species) = (0..counts.len()).find(|species| counts[*species] != model.species[*species].count) {
            let (found, asked) = (counts[species], model.species[species].count);
            return Some(format!("{found} particles are of species {species} instead of {asked}"));
        }
        let heavy = |mass: &u32| f64::from(*mass) > LARGEST_MASS;
        if matches!(self, Self::Water { .. }) && state.masses.iter().any(heavy) {
            return Some(format!("a particle has a mass of more than {LARGEST_MASS} units"));
        }
        let exists = |id: u32| (id as usize) < state.len();
        let in_order = state.pair_baths.windows(2).all(|pair| {
            let [a, b] = [pair[0], pair[1]].map(|pair| (pair.first, pair.second));
            a < b
        });
        let wrong =
            state.pair_baths.iter().any(|pair| pair.first >= pair.second || !exists(pair.second) || pair.spared > 1);
        (wrong || !in_order).then(|| "its pairs are not those of its particles".to_owned())
    }
}

/// The length of an array of a state.
struct Array {
    name: &'static str,
    found: usize,
    expected: usize,
    /// Whether it may be missing.
    optional: bool,
}

impl Array {
    fn fits(&self) -> bool {
        self.found == self.expected || self.optional && self.found == 0
    }

    fn problem(&self) -> String {
        format!("its `{}` have {} elements instead of {}", self.name, self.found, self.expected)
    }
}
