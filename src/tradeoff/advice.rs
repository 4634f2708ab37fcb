//! The page of a tradeoff: what to choose, in words.

use super::deviation::Deviation;
use super::fields::DISTANCE;
use super::reference::Source;
use super::summary::{Choice, ChoiceState, TradeoffSummary};
use super::target::{Target, Verdict};
use crate::numbers::{counted, short, with_error};
use crate::plot::capitalised;
use crate::study::table::{list, markdown};
use crate::study::{Setting, by_key, each_once, in_hours};

/// Errors that the page names the cheapest choice for.
const ROUND_ERRORS: [f64; 3] = [0.05, 0.01, 0.001];

/// The remedy where more samples tell.
const DECIDED: &str = "A smaller --error or a larger --budget decides it.";

/// A duration in seconds, minutes or hours.
pub(super) fn duration(seconds: f64) -> String {
    match seconds {
        ..120.0 => format!("{seconds:.0} s"),
        120.0..7200.0 => format!("{:.0} minutes", seconds / 60.0),
        _ => in_hours(seconds),
    }
}

/// What a measure is compared with.
pub(super) fn reference_in_words(summary: &TradeoffSummary, measure: &str) -> String {
    let Some(reference) = summary.reference(measure) else { return "there is nothing to compare it with".to_owned() };
    let value = with_error(reference.value, reference.uncertainty);
    match &reference.source {
        Source::Given => format!("compared with {value}, which was given"),
        Source::Predicted(law) => format!("compared with {value}: {law}"),
        Source::Finer(_) => format!("compared with {value} of a finer run{}", finer_in_words(summary)),
    }
}

/// What the finer run is like, and how uncertain what it says is.
fn finer_in_words(summary: &TradeoffSummary) -> String {
    let step = summary.finer.first().map_or(0.0, |run| run.time_step);
    let step = if step > 0.0 { format!(" of step {}", short(step)) } else { String::new() };
    let settings = summary.arguments.finer.as_deref().map(|finer| format!(" with `{finer}`")).unwrap_or_default();
    let changes = match &summary.arguments.still_finer {
        Some(still_finer) => format!("`{still_finer}` and twice its step change"),
        None => "twice its step changes".to_owned(),
    };
    format!("{step}{settings}, uncertain by what {changes}")
}

/// An error with its uncertainty, in per cent where it is a part of something.
#[must_use]
pub fn error_in_words(error: &Deviation) -> String {
    let (scale, unit) = if error.is_part() { (100.0, " %") } else { (1.0, "") };
    let text = with_error(scale * error.error, error.uncertainty.map(|found| scale * found));
    let mark = if error.from_few_samples { format!(" {FEW_SAMPLES}") } else { String::new() };
    format!("{text}{unit}{mark}")
}

/// Errors with what they are of.
pub(crate) fn errors_in_words(errors: &[Deviation]) -> String {
    let words = |error: &Deviation| format!("{} {}", error.measure.replace('_', " "), error_in_words(error));
    errors.iter().map(words).collect::<Vec<_>>().join(", ")
}

/// What marks an error from few samples.
const FEW_SAMPLES: char = '‡';

/// What the mark means, if one of these errors has it.
pub(crate) fn legend_of<'e>(mut errors: impl Iterator<Item = &'e Deviation>) -> Option<String> {
    let few = errors.any(|error| error.from_few_samples);
    few.then(|| format!("{FEW_SAMPLES} from few samples: the standard error is taken three times as large as they say"))
}

