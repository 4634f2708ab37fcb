//! All ranks of a run, as the first of them sees them: one engine.

use super::Channel;
use super::member::{Portions, execute};
use super::message::{Answer, Command, Contents, Problem, join, read, written};
use crate::engine::{Engine, EngineError, RankReport, Sample, Sampling, Shown, Stepper, Traffic, no_part};
use crate::plan::{PARTICLE_WORDS, Places, Plan, Sampler};
use crate::shaders::Array;
use crate::state::{Reported, State};
use std::collections::BTreeMap;
use std::ops::Range;

/// Words of a particle.
const WORDS: usize = PARTICLE_WORDS as usize;

/// What is wrong if not all particles come back.
const LOST: &str = "particles were lost between ranks";

/// Whether ranks computed the same from the same state: then a run has the bytes of one rank.
#[must_use]
pub fn computes_alike(ranks: &[RankReport]) -> bool {
    ranks.windows(2).all(|two| two[0].arithmetic == two[1].arithmetic)
}

/// Who the ranks are, and what to do if they do not compute alike.
pub(crate) fn remedy(ranks: &[RankReport]) -> String {
    let ranks = ranks.iter().zip(0..).map(|(RankReport { host, adapter, arithmetic, .. }, rank)| {
        format!("\n  rank {rank} on {host}, {adapter}: {arithmetic:08x}")
    });
    format!(
        "{}\ntake adapters and drivers of one kind, or `--mixed`, with which momentum is conserved to rounding only",
        ranks.collect::<String>()
    )
}

/// That so many ranks on a machine have to share its adapters, if they have.
///
/// ```
/// use mesoscope::ranks::sharing;
///
/// assert_eq!(sharing(4, 4, "node7"), None);
/// let told = sharing(2, 1, "node7");
/// assert_eq!(told.as_deref(), Some("2 ranks share 1 adapter of node7: they take turns on it"));
/// assert_eq!(sharing(8, 4, "this machine").as_deref(), Some("8 ranks share 4 adapters of this machine"));
/// ```
#[must_use]
pub fn sharing(ranks: u32, adapters: u32, machine: &str) -> Option<String> {
    let turns = if adapters == 1 { ": they take turns on it" } else { "" };
    let those = if adapters == 1 { "adapter" } else { "adapters" };
    (ranks > adapters).then(|| format!("{ranks} ranks share {adapters} {those} of {machine}{turns}"))
}

/// The same of each machine that ranks are on.
///
/// ```
/// use mesoscope::engine::RankReport;
/// use mesoscope::ranks::sharing_anywhere;
///
/// let ranks: Vec<RankReport> = [("a", 2), ("b", 1), ("a", 2), ("b", 1), ("c", 1), ("a", 2)]
///     .map(|(host, adapters)| RankReport { host: host.to_owned(), adapters, ..RankReport::default() })
///     .to_vec();
/// let expected = ["3 ranks share 2 adapters of a", "2 ranks share 1 adapter of b: they take turns on it"];
/// assert_eq!(sharing_anywhere(&ranks), expected);
/// ```
#[must_use]
pub fn sharing_anywhere(ranks: &[RankReport]) -> Vec<String> {
    let first_there =
        |(place, rank): &(usize, &RankReport)| ranks[..*place].iter().all(|other| other.host != rank.host);
    let machines = ranks.iter().enumerate().filter(first_there);
    let told = |(_, machine): (usize, &RankReport)| {
        let there = ranks.iter().filter(|rank| rank.host == machine.host).count();
        sharing(there as u32, machine.adapters, &machine.host)
    };
    machines.filter_map(told).collect()
}

/// Several ranks that advance one state.
pub struct Team<'a> {
    engine: Engine<'a>,
    channel: Box<dyn Channel + 'a>,
    /// Rows to which not all ranks have added yet, by step and sampler.
    incomplete: BTreeMap<(u64, usize), (u32, Vec<i64>)>,
    collected: Vec<Sample>,
    ranks: Vec<RankReport>,
    species: Vec<u32>,
    /// The step whose particles have been gathered and measured.
    measured: Option<u64>,
    /// Particles of the first rank that pass in several messages.
    portions: Portions,
}

impl<'a> Team<'a> {
    /// The first rank's engine, with the others behind a channel, at a state.
    ///
    /// # Errors
    /// [`EngineError`] of the first rank that has one.
    pub fn new(
        engine: Engine<'a>,
        introduction: RankReport,
        channel: Box<dyn Channel + 'a>,
        state: &State,
    ) -> Result<Self, EngineError> {
        let count = channel.count() as usize;
        let mut team = Self {
            engine,
            channel,
            incomplete: BTreeMap::new(),
            collected: Vec::new(),
            ranks: vec![RankReport::default(); count],
            species: Vec::new(),
            measured: None,
            portions: Portions::default(),
        };
        if let Some(first) = team.ranks.first_mut() {
            *first = introduction;
        }
        // The others wait for their first command; where all share an adapter, each would compile the same kernels at the same time.
        team.engine.compile()?;
        team.upload(state)?;
        Ok(team)
    }

