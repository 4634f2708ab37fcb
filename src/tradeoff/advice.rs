//! The page of a tradeoff: what to choose, in words.

use super::deviation::Deviation;
use super::fields::DISTANCE;
use super::reference::Source;
use super::summary::{Choice, ChoiceState, Float64Stretch, TradeoffSummary};
use super::target::{Target, Verdict};
use crate::numbers::{short, with_error};
use crate::study::{Setting, by_key, in_hours};
use std::fmt::Write as _;

/// Errors that the page names the cheapest choice for.
const ROUND_ERRORS: [f64; 3] = [0.05, 0.01, 0.001];

/// A verdict in a word.
pub(super) fn verdict_word(verdict: Verdict) -> &'static str {
    match verdict {
        Verdict::Meets => "meets",
        Verdict::Open => "open",
        Verdict::Misses => "misses",
    }
}

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
    let value = with_error(reference.value, reference.uncertainty.filter(|error| *error > 0.0));
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
    let text =
        with_error(scale * error.error, error.uncertainty.filter(|found| *found > 0.0).map(|found| scale * found));
    let mark = if error.from_few_samples { format!(" {FEW_SAMPLES}") } else { String::new() };
    format!("{text}{unit}{mark}")
}

/// What marks an error from few samples.
const FEW_SAMPLES: char = '‡';

/// What the mark means, where it is used.
pub(super) fn legend(summary: &TradeoffSummary) -> Option<String> {
    legend_of(summary.choices.iter().flat_map(|choice| &choice.errors))
}

/// What the mark means, if one of these errors has it.
pub(crate) fn legend_of<'e>(mut errors: impl Iterator<Item = &'e Deviation>) -> Option<String> {
    let few = errors.any(|error| error.from_few_samples);
    few.then(|| format!("{FEW_SAMPLES} from few samples: the standard error is taken three times as large as they say"))
}

/// That the runs are not as long as they should be, and what makes them longer; nothing where they are.
pub(super) fn short_of_errors(summary: &TradeoffSummary) -> Option<String> {
    let more = match &summary.wanted {
        Some(wanted) => format!("{wanted}, and wants --yes"),
        None if summary.arguments.length.budget.is_some() => "a larger --budget makes them longer".to_owned(),
        None => "--set time.steps=N begins with longer ones".to_owned(),
    };
    summary.is_short.then(|| format!("The runs ended before all errors were as small as asked for: {more}"))
}

/// The whole page, in Markdown.
pub(super) fn page(summary: &TradeoffSummary, title: &str) -> String {
    let mut text = format!("# What accuracy costs: {title}\n\n");
    let adapter = summary.adapter.as_ref().map_or("an unknown adapter", |adapter| &adapter.name);
    let (count, time) = (summary.choices.len(), short(summary.averaged_time()));
    let _ = writeln!(
        text,
        "{count} choices, each averaged over {time} units of simulated time after {} of equilibration, on {adapter}. \
         Costs are medians of steps timed in turns, without reports.\n",
        short(summary.stretch.equilibration)
    );
    for note in &notes(summary) {
        let _ = writeln!(text, "{note}\n");
    }
    if let Some(short) = short_of_errors(summary) {
        let _ = writeln!(text, "**{short}.**\n");
    }
    targets(&mut text, summary);
    table(&mut text, summary);
    costs(&mut text, summary);
    conserved(&mut text, summary);
    for measure in &summary.measures {
        section(&mut text, summary, measure);
    }
    unstable(&mut text, summary);
    text
}

/// What to know before the numbers are trusted.
pub(super) fn notes(summary: &TradeoffSummary) -> Vec<String> {
    let mut notes = Vec::new();
    if !summary.physical_keys.is_empty() {
        notes.push(format!(
            "`{}` changes what is simulated, and not only how it is computed: all choices are compared with the scene as it is.",
            summary.physical_keys.join("`, `")
        ));
    }
    for choice in summary.choices.iter().chain(&summary.finer) {
        let spoilt: Vec<&str> = choice.unequilibrated.iter().map(String::as_str).collect();
        if spoilt.iter().any(|column| summary.measures.iter().any(|measure| measure == column)) {
            let note = format!(
                "Means of {} include the way to equilibrium ({}): set a longer time.equilibration.",
                choice.label,
                spoilt.join(", ")
            );
            // A choice may be the run that others are compared with.
            if !notes.contains(&note) {
                notes.push(note);
            }
        }
    }
    notes.extend(same_runs(summary));
    notes.extend(refused_steps(summary));
    notes
}

