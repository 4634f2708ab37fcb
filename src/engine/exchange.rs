//! What passes from rank to rank where several share a run: particles at the end of a step, and integers that all add to within it.

use super::readback::Reading;
use super::stored::Stored;
use super::{EngineError, recording::Recording};
use crate::gpu::{Gpu, GpuError};
use crate::plan::paths::PATH_WORDS;
use crate::plan::{Domain, FREE_SHARE, Part, ParticleWords, PlannedPart, SharedSum, Stretch};
use crate::shaders::Array;
use crate::state::crossings;
use serde::{Deserialize, Serialize};
use std::collections::HashMap;
use std::time::{Duration, Instant};

/// The number of a particle that is forgotten: shaders/ranks/domain.wgsl.
const NOBODY: u32 = u32::MAX;

/// How a rank passes on what its peers need, and learns what it needs of them.
pub trait Swap: Send {
    /// Gives every peer its bytes, and returns theirs in the same order.
    ///
    /// # Errors
    /// What is wrong with a peer, in words.
    fn swap(&mut self, part: &Part, peers: &[u32], outgoing: &[&[u8]]) -> Result<Vec<Vec<u8>>, String>;

    /// Lets peers know that nothing more comes from here; where they cannot notice by themselves.
    fn leave(&mut self, peers: &[u32]) {
        let _ = peers;
    }
}

/// What has been exchanged.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
pub struct Traffic {
    /// Exchanges.
    pub exchanges: u64,
    /// Bytes sent.
    pub bytes: u64,
    /// Copies of particles of others that were stored, summed over the exchanges.
    pub copies: u64,
    /// Time spent waiting for peers.
    pub waiting: Duration,
    /// Time in which the host waited for the device and the copies from it.
    pub computing: Duration,
    /// Time of the exchanges but for that: waiting for peers, and what the host does before and after. The device may compute meanwhile.
    pub exchanging: Duration,
}

/// The exchange of one rank.
pub(super) struct Exchange<'a> {
    gpu: Gpu,
    pub part: PlannedPart,
    swap: Box<dyn Swap + 'a>,
    particles: Stored,
    stored_count: Stored,
    outgoing: Stored,
    outgoing_counts: Stored,
    /// The arrays that are summed over ranks.
    summed: Vec<Stored>,
    /// Particles for each peer that are read back before their number is known.
    guesses: Vec<u64>,
    /// The same of exchanges with the other halo.
    other_guesses: Vec<u64>,
    /// Whether ranks are sent what they need for samples that look further.
    is_wide: bool,
    domains: Option<Stored>,
    /// Places of particles in use: the sorted ones and what has arrived.
    pub stored: u64,
    /// Particles that are the rank's own, where it knows of no others.
    own: u64,
    /// What is on its way to the host, and since when.
    outgoing_read: Option<(Reading, Instant)>,
    /// The step at which a part turned out too small for what arrived.
    pub crowded: Option<u64>,
    pub traffic: Traffic,
}

impl<'a> Exchange<'a> {
    pub(super) fn new(
        gpu: &Gpu,
        part: PlannedPart,
        swap: Box<dyn Swap + 'a>,
        buffers: &HashMap<Array, Stored>,
    ) -> Self {
        let of = |array| buffers[&array].clone();
        let guesses = vec![0; part.peers.len()];
        let summed = part.sums.iter().map(|sum| of(sum.array)).collect();
        Self {
            gpu: gpu.clone(),
            part,
            swap,
            particles: of(Array::Particles),
            stored_count: of(Array::StoredNumber),
            outgoing: of(Array::Outgoing),
            outgoing_counts: of(Array::OutgoingCounts),
            summed,
            other_guesses: guesses.clone(),
            guesses,
            is_wide: false,
            domains: buffers.get(&Array::Domains).cloned(),
            stored: 0,
            own: 0,
            outgoing_read: None,
            crowded: None,
            traffic: Traffic::default(),
        }
    }

