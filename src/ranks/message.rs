//! What ranks tell each other: a line of JSON, and particles as they are stored.

use crate::engine::{EngineError, RankReport, Sample, Sampling, Traffic};
use crate::plan::Failure;
use serde::{Deserialize, Serialize};

/// What the first rank tells the others to do.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub(super) enum Command {
    /// Take the particles that follow, and wait for more.
    Take,
    /// Begin at a step, with the particles that were taken and those that follow.
    Upload { step: u64 },
    /// Advance, in submissions of so many steps.
    Advance { steps: u64, batch: u64 },
    /// Take the samples of the step.
    Finish,
    /// Wait until the device has taken all steps.
    Wait,
    /// Take samples of the step by these samplers, due or not.
    Measure { samplers: Vec<usize> },
    /// Go on by the numbers of this scene, in JSON; one word says whether they are all that differs.
    Renumber { scene: String },
    /// Give the particles to go on from; of all those with the smallest numbers, and what else belongs to the state.
    State,
    /// The same of a report.
    Report,
    /// The same of a sample of them.
    Show { sample: Sampling },
    /// Give the momenta of the report.
    Momenta,
    /// Give those with the next numbers.
    Next,
    /// Nothing more is to be done.
    End,
}

/// What a rank answers.
#[derive(Debug, Clone, Default, PartialEq, Eq, Serialize, Deserialize)]
pub(super) struct Answer {
    /// Rows of sums.
    pub samples: Vec<Sample>,
    /// What went wrong, if anything.
    pub problem: Option<Problem>,
    /// The sum of its exchanges until now.
    pub traffic: Traffic,
    /// Who it is, at the beginning.
    pub introduction: Option<RankReport>,
}

/// What went wrong on a rank.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub(super) enum Problem {
    /// The run became unstable.
    Unstable { step: u64, bits: u32, place: u32 },
    /// Too many particles in one place.
    Crowded { step: u64 },
    /// A bond reaches beyond the halo.
    Overreached { step: u64 },
    /// The adapter left a loop.
    GaveUp { step: u64, adapter: String },
    /// Another rank is lost: whatever ended that is the cause.
    Alone { reason: String },
    /// Anything else.
    Other { reason: String },
}

impl Problem {
    pub(super) fn of(error: &EngineError) -> Self {
        match error {
            EngineError::Unstable(Failure { step, bits, place }) => {
                Self::Unstable { step: *step, bits: *bits, place: *place }
            }
            EngineError::Crowded { step } => Self::Crowded { step: *step },
            EngineError::Overreached { step } => Self::Overreached { step: *step },
            EngineError::GaveUp { step, adapter } => Self::GaveUp { step: *step, adapter: adapter.clone() },
            EngineError::Ranks { reason } => Self::Alone { reason: reason.clone() },
            error => Self::Other { reason: error.to_string() },
        }
    }

    /// What is told of the problems of all ranks that have one: what came first, with all that came at the same step; and what is not the
    /// consequence of something else.
    pub(super) fn first(problems: &[(u32, Self)]) -> Option<EngineError> {
        let other = problems.iter().find(|(_, problem)| matches!(problem, Self::Other { .. }));
        if let Some((rank, Self::Other { reason })) = other {
            return Some(EngineError::Ranks { reason: format!("rank {rank}: {reason}") });
        }
        let step = |problem: &Self| match problem {
            Self::Unstable { step, .. }
            | Self::Crowded { step }
            | Self::Overreached { step }
            | Self::GaveUp { step, .. } => Some(*step),
            _ => None,
        };
        let Some(first) = problems.iter().filter_map(|(_, problem)| step(problem)).min() else {
            let (rank, problem) = problems.first()?;
            let Self::Alone { reason } = problem else { return None };
            return Some(EngineError::Ranks { reason: format!("rank {rank}: {reason}") });
        };
        let mut failure = Failure { step: first, bits: 0, place: u32::MAX };
        for (_, problem) in problems.iter().filter(|(_, problem)| step(problem) == Some(first)) {
            match problem {
                Self::Crowded { step } => return Some(EngineError::Crowded { step: *step }),
                Self::Overreached { step } => return Some(EngineError::Overreached { step: *step }),
                Self::GaveUp { step, adapter } => {
                    return Some(EngineError::GaveUp { step: *step, adapter: adapter.clone() });
                }
                Self::Unstable { bits, place, .. } => {
                    failure.bits |= bits;
                    failure.place = failure.place.min(*place);
                }
                Self::Alone { .. } | Self::Other { .. } => {}
            }
        }
        Some(EngineError::Unstable(failure))
    }
}

/// Words of each array of a state, as a plan has them in buffers.
pub(super) type Contents = Vec<Vec<u32>>;

