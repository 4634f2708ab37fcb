//! Ranks that are processes, on one machine or several, started by a launcher of MPI. Nothing waits longer than is patient: who does ends
//! all ranks.
//!
//! A rank that has waited for so long asks the one that it waits for. Whoever waits too answers at once, so that only those speak that
//! wait for the rank that is lost. The first rank, which writes and draws between commands, keeps alive in the meantime.

use super::{Channel, PATIENCE, Processes};
use crate::engine::Swap;
use crate::plan::Part;
use mpi::environment::Universe;
use mpi::point_to_point::{Message, Status};
use mpi::request::LocalScope;
use mpi::topology::SimpleCommunicator;
use mpi::traits::{Communicator as _, Destination as _, Source as _};
use std::cell::Cell;
use std::thread;
use std::time::{Duration, Instant};

/// Kinds of messages.
const COMMAND: i32 = 1;
const ANSWER: i32 = 2;
const PARCEL: i32 = 3;
/// Its sender will send no parcels any more.
const GONE: i32 = 4;
/// Whether its receiver waits as well, ...
const ASKED: i32 = 5;
/// ... and that it does.
const WAITING: i32 = 6;

/// The length of a command that is none: its sender is at work.
const ALIVE: u64 = u64::MAX;

/// Time for the answer of a rank that waits.
const GRACE: Duration = Duration::from_secs(1);
/// Of several ranks that miss the same one, the first speaks and ends all before the turn of the next: launchers take a second.
const TURN: Duration = Duration::from_secs(2);
const TURNS: u32 = 4;

/// A message is sent in pieces of at most so many bytes: MPI counts in 32 bits.
const PIECE: usize = 1 << 30;

/// The exit code of ranks that are ended because one is lost.
const LOST: i32 = 3;

/// Waiting without sleep gets in the way of others on the same cores; these are the shortest and the longest sleeps.
const NAPS: [Duration; 2] = [Duration::from_micros(20), Duration::from_millis(2)];

/// All ranks, for as long as the process takes part.
pub struct World {
    universe: Universe,
    patience: Duration,
    alarm: fn(&str),
    /// How often the ranks have become peers, which is the same on all of them.
    rounds: Cell<u64>,
}

impl World {
    /// Takes part. `alarm` is told why before all ranks are ended; without a time of its own a rank is patient for [`PATIENCE`].
    ///
    /// # Errors
    /// In words, if MPI has been started before.
    pub fn join(patience: Option<Duration>, alarm: fn(&str)) -> Result<Self, String> {
        let universe = mpi::initialize().ok_or_else(|| "MPI has been started before".to_owned())?;
        Ok(Self { universe, patience: patience.unwrap_or(PATIENCE), alarm, rounds: Cell::new(0) })
    }

    /// This rank.
    #[must_use]
    pub fn rank(&self) -> u32 {
        self.universe.world().rank().cast_unsigned()
    }

    fn line(&self) -> Line {
        Line { patience: self.patience, alarm: self.alarm, round: self.rounds.get() }
    }
}

/// Ends all ranks at once.
pub fn abort(exit_code: i32) -> ! {
    SimpleCommunicator::world().abort(exit_code)
}

impl Processes for World {
    fn count(&self) -> u32 {
        self.universe.world().size().cast_unsigned()
    }

    fn channel(&self) -> Box<dyn Channel + '_> {
        Box::new(self.line())
    }

    fn peers(&self) -> Box<dyn Swap + '_> {
        self.rounds.set(self.rounds.get() + 1);
        Box::new(Peers { line: self.line() })
    }
}

/// The line of a rank to the others. It holds no communicator, which could not move to another thread.
struct Line {
    patience: Duration,
    alarm: fn(&str),
    round: u64,
}

/// The same for parcels.
struct Peers {
    line: Line,
}

/// Tries again and again, with sleeps that become longer.
fn wait_for<T>(patience: Duration, mut attempt: impl FnMut() -> Option<T>) -> Option<T> {
    let begun = Instant::now();
    let [mut nap, longest] = NAPS;
    loop {
        if let Some(found) = attempt() {
            return Some(found);
        }
        let waited = begun.elapsed();
        if waited > patience {
            return None;
        }
        // The first answers come within microseconds.
        if waited > NAPS[0] {
            thread::sleep(nap);
            nap = (nap * 2).min(longest);
        }
    }
}

/// What a message says that is no piece of another.
fn head_of(message: Message) -> [u64; 2] {
    let mut head = [0; 2];
    message.matched_receive_into(bytemuck::bytes_of_mut(&mut head));
    head
}

impl Line {
    /// Ends all ranks: who does not answer would not hear of anything else.
    fn lose(&self, rank: u32) -> ! {
        let turn = TURN * SimpleCommunicator::world().rank().cast_unsigned().min(TURNS);
        let _: Option<()> = wait_for(turn, || {
            self.answer_questions();
            None
        });
        (self.alarm)(&format!("rank {rank} has not answered for {} s", self.patience.as_secs()));
        SimpleCommunicator::world().abort(LOST)
    }

