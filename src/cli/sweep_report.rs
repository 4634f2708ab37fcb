//! What a sweep says to its user apart from how far it is: warnings, and a table at the end.

use mesoscope::families;
use mesoscope::output::summary::Unequilibrated;
use mesoscope::quantity::{Quantity, Unit};
use mesoscope::run::printed_estimate;
use mesoscope::sweep::{SweepOutcome, Variant, VariantState};
use serde_json::{Map, Value};

use super::line;
use super::report::{marked, marks};
use super::table::aligned;

/// Columns of the table at the end, where a variant has them: the total energy, and what does not grow with the number
/// of particles.
fn shown() -> impl Iterator<Item = &'static str> {
    let usual = Quantity::usual().filter(|quantity| quantity.unit != Unit::Energy).map(|quantity| quantity.name);
    std::iter::once("total_energy").chain(usual)
}

/// Writes lines for the user, each about a variant; one about several is written once, with their names unless they are all.
fn print(texts: &[(String, &str)], variants: usize) {
    for (place, (text, _)) in texts.iter().enumerate() {
        let same = |(other, _): &&(String, &str)| other == text;
        if texts[..place].iter().any(|other| same(&other)) {
            continue;
        }
        let names: Vec<&str> = texts.iter().filter(same).map(|(_, name)| *name).collect();
        let names = if names.len() == variants { String::new() } else { format!(" (`{}`)", names.join("`, `")) };
        line(&format!("{text}{names}"));
    }
}

/// Warnings about the scenes.
pub fn warn(variants: &[&Variant]) {
    let texts = variants.iter().flat_map(|variant| {
        let notices = variant.scene.notices().iter().map(|notice| format!("note: {notice}"));
        let warnings = families::warnings(&variant.scene).into_iter().map(|warning| format!("warning: {warning}"));
        notices.chain(warnings).map(|text| (text, variant.name.as_str()))
    });
    print(&texts.collect::<Vec<_>>(), variants.len());
}

/// What the runs themselves gave rise to; means that include the way to equilibrium are marked in the table.
pub fn warn_of_results(variants: &[&Variant], outcome: &SweepOutcome) {
    let texts = variants.iter().zip(&outcome.summary.variants).flat_map(|(variant, summary)| {
        let of_scene = families::warnings(&variant.scene);
        let before = variant.scene.notices().iter().chain(&of_scene).map(ToString::to_string);
        let known: Vec<String> = before.chain(summary.unequilibrated.as_ref().map(ToString::to_string)).collect();
        let new = summary.warnings.iter().filter(move |warning| !known.contains(warning));
        new.map(|warning| (format!("warning: {warning}"), variant.name.as_str()))
    });
    print(&texts.collect::<Vec<_>>(), variants.len());
}

/// The table at the end and the files written.
pub fn results(outcome: &SweepOutcome, directory: &str) -> String {
    let variants = &outcome.summary.variants;
    let columns: Vec<&str> = shown()
        .filter(|name| variants.iter().any(|v| v.means.get(*name).and_then(printed_estimate).is_some()))
        .collect();
    let mut header = vec!["VARIANT".to_owned()];
    header.extend(columns.iter().map(|name| name.replace('_', " ").to_uppercase()));
    header.push("TIME".to_owned());
    let mut rows = vec![header];
    let shown = |means: &Map<String, Value>, is_spoilt: &dyn Fn(&str) -> bool| -> Vec<String> {
        let cell = |name: &&str| Some(marked(means.get(*name).and_then(printed_estimate)?, is_spoilt(name)));
        columns.iter().map(|name| cell(name).unwrap_or_default()).collect()
    };
    for variant in variants {
        let mut row = vec![variant.name.clone()];
        if variant.state == VariantState::Finished {
            let is_spoilt = |name: &str| variant.unequilibrated.as_ref().is_some_and(|found| found.includes(name));
            row.extend(shown(&variant.means, &is_spoilt));
            row.push(format!("{:.2} s", variant.wall_seconds));
        } else {
            row.push(variant.state.to_string());
        }
        rows.push(row);
    }
    let averages = &outcome.summary.averages;
    if let Some(average) = averages.first() {
        rows.extend([Vec::new(), vec![format!("MEAN OF {} SEEDS", average.seeds)]]);
        rows.extend(averages.iter().map(|average| {
            let is_spoilt = |name: &str| average.unequilibrated.iter().any(|known| known == name);
            [vec![average.label.clone()], shown(&average.means, &is_spoilt)].concat()
        }));
    }
    let unequilibrated = variants.iter().filter_map(|variant| variant.unequilibrated.clone());
    let note = marks(&rows, unequilibrated.reduce(Unequilibrated::and).as_ref());
    format!("{}{note}wrote {directory}/: {}\n", aligned(&rows, "  "), outcome.files.join(", "))
}
