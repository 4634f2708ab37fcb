//! Which of several copies of the program this one is: what launchers of MPI and batch systems say in environment variables.

use mesoscope::study::Shard;

use super::Failure;

/// What reads a variable.
type Variables<'v> = &'v dyn Fn(&str) -> Option<String>;

/// What starts copies of a program at the same time.
struct Launcher {
    /// The number of a copy, from zero.
    rank: &'static str,
    /// The number of copies.
    size: &'static str,
    /// The number of a copy among those on its machine, from zero.
    local: &'static [&'static str],
    /// The number of copies on its machine.
    on_machine: &'static [&'static str],
}

/// The one that is nearest to the program comes first: `mpirun` within a job of Slurm leaves Slurm's variables as they are.
const LAUNCHERS: [Launcher; 4] = [
    Launcher {
        rank: "OMPI_COMM_WORLD_RANK",
        size: "OMPI_COMM_WORLD_SIZE",
        local: &["OMPI_COMM_WORLD_LOCAL_RANK"],
        on_machine: &["OMPI_COMM_WORLD_LOCAL_SIZE"],
    },
    Launcher {
        rank: "MV2_COMM_WORLD_RANK",
        size: "MV2_COMM_WORLD_SIZE",
        local: &["MV2_COMM_WORLD_LOCAL_RANK"],
        on_machine: &["MV2_COMM_WORLD_LOCAL_SIZE"],
    },
    // MPICH, Intel MPI, Cray.
    Launcher {
        rank: "PMI_RANK",
        size: "PMI_SIZE",
        local: &["MPI_LOCALRANKID", "PALS_LOCAL_RANKID"],
        on_machine: &["MPI_LOCALNRANKS", "PALS_LOCAL_SIZE"],
    },
    // Of `srun`. In the script of a job SLURM_NTASKS says how many copies a job may start, and one copy runs.
    Launcher {
        rank: "SLURM_PROCID",
        size: "SLURM_STEP_NUM_TASKS",
        local: &["SLURM_LOCALID"],
        on_machine: &["SLURM_NTASKS_PER_NODE"],
    },
];

/// What starts jobs that differ in a number.
struct Array {
    index: &'static str,
    first: &'static str,
    last: &'static str,
    step: &'static str,
    count: &'static str,
}

const ARRAYS: [Array; 2] = [
    Array {
        index: "SLURM_ARRAY_TASK_ID",
        first: "SLURM_ARRAY_TASK_MIN",
        last: "SLURM_ARRAY_TASK_MAX",
        step: "SLURM_ARRAY_TASK_STEP",
        count: "SLURM_ARRAY_TASK_COUNT",
    },
    // Grid Engine, which does not say how many there are.
    Array {
        index: "SGE_TASK_ID",
        first: "SGE_TASK_FIRST",
        last: "SGE_TASK_LAST",
        step: "SGE_TASK_STEPSIZE",
        count: "",
    },
];

/// Variables that say which copy this is, and nothing says of how many.
const WITHOUT_COUNT: [&str; 4] = ["PBS_ARRAY_INDEX", "PBS_ARRAYID", "LSB_JOBINDEX", "PMIX_RANK"];

fn number(variables: Variables<'_>, name: &str) -> Option<u64> {
    variables(name)?.trim().parse().ok()
}

/// The launcher that started this copy, with its rank and the number of copies.
fn launcher(variables: Variables<'_>) -> Option<(&'static Launcher, u64, u64)> {
    LAUNCHERS.iter().find_map(|launcher| {
        let (rank, size) = (number(variables, launcher.rank)?, number(variables, launcher.size)?);
        Some((launcher, rank, size))
    })
}

/// The place of this job in its array, from zero, and the number of jobs.
fn place_in_array(array: &Array, variables: Variables<'_>) -> Result<Option<(u64, u64)>, String> {
    // Outside of arrays Grid Engine says "undefined".
    let Some(index) = number(variables, array.index) else { return Ok(None) };
    let first = number(variables, array.first);
    let step = number(variables, array.step).unwrap_or(1).max(1);
    let of_range = || Some((number(variables, array.last)?.checked_sub(first?)?) / step + 1);
    let count = number(variables, array.count).or_else(of_range);
    let (Some(first), Some(count)) = (first, count) else {
        return Err(format!("`{}` is set, but not what says of how many: give `--shard 3/16`", array.index));
    };
    let place = index.checked_sub(first).filter(|above| above % step == 0).map(|above| above / step);
    match place.filter(|place| *place < count && of_range().is_none_or(|range| range == count)) {
        Some(place) => Ok(Some((place, count))),
        None => Err(format!(
            "the numbers of this array have gaps ({} is {index}, of {count} from {first} on): give `--shard 3/16`",
            array.index
        )),
    }
}

