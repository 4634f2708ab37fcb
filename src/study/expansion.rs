//! From what is to be varied to checked variants.

use super::error::{Mistake, StudyError};
use super::lists::each_once;
use super::naming::{self, ShortKeys};
use super::seeds::{SEED, check_seeds, following};
use super::variation::{Setting, Variation, settings};
use crate::families::{Checked, StepCheck};
use crate::scene::{self, SceneError, Stage, StateFiles, WrittenScene};
use serde_json::Value;

/// More variants than this are taken for a slip.
const MOST_VARIANTS: usize = super::seeds::MOST_RUNS;

/// Keys that the length of runs is made of: they cannot be varied where all runs cover the same simulated time.
pub(crate) const LENGTHS: [&str; 6] =
    ["time", "time.steps", "time.equilibration", "output", "output.energies", "output.energies.every"];

/// A scene, what is varied in it, and the variants that follow.
#[derive(Debug, Clone, PartialEq)]
pub struct Sweep {
    /// The scene, with the number of steps of all variants that do not set it.
    pub(crate) scene: WrittenScene,
    /// The scene as JSON.
    pub(crate) base: Value,
    pub(crate) vary: Vec<Variation>,
    pub(crate) also: Vec<Vec<Setting>>,
    /// Files that variants start from.
    pub(crate) files: StateFiles,
    variants: Vec<Variant>,
}

/// Why runs that cover a given time in steps of any length cannot have the stages of a scene, if it has some.
pub(crate) fn refusal_of_stages(scene: &Checked) -> Option<String> {
    let why = "all runs cover the same simulated time, with the numbers of one scene";
    (!scene.stages.is_empty())
        .then(|| format!("the scene has stages: {why}; accepted: a scene without, such as that of one stage"))
}

/// One scene of a sweep.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct Variant {
    /// Name of its directory: `friction=4.5`.
    pub name: String,
    /// What a legend calls it: `friction = 4.5`.
    pub label: String,
    /// What distinguishes it.
    pub settings: Vec<Setting>,
    /// The scene, with every default filled in.
    pub scene: Checked,
    /// Why a run of it alone would be refused: its time step is beyond what any scheme is stable with. Only where that is allowed.
    pub(crate) refusal: Option<String>,
    /// Number of the value of each variation; empty for a variant that is none of the combinations.
    pub(crate) places: Vec<usize>,
}

impl Sweep {
    /// Varies the scene in the file `source`, or the built-in scene of that name.
    ///
    /// Each of `vary` is a key with its values, `key=value,value,…` (see [`Variation::parse`]); there is a variant for
    /// every combination, the last key varying fastest. Each of `also` is one more variant, with settings
    /// `key=value,key=value,…` of its own. The overrides `set` apply to all of them, first. With `steps` all variants run for
    /// so many, as [`WrittenScene::for_steps`] does it.
    ///
    /// # Errors
    /// [`StudyError::Arguments`] or [`StudyError::Variants`] with all mistakes at once; [`StudyError::Scene`] when there is no
    /// such scene.
    ///
    /// ```
    /// use mesoscope::study::Sweep;
    /// let vary = ["interactions.0.friction=1,4.5", "time.step=0.02,0.04"].map(str::to_owned);
    /// let sweep = Sweep::load("dpd-fluid", &[], None, &vary, &[])?;
    /// assert_eq!(sweep.variants()[1].name, "friction=1,step=0.04");
    /// # Ok::<(), mesoscope::study::StudyError>(())
    /// ```
    pub fn load(
        source: &str,
        set: &[String],
        steps: Option<u64>,
        vary: &[String],
        also: &[String],
    ) -> Result<Self, StudyError> {
        let scene = WrittenScene::read(source)?.with(set).for_steps(steps);
        let files = StateFiles::of(&scene.name);
        Self::from_arguments(scene, vary, also, files, StepCheck::Refuse)
    }

