//! Runs on several ranks: threads of this process, or processes.

use super::RunError;
use super::adapter::{open_adapter, plan_for};
use super::division::fits;
use crate::engine::{Engine, EngineError, RankReport, Swap, Traffic};
use crate::families::{Checked, initial_state};
use crate::gpu::{AdapterChoice, Gpu, adapters_by_turns};
use crate::plan::{Division, Hardware, Options, Part};
use crate::ranks::{Channel, Processes, Team, decline, serve, threads};
use crate::scene::{self, FileStart, KeptStart, Scene};
use crate::state::State;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::sync::{Arc, Mutex, PoisonError};
use std::thread;

/// Opens the other ranks of a run, of which this adapter's is the first, and gives all of them their part of a state.
/// Ranks may compute differently until they are [checked](Team::check_alike).
///
/// ```
/// use mesoscope::engine::{Engine, Stepper};
/// use mesoscope::gpu::AdapterChoice;
/// use mesoscope::plan::{Division, Options};
/// use mesoscope::{families, run, scene};
///
/// let changes = ["space.box=[3,3,12]", "output={}"].map(str::to_owned);
/// let scene = scene::load("dpd-fluid", &changes)?;
/// let start = families::initial_state(&scene);
/// let gpu = run::adapter_for(&scene, &AdapterChoice::Best)?;
/// let options = Options::default();
///
/// // Two ranks, one after the other along z, do what one does, to the last bit.
/// let division = Division { parts: [1, 1, 2] };
/// let mut team = run::team(&scene, &gpu, &AdapterChoice::Best, division, options, &start)?;
/// team.check_alike()?;
/// team.advance(20, 20)?;
/// let mut alone = Engine::new(&gpu, run::plan(&scene, (&gpu).into(), options), &start)?;
/// alone.advance(20, 20)?;
/// assert_eq!(team.state()?, alone.state()?);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// [`RunError`] of the first rank that cannot be opened or does not take its part.
pub fn team(
    scene: &Checked,
    gpu: &Gpu,
    choice: &AdapterChoice,
    division: Division,
    options: Options,
    state: &State,
) -> Result<Team<'static>, RunError> {
    let part = |rank| Options { part: Some(Part { division, rank }), ..options };
    // Parts have to be wide enough for what their ranks have to know of each other.
    if !plan_for(scene, gpu, part(0)).part.as_ref().is_some_and(|part| fits(scene.model(), part)) {
        return Err(RunError::Undividable { reasons: vec!["its parts are too thin for this scene".to_owned()] });
    }
    let mut links = threads::links(division.ranks()).into_iter();
    let Some(mut first) = links.next() else {
        return Err(EngineError::Ranks { reason: "a run needs at least one rank".to_owned() }.into());
    };
    let mut threads = Vec::new();
    for (rank, links) in (1..).zip(links) {
        let (scene, choice) = (scene.clone(), choice.of_rank(rank as usize));
        let options = part(rank);
        threads.push(thread::spawn(move || {
            let threads::Links { mut channel, peers } = links;
            // Whoever is left alone ends; the first rank is told, or is gone.
            let _ = take_part(&scene, &choice, options, &mut channel, Box::new(peers));
        }));
    }
    first.channel.keep(threads);
    let engine = Engine::of_part(gpu, plan_for(scene, gpu, part(0)), Box::new(first.peers))?;
    Ok(Team::new(engine, introduction(gpu, scene, choice)?, Box::new(first.channel), state)?)
}

/// Opens this rank's adapter and does what the first rank tells.
fn take_part<'a>(
    scene: &Checked,
    choice: &AdapterChoice,
    options: Options,
    channel: &mut dyn Channel,
    peers: Box<dyn Swap + 'a>,
) -> Result<(), String> {
    let take_turns = || {
        let (gpu, plan) = open_adapter(scene, choice, options).map_err(|error| error.to_string())?;
        let mut engine = Engine::of_part(&gpu, plan, peers).map_err(|error| error.to_string())?;
        let introduction = introduction(&gpu, scene, choice).map_err(|error| error.to_string())?;
        let replan = |told: &str| {
            let mut changed: Scene = serde_json::from_str(told).map_err(|error| error.to_string())?;
            changed.kept = scene.kept.clone();
            Ok(plan_for(&Checked::presumed(changed), &gpu, options))
        };
        Ok(serve(&mut engine, introduction, channel, &replan))
    };
    take_turns().unwrap_or_else(|reason| decline(channel, reason))
}

/// Particles and steps of the scene from which ranks find out whether they compute alike.
const SMALL: [&str; 3] = ["space.box=[5,5,5]", "time.equilibration=0", "output={}"];
const STEPS: u64 = 8;

/// A small scene of the kind of a scene; else a small fluid with its integrator and noise.
fn small_scene(scene: &Checked) -> Result<Checked, RunError> {
    if let Some(small) = scene.model().physics().small_scene(scene) {
        return Ok(Checked::presumed(small));
    }
    let fluid = scene::load("dpd-fluid", &SMALL.map(str::to_owned))?;
    Ok(fluid.changed(|small| {
        let integrators = scene.system.particle_integrator().zip(small.system.particle_integrator_mut());
        if let Some((own, integrator)) = integrators {
            integrator.clone_from(own);
        }
        small.noise.clone_from(&scene.noise);
    }))
}

/// Checksums of small scenes by adapter, driver, plan and scene. Ranks of a process that share an adapter compute alike: one of them finds
/// out for all, whose devices would each compile the kernels of it.
static CHECKSUMS: Mutex<BTreeMap<String, Arc<Mutex<Option<u32>>>>> = Mutex::new(BTreeMap::new());

