//! One plot of all variants for every quantity.

use super::files;
use super::means_chart;
use super::summary::SweepSummary;
use super::variant::VariantState;
use crate::measure::statistics::independent;
use crate::output::{RunDirectory, Summary, files as run_files};
use crate::plot::{Chart, Series, SeriesInk, SeriesStyle, overlay_chart};
use crate::run;
use crate::study::{
    Charts, SEED, Setting, ShortKeys, StudyError, Sweep, Variant, by_key, each_once, numbers, parameter_name,
};
use crate::table::Table;

/// A scale of colours says more than colours apart from more than this many values on.
const FEW: usize = 5;

/// The plots of all variants that are finished, from the tables that they left.
pub(super) fn charts<'c>(
    sweep: &'c Sweep,
    summary: &'c SweepSummary,
    place: &RunDirectory,
) -> Result<Charts<'c>, StudyError> {
    let mut finished: Vec<(&Variant, SeriesInk, Table)> = Vec::new();
    for ((variant, ink), ended) in sweep.variants().iter().zip(inks(sweep)).zip(&summary.variants) {
        if ended.state == VariantState::Finished {
            let run = RunDirectory::open(place.file(&variant.name))?;
            run.check_run(ended.run_id, files::SUMMARY)?;
            Summary::load(&run.file(run_files::SUMMARY))?.check_table(&run, run_files::ENERGIES)?;
            let table = run::read_energies(&run.file(run_files::ENERGIES), &variant.scene, ended.steps)?;
            finished.push((variant, ink, table));
        }
    }
    let look = &summary.plots;
    let is_shown = |column: &&String| {
        let is_asked = look.quantities.is_empty() || look.quantities.contains(column);
        is_asked && !["step", "time"].contains(&column.as_str())
    };
    let quantities = each_once(finished.iter().flat_map(|(_, _, table)| &table.columns).filter(is_shown).cloned());
    let of_quantity = move |quantity: String| -> Option<(String, Chart)> {
        let mut without: Vec<&str> = Vec::new();
        let found = finished.iter().filter_map(|(variant, ink, table)| {
            let found = points(table, &quantity, look.relative);
            if found.is_none() {
                without.push(&variant.label);
            }
            let (seeds, others) =
                variant.settings.iter().cloned().partition::<Vec<_>, _>(|setting| setting.key == SEED);
            Some(((others, seeds.is_empty()), Curve { variant, ink: *ink, points: found? }))
        });
        let groups = by_key(found);
        let averaged = groups.iter().any(|(_, members)| members.len() > 1);
        let numbered = (0..).zip(&groups);
        let curves = numbered.flat_map(|(number, ((own, _), members))| curves_of_seeds(number, own, members));
        let curves: Vec<Series> = curves.collect();
        if curves.is_empty() || look.quantities.is_empty() && !changes(&curves) {
            return None;
        }
        let title = finished.first().map_or("", |(variant, _, _)| variant.scene.title.as_str());
        let mut subtitle = subtitle(sweep, summary);
        if averaged {
            subtitle.push_str("; thick: means over seeds, in a band of their standard errors; thin: single seeds");
        }
        if !without.is_empty() {
            subtitle = format!("{subtitle}; without {}", without.join(", "));
        }
        Some((files::plot(&quantity), overlay_chart(title, &subtitle, &quantity, look.relative, curves)))
    };
    let means =
        (1..).zip(means_chart::charts(sweep, summary, look)).map(|(number, chart)| (files::means(number), chart));
    Ok(Box::new(means.chain(quantities.into_iter().filter_map(of_quantity))))
}

/// A quantity of a variant over time.
#[derive(Clone)]
struct Curve<'v> {
    variant: &'v Variant,
    ink: SeriesInk,
    points: Vec<[f64; 2]>,
}

/// The curves of variants that differ in their seeds alone, with the number of their group and what they have in
/// common: each of them, thin, behind their mean in a band of its standard error.
fn curves_of_seeds(number: usize, settings: &[Setting], members: &[Curve<'_>]) -> Vec<Series> {
    let ink = |ink: SeriesInk| if ink == SeriesInk::Own { SeriesInk::Numbered(number) } else { ink };
    let mean = mean_curve(members).filter(|_| members.len() > 1);
    let shown = |Curve { variant, ink: own, points }: &Curve<'_>| {
        let (name, style) =
            if mean.is_none() { (variant.label.as_str(), SeriesStyle::Line) } else { ("", SeriesStyle::Thin) };
        Series { style, ..Series::line(name, points.clone()).with_ink(ink(*own)) }
    };
    let mut curves: Vec<Series> = members.iter().map(shown).collect();
    if let (Some((mean, errors)), Some(first)) = (mean, members.first()) {
        let label = if settings.is_empty() { "mean" } else { &ShortKeys::of_settings(settings).label(settings) };
        curves.push(Series::line(label, mean).with_band(errors).with_ink(ink(first.ink)));
    }
    curves
}

