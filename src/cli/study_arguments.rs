//! Arguments of the commands of many runs, and how all of them run.

use std::path::PathBuf;
use std::sync::Arc;
use std::sync::atomic::AtomicBool;

use mesoscope::gpu::{AdapterChoice, list_adapters, unseen_card};
use mesoscope::output::OutputError;
use mesoscope::scene::Warning;
use mesoscope::study::{Kind, LONG, Observer, Record, StudyError, StudyRun};

use super::study_report::Reporter;
use super::{
    AdapterArgument, Failure, RunArguments, SceneArguments, guidance, heading, interruption, line, report, whole_number,
};

/// Which scene, where to, and how.
#[derive(Debug, clap::Args)]
pub struct StudyArguments {
    /// A scene file, or the name of a built-in scene (see `mesoscope scenes`)
    #[arg(required_unless_present = "resume", conflicts_with = "resume")]
    scene: Option<String>,

    /// Change one value in all runs, as for `mesoscope run`; may be repeated
    #[arg(long, help_heading = heading::SCENE, value_name = "PATH=VALUE", conflicts_with = "resume")]
    pub set: Vec<String>,

    /// Number of steps of the scene, as for `mesoscope run`: what does not fit into fewer is shortened, and it is said which
    #[arg(long, help_heading = heading::RUNNING, value_name = "N", value_parser = whole_number, allow_negative_numbers = true, conflicts_with = "resume")]
    pub steps: Option<u64>,

    /// Runs at once [default: 2 on a software adapter where a step is short, as of fewer than 18,000 particles of a DPD fluid
    /// or 280,000 of shallow water, which is 1.1 to 1.5 times as fast; otherwise 1]. Results do not depend on it, but
    /// runs in a `tradeoff --budget` are as long as the time allows
    #[arg(long, help_heading = heading::RUNNING, value_name = "N", value_parser = clap::value_parser!(u16).range(1..))]
    jobs: Option<u16>,

    /// Runs that a device advances together, in the dispatches of one, where they differ in numbers only [default: on a card as
    /// many as have 131,072 particles, up to 64, of those that differ in their seeds; on a software adapter 1]. Results do not depend
    /// on it but for rounding, where other numbers than seeds differ: kernels then load them
    #[arg(long, help_heading = heading::RUNNING, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=64))]
    replicas: Option<u16>,

    /// Independent runs of each scene, with its own seed and those that follow: means are taken over them, with errors
    /// from their scatter
    #[arg(long, help_heading = heading::SEVERAL, value_name = "N", conflicts_with = "resume")]
    pub seeds: Option<u32>,

    /// Directory for all results [default: the names of scene and command, joined by a hyphen, in the working directory]
    #[arg(long, help_heading = heading::OUTPUT, value_name = "DIR", conflicts_with = "resume")]
    out: Option<PathBuf>,

    /// Go on in this directory with what was interrupted, and draw its pictures again
    #[arg(long, help_heading = heading::RUNNING, value_name = "DIR", conflicts_with = "force")]
    resume: Option<PathBuf>,

    /// Run even if it takes more than eight hours
    #[arg(long, help_heading = heading::RUNNING)]
    yes: bool,

    #[command(flatten)]
    adapter: AdapterArgument,

    #[command(flatten)]
    pub how: RunArguments,
}

/// Which variants, where every combination of values is one.
#[derive(Debug, clap::Args)]
pub struct VariantArguments {
    /// A key of the scene and the values to try. Repeated, every combination is run. A value is JSON, or else text;
    /// the path is as in `--set`
    #[arg(long, help_heading = heading::SCENE, value_name = "PATH=VALUE,…", required_unless_present_any = ["resume", "seeds"], conflicts_with = "resume")]
    pub vary: Vec<String>,

    /// One more variant besides the combinations, with settings of its own; may be repeated
    #[arg(long, help_heading = heading::SCENE, value_name = "PATH=VALUE,…", conflicts_with = "resume")]
    pub also: Vec<String>,
}