/// A line, that with the lengths of the arrays that follow, and these.
pub(super) fn written(head: &impl Serialize, contents: &[Vec<u32>]) -> Result<Vec<u8>, String> {
    let lengths: Vec<usize> = contents.iter().map(Vec::len).collect();
    let head = serde_json::to_string(&(head, lengths)).map_err(|error| error.to_string())?;
    let mut bytes = head.into_bytes();
    bytes.push(b'\n');
    for words in contents {
        bytes.extend_from_slice(bytemuck::cast_slice(words));
    }
    Ok(bytes)
}

/// What [`written`] has written.
pub(super) fn read<Head: for<'de> Deserialize<'de>>(bytes: &[u8]) -> Result<(Head, Contents), String> {
    let garbled = || "a message between ranks is garbled".to_owned();
    let end = bytes.iter().position(|byte| *byte == b'\n').ok_or_else(garbled)?;
    let (head, lengths): (Head, Vec<usize>) = serde_json::from_slice(&bytes[..end]).map_err(|_| garbled())?;
    let mut left = &bytes[end + 1..];
    let mut contents = Vec::with_capacity(lengths.len());
    for length in lengths {
        let (words, rest) =
            length.checked_mul(4).and_then(|length| left.split_at_checked(length)).ok_or_else(garbled)?;
        contents.push(bytemuck::pod_collect_to_vec(words));
        left = rest;
    }
    if left.is_empty() { Ok((head, contents)) } else { Err(garbled()) }
}

/// Adds what another rank has of the arrays of a state: particles follow those that are there, and of all others the 64-bit sums are
/// added; a rank gives nothing of an array that all have whole.
pub(super) fn join(contents: &mut Contents, other: Contents) {
    for (number, words) in other.into_iter().enumerate() {
        match contents.get_mut(number) {
            None => contents.push(words),
            Some(there) if number == 0 => there.extend(words),
            Some(there) => {
                for (sum, more) in there.chunks_exact_mut(2).zip(words.chunks_exact(2)) {
                    let value = |words: &[u32]| u64::from(words[1]) << 32 | u64::from(words[0]);
                    let total = value(sum).wrapping_add(value(more));
                    sum.copy_from_slice(&[total as u32, (total >> 32) as u32]);
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    #[test]
    fn messages_come_back_as_they_were() {
        let sample = Sample { sampler: 1, step: u64::MAX, sums: vec![i64::MIN, 3] };
        let answer = Answer { samples: vec![sample], ..Answer::default() };
        let contents = vec![vec![0, u32::from(b'\n'), u32::MAX], Vec::new(), vec![7]];
        let bytes = written(&answer, &contents).unwrap();
        assert_eq!(read::<Answer>(&bytes).unwrap(), (answer, contents));
        assert!(read::<Answer>(&bytes[..bytes.len() - 1]).is_err() && read::<Command>(&bytes).is_err());
    }

    #[test]
    fn particles_are_lined_up_and_sums_added() {
        let mut contents = vec![vec![1, 2], vec![u32::MAX, 0, u32::MAX, u32::MAX]];
        join(&mut contents, vec![vec![3], vec![1, 0, 2, 0]]);
        assert_eq!(contents, [vec![1, 2, 3], vec![0, 1, 1, 0]]);
    }

    #[test]
    fn what_came_first_is_told() {
        let unstable = |step, bits, place| Problem::Unstable { step, bits, place };
        let told = |problems: &[Problem]| {
            let problems: Vec<(u32, Problem)> = (0..).zip(problems.iter().cloned()).collect();
            Problem::first(&problems).unwrap().to_string()
        };
        let alone = Problem::Alone { reason: "rank 2 has ended".to_owned() };
        let lost = Problem::Other { reason: "the adapter is lost".to_owned() };
        assert!(told(&[unstable(7, 1, 9), unstable(5, 2, 4), unstable(9, 4, 1)]).ends_with("at step 5"));
        assert!(told(&[unstable(5, 1, 9), Problem::Crowded { step: 5 }]).contains("capacity"));
        assert!(told(&[unstable(5, 1, 9), Problem::Overreached { step: 5 }]).contains("bond"));
        assert!(told(&[unstable(4, 1, 9), Problem::Overreached { step: 5 }]).ends_with("at step 4"));
        assert_eq!(told(&[alone.clone(), lost]), "rank 1: the adapter is lost");
        assert_eq!(told(&[alone]), "rank 0: rank 2 has ended");
        assert!(Problem::first(&[]).is_none());
        let problems = [(0, unstable(5, 2, 9)), (1, unstable(5, 1, 4))];
        let first = Problem::first(&problems);
        assert!(matches!(first, Some(EngineError::Unstable(Failure { step: 5, bits: 3, place: 4 }))));
    }
}
