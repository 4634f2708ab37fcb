//! Simulations that several ranks share are those of one, to the bit.

use mesoscope::Simulation;
use mesoscope::run::RunError;
use mesoscope::scene::Checked;

use super::ranks::fits;
use crate::support::{COTTER_REICH, GROOT_WARREN, PREDICTED, SPLITTING, adapter, fluid, water};

const LONG: &str = "space.box=[4,4,9]";

/// A scene of each kind of step, without memory: what ranks may share.
fn scenes() -> Vec<(&'static str, Checked)> {
    vec![
        ("splitting", fluid(&[SPLITTING, LONG])),
        ("Groot and Warren", fluid(&[GROOT_WARREN, LONG])),
        ("predicted", fluid(&[PREDICTED, LONG])),
        ("Cotter and Reich", fluid(&[COTTER_REICH, LONG])),
        ("walls", fluid(&[GROOT_WARREN, LONG, r#"space.walls={"y":{"upper_velocity":[1.5,0,0]}}"#])),
        ("shear", fluid(&[SPLITTING, LONG, r#"space.shear={"rate":1.2,"gradient":"y"}"#])),
        ("announced", fluid(&[SPLITTING, LONG, r#"announced=[{"key":"interactions.0.repulsion","largest":4e3}]"#])),
        ("water", water(&[])),
    ]
}

fn shared(scene: &Checked, ranks: u32) -> Simulation {
    let simulation = Simulation::on_ranks(scene, &adapter(), ranks).unwrap();
    assert_eq!(simulation.ranks().len(), ranks as usize);
    simulation
}

/// Numbers with their names, of which none may be NaN.
fn numbers(simulation: &mut Simulation) -> Vec<(&'static str, u64)> {
    simulation.observables().unwrap().into_iter().map(|(name, value)| (name, value.to_bits())).collect()
}

fn assert_alike(one: &mut Simulation, other: &mut Simulation, name: &str) {
    let step = one.step();
    assert_eq!(other.step(), step, "{name}");
    assert_eq!(numbers(one), numbers(other), "{name} at {step}");
    let [seen, expected] = [&mut *one, &mut *other].map(|simulation| simulation.frame().unwrap());
    assert!(seen == expected, "{name} at {step}: frames differ");
    assert!(one.state().unwrap() == other.state().unwrap(), "{name} at {step}: states differ");
    assert!(one.fields().unwrap() == other.fields().unwrap(), "{name} at {step}: fields differ");
}

/// At any step, at rows of the table and between them, and from each other's checkpoints.
#[test]
fn ranks_that_are_looked_at_are_one() {
    let root = tempfile::tempdir().unwrap();
    let path = root.path().join("shared.ckpt");
    for (name, scene) in scenes() {
        if !fits(&scene) {
            continue;
        }
        let mut alone = Simulation::new(&scene, &adapter()).unwrap();
        let mut shared = shared(&scene, 2);
        for steps in [0, 4, 6, 1] {
            alone.advance(steps).unwrap();
            shared.advance(steps).unwrap();
            assert_alike(&mut shared, &mut alone, name);
        }
        assert_eq!(shared.energies(), alone.energies(), "{name}");
        shared.checkpoint(&path).unwrap();
        let mut again = Simulation::from_checkpoint(&path, &adapter()).unwrap();
        let mut divided = Simulation::from_checkpoint_on_ranks(&path, &adapter(), 2).unwrap();
        again.advance(5).unwrap();
        divided.advance(5).unwrap();
        shared.advance(5).unwrap();
        assert_alike(&mut divided, &mut again, name);
        assert_alike(&mut divided, &mut shared, name);
    }
}

/// Numbers, positions and velocities change on all ranks: the first change opens them again, the second one loads
/// numbers.
#[test]
fn ranks_change_as_one_does() {
    for (name, scene) in scenes() {
        if !fits(&scene) || name == "water" {
            continue;
        }
        let mut alone = Simulation::new(&scene, &adapter()).unwrap();
        let mut shared = shared(&scene, 2);
        let each = |both: [&mut Simulation; 2]| {
            for simulation in both {
                simulation.advance(3).unwrap();
                simulation.set("interactions.0.repulsion", 31.0).unwrap();
                simulation.advance(3).unwrap();
                simulation.set("interactions.0.repulsion", 12.5).unwrap();
                let frame = simulation.frame().unwrap();
                let backwards: Vec<[f64; 3]> =
                    frame.velocities.iter().map(|velocity| velocity.map(|component| -component)).collect();
                simulation.set_velocities(&backwards).unwrap();
                let aside: Vec<[f64; 3]> = frame.positions.iter().map(|[x, y, z]| [(*x + 1.5) % 4.0, *y, *z]).collect();
                simulation.set_positions(&aside).unwrap();
                simulation.advance(4).unwrap();
            }
        };
        each([&mut alone, &mut shared]);
        assert_alike(&mut shared, &mut alone, name);
        assert_eq!(shared.changes(), alone.changes(), "{name}");
        let openings = if shared.scene().announced.is_empty() { 2 } else { 1 };
        assert_eq!([shared.openings(), alone.openings()], [openings; 2], "{name}");
    }
}

#[test]
fn what_ranks_cannot_share_is_refused() {
    let refusal = |scene: &Checked, ranks| match Simulation::on_ranks(scene, &adapter(), ranks) {
        Err(error @ (RunError::Unshared { .. } | RunError::Undividable { .. })) => error.to_string(),
        Err(error) => panic!("{error}"),
        Ok(_) => panic!("{ranks} ranks"),
    };
    let memory = fluid(&[LONG, r#"interactions.0.bath={"type":"memory","rate":3}"#]);
    let text = refusal(&memory, 2);
    assert!(text.contains("memory"), "{text}");
    let stress = fluid(&[SPLITTING, LONG, r#"output.stress={"every":7}"#]);
    let text = refusal(&stress, 2);
    assert!(text.contains("`stress` in output.stress: on one rank only"), "{text}");
    let text = refusal(&fluid(&[SPLITTING, LONG]), 64);
    assert!(text.contains("ranks fit"), "{text}");
    let text = refusal(&fluid(&[SPLITTING, LONG]), 0);
    assert!(text.contains("0 parts"), "{text}");
}
