//! What a tradeoff is asked for.

use super::length::Length;
use super::reference::{Reference, References};
use super::target::Target;
use super::{fields, measures};
use crate::families::{Checked, StepCheck};
use crate::run;
use crate::scene::{AnalysisId, SceneError, StateFiles, WrittenScene};
use crate::study::{
    self, LENGTHS, Setting, StudyError, Sweep, Variant, Variation, check_seeds, each_once, following, further_seed,
    settings,
};
use serde::{Deserialize, Serialize};

/// Names of the runs that give references.
pub(super) const FINER: &str = "finer";
pub(super) const COARSER: &str = "finer-twice-the-step";
pub(super) const STILL_FINER: &str = "still-finer";

/// A scene, what of it to vary, for how long to run it, and what to compare it with.
#[derive(Debug, Clone, PartialEq)]
pub struct Request {
    pub(super) arguments: Arguments,
    pub(super) sweep: Sweep,
    /// The scene before anything is varied.
    pub(super) base: Checked,
}

/// A request as it is written into the summary, and read from there.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub(super) struct Arguments {
    /// The scene.
    #[serde(flatten)]
    pub scene: WrittenScene,
    /// Keys and their values.
    pub vary: Vec<String>,
    /// Further choices.
    pub also: Vec<String>,
    /// Settings of the run that references are taken from.
    pub finer: Option<String>,
    /// Further settings of a run that says how far that one is off.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub still_finer: Option<String>,
    /// How long to run.
    pub length: Length,
    /// References of the user.
    pub references: References,
    /// What a choice is to reach.
    pub targets: Vec<Target>,
    /// Measures to assess; all usual ones if empty.
    pub measures: Vec<String>,
    /// Independent runs of each choice; none for one.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub seeds: Option<u32>,
    /// The files that runs start from.
    #[serde(default, skip_serializing_if = "StateFiles::is_empty")]
    pub state_files: StateFiles,
}

impl Arguments {
    /// The scene with further overrides; its step may be too large, for what becomes of it is a result.
    pub(super) fn scene(&self, own: impl IntoIterator<Item = String>) -> Result<Checked, SceneError> {
        let own: Vec<String> = own.into_iter().collect();
        self.scene.clone().with(&own).check_among(&self.state_files, StepCheck::Allow)
    }
}

impl Request {
    /// Varies the scene in a file, or a built-in one, as [`Sweep::load`] does, but for time steps that cannot be
    /// stable: they are run, too. With
    /// `steps` the scene has so many, to which its equilibration is shortened where it does not fit, as
    /// [`crate::scene::WrittenScene::for_steps`] does it; an override of `time.steps` is such a number too.
    ///
    /// # Errors
    /// [`StudyError::Variants`] or [`StudyError::Arguments`] with all mistakes at once; [`StudyError::Scene`] when there is no such scene.
    pub fn load(
        source: &str,
        set: &[String],
        steps: Option<u64>,
        vary: &[String],
        also: &[String],
    ) -> Result<Self, StudyError> {
        let scene = study::written_scene(source, set, steps)?;
        let (state_files, vary, also) = (StateFiles::of(&scene.name), vary.to_vec(), also.to_vec());
        Self::new(Arguments { scene, vary, also, state_files, ..Arguments::default() })
    }

    /// The request of a summary, or of a command line.
    pub(super) fn new(mut arguments: Arguments) -> Result<Self, StudyError> {
        let Arguments { scene, vary, also, .. } = &arguments;
        let varied = vary.iter().filter_map(|argument| Some(Variation::parse(argument).ok()?.key));
        let further = also.iter().filter_map(|argument| settings(argument).ok()).flatten().map(|setting| setting.key);
        let keys: Vec<String> = varied.chain(further).collect();
        let why = "all choices cover the same simulated time; --steps, --error and --budget say how much";
        let mistake = |key: &str| format!("`{key}` cannot be varied: {why}");
        let lengths = LENGTHS.into_iter().filter(|key| keys.iter().any(|known| known == key));
        StudyError::refuse(lengths.map(mistake).collect())?;
        let files = arguments.state_files.clone();
        let sweep = Sweep::from_arguments(scene.clone(), vary, also, files, StepCheck::Allow)?;
        StudyError::refuse(
            sweep.variants().first().and_then(|variant| study::refusal_of_stages(&variant.scene)).into_iter().collect(),
        )?;
        if sweep.variants().iter().any(|variant| [FINER, COARSER, STILL_FINER].contains(&variant.name.as_str())) {
            let mistake = format!("`{FINER}` and `{STILL_FINER}` are names of runs that references are taken from");
            return Err(StudyError::mistake(mistake));
        }
        arguments.state_files = sweep.files.clone();
        let base = arguments.scene.check_among(&arguments.state_files, StepCheck::Allow)?;
        arguments.state_files.note(&base);
        Ok(Self { arguments, sweep, base })
    }

