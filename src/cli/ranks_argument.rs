//! The argument that says how many ranks share a run.

use mesoscope::families::Checked;
use mesoscope::gpu::adapters_by_turns;
use mesoscope::plan::Division;
use mesoscope::ranks::sharing;
use mesoscope::run::{self, Ranks, RunError};
use mesoscope::scene::SceneError;

use super::{AdapterArgument, Failure, SceneArguments, heading};

/// How many ranks, and on which adapter.
#[derive(Debug, clap::Args)]
pub struct RanksArgument {
    #[command(flatten)]
    pub adapter: AdapterArgument,

    /// Share the run among this many ranks, each with an adapter of its own, which divide the box; results are those of one, to the last
    /// bit. `1,2,2` says how many along each axis, `auto` takes one for each adapter that is as good as the best [default: 1]
    #[arg(long, help_heading = heading::SEVERAL, value_name = "N", value_parser = asked, allow_negative_numbers = true)]
    ranks: Option<Asked>,

    /// Let ranks compute differently, as adapters of several kinds do: momentum is conserved to rounding only
    #[arg(long, help_heading = heading::SEVERAL)]
    pub mixed: bool,
}

/// What was asked for.
#[derive(Debug, Clone, PartialEq, Eq)]
enum Asked {
    Auto,
    Count(u32),
    Along(Vec<u32>),
}

fn asked(text: &str) -> Result<Asked, String> {
    if text == "auto" {
        return Ok(Asked::Auto);
    }
    let numbers = text.split(',').map(|number| number.trim().parse().ok().filter(|number| *number > 0));
    match numbers.collect::<Option<Vec<u32>>>().as_deref() {
        Some([count]) => Ok(Asked::Count(*count)),
        Some(along) if along.len() <= 3 => Ok(Asked::Along(along.to_vec())),
        _ => Err("accepted: `auto`, a whole number from 1 on, or one for each axis of the box, as `1,2,2`".to_owned()),
    }
}

impl RanksArgument {
    /// The division of the box of a run; none for one rank.
    pub fn division(&self, scene: &Checked, copies: Option<u32>) -> Result<Option<Division>, Failure> {
        let ranks = match &self.ranks {
            None if copies.is_none() => return Ok(None),
            None | Some(Asked::Auto) => {
                Ranks::Count(copies.unwrap_or_else(|| adapters_by_turns(&self.adapter.choice())))
            }
            Some(Asked::Count(count)) => Ranks::Count(*count),
            Some(Asked::Along(along)) => {
                let dimension = scene.space.lengths.len();
                let mut parts = [1; 3];
                if along.len() != dimension {
                    let text = along.iter().map(u32::to_string).collect::<Vec<_>>().join(",");
                    return Err(Failure::usage(format!(
                        "`--ranks {text}` has {} numbers, where the box has {dimension} axes",
                        along.len()
                    )));
                }
                parts[..dimension].copy_from_slice(along);
                Ranks::Parts(parts)
            }
        };
        let division = run::divide(scene, ranks)?;
        if let Some(copies) = copies.filter(|copies| *copies != division.ranks()) {
            return Err(Failure::usage(format!(
                "`--ranks` asks for {} ranks, and the launcher has started {copies} copies of the program",
                division.ranks()
            )));
        }
        Ok((division.ranks() > 1).then_some(division))
    }

    /// What ranks of this machine cost each other, if they do; processes tell where they are once they share the run.
    pub fn warning(&self, division: Option<Division>, copies: Option<u32>) -> Option<String> {
        let division = division.filter(|_| copies.is_none())?;
        sharing(division.ranks(), adapters_by_turns(&self.adapter.choice()), "this machine")
    }

    /// Loads a scene; one that the adapter cannot hold is refused before its particles are read or placed.
    pub fn load(&self, scene: &SceneArguments, copies: Option<u32>) -> Result<Checked, SceneError> {
        scene.load(&|scene| {
            // Whatever else is wrong is said of the whole scene.
            let Ok(division) = self.division(scene, copies) else { return Ok(()) };
            match run::adapter_for_rank(scene, division, &self.adapter.choice()) {
                Err(error @ (RunError::TooLarge { .. } | RunError::Memory { .. })) => {
                    Err(SceneError::TooManyParticles { reason: error.to_string() })
                }
                _ => Ok(()),
            }
        })
    }
}

#[cfg(test)]
mod tests {
    use super::{Asked, asked};

    #[test]
    fn ranks_are_a_number_or_one_for_each_axis() {
        assert_eq!(asked("auto"), Ok(Asked::Auto));
        assert_eq!(asked("8"), Ok(Asked::Count(8)));
        assert_eq!(asked("1,2,2"), Ok(Asked::Along(vec![1, 2, 2])));
        for wrong in ["0", "-1", "a,b", "1,2,3,4,5", "2,0", "", "1.5"] {
            assert!(asked(wrong).is_err(), "{wrong}");
        }
    }
}