/// Choices that came to their end though a run of their scene alone is refused.
fn refused_steps(summary: &TradeoffSummary) -> Vec<String> {
    let finished = summary.choices.iter().filter(|choice| choice.state == ChoiceState::Finished);
    let note = |choice: &Choice| {
        let refusal = choice.refusal.as_ref()?;
        Some(format!("{} is never chosen, for `mesoscope run` refuses its scene: {refusal}.", choice.label))
    };
    finished.filter_map(note).collect()
}

/// Choices whose runs measure the same to the last digit: what tells them apart makes no difference to them.
fn same_runs(summary: &TradeoffSummary) -> Vec<String> {
    let measured = summary.choices.iter().filter(|choice| choice.measured.iter().any(|found| found.fluctuates));
    let groups = by_key(measured.map(|choice| ((choice.steps, &choice.measured), format!("`{}`", choice.label))));
    let in_words = |labels: Vec<String>| {
        format!(
            "{} are the same run, to the last digit of all that is measured: what tells them apart can only change what a step costs.",
            labels.join(" and ")
        )
    };
    groups.into_iter().map(|(_, labels)| labels).filter(|labels| labels.len() > 1).map(in_words).collect()
}

/// Targets that no choice can be said to meet, as they are parts of nothing.
fn parts_of_nothing(summary: &TradeoffSummary) -> Vec<String> {
    let of_nothing = |target: &Target| target.part_of_nothing(summary.reference(&target.measure)?);
    summary.arguments.targets.iter().filter_map(of_nothing).collect()
}

/// The targets, and which choice meets them.
fn targets(text: &mut String, summary: &TradeoffSummary) {
    let targets = &summary.arguments.targets;
    if targets.is_empty() {
        return;
    }
    let wanted = targets.iter().map(Target::to_string).collect::<Vec<_>>().join(", ");
    let _ = writeln!(text, "## {wanted}\n");
    verdict(text, summary, ["**", "    "]);
}

/// Which choice meets the targets and what to write into the scene, or which comes nearest. `bold` and `indent` are what the format
/// marks with.
pub(super) fn verdict(text: &mut String, summary: &TradeoffSummary, [bold, indent]: [&str; 2]) {
    if let Some(choice) = summary.choice() {
        let cost = choice.cost.map_or_else(String::new, |cost| {
            format!(", at {} s a unit of simulated time", with_error(cost.seconds_per_time, None))
        });
        let _ = writeln!(
            text,
            "Choose {bold}{}{bold}{cost}: the cheapest that meets the targets, with two standard errors.\n",
            choice.label
        );
        for line in lines(&summary.lines_of(choice)) {
            let _ = writeln!(text, "{indent}{line}");
        }
        text.push('\n');
        let cost = |choice: &Choice| choice.cost.map_or(f64::INFINITY, |cost| cost.seconds_per_time);
        let open =
            summary.choices.iter().filter(|other| other.verdict == Some(Verdict::Open) && cost(other) < cost(choice));
        let open: Vec<&str> = open.map(|other| other.label.as_str()).collect();
        if !open.is_empty() {
            let _ = writeln!(
                text,
                "Of what costs less it is open: {}. A smaller --error or a larger --budget decides it.\n",
                open.join("; ")
            );
        }
        return;
    }
    let of_nothing = parts_of_nothing(summary);
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
    let _ = write!(text, "{bold}{found}{bold} ");
    if !of_nothing.is_empty() {
        for reason in of_nothing {
            let _ = write!(text, "{}. ", capitalised(&reason));
        }
        text.push_str("\n\n");
        return;
    }
    let nearest = nearest(summary);
    if let Some((choice, target, factor)) = nearest {
        let error = choice.error(&target.measure).map_or_else(String::new, error_in_words);
        let _ = write!(
            text,
            "{} comes nearest: its {} is off by {error}, with two standard errors {} times as much as it may be. ",
            choice.label,
            target.measure,
            with_error(factor, None)
        );
    }
    if is_open {
        text.push_str("A smaller --error or a larger --budget decides it.\n\n");
        return;
    }
    let further = nearest.and_then(|(choice, target, _)| what_to_vary(summary, choice, target));
    text.push_str(&further.unwrap_or_default());
    text.push_str("Vary other keys, or a smaller time step.\n\n");
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
    let (setting, error) = others.max_by(|(_, a), (_, b)| a.size().total_cmp(&b.size()))?;
    let is_seen =
        error.size() > own.size() + 2.0 * error.uncertainty.unwrap_or(0.0).hypot(own.uncertainty.unwrap_or(0.0));
    is_seen.then(|| {
        format!(
            "Of what was varied `{}` matters most: with {} it is off by {}; values beyond that of the nearest may be better. ",
            setting.key,
            setting.value,
            error_in_words(error)
        )
    })
}