impl TradeoffSummary {
    /// Caveats about the numbers, line by line.
    #[must_use]
    pub fn notes(&self) -> Vec<String> {
        let mut notes = Vec::new();
        if !self.physical_keys.is_empty() {
            let keys = self.physical_keys.join("`, `");
            notes.push(format!(
                "`{keys}` changes what is simulated, and not only how it is computed: all choices are compared with \
                 the scene as it is."
            ));
        }
        let spoilt = |choice: &Choice| {
            let (label, columns) = (&choice.label, choice.unequilibrated.join(", "));
            choice.unequilibrated.iter().any(|column| self.measures.contains(column)).then(|| {
                format!("Means of {label} include the way to equilibrium ({columns}): set a longer time.equilibration.")
            })
        };
        // A choice may be the run that others are compared with.
        notes.extend(each_once(self.choices.iter().chain(&self.finer).filter_map(spoilt)));
        let measured = self.choices.iter().filter(|choice| choice.measured.iter().any(|found| found.fluctuates));
        let alike = by_key(measured.map(|choice| ((choice.steps, &choice.measured), format!("`{}`", choice.label))));
        for (_, labels) in alike.into_iter().filter(|(_, labels)| labels.len() > 1) {
            let labels = labels.join(" and ");
            notes.push(format!(
                "{labels} are the same run, to the last digit of all that is measured: what tells them apart can only \
                 change what a step costs."
            ));
        }
        // Nothing of a deterministic scene depends on its seed.
        let copied: Vec<&str> = self.with_seeds_alike().map(|choice| choice.label.as_str()).collect();
        if !copied.is_empty() {
            let copied = copied.join(" and ");
            notes.push(format!(
                "All seeds of {copied} gave the same numbers, whose errors are those of one run: nothing that was \
                 measured depends on the seed."
            ));
        }
        // Choices that came to their end though a run of their scene alone is refused.
        notes.extend(self.finished().filter_map(|choice| {
            let (label, refusal) = (&choice.label, choice.refusal.as_ref()?);
            Some(format!("{label} is never chosen, for `mesoscope run` refuses its scene: {refusal}."))
        }));
        notes
    }

    /// What every choice costs and how far it is off, a row for each below the names of the columns. `*` marks errors on the Pareto
    /// front of their measure.
    #[must_use]
    pub fn errors_in_words(&self) -> Vec<Vec<String>> {
        let names = self.measures.iter().map(|measure| measure.replace('_', " "));
        let header = ["choice", "s a unit of time"].map(str::to_owned).into_iter().chain(names).collect();
        let or_dash = |text: Option<String>| text.unwrap_or_else(|| "—".to_owned());
        let marked = |error: &Deviation| format!("{}{}", error_in_words(error), if error.on_front { " *" } else { "" });
        let row = |choice: &Choice| {
            let cost = choice.cost.map(|cost| with_error(cost.seconds_per_time, None));
            let unstable = (choice.state == ChoiceState::Unstable).then(|| "unstable".to_owned());
            let errors = self.measures.iter().map(|measure| or_dash(choice.error(measure).map(marked)));
            [choice.label.clone(), or_dash(unstable.or(cost))].into_iter().chain(errors).collect()
        };
        [header].into_iter().chain(self.choices.iter().map(row)).collect()
    }

    /// The meaning of the mark of errors from few samples, where there are any.
    #[must_use]
    pub fn legend(&self) -> Option<String> {
        legend_of(self.choices.iter().flat_map(|choice| &choice.errors))
    }

    /// That the runs are not as long as they should be, and what makes them longer; nothing where they are.
    #[must_use]
    pub fn short_of_errors(&self) -> Option<String> {
        let more = match &self.wanted {
            Some(wanted) => format!("{wanted}, and wants --yes"),
            None if self.arguments.length.budget.is_some() => "a larger --budget makes them longer".to_owned(),
            None => "--set time.steps=N begins with longer ones".to_owned(),
        };
        self.is_short.then(|| format!("The runs ended before all errors were as small as asked for: {more}"))
    }

    /// The choices that meet the targets, in words; nothing where there are none.
    #[must_use]
    pub fn advice(&self) -> String {
        let paragraphs = verdict(self, ["", "  "]);
        paragraphs.into_iter().map(|paragraph| paragraph + "\n\n").collect()
    }
}