    /// The same for so long.
    #[must_use]
    pub fn with_length(mut self, length: Length) -> Self {
        self.arguments.length = length;
        self
    }

    /// The same with references that the user gives.
    ///
    /// # Errors
    /// [`StudyError::Arguments`] names those of measures that no run has.
    pub fn with_references(mut self, references: References) -> Result<Self, StudyError> {
        self.check_names("--reference", references.measures())?;
        self.arguments.references = references;
        Ok(self)
    }

    /// The same with `seeds` independent runs of each choice, with the seed of the scene and those that follow: means
    /// are taken over them, with standard errors from their scatter.
    ///
    /// # Errors
    /// [`StudyError::Arguments`] unless there are 1 to [`study::MOST_SEEDS`], and where the seed is varied.
    pub fn with_seeds(mut self, seeds: u32) -> Result<Self, StudyError> {
        check_seeds(seeds, self.sweep.variants().len(), self.sweep.keys())?;
        self.arguments.seeds = (seeds > 1).then_some(seeds);
        Ok(self)
    }

    /// The independent runs of each choice.
    pub(crate) fn seeds(&self) -> u32 {
        self.arguments.seeds.unwrap_or(1)
    }

    /// The seed that is `further` places after that of the scene.
    pub(super) fn seed(&self, further: u32) -> u64 {
        following(self.base.seed, further)
    }

    /// The scenes of all choices and of the runs that references are taken from with the seed that is `further` places
    /// after that of the scene: each is read with it, for places and noise follow from it where particles start.
    pub(super) fn scenes(&self, further: u32) -> Result<Vec<Checked>, StudyError> {
        let seed = further_seed(self.base.seed, further);
        let choice = |variant: &Variant| match &seed {
            None => Ok(variant.scene.clone()),
            Some(seed) => {
                let own = variant.settings.iter().map(Setting::argument).chain([seed.clone()]);
                self.arguments.scene(own).map_err(|source| StudyError::of_variant(&variant.name, source))
            }
        };
        let mut scenes = self.sweep.variants().iter().map(choice).collect::<Result<Vec<_>, _>>()?;
        scenes.extend(self.finer_scenes(seed.as_deref())?.into_iter().map(|(_, scene)| scene));
        Ok(scenes)
    }

    /// The reference of a measure that is known before anything runs.
    pub(super) fn known(&self, measure: &str) -> Option<Reference> {
        self.arguments.references.known(measure, &self.base)
    }

    /// Those of some measures that are not known to be zero: errors of the others are no parts of anything, and more samples make them no
    /// smaller parts.
    pub(super) fn with_parts(&self, measures: &[String]) -> Vec<String> {
        let has_parts = |measure: &&String| !self.known(measure).is_some_and(|reference| reference.is_zero());
        measures.iter().filter(has_parts).cloned().collect()
    }

    /// The same with targets, whose measures are assessed too.
    ///
    /// # Errors
    /// [`StudyError::Arguments`] names those of measures that no run has, and parts of what is known to be zero.
    pub fn with_targets(mut self, targets: Vec<Target>) -> Result<Self, StudyError> {
        self.check_names("--target", targets.iter().map(|target| target.measure.as_str()))?;
        let of_nothing = |target: &Target| target.part_of_nothing(&self.known(&target.measure)?);
        StudyError::refuse(targets.iter().filter_map(of_nothing).collect())?;
        self.arguments.targets = targets;
        Ok(self)
    }

    /// The same, which assesses these measures.
    ///
    /// # Errors
    /// [`StudyError::Arguments`] names those that no run has.
    pub fn with_measures(mut self, measures: &[String]) -> Result<Self, StudyError> {
        self.check_names("--measure", measures.iter().map(String::as_str))?;
        self.arguments.measures = each_once(self.arguments.measures.into_iter().chain(measures.iter().cloned()));
        Ok(self)
    }

    /// The same, whose references are those of a run with the settings `finer`, `key=value,key=value,…`, instead of half the smallest time
    /// step. A run with the settings `still_finer` beside those says how far that one is off in them: what they change is added to the
    /// uncertainty of its references.
    ///
    /// # Errors
    /// [`StudyError::Arguments`] if they are not settings, [`StudyError::Variants`] if they make no scene.
    pub fn with_finer(mut self, finer: Option<&str>, still_finer: Option<&str>) -> Result<Self, StudyError> {
        for (option, argument) in [("--finer", finer), ("--still-finer", still_finer)] {
            argument.map_or(Ok(()), |argument| check_finer(option, argument))?;
        }
        [self.arguments.finer, self.arguments.still_finer] = [finer, still_finer].map(|asked| asked.map(str::to_owned));
        for (_, scene) in self.finer_scenes(None)? {
            self.arguments.state_files.note(&scene);
        }
        Ok(self)
    }