/// What is right.
#[derive(Debug, clap::Args)]
pub struct ComparisonArguments {
    /// What a measure should be, as in `pressure=23.635` or `pressure=23.635+-0.005`; may be repeated
    #[arg(long, help_heading = heading::COMPARISON, value_name = "MEASURE=VALUE", conflicts_with = "resume")]
    pub reference: Vec<String>,
}

impl StudyArguments {
    /// Those of independent runs of one scene, into `directory`.
    pub fn of_seeds(
        seeds: u32,
        scene: &SceneArguments,
        directory: PathBuf,
        adapter: &AdapterArgument,
        how: &RunArguments,
    ) -> Self {
        Self {
            scene: Some(scene.scene.clone()),
            set: scene.set.clone(),
            steps: scene.steps,
            jobs: None,
            replicas: None,
            seeds: Some(seeds),
            out: Some(directory),
            resume: None,
            // A run may take as long as it takes.
            yes: true,
            adapter: adapter.clone(),
            how: how.clone(),
        }
    }

    /// The study in the directory to go on in, or else a new one of what is asked of a scene.
    pub fn study<R: Record>(
        &self,
        request: impl FnOnce(&str) -> Result<R::Request, Failure>,
    ) -> Result<StudyRun<R>, Failure> {
        let study = if let Some(directory) = &self.resume {
            guidance::check_directory(directory)?;
            StudyRun::resume(directory)?
        } else {
            // The scene is there, or the command line would have been refused.
            let scene = self.scene.as_deref().unwrap_or_default();
            let default = || format!("{}-{}", report::stem(scene), R::KIND.command).into();
            let (request, out) = (request(scene)?, self.out.clone().unwrap_or_else(default));
            if self.how.force { StudyRun::replace(request, out) } else { StudyRun::start(request, out) }
        };
        Ok(study
            .with_jobs(self.jobs.map(usize::from))
            .with_replicas(self.replicas.map(usize::from))
            .up_to((!self.yes).then_some(LONG))
            .until(&interruption::interrupt(&Arc::new(AtomicBool::new(true)))))
    }

    /// Says what was shortened in the scene of a study, unless it is to be quiet.
    pub fn note(&self, notices: &[Warning]) {
        for notice in notices.iter().filter(|_| !self.how.quiet) {
            line(&format!("note: {notice}"));
        }
    }

    /// Executes a study and shows how far it is, unless it is to be quiet; `runs` says what its runs are, given their
    /// number.
    pub fn execute<R: Record, O>(
        &self,
        study: StudyRun<R>,
        title: &str,
        runs: impl Fn(usize) -> String,
        execute: impl FnOnce(StudyRun<R>, &AdapterChoice, &mut Observer<'_, R>) -> Result<O, StudyError>,
    ) -> Result<O, Failure> {
        // Copies on one machine take different adapters, where there are several.
        let adapter = &self.adapter.choice_of_copy();
        let directory = study.directory().to_path_buf();
        let executed = if self.how.quiet {
            execute(study, adapter, &mut |_| {})
        } else {
            let warning = list_adapters().first().and_then(|best| unseen_card(best, adapter));
            if let Some(warning) = warning {
                line(&format!("warning: {warning}"));
            }
            let mut reporter = Reporter::new(title, R::KIND);
            let executed = execute(study, adapter, &mut |event| reporter.show(&event, &runs));
            reporter.bar.finish_and_clear();
            executed
        };
        executed.map_err(|error| match (&error, Kind::of(&directory)) {
            // What is in the way may be of another kind, or no study.
            (StudyError::Output(OutputError::ResultExists { .. }), Some(kind)) => {
                let (noun, resuming) = (kind.noun, kind.resuming(&directory));
                Failure::input_output(format!("{error}\nhint: {resuming} goes on with an interrupted {noun}"))
            }
            _ => error.into(),
        })
    }
}