/// The mean of curves over their values at the same times, with the standard errors from their scatter; none where
/// times differ.
fn mean_curve(curves: &[Curve<'_>]) -> Option<(Vec<[f64; 2]>, Vec<f64>)> {
    let first = &curves.first()?.points;
    let is_alike = |Curve { points, .. }: &Curve<'_>| {
        points.len() == first.len() && points.iter().zip(first).all(|(a, b)| a[0].total_cmp(&b[0]).is_eq())
    };
    let mean = |(row, [time, _]): (usize, &[f64; 2])| {
        let values: Vec<f64> = curves.iter().map(|curve| curve.points[row][1]).collect();
        let found = independent(&values);
        let error = found.and_then(|found| found.error).unwrap_or(f64::NAN);
        ([*time, found.map_or(f64::NAN, |found| found.value)], error)
    };
    curves.iter().all(is_alike).then(|| first.iter().enumerate().map(mean).unzip())
}

/// What is varied, and what is not in the picture.
fn subtitle(sweep: &Sweep, summary: &SweepSummary) -> String {
    let scene = sweep.variants().first().map(|variant| &variant.scene);
    let name = |key: &str| scene.map_or_else(|| key.to_owned(), |scene| parameter_name(key, scene));
    let keys: Vec<String> = sweep.variations().iter().map(|variation| name(&variation.key)).collect();
    let mut text = format!("{} varied", keys.join(", "));
    for (state, words) in [(VariantState::Failed, "failed"), (VariantState::Waiting, "not finished")] {
        let names: Vec<&str> =
            summary.variants.iter().filter(|variant| variant.state == state).map(|v| v.label.as_str()).collect();
        match names.as_slice() {
            [] => {}
            [only] => text = format!("{text}; {words}: {only}"),
            several => text = format!("{text}; {} variants {words}", several.len()),
        }
    }
    text
}

/// Pairs of time and value, or value over its own first; none where a column is missing or the first value is zero.
fn points(table: &Table, quantity: &str, relative: bool) -> Option<Vec<[f64; 2]>> {
    let (times, values) = (table.column("time")?, table.column(quantity)?);
    let first = if relative { values.iter().copied().find(|value| value.is_finite())? } else { 1.0 };
    (first != 0.0).then(|| times.into_iter().zip(values).map(|(time, value)| [time, value / first]).collect())
}

/// Whether there is more to see than one horizontal line.
fn changes(curves: &[Series]) -> bool {
    let mut values =
        curves.iter().flat_map(|curve| &curve.points).map(|point| point[1]).filter(|value| value.is_finite());
    let first = values.next();
    values.any(|value| Some(value) != first)
}

