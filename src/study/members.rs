//! The runs of a study that have directories of their own, each that of an ordinary run.

use super::concurrency::at_once;
use super::error::StudyError;
use super::groups::Group;
use super::record::Record;
use super::run::{Observer, StudyEvent, StudyRun};
use crate::engine::Replica;
use crate::families::Checked;
use crate::gpu::AdapterChoice;
use crate::output::{Id, OutputError, RunDirectory, Summary, files, of_one_run};
use crate::run::{Event, Progress, Run, RunError};
use crate::scene::Scene;
use std::path::Path;
use std::thread;

/// A run of a study.
pub(crate) struct Member {
    /// Its place in the summary.
    pub entry: usize,
    /// Name of its directory.
    pub name: String,
    /// Its scene, with the step to end with.
    pub scene: Checked,
    /// Its id.
    pub id: Id,
}

/// The summary of the run of a scene in its directory, if it reached its last step and left all of its files; `reference` is the file
/// that says which id it is to have.
pub(crate) fn finished(directory: &Path, scene: &Scene, id: Id, reference: &'static str) -> Option<Summary> {
    if !directory.is_dir() {
        return None;
    }
    // A process that still writes there is not finished; what a killed one left half-written is removed.
    let directory = RunDirectory::claim(directory).ok()?;
    directory.check_run(id, reference).ok()?;
    let reached_its_end = |summary: &Summary| {
        summary.run_id == id && summary.steps >= scene.time.steps && of_one_run(&summary.scene, scene)
    };
    let summary = Summary::load(&directory.file(files::SUMMARY)).ok().filter(reached_its_end)?;
    summary.is_complete(&directory).then_some(summary)
}

impl Member {
    /// The run in its directory: from its checkpoint if there is one, else from the beginning.
    fn simulation(&self, directory: &Path, summary: &'static str) -> Result<Run, RunError> {
        let steps = self.scene.time.steps;
        if directory.is_dir() {
            // The run of another scene is not to be continued, nor to be overwritten.
            RunDirectory::open(directory)?.check_run(self.id, summary)?;
        }
        if !directory.join(files::CHECKPOINT).exists() {
            // What is found without a checkpoint is the beginning of this very run.
            return Ok(Run::replace(self.scene.clone(), directory).with_id(self.id));
        }
        let simulation = Run::resume(directory, Some(steps))?;
        if simulation.first_step() > steps {
            return Err(OutputError::Continued { directory: directory.to_path_buf(), finished: steps }.into());
        }
        Ok(simulation)
    }
}

/// The next action of a study when this run has ended.
type OnEnd<'t, R> = dyn FnMut(&mut StudyRun<R>, &Member, Ended, &mut Observer<'_, R>) -> Result<(), StudyError> + 't;

/// The summary of a run, or the error that ended it.
type Ended = Result<Summary, RunError>;

/// What a run under way reports.
enum Message {
    Begun(u64),
    Advanced(Progress),
    Ended(Box<Ended>),
}

impl<R: Record> StudyRun<R> {
    /// Brings runs to their last steps, `jobs` at once; `on_end` learns of each how it ended, and no others begin once that fails.
    ///
    /// # Errors
    /// The first of `on_end`; [`StudyError::Interrupted`] if it was asked to stop.
    pub(crate) fn simulate(
        &mut self,
        members: &[Member],
        jobs: usize,
        adapter: &AdapterChoice,
        observer: &mut Observer<'_, R>,
        on_end: &mut OnEnd<'_, R>,
    ) -> Result<(), StudyError> {
        let (place, interrupt) = (self.directory().to_path_buf(), self.interrupt().clone());
        let work = |member: &Member, replica: Option<Replica>, report: &dyn Fn(Message)| {
            let directory = place.join(&member.name);
            let ended = member.simulation(&directory, R::KIND.summary).and_then(|simulation| {
                if simulation.is_finished() {
                    return Ok(Summary::load(&directory.join(files::SUMMARY))?);
                }
                report(Message::Begun(simulation.first_step()));
                let (run, mut observer) = (simulation.until(&interrupt), |event: Event<'_>| {
                    if let Event::Advanced(progress) = event {
                        report(Message::Advanced(progress));
                    }
                });
                let ended = match replica {
                    Some(replica) => run.execute_with(replica, adapter, &mut observer),
                    None => run.execute(adapter, &mut observer),
                };
                ended.map(|outcome| outcome.summary)
            });
            report(Message::Ended(Box::new(ended)));
        };
        let groups = self.groups(members, adapter);
        let work_on_group = |group: &Group, report: &(dyn Fn((usize, Message)) + Sync)| {
            let simulate =
                |number: usize, replica| work(&members[number], replica, &|message| report((number, message)));
            let Some(replicas) = group.replicas() else {
                for number in group.members().iter().take_while(|_| !interrupt.is_asked()) {
                    simulate(*number, None);
                }
                return;
            };
            thread::scope(|scope| {
                for (number, replica) in group.members().iter().zip(replicas) {
                    scope.spawn(move || simulate(*number, Some(replica)));
                }
            });
        };
        at_once(&groups, jobs, &interrupt, work_on_group, |_, (number, message)| {
            let run = members[number].name.as_str();
            match message {
                Message::Begun(first_step) => observer(StudyEvent::Begun { run, first_step }),
                Message::Advanced(progress) => observer(StudyEvent::Advanced { run, progress }),
                Message::Ended(ended) => match *ended {
                    // It waits to be continued.
                    Err(RunError::Interrupted { .. } | RunError::NotBegun) => {}
                    ended => return on_end(self, &members[number], ended, observer),
                },
            }
            Ok(())
        })?;
        self.proceed()
    }
}