/// The choice whose worst error, as a multiple of its target, is least; with that target and the multiple.
fn nearest(summary: &TradeoffSummary) -> Option<(&Choice, &Target, f64)> {
    let worst = |choice| {
        let choice: &Choice = choice;
        let factor = |target| {
            let target: &Target = target;
            let (error, reference) = (choice.error(&target.measure)?, summary.reference(&target.measure)?);
            let upper = error.size() + 2.0 * error.uncertainty.unwrap_or(0.0);
            Some((choice, target, upper / target.most(reference.value, error.relative)))
        };
        // A choice that lacks a measure is not near.
        let factors: Option<Vec<_>> = summary.arguments.targets.iter().map(factor).collect();
        factors?.into_iter().max_by(|a, b| a.2.total_cmp(&b.2))
    };
    summary.choices.iter().filter_map(worst).min_by(|a, b| a.2.total_cmp(&b.2))
}

/// The lines of a scene that a choice changes, as overrides.
pub(super) fn lines(settings: &[Setting]) -> Vec<String> {
    settings.iter().map(|setting| format!("{}: {}", setting.key, setting.value)).collect()
}

/// All choices in one table.
fn table(text: &mut String, summary: &TradeoffSummary) {
    text.push_str("| choice | s a unit of time |");
    for measure in &summary.measures {
        let _ = write!(text, " {} |", measure.replace('_', " "));
    }
    text.push_str("\n|---|--:|");
    text.push_str(&"--:|".repeat(summary.measures.len()));
    text.push('\n');
    for choice in &summary.choices {
        let cost = choice.cost.map_or_else(|| "—".to_owned(), |cost| with_error(cost.seconds_per_time, None));
        let _ = write!(text, "| {} | {cost} |", choice.label);
        for measure in &summary.measures {
            let error = choice.error(measure).map_or_else(|| "—".to_owned(), error_in_words);
            let _ = write!(text, " {error} |");
        }
        text.push('\n');
    }
    text.push_str("\nErrors with standard errors, in per cent of the reference of the measure, or of what a drift, a distance or a share is a part of.");
    text.extend(legend(summary).map(|legend| format!(" {legend}.")));
    let distances = summary.choices.iter().filter_map(|choice| choice.float64_distance);
    if let Some(largest) = distances.reduce(f64::max) {
        let _ = write!(
            text,
            " One step of the device is off from float64 by {} of what the step changes, at most.",
            with_error(largest, None)
        );
    }
    let stretches = summary.choices.iter().filter_map(|choice| choice.float64_stretch);
    let farthest = stretches.filter(|stretch| stretch.steps > 1).max_by(|a, b| a.distance.total_cmp(&b.distance));
    if let Some(Float64Stretch { steps, distance }) = farthest {
        let _ = write!(text, " After {steps} steps it is {} of what they change.", with_error(distance, None));
    }
    text.push_str("\n\n");
}

/// What choices cost, in time and memory.
fn costs(text: &mut String, summary: &TradeoffSummary) {
    text.push_str(
        "## Costs\n\n| choice | s a unit of time | fastest and slowest round | particle-steps/s | bytes a particle |\n\
         |---|--:|--:|--:|--:|\n",
    );
    for choice in &summary.choices {
        let Some(cost) = choice.cost else { continue };
        let [median, fastest, slowest] =
            [cost.seconds_per_time, cost.fastest, cost.slowest].map(|seconds| with_error(seconds, None));
        let _ = writeln!(
            text,
            "| {} | {median} | {fastest} to {slowest} | {} | {:.0} |",
            choice.label,
            with_error(cost.particle_steps_per_second, None),
            cost.bytes_per_particle
        );
    }
    text.push('\n');
}