/// The whole page, in Markdown.
pub(super) fn page(summary: &TradeoffSummary, title: &str) -> String {
    let adapter = summary.adapter.as_ref().map_or("an unknown adapter", |adapter| &adapter.name);
    let (count, time) = (summary.choices.len(), short(summary.averaged_time()));
    let before = short(summary.stretch.equilibration);
    let seeds = summary.arguments.seeds.map(|seeds| {
        format!(
            " Every choice ran with {seeds} seeds: its numbers are means over them, with errors from their scatter, of \
             which two hold the true value with 95 %."
        )
    });
    let mut paragraphs = vec![
        format!("# What accuracy costs: {title}"),
        format!(
            "{count} choices, each averaged over {time} units of simulated time after {before} of equilibration, on {adapter}. \
             Costs are medians of steps timed in turns, without reports.{}",
            seeds.unwrap_or_default()
        ),
    ];
    paragraphs.extend(summary.notes());
    paragraphs.extend(summary.short_of_errors().map(|short| format!("**{short}.**")));
    let targets: Vec<String> = summary.arguments.targets.iter().map(Target::to_string).collect();
    if !targets.is_empty() {
        paragraphs.push(format!("## {}", targets.join(", ")));
    }
    paragraphs.extend(verdict(summary, ["**", "    "]));
    paragraphs.extend([
        markdown(summary.errors_in_words(), "--:"),
        basis_of_errors(summary),
        "## Costs".to_owned(),
        costs(summary),
    ]);
    paragraphs.extend(list("## What is conserved", conserved(summary)));
    paragraphs.extend(summary.measures.iter().flat_map(|measure| section(summary, measure)));
    let unstable = summary.choices.iter().filter(|choice| choice.state == ChoiceState::Unstable);
    let reason = |choice: &Choice| choice.failure.clone().unwrap_or_else(|| "it became unstable".to_owned());
    paragraphs.extend(list("## Unstable", unstable.map(|choice| format!("{}: {}", choice.label, reason(choice)))));
    paragraphs.join("\n\n") + "\n"
}

/// The choice that meets the targets and the lines to write into the scene, or the one that comes nearest; nothing without targets.
/// `bold` and `indent` are what the format marks with.
fn verdict(summary: &TradeoffSummary, [bold, indent]: [&str; 2]) -> Vec<String> {
    let targets = &summary.arguments.targets;
    if targets.is_empty() {
        return Vec::new();
    }
    if let Some(choice) = summary.choice() {
        let cost = choice.cost.map(|cost| with_error(cost.seconds_per_time, None));
        let cost = cost.map(|cost| format!(", at {cost} s a unit of simulated time")).unwrap_or_default();
        let label = &choice.label;
        let chosen =
            format!("Choose {bold}{label}{bold}{cost}: the cheapest that meets the targets, with two standard errors.");
        let line = |setting: &Setting| format!("{indent}{}: {}", setting.key, setting.value);
        let lines: Vec<String> = summary.lines_of(choice).iter().map(line).collect();
        let is_open = |other: &&Choice| other.verdict == Some(Verdict::Open) && other.seconds() < choice.seconds();
        let open: Vec<&str> = summary.choices.iter().filter(is_open).map(|other| other.label.as_str()).collect();
        let open = (!open.is_empty()).then(|| format!("Of what costs less it is open: {}. {DECIDED}", open.join("; ")));
        return [chosen, lines.join("\n")].into_iter().chain(open).collect();
    }
    // Targets that no choice can be said to meet, as they are parts of nothing.
    let of_nothing = |target: &Target| target.part_of_nothing(summary.reference(&target.measure)?);
    let of_nothing: Vec<String> = targets.iter().filter_map(of_nothing).collect();
    let any = |verdict: Verdict| summary.choices.iter().any(|choice| choice.verdict == Some(verdict));
    let is_open = of_nothing.is_empty() && any(Verdict::Open);
    let found = if is_open {
        "Undecided: no choice is known to meet the targets, and of some it is open."
    } else if any(Verdict::Meets) {
        // One that `run` refuses may.
        "No choice that `mesoscope run` takes meets the targets."
    } else {
        "No choice meets the targets."
    };
    let mut sentences = vec![format!("{bold}{found}{bold}")];
    if !of_nothing.is_empty() {
        sentences.extend(of_nothing.iter().map(|reason| capitalised(reason) + "."));
        return vec![sentences.join(" ")];
    }
    let nearest = nearest(summary);
    sentences.extend(nearest.map(|(choice, target, factor)| {
        let (label, measure, factor) = (&choice.label, &target.measure, with_error(factor, None));
        let error = choice.error(measure).map_or_else(String::new, error_in_words);
        format!(
            "{label} comes nearest: its {measure} is off by {error}, with two standard errors {factor} times as much as it may be."
        )
    }));
    if is_open {
        sentences.push(DECIDED.to_owned());
    } else {
        sentences.extend(nearest.and_then(|(choice, target, _)| what_to_vary(summary, choice, target)));
        sentences.push("Vary other keys, or a smaller time step.".to_owned());
    }
    vec![sentences.join(" ")]
}

