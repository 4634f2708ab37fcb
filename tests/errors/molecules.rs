//! Molecules with mistakes.

use mesoscope::families::{Angles, Bonds};
use serde_json::{Value, json};

use crate::support::mistakes::Correct;

const SURFACTANT: Correct = Correct(base);

fn base() -> Value {
    json!({
        "title": "test",
        "space": {"box": [6, 7, 8]},
        "time": {"step": 0.01, "steps": 100},
        "temperature": 1,
        "particles": [{"species": "head"}, {"species": "tail"}, {"species": "water"}],
        "molecules": [
            {"beads": ["head", "tail", "tail"], "bonds": [[0, 1], [1, 2]], "angles": [[0, 1, 2]], "count": 40},
            {"beads": ["water"], "number_density": 2},
        ],
        "interactions": [
            {"type": "dpd", "repulsion": 25, "friction": 4.5},
            {"type": "bonds", "potential": {"type": "harmonic", "stiffness": 4}},
            {"type": "angles", "stiffness": 2},
        ],
    })
}

#[test]
fn the_base_is_right() {
    let scene = SURFACTANT.accepted(&[]);
    let counts: Vec<_> = scene.particles.iter().map(|group| group.count).collect();
    assert_eq!(counts, [Some(40), Some(80), Some(672)]);
    assert_eq!(SURFACTANT.warnings(&[]), Vec::<String>::new());
    let model = scene.model();
    let particles = model.particles();
    assert_eq!(particles.bonds.as_ref().map(Bonds::count), Some(80));
    assert_eq!(particles.angles.as_ref().map(Angles::count), Some(40));
    // No molecules are none, and so is a scene without particles.
    assert_eq!(SURFACTANT.accepted(&["molecules.0.count=0"]).particles[0].count, Some(0));
}

