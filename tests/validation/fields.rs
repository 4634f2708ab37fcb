//! Fields of shallow water by the libraries that people read them with, in Python: `make validate`.

use std::path::Path;
use std::process::Command;

use mesoscope::run::Run;

use super::readers::python;
use crate::support::{adapter, water};

const PACKAGES: [&str; 6] = ["numpy", "scipy", "netCDF4", "xarray", "dask", "gsd"];

/// The fields of a run as `NetCDF` are those of the same run as arrays of `NumPy`, in three readers; both start another run with the same depth.
#[test]
#[ignore = "installs Python packages"]
fn other_programs_read_fields() {
    let root = tempfile::tempdir().unwrap();
    let quantities =
        r#""every":10,"quantities":["depth","velocity-x","velocity-y","vorticity","potential-vorticity","speed"]"#;
    for format in ["npy", "netcdf"] {
        let fields = format!(r#"output={{"fields":{{{quantities},"format":"{format}"}}}}"#);
        let scene = water(&["time.step=0.01", "time.steps=20", &fields]);
        Run::replace(scene, root.path().join(format)).execute(&adapter(), &mut |_| {}).unwrap();
    }
    let floats = r#"particles=[{"species":"water","count":4096,"placement":{"type":"lattice"},"velocities":{"type":"geostrophic"}},
        {"species":"float","tracer":true,"velocities":{"type":"geostrophic"},
            "placement":{"type":"listed","positions":[[0.02,3],[3,0.02],[1,5],[6.27,2]]}}]"#;
    let scene = water(&["time.step=0.02", "time.steps=400", floats, r#"output={"trajectory":{"every":1}}"#]);
    Run::start(scene, root.path().join("shallow-water")).execute(&adapter(), &mut |_| {}).unwrap();
    let Some(python) = python(Path::new(env!("CARGO_TARGET_TMPDIR")), &PACKAGES) else {
        println!("NOT TESTED: there is no Python that makes virtual environments");
        return;
    };
    let script = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/validation/fields.py");
    let output = Command::new(python).arg(script).arg(root.path()).output().unwrap();
    println!("{}", String::from_utf8_lossy(&output.stdout));
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let state = format!(r#"state={{"file":"{}"}}"#, root.path().join("python.npz").display());
    let start = [
        r#"particles.0.velocities={"type":"thermal"}"#,
        "interactions.0.surface=[]",
        r#"output={"fields":{"every":20}}"#,
        &state,
    ];
    let again = water(&[&["time.step=0.01", "time.steps=20"], &start[..]].concat());
    let directory = root.path().join("again");
    Run::replace(again, &directory).execute(&adapter(), &mut |_| {}).unwrap();
    let read = |path: &Path| mesoscope::output::read_npy(path).unwrap().1;
    let [asked, found] =
        [root.path().join("npy/depth.npy"), directory.join("depth-000001.npy")].map(|path| read(&path));
    let apart = asked.iter().zip(&found).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
    println!("depth of a start from an archive of numpy: at most {apart:.2e} apart");
    assert!(apart < 1e-6);
}