/// Which of the keys that were varied matters most to what keeps the nearest choice from its target, judged by the choices that differ from it in
/// this key alone.
fn what_to_vary(summary: &TradeoffSummary, nearest: &Choice, target: &Target) -> Option<String> {
    let own = nearest.error(&target.measure)?;
    let others = summary.choices.iter().filter_map(|other| {
        let mut differ = nearest.settings.iter().zip(&other.settings).filter(|(one, other)| one != other);
        let ((_, setting), error) = (differ.next()?, other.error(&target.measure)?);
        let alone = differ.next().is_none() && nearest.settings.len() == other.settings.len();
        (alone && nearest.settings.iter().any(|one| one.key == setting.key)).then_some((setting, error))
    });
    let (Setting { key, value }, error) = others.max_by(|(_, a), (_, b)| a.size().total_cmp(&b.size()))?;
    let is_seen =
        error.size() > own.size() + 2.0 * error.uncertainty.unwrap_or(0.0).hypot(own.uncertainty.unwrap_or(0.0));
    is_seen.then(|| {
        let error = error_in_words(error);
        format!("Of what was varied `{key}` matters most: with {value} it is off by {error}; values beyond that of the nearest may be better.")
    })
}

/// The choice whose worst error, as a multiple of its target, is least; with that target and the multiple.
fn nearest(summary: &TradeoffSummary) -> Option<(&Choice, &Target, f64)> {
    let worst = summary.choices.iter().filter_map(|choice| {
        let factors = summary.arguments.targets.iter().map(|target| {
            let (error, reference) = (choice.error(&target.measure)?, summary.reference(&target.measure)?);
            Some((choice, target, error.largest() / target.most(reference.value, error.relative)))
        });
        // A choice that lacks a measure is not near.
        factors.collect::<Option<Vec<_>>>()?.into_iter().max_by(|a, b| a.2.total_cmp(&b.2))
    });
    worst.min_by(|a, b| a.2.total_cmp(&b.2))
}

/// The references of errors, and how far the device is from float64.
fn basis_of_errors(summary: &TradeoffSummary) -> String {
    let parts = "Errors with standard errors, in per cent of the reference of the measure, or of what a drift, a distance or a share is a part of; * on the Pareto front of cost and error.";
    let mut sentences = vec![parts.to_owned()];
    sentences.extend(summary.legend().map(|legend| legend + "."));
    let stretches = summary.choices.iter().filter_map(|choice| choice.float64_stretch);
    sentences.extend(stretches.max_by(|a, b| a.distance.total_cmp(&b.distance)).map(|farthest| {
        let (steps, distance) = (counted(farthest.steps, "step"), with_error(farthest.distance, None));
        format!("After {steps} the device is off from float64 by {distance} of what has changed, at most.")
    }));
    sentences.join(" ")
}

/// What choices cost, in time and memory.
fn costs(summary: &TradeoffSummary) -> String {
    let header = ["choice", "s a unit of time", "fastest and slowest round", "particle-steps/s", "bytes a particle"];
    let row = |choice: &Choice| {
        let cost = choice.cost?;
        let [median, fastest, slowest, speed] =
            [cost.seconds_per_time, cost.fastest, cost.slowest, cost.particle_steps_per_second]
                .map(|number| with_error(number, None));
        let bytes = format!("{:.0}", cost.bytes_per_particle);
        Some(vec![choice.label.clone(), median, format!("{fastest} to {slowest}"), speed, bytes])
    };
    let header = header.map(str::to_owned).to_vec();
    markdown([header].into_iter().chain(summary.choices.iter().filter_map(row)), "--:")
}