    /// Exchanges what is exchanged after a kernel, if anything, with all that is recorded before.
    ///
    /// # Errors
    /// [`EngineError`] if the device or a peer fails.
    pub(super) fn follow(&mut self, kernel: usize, recording: &mut Recording, step: u64) -> Result<(), EngineError> {
        if self.part.passages.iter().any(|passage| passage.after == kernel) {
            self.send(recording)?;
        }
        if self.part.passages.iter().any(|passage| passage.until == kernel) {
            // The device goes on with what is recorded since.
            recording.submit();
            self.receive(step)?;
        }
        let Some(index) = self.part.sums.iter().position(|sum| sum.after == kernel) else { return Ok(()) };
        let (sum, array) = (self.part.sums[index].clone(), self.summed[index].clone());
        self.add_up(recording, &sum, &array)
    }

    /// Whether the next exchanges bring what samples need that look further than forces reach.
    pub(super) fn widen(&mut self, wide: bool) -> Result<(), GpuError> {
        let (Some(wider), Some(buffer)) = (&self.part.wider, &self.domains) else { return Ok(()) };
        if std::mem::replace(&mut self.is_wide, wide) != wide {
            std::mem::swap(&mut self.guesses, &mut self.other_guesses);
            let domains = if wide { &wider.domains } else { &self.part.domains };
            buffer.write(&self.gpu, 0, bytemuck::cast_slice(domains))?;
        }
        Ok(())
    }

    /// Whether so many places are free that particles should be put in order.
    pub(super) fn has_gaps(&self) -> bool {
        FREE_SHARE * self.stored.saturating_sub(self.own) > self.own
    }

    /// Whether this is the first rank.
    pub(super) fn is_first(&self) -> bool {
        self.part.part.rank == 0
    }

    /// Whether the rank knows all particles of the box.
    pub(super) fn knows_all(&self) -> bool {
        self.part.domains.get(1).is_some_and(Domain::is_whole)
    }

    /// Of particles as they are stored those that the rank needs, whatever is sampled first.
    pub(super) fn needed(&self, particles: &[u32]) -> Vec<u32> {
        let domains = self.part.wider.as_ref().map_or(&self.part.domains, |wider| &wider.domains);
        let [_, needed, ..] = domains[..] else { return Vec::new() };
        within(&needed, self.part.particle, particles)
    }

    /// The rank's own of the particles in storage after an exchange.
    pub(super) fn own_of(&self, particles: &[u32]) -> Vec<u32> {
        let stored = &particles[..self.part.particle.count * (self.stored as usize)];
        self.part.domains.first().map_or_else(Vec::new, |own| within(own, self.part.particle, stored))
    }

    /// The rank's own of the particles in storage after a sort, which has counted all; where there are copies of others, it has marked them
    /// before they moved on.
    pub(super) fn sorted_of(&self, particles: &[u32], marks: Option<&[u32]>, counts: &[u32]) -> Vec<u32> {
        let words = self.part.particle.count;
        let sorted = counts.get(self.part.peers.len()).map_or(0, |sorted| *sorted as usize);
        let Some(marks) = marks else {
            let own = self.part.domains.first();
            return own.map_or_else(Vec::new, |own| within(own, self.part.particle, &particles[..words * sorted]));
        };
        let marked = particles.chunks_exact(words).zip(marks).take(sorted);
        marked.filter(|(_, mark)| **mark != 0).flat_map(|(particle, _)| particle).copied().collect()
    }

    /// Leaves the peers, who wait no longer.
    pub(super) fn leave(&mut self) {
        self.swap.leave(&self.part.peers);
    }

    /// Begins with particles in storage, of so many words.
    pub(super) fn begin(&mut self, words: u64) -> Result<(), GpuError> {
        let stored = words / self.part.particle.count as u64;
        self.store_count(stored)?;
        self.own = stored;
        self.outgoing_read = None;
        self.crowded = None;
        let none = vec![0_u8; 4 * (self.part.peers.len() + 1)];
        self.outgoing_counts.write(&self.gpu, 0, &none)
    }

    fn store_count(&mut self, stored: u64) -> Result<(), GpuError> {
        self.stored = stored;
        self.stored_count.write(&self.gpu, 0, bytemuck::bytes_of(&(stored as u32)))
    }

    /// Bytes of the numbers of outgoing and of sorted particles.
    fn head(&self) -> u64 {
        4 * (self.part.peers.len() as u64 + 1)
    }

