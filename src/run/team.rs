//! Runs on several ranks that are threads of this process.

use super::RunError;
use super::adapter::{open_adapter, plan_for};
use crate::engine::{Engine, EngineError};
use crate::families::Model;
use crate::gpu::{AdapterChoice, Gpu};
use crate::plan::{Division, Options, Part};
use crate::ranks::{Team, decline, serve, threads};
use crate::scene::Scene;
use crate::state::State;
use std::thread;

/// Opens the other ranks of a run, of which this adapter's is the first, and gives all of them their part of a state.
///
/// ```
/// use mesoscope::engine::{Engine, Stepper};
/// use mesoscope::gpu::AdapterChoice;
/// use mesoscope::plan::{Division, Options};
/// use mesoscope::{families, run, scene};
///
/// let changes = ["space.box=[3,3,12]", "output={}"].map(str::to_owned);
/// let scene = scene::load("dpd-fluid", &changes)?;
/// let model = families::Model::new(&scene);
/// let start = families::initial_state(&scene, &model);
/// let gpu = run::adapter_for(&scene, &AdapterChoice::Best)?;
/// let options = Options::default();
///
/// // Two ranks, one after the other along z, do what one does, to the last bit.
/// let division = Division { parts: [1, 1, 2] };
/// let mut team = run::team((&scene, &model), &gpu, &AdapterChoice::Best, division, options, &start)?;
/// team.advance(20, 20)?;
/// let mut alone = Engine::new(&gpu, run::plan(&model, 0, &scene.output, (&gpu).into(), options), &start)?;
/// alone.advance(20, 20)?;
/// assert_eq!(team.state()?, alone.state()?);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// [`RunError`] of the first rank that cannot be opened or does not take its part.
pub fn team<'a>(
    (scene, model): (&Scene, &Model),
    gpu: &'a Gpu,
    choice: &AdapterChoice,
    division: Division,
    options: Options,
    state: &State,
) -> Result<Team<'a>, RunError> {
    let part = |rank| Options { part: Some(Part { division, rank }), ..options };
    let mut links = threads::links(division.ranks()).into_iter();
    let Some(first) = links.next() else {
        return Err(EngineError::Ranks { reason: "a run needs at least one rank".to_owned() }.into());
    };
    for (rank, links) in (1..).zip(links) {
        let (scene, model, choice) = (scene.clone(), model.clone(), choice.of_rank(rank as usize));
        let options = part(rank);
        thread::spawn(move || {
            let threads::Links { mut channel, peers } = links;
            let opened = open_adapter(&scene, &model, &choice, options);
            let served = opened.map_err(|error| error.to_string()).and_then(|(gpu, plan)| {
                let engine = Engine::of_part(&gpu, plan, Box::new(peers));
                let mut engine = engine.map_err(|error| error.to_string())?;
                // Whoever is left alone ends; the first rank is told, or is gone.
                let _ = serve(&mut engine, &mut channel);
                Ok(())
            });
            if let Err(reason) = served {
                let _ = decline(&mut channel, reason);
            }
        });
    }
    let engine = Engine::of_part(gpu, plan_for(scene, model, gpu, part(0)), Box::new(first.peers))?;
    Ok(Team::new(engine, Box::new(first.channel), state)?)
}
