//! From what was measured to errors, Pareto fronts and verdicts.

use super::deviation::Deviation;
use super::measures::{self, Measured};
use super::pareto;
use super::reference::{self, Reference};
use super::request::{FINER, Request};
use super::summary::{Choice, ChoiceState, TradeoffSummary};
use super::target::{Target, Verdict};
use crate::study::{StudyError, each_once};

impl TradeoffSummary {
    /// References, errors and Pareto fronts.
    ///
    /// # Errors
    /// [`StudyError::Arguments`] if a measure was asked for that no run has.
    pub(super) fn assess(&mut self, request: &Request) -> Result<(), StudyError> {
        let arguments = &request.arguments;
        if self.measures.is_empty() {
            let finished = self.finished().next();
            let usual = finished.map(|choice| measures::usual(&choice.measured)).unwrap_or_default();
            let measures = if arguments.measures.is_empty() { usual } else { arguments.measures.clone() };
            let further = arguments.targets.iter().map(|target| target.measure.clone());
            let further = further.chain(arguments.references.measures().map(str::to_owned));
            self.measures = each_once(measures.into_iter().chain(further));
        }
        if self.finished().next().is_some() {
            let lacks = |measure: &&String| self.finished().all(|choice| choice.value(measure).is_none());
            let mistake = |measure| format!("no run measured `{measure}`");
            StudyError::refuse(self.measures.iter().filter(lacks).map(mistake).collect())?;
        }
        let finer: Vec<&[Measured]> = self.finer.iter().map(|run| run.measured.as_slice()).collect();
        let reference = |measure: &String| request.known(measure).or_else(|| reference::finer(measure, FINER, &finer));
        self.references = self.measures.iter().filter_map(reference).collect();
        for (choice, variant) in self.choices.iter_mut().zip(request.sweep.variants()) {
            let error = |reference: &Reference| {
                let measured = choice.measured.iter().find(|found| found.measure == reference.measure)?;
                let of_scheme = reference::of_scheme(&reference.measure, &variant.scene);
                Some(Deviation::new(measured, reference).with_scheme(of_scheme, reference))
            };
            choice.errors = self.references.iter().filter_map(error).collect();
        }
        for measure in &self.measures {
            let pair = |choice: &Choice| [choice.seconds(), choice.error(measure).map_or(f64::NAN, Deviation::size)];
            let front = pareto::front(&self.choices.iter().map(pair).collect::<Vec<_>>());
            for (choice, on_front) in self.choices.iter_mut().zip(front) {
                let own = choice.errors.iter_mut().filter(|error| error.measure == *measure);
                own.for_each(|error| error.on_front = on_front);
            }
        }
        let targets = &arguments.targets;
        for choice in &mut self.choices {
            let verdict = |target: &Target| {
                let reference = self.references.iter().find(|known| known.measure == target.measure)?;
                Some(target.verdict(choice.error(&target.measure)?, reference.value))
            };
            choice.verdict = match choice.state {
                _ if targets.is_empty() => None,
                ChoiceState::Finished => targets.iter().map(|target| verdict(target).unwrap_or(Verdict::Open)).max(),
                _ => Some(Verdict::Misses),
            };
        }
        Ok(())
    }

    /// The cheapest choice that meets all targets and that a run of its scene takes.
    pub(super) fn choose(&mut self) {
        let may_be = |choice: &&Choice| {
            choice.verdict == Some(Verdict::Meets) && choice.cost.is_some() && choice.refusal.is_none()
        };
        let chosen = self.choices.iter().filter(may_be).min_by(|a, b| a.seconds().total_cmp(&b.seconds()));
        self.chosen = chosen.map(|choice| choice.name.clone());
    }
}