/// What each variant is drawn with: where one key has more than a few numbers as values, and no other has, colours on
/// a scale in the order of these numbers, and dashes for the other keys; variants that are none of their combinations in the ink of the axes.
fn inks(sweep: &Sweep) -> Vec<SeriesInk> {
    let varied = sweep.variations();
    // Seeds are averaged.
    let many = (0..varied.len()).filter(|place| varied[*place].values.len() > FEW && varied[*place].key != SEED);
    let many: Vec<usize> = many.collect();
    let only = if let [only] = many[..] { numbers(&varied[only].values).map(|values| (only, values)) } else { None };
    let Some((scaled, values)) = only else { return vec![SeriesInk::Own; sweep.variants().len()] };
    let last = (values.len() - 1) as f64;
    let place_on_scale = |index: usize| values.iter().filter(|value| **value < values[index]).count() as f64 / last;
    let mut further = 0;
    let ink = |variant: &Variant| {
        let Some(index) = variant.places.get(scaled) else {
            further += 1;
            return SeriesInk::Ink { pattern: further };
        };
        // Dashes count through the combinations of the other keys.
        let others = (0..variant.places.len()).filter(|place| *place != scaled && varied[*place].key != SEED);
        let pattern = others.fold(0, |pattern, place| pattern * varied[place].values.len() + variant.places[place]);
        SeriesInk::Scale { place: place_on_scale(*index), pattern }
    };
    sweep.variants().iter().map(ink).collect()
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    fn inks_of(vary: &[&str], also: &[&str]) -> Vec<SeriesInk> {
        let owned = |texts: &[&str]| texts.iter().map(|text| (*text).to_owned()).collect::<Vec<_>>();
        inks(&Sweep::load("dpd-fluid", &[], None, &owned(vary), &owned(also)).unwrap())
    }

    #[test]
    fn many_numbers_are_colours_on_a_scale_in_their_order() {
        let found = inks_of(&["interactions.0.friction=9,1,3,2,5,7"], &["temperature=0"]);
        let places: Vec<f64> = [5, 0, 2, 1, 3, 4].iter().map(|rank| f64::from(*rank) / 5.0).collect();
        for (ink, place) in found.iter().zip(&places) {
            assert_eq!(*ink, SeriesInk::Scale { place: *place, pattern: 0 });
        }
        assert_eq!(found[6], SeriesInk::Ink { pattern: 1 });
    }

    #[test]
    fn few_values_and_words_have_colours_of_their_own() {
        assert_eq!(inks_of(&["seed=1,2,3,4,5"], &["seed=6"]), [SeriesInk::Own; 6]);
        assert_eq!(inks_of(&["title=a,b,c,d,e,f"], &[]), [SeriesInk::Own; 6]);
        assert_eq!(inks_of(&["seed=1,2,3,4,5,6"], &[]), [SeriesInk::Own; 6]);
    }

    #[test]
    fn a_second_key_is_told_by_dashes() {
        let found = inks_of(&["time.step=0.01,0.02", "temperature=1,2,3,4,5,6"], &[]);
        assert_eq!(found[0], SeriesInk::Scale { place: 0.0, pattern: 0 });
        assert_eq!(found[11], SeriesInk::Scale { place: 1.0, pattern: 1 });
    }

    #[test]
    fn single_seeds_are_thin_behind_their_mean() {
        let arguments = ["temperature=1,2", "seed=1,2"].map(str::to_owned);
        let sweep = Sweep::load("dpd-fluid", &[], None, &arguments, &[]).unwrap();
        let [one, other] = [&sweep.variants()[0], &sweep.variants()[1]];
        let settings = vec![one.settings[0].clone()];
        let own = SeriesInk::Own;
        let curve = |variant, points: [[f64; 2]; 2]| Curve { variant, ink: own, points: points.to_vec() };
        let members = [curve(one, [[0.0, 1.0], [1.0, 3.0]]), curve(other, [[0.0, 2.0], [1.0, 5.0]])];
        let curves = curves_of_seeds(3, &settings, &members);
        let seen: Vec<(SeriesStyle, &str)> = curves.iter().map(|curve| (curve.style, curve.name.as_str())).collect();
        assert_eq!(seen, [(SeriesStyle::Thin, ""), (SeriesStyle::Thin, ""), (SeriesStyle::Band, "temperature = 1")]);
        assert_eq!(curves[2].points, [[0.0, 1.5], [1.0, 4.0]]);
        // Half the difference of two values, by Student's factor of 1.84 for 68 %.
        let errors = curves[2].errors.as_ref().unwrap();
        assert!((errors[0] / 0.5 - 1.837).abs() < 0.01 && (errors[1] / errors[0] - 2.0).abs() < 1e-9, "{errors:?}");
        assert!(curves.iter().all(|curve| curve.ink == SeriesInk::Numbered(3)));
        let mut unlike = members;
        unlike[1].points[1][0] = 1.5;
        let curves = curves_of_seeds(0, &settings, &unlike);
        assert!(curves.len() == 2 && curves.iter().all(|curve| !curve.name.is_empty()), "no mean of unlike times");
    }

    #[test]
    fn relative_values_begin_with_one() {
        let table = Table {
            columns: ["step", "time", "a", "b"].map(str::to_owned).to_vec(),
            rows: vec![vec![0.0, 0.0, 4.0, 0.0], vec![1.0, 0.5, 6.0, 1.0]],
        };
        assert_eq!(points(&table, "a", true).unwrap(), [[0.0, 1.0], [0.5, 1.5]]);
        assert_eq!(points(&table, "a", false).unwrap(), [[0.0, 4.0], [0.5, 6.0]]);
        assert_eq!(points(&table, "b", true), None);
        assert_eq!(points(&table, "c", false), None);
    }
}