/// What the runs have conserved, and how exactly.
fn conserved(summary: &TradeoffSummary) -> Vec<String> {
    let mut kinds = by_key(summary.finished().map(|choice| (&choice.conserved_exactly, choice.label.as_str())));
    kinds.sort();
    let is_one = kinds.len() == 1;
    let in_words = |(kind, labels): (&Vec<String>, Vec<&str>)| {
        let whose = if is_one { "all choices".to_owned() } else { labels.join("; ") };
        let what = if kind.is_empty() { "nothing".to_owned() } else { kind.join("; ") };
        format!("{whose}: {what}")
    };
    kinds.into_iter().map(in_words).collect()
}

/// What a measure says.
fn section(summary: &TradeoffSummary, measure: &str) -> Vec<String> {
    let heading = format!("## {}", measure.replace('_', " "));
    let mut paragraphs = vec![heading, capitalised(&reference_in_words(summary, measure)) + "."];
    if measure.ends_with(DISTANCE) {
        paragraphs.push(format!("The finer run is one{}.", finer_in_words(summary)));
    }
    let mut known: Vec<(&Choice, &Deviation)> =
        summary.choices.iter().filter_map(|choice| Some((choice, choice.error(measure)?))).collect();
    let of_schemes = known.iter().filter_map(|(choice, error)| {
        let of_scheme = Deviation { error: error.of_scheme?, uncertainty: None, ..(*error).clone() };
        let [of_scheme, measured] = [&of_scheme, error].map(error_in_words);
        Some(format!("{}: {of_scheme}, measured {measured}", choice.label))
    });
    let of_schemes = list("What theory says of the scheme with its time step, and what was measured:", of_schemes);
    known.sort_by(|(a, _), (b, _)| a.seconds().total_cmp(&b.seconds()));
    let front = known.iter().filter(|(_, error)| error.on_front).map(|(choice, error)| {
        let noise = if error.is_within_noise() { " (within its statistical error)" } else { "" };
        let (cost, error) = (with_error(choice.seconds(), None), error_in_words(error));
        format!("{}: {cost} s, off by {error}{noise}", choice.label)
    });
    let front = list("The Pareto front, from the cheapest on:", front);
    if front.is_empty() {
        paragraphs.push("No choice has both a cost and an error.".to_owned());
        return paragraphs;
    }
    paragraphs.extend(front.into_iter().chain(of_schemes));
    let cheapest = |bound: f64| {
        let is_within = |error: &Deviation| error.relative && error.within(bound) == Verdict::Meets;
        let (choice, _) = known.iter().find(|(_, error)| is_within(error))?;
        Some(format!("The cheapest within {} %: {}.", short(100.0 * bound), choice.label))
    };
    let cheapest: Vec<String> = ROUND_ERRORS.into_iter().filter_map(cheapest).collect();
    paragraphs.extend((!cheapest.is_empty()).then(|| cheapest.join("\n")));
    paragraphs
}

#[cfg(test)]
mod tests {
    use super::super::made_up;
    use super::*;

    #[test]
    fn parts_are_in_per_cent_as_in_the_pictures() {
        let deviation = |measure: &str, relative: bool, from_few_samples: bool| {
            let (measure, uncertainty) = (measure.to_owned(), Some(0.001));
            Deviation {
                measure,
                error: 0.023,
                uncertainty,
                from_few_samples,
                relative,
                on_front: false,
                of_scheme: None,
            }
        };
        assert_eq!(error_in_words(&deviation("pressure", true, false)), "2.30 ± 0.10 %");
        assert_eq!(error_in_words(&deviation("limited_exchange_share", false, false)), "2.30 ± 0.10 %");
        assert_eq!(error_in_words(&deviation("depth_distance", false, true)), "2.30 ± 0.10 % ‡");
        assert_eq!(error_in_words(&deviation("momentum_x", false, false)), "0.0230 ± 0.0010");
    }

