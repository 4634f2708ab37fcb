//! Which means of a run include the way to equilibrium, and what to do about it.

use crate::families::Model;
use crate::measure::equilibration::transient;
use crate::output::summary::{Unequilibrated, UnsettledMean};
use crate::quantity::{QUANTITIES, Quantity};
use crate::scene::Scene;
use crate::table::Table;

/// Whether the means of a scene are meant to be those of equilibrium: where it says how long to wait for that, and for
/// thermal particles anyway. Flows of water, cells that warm up or slow down and chains with a pulse are about the way.
pub(super) fn is_about_equilibrium(scene: &Scene, model: &Model) -> bool {
    let particles = model.physics().reaches_equilibrium();
    scene.time.equilibration > 0 || particles && model.temperature > 0.0
}

/// The quantities whose rows from the step `equilibration` on begin with a transient, in a table whose first column is the step.
pub(super) fn unequilibrated(table: &Table, equilibration: u64) -> Option<Unequilibrated> {
    let first = table.rows.iter().position(|row| row[0] >= equilibration as f64)?;
    let rows = &table.rows[first..];
    let last_step = rows.last()?[0] as u64;
    let mut means = Vec::new();
    for Quantity { name, .. } in QUANTITIES.iter().filter(|quantity| quantity.settles) {
        let Some(column) = table.columns.iter().position(|column| column == name) else { continue };
        let known: Vec<&Vec<f64>> = rows.iter().filter(|row| row[column].is_finite()).collect();
        let series: Vec<f64> = known.iter().map(|row| row[column]).collect();
        if let Some(found) = transient(&series) {
            let settled_from = known.get(found.samples).filter(|_| found.settles).map(|row| row[0] as u64);
            means.push(UnsettledMean { quantity: (*name).to_owned(), settled_from, mean_from_there: found.mean });
        }
    }
    // Where one does not settle, a run as long as this one has to be over before averages begin.
    let settled = means.iter().map(|mean| mean.settled_from).collect::<Option<Vec<u64>>>();
    let (wait, steps) = if let Some(steps) = settled {
        (rounded_up(steps.into_iter().max()?), None)
    } else {
        let wait = rounded_up(last_step);
        (wait, Some(wait.saturating_add(rounded_up(last_step.saturating_sub(equilibration)))))
    };
    (!means.is_empty()).then_some(Unequilibrated { means, equilibration: wait, steps })
}

/// The next number of at most two digits and zeros.
fn rounded_up(number: u64) -> u64 {
    let mut unit = 1;
    while number / unit >= 100 {
        unit *= 10;
    }
    number.div_ceil(unit).saturating_mul(unit)
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, clippy::panic)]
    use super::*;
    use crate::noise::{gaussian, step_key};

    /// A table with a row every ten steps, whose temperature begins far out and whose pressure is steady.
    fn table(rows: u64, decay: f64) -> Table {
        let row = |index: u64| {
            let noise = |stream: u32| 0.1 * gaussian(step_key(3, stream, index));
            let far = 5.0 * (-(index as f64) / decay).exp();
            vec![10.0 * index as f64, 1.0 + far + noise(1), 20.0 + noise(2), 0.1 * index as f64]
        };
        let columns = ["step", "temperature", "pressure", "limited_exchanges"].map(str::to_owned).to_vec();
        Table::new(columns, (0..rows).map(row).collect())
    }

    #[test]
    fn a_transient_is_told_with_what_leaves_it_out() {
        let table = table(500, 10.0);
        let found = unequilibrated(&table, 0).unwrap();
        let [mean] = &found.means[..] else { panic!("{found:?}") };
        assert_eq!(mean.quantity, "temperature");
        assert!((mean.mean_from_there - 1.0).abs() < 0.05 && found.steps.is_none(), "{found:?}");
        assert!((300..1000).contains(&found.equilibration), "{found:?}");
        let text = format!(
            "the mean of `temperature` includes the way to equilibrium: leave it out with `--set time.equilibration={}`",
            found.equilibration
        );
        assert_eq!(found.to_string(), text);
        // Which indeed leaves it out.
        assert_eq!(unequilibrated(&table, found.equilibration), None);
    }

    #[test]
    fn a_run_that_never_settles_is_to_be_longer() {
        let found = unequilibrated(&table(100, 60.0), 0).unwrap();
        assert_eq!((found.equilibration, found.steps, found.means[0].settled_from), (990, Some(1980), None));
        let text = found.to_string();
        assert!(text.ends_with("run longer, as with `--set time.equilibration=990 --steps 1980`"), "{text}");
    }

    #[test]
    fn numbers_are_rounded_up_to_two_digits() {
        assert_eq!([0, 7, 99, 100, 101, 1234, 65_000].map(rounded_up), [0, 7, 99, 100, 110, 1300, 65_000]);
        assert_eq!(rounded_up(u64::MAX), u64::MAX);
    }

    #[test]
    fn flows_and_pulses_are_about_the_way() {
        for (name, overrides, expected) in [
            ("dpd-fluid", "time.equilibration=0", true),
            ("dpd-fluid", "temperature=0", true),
            ("shallow-water", "seed=1", false),
            ("shallow-water-equilibrium", "seed=1", true),
            ("voronoi-dpd", "seed=1", false),
            ("voronoi-dpd", "time.equilibration=100", true),
            ("harmonic-chain", "seed=1", false),
        ] {
            let scene = crate::scene::load(name, &[overrides.to_owned()]).unwrap();
            assert_eq!(is_about_equilibrium(&scene, scene.model()), expected, "{name} {overrides}");
        }
    }
}
