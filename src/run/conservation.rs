//! What a run conserves exactly, what it does not, and why, in words for its summary.

use crate::families::{KeptQuantity, Model};
use crate::state::State;

/// What a model keeps to the last bit.
pub(crate) fn kept(model: &Model) -> Vec<KeptQuantity> {
    let mut kept: Vec<KeptQuantity> =
        model.physics().kept(model, &State::default()).into_iter().map(|sum| sum.quantity).collect();
    kept.dedup();
    kept
}

/// What a run conserves, to the last bit or to rounding where that is said, but for what was seen to be lost. Of `mixed` ranks, which
/// compute differently, the two ends of a pair may be rounded differently.
pub(super) fn conserved(model: &Model, lost: &[KeptQuantity], mixed: bool) -> Vec<String> {
    let mut conserved: Vec<String> = model.physics().never_changes().iter().map(|name| (*name).to_owned()).collect();
    let left = kept(model).into_iter().filter(|quantity| !lost.contains(quantity));
    let exactness = |quantity: KeptQuantity| if mixed && quantity.is_exchanged() { "rounding" } else { "the last bit" };
    conserved.extend(left.map(|quantity| format!("{}, to {}", quantity.name(), exactness(quantity))));
    conserved.extend(model.physics().kept_to_rounding(model).map(|what| format!("{what}, to rounding")));
    conserved
}

/// What has to be known of a run whose ranks compute differently.
pub(super) fn warning_of_mixed_ranks(model: &Model) -> String {
    let momentum = kept(model).into_iter().find(|quantity| quantity.is_exchanged());
    let momentum = momentum.map(|quantity| format!(", and the {} is conserved to rounding only", quantity.name()));
    format!(
        "not all ranks of this run compute alike (`--mixed`): results are not those of one rank to the last bit{}",
        momentum.unwrap_or_default()
    )
}

/// What a run does not conserve, with the reasons, and what was seen to change that was to be kept.
pub(super) fn not_conserved(model: &Model, changed: &[(KeptQuantity, String)]) -> Vec<String> {
    let mut lost = Vec::new();
    if !kept(model).contains(&KeptQuantity::Energy) {
        lost.push(format!("total energy: {}", model.physics().fate_of_energy(model)));
        let reasons = model.physics().fate_of_momentum(model);
        if !reasons.is_empty() {
            lost.push(format!("total momentum: {}", reasons.join("; ")));
        }
    }
    lost.extend(changed.iter().map(|(quantity, change)| format!("{}: {change}", quantity.name())));
    lost
}

#[cfg(test)]
mod tests {
    #![allow(clippy::expect_used)]
    use super::*;
    use crate::families::conservation::INTEGRATED;
    use crate::scene;