#[test]
fn beads_and_numbers() {
    SURFACTANT.refused_with(&[r#"molecules.0.beads.1="tali""#], &["molecules[0].beads[1]: found \"tali\"", "`tail`"]);
    SURFACTANT.refused_with(&["molecules.0.beads=[]"], &["molecules[0].beads"]);
    SURFACTANT.refused(
        &["molecules.0.number_density=1"],
        "molecules[0]: both `count` and `number_density` are given; accepted: exactly one of `count` and `number_density`",
    );
    SURFACTANT.refused_with(&["molecules.1.number_density=null"], &["molecules[1]: neither `count` nor"]);
    SURFACTANT.refused_with(&["molecules.0.count=-1"], &["molecules[0].count: found -1"]);
    SURFACTANT.refused_with(
        &["molecules.1.number_density=1e9"],
        &["molecules: found 336000000120 beads in all", "at most 100000000"],
    );
    SURFACTANT.refused_with(
        &["particles.2.count=7"],
        &["particles[2].count: found 7 particles", "672, the number of particles of `water` in `molecules`"],
    );
}

#[test]
fn bonds_and_angles() {
    SURFACTANT
        .refused_with(&["molecules.0.bonds.1=[1,3]"], &["molecules[0].bonds[1]: found [1, 3]", "beads from 0 to 2"]);
    SURFACTANT.refused_with(&["molecules.0.bonds.1=[1,1]"], &["molecules[0].bonds[1]", "beads that are all different"]);
    SURFACTANT.refused_with(
        &["molecules.0.bonds=[[0,1],[1,2],[1,0]]"],
        &["molecules[0].bonds[2]: found [1, 0]", "each once: molecules[0].bonds[0] is the same"],
    );
    SURFACTANT.refused_with(
        &["molecules.0.bonds=[[0,1]]", "molecules.0.angles=[]", "interactions.2.triples=[[0,1,2]]"],
        &["molecules[0].bonds: found no way along them from bead 0 to bead 2", "a molecule of its own"],
    );
    SURFACTANT.refused_with(
        &["molecules.0.angles.0=[1,0,2]"],
        &["molecules[0].angles[0]: found [1, 0, 2]", "the one in the middle is bonded to both others"],
    );
    SURFACTANT.refused_with(
        &[r#"molecules.0.bond_types=["head"]"#],
        &["molecules[0].bond_types: found a list of 1", "2, one for each of `bonds`"],
    );
    SURFACTANT.refused_with(&["molecules.0.spacing=3.5"], &["molecules[0].spacing: found 3.5", "at most 3, half of"]);
    SURFACTANT.refused_with(&["molecules.0.spacing=0"], &["molecules[0].spacing: found 0"]);
    // Five beads that are all bonded to each other have no room in space.
    SURFACTANT.refused_with(
        &[
            r#"molecules.0.beads=["tail","tail","tail","tail","tail"]"#,
            "molecules.0.bonds=[[0,1],[0,2],[0,3],[0,4],[1,2],[1,3],[1,4],[2,3],[2,4],[3,4]]",
        ],
        &["molecules[0].bonds: found bonds that cannot all be 1 long in 3 dimensions"],
    );
    SURFACTANT.refused_with(
        &[r#"interactions.1.types=["tail"]"#],
        &["interactions[1].types[0]: found \"tail\"", "a type of bonds in `molecules`: `bond`"],
    );
    SURFACTANT.accepted(&[r#"molecules.0.bond_types=["head","tail"]"#, r#"interactions.1.types=["tail"]"#]);
}

/// A molecule that reaches over half of the box is near its own image.
#[test]
fn long_molecules() {
    let chain = |beads: usize, angles: bool| {
        let names = vec![r#""tail""#; beads].join(",");
        let list = |width: usize| {
            let link = |first: usize| format!("{:?}", (first..first + width).collect::<Vec<_>>());
            (0..=beads - width).map(link).collect::<Vec<_>>().join(",")
        };
        let angles = if angles { list(3) } else { String::new() };
        format!(
            r#"molecules.0={{"beads":[{names}],"bonds":[{}],"angles":[{angles}],"count":3,"spacing":0.7}}"#,
            list(2)
        )
    };
    let without_angles = "interactions.2.triples=[[0,1,2]]";
    let said = |beads: usize, angles: bool| {
        let long = chain(beads, angles);
        if angles { SURFACTANT.warnings(&[&long]) } else { SURFACTANT.warnings(&[&long, without_angles]) }
    };
    // Half of the shortest edge is 3: 4 bonds of .7 are 2.8 long; as a coil 18 reach over 2.97.
    assert_eq!(said(5, true), Vec::<String>::new());
    assert_eq!(said(19, false), Vec::<String>::new());
    let stretched = said(6, true);
    assert!(
        stretched.len() == 1
            && stretched[0]
                .starts_with("molecules[0]: a molecule with 5 bonds from end to end reaches over 3.500 as stretched"),
        "{stretched:?}"
    );
    let coil = said(20, false);
    assert!(
        coil.len() == 1 && coil[0].contains("19 bonds") && coil[0].contains("3.051 as a coil, more than 3.000, half"),
        "{coil:?}"
    );
    // A star has the two longest arms.
    let star = r#"molecules.0={"beads":["tail","tail","tail","tail","tail","tail"],"bonds":[[0,1],[0,2],[2,3],[0,4],[4,5]],
        "angles":[[1,0,2]],"count":3,"spacing":0.8}"#;
    let star = SURFACTANT.warnings(&[star]);
    assert!(star.len() == 1 && star[0].contains("a molecule with 4 bonds from end to end"), "{star:?}");
}

#[test]
fn several_mistakes_are_told_at_once() {
    let problems = SURFACTANT.problems(&[
        "molecules.0.bonds.0=[0,9]",
        "molecules.0.angles.0=[0,0,1]",
        r#"molecules.1.beads.0="wine""#,
        "molecules.1.count=3",
    ]);
    assert_eq!(problems.len(), 4, "{problems:#?}");
}

#[test]
fn what_does_not_go_together() {
    SURFACTANT
        .refused_with(&[r#"state={"file":"start.gsd"}"#], &["molecules: found beside a `state`", "one of the two"]);
    SURFACTANT.refused_with(
        &[r#"particles.0.placement={"type":"lattice"}"#],
        &["particles[0].placement: found beside `molecules`"],
    );
    SURFACTANT.refused_with(
        &[r#"particles.0.velocities={"type":"rest"}"#],
        &["particles[0].velocities: found beside `molecules`", "Maxwell's distribution"],
    );
    let layer = r#"{"species":"wall","count":90,"placement":{"type":"behind-walls","axis":"z","thickness":1}}"#;
    let groups = |groups: &str| format!("particles=[{groups}]");
    let (head, others) = (r#"{"species":"head"}"#, r#"{"species":"tail"},{"species":"water"}"#);
    let walls = r#"space.walls={"z":{}}"#;
    SURFACTANT.accepted(&[walls, &groups(&[head, others, layer].join(","))]);
    SURFACTANT.refused_with(
        &[walls, &groups(&[head, layer, others].join(","))],
        &["particles[1]: found beside `molecules`", "layers after all other groups, the last of which is particles[3]"],
    );
    SURFACTANT.refused_with(
        &[walls, &groups(&[head, others, layer].join(",")), r#"molecules.1.beads=["wall"]"#],
        &["particles[3].species: `molecules` has ", "a species of its own for a layer"],
    );
    let sizes = r#"output.chain_sizes={"every":2}"#;
    SURFACTANT.accepted(&[sizes]);
    SURFACTANT.refused_with(
        &[sizes, r#"interactions=[{"type":"dpd"}]"#],
        &["output.chain_sizes: found in a scene without chains", "or with `bonds` of `molecules` or of a file"],
    );
    let of = |species: &str| format!(r#"output.chain_sizes={{"every":2,"species":"{species}"}}"#);
    SURFACTANT.accepted(&[&of("head")]);
    SURFACTANT.refused_with(
        &[&of("water")],
        &["output.chain_sizes.species: found `water`, of which no chain and no molecule has particles"],
    );
    SURFACTANT.refused_with(&[&of("heat")], &[r#"output.chain_sizes.species: found "heat""#, "did you mean `head`?"]);
    let chain = |beads: u32| {
        let bonds: Vec<[u32; 2]> = (1..beads).map(|bead| [bead - 1, bead]).collect();
        json!({"beads": vec!["tail"; beads as usize], "bonds": bonds, "count": 1})
    };
    let two = r#"interactions=[{"type":"dpd"},{"type":"bonds","potential":{"type":"harmonic","stiffness":4}}]"#;
    let kinds: Vec<Value> = (2..259).map(chain).collect();
    SURFACTANT.refused_with(
        &[sizes, "space.box=[40,40,40]", &format!("molecules={}", Value::from(kinds)), two],
        &["output.chain_sizes: found 257 kinds of molecules", "at most 256"],
    );
    SURFACTANT.refused_with(
        &[r#"particles.1.chain={"beads":2}"#],
        &["particles[1].chain: found beside `molecules`", "one is a molecule"],
    );
    SURFACTANT.refused_with(
        &[r#"molecules=[{"beads":["water"],"count":5}]"#, "interactions.2.triples=[[0,1,2]]"],
        &["interactions[1]: found no bonds in `molecules`", "molecules with bonds"],
    );
}