    /// Refuses ranks that do not compute alike, with which momentum is conserved to rounding only.
    ///
    /// # Errors
    /// [`EngineError::Ranks`] with all ranks.
    pub fn check_alike(&self) -> Result<(), EngineError> {
        if computes_alike(&self.ranks) {
            return Ok(());
        }
        let reason = format!("the ranks compute differently: from the same state they get{}", remedy(&self.ranks));
        Err(EngineError::Ranks { reason })
    }

    /// Number of the particles that the ranks share out.
    fn shared(&self) -> u64 {
        self.engine.plan().part.as_ref().map_or(0, |part| part.shared)
    }

    /// The numbers of the particles of each message that passes on a state.
    fn portions(&self) -> Result<Vec<Range<u64>>, EngineError> {
        self.engine.plan().part.as_ref().map(|part| part.portions().collect()).ok_or_else(no_part)
    }

    /// Gathers so many particles of those that all ranks share out, in several messages; `begin` sees what else belongs to the state, before
    /// `take` gets any.
    fn gather<T>(
        &mut self,
        (command, count): (Command, u64),
        begin: impl FnOnce(&Self, &Contents) -> Result<T, EngineError>,
        mut take: impl FnMut(&mut T, &[u32]) -> Result<(), EngineError>,
    ) -> Result<T, EngineError> {
        let messages = self.portions()?.len();
        let mut given = self.tell(command, &[])?;
        let mut particles = given.first_mut().map(std::mem::take).unwrap_or_default();
        let mut gathered = begin(self, &given)?;
        let mut words = 0;
        for message in 1..=messages {
            words += particles.len() as u64;
            take(&mut gathered, &particles)?;
            if message < messages {
                particles = self.tell(Command::Next, &[])?.into_iter().next().unwrap_or_default();
            }
        }
        let part = self.engine.plan().part.as_ref();
        if part.is_some_and(|part| count * part.particle.count as u64 == words) {
            return Ok(gathered);
        }
        Err(EngineError::Ranks { reason: LOST.to_owned() })
    }

    /// What each rank has exchanged, in their order.
    #[must_use]
    pub fn traffic(&self) -> Vec<Traffic> {
        self.ranks.iter().map(|rank| rank.traffic).collect()
    }

    /// Lets all ranks do something; what they give together.
    fn tell(&mut self, command: Command, contents: &[Vec<u32>]) -> Result<Contents, EngineError> {
        let lost = |reason| EngineError::Ranks { reason };
        self.channel.tell(&written(&command, contents).map_err(lost)?).map_err(lost)?;
        let (own, mut given) = execute(&mut self.engine, &mut self.portions, command, contents);
        let mut problems: Vec<(u32, Problem)> = own.problem.clone().map(|problem| (0, problem)).into_iter().collect();
        if !problems.is_empty() {
            self.engine.leave();
        }
        self.add(0, own);
        match self.channel.collect() {
            Ok(answers) => {
                for (rank, answer) in (1..).zip(answers) {
                    let (answer, more): (Answer, Contents) = read(&answer).map_err(lost)?;
                    problems.extend(answer.problem.clone().map(|problem| (rank, problem)));
                    join(&mut given, more);
                    self.add(rank as usize, answer);
                }
            }
            // The others cannot go on without it; what it says for itself counts more.
            Err(reason) if problems.is_empty() => return Err(lost(reason)),
            Err(_) => {}
        }
        Problem::first(&problems).map_or(Ok(given), Err)
    }

    /// Gathers the particles of all ranks and measures them, if a sample of them is due and has not been taken.
    fn measure_gathered(&mut self) -> Result<(), EngineError> {
        let step = self.engine.step();
        let due = self.engine.plan().samplers.iter().any(|sampler| sampler.gathered && sampler.due(step));
        if !due || self.measured == Some(step) {
            return Ok(());
        }
        let begin = |team: &Self, contents: &Contents| {
            let plan = team.engine.plan();
            let images = if plan.has_buffer(Array::GatheredPaths) { images(contents) } else { Vec::new() };
            Ok((vec![u32::MAX; WORDS * plan.particles as usize], images))
        };
        let (gathered, images) = self.gather((Command::Report, self.shared()), begin, |(gathered, _), particles| {
            for particle in particles.chunks_exact(WORDS) {
                if let Some(place) = gathered.chunks_exact_mut(WORDS).nth(particle[3] as usize) {
                    place.copy_from_slice(particle);
                }
            }
            Ok(())
        })?;
        if (0..).zip(gathered.chunks_exact(WORDS)).any(|(id, particle): (u32, _)| particle[3] != id) {
            return Err(EngineError::Ranks { reason: LOST.to_owned() });
        }
        self.measured = Some(step);
        self.engine.measure_gathered(&gathered, &images)
    }