    #[test]
    fn durations_are_in_units_of_their_size() {
        assert_eq!([7.0, 600.0, 10_000.0, 864_000.0].map(duration), ["7 s", "10 minutes", "3 hours", "10 days"]);
    }

    #[test]
    fn the_choice_is_the_cheapest_that_meets_the_target_and_cheaper_ones_may_be_open() {
        let steps = ["time.step=0.01,0.02,0.04"];
        let choices = [(4.0, 20.01, 0.01), (2.0, 20.1, 0.01), (1.0, 20.2, 0.1)].map(Some);
        let (_, summary) = made_up::summary(&steps, "1%", &choices);
        let text = summary.advice();
        assert!(text.starts_with("Choose step = 0.02, at 2 s a unit of simulated time"), "{text}");
        assert!(text.contains("  time.step: 0.02\n") && text.contains("  time.steps: "), "{text}");
        assert!(text.contains("Of what costs less it is open: step = 0.04."), "{text}");
    }

    #[test]
    fn where_no_choice_meets_the_target_the_nearest_is_named_and_what_to_vary() {
        let keys = ["time.step=0.02,0.04", "integrator.type=splitting,groot-warren"];
        let choices = [(4.0, 20.6, 0.02), (3.0, 20.7, 0.02), (2.0, 22.0, 0.02), (1.0, 23.0, 0.02)].map(Some);
        let (_, summary) = made_up::summary(&keys, "1%", &choices);
        let text = summary.advice();
        let nearest =
            "No choice meets the targets. step = 0.02, type = splitting comes nearest: its pressure is off by ";
        assert!(text.starts_with(nearest) && text.contains("3.2 times as much as it may be"), "{text}");
        let most = "Of what was varied `time.step` matters most: with 0.04 it is off by 10.00 ± 0.10 %";
        assert!(text.contains(most) && !text.contains("it is open"), "{text}");
        // Where all are off alike nothing is said of what matters.
        let alike = [(4.0, 20.6, 0.02), (3.0, 20.6, 0.02), (2.0, 20.6, 0.02), (1.0, 20.6, 0.02)].map(Some);
        let text = made_up::summary(&keys, "1%", &alike).1.advice();
        assert!(text.starts_with("No choice meets") && !text.contains("matters most"), "{text}");
        // An error within two of its own errors of the target may meet it.
        let open = [Some((4.0, 20.15, 0.1)), Some((1.0, 23.0, 0.02))];
        let text = made_up::summary(&["time.step=0.02,0.04"], "1%", &open).1.advice();
        let undecided =
            "Undecided: no choice is known to meet the targets, and of some it is open. step = 0.02 comes nearest";
        assert!(
            text.starts_with(undecided) && text.contains("A smaller --error or a larger --budget decides it."),
            "{text}"
        );
        assert!(!text.contains("No choice meets") && !text.contains("Vary other keys"), "{text}");
        // Nothing is near where all became unstable.
        let text = made_up::summary(&keys, "1%", &[None; 4]).1.advice();
        assert!(text.starts_with("No choice meets the targets. Vary other keys"), "{text}");
    }

    #[test]
    fn the_page_says_what_is_conserved_and_by_which_choice() {
        let (_, mut summary) =
            made_up::summary(&["time.step=0.01,0.02"], "1%", &[Some((2.0, 20.0, 0.1)), Some((1.0, 20.0, 0.1))]);
        for choice in &mut summary.choices {
            choice.conserved_exactly = vec!["total mass".to_owned(), "total momentum, to the last bit".to_owned()];
        }
        let page_of = |summary: &TradeoffSummary| page(summary, "fluid");
        assert!(page_of(&summary).contains("- all choices: total mass; total momentum, to the last bit\n"));
        summary.choices[1].conserved_exactly.pop();
        let text = page_of(&summary);
        assert!(
            text.contains("- step = 0.02: total mass\n") && text.contains("- step = 0.01: total mass; total"),
            "{text}"
        );
    }
}
