//! Whether what a model keeps to the last bit is kept on this adapter: the sums of every report are compared with those of
//! the start.

use super::sections::Sections;
use crate::engine::Sample;
use crate::families::{KeptQuantity, KeptSum, Model};
use crate::numbers::counted;
use crate::output::checkpoint::CheckpointError;
use crate::state::State;

/// Name of the section of a checkpoint.
pub(super) const SECTION: &str = "kept_sums";
/// Name of the section, without content, of a run that was shared by ranks that compute differently.
const MIXED: &str = "mixed_ranks";

/// The ranks that share a run.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(super) struct Sharing {
    /// There are several, and they have to compute alike.
    pub strict: bool,
    /// They compute differently.
    pub mixed: bool,
}

/// The integer sums that a model keeps, as they were at the start, and the changes that were seen since.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct KeptSums {
    sums: Vec<Watched>,
    /// Whether no sum may change.
    strict: bool,
    /// Whether some part of the run was shared by ranks that compute differently.
    pub mixed: bool,
}

#[derive(Debug, Clone, PartialEq)]
struct Watched {
    /// The sum, as it was at the first step.
    sum: KeptSum,
    change: Option<Change>,
}

/// A sum that is not what it was.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
struct Change {
    /// The first step at which it was seen.
    step: u64,
    /// By how many units it had changed then.
    first: i64,
    /// The change that is largest in magnitude so far.
    largest: i64,
}

/// Numbers that a checkpoint keeps of each sum.
const NUMBERS: usize = 4;

impl KeptSums {
    /// The sums of the state that a run begins with, or what a checkpoint has kept of them.
    ///
    /// # Errors
    /// [`CheckpointError::Content`] where that is of another length.
    pub(super) fn new(
        model: &Model,
        state: &State,
        sections: &Sections<'_>,
        sharing: Sharing,
    ) -> Result<Self, CheckpointError> {
        let kept = model.physics().kept(model, state).into_iter();
        let mut sums: Vec<Watched> = kept.map(|sum| Watched { sum, change: None }).collect();
        if let Some(kept) = sections.integers(SECTION, (NUMBERS * sums.len()) as u64)? {
            for (sum, [start, step, first, largest]) in sums.iter_mut().zip(kept.as_chunks().0) {
                sum.sum.total = *start;
                let change = Change { step: *step as u64, first: *first, largest: *largest };
                sum.change = (*first != 0).then_some(change);
            }
        }
        // What changed before is not the fault of these ranks.
        let strict = sharing.strict && sums.iter().all(|sum| sum.change.is_none());
        Ok(Self { sums, strict, mixed: sharing.mixed || sections.has(MIXED) })
    }

    /// The ranks that share the run.
    pub(super) fn sharing(&self) -> Sharing {
        Sharing { strict: self.strict, mixed: self.mixed }
    }

    /// What a checkpoint has to keep.
    pub(super) fn sections(&self) -> Vec<(String, Vec<u8>)> {
        let mixed = self.mixed.then(|| (MIXED.to_owned(), Vec::new()));
        std::iter::once((SECTION.to_owned(), self.section())).chain(mixed).collect()
    }

    fn section(&self) -> Vec<u8> {
        let numbers = |sum: &Watched| {
            let change = sum.change.unwrap_or(Change { step: 0, first: 0, largest: 0 });
            [sum.sum.total, change.step as i64, change.first, change.largest]
        };
        self.sums.iter().flat_map(numbers).flat_map(i64::to_le_bytes).collect()
    }

    /// Compares a sample of the observables with the start.
    pub(super) fn compare(&mut self, sample: &Sample) {
        for sum in &mut self.sums {
            let Some(found) = sum.sum.of(&sample.sums) else { continue };
            let difference = found.wrapping_sub(sum.sum.total);
            if difference == 0 {
                continue;
            }
            let change = sum.change.get_or_insert(Change { step: sample.step, first: difference, largest: difference });
            if difference.unsigned_abs() > change.largest.unsigned_abs() {
                change.largest = difference;
            }
        }
    }

