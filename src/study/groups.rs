//! Runs of a study that a device advances together: those of plans that differ in numbers only.

use super::members::Member;
use crate::engine::{MOST_REPLICAS, Replica, Replicas};
use crate::gpu::{AdapterDescription, AdapterKind, ConstantsIn, Gpu};
use crate::plan::{Hardware, Options, Plan};
use crate::run;

/// Particles that a card needs to be busy: some ten thousands of invocations at once, twice over.
const BUSY: u64 = 1 << 17;

/// The number of `runs` of `particles` each that an adapter advances together, where the user does not say.
///
/// A card that advances a small run waits for its own dispatches. A software adapter does not, and several runs at once share its
/// cores already.
///
/// ```
/// use mesoscope::gpu::{AdapterDescription, AdapterKind};
/// use mesoscope::study::default_replicas;
///
/// let (name, backend, driver) = (String::new(), "Vulkan".to_owned(), String::new());
/// let adapter = |kind| AdapterDescription { name: name.clone(), kind, backend: backend.clone(), driver: driver.clone() };
/// assert_eq!(default_replicas(&adapter(AdapterKind::Discrete), 3000, 16), 16);
/// assert_eq!(default_replicas(&adapter(AdapterKind::Discrete), 50_000, 16), 3);
/// assert_eq!(default_replicas(&adapter(AdapterKind::Software), 3000, 16), 1);
/// ```
#[must_use]
pub fn default_replicas(adapter: &AdapterDescription, particles: u64, runs: usize) -> usize {
    let busy = match adapter.kind {
        AdapterKind::Software => 1,
        _ => BUSY.div_ceil(particles.max(1)).min(MOST_REPLICAS),
    };
    busy.min(runs.max(1) as u64) as usize
}

/// Runs that may be advanced together.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Alike {
    /// Those with the constants of each other, such as runs that differ in their seeds: each has the bytes that it has alone.
    InConstants,
    /// Those with other numbers too, which kernels then load: a driver may round them otherwise than those that it knows when it
    /// compiles a kernel.
    ButForNumbers,
}

/// Runs that are advanced together.
pub(super) struct Group {
    /// Their places among all.
    members: Vec<usize>,
    /// The device, and the plan of the first, if they are several.
    together: Option<(Gpu, Box<Plan>)>,
}

impl Group {
    /// The runs on their own, one after the other.
    pub(super) fn of_each(count: usize) -> Vec<Self> {
        (0..count).map(|number| Self { members: vec![number], together: None }).collect()
    }

    /// Runs by their order, each together with the first ones that are alike, up to `most` of them.
    pub(super) fn of_alike(members: &[Member], most: usize, alike: Alike, gpu: &Gpu) -> Vec<Self> {
        let mut groups: Vec<Self> = Vec::new();
        for (number, member) in members.iter().enumerate() {
            let plan = run::plan(&member.scene, Hardware::from(gpu), Options::default());
            // Stages have plans of their own.
            let has_stages = !member.scene.stages.is_empty();
            let fitting = if has_stages { 1 } else { Replicas::fitting(&plan, gpu, most) };
            let with = groups.iter_mut().find_map(|group| {
                let (_, first) = group.together.as_mut().filter(|_| group.members.len() < fitting)?;
                let same = first.has_constants_of(&plan);
                let joins = Plan { constants_in: first.constants_in, ..plan.clone() };
                if !first.differs_in_numbers(&joins) || alike == Alike::InConstants && !same {
                    return None;
                }
                if !same {
                    first.constants_in = ConstantsIn::Buffer;
                }
                Some(&mut group.members)
            });
            match with {
                Some(members) => members.push(number),
                None => groups.push(Self { members: vec![number], together: Some((gpu.clone(), Box::new(plan))) }),
            }
        }
        groups
    }

    /// Their places among all runs.
    pub(super) fn members(&self) -> &[usize] {
        &self.members
    }

    /// A replica for each run, in their order; none of a single one, nor where the device has no memory for all of them together.
    pub(super) fn replicas(&self) -> Option<Vec<Replica>> {
        let (gpu, plan) = self.together.as_ref().filter(|_| self.members.len() > 1)?;
        Replicas::side_by_side(gpu, (**plan).clone(), self.members.len() as u32).ok()
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::{Alike, Group};
    use crate::gpu::{AdapterChoice, ConstantsIn, Gpu, Requirements};
    use crate::output::Id;
    use crate::scene;
    use crate::study::Member;

    #[test]
    fn runs_are_grouped_by_their_plans() {
        let gpu = Gpu::open(&AdapterChoice::Best, Requirements::default()).unwrap();
        let member = |entry: usize, name: &str, changes: &[&str]| {
            let set: Vec<String> = changes.iter().map(|change| (*change).to_owned()).collect();
            let scene = scene::load(name, &set).unwrap();
            Member { entry, name: entry.to_string(), id: Id::of_run(&scene), scene }
        };
        let fluid = |entry, change: &str| member(entry, "dpd-fluid", &["space.box=[4,4,4]", "output={}", change]);
        let members = [
            fluid(0, "seed=1"),
            fluid(1, "time.step=0.03"),
            fluid(2, "seed=2"),
            fluid(3, "space.box=[4,4,5]"),
            fluid(4, "seed=3"),
            member(5, "edpd-fluid", &["space.box=[4,4,4]", "output={}"]),
            member(6, "edpd-fluid", &["space.box=[4,4,4]", "output={}", "seed=7"]),
        ];
        let of = |alike, most| {
            let groups = Group::of_alike(&members, most, alike, &gpu);
            groups.into_iter().map(|group| (group.members, group.together.unwrap().1.constants_in)).collect::<Vec<_>>()
        };
        let (code, buffer) = (ConstantsIn::Code, ConstantsIn::Buffer);
        // A list that holds takes dispatches that depend on the step.
        let lists = [(vec![5], code), (vec![6], code)];
        let expected = [&[(vec![0, 2, 4], code), (vec![1], code), (vec![3], code)], &lists[..]].concat();
        assert_eq!(of(Alike::InConstants, 8), expected);
        let expected = [&[(vec![0, 1, 2, 4], buffer), (vec![3], code)], &lists[..]].concat();
        assert_eq!(of(Alike::ButForNumbers, 8), expected);
        let expected = [&[(vec![0, 2], code), (vec![1], code), (vec![3], code), (vec![4], code)], &lists[..]].concat();
        assert_eq!(of(Alike::InConstants, 2), expected);
    }
}
