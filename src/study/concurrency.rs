//! Several runs at once, and how many.

use super::error::StudyError;
use crate::gpu::{AdapterDescription, AdapterKind};
use crate::run::Interrupt;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::mpsc;
use std::thread;

/// Operations of a step from which a single variant keeps a software adapter busy.
const LARGE: f64 = 5e7;

/// How many of `variants` to run at once on an adapter, where the user does not say; `largest` is the arithmetic of a
/// step of the largest of them: its particles times [`crate::plan::Plan::operations_per_particle`].
///
/// On lavapipe with two cores, two variants at once were done 1.5 times as fast as one after the other with shallow water of
/// 4 096 particles (median of three rounds), 1.13 with 65 536 (11 million operations) and 1.1 with 262 144 (46 million), and 1.2
/// with a DPD fluid of 3 000 (8 million; ten rounds) and 1.2 with one of 10 125 (27 million): one prepares, measures and draws
/// while the other computes. With 24 000 (64 million) and 52 728 it was 1.0, which is not worth twice the memory, and more than
/// two at once did not differ clearly from two. No GPU has been measured: there, variants run one after the other unless the
/// user says otherwise.
///
/// ```
/// use mesoscope::gpu::{AdapterDescription, AdapterKind};
/// use mesoscope::study::default_jobs;
///
/// let (name, backend, driver) = ("llvmpipe".to_owned(), "Vulkan".to_owned(), "Mesa".to_owned());
/// let adapter = AdapterDescription { name, kind: AdapterKind::Software, backend, driver };
/// assert_eq!(default_jobs(&adapter, 8e6, 8), 2);
/// assert_eq!(default_jobs(&adapter, 64e6, 8), 1);
/// ```
#[must_use]
pub fn default_jobs(adapter: &AdapterDescription, largest: f64, variants: usize) -> usize {
    let wanted = if adapter.kind == AdapterKind::Software && largest < LARGE { 2 } else { 1 };
    wanted.min(variants.max(1))
}

/// Works on items in their order, `jobs` at once, and hands what is reported of them on in this thread, with the number of the
/// item. No further items begin once `receive` fails or an interrupt is asked for; those under way may end.
///
/// # Errors
/// The first of `receive`.
pub(crate) fn at_once<T: Sync, M: Send>(
    items: &[T],
    jobs: usize,
    interrupt: &Interrupt,
    work: impl Fn(&T, &(dyn Fn(M) + Sync)) + Sync,
    mut receive: impl FnMut(usize, M) -> Result<(), StudyError>,
) -> Result<(), StudyError> {
    let next = AtomicUsize::new(0);
    // Without a queue no thread is more than one item ahead of what was received and saved.
    let (sender, receiver) = mpsc::sync_channel(0);
    let mut result = Ok(());
    thread::scope(|scope| {
        for _ in 0..jobs.min(items.len()) {
            let (sender, next, work) = (sender.clone(), &next, &work);
            scope.spawn(move || {
                while !interrupt.is_asked() {
                    let number = next.fetch_add(1, Ordering::Relaxed);
                    let Some(item) = items.get(number) else { break };
                    // If nobody listens any more, there is nobody to report to.
                    work(item, &|message| drop(sender.send((number, message))));
                }
            });
        }
        drop(sender);
        for (number, message) in receiver {
            let received = receive(number, message);
            if received.is_err() && result.is_ok() {
                next.store(items.len(), Ordering::Relaxed);
                result = received;
            }
        }
    });
    result
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn small_variants_on_the_processor_run_two_at_once() {
        let adapter =
            |kind| AdapterDescription { name: String::new(), kind, backend: String::new(), driver: String::new() };
        for (kind, largest, variants, expected) in [
            (AdapterKind::Software, 8e6, 8, 2),
            (AdapterKind::Software, 8e6, 1, 1),
            (AdapterKind::Software, 8e6, 0, 1),
            (AdapterKind::Software, 64e6, 8, 1),
            (AdapterKind::Discrete, 8e6, 8, 1),
        ] {
            assert_eq!(default_jobs(&adapter(kind), largest, variants), expected, "{kind:?} {largest} {variants}");
        }
    }

    #[test]
    fn reports_come_with_the_numbers_of_their_items_until_one_fails() {
        let (items, interrupt): (Vec<usize>, _) = ((10..20).collect(), Interrupt::default());
        let work = |item: &usize, report: &(dyn Fn(usize) + Sync)| {
            report(*item);
            report(2 * *item);
        };
        let mut seen = Vec::new();
        let ended = at_once(&items, 3, &interrupt, work, |number, reported| {
            seen.push((number, reported));
            Ok(())
        });
        seen.sort_unstable();
        let expected: Vec<(usize, usize)> =
            (0..10).flat_map(|number| [(number, 10 + number), (number, 20 + 2 * number)]).collect();
        assert!(ended.is_ok() && seen == expected, "{seen:?}");
        let failed = at_once(&items, 1, &interrupt, work, |number, _| match number {
            0 | 1 => Ok(()),
            _ => Err(StudyError::mistake(number.to_string())),
        });
        assert_eq!(failed.err().map(|error| error.to_string()), Some("2".to_owned()));
        interrupt.ask();
        let mut begun = 0;
        let ended = at_once(&items, 2, &interrupt, work, |_, _| {
            begun += 1;
            Ok(())
        });
        assert!(ended.is_ok() && begun == 0);
    }
}