    /// The names of the runs that references are taken from.
    pub(super) fn finer_names(&self) -> Vec<&'static str> {
        let still_finer = self.arguments.still_finer.as_ref().map(|_| STILL_FINER);
        [FINER, COARSER].into_iter().chain(still_finer).collect()
    }

    /// The run that references are taken from, and those that say how good they are: one with twice its step, and one that is finer
    /// still where that is asked for.
    fn finer_scenes(&self, seed: Option<&str>) -> Result<Vec<(&'static str, Checked)>, StudyError> {
        let smallest =
            self.sweep.variants().iter().map(|variant| variant.scene.time.step).fold(self.base.time.step, f64::min);
        let asked = |argument: &Option<String>| -> Vec<Setting> {
            argument.as_deref().and_then(|argument| settings(argument).ok()).unwrap_or_default()
        };
        let [finer, still_finer] = [&self.arguments.finer, &self.arguments.still_finer].map(asked);
        let step_of = |asked: &[Setting]| asked.iter().rev().find(|one| one.key == "time.step")?.value.as_f64();
        let step = step_of(&finer).unwrap_or(0.5 * smallest);
        let scene = |name: &'static str| {
            let further = if name == STILL_FINER { &still_finer[..] } else { &[] };
            let step = if name == COARSER { 2.0 * step } else { step_of(further).unwrap_or(step) };
            let asked = finer.iter().chain(further).map(Setting::argument).chain([format!("time.step={step}")]);
            let asked = asked.chain(seed.map(str::to_owned));
            let scene = self.arguments.scene(asked).map_err(|source| StudyError::of_variant(name, source))?;
            Ok((name, scene))
        };
        self.finer_names().into_iter().map(scene).collect()
    }

    /// Whether a choice is to reach something.
    #[must_use]
    pub fn has_targets(&self) -> bool {
        !self.arguments.targets.is_empty()
    }

    /// The scene before anything is varied.
    #[must_use]
    pub fn base(&self) -> &Checked {
        &self.base
    }

    /// Keys among those varied that change what is simulated, and not only how it is computed.
    pub(super) fn physical_keys(&self) -> Vec<&str> {
        let refines = self.base.model().physics().is_resolved_by_particles();
        let is_physical = |key: &&str| {
            let last = key.rsplit('.').next().unwrap_or_default();
            if refines && last == "count" {
                return false;
            }
            ["temperature", "space", "particles"].iter().any(|start| key.starts_with(start))
                || key.starts_with("interactions") && OF_PHYSICS.contains(&last)
        };
        self.sweep.keys().into_iter().filter(is_physical).collect()
    }

    /// Looks for names of measures that no run has.
    fn check_names<'a>(&self, option: &str, wanted: impl Iterator<Item = &'a str>) -> Result<(), StudyError> {
        let asked = run::asked_analyses(&self.base);
        let found = asked.iter().flat_map(|asked| asked.found.iter().map(|number| (asked.id.name(), number)));
        let found = found.map(|(analysis, number)| format!("{analysis}.{number}"));
        let fields = fields::names(fields::compared(&self.base).into_iter(), fields::DISTANCE);
        let curve = AnalysisId::RadialDistribution.name();
        let has_curve = asked.iter().any(|asked| asked.id.name() == curve);
        let curve = has_curve.then(|| format!("{curve}{}", fields::DISTANCE));
        let accepted: Vec<String> =
            measures::names(&self.base).into_iter().chain(found).chain(fields).chain(curve).collect();
        let accepted: Vec<&str> = accepted.iter().map(String::as_str).collect();
        StudyError::refuse(wanted.filter_map(|name| measures::unknown(option, name, &accepted)).collect())
    }
}

/// Refuses what is no setting of a finer run.
fn check_finer(option: &str, argument: &str) -> Result<(), StudyError> {
    let mistake = |message: String| StudyError::mistake(format!("`{option} {argument}`: {message}"));
    for setting in settings(argument).map_err(mistake)? {
        if LENGTHS.contains(&setting.key.as_str()) {
            return Err(mistake(format!("`{}` follows from the choices", setting.key)));
        }
        if setting.key == "time.step" && setting.value.as_f64().is_none() {
            return Err(mistake(format!("time.step: found {}; accepted: a number", setting.value)));
        }
    }
    Ok(())
}