    /// Runs what is recorded, and begins to read the particles that other ranks need.
    fn send(&mut self, recording: &mut Recording) -> Result<(), EngineError> {
        let particle = 4 * self.part.particle.count as u64;
        let stretch = particle * self.part.room;
        let head = self.head();
        let (outgoing, counts) = (&self.outgoing, &self.outgoing_counts);
        let guessed = head + particle * self.guesses.iter().sum::<u64>();
        let submitted = Instant::now();
        let reading = Reading::begin(&self.gpu, recording.take(), guessed, |encoder, staging| {
            counts.copy_to(encoder, 0..head, staging, 0);
            let mut at = head;
            for (peer, guess) in self.guesses.iter().enumerate().filter(|(_, guess)| **guess > 0) {
                let from = stretch * peer as u64;
                outgoing.copy_to(encoder, from..from + particle * guess, staging, at);
                at += particle * guess;
            }
            counts.clear(encoder, 0..head - 4);
        })?;
        self.outgoing_read = Some((reading, submitted));
        Ok(())
    }

    /// Gives the other ranks what was read, and stores what they give.
    ///
    /// # Errors
    /// [`EngineError`] if the device or a peer fails. Too many particles are no error yet: the other ranks wait for the rest of the batch.
    fn receive(&mut self, step: u64) -> Result<(), EngineError> {
        let Some((reading, submitted)) = self.outgoing_read.take() else { return Ok(()) };
        let particle = 4 * self.part.particle.count as u64;
        let head = self.head();
        let read = reading.finish(&self.gpu)?;
        self.traffic.computing += submitted.elapsed();
        let computed = Instant::now();
        let head_words: Vec<u32> = bytemuck::pod_collect_to_vec(&read[..head as usize]);
        let (sorted, counts) = head_words.split_last().map_or((0, &[][..]), |(sorted, counts)| (*sorted, counts));
        let counts: Vec<u64> = counts.iter().map(|count| u64::from(*count).min(self.part.room)).collect();
        let mut at = head as usize;
        let mut parcels: Vec<Vec<u8>> = Vec::with_capacity(counts.len());
        for (count, guess) in counts.iter().zip(&self.guesses) {
            parcels.push(read[at..at + (particle * count.min(guess)) as usize].to_vec());
            at += (particle * guess) as usize;
        }
        self.read_rest(&counts, &mut parcels)?;
        // A little more than this time: a second look costs as much as the first.
        self.guesses = counts.iter().map(|count| (count + count / 32 + 16).min(self.part.room)).collect();
        let parcels: Vec<&[u8]> = parcels.iter().map(Vec::as_slice).collect();
        let begun = Instant::now();
        let arrived = self.swap.swap(&self.part.part, &self.part.peers, &parcels);
        let arrived = arrived.map_err(|reason| EngineError::Ranks { reason })?;
        self.traffic.waiting += begun.elapsed();
        self.traffic.exchanges += 1;
        self.traffic.bytes += parcels.iter().map(|parcel| parcel.len() as u64).sum::<u64>();
        let mut stored = u64::from(sorted);
        self.own = self.own.saturating_sub(counts.iter().sum());
        for parcel in &arrived {
            let count = parcel.len() as u64 / particle;
            let fits = count.min(self.part.slots - stored.min(self.part.slots));
            if fits < count {
                self.crowded.get_or_insert(step);
            }
            self.particles.write(&self.gpu, particle * stored, &parcel[..(particle * fits) as usize])?;
            stored += fits;
            self.own += fits;
            // Without a halo a particle is nobody else's.
            self.traffic.copies += if self.part.has_halo() { fits } else { 0 };
        }
        self.store_count(stored)?;
        self.traffic.exchanging += computed.elapsed();
        Ok(())
    }