/// The shard of this copy: the place of its job in an array, times its place among the copies that a launcher started in the job.
fn shard_of(variables: Variables<'_>) -> Result<Shard, String> {
    let mut found = ARRAYS.iter().find_map(|array| place_in_array(array, variables).transpose()).transpose()?;
    if let Some((_, rank, size)) = launcher(variables) {
        let (place, count) = found.unwrap_or((0, 1));
        found = place.checked_mul(size).and_then(|place| Some((place.checked_add(rank)?, count.checked_mul(size)?)));
    }
    if let Some((place, count)) = found {
        let shard = place.checked_add(1).and_then(|number| Shard::new(number, count));
        return shard.ok_or_else(|| format!("the environment says copy {place} of {count}: give `--shard 3/16`"));
    }
    if let Some(name) = WITHOUT_COUNT.into_iter().find(|name| number(variables, name).is_some()) {
        return Err(format!(
            "`{name}` says which copy this is, and nothing says of how many: give `--shard ${name}/16` for shards from 1 to 16"
        ));
    }
    let ranks = LAUNCHERS.iter().map(|launcher| launcher.rank);
    let names: Vec<&str> = ARRAYS.iter().map(|array| array.index).chain(ranks).collect();
    Err(format!("nothing says which shard this is: none of {} is set; give `--shard 3/16`", names.join(", ")))
}

/// The variable that says how many copies a launcher started, where these are several.
fn copies(variables: Variables<'_>) -> Option<(&'static str, String)> {
    match launcher(variables) {
        Some((launcher, _, size)) => (size > 1).then(|| (launcher.size, size.to_string())),
        // Started by a launcher that does not say how many there are: others than the first are not alone.
        None => number(variables, "PMIX_RANK").filter(|rank| *rank > 0).map(|rank| ("PMIX_RANK", rank.to_string())),
    }
}

fn environment(name: &str) -> Option<String> {
    std::env::var(name).ok()
}

/// The shard that the environment says.
pub fn shard() -> Result<Shard, Failure> {
    shard_of(&environment).map_err(|problem| Failure::usage(format!("`--shard auto`: {problem}")))
}

/// The number in the first of the variables that the launcher of this copy has for it.
fn number_of_machine(variables: impl Fn(&Launcher) -> &[&str]) -> Option<usize> {
    let (launcher, ..) = launcher(&environment)?;
    let found = variables(launcher).iter().find_map(|name| number(&environment, name));
    found.and_then(|number| usize::try_from(number).ok())
}

/// The number of this copy among those on its machine, from zero, where a launcher says it.
pub fn local_rank() -> Option<usize> {
    number_of_machine(|launcher| launcher.local)
}

/// The number of copies on this machine, where a launcher says it; else one.
pub fn local_copies() -> usize {
    number_of_machine(|launcher| launcher.on_machine).unwrap_or(1).max(1)
}

/// Whether a launcher started this copy and others.
#[cfg(feature = "mpi")]
pub fn is_copy() -> bool {
    copies(&environment).is_some()
}

/// Refuses to be one of several copies that all would write the same files.
pub fn refuse_copies() -> Result<(), Failure> {
    match copies(&environment) {
        None => Ok(()),
        Some((name, value)) => Err(Failure::usage(format!(
            "this is one of several copies that a launcher started (`{name}` is {value}), and {}: \
             they would write over each other's files\n\
             hint: start one copy; or let each run variants of its own, with `mesoscope sweep … --shard auto`; \
             where each has a directory of its own, unset `{name}`",
            if cfg!(feature = "mpi") {
                "this command does not share its work"
            } else {
                "the program was built without MPI"
            }
        ))),
    }
}

#[cfg(test)]
mod tests {
    use super::{copies, shard_of};

    /// The shard of these variables, or a part of the message.
    fn shard(set: &[(&str, &str)]) -> Result<String, String> {
        let variables = |name: &str| set.iter().find(|(known, _)| *known == name).map(|(_, value)| (*value).to_owned());
        shard_of(&variables).map(|shard| shard.to_string())
    }

