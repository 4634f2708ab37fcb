//! Particles that pass from rank to rank at the end of a step, where several share a run.

use super::readback::read_after;
use super::{EngineError, recording::Recording};
use crate::gpu::Gpu;
use crate::plan::paths::PATH_WORDS;
use crate::plan::{Domain, PARTICLE_WORDS, Part, PlannedPart};
use crate::shaders::Array;
use crate::state::crossings;
use std::collections::HashMap;
use std::time::{Duration, Instant};

/// Words of a particle.
const PARTICLE: usize = PARTICLE_WORDS as usize;

/// The number of a particle that is forgotten: shaders/ranks/domain.wgsl.
const NOBODY: u32 = u32::MAX;

/// How a rank passes on what its peers need, and learns what it needs of them.
pub trait Swap {
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
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Traffic {
    /// Exchanges.
    pub exchanges: u64,
    /// Bytes sent.
    pub bytes: u64,
    /// Copies of particles of others that were stored, summed over the exchanges.
    pub copies: u64,
    /// Time spent waiting for peers.
    pub waiting: Duration,
}

/// The exchange of one rank.
pub(super) struct Exchange<'a> {
    gpu: &'a Gpu,
    part: PlannedPart,
    swap: Box<dyn Swap + 'a>,
    particles: wgpu::Buffer,
    stored_count: wgpu::Buffer,
    outgoing: wgpu::Buffer,
    outgoing_counts: wgpu::Buffer,
    /// Particles for each peer that are read back before their number is known.
    guesses: Vec<u64>,
    /// Particles stored: the sorted ones and what has arrived.
    pub stored: u64,
    /// The step at which a part turned out too small for what arrived.
    pub crowded: Option<u64>,
    pub traffic: Traffic,
}

impl<'a> Exchange<'a> {
    pub(super) fn new(
        gpu: &'a Gpu,
        part: PlannedPart,
        swap: Box<dyn Swap + 'a>,
        buffers: &HashMap<Array, wgpu::Buffer>,
    ) -> Self {
        let of = |array| buffers[&array].clone();
        let guesses = vec![0; part.peers.len()];
        Self {
            gpu,
            part,
            swap,
            particles: of(Array::Particles),
            stored_count: of(Array::StoredNumber),
            outgoing: of(Array::Outgoing),
            outgoing_counts: of(Array::OutgoingCounts),
            guesses,
            stored: 0,
            crowded: None,
            traffic: Traffic::default(),
        }
    }

    /// The kernel after which particles are exchanged.
    pub(super) fn kernel(&self) -> usize {
        self.part.exchange
    }

    /// Whether this is the first rank.
    pub(super) fn is_first(&self) -> bool {
        self.part.part.rank == 0
    }

    /// Whether the rank knows all particles of the box.
    pub(super) fn knows_all(&self) -> bool {
        self.part.domains.get(1).is_some_and(Domain::is_whole)
    }

    /// Of particles as they are stored those that the rank needs.
    pub(super) fn needed(&self, particles: &[u32]) -> Vec<u32> {
        let [_, needed, ..] = self.part.domains[..] else { return Vec::new() };
        within(&needed, particles)
    }

    /// The rank's own of the particles in storage after an exchange.
    pub(super) fn own_of(&self, particles: &[u32]) -> Vec<u32> {
        let stored = &particles[..PARTICLE * (self.stored as usize)];
        self.part.domains.first().map_or_else(Vec::new, |own| within(own, stored))
    }

    /// The rank's own of the particles in storage after a sort, which has marked them and counted all.
    pub(super) fn marked_of(&self, particles: &[u32], marks: &[u32], counts: &[u32]) -> Vec<u32> {
        let sorted = counts.get(self.part.peers.len()).copied().unwrap_or_default();
        let marked = particles.chunks_exact(PARTICLE).zip(marks).take(sorted as usize);
        marked.filter(|(_, mark)| **mark != 0).flat_map(|(particle, _)| particle).copied().collect()
    }

    /// Leaves the peers, who wait no longer.
    pub(super) fn leave(&mut self) {
        self.swap.leave(&self.part.peers);
    }

    /// Begins with a number of particles in storage.
    pub(super) fn begin(&mut self, stored: u64) {
        self.store_count(stored);
        self.crowded = None;
    }