    /// How many ranks add to a row of a sampler.
    fn adding(&self, sampler: usize) -> u32 {
        let gathered = self.engine.plan().samplers.get(sampler).is_some_and(|sampler| sampler.gathered);
        if gathered { 1 } else { self.channel.count() }
    }

    /// Adds the sums of a rank to those of the others.
    fn add(&mut self, rank: usize, answer: Answer) {
        if let Some(known) = self.ranks.get_mut(rank) {
            let introduction = answer.introduction.unwrap_or_else(|| std::mem::take(known));
            *known = RankReport { traffic: answer.traffic, ..introduction };
        }
        for Sample { sampler, step, sums } in answer.samples {
            let (added, total) = self.incomplete.entry((step, sampler)).or_insert_with(|| (0, vec![0; sums.len()]));
            *added += 1;
            // What every rank finds whole is that of the first.
            let whole = self.engine.plan().samplers.get(sampler).map_or(0..0, |sampler| sampler.whole.clone());
            let added = total.iter_mut().zip(sums).enumerate().filter(|(place, _)| rank == 0 || !whole.contains(place));
            for (_, (total, sum)) in added {
                *total = total.wrapping_add(sum);
            }
        }
        while let Some((&(step, sampler), (added, _))) = self.incomplete.first_key_value() {
            if *added != self.adding(sampler) {
                break;
            }
            if let Some((_, (_, sums))) = self.incomplete.pop_first() {
                self.collected.push(Sample { sampler, step, sums });
            }
        }
    }

    /// A state of the particles of all ranks, or of those with some numbers alone.
    fn joined(&mut self, command: Command, reported: bool, numbers: Option<&[u32]>) -> Result<State, EngineError> {
        let plan = self.engine.plan();
        let layout = plan.reported.as_ref().filter(|_| reported).map_or(&plan.layout, |(_, layout)| layout).clone();
        let (count, words) = (plan.particles as usize, plan.part.as_ref().map(|part| part.particle));
        let count = numbers.map_or(count, <[u32]>::len);
        let given = numbers.map_or(self.shared(), |_| count as u64);
        let problem = |reason: String| EngineError::Ranks { reason };
        let begin = |team: &Self, given: &Contents| {
            let contents: Vec<&[u32]> = given.iter().map(Vec::as_slice).collect();
            let mut state = layout.begin(team.engine.step(), &contents, count).map_err(problem)?;
            if numbers.is_none() && team.engine.plan().paths.are_followed() {
                state.images = images(given);
            }
            Ok((state, Places::of(count)))
        };
        let place = |(state, places): &mut (State, Places), particles: &[u32]| {
            let (Some(numbers), Some(words)) = (numbers, words) else {
                return layout.place(particles, places, state).map_err(problem);
            };
            let mut particles = particles.to_vec();
            for particle in particles.chunks_exact_mut(words.count) {
                let place = numbers.binary_search(&particle[words.number]);
                particle[words.number] = place.map_err(|_| problem(LOST.to_owned()))? as u32;
            }
            layout.place(&particles, places, state).map_err(problem)
        };
        let (mut state, _) = self.gather((command, given), begin, place)?;
        if state.species.is_empty() {
            state.species = match numbers {
                None => self.species.clone(),
                Some(numbers) => {
                    numbers.iter().filter_map(|number| self.species.get(*number as usize)).copied().collect()
                }
            };
        }
        Ok(state)
    }

    /// A sample of the particles of a report.
    fn sample(&mut self, sampling: Sampling) -> Result<Shown, EngineError> {
        let numbers = sampling.numbers(self.engine.plan().particles);
        let state = self.joined(Command::Show { sample: sampling }, true, Some(&numbers))?;
        let Reported { step, positions, momenta, species, .. } = state.into();
        let state = Reported { step, positions, momenta, species, ..Reported::default() };
        Ok(Shown { state, numbers: Some(numbers) })
    }
}

/// How often each particle has crossed the box, which all ranks have counted together: the last of what goes with particles that are
/// followed. The high words are of the sign only.
fn images(contents: &Contents) -> Vec<[i32; 3]> {
    let counted = contents.last().map(Vec::as_slice).unwrap_or_default();
    counted.chunks_exact(6).map(|words| [0, 2, 4].map(|axis| words[axis].cast_signed())).collect()
}