    fn several(set: &[(&str, &str)]) -> Option<&'static str> {
        let variables = |name: &str| set.iter().find(|(known, _)| *known == name).map(|(_, value)| (*value).to_owned());
        copies(&variables).map(|(name, _)| name)
    }

    fn slurm<'v>(id: &'v str, [min, max, step, count]: [&'v str; 4]) -> [(&'static str, &'v str); 5] {
        [
            ("SLURM_ARRAY_TASK_ID", id),
            ("SLURM_ARRAY_TASK_MIN", min),
            ("SLURM_ARRAY_TASK_MAX", max),
            ("SLURM_ARRAY_TASK_STEP", step),
            ("SLURM_ARRAY_TASK_COUNT", count),
        ]
    }

    #[test]
    fn arrays_say_which_shard() {
        for (id, rest, expected) in [
            ("1", ["1", "16", "1", "16"], "1/16"),
            ("16", ["1", "16", "1", "16"], "16/16"),
            ("0", ["0", "15", "1", "16"], "1/16"),
            ("15", ["0", "15", "1", "16"], "16/16"),
            ("9", ["1", "13", "4", "4"], "3/4"),
            ("7", ["7", "7", "1", "1"], "1/1"),
        ] {
            assert_eq!(shard(&slurm(id, rest)).as_deref(), Ok(expected), "{id} {rest:?}");
        }
        // Of those without the largest number, and without the step, the count tells.
        let few = [("SLURM_ARRAY_TASK_ID", "3"), ("SLURM_ARRAY_TASK_MIN", "1"), ("SLURM_ARRAY_TASK_COUNT", "4")];
        assert_eq!(shard(&few).as_deref(), Ok("3/4"));
        let engine =
            [("SGE_TASK_ID", "5"), ("SGE_TASK_FIRST", "1"), ("SGE_TASK_LAST", "7"), ("SGE_TASK_STEPSIZE", "2")];
        assert_eq!(shard(&engine).as_deref(), Ok("3/4"));
        for (id, rest) in [
            ("5", ["1", "7", "1", "3"]),
            ("1", ["1", "7", "1", "3"]),
            ("4", ["1", "7", "2", "4"]),
            ("0", ["1", "4", "1", "4"]),
        ] {
            let message = shard(&slurm(id, rest)).err().unwrap_or_default();
            assert!(message.contains("have gaps"), "{id} {rest:?}: {message}");
        }
        let message = shard(&[("SLURM_ARRAY_TASK_ID", "3")]).err().unwrap_or_default();
        assert!(message.contains("not what says of how many"), "{message}");
    }

    #[test]
    fn launchers_say_which_shard() {
        for (rank, size) in [
            ("OMPI_COMM_WORLD_RANK", "OMPI_COMM_WORLD_SIZE"),
            ("MV2_COMM_WORLD_RANK", "MV2_COMM_WORLD_SIZE"),
            ("PMI_RANK", "PMI_SIZE"),
            ("SLURM_PROCID", "SLURM_STEP_NUM_TASKS"),
        ] {
            assert_eq!(shard(&[(rank, "2"), (size, "4")]).as_deref(), Ok("3/4"));
            assert!(shard(&[(rank, "4"), (size, "4")]).is_err(), "{rank}");
            assert_eq!(several(&[(rank, "0"), (size, "4")]), Some(size));
            assert_eq!(several(&[(rank, "0"), (size, "1")]), None);
            assert_eq!(several(&[(rank, "0")]), None);
        }
        // The nearest counts, and jobs of an array divide among their copies.
        let within = [
            ("OMPI_COMM_WORLD_RANK", "1"),
            ("OMPI_COMM_WORLD_SIZE", "2"),
            ("SLURM_PROCID", "0"),
            ("SLURM_STEP_NUM_TASKS", "1"),
        ];
        assert_eq!(shard(&within).as_deref(), Ok("2/2"));
        let both = [&slurm("3", ["1", "4", "1", "4"])[..], &within].concat();
        assert_eq!(shard(&both).as_deref(), Ok("6/8"));
        // A script of a job that may start 16 copies is one copy.
        assert_eq!(several(&[("SLURM_PROCID", "0"), ("SLURM_NTASKS", "16")]), None);
        assert!(shard(&[("SLURM_PROCID", "0"), ("SLURM_NTASKS", "16")]).is_err());
        assert_eq!(several(&[("PMIX_RANK", "1")]), Some("PMIX_RANK"));
        assert_eq!(several(&[("PMIX_RANK", "0")]), None);
    }

    #[test]
    fn what_does_not_say_how_many_there_are_is_named() {
        for name in ["PBS_ARRAY_INDEX", "PBS_ARRAYID", "LSB_JOBINDEX"] {
            let message = shard(&[(name, "3")]).err().unwrap_or_default();
            assert!(message.contains(&format!("--shard ${name}/16")), "{message}");
        }
        let message = shard(&[]).err().unwrap_or_default();
        assert!(message.contains("SLURM_ARRAY_TASK_ID") && message.contains("PMI_RANK"), "{message}");
    }
}