    fn model(particles: &str, interactions: &str) -> Model {
        let text = format!(
            r#"{{"title": "test", "space": {{"box": [5, 5, 5]}}, "time": {{"step": 0.01, "steps": 1}}, "temperature": 1,
            "particles": [{{"species": "A", "count": 10}} {particles}], "interactions": [{interactions}]}}"#
        );
        scene::parse("test", &text, &[]).expect("a scene").model().clone()
    }

    #[test]
    fn voronoi_cells_keep_mass_and_momentum_and_with_their_energies_those_too() {
        let fate = |interaction: &str, temperature: f64| {
            let text = format!(
                r#"{{"title": "test", "space": {{"box": [5, 5]}}, "time": {{"step": 0.01, "steps": 1}},
                "temperature": {temperature}, "particles": [{{"species": "A", "count": 10}}],
                "interactions": [{{"type": "voronoi", {interaction}}}]}}"#
            );
            let model = scene::parse("test", &text, &[]).expect("a scene").model().clone();
            (conserved(&model, &[], false), not_conserved(&model, &[]))
        };
        let kept = ["mass, to the last bit", "total momentum, to the last bit", "total energy, to the last bit"];
        assert_eq!(fate(r#""energy": {}"#, 1.0), (kept.map(str::to_owned).to_vec(), Vec::new()));
        for (interaction, temperature, energy) in [
            (r#""viscosity": 1"#, 1.0, "exchanged with the fluid"),
            (r#""viscosity": 1"#, 0.0, "taken away by friction"),
            (r#""viscosity": 0"#, 1.0, INTEGRATED),
            (r#""viscosity": 0, "form": "paper""#, 1.0, "exchanging mass"),
        ] {
            let (found, lost) = fate(interaction, temperature);
            assert_eq!(found, kept[..2]);
            assert_eq!(lost.len(), 1);
            assert!(lost[0].starts_with("total energy: ") && lost[0].contains(energy), "{lost:?}");
        }
    }

    #[test]
    fn walls_absorb_momentum() {
        let told = |walls: &str, force: &str| {
            let text = format!(
                r#"{{"title": "test", "space": {{"box": [5, 5, 5], "walls": {walls}}}, "time": {{"step": 0.01, "steps": 1}},
                "temperature": 1, "particles": [{{"species": "A", "count": 10}}],
                "interactions": [{{"type": "dpd", "repulsion": 1}}{force}]}}"#
            );
            let model = scene::parse("test", &text, &[]).expect("a scene").model().clone();
            (conserved(&model, &[], false), not_conserved(&model, &[]))
        };
        let (kept, lost) = told(r#"{"z": {}}"#, "");
        assert_eq!(kept, ["mass", "total momentum, including that absorbed by walls, to the last bit"]);
        assert!(lost[0].contains(INTEGRATED) && lost[1].starts_with("total momentum: walls absorb it"), "{lost:?}");
        let force = r#", {"type": "body-force", "force": [1, 0, 0]}"#;
        let (kept, lost) = told(r#"{"z": {"upper_velocity": [1, 0, 0]}}"#, force);
        let both =
            "total momentum, including that absorbed by walls, excluding the impulse of body forces, to the last bit";
        assert_eq!(kept, ["mass", both]);
        assert!(lost[0].contains("`body_force_work`") && lost[0].contains("`wall_work`"), "{lost:?}");
    }

    #[test]
    fn boundaries_that_shear_take_momentum() {
        let text = |rate: f64| {
            format!(
                r#"{{"title": "test", "space": {{"box": [5, 5, 5], "shear": {{"rate": {rate}, "gradient": "y"}}}},
                "time": {{"step": 0.01, "steps": 1}}, "temperature": 1, "particles": [{{"species": "A", "count": 10}}],
                "interactions": [{{"type": "dpd", "repulsion": 1, "friction": 1}}]}}"#
            )
        };
        let told = |rate: f64| {
            let model = scene::parse("test", &text(rate), &[]).expect("a scene").model().clone();
            (conserved(&model, &[], false), not_conserved(&model, &[]))
        };
        let (kept, lost) = told(0.5);
        let with_boundaries = "total momentum, including that lost at sheared boundaries, to the last bit";
        assert_eq!(kept, ["mass", with_boundaries]);
        assert_eq!(lost.len(), 2, "{lost:?}");
        assert!(lost[0].starts_with("total energy: added by shear") && lost[0].contains("the heat bath"), "{lost:?}");
        assert!(
            lost[1].starts_with("total momentum: sheared boundaries") && lost[1].contains("`shear_momentum`"),
            "{lost:?}"
        );
        let (kept, lost) = told(0.0);
        assert_eq!(kept, ["mass", "total momentum, to the last bit"]);
        assert_eq!(lost, ["total energy: exchanged with the heat bath"]);
    }

    /// A force that changes its sign from half to half adds momentum only as far as their numbers of particles differ,
    /// which is booked.
    #[test]
    fn opposed_forces_are_booked() {
        let interactions = r#"{"type": "dpd", "friction": 1}, {"type": "body-force", "force": [1, 0, 0], "profile": "opposed", "axis": "z"}"#;
        let model = model("", interactions);
        assert_eq!(
            conserved(&model, &[], false),
            ["mass", "total momentum, excluding the impulse of body forces, to the last bit"]
        );
        let lost = not_conserved(&model, &[]);
        assert!(lost[0].contains("`body_force_work`") && lost[0].contains("exchanged with the heat bath"), "{lost:?}");
        assert!(lost[1].contains("as much as `body_force_momentum`"), "{lost:?}");
        assert_eq!(lost.len(), 2, "{lost:?}");
    }

    #[test]
    fn every_reason_is_told_and_none_that_is_not() {
        let cases = [
            ("", "", INTEGRATED, ""),
            ("", r#"{"type": "dpd", "friction": 1}"#, "exchanged with the heat bath", ""),
            (
                "",
                r#"{"type": "dpd", "friction": 1, "bath": {"type": "white", "temperature": 0}}"#,
                "taken away by friction",
                "",
            ),
            (
                "",
                r#"{"type": "dpd", "bath": {"type": "memory", "rate": 0, "coupling": 2}}"#,
                "lent to the variables of baths",
                "",
            ),
            ("", r#"{"type": "dpd", "friction": 1, "bath": {"type": "memory", "rate": 3}}"#, "exchanged", ""),
            ("", r#"{"type": "langevin", "friction": 1}"#, "exchanged", "friction and noise act on every particle"),
            ("", r#"{"type": "tether", "stiffness": 1}"#, INTEGRATED, "every particle is tied"),
            (r#", {"species": "B", "count": 2, "fixed": true}"#, "", INTEGRATED, "fixed particles absorb"),
            (
                "",
                r#"{"type": "coloured-noise", "strength": 1, "time": 0.1}"#,
                "added by the coloured noise",
                "wanders; temperatures are about the velocity of the centre of mass",
            ),
            (
                "",
                r#"{"type": "dpd", "friction": 1, "bath": {"type": "white", "temperature": 0}},
                {"type": "coloured-noise", "strength": 1, "time": 0.1}, {"type": "tether", "stiffness": 1}"#,
                "added by the coloured noise, taken away by friction",
                "wanders; every particle is tied to a point fixed in space",
            ),
        ];
        for (particles, interactions, energy, momentum) in cases {
            let model = model(particles, interactions);
            let lost = not_conserved(&model, &[]);
            assert!(lost[0].contains(energy), "{interactions}: {lost:?}");
            match momentum {
                "" => {
                    assert_eq!(lost.len(), 1, "{interactions}: {lost:?}");
                    assert_eq!(conserved(&model, &[], false), ["mass", "total momentum, to the last bit"]);
                }
                reason => {
                    assert!(lost[1].starts_with("total momentum: ") && lost[1].contains(reason), "{lost:?}");
                    assert_eq!(conserved(&model, &[], false), ["mass"]);
                }
            }
        }
    }
}
