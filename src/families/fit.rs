//! Whether a state is one of the scene that a plan was made for.

use super::Model;
use crate::numbers::counted;
use crate::plan::{Length, Plan};
use crate::state::{State, StateArray};

impl Plan {
    /// What a state has that a run of this model would not have left, if there is anything: arrays that are missing, too
    /// long or too many, species that are not those of the model, pairs of particles that do not exist.
    ///
    /// ```
    /// use mesoscope::plan::{Hardware, Options};
    /// use mesoscope::run::plan;
    /// use mesoscope::{families::initial_state, scene};
    ///
    /// let scene = scene::load("langevin-gas", &["interactions.1.bath={\"type\":\"memory\",\"rate\":1}".to_owned()])?;
    /// let model = scene.model();
    /// let plan = plan(&scene, Hardware::default(), Options::default());
    /// let mut state = initial_state(&scene);
    /// assert_eq!(plan.misfit(&state, model), None);
    /// state.position_baths.pop();
    /// let particles = state.len();
    /// let problem = format!("its `position_baths` have {} elements instead of {particles}", particles - 1);
    /// assert_eq!(plan.misfit(&state, model), Some(problem));
    /// # Ok::<(), scene::SceneError>(())
    /// ```
    #[must_use]
    pub fn misfit(&self, state: &State, model: &Model) -> Option<String> {
        self.wrong_length(state).or_else(|| wrong_species(state, model)).or_else(|| self.layout.wrong_content(state))
    }

    /// The arrays that a state of it has, and how long they are; it has no others.
    pub(crate) fn arrays(&self, count: usize) -> Vec<(StateArray, Length)> {
        let mut arrays = self.layout.arrays(count);
        if self.paths.are_followed() {
            arrays.push((StateArray::Images, Length::AfterFirstStep(count)));
        }
        arrays
    }

    fn wrong_length(&self, state: &State) -> Option<String> {
        let expected = self.arrays(state.len());
        StateArray::ALL.into_iter().find_map(|array| {
            let length = expected.iter().find(|(known, _)| *known == array);
            let length = length.map_or(Length::Exactly(0), |(_, length)| *length);
            let (found, expected) = (state.length(array), length.expected());
            let fits = length.allows(found, state.step);
            (!fits).then(|| format!("its `{}` have {found} elements instead of {expected}", array.name()))
        })
    }
}

fn wrong_species(state: &State, model: &Model) -> Option<String> {
    let mut counts = vec![0_u64; model.species.len()];
    for species in &state.species {
        match counts.get_mut(*species as usize) {
            Some(count) => *count += 1,
            None => return Some(format!("a particle is of species {species}, and there are {}", counts.len())),
        }
    }
    let wrong = (0..counts.len()).find(|species| counts[*species] != model.species[*species].count)?;
    let (found, asked) = (counts[wrong], model.species[wrong].count);
    Some(format!("{} of species {wrong} in place of {asked}", counted(found, "particle")))
}
