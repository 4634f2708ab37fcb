//! Ranks that are threads of one process, each with an adapter of its own.

use super::{Channel, PATIENCE};
use crate::engine::Swap;
use crate::plan::Part;
use std::sync::mpsc::{Receiver, RecvTimeoutError, Sender, channel};
use std::thread::{self, JoinHandle};
use std::time::{Duration, Instant};

/// How long the first rank waits for the threads of the others at its end.
const ENDING: Duration = Duration::from_secs(10);

/// Lines to all ranks and from them, in their order.
struct Lines {
    to: Vec<Sender<Vec<u8>>>,
    from: Vec<Receiver<Vec<u8>>>,
    patience: Duration,
}

impl Lines {
    /// The lines of each of so many ranks.
    fn among(count: u32, patience: Duration) -> Vec<Self> {
        let mut all: Vec<Self> = (0..count).map(|_| Self { to: Vec::new(), from: Vec::new(), patience }).collect();
        for receiver in 0..all.len() {
            for sender in 0..all.len() {
                let (to, from) = channel();
                all[sender].to.push(to);
                all[receiver].from.push(from);
            }
        }
        all
    }

    fn say(&self, rank: u32, message: &[u8]) -> Result<(), String> {
        let to = self.to.get(rank as usize).ok_or_else(|| format!("there is no rank {rank}"))?;
        to.send(message.to_vec()).map_err(|_| format!("rank {rank} has ended"))
    }

    /// The message of another rank.
    fn hear(&self, rank: u32) -> Result<Vec<u8>, String> {
        let from = self.from.get(rank as usize).ok_or_else(|| format!("there is no rank {rank}"))?;
        from.recv_timeout(self.patience).map_err(|error| match error {
            RecvTimeoutError::Timeout => format!("rank {rank} has not answered for {} s", self.patience.as_secs()),
            RecvTimeoutError::Disconnected => format!("rank {rank} has ended"),
        })
    }
}

/// What a rank talks with: to the first rank, and to its peers.
pub struct Links {
    /// With the first rank; for that, with all others.
    pub channel: Threads,
    /// With all ranks.
    pub peers: Peers,
}

/// Lines between the first rank and the others.
pub struct Threads {
    lines: Lines,
    /// Of the first rank the threads of the others.
    ranks: Vec<JoinHandle<()>>,
}

impl Threads {
    /// Takes the threads of the other ranks, to wait for them at the end: they unload drivers, and a process that ends meanwhile crashes.
    pub(crate) fn keep(&mut self, ranks: Vec<JoinHandle<()>>) {
        self.ranks = ranks;
    }
}

impl Drop for Threads {
    fn drop(&mut self) {
        // Who listens to this rank, or answers it, ends.
        self.lines.to.clear();
        self.lines.from.clear();
        let begun = Instant::now();
        while self.ranks.iter().any(|rank| !rank.is_finished()) && begun.elapsed() < ENDING {
            thread::sleep(Duration::from_millis(1));
        }
        for rank in self.ranks.drain(..).filter(JoinHandle::is_finished) {
            // A panic has told of itself.
            let _ = rank.join();
        }
    }
}

/// Lines between ranks that are neighbours.
pub struct Peers(Lines);

/// The links of so many ranks, in their order.
///
/// ```
/// use mesoscope::ranks::{Channel, threads};
///
/// let mut links = threads::links(3);
/// let mut others = links.split_off(1);
/// links[0].channel.tell(b"advance")?;
/// for other in &mut others {
///     assert_eq!(other.channel.listen()?, b"advance");
///     other.channel.answer(b"done")?;
/// }
/// assert_eq!(links[0].channel.collect()?, [b"done", b"done"]);
/// // Whoever waits for a rank that is gone is told.
/// drop(others.pop());
/// others[0].channel.answer(b"done")?;
/// assert_eq!(links[0].channel.collect(), Err("rank 2 has ended".to_owned()));
/// # Ok::<(), String>(())
/// ```
#[must_use]
pub fn links(count: u32) -> Vec<Links> {
    links_with(count, PATIENCE)
}

/// The same with another time until a rank counts as lost.
#[must_use]
pub(crate) fn links_with(count: u32, patience: Duration) -> Vec<Links> {
    let channels = Lines::among(count, patience).into_iter().map(|lines| Threads { lines, ranks: Vec::new() });
    let peers = Lines::among(count, patience).into_iter().map(Peers);
    channels.zip(peers).map(|(channel, peers)| Links { channel, peers }).collect()
}

impl Channel for Threads {
    fn count(&self) -> u32 {
        self.lines.to.len() as u32
    }

    fn tell(&mut self, message: &[u8]) -> Result<(), String> {
        (1..self.count()).try_for_each(|rank| self.lines.say(rank, message))
    }

    fn keep_alive(&self) {}

    fn listen(&mut self) -> Result<Vec<u8>, String> {
        // The first rank may compute, write and draw as long as it likes: it cannot stop alone, and its end is told at once.
        self.lines.from.first().and_then(|from| from.recv().ok()).ok_or_else(|| "rank 0 has ended".to_owned())
    }

    fn answer(&mut self, message: &[u8]) -> Result<(), String> {
        self.lines.say(0, message)
    }

    fn collect(&mut self) -> Result<Vec<Vec<u8>>, String> {
        (1..self.count()).map(|rank| self.lines.hear(rank)).collect()
    }
}

impl Swap for Peers {
    fn swap(&mut self, _: &Part, peers: &[u32], outgoing: &[&[u8]]) -> Result<Vec<Vec<u8>>, String> {
        peers.iter().zip(outgoing).try_for_each(|(peer, parcel)| self.0.say(*peer, parcel))?;
        peers.iter().map(|peer| self.0.hear(*peer)).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::sync::Arc;
    use std::sync::atomic::{AtomicBool, Ordering};

    /// What a thread does after its rank has been told to end is done when the first rank is gone.
    #[test]
    fn the_first_rank_ends_after_the_others() {
        let mut links = links(2);
        let second = links.remove(1);
        let is_done = Arc::new(AtomicBool::new(false));
        let done = Arc::clone(&is_done);
        links[0].channel.keep(vec![thread::spawn(move || {
            let Links { mut channel, .. } = second;
            while channel.listen().is_ok() {}
            thread::sleep(Duration::from_millis(50));
            done.store(true, Ordering::SeqCst);
        })]);
        drop(links);
        assert!(is_done.load(Ordering::SeqCst));
    }
}
