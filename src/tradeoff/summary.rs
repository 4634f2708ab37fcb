//! The summary of a tradeoff, `tradeoff.json`.

use super::cost::Cost;
use super::deviation::Deviation;
use super::measures::Measured;
use super::reference::Reference;
use super::request::{Arguments, Request};
use super::run::Phase;
use super::stretch::Stretch;
use super::target::Verdict;
use super::{advice, charts, files, table};
use crate::families::StepCheck;
use crate::output::summary::AdapterSummary;
use crate::output::{Id, RunDirectory};
use crate::scene::{PlotStyle, SceneError, WrittenScene};
use crate::study::{self, ASKS_ELSE, Charts, Kind, Record, SEED, Setting, StudyError, TRADEOFF, Variant};
use serde::{Deserialize, Serialize};
use std::fmt;
use std::path::Path;

/// What was asked, and what every choice costs and misses.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct TradeoffSummary {
    /// Version of the program that began it.
    pub mesoscope_version: String,
    /// The day it was begun, as year, month and day.
    #[serde(default)]
    pub date: String,
    /// The id of the tradeoff, made of those of its runs.
    pub tradeoff_id: Id,
    /// The adapter it last computed on; none before it began.
    pub adapter: Option<AdapterSummary>,
    pub(super) arguments: Arguments,
    pub(super) stretch: Stretch,
    /// Seconds that the runs have taken so far, drawing included.
    pub spent: f64,
    /// Whether the runs are as long as they are going to be.
    pub(super) is_long_enough: bool,
    /// How often the runs were made longer.
    pub extensions: usize,
    /// Whether the budget, or the number of extensions, ended before the errors were as small as they were to be.
    pub is_short: bool,
    /// What more of runs is wanted, where that is so much that nobody but the user can say that it may be.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub wanted: Option<Wanted>,
    /// The measures that are assessed.
    pub measures: Vec<String>,
    /// What they are compared with.
    pub references: Vec<Reference>,
    /// Keys among those varied that change what is simulated.
    #[serde(default)]
    pub(super) physical_keys: Vec<String>,
    /// The choices, in order.
    pub choices: Vec<Choice>,
    /// The runs that references are taken from.
    pub finer: Vec<Choice>,
    /// The runs of all choices and of those that references are taken from with further seeds, seed by seed; the means
    /// of all seeds are in `choices` and `finer`.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub further_seeds: Vec<Choice>,
    /// The name of the cheapest choice that meets all targets.
    pub chosen: Option<String>,
}

/// How much longer runs have to become for what is asked for.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Wanted {
    /// How often they are to be made longer.
    pub rounds: usize,
    /// Seconds that all of them are expected to take in all by then.
    pub seconds: f64,
}

impl fmt::Display for Wanted {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        let rounds =
            if self.rounds == 1 { "one more round".to_owned() } else { format!("{} more rounds", self.rounds) };
        let duration = advice::duration(self.seconds);
        write!(formatter, "what is asked for takes {rounds} of longer runs, about {duration} of runs in all")
    }
}

/// One choice: a variant, what it costs and what it misses.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct Choice {
    /// Name of its directory.
    pub name: String,
    /// What a legend calls it.
    pub label: String,
    /// What distinguishes it from others.
    pub settings: Vec<Setting>,
    /// The id of its run, from when it is first to run.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub run_id: Option<Id>,
    /// How far it is.
    pub state: ChoiceState,
    /// Why it ended early.
    pub failure: Option<String>,
    /// Why a run of it alone is refused, where it is: its time step is beyond what any scheme is stable with.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub refusal: Option<String>,
    /// Its time step.
    pub time_step: f64,
    /// The steps that it has run.
    pub steps: u64,
    /// What it costs.
    pub cost: Option<Cost>,
    /// How far one step of the device is from one of the float64 reference, as a part of what the step changes; none for large systems.
    pub float64_distance: Option<f64>,
    /// The same of some steps, as a part of what all of them change.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub float64_stretch: Option<Float64Stretch>,
    /// What was measured.
    pub measured: Vec<Measured>,
    /// Columns of the table of energies whose means include the way to equilibrium.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub unequilibrated: Vec<String>,
    /// What its run has conserved, and how exactly.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub conserved_exactly: Vec<String>,
    /// How far that is off.
    pub errors: Vec<Deviation>,
    /// Whether it meets the targets, if there are any.
    pub verdict: Option<Verdict>,
}