    /// Sends something to some ranks, each its own, while `meanwhile` receives.
    fn send<T>(&self, parcels: &[(u32, &[u8])], tag: i32, meanwhile: impl FnOnce() -> T) -> T {
        let heads: Vec<[u64; 2]> = parcels.iter().map(|(_, bytes)| [bytes.len() as u64, self.round]).collect();
        let world = SimpleCommunicator::world();
        mpi::request::scope(|scope: &LocalScope<'_>| {
            let mut requests = Vec::new();
            for ((rank, bytes), head) in parcels.iter().zip(&heads) {
                let process = world.process_at_rank(rank.cast_signed());
                let pieces = std::iter::once(bytemuck::bytes_of(head)).chain(bytes.chunks(PIECE));
                requests.extend(pieces.map(|piece| (*rank, process.immediate_send_with_tag(scope, piece, tag))));
            }
            let done = meanwhile();
            for (rank, request) in requests {
                let mut waiting = Some(request);
                self.wait_for(rank, || {
                    waiting = waiting.take().and_then(|request| request.test().err());
                    waiting.is_none().then_some(())
                });
            }
            done
        })
    }

    /// Waits for something that depends on a rank: twice, if that waits as well, until whoever waits for the one that is lost has spoken.
    fn wait_for<T>(&self, rank: u32, mut attempt: impl FnMut() -> Option<T>) -> T {
        let mut attempt = || {
            attempt().or_else(|| {
                self.answer_questions();
                None
            })
        };
        let found = wait_for(self.patience, &mut attempt).or_else(|| {
            self.send_head(rank.cast_signed(), 0, ASKED);
            let world = SimpleCommunicator::world();
            let process = world.process_at_rank(rank.cast_signed());
            let waits = || process.immediate_matched_probe_with_tag(WAITING);
            let answer = wait_for(GRACE, || attempt().map(Ok).or_else(|| waits().map(Err)))?;
            answer.map_or_else(
                |(message, _)| {
                    let _ = head_of(message);
                    wait_for(self.patience + GRACE + TURN * (TURNS + 1), &mut attempt)
                },
                Some,
            )
        });
        found.unwrap_or_else(|| self.lose(rank))
    }

    /// Sends what is so short that nobody waits until it is received.
    fn send_head(&self, rank: i32, length: u64, tag: i32) {
        SimpleCommunicator::world().process_at_rank(rank).send_with_tag(bytemuck::bytes_of(&[length, self.round]), tag);
    }

    fn answer_questions(&self) {
        let world = SimpleCommunicator::world();
        while let Some((message, status)) = world.any_process().immediate_matched_probe_with_tag(ASKED) {
            let _ = head_of(message);
            self.send_head(status.source_rank(), 0, WAITING);
        }
    }

    /// The next message of some kinds from a rank.
    fn next(&self, rank: u32, tags: &[i32]) -> (Message, Status) {
        let world = SimpleCommunicator::world();
        let process = world.process_at_rank(rank.cast_signed());
        self.wait_for(rank, || tags.iter().find_map(|tag| process.immediate_matched_probe_with_tag(*tag)))
    }

    /// What a rank sends; nothing if it has gone.
    fn receive(&self, rank: u32, tags: &[i32]) -> Option<Vec<u8>> {
        let (length, tag) = loop {
            let (message, status) = self.next(rank, tags);
            let [length, round] = head_of(message);
            match status.tag() {
                GONE if round == self.round => return None,
                // It had left in an earlier round.
                GONE => {}
                COMMAND if length == ALIVE => {}
                tag => break (length, tag),
            }
        };
        let mut bytes = vec![0; usize::try_from(length).unwrap_or(usize::MAX)];
        for piece in bytes.chunks_mut(PIECE) {
            let (message, _) = self.next(rank, &[tag]);
            message.matched_receive_into(piece);
        }
        Some(bytes)
    }

    fn others(&self) -> std::ops::Range<u32> {
        1..SimpleCommunicator::world().size().cast_unsigned()
    }
}

fn gone(rank: u32) -> String {
    format!("rank {rank} has ended")
}

impl Channel for Line {
    fn count(&self) -> u32 {
        SimpleCommunicator::world().size().cast_unsigned()
    }

    fn tell(&mut self, message: &[u8]) -> Result<(), String> {
        let all: Vec<(u32, &[u8])> = self.others().map(|rank| (rank, message)).collect();
        self.send(&all, COMMAND, || ());
        Ok(())
    }

    fn keep_alive(&self) {
        self.others().for_each(|rank| self.send_head(rank.cast_signed(), ALIVE, COMMAND));
    }

    fn listen(&mut self) -> Result<Vec<u8>, String> {
        self.receive(0, &[COMMAND]).ok_or_else(|| gone(0))
    }

    fn answer(&mut self, message: &[u8]) -> Result<(), String> {
        self.send(&[(0, message)], ANSWER, || ());
        Ok(())
    }

    fn collect(&mut self) -> Result<Vec<Vec<u8>>, String> {
        self.others().map(|rank| self.receive(rank, &[ANSWER]).ok_or_else(|| gone(rank))).collect()
    }
}

impl Swap for Peers {
    fn swap(&mut self, _: &Part, peers: &[u32], outgoing: &[&[u8]]) -> Result<Vec<Vec<u8>>, String> {
        let parcels: Vec<(u32, &[u8])> = peers.iter().copied().zip(outgoing.iter().copied()).collect();
        self.line.send(&parcels, PARCEL, || {
            peers.iter().map(|peer| self.line.receive(*peer, &[PARCEL, GONE]).ok_or_else(|| gone(*peer))).collect()
        })
    }

    fn leave(&mut self, peers: &[u32]) {
        let parcels: Vec<(u32, &[u8])> = peers.iter().map(|peer| (*peer, &[][..])).collect();
        self.line.send(&parcels, GONE, || ());
    }
}