/// A checksum of the state that an adapter comes to after a few steps of a small scene.
fn arithmetic(gpu: &Gpu, scene: &Checked) -> Result<u32, RunError> {
    let small = small_scene(scene)?;
    if gpu.is_rewriting() {
        return checksum(gpu, &small);
    }
    let text = serde_json::to_string(&small).map_err(|error| lost(error.to_string()))?;
    let key = format!("{:?} {:?} {text}", gpu.description(), Hardware::from(gpu));
    let place = Arc::clone(CHECKSUMS.lock().unwrap_or_else(PoisonError::into_inner).entry(key).or_default());
    let mut known = place.lock().unwrap_or_else(PoisonError::into_inner);
    if let Some(known) = *known {
        return Ok(known);
    }
    let found = checksum(gpu, &small)?;
    *known = Some(found);
    Ok(found)
}

fn checksum(gpu: &Gpu, small: &Checked) -> Result<u32, RunError> {
    let plan = plan_for(small, gpu, Options::default()).without_reports();
    let mut engine = Engine::new(gpu, plan, &initial_state(small))?;
    engine.advance(STEPS, STEPS)?;
    let state = engine.state()?;
    let mut checksum = crc32fast::Hasher::new();
    checksum.update(bytemuck::cast_slice(&state.positions));
    checksum.update(bytemuck::cast_slice(&state.momenta));
    Ok(checksum.finalize())
}

/// This rank, with what its adapter makes of a small scene.
fn introduction(gpu: &Gpu, scene: &Checked, choice: &AdapterChoice) -> Result<RankReport, RunError> {
    let adapter = gpu.description();
    let host = std::fs::read_to_string("/proc/sys/kernel/hostname").map(|name| name.trim().to_owned());
    let host = host.or_else(|_| std::env::var("COMPUTERNAME")).unwrap_or_else(|_| "this machine".to_owned());
    let adapter = format!("{} ({})", adapter.name, adapter.driver);
    let (adapters, arithmetic) = (adapters_by_turns(choice), arithmetic(gpu, scene)?);
    Ok(RankReport { host, adapter, adapters, arithmetic, traffic: Traffic::default() })
}

/// What the first process tells the others before they become ranks.
#[derive(Debug, Serialize, Deserialize)]
enum Call {
    /// To share a run.
    Share {
        version: String,
        scene: Box<Scene>,
        /// What the scene keeps of the file that its particles are from, as bytes.
        start: Option<Vec<u8>>,
        division: [u32; 3],
        /// How often it has been repeated with more room.
        repeated: u32,
        /// How often with longer bonds.
        lengthened: u32,
    },
    /// To end.
    End,
}

const VERSION: &str = env!("CARGO_PKG_VERSION");

fn lost(reason: String) -> RunError {
    EngineError::Ranks { reason }.into()
}

fn call(processes: &dyn Processes, call: &Call) -> Result<(), RunError> {
    let message = serde_json::to_vec(call).map_err(|error| lost(error.to_string()))?;
    processes.channel().tell(&message).map_err(lost)
}

/// As [`team`], of processes.
pub(super) fn team_of_processes<'a>(
    scene: &Checked,
    gpu: &Gpu,
    choice: &AdapterChoice,
    division: Division,
    options: Options,
    state: &State,
    processes: &'a dyn Processes,
) -> Result<Team<'a>, RunError> {
    let version = VERSION.to_owned();
    let scene_told = Box::new(Scene::clone(scene));
    let (repeated, lengthened) = (options.list_growth, options.lengthened);
    let start = scene.start().map(|start| start.to_bytes());
    call(
        processes,
        &Call::Share { version, scene: scene_told, start, division: division.parts, repeated, lengthened },
    )?;
    let options = Options { part: Some(Part { division, rank: 0 }), ..options };
    let engine = Engine::of_part(gpu, plan_for(scene, gpu, options), processes.peers())?;
    Ok(Team::new(engine, introduction(gpu, scene, choice)?, processes.channel(), state)?)
}

/// Lets all other processes end.
///
/// # Errors
/// [`RunError::Engine`] if one is lost.
pub fn dismiss(processes: &dyn Processes) -> Result<(), RunError> {
    call(processes, &Call::End)
}

/// Takes part in the runs of the first process as one of its other ranks, until it is dismissed.
///
/// # Errors
/// [`RunError::Engine`] if the first process is lost.
pub fn follow(processes: &dyn Processes, rank: u32, choice: &AdapterChoice) -> Result<(), RunError> {
    loop {
        let mut channel = processes.channel();
        let message = channel.listen().map_err(lost)?;
        match serde_json::from_slice(&message).map_err(|error| lost(error.to_string()))? {
            Call::End => return Ok(()),
            Call::Share { version, .. } if version != VERSION => {
                decline(channel.as_mut(), format!("is of version {VERSION}, the first of {version}")).map_err(lost)?;
            }
            Call::Share { mut scene, start, division, repeated, lengthened, .. } => {
                let start = start.as_deref().and_then(FileStart::from_bytes).map(Arc::new);
                scene.kept = start.map(KeptStart::of).unwrap_or_default();
                let scene = Checked::presumed(*scene);
                let roomy = |options: Options, _| options.with_room(scene.model().particle_count());
                let options = (0..repeated).fold(Options::default(), roomy);
                let part = Some(Part { division: Division { parts: division }, rank });
                let options = Options { lengthened, part, ..options };
                take_part(&scene, choice, options, channel.as_mut(), processes.peers()).map_err(lost)?;
            }
        }
    }
}
