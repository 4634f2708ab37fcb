//! Kernels: an entry point with chosen variants, constants and a size.

use super::Plan;
use crate::noise::Generator;
use crate::shaders::{self, Array, Choices, Constant, Entry};
use std::collections::BTreeSet;

/// A kernel: its entry point and variants, its constants and its size.
#[derive(Debug, Clone, PartialEq)]
pub struct Kernel {
    /// What it does, in a word or two.
    pub name: &'static str,
    /// Its entry point.
    pub entry: Entry,
    /// The variants chosen for it; those of slots that it does not reach have no effect.
    pub choices: Choices,
    /// Number of workgroups.
    pub workgroups: u32,
    /// The position of its number of workgroups in the buffer `demands`, which has three words for each, if that depends on the step.
    pub demand: Option<u32>,
    /// Constants of this kernel only; all others come from [`Plan::constants`].
    pub constants: Vec<(Constant, f64)>,
    /// Variables in whose place it has another buffer or texture: `(variable, in its place)`.
    pub renamed: Vec<(Array, Array)>,
    /// Whether it may take so long that it has to be the last of a submission: systems with a watchdog end a submission that takes
    /// seconds.
    pub takes_long: bool,
}

impl Kernel {
    /// A kernel of at least one workgroup, without constants of its own.
    pub(crate) fn new(name: &'static str, entry: Entry, choices: Choices, workgroups: u64) -> Self {
        Self {
            name,
            entry,
            choices,
            workgroups: workgroups.max(1) as u32,
            demand: None,
            constants: Vec::new(),
            renamed: Vec::new(),
            takes_long: false,
        }
    }

    /// Paths of the pages and variants that it reaches, below `shaders` and without extensions.
    ///
    /// ```
    /// use mesoscope::plan::{Hardware, Options};
    /// use mesoscope::run::plan;
    ///
    /// let scene = mesoscope::scene::load("dpd-fluid", &[])?;
    /// let plan = plan(&scene, Hardware::default(), Options::default());
    /// let step = &plan.kernels[plan.advance[0]];
    /// assert!(step.files()?.contains("pairs/pass/relax"));
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// [`shaders::Unlinked`] if it does not link.
    pub fn files(&self) -> Result<BTreeSet<&'static str>, shaders::Unlinked> {
        let linked = shaders::linked_text(self.entry, &self.choices)?;
        Ok(linked.parts.iter().map(|part| part.path).collect())
    }

    /// The same with constants of its own.
    pub(crate) fn with(self, constants: Vec<(Constant, f64)>) -> Self {
        Self { constants, ..self }
    }

    /// The same with other buffers and textures in the place of variables.
    pub(crate) fn renamed(self, renamed: Vec<(Array, Array)>) -> Self {
        Self { renamed, ..self }
    }

    /// The buffer or texture that a variable stands for.
    ///
    /// ```
    /// use mesoscope::plan::{Hardware, Options};
    /// use mesoscope::run::plan;
    /// use mesoscope::shaders::{Array, Entry};
    ///
    /// let asked = r#"output.viscosity={"every":10,"window":50}"#.to_owned();
    /// let scene = mesoscope::scene::load("dpd-fluid", &[asked])?;
    /// let plan = plan(&scene, Hardware::default(), Options::default());
    /// let kernel = plan.kernels.iter().find(|kernel| kernel.entry == Entry::SumTransverseModes);
    /// let array_of = |variable| kernel.map(|kernel| kernel.array_of(variable));
    /// assert_eq!(array_of(Array::PartialSums), Some(Array::ModeSums));
    /// assert_eq!(array_of(Array::Particles), Some(Array::Particles));
    /// # Ok::<(), mesoscope::scene::SceneError>(())
    /// ```
    #[must_use]
    pub fn array_of(&self, variable: Array) -> Array {
        self.renamed.iter().find(|(known, _)| *known == variable).map_or(variable, |(_, array)| *array)
    }

    /// Its own constants, then those of the plan that it does not set for itself.
    pub fn constants_in<'a>(&'a self, plan: &'a Plan) -> impl Iterator<Item = (Constant, f64)> + 'a {
        let own = |name: Constant| self.constants.iter().any(|(known, _)| *known == name);
        self.constants.iter().chain(plan.constants.iter().filter(move |(name, _)| !own(*name))).copied()
    }
}

/// A constant of a law that is there or not: what is not is taken out of kernels.
pub(crate) fn switch(constant: Constant, on: bool) -> (Constant, f64) {
    (constant, if on { 1.0 } else { 0.0 })
}

/// The constant that says what draws random words: `shaders/noise/generators.wgsl`.
pub(crate) fn generator(generator: Generator) -> (Constant, f64) {
    (Constant::Generator, if generator == Generator::Threefry2x32 { 0.0 } else { 1.0 })
}

/// Folds a number of workgroups into two dimensions of at most 65 535; a few of them may find nothing to do.
pub(crate) fn folded(workgroups: u32) -> [u32; 2] {
    const LIMIT: u32 = 65_535;
    if workgroups <= LIMIT {
        [workgroups, 1]
    } else {
        let height = workgroups.div_ceil(LIMIT);
        [workgroups.div_ceil(height), height]
    }
}

#[cfg(test)]
mod tests {
    use super::folded;

    #[test]
    fn folding_covers_every_workgroup() {
        for count in [1, 65_535, 65_536, 131_071, 1_000_000, 20_000_000] {
            let [width, height] = folded(count);
            assert!(width <= 65_535 && height <= 65_535);
            assert!(u64::from(width) * u64::from(height) >= u64::from(count));
        }
    }
}