/// How far the device is from the float64 reference after some steps.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Float64Stretch {
    /// The number of steps.
    pub steps: u64,
    /// The largest difference, as a part of the largest change since the start.
    pub distance: f64,
}

/// How far a choice is.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, strum::Display)]
#[serde(rename_all = "snake_case")]
#[strum(serialize_all = "snake_case")]
pub enum ChoiceState {
    /// Not finished yet.
    #[default]
    Waiting,
    /// Ran to its end.
    Finished,
    /// Became unstable, which is a result.
    Unstable,
}

impl Choice {
    /// The error of a measure.
    #[must_use]
    pub fn error(&self, measure: &str) -> Option<&Deviation> {
        self.errors.iter().find(|found| found.measure == measure)
    }

    /// Seconds of steps a unit of simulated time; infinite where they were not timed.
    pub(super) fn seconds(&self) -> f64 {
        self.cost.map_or(f64::INFINITY, |cost| cost.seconds_per_time)
    }

    /// The value of a measure.
    #[must_use]
    pub fn value(&self, measure: &str) -> Option<&Measured> {
        self.measured.iter().find(|found| found.measure == measure)
    }
}

impl fmt::Display for Choice {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        match (self.state, &self.failure) {
            (ChoiceState::Unstable, Some(failure)) => write!(formatter, "unstable: {failure}"),
            _ => write!(formatter, "{} steps", self.steps),
        }
    }
}

impl TradeoffSummary {
    /// The reference of a measure.
    pub(crate) fn reference(&self, measure: &str) -> Option<&Reference> {
        self.references.iter().find(|reference| reference.measure == measure)
    }

    /// The simulated time that means are taken over.
    #[must_use]
    pub fn averaged_time(&self) -> f64 {
        self.stretch.averaged
    }

    /// The cheapest choice that meets all targets.
    #[must_use]
    pub fn choice(&self) -> Option<&Choice> {
        let name = self.chosen.as_ref()?;
        self.choices.iter().find(|choice| choice.name == *name)
    }

    /// The scene of a choice, with the overrides that make the choice.
    pub(crate) fn scene_of(&self, choice: &Choice) -> WrittenScene {
        let settings: Vec<String> = choice.settings.iter().map(Setting::argument).collect();
        self.arguments.scene.clone().with(&settings)
    }

    /// Choices of which all seeds gave the same numbers, which then are their means too.
    pub(super) fn with_seeds_alike(&self) -> impl Iterator<Item = &Choice> {
        let all = self.choices.len() + self.finer.len();
        let is_alike = move |(place, choice): &(usize, &Choice)| {
            let mut others = self.further_seeds.iter().skip(*place).step_by(all).peekable();
            others.peek().is_some() && others.all(|other| other.measured == choice.measured)
        };
        let finished = |choice: &&Choice| choice.state == ChoiceState::Finished;
        self.choices.iter().enumerate().filter(is_alike).map(|(_, choice)| choice).filter(finished)
    }

    /// Choices that came to their end.
    pub(super) fn finished(&self) -> impl Iterator<Item = &Choice> {
        self.choices.iter().filter(|choice| choice.state == ChoiceState::Finished)
    }

    /// What a choice changes in the scene, with the numbers of steps that cover the simulated time of the scene where the step differs.
    pub(super) fn lines_of(&self, choice: &Choice) -> Vec<Setting> {
        let mut settings = choice.settings.clone();
        let parsed = |settings: &[Setting]| self.arguments.scene(settings.iter().map(Setting::argument)).ok();
        let Some((base, chosen)) = parsed(&[]).zip(parsed(&settings)) else { return settings };
        if base.time.step != chosen.time.step {
            let setting = |key: &str, value: u64| Setting { key: key.to_owned(), value: value.into() };
            let (equilibration, steps) = Stretch::of(&base).numbers(&chosen);
            settings.push(setting("time.steps", steps));
            if equilibration > 0 || chosen.time.equilibration > 0 {
                settings.push(setting("time.equilibration", equilibration));
            }
        }
        settings
    }

    /// The text of the scene with the settings of the choice that meets the targets, as JSON; none where no choice does.
    ///
    /// # Errors
    /// [`StudyError::Scene`] if the scene cannot be read again.
    pub fn chosen_scene(&self) -> Result<Option<String>, StudyError> {
        let Some(choice) = self.choice() else { return Ok(None) };
        let Arguments { scene, state_files, .. } = &self.arguments;
        let settings: Vec<String> = self.lines_of(choice).iter().map(Setting::argument).collect();
        Ok(Some(scene.clone().with(&settings).resolved(state_files)?))
    }