    /// Runs what is recorded, and adds what the other ranks have to an array that all of them add to.
    fn add_up(&mut self, recording: &mut Recording, sum: &SharedSum, array: &Stored) -> Result<(), EngineError> {
        let lost = |reason: String| EngineError::Ranks { reason };
        let rank = self.part.part.rank as usize;
        let none = Stretch { first: 0, count: 0 };
        let stretch_of = |rank: usize| sum.stretches.get(rank).copied().unwrap_or(none);
        let own = stretch_of(rank);
        let submitted = Instant::now();
        let read = Reading::begin(&self.gpu, recording.take(), 4 * own.count, |encoder, staging| {
            let mut at = 0;
            for piece in sum.pieces(own).into_iter().filter(|piece| piece.count > 0) {
                array.copy_to(encoder, 4 * piece.first..4 * (piece.first + piece.count), staging, at);
                at += 4 * piece.count;
            }
        })?;
        let read = read.finish(&self.gpu)?;
        self.traffic.computing += submitted.elapsed();
        let computed = Instant::now();
        let others = self.part.others();
        let begun = Instant::now();
        let arrived = self.swap.swap(&self.part.part, &others, &vec![read.as_slice(); others.len()]).map_err(lost)?;
        self.traffic.waiting += begun.elapsed();
        self.traffic.bytes += (read.len() * others.len()) as u64;
        let mut sums = vec![0_i64; sum.length as usize];
        let parts = others.iter().map(|other| *other as usize).zip(&arrived).chain([(rank, &read)]);
        for (rank, bytes) in parts {
            let stretch = stretch_of(rank);
            if bytes.len() as u64 != 4 * stretch.count {
                return Err(lost(format!("rank {rank} adds to another number of places")));
            }
            let words: Vec<i32> = bytemuck::pod_collect_to_vec(bytes);
            let mut words = words.into_iter();
            for piece in sum.pieces(stretch) {
                let places = sums.iter_mut().skip(piece.first as usize).take(piece.count as usize);
                for (place, word) in places.zip(words.by_ref()) {
                    *place = sum.with(*place, word);
                }
            }
        }
        let sums: Vec<i32> = sums.into_iter().map(|all| sum.word(all)).collect();
        array.write(&self.gpu, 0, bytemuck::cast_slice(&sums))?;
        self.traffic.exchanging += computed.elapsed();
        Ok(())
    }

    /// Reads what was not guessed.
    fn read_rest(&self, counts: &[u64], parcels: &mut [Vec<u8>]) -> Result<(), EngineError> {
        let particle = 4 * self.part.particle.count as u64;
        let rests: Vec<u64> =
            counts.iter().zip(&self.guesses).map(|(count, guess)| count.saturating_sub(*guess)).collect();
        let all: u64 = rests.iter().sum();
        if all == 0 {
            return Ok(());
        }
        let stretch = particle * self.part.room;
        let encoder = self.gpu.encoder("exchange");
        let read = Reading::begin(&self.gpu, encoder, particle * all, |encoder, staging| {
            let mut at = 0;
            for (peer, rest) in rests.iter().enumerate().filter(|(_, rest)| **rest > 0) {
                let from = stretch * peer as u64 + particle * self.guesses[peer];
                self.outgoing.copy_to(encoder, from..from + particle * rest, staging, at);
                at += particle * rest;
            }
        })?;
        let read = read.finish(&self.gpu)?;
        let mut at = 0;
        for (parcel, rest) in parcels.iter_mut().zip(&rests) {
            let bytes = (particle * rest) as usize;
            parcel.extend(&read[at..at + bytes]);
            at += bytes;
        }
        Ok(())
    }
}

/// The particles in a domain; one that is forgotten may lie anywhere.
fn within(domain: &Domain, words: ParticleWords, particles: &[u32]) -> Vec<u32> {
    let inside = |particle: &&[u32]| particle[words.number] != NOBODY && domain.contains(words.position(particle));
    particles.chunks_exact(words.count).filter(inside).flatten().copied().collect()
}

/// How often each particle has crossed the box on every axis while it was a rank's own, two words each, from where all were last and these
/// particles, its own, are now.
pub(super) fn crossed(paths: &[u32], words: ParticleWords, own: &[u32]) -> Vec<u32> {
    let mut counted: Vec<[i64; 3]> = paths
        .chunks_exact(PATH_WORDS)
        .map(|path| std::array::from_fn(|axis| i64::from(path[PATH_WORDS / 2 + axis].cast_signed())))
        .collect();
    for particle in own.chunks_exact(words.count) {
        let id = particle[words.number] as usize;
        if let (Some(counted), Some(path)) = (counted.get_mut(id), paths.chunks_exact(PATH_WORDS).nth(id)) {
            let since = crossings([path[0], path[1], path[2]], words.position(particle));
            (0..3).for_each(|axis| counted[axis] += i64::from(since[axis]));
        }
    }
    counted.into_iter().flatten().flat_map(|count| [count as u32, (count >> 32) as u32]).collect()
}