    fn store_count(&mut self, stored: u64) {
        self.stored = stored;
        self.gpu.queue.write_buffer(&self.stored_count, 0, bytemuck::bytes_of(&(stored as u32)));
    }

    /// Runs what is recorded, and exchanges the particles that it leaves at the end of a step.
    ///
    /// # Errors
    /// [`EngineError`] if the device or a peer fails. Too many particles are no error yet: the other ranks wait for the rest of the batch.
    pub(super) fn pass_on(&mut self, recording: &mut Recording<'_>, step: u64) -> Result<(), EngineError> {
        let particle = 4 * PARTICLE as u64;
        let stretch = particle * self.part.room;
        let head = 4 * (self.part.peers.len() as u64 + 1);
        let (outgoing, counts) = (&self.outgoing, &self.outgoing_counts);
        let guessed = head + particle * self.guesses.iter().sum::<u64>();
        let read = read_after(self.gpu, recording.take(), guessed, |encoder, staging| {
            encoder.copy_buffer_to_buffer(counts, 0, staging, 0, head);
            let mut at = head;
            for (peer, guess) in self.guesses.iter().enumerate().filter(|(_, guess)| **guess > 0) {
                encoder.copy_buffer_to_buffer(outgoing, stretch * peer as u64, staging, at, particle * guess);
                at += particle * guess;
            }
            encoder.clear_buffer(counts, 0, Some(head - 4));
        })?;
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
        for parcel in &arrived {
            let count = parcel.len() as u64 / particle;
            let fits = count.min(self.part.slots - stored.min(self.part.slots));
            if fits < count {
                self.crowded.get_or_insert(step);
            }
            self.gpu.queue.write_buffer(&self.particles, particle * stored, &parcel[..(particle * fits) as usize]);
            stored += fits;
            self.traffic.copies += fits;
        }
        self.store_count(stored);
        Ok(())
    }

    /// Reads what was not guessed.
    fn read_rest(&self, counts: &[u64], parcels: &mut [Vec<u8>]) -> Result<(), EngineError> {
        let particle = 4 * PARTICLE as u64;
        let rests: Vec<u64> =
            counts.iter().zip(&self.guesses).map(|(count, guess)| count.saturating_sub(*guess)).collect();
        let all: u64 = rests.iter().sum();
        if all == 0 {
            return Ok(());
        }
        let stretch = particle * self.part.room;
        let encoder = self.gpu.encoder("exchange");
        let read = read_after(self.gpu, encoder, particle * all, |encoder, staging| {
            let mut at = 0;
            for (peer, rest) in rests.iter().enumerate().filter(|(_, rest)| **rest > 0) {
                let from = stretch * peer as u64 + particle * self.guesses[peer];
                encoder.copy_buffer_to_buffer(&self.outgoing, from, staging, at, particle * rest);
                at += particle * rest;
            }
        })?;
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
fn within(domain: &Domain, particles: &[u32]) -> Vec<u32> {
    let inside = |particle: &&[u32]| particle[3] != NOBODY && domain.contains([particle[0], particle[1], particle[2]]);
    particles.chunks_exact(PARTICLE).filter(inside).flatten().copied().collect()
}

/// How often each particle has crossed the box on every axis while it was a rank's own, two words each, from where all were last and these
/// particles, its own, are now.
pub(super) fn crossed(paths: &[u32], own: &[u32]) -> Vec<u32> {
    let mut counted: Vec<[i64; 3]> = paths
        .chunks_exact(PATH_WORDS)
        .map(|path| std::array::from_fn(|axis| i64::from(path[PATH_WORDS / 2 + axis].cast_signed())))
        .collect();
    for particle in own.chunks_exact(PARTICLE) {
        let id = particle[3] as usize;
        if let (Some(counted), Some(path)) = (counted.get_mut(id), paths.chunks_exact(PATH_WORDS).nth(id)) {
            let since = crossings([path[0], path[1], path[2]], [particle[0], particle[1], particle[2]]);
            (0..3).for_each(|axis| counted[axis] += i64::from(since[axis]));
        }
    }
    counted.into_iter().flatten().flat_map(|count| [count as u32, (count >> 32) as u32]).collect()
}