    /// The same with `seeds` independent runs of each variant, with the seed of the scene and those that follow.
    ///
    /// # Errors
    /// As [`Self::load`], and [`StudyError::Arguments`] unless there are 1 to [`MOST_SEEDS`](super::MOST_SEEDS), and
    /// where the seed is varied.
    ///
    /// ```
    /// use mesoscope::study::Sweep;
    /// let sweep = Sweep::load_seeded("dpd-fluid", &["seed=7".to_owned()], None, &[], &[], 3)?;
    /// let names: Vec<&str> = sweep.variants().iter().map(|variant| variant.name.as_str()).collect();
    /// assert_eq!(names, ["seed=7", "seed=8", "seed=9"]);
    /// # Ok::<(), mesoscope::study::StudyError>(())
    /// ```
    pub fn load_seeded(
        source: &str,
        set: &[String],
        steps: Option<u64>,
        vary: &[String],
        also: &[String],
        seeds: u32,
    ) -> Result<Self, StudyError> {
        let keys = vary.iter().filter_map(|argument| Some(argument.split_once('=')?.0.trim()));
        check_seeds(seeds, 1, keys)?;
        let own = WrittenScene::read(source)?.with(set).seed()?;
        let all: Vec<String> = (0..seeds).map(|further| following(own, further).to_string()).collect();
        let vary: Vec<String> = vary.iter().cloned().chain([format!("{SEED}={}", all.join(","))]).collect();
        // A variant besides the combinations has each seed too, unless it sets one.
        let seeded = |argument: &String| -> Vec<String> {
            let has_own = settings(argument).is_ok_and(|settings| settings.iter().any(|setting| setting.key == SEED));
            if has_own {
                vec![argument.clone()]
            } else {
                all.iter().map(|seed| format!("{argument},{SEED}={seed}")).collect()
            }
        };
        let also: Vec<String> = also.iter().flat_map(seeded).collect();
        Self::load(source, set, steps, &vary, &also)
    }

    /// Varies a scene that was read already; `files` are those that its scenes start from, `step` is whether a variant
    /// may have a time step that cannot be stable.
    pub(crate) fn from_arguments(
        scene: WrittenScene,
        vary: &[String],
        also: &[String],
        files: StateFiles,
        step: StepCheck,
    ) -> Result<Self, StudyError> {
        let mut mistakes = Vec::new();
        let mut note = |option: &str, argument: &String, message: String| {
            mistakes.push(format!("`{option} {argument}`: {message}"));
        };
        let variation =
            |argument: &String| Variation::parse(argument).map_err(|message| note("--vary", argument, message)).ok();
        let read: Vec<Variation> = vary.iter().filter_map(variation).collect();
        let variant = |argument: &String| settings(argument).map_err(|message| note("--also", argument, message)).ok();
        let further: Vec<Vec<Setting>> = also.iter().filter_map(variant).collect();
        for (index, variation) in read.iter().enumerate() {
            let inside = |outer: &str, inner: &str| inner.strip_prefix(outer).is_some_and(|rest| rest.starts_with('.'));
            for earlier in &read[..index] {
                let (one, other) = (earlier.key.as_str(), variation.key.as_str());
                if one == other {
                    mistakes.push(format!("`{one}` is varied twice; name all its values in one `--vary`"));
                } else if inside(other, one) {
                    mistakes.push(format!("`{other}` replaces `{one}`, which is varied before it: vary one of them"));
                }
            }
        }
        if vary.is_empty() {
            mistakes.push("nothing is varied; accepted: `--vary key=value,value,…`".to_owned());
        }
        let count = read.iter().try_fold(1_usize, |count, variation| count.checked_mul(variation.values.len()));
        if count.is_none_or(|count| count > MOST_VARIANTS) {
            mistakes.push(format!("there are more than {MOST_VARIANTS} combinations of values to vary"));
        }
        StudyError::refuse(mistakes)?;
        let sweep = Self::new(scene, read, further, files, step)?;
        StudyError::refuse(sweep.without_effect())?;
        Ok(sweep)
    }

    /// The variants of a scene, all of which are checked.
    pub(crate) fn new(
        scene: WrittenScene,
        vary: Vec<Variation>,
        also: Vec<Vec<Setting>>,
        files: StateFiles,
        step: StepCheck,
    ) -> Result<Self, StudyError> {
        let Ok(base) = serde_json::from_str(scene.text.trim_start_matches('\u{feff}')) else {
            // The reader of scenes says what is wrong in better words.
            scene::parse(&scene.name, &scene.text, &scene.set)?;
            return Err(StudyError::mistake("the scene is not JSON"));
        };
        Self { scene, base, vary, also, files, variants: Vec::new() }.expand(step)
    }

    /// The variants, in order.
    #[must_use]
    pub fn variants(&self) -> &[Variant] {
        &self.variants
    }

    /// The keys that are varied and their values.
    #[must_use]
    pub fn variations(&self) -> &[Variation] {
        &self.vary
    }

