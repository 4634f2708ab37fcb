//! Structure by other programs, from the trajectory of the same run: `make validate`.

use std::path::Path;
use std::process::Command;

use mesoscope::run::Run;

use super::readers::python;
use crate::support::{adapter, fluid};

const PACKAGES: [&str; 3] = ["gsd", "freud-analysis", "MDAnalysis"];

/// Pairs by distance and clusters of freud, structure factors of `NumPy`, and sizes of chains of `MDAnalysis`, of every frame of a mixture with chains.
#[test]
#[ignore = "installs Python packages"]
fn other_programs_find_the_structure() {
    let root = tempfile::tempdir().unwrap();
    let particles =
        r#"particles=[{"species":"A","count":200},{"species":"B","count":120,"chain":{"beads":4,"spacing":0.77}}]"#;
    let interactions = r#"interactions=[{"type":"dpd","repulsion":25,"friction":4.5},
        {"type":"bonds","potential":{"type":"harmonic","stiffness":8}}]"#;
    let output = r#"output={"radial_distribution":{"every":20,"range":2.4,"bins":24,"species":"all-pairs"},
        "structure_factor":{"every":20,"range":8,"bins":16,"vectors":256,"species":"all-pairs"},
        "clusters":{"every":20,"distance":0.45,"species":"A"},"chain_sizes":{"every":20},"trajectory":{"every":20}}"#;
    let time = ["space.box=[5,5,5]", "time.step=0.01", "time.steps=400", "time.equilibration=0"];
    let coupled = r#"integrator={"type":"cotter-reich"}"#;
    let scene = fluid(&[&time[..], &[particles, interactions, output, coupled]].concat());
    Run::replace(scene, root.path()).execute(&adapter(), &mut |_| {}).unwrap();
    let Some(python) = python(Path::new(env!("CARGO_TARGET_TMPDIR")), &PACKAGES) else {
        println!("NOT TESTED: there is no Python that makes virtual environments");
        return;
    };
    let script = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/validation/structure.py");
    let output = Command::new(python).arg(script).arg(root.path()).output().unwrap();
    println!("{}", String::from_utf8_lossy(&output.stdout));
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
}