/// Keys of interactions that say what these are, and not how they are computed.
const OF_PHYSICS: [&str; 10] = [
    "repulsion",
    "friction",
    "viscosity",
    "stiffness",
    "cutoff",
    "strength",
    "bjerrum_length",
    "width",
    "field",
    "frequency",
];

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    fn request(vary: &[&str]) -> Result<Request, StudyError> {
        let owned: Vec<String> = vary.iter().map(|text| (*text).to_owned()).collect();
        Request::load("dpd-fluid", &[], None, &owned, &[])
    }

    #[test]
    fn lengths_cannot_be_varied() {
        let text = request(&["time.steps=100,200"]).unwrap_err().to_string();
        assert!(text.contains("`time.steps` cannot be varied"), "{text}");
    }

    #[test]
    fn unknown_measures_are_named_with_the_nearest() {
        let request = request(&["time.step=0.02,0.04"]).unwrap();
        let text = request.clone().with_measures(&["presure".to_owned()]).unwrap_err().to_string();
        assert!(text.contains("did you mean `pressure`?"), "{text}");
        assert!(request.clone().with_measures(&["radial_distribution.peak_height".to_owned()]).is_ok());
        let target = |text: &str| request.clone().with_targets(vec![Target::parse(text).unwrap()]);
        assert!(target("colour=1%").is_err());
        let text = target("radial_distribution.peak_hight=1%").unwrap_err().to_string();
        assert!(text.contains("did you mean `radial_distribution.peak_height`?"), "{text}");
    }

    #[test]
    fn nothing_is_a_part_of_zero() {
        let request = request(&["time.step=0.02,0.04"]).unwrap();
        let target = |request: &Request, text: &str| request.clone().with_targets(vec![Target::parse(text).unwrap()]);
        let text = target(&request, "momentum_x=1%").unwrap_err().to_string();
        assert!(
            text.contains("the reference of `momentum_x` is 0") && text.contains("--target momentum_x=VALUE"),
            "{text}"
        );
        assert!(target(&request, "momentum_x=0.01").is_ok() && target(&request, "pressure=1%").is_ok());
        let given = request.with_references(References::parse(&["pressure=0".to_owned()]).unwrap()).unwrap();
        assert!(target(&given, "pressure=1%").is_err() && target(&given, "pressure=0.1").is_ok());
        let uncertain = request_with("pressure=0.02+-0.03");
        let text = target(&uncertain, "pressure=1%").unwrap_err().to_string();
        assert!(text.contains("the reference of `pressure` cannot be told from 0"), "{text}");
        // More samples make no parts of what should be zero.
        let measures = ["momentum_x", "pressure", "temperature"].map(str::to_owned);
        assert_eq!(uncertain.with_parts(&measures), ["temperature"]);
        assert_eq!(request_with("pressure=0.02+-0.009").with_parts(&measures), ["pressure", "temperature"]);
    }

    fn request_with(reference: &str) -> Request {
        let references = References::parse(&[reference.to_owned()]).unwrap();
        request(&["time.step=0.02,0.04"]).unwrap().with_references(references).unwrap()
    }

    #[test]
    fn references_come_from_half_the_smallest_step_unless_the_user_says_otherwise() {
        let request = request(&["time.step=0.02,0.04"]).unwrap();
        let steps = |request: &Request| -> Vec<f64> {
            request.finer_scenes(None).unwrap().into_iter().map(|(_, scene)| scene.time.step).collect()
        };
        assert_eq!(steps(&request), [0.01, 0.02]);
        let finer = Some("time.step=0.005,integrator.type=groot-warren");
        let asked = request.clone().with_finer(finer, None).unwrap();
        assert_eq!(steps(&asked), [0.005, 0.01]);
        assert!(request.clone().with_finer(Some("integrator.type=none"), None).is_err());
        // The still finer run has the settings of the finer one, its own, and the step of either.
        let still = request.clone().with_finer(finer, Some("integrator.lambda=0.65")).unwrap();
        assert_eq!(steps(&still), [0.005, 0.01, 0.005]);
        let scenes = still.finer_scenes(None).unwrap();
        assert_eq!(scenes.iter().map(|(name, _)| *name).collect::<Vec<_>>(), still.finer_names());
        let same_but_for = |scene: &Checked| scene.clone().changed(|scene| scene.system = scenes[0].1.system.clone());
        assert_ne!(scenes[2].1, scenes[0].1);
        assert_eq!(same_but_for(&scenes[2].1), scenes[0].1);
        assert_eq!(steps(&request.clone().with_finer(finer, Some("time.step=0.0025")).unwrap()), [0.005, 0.01, 0.0025]);
        let text = request.with_finer(finer, Some("time.steps=7")).unwrap_err().to_string();
        assert!(text.contains("`--still-finer time.steps=7`: `time.steps` follows from the choices"), "{text}");
    }
}