    /// What changed, with the largest change, for what a run does not conserve.
    pub(super) fn lost(&self) -> Vec<(KeptQuantity, String)> {
        let mut lost: Vec<(KeptQuantity, String)> = Vec::new();
        for (sum, change) in self.changed() {
            let size = format!("{}{}", size(sum, change.largest), sum.direction);
            match lost.iter_mut().find(|(quantity, _)| *quantity == sum.quantity) {
                Some((_, text)) => *text = format!("{text}, {size}"),
                None if self.mixed => lost.push((sum.quantity, format!("on ranks of several kinds changed by {size}"))),
                None => lost.push((sum.quantity, format!("on this driver changed by {size}"))),
            }
        }
        lost
    }

    /// Says once of the sum that changed first when and by how much.
    pub(super) fn warning(&self) -> Option<String> {
        if self.mixed {
            let (sum, change) = self.first()?;
            let size = size(sum, change.first);
            return Some(format!(
                "the {}{} had changed by {size} at step {}, as it does where ranks compute differently",
                sum.quantity.name(),
                sum.direction,
                change.step,
            ));
        }
        Some(format!(
            "{}: a defect of this driver's compiler or of mesoscope; please report it with the name of the adapter",
            self.changed_in_words()?
        ))
    }

    /// Why ranks that have to compute alike do not, if a sum shows it.
    pub(super) fn refused(&self) -> Option<String> {
        self.strict.then(|| self.changed_in_words()).flatten()
    }

    fn changed_in_words(&self) -> Option<String> {
        let (sum, change) = self.first()?;
        Some(format!(
            "the {}{} should be constant to the last bit, but at step {} it had changed by {}",
            sum.quantity.name(),
            sum.direction,
            change.step,
            size(sum, change.first),
        ))
    }

    fn first(&self) -> Option<(&KeptSum, Change)> {
        self.changed().min_by_key(|(_, change)| change.step)
    }

    fn changed(&self) -> impl Iterator<Item = (&KeptSum, Change)> {
        self.sums.iter().filter_map(|sum| Some((&sum.sum, sum.change?)))
    }
}