    /// All keys that distinguish variants, in order.
    pub(crate) fn keys(&self) -> Vec<&str> {
        let varied = self.vary.iter().map(|variation| variation.key.as_str());
        each_once(varied.chain(self.also.iter().flatten().map(|setting| setting.key.as_str())))
    }

    /// Keys that are varied though the first stage sets them.
    fn without_effect(&self) -> Vec<String> {
        let first = self.variants.first().and_then(|variant| variant.scene.stages.first());
        let set: Vec<String> = first.into_iter().flat_map(Stage::keys).collect();
        let varied = self.keys().into_iter().filter(|key| set.iter().any(|known| known == key));
        varied
            .map(|key| format!("`{key}` has no effect, as the first stage sets it: vary `stages.0.set.{key}`"))
            .collect()
    }

    /// The same with its variants.
    fn expand(mut self, step: StepCheck) -> Result<Self, StudyError> {
        let counts: Vec<usize> = self.vary.iter().map(|variation| variation.values.len()).collect();
        let combined = combinations(&counts).into_iter().map(|places| {
            let setting = |(variation, place): (&Variation, &usize)| Setting {
                key: variation.key.clone(),
                value: variation.values[*place].clone(),
            };
            (self.vary.iter().zip(&places).map(setting).collect::<Vec<_>>(), places)
        });
        let further = self.also.iter().map(|settings| (settings.clone(), Vec::new()));
        let all: Vec<(Vec<Setting>, Vec<usize>)> = combined.chain(further).collect();
        let short = ShortKeys::of(&self.keys());
        let names = naming::distinct(all.iter().map(|(settings, _)| naming::directory(settings, &short)).collect());
        let mut variants = Vec::new();
        let mut mistakes: Vec<Mistake> = Vec::new();
        for ((settings, places), variant) in all.into_iter().zip(names) {
            let sets_steps = settings.iter().any(|setting| ["time", "time.steps"].contains(&setting.key.as_str()));
            let own: Vec<String> = settings.iter().map(Setting::argument).collect();
            let mut written = self.scene.clone().with(&own);
            written.steps = written.steps.filter(|_| !sets_steps);
            let read = |step| written.check_among(&self.files, step);
            let (found, refusal) = match (read(StepCheck::Refuse), step) {
                (Err(SceneError::Invalid { problems, .. }), StepCheck::Allow) => {
                    (read(StepCheck::Allow), problems.first().map(ToString::to_string))
                }
                (found, _) => (found, None),
            };
            match found {
                Ok(scene) => {
                    self.files.note(&scene);
                    // Values of one key differ, but a further variant may be one of the combinations.
                    let twin = variants.iter().find(|known: &&Variant| places.is_empty() && known.scene == scene);
                    if let Some(twin) = twin {
                        let message = format!("this is the scene of `{}` again; leave one of them out", twin.name);
                        mistakes.push(Mistake { variants: vec![variant], message });
                        continue;
                    }
                    let label = short.label(&settings);
                    variants.push(Variant { name: variant, label, settings, scene, refusal, places });
                }
                Err(error @ (SceneError::Read { .. } | SceneError::StateChanged { .. })) => return Err(error.into()),
                Err(error) => {
                    let message = error.to_string();
                    match mistakes.iter_mut().find(|known| known.message == message) {
                        Some(known) => known.variants.push(variant),
                        None => mistakes.push(Mistake { variants: vec![variant], message }),
                    }
                }
            }
        }
        self.variants = variants;
        if mistakes.is_empty() { Ok(self) } else { Err(StudyError::Variants { mistakes }) }
    }
}

