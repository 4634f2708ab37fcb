//! Runs of a study that a device advances together: those of plans that differ in numbers only.

use super::members::Member;
use crate::engine::{Replica, Replicas};
use crate::gpu::{AdapterDescription, AdapterKind, ConstantsIn, Gpu};
use crate::plan::{Hardware, Options, Plan};
use crate::run;
use std::iter;

/// Particles that a card needs to be busy: some ten thousands of invocations at once, twice over.
const BUSY: u64 = 1 << 17;

/// Runs that a card advances together at most, where the user does not say: a thread of the host attends to each.
const MOST: u64 = 64;

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
        _ => BUSY.div_ceil(particles.max(1)).min(MOST),
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
        let mut groups: Vec<(Vec<usize>, Plan, ConstantsIn)> = Vec::new();
        for (number, member) in members.iter().enumerate() {
            let plan = run::plan(&member.scene, Hardware::from(gpu), Options::default());
            let fitting = Replicas::fitting(&plan, gpu, most);
            let is_alike = |first: &Plan| match alike {
                Alike::InConstants => first.differs_in_numbers(&plan) && first.has_constants_of(&plan),
                Alike::ButForNumbers => first.differs_in_numbers(&plan),
            };
            let with = groups.iter_mut().find(|(all, first, _)| all.len() < fitting && is_alike(first));
            match with {
                Some((all, first, constants_in)) => {
                    all.push(number);
                    if !first.has_constants_of(&plan) {
                        *constants_in = ConstantsIn::Buffer;
                    }
                }
                None => groups.push((vec![number], plan, ConstantsIn::Code)),
            }
        }
        let group = |(all, plan, constants_in): (Vec<usize>, Plan, _)| Self {
            together: (all.len() > 1).then(|| (gpu.clone(), Box::new(Plan { constants_in, ..plan }))),
            members: all,
        };
        groups.into_iter().map(group).collect()
    }

    /// Each run with its place among those that are advanced together. Where the device has too little memory for all of them,
    /// they run on their own.
    pub(super) fn replicas(&self) -> impl Iterator<Item = (usize, Option<Replica>)> {
        let together = self.together.as_ref();
        let made =
            together.and_then(|(gpu, plan)| Replicas::new(gpu, (**plan).clone(), self.members.len() as u32).ok());
        let replicas = made.into_iter().flatten().map(Some).chain(iter::repeat_with(|| None));
        self.members.iter().copied().zip(replicas)
    }
}