/// A change with its number of units.
fn size(sum: &KeptSum, change: i64) -> String {
    format!("{:.3e} ({})", change as f64 * sum.unit, counted(change.unsigned_abs(), "unit"))
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use crate::families::initial_state;
    use crate::run::conservation::{conserved, not_conserved, warning_of_mixed_ranks};
    use crate::scene;
    use std::path::Path;

    fn at(step: u64, sections: &[(String, Vec<u8>)]) -> Sections<'_> {
        Sections::new(Path::new("checkpoint.bin"), step, sections)
    }

    /// A model, and a sample of its start.
    fn start(text: &str) -> (Model, State, Sample) {
        let scene = scene::parse("test", text, &[]).unwrap();
        let model = scene.model();
        let state = initial_state(&scene);
        let mut sums = vec![0; 12];
        for sum in model.physics().kept(model, &state) {
            sums[sum.parts[0].0] = sum.total;
        }
        (model.clone(), state, Sample { sampler: 0, step: 0, sums })
    }

    const FLUID: &str = r#"{"title": "t", "space": {"box": [5, 5, 5]}, "time": {"step": 0.01, "steps": 1}, "temperature": 1,
        "particles": [{"species": "A", "count": 10}], "interactions": [{"type": "dpd", "friction": 1}]}"#;
    const CELLS: &str = r#"{"title": "t", "space": {"box": [5, 5]}, "time": {"step": 0.01, "steps": 1}, "temperature": 1,
        "particles": [{"species": "A", "count": 25}], "interactions": [{"type": "voronoi", "energy": {}}]}"#;
    const WATER: &str = r#"{"title": "t", "space": {"box": [6, 6]}, "time": {"step": 0.01, "steps": 1}, "temperature": 0,
        "particles": [{"species": "water", "count": 1024, "placement": {"type": "lattice"},
            "velocities": {"type": "rest"}}],
        "interactions": [{"type": "shallow-water", "mesh": [16, 16], "wave_speed": 6, "rotation": 6}]}"#;

    #[test]
    fn a_tampered_sample_is_told_once_and_the_claim_goes() {
        for (text, place, name, others) in [
            (FLUID, 3, "total momentum", 1),
            (CELLS, 2, "total momentum", 2),
            (CELLS, 3, "mass", 2),
            (CELLS, 7, "total energy", 2),
            (WATER, 5, "mass on the mesh", 0),
        ] {
            let (model, state, mut sample) = start(text);
            let one = Sharing::default();
            let mut sums = KeptSums::new(&model, &state, &at(0, &[]), one).unwrap();
            sums.compare(&sample);
            assert_eq!((sums.warning(), sums.lost()), (None, Vec::new()));
            let claim = format!("{name}, to the last bit");
            assert!(conserved(&model, &[], false).contains(&claim), "{claim}");

            for (step, change) in [(40, 1), (80, -3), (120, 0)] {
                let mut tampered = sample.clone();
                tampered.step = step;
                tampered.sums[place] += change;
                sums.compare(&tampered);
            }
            sample.step = 160;
            sums.compare(&sample);
            let warning = sums.warning().unwrap();
            assert!(warning.starts_with(&format!("the {name}")) && warning.contains("(1 unit)"), "{warning}");
            assert!(warning.contains("at step 40 it had changed"), "{warning}");
            let lost = sums.lost();
            let kept: Vec<KeptQuantity> = lost.iter().map(|(quantity, _)| *quantity).collect();
            let found = conserved(&model, &kept, false);
            assert!(!found.contains(&claim) && found.len() == others, "{found:?}");
            let entry = not_conserved(&model, &lost);
            let text = format!("{name}: on this driver changed by -");
            assert!(entry.iter().any(|entry| entry.starts_with(&text) && entry.contains("(3 units)")), "{entry:?}");

            // An interruption changes nothing of that.
            let section = [(SECTION.to_owned(), sums.section())];
            assert_eq!(KeptSums::new(&model, &state, &at(160, &section), one).unwrap(), sums);
            let short = [(SECTION.to_owned(), sums.section()[8..].to_vec())];
            assert!(KeptSums::new(&model, &state, &at(160, &short), one).is_err());
        }
    }

    /// Ranks that have to compute alike are refused once a sum changes; of those that need not, nobody is told of a defect.
    #[test]
    fn ranks_are_refused_or_keep_momentum_to_rounding() {
        let (model, state, mut sample) = start(FLUID);
        let sums = |sections: &[(String, Vec<u8>)], strict, mixed| {
            KeptSums::new(&model, &state, &at(40, sections), Sharing { strict, mixed }).unwrap()
        };
        let unchanged = [(SECTION.to_owned(), sums_at_start(&model, &state).section())];
        let (mut alike, mut mixed) = (sums(&unchanged, true, false), sums(&unchanged, false, true));
        alike.compare(&sample);
        assert_eq!(alike.refused(), None);
        (sample.step, sample.sums[3]) = (80, sample.sums[3] - 2);
        for sums in [&mut alike, &mut mixed] {
            sums.compare(&sample);
        }
        let refused = alike.refused().unwrap();
        assert!(refused.contains("total momentum along y") && refused.contains("at step 80"), "{refused}");
        assert_eq!(mixed.refused(), None);
        let warning = mixed.warning().unwrap();
        assert!(warning.contains("(2 units) at step 80") && !warning.contains("defect"), "{warning}");
        assert!(mixed.lost()[0].1.starts_with("on ranks of several kinds changed by -"), "{:?}", mixed.lost());

        // What was mixed stays so, and what it has changed is not the fault of the ranks that go on.
        let kept = mixed.sections();
        assert!(sums(&kept, true, false).mixed && !sums(&unchanged, true, false).mixed);
        assert_eq!(sums(&kept, true, false).refused(), None);
        assert!(conserved(&model, &[], true).contains(&"total momentum, to rounding".to_owned()));
        assert!(warning_of_mixed_ranks(&model).contains("total momentum is conserved to rounding only"));
        // Mass is brought to the nodes as integers.
        let (water, ..) = start(WATER);
        assert!(conserved(&water, &[], true).contains(&"mass on the mesh, to the last bit".to_owned()));
        assert!(!warning_of_mixed_ranks(&water).contains("rounding"));
    }

    fn sums_at_start(model: &Model, state: &State) -> KeptSums {
        KeptSums::new(model, state, &at(0, &[]), Sharing::default()).unwrap()
    }

    #[test]
    fn what_is_not_kept_is_not_compared() {
        let langevin = FLUID.replace(r#"{"type": "dpd", "friction": 1}"#, r#"{"type": "langevin", "friction": 1}"#);
        let (model, state, mut sample) = start(&langevin);
        let mut sums = KeptSums::new(&model, &state, &at(0, &[]), Sharing::default()).unwrap();
        sample.sums[3] += 1000;
        sums.compare(&sample);
        assert_eq!((sums.warning(), sums.section().len()), (None, 0));
    }
}