/// Every combination of places, the last varying fastest.
fn combinations(counts: &[usize]) -> Vec<Vec<usize>> {
    counts.iter().fold(vec![Vec::new()], |shorter, count| {
        let longer = shorter.iter().flat_map(|places| (0..*count).map(move |place| [&places[..], &[place]].concat()));
        longer.collect()
    })
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    fn sweep(vary: &[&str], also: &[&str]) -> Result<Sweep, StudyError> {
        let owned = |texts: &[&str]| texts.iter().map(|text| (*text).to_owned()).collect::<Vec<_>>();
        Sweep::load("dpd-fluid", &owned(&["time.equilibration=0", "time.steps=100"]), None, &owned(vary), &owned(also))
    }

    fn names(sweep: &Sweep) -> Vec<&str> {
        sweep.variants().iter().map(|variant| variant.name.as_str()).collect()
    }

    #[test]
    fn several_keys_make_a_product() {
        let found = sweep(&["interactions.0.friction=1,4.5", "time.step=.01,.02,.04"], &[]).unwrap();
        assert_eq!(
            names(&found),
            [
                "friction=1,step=0.01",
                "friction=1,step=0.02",
                "friction=1,step=0.04",
                "friction=4.5,step=0.01",
                "friction=4.5,step=0.02",
                "friction=4.5,step=0.04"
            ]
        );
        let last = &found.variants()[5];
        assert_eq!((last.scene.time.step, last.scene.time.steps), (0.04, 100));
        assert_eq!((last.label.as_str(), last.places.as_slice()), ("friction = 4.5, step = 0.04", &[1, 2][..]));
    }

    #[test]
    fn a_variant_may_stand_further_the_product() {
        let found = sweep(&["interactions.0.friction=1,2"], &["integrator.type=cotter-reich,time.step=.01"]).unwrap();
        assert_eq!(names(&found), ["friction=1", "friction=2", "type=cotter-reich,step=0.01"]);
        assert_eq!(found.variants()[2].scene.time.step, 0.01);
        assert_eq!(found.keys(), ["interactions.0.friction", "integrator.type", "time.step"]);
        let twice = sweep(&["interactions.0.friction=1,2"], &["interactions.0.friction=2.0"]).unwrap_err();
        assert!(twice.to_string().contains("this is the scene of `friction=2` again"), "{twice}");
    }

    #[test]
    fn a_sweep_is_the_same_when_it_is_read_again() {
        let found = sweep(&["temperature=0.1,.30000000000000004", "space.box=[6,6,6],[7,7,7]"], &[]).unwrap();
        let text = serde_json::to_string(&(&found.base, &found.vary, &found.also)).unwrap();
        let (base, vary, also): (Value, _, _) = serde_json::from_str(&text).unwrap();
        let scene = WrittenScene { text: base.to_string(), ..found.scene.clone() };
        let mut again = Sweep::new(scene, vary, also, found.files.clone(), StepCheck::Refuse).unwrap();
        again.scene.text.clone_from(&found.scene.text);
        assert_eq!(again, found);
    }

    #[test]
    fn all_mistakes_are_named_with_their_variants() {
        let error = sweep(&["interactions.0.friction=-1,4.5,-2", "time.step=0,.04"], &[]).unwrap_err();
        let StudyError::Variants { mistakes } = &error else { unreachable!("{error}") };
        assert_eq!(mistakes.iter().map(|mistake| mistake.variants.len()).sum::<usize>(), 5);
        let text = error.to_string();
        for part in ["variant `friction=-1,step=0`: ", "`friction=4.5,step=0`", "found -2", "time.step: found 0"] {
            assert!(text.contains(part), "`{part}` is not in: {text}");
        }
        // A mistake of all is said once.
        let text = sweep(&["interactions.0.fricton=1,2"], &[]).unwrap_err().to_string();
        assert_eq!(text.matches("did you mean `friction`").count(), 1, "{text}");
        assert!(text.starts_with("variants `fricton=1`, `fricton=2`: "), "{text}");
    }

    #[test]
    fn wrong_arguments_are_named_all_at_once() {
        let text = sweep(&["time.step", "temperature=1,1"], &["seed"]).unwrap_err().to_string();
        for part in ["`--vary time.step`", "`--vary temperature=1,1`", "twice", "`--also seed`"] {
            assert!(text.contains(part), "`{part}` is not in: {text}");
        }
        assert!(sweep(&["seed=1,2", "seed=3,4"], &[]).unwrap_err().to_string().contains("varied twice"));
        let text = sweep(&["time.step=1,2", r#"time={"step":1,"steps":1}"#], &[]).unwrap_err().to_string();
        assert!(text.contains("`time` replaces `time.step`"), "{text}");
        assert!(sweep(&[], &["seed=1"]).unwrap_err().to_string().contains("nothing is varied"));
        let many: Vec<String> = (0..70).map(|number| number.to_string()).collect();
        let many = [format!("seed={}", many.join(",")), format!("temperature={}", many.join(","))];
        assert!(sweep(&[&many[0], &many[1]], &[]).unwrap_err().to_string().contains("more than 4096"));
        assert!(matches!(Sweep::load("no-such", &[], None, &["seed=1".to_owned()], &[]), Err(StudyError::Scene(_))));
    }
}
