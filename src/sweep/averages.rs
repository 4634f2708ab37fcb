//! Averages over the seed: variants that differ in nothing else are samples of one.

use super::observables::{Observable, observables};
use super::variant::{VariantState, VariantSummary};
use crate::measure::statistics::{Estimate, independent};
use crate::study::{SEED, Setting, ShortKeys, by_key};
use serde::{Deserialize, Serialize};
use serde_json::{Map, Value};

/// What variants that differ in their seeds alone have in common.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct SeedAverage {
    /// What a legend calls them.
    pub label: String,
    /// What distinguishes them from others.
    pub settings: Vec<Setting>,
    /// Number of seeds that are finished.
    pub seeds: usize,
    /// The mean over seeds of every quantity of the variants, with its standard error from their scatter.
    pub means: Map<String, Value>,
    /// Quantities of which the mean of some seed includes the way to equilibrium.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub unequilibrated: Vec<String>,
}

/// Variants that belong together, in order of the first of each.
pub(super) struct Group<'a> {
    /// What they have in common.
    pub settings: Vec<Setting>,
    /// The variants of it that are finished.
    pub finished: Vec<&'a VariantSummary>,
}

/// The groups of variants: those with the same settings but for the seed, or else each by itself.
pub(super) fn groups(variants: &[VariantSummary]) -> Vec<Group<'_>> {
    let keyed = variants.iter().enumerate().map(|(number, variant)| {
        let mut settings = variant.settings.clone();
        settings.retain(|setting| setting.key != SEED);
        let alone = (settings.len() == variant.settings.len()).then_some(number);
        ((alone, settings), variant)
    });
    let groups = by_key(keyed).into_iter().map(|((_, settings), mut variants)| {
        variants.retain(|variant| variant.state == VariantState::Finished);
        Group { settings, finished: variants }
    });
    groups.collect()
}

impl Group<'_> {
    /// What came out: of one variant as it says itself, of several the mean over them, with its error from their scatter.
    /// Quantities that some of them lack are left out.
    pub(super) fn observables(&self) -> Vec<Observable> {
        let Some((first, others)) = self.finished.split_first() else { return Vec::new() };
        if others.is_empty() {
            return observables(first);
        }
        let others: Vec<Vec<Observable>> = others.iter().map(|variant| observables(variant)).collect();
        let average = |observable: Observable| {
            let found = others.iter().map(|others| others.iter().find(|other| other.name == observable.name));
            let rest: Vec<&Observable> = found.collect::<Option<_>>()?;
            let all = || std::iter::once(&observable).chain(rest.iter().copied());
            let values: Vec<f64> = all().map(|observable| observable.value).collect();
            let unequilibrated = all().any(|observable| observable.unequilibrated);
            let Estimate { value, error, few, .. } = independent(&values)?;
            let from_few_samples = error.is_some() && few;
            Some(Observable { name: observable.name, value, error, from_few_samples, unequilibrated })
        };
        observables(first).into_iter().filter_map(average).collect()
    }
}

/// The averages of all variants of which there is more than one seed.
pub(super) fn averages(variants: &[VariantSummary]) -> Vec<SeedAverage> {
    let several = groups(variants).into_iter().filter(|group| group.finished.len() > 1);
    several
        .map(|group| {
            let seeds = group.finished.len();
            let observables = group.observables();
            let settings = group.settings;
            let spoilt = observables.iter().filter(|observable| observable.unequilibrated);
            let unequilibrated = spoilt.map(|observable| observable.name.clone()).collect();
            let means = observables.into_iter().map(|Observable { name, value, error, .. }| {
                let estimate = Estimate::new(value, error, seeds);
                // Plain numbers and nothing else: this conversion cannot fail.
                (name, serde_json::to_value(estimate).unwrap_or_default())
            });
            let label =
                if settings.is_empty() { "all".to_owned() } else { ShortKeys::of_settings(&settings).label(&settings) };
            SeedAverage { label, settings, seeds, means: means.collect(), unequilibrated }
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    fn variant(settings: &[(&str, Value)], state: VariantState, temperature: f64) -> VariantSummary {
        let settings: Vec<Setting> =
            settings.iter().map(|(key, value)| Setting { key: (*key).to_owned(), value: value.clone() }).collect();
        let means = json!({"temperature": {"value": temperature, "error": 0.5}});
        let results = json!({"diffusion": {"windows": 3, "einstein": {"value": temperature}}});
        let object = |value: Value| value.as_object().cloned().unwrap_or_default();
        VariantSummary { state, means: object(means), results: object(results), ..VariantSummary::blank(settings) }
    }

    /// Worked out by hand: 1, 2 and 6 have the mean 3 and the error √((4 + 1 + 9)/(3·2)).
    #[test]
    fn seeds_are_samples_of_one_variant() {
        let finished = VariantState::Finished;
        let seeds = |friction: f64, values: &[f64]| -> Vec<VariantSummary> {
            let one = |(seed, value): (usize, &f64)| {
                variant(&[("a.friction", json!(friction)), ("seed", json!(seed))], finished, *value)
            };
            values.iter().enumerate().map(one).collect()
        };
        let mut variants = [seeds(1.0, &[1.0, 2.0, 6.0]), seeds(9.0, &[4.0, 4.0])].concat();
        variants.push(variant(&[("a.friction", json!(9.0)), ("seed", json!(7))], VariantState::Failed, 1e9));
        variants.push(variant(&[("a.friction", json!(20))], finished, 5.0));
        let found = averages(&variants);
        assert_eq!(
            found.iter().map(|average| average.label.as_str()).collect::<Vec<_>>(),
            ["friction = 1.0", "friction = 9.0"]
        );
        assert_eq!(found.iter().map(|average| average.seeds).collect::<Vec<_>>(), [3, 2]);
        let temperature = &found[0].means["temperature"];
        assert_eq!(temperature["value"], json!(3.0));
        assert_eq!(temperature["error"].as_f64(), independent(&[1.0, 2.0, 6.0]).and_then(|found| found.error));
        assert_eq!((&temperature["samples"], &found[0].means["diffusion.windows"]["value"]), (&json!(3), &json!(3.0)));
        assert_eq!(found[0].means["diffusion.einstein"]["value"], json!(3.0));
        assert_eq!(found[1].means["temperature"]["error"], json!(0.0));
        // A variant alone keeps its own error, and without seeds nothing is averaged.
        let groups = groups(&variants);
        assert_eq!(groups.len(), 3);
        assert_eq!(groups[2].observables()[0].error, Some(0.5));
        let alike = [1.0, 2.0].map(|friction| variant(&[("a.friction", json!(friction))], finished, 1.0));
        assert!(averages(&alike).is_empty());
        let only_seeds = [1, 2].map(|seed| variant(&[("seed", json!(seed))], finished, f64::from(seed)));
        assert_eq!(averages(&only_seeds)[0].label, "all");
    }
}
