//! Ranks that are threads of one process, each with an adapter of its own.

use super::{Channel, PATIENCE};
use crate::engine::Swap;
use crate::plan::Part;
use std::sync::mpsc::{Receiver, RecvTimeoutError, Sender, channel};
use std::thread::{self, JoinHandle};
use std::time::{Duration, Instant};

/// How long the first rank waits for the threads of the others at its end.
const ENDING: Duration = Duration::from_secs(10);

/// One direction between two ranks.
type Line = (Sender<Vec<u8>>, Receiver<Vec<u8>>);

/// What a rank talks with: to the first rank, and to its peers.
pub struct Links {
    /// With the first rank; for that, with all others.
    pub channel: Threads,
    /// With all ranks.
    pub peers: Peers,
}

/// Lines between the first rank and the others.
pub struct Threads {
    count: u32,
    /// Of the first rank one to each other; of those one to the first.
    to: Vec<Sender<Vec<u8>>>,
    from: Vec<Receiver<Vec<u8>>>,
    patience: Duration,
    /// Of the first rank the threads of the others.
    ranks: Vec<JoinHandle<()>>,
}

impl Threads {
    /// Takes the threads of the other ranks, to wait for them at the end: they unload drivers, and a process that ends meanwhile crashes.
    pub fn keep(&mut self, ranks: Vec<JoinHandle<()>>) {
        self.ranks = ranks;
    }
}

impl Drop for Threads {
    fn drop(&mut self) {
        // Who listens to this rank, or answers it, ends.
        self.to.clear();
        self.from.clear();
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
pub struct Peers {
    to: Vec<Sender<Vec<u8>>>,
    from: Vec<Receiver<Vec<u8>>>,
    patience: Duration,
}

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
pub fn links_with(count: u32, patience: Duration) -> Vec<Links> {
    let lines = |number: u32| -> Vec<Line> { (0..number).map(|_| channel()).collect() };
    let others = count.saturating_sub(1);
    let (commands, commanded): (Vec<_>, Vec<_>) = lines(others).into_iter().unzip();
    let (answering, answers): (Vec<_>, Vec<_>) = lines(others).into_iter().unzip();
    let first = Threads { count, to: commands, from: answers, patience, ranks: Vec::new() };
    let rest = answering.into_iter().zip(commanded);
    let rest = rest.map(|(to, from)| Threads { count, to: vec![to], from: vec![from], patience, ranks: Vec::new() });
    // The lines to rank 0, to rank 1, …: row by row from rank 0, from rank 1, ….
    let mut to: Vec<Vec<Sender<Vec<u8>>>> = (0..count).map(|_| Vec::new()).collect();
    let mut from: Vec<Vec<Receiver<Vec<u8>>>> = (0..count).map(|_| Vec::new()).collect();
    for receivers in &mut from {
        for senders in &mut to {
            let (sender, receiver) = channel();
            senders.push(sender);
            receivers.push(receiver);
        }
    }
    let peers = to.into_iter().zip(from).map(|(to, from)| Peers { to, from, patience });
    std::iter::once(first).chain(rest).zip(peers).map(|(channel, peers)| Links { channel, peers }).collect()
}

/// What another rank says.
fn heard(from: Option<&Receiver<Vec<u8>>>, rank: u32, patience: Duration) -> Result<Vec<u8>, String> {
    let from = from.ok_or_else(|| format!("there is no rank {rank}"))?;
    from.recv_timeout(patience).map_err(|error| match error {
        RecvTimeoutError::Timeout => format!("rank {rank} has not answered for {} s", patience.as_secs()),
        RecvTimeoutError::Disconnected => format!("rank {rank} has ended"),
    })
}

fn said(to: Option<&Sender<Vec<u8>>>, rank: u32, message: &[u8]) -> Result<(), String> {
    let to = to.ok_or_else(|| format!("there is no rank {rank}"))?;
    to.send(message.to_vec()).map_err(|_| format!("rank {rank} has ended"))
}

impl Channel for Threads {
    fn count(&self) -> u32 {
        self.count
    }

    fn tell(&mut self, message: &[u8]) -> Result<(), String> {
        self.to.iter().zip(1..).try_for_each(|(to, rank)| said(Some(to), rank, message))
    }

    fn keep_alive(&self) {}

    fn listen(&mut self) -> Result<Vec<u8>, String> {
        // The first rank may compute, write and draw as long as it likes: it cannot stop alone, and its end is told at once.
        self.from.first().and_then(|from| from.recv().ok()).ok_or_else(|| "rank 0 has ended".to_owned())
    }

    fn answer(&mut self, message: &[u8]) -> Result<(), String> {
        said(self.to.first(), 0, message)
    }

    fn collect(&mut self) -> Result<Vec<Vec<u8>>, String> {
        self.from.iter().zip(1..).map(|(from, rank)| heard(Some(from), rank, self.patience)).collect()
    }
}

impl Swap for Peers {
    fn swap(&mut self, _: &Part, peers: &[u32], outgoing: &[&[u8]]) -> Result<Vec<Vec<u8>>, String> {
        for (peer, parcel) in peers.iter().zip(outgoing) {
            said(self.to.get(*peer as usize), *peer, parcel)?;
        }
        peers.iter().map(|peer| heard(self.from.get(*peer as usize), *peer, self.patience)).collect()
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