    /// Reads the summary in the directory of a tradeoff.
    ///
    /// # Errors
    /// [`StudyError::Nothing`] when there is none, [`StudyError::Output`] when it cannot be read or is no summary.
    pub fn load(directory: &Path) -> Result<Self, StudyError> {
        study::load(directory)
    }

    fn id_of(request: &Request) -> Id {
        let runs = request.sweep.variants().iter().map(|variant| Id::of_run(&variant.scene));
        Id::of_study(runs, &request.arguments)
    }
}

impl Record for TradeoffSummary {
    type Request = Request;
    type Ended = Choice;
    type Phase = Phase;

    const KIND: &'static Kind = &TRADEOFF;

    fn before(request: &Request) -> Self {
        let variants = request.sweep.variants();
        let choice = |variant: &Variant| Choice {
            name: variant.name.clone(),
            label: variant.label.clone(),
            settings: variant.settings.clone(),
            refusal: variant.refusal.clone(),
            time_step: variant.scene.time.step,
            ..Choice::default()
        };
        let reference = |name: &str| Choice { name: name.to_owned(), label: name.to_owned(), ..Choice::default() };
        let choices: Vec<Choice> = variants.iter().map(choice).collect();
        let finer: Vec<Choice> = request.finer_names().into_iter().map(reference).collect();
        let seeds = (1..request.seeds()).map(|further| request.seed(further));
        let with_seed = |run: &Choice, seed: u64| {
            let name = format!("{},{SEED}={seed}", run.name);
            Choice { label: name.clone(), name, ..run.clone() }
        };
        let further_seeds = seeds.flat_map(|seed| choices.iter().chain(&finer).map(move |run| with_seed(run, seed)));
        let further_seeds = further_seeds.collect();
        Self {
            mesoscope_version: env!("CARGO_PKG_VERSION").to_owned(),
            date: jiff::Timestamp::now().strftime("%Y-%m-%d").to_string(),
            tradeoff_id: Self::id_of(request),
            arguments: request.arguments.clone(),
            stretch: Stretch::of(&request.base),
            physical_keys: request.physical_keys().into_iter().map(str::to_owned).collect(),
            choices,
            finer,
            further_seeds,
            ..Self::default()
        }
    }

    fn request(&self) -> Result<Request, StudyError> {
        Request::new(self.arguments.clone())
    }

    fn checks(&self, request: &Request) -> Vec<(bool, &'static str)> {
        let Arguments { measures, references, targets, .. } = &request.arguments;
        let targets = targets.iter().map(|target| target.measure.as_str());
        let mut asked = measures.iter().map(String::as_str).chain(references.measures()).chain(targets);
        let same_id = !self.is_of_this_version() || self.tradeoff_id == Self::id_of(request);
        let names = self.choices.iter().map(|choice| &choice.name);
        let same_runs = names.eq(request.sweep.variants().iter().map(|variant| &variant.name))
            && self.finer.len() == request.finer_names().len()
            && self.further_seeds.len() == (request.seeds() as usize - 1) * (self.choices.len() + self.finer.len());
        let same_measures = self.measures.is_empty() || asked.all(|name| self.measures.iter().any(|own| own == name));
        vec![
            (same_id, ASKS_ELSE),
            (same_runs, "has other runs than those that it asks for"),
            (same_measures, "lacks measures that it asks for"),
        ]
    }

    fn version(&self) -> &str {
        &self.mesoscope_version
    }

    fn id(&self) -> Id {
        self.tradeoff_id
    }

    fn runs(&self) -> Vec<&str> {
        self.choices.iter().chain(&self.finer).chain(&self.further_seeds).map(|run| run.name.as_str()).collect()
    }

    fn tables(&self, request: &Request) -> Vec<(&'static str, String)> {
        vec![(files::TABLE, table::text(self, &request.sweep.keys()))]
    }

    fn page(&self, request: &Request) -> Option<(&'static str, String)> {
        Some((files::PAGE, advice::page(self, &request.base.title)))
    }

    fn charts<'c>(&'c self, request: &'c Request, _: &RunDirectory) -> Result<Charts<'c>, StudyError> {
        let chart = |measure: &String| Some((files::plot(measure), charts::chart(self, request, measure)?));
        Ok(Box::new(self.measures.iter().filter_map(chart)))
    }

    fn style(&self, request: &Request, overrides: &[String]) -> Result<PlotStyle, SceneError> {
        let Arguments { scene, state_files, .. } = &request.arguments;
        study::style(scene, &request.base, overrides, state_files, StepCheck::Allow)
    }
}