impl Stepper for Team<'_> {
    fn ranks(&self) -> &[RankReport] {
        &self.ranks
    }

    fn keep_alive(&self) {
        self.channel.keep_alive();
    }

    fn plan(&self) -> &Plan {
        self.engine.plan()
    }

    fn step(&self) -> u64 {
        self.engine.step()
    }

    fn upload(&mut self, state: &State) -> Result<(), EngineError> {
        self.species.clone_from(&state.species);
        self.incomplete.clear();
        self.collected.clear();
        self.measured = None;
        let mut portions: Vec<Range<u64>> = self.portions()?;
        let last = portions.pop().map_or(0, |portion| portion.start);
        for portion in portions {
            let mut particles = self.engine.pack_some(state, portion)?;
            particles.truncate(1);
            self.tell(Command::Take, &particles)?;
        }
        let contents = self.engine.pack_for_parts(state, last..state.len() as u64)?;
        self.tell(Command::Upload { step: state.step }, &contents).map(|_| ())
    }

    fn advance(&mut self, steps: u64, batch: u64) -> Result<(), EngineError> {
        let Some(last) = self.step().checked_add(steps) else {
            // Which every rank refuses.
            return self.tell(Command::Advance { steps, batch }, &[]).map(|_| ());
        };
        while self.step() < last {
            self.measure_gathered()?;
            let samplers = self.plan().samplers.iter().filter(|sampler| sampler.gathered);
            let next = samplers.map(|sampler| sampler.next_after(self.step())).fold(last, u64::min);
            self.tell(Command::Advance { steps: next - self.step(), batch }, &[])?;
        }
        Ok(())
    }

    fn finish(&mut self) -> Result<Vec<Sample>, EngineError> {
        self.measure_gathered()?;
        self.tell(Command::Finish, &[])?;
        Ok(self.take_samples())
    }

    fn take_samples(&mut self) -> Vec<Sample> {
        std::mem::take(&mut self.collected)
    }

    fn words(&mut self, array: Array) -> Result<Vec<u32>, EngineError> {
        let plan = self.plan();
        let is_of_first =
            |sampler: &Sampler| sampler.gathered && sampler.window.is_some_and(|window| window.buffer == array);
        let is_whole = plan.part.as_ref().is_some_and(|part| part.whole.contains(&array));
        if is_whole || plan.samplers.iter().any(is_of_first) {
            return self.engine.words(array);
        }
        let reason = format!("`{}` lies on several devices", array.name());
        Err(EngineError::State { reason })
    }

    fn continue_window(&mut self, sampler: usize, taken: u64, words: &[u32]) -> Result<(), EngineError> {
        if self.plan().samplers.get(sampler).is_some_and(|sampler| sampler.gathered) {
            return self.engine.continue_window(sampler, taken, words);
        }
        Err(EngineError::State { reason: "windows of samples lie on several devices".to_owned() })
    }

    fn state(&mut self) -> Result<State, EngineError> {
        self.joined(Command::State, false, None)
    }

    fn shown(&mut self, most: u64) -> Result<Shown, EngineError> {
        match Sampling::new(self.shared(), most) {
            Some(sampling) if self.shared() == self.plan().particles => self.sample(sampling),
            _ => Ok(Shown::of(self.reported()?, most)),
        }
    }

    fn reported(&mut self) -> Result<Reported, EngineError> {
        Ok(self.joined(Command::Report, true, None)?.into())
    }

    fn wait(&mut self) -> Result<(), EngineError> {
        self.tell(Command::Wait, &[]).map(|_| ())
    }

    fn report_of(&mut self, state: &State) -> Result<Reported, EngineError> {
        if !self.plan().has_buffer(Array::ReportedMomenta) {
            return self.reported();
        }
        let given = self.tell(Command::Momenta, &[])?;
        let words = given.get(1).map_or(&[][..], Vec::as_slice);
        // The high words are of the sign only.
        let momenta = words.chunks_exact(6).map(|words| [0, 2, 4].map(|axis| words[axis].cast_signed())).collect();
        Ok(Reported { momenta, ..state.clone().into() })
    }

    fn measure(&mut self, samplers: &[usize]) -> Result<Vec<Sample>, EngineError> {
        self.tell(Command::Measure { samplers: samplers.to_vec() }, &[])?;
        Ok(self.take_samples())
    }

    fn renumber(&mut self, plan: &Plan, scene: &str, state: &State) -> Result<bool, EngineError> {
        if !self.engine.load_numbers(plan)? {
            return Ok(false);
        }
        let loaded = self.tell(Command::Renumber { scene: scene.to_owned() }, &[])?;
        if loaded.iter().flatten().any(|loaded| *loaded == 0) {
            return Ok(false);
        }
        self.upload(state)?;
        Ok(true)
    }
}

impl Drop for Team<'_> {
    fn drop(&mut self) {
        // Ranks that have ended already need not be told.
        let _ = written(&Command::End, &[]).and_then(|message| self.channel.tell(&message));
    }
}