/// What the runs have conserved, and how exactly.
fn conserved(text: &mut String, summary: &TradeoffSummary) {
    let finished: Vec<&Choice> =
        summary.choices.iter().filter(|choice| choice.state == ChoiceState::Finished).collect();
    let mut kinds: Vec<&[String]> = finished.iter().map(|choice| choice.conserved_exactly.as_slice()).collect();
    kinds.sort();
    kinds.dedup();
    if finished.is_empty() {
        return;
    }
    text.push_str("## What is conserved\n\n");
    for kind in &kinds {
        let own = finished.iter().filter(|choice| choice.conserved_exactly == *kind);
        let labels: Vec<&str> = own.map(|choice| choice.label.as_str()).collect();
        let whose = if kinds.len() == 1 { "all choices".to_owned() } else { labels.join("; ") };
        let what = if kind.is_empty() { "nothing".to_owned() } else { kind.join("; ") };
        let _ = writeln!(text, "- {whose}: {what}");
    }
    text.push('\n');
}

/// The beginning of a sentence.
fn capitalised(text: &str) -> String {
    let mut rest = text.chars();
    rest.next().into_iter().flat_map(char::to_uppercase).chain(rest).collect()
}

/// What a measure says.
fn section(text: &mut String, summary: &TradeoffSummary, measure: &str) {
    let _ = writeln!(text, "## {}\n", measure.replace('_', " "));
    let _ = writeln!(text, "{}.\n", capitalised(&reference_in_words(summary, measure)));
    if measure.ends_with(DISTANCE) {
        let _ = writeln!(text, "The finer run is one{}.\n", finer_in_words(summary));
    }
    let mut front: Vec<(&Choice, &Deviation)> = summary
        .choices
        .iter()
        .filter_map(|choice| Some((choice, choice.error(measure).filter(|error| error.on_front)?)))
        .collect();
    let cost = |choice: &Choice| choice.cost.map_or(f64::INFINITY, |cost| cost.seconds_per_time);
    front.sort_by(|a, b| cost(a.0).total_cmp(&cost(b.0)));
    if front.is_empty() {
        text.push_str("No choice has both a cost and an error.\n\n");
        return;
    }
    text.push_str("The Pareto front, from the cheapest on:\n\n");
    for (choice, error) in &front {
        let noise = if error.is_within_noise() { " (within its statistical error)" } else { "" };
        let _ = writeln!(
            text,
            "- {}: {} s, off by {}{noise}",
            choice.label,
            with_error(cost(choice), None),
            error_in_words(error)
        );
    }
    text.push('\n');
    of_schemes(text, summary, measure);
    for bound in ROUND_ERRORS {
        let within = |error: &Deviation| {
            error.relative && error.uncertainty.is_some_and(|known| error.size() + 2.0 * known <= bound)
        };
        let cheapest = summary
            .choices
            .iter()
            .filter(|choice| choice.error(measure).is_some_and(within))
            .min_by(|a, b| cost(a).total_cmp(&cost(b)));
        if let Some(choice) = cheapest {
            let _ = writeln!(text, "The cheapest within {} %: {}.", short(100.0 * bound), choice.label);
        }
    }
    text.push('\n');
}

/// The errors that schemes have by themselves, where they are known, next to what was measured.
fn of_schemes(text: &mut String, summary: &TradeoffSummary, measure: &str) {
    let known = summary.choices.iter().filter_map(|choice| {
        let error = choice.error(measure)?;
        Some((choice, error, error.of_scheme?))
    });
    let mut known = known.peekable();
    if known.peek().is_none() {
        return;
    }
    text.push_str("What theory says of the scheme with its time step, and what was measured:\n\n");
    for (choice, error, of_scheme) in known {
        let of_scheme = Deviation { error: of_scheme, uncertainty: None, ..error.clone() };
        let _ =
            writeln!(text, "- {}: {}, measured {}", choice.label, error_in_words(&of_scheme), error_in_words(error));
    }
    text.push('\n');
}

/// Choices that became unstable.
fn unstable(text: &mut String, summary: &TradeoffSummary) {
    let mut ended = summary.choices.iter().filter(|choice| choice.state == ChoiceState::Unstable).peekable();
    if ended.peek().is_none() {
        return;
    }
    text.push_str("## Unstable\n\n");
    for choice in ended {
        let _ = writeln!(text, "- {}: {}", choice.label, choice.failure.as_deref().unwrap_or("it became unstable"));
    }
    text.push('\n');
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
