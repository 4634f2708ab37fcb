//! Every shader variant that any scene can ask for: linked, validated, and held against the plans and the host structs.

use std::collections::{BTreeMap, BTreeSet, HashMap};
use std::mem::offset_of;
use std::num::NonZero;
use std::path::Path;
use std::sync::{Mutex, OnceLock};
use std::thread;

use mesoscope::engine::Control;
use mesoscope::families::shallow_water::WaterLayout;
use mesoscope::gpu::{Binding, GpuError, LinkedShader, Switched, link_loading, validate};
use mesoscope::plan::{Division, Domain, Hardware, Kernel, Options, Part, Plan, Storage, Texture, Traversal};
use mesoscope::run;
use mesoscope::scene::{self, Checked};
use mesoscope::shaders::{Array, Choices, Constant, Entry, Library, LinkedText, library, linked_text};
use mesoscope::state::Hold;

use serde_json::{Value, json};

use crate::canonical::hash_of_kernel;
use crate::support::{COTTER_REICH, INTEGRATORS, MIXTURE, MIXTURE_FORCE, SPLITTING, STAGED, cells, fluid, water};

/// WebGPU's core limits.
const STORAGE_BUFFERS: usize = 8;
/// What the engine asks for where there are textures.
const STORAGE_TEXTURES: usize = 8;
const WORKGROUPS: u64 = 65_535 * 65_535;
const WORKGROUP_BYTES: u32 = 16_384;

const SAMPLERS: &[&str] = &[
    "time.steps=1000",
    r#"output.radial_distribution={"every":10,"range":1.1}"#,
    r#"output.diffusion={"every":2,"window":8}"#,
    r#"output.trajectory={"every":5}"#,
    r#"output.autocorrelations=[{"quantity":"velocity","every":2,"window":8},{"quantity":"force","every":2,"window":8}]"#,
    r#"output.histograms=[{"quantity":"velocity","every":2,"axis":"x"},{"quantity":"acceleration","every":2},
        {"quantity":"speed","every":2,"frame":"centre-of-mass"}]"#,
    r#"output.profiles={"axis":"x","every":2,"quantities":["density","velocity","temperature","stress"]}"#,
    r#"output.stress={"every":2}"#,
];

/// Of particles that nothing but pairs and bonds acts on.
const VISCOSITY: &str = r#"output.viscosity={"every":2,"window":8}"#;

/// Analyses of the motion of particles.
const OF_MOTION: [&str; 3] = [
    r#"output.diffusion={"every":2,"window":4}"#,
    r#"output.autocorrelations=[{"quantity":"velocity","every":2,"window":4,"frame":"centre-of-mass"}]"#,
    r#"output.histograms=[{"quantity":"velocity","every":2,"frame":"box"},{"quantity":"speed","every":2}]"#,
];

fn plan_of(scene: &Checked, options: Options) -> Plan {
    run::plan(scene, Hardware::default(), options)
}

/// Plans of a scene for either kind of memory.
fn plans_of(name: &str, scene: &Checked, options: Options) -> [(String, Plan); 2] {
    [false, true].map(|serial| {
        let plan = plan_of(scene, Options { serial_memory: Some(serial), ..options });
        (format!("{name} serial_memory={serial}"), plan)
    })
}

/// Plans of a scene of particles by one traversal or the other, in turns.
fn plans_in_turn(number: usize, changes: &[&str]) -> [(String, Plan); 2] {
    let traversal = [Traversal::Rows, Traversal::Clusters][number % 2];
    let options = Options { traversal: Some(traversal), ..Options::default() };
    plans_of(&format!("{} {traversal:?}", changes.join(" ")), &fluid(changes), options)
}

/// Plans of everything that chooses a module.
pub fn plans() -> &'static [(String, Plan)] {
    static PLANS: OnceLock<Vec<(String, Plan)>> = OnceLock::new();
    PLANS.get_or_init(|| {
        let kinds = [
            structure_plans,
            queued_plans,
            fluid_plans,
            long_range_plans,
            shared_plans,
            driven_plans,
            walled_plans,
            sheared_plans,
            sheared_coupled_plans,
            kicked_plans,
            charged_plans,
            water_plans,
            shared_water_plans,
            coupled_plans,
            noise_plans,
            bond_plans,
            voronoi_plans,
            range_plans,
            many_body_plans,
            relaxed_plans,
            layered_plans,
            porous_plans,
            shared_bond_plans,
        ];
        thread::scope(|scope| {
            let kinds = kinds.map(|plans| scope.spawn(plans));
            kinds.into_iter().flat_map(|plans| plans.join().unwrap()).collect()
        })
    })
}

/// Every structure that a scene of particles may have: spaces, species, integrators, pairs, what acts beside them and what
/// is measured, in every combination that scenes accept, with every way to visit pairs. Laws that are branches on
/// constants make no other kernels.
fn structure_plans() -> Vec<(String, Plan)> {
    let spaces = [
        json!({"box": [900]}),
        json!({"box": [900], "walls": {"x": {}}}),
        json!({"box": [9, 7]}),
        json!({"box": [9, 7], "walls": {"y": {}}}),
        json!({"box": [9, 7], "shear": {"rate": 0.2, "gradient": "y"}}),
        json!({"box": [9, 7, 8]}),
        json!({"box": [9, 7, 8], "walls": {"z": {}}}),
        json!({"box": [9, 7, 8], "shear": {"rate": 0.2, "gradient": "y"}}),
    ];
    let pairs = [
        json!([]),
        json!([{"type": "dpd", "repulsion": 25}]),
        json!([{"type": "dpd", "repulsion": 25, "friction": 4.5}]),
        json!([{"type": "dpd", "repulsion": 25, "friction": 4.5, "skin": 0}]),
        json!([{"type": "dpd", "repulsion": 25, "friction": 4.5, "skin": 0.3, "bath": {"type": "memory", "rate": 3}}]),
        json!([{"type": "dpd", "repulsion": 25, "friction": 4.5, "skin": 0, "bath": {"type": "memory", "rate": 3}}]),
        json!([{"type": "dpd", "repulsion": -40, "friction": 4.5, "many_body": {"repulsion": 25}}]),
    ];
    let mut grounds = Vec::new();
    for space in &spaces {
        let mut second = vec![None, Some(json!({"species": "B", "count": 50, "mass": 2.5}))];
        // A layer of frozen particles.
        second.extend(space["walls"].as_object().and_then(|walls| walls.keys().next()).map(|axis| {
            let placement = json!({"type": "behind-walls", "axis": axis, "thickness": 1});
            Some(json!({"species": "B", "number_density": 3, "placement": placement}))
        }));
        for (second, pairs) in second.iter().flat_map(|second| pairs.iter().map(move |pairs| (second, pairs))) {
            for integrator in [COTTER_REICH, STAGED] {
                let mut groups = vec![json!({"species": "A", "count": 200, "chain": {"beads": 4}})];
                groups.extend(second.clone());
                let mut scene = json!({
                    "title": "structure", "seed": 1, "space": space, "time": {"step": 0.01, "steps": 1000},
                    "temperature": 1, "particles": groups, "interactions": pairs, "output": {"energies": {"every": 1}},
                });
                scene["integrator"] = serde_json::from_str(integrator.split_once('=').unwrap().1).unwrap();
                grounds.extend(accepted(&scene).map(|_| scene));
            }
        }
    }
    let plans: Vec<(String, Plan)> = in_shares(&grounds, plans_beside).into_iter().flatten().collect();
    assert!(plans.len() > 10_000, "only {} plans", plans.len());
    plans
}

/// Pairs from a queue, in every pass that takes them from one, in every space, beside one species and two.
fn queued_plans() -> Vec<(String, Plan)> {
    let spaces = ["[9,7]", "[9,7,8]"].iter().flat_map(|lengths| {
        let axis = if lengths.len() < 6 { "y" } else { "z" };
        [
            format!(r#"space={{"box":{lengths}}}"#),
            format!(r#"space={{"box":{lengths},"walls":{{"{axis}":{{}}}}}}"#),
            format!(r#"space={{"box":{lengths},"shear":{{"rate":0.2,"gradient":"{axis}"}}}}"#),
        ]
    });
    let pairs = [
        r#"interactions=[{"type":"dpd","repulsion":25}]"#,
        r#"interactions=[{"type":"dpd","repulsion":25,"friction":4.5}]"#,
        r#"interactions=[{"type":"dpd","repulsion":-40,"friction":4.5,"many_body":{"repulsion":25}}]"#,
    ];
    let particles = [
        r#"particles=[{"species":"A","count":200}]"#,
        r#"particles=[{"species":"A","count":200},{"species":"B","count":50,"mass":2.5}]"#,
    ];
    let options = Options { traversal: Some(Traversal::Queue), ..Options::default() };
    let mut plans = Vec::new();
    for (space, pairs) in spaces.flat_map(|space| pairs.map(|pairs| (space.clone(), pairs))) {
        for (particles, integrator) in
            particles.iter().flat_map(|groups| INTEGRATORS.iter().map(move |scheme| (groups, *scheme)))
        {
            let changes = [space.as_str(), pairs, particles, integrator, "time.steps=1000"];
            plans.push((format!("{} queue", changes.join(" ")), plan_of(&fluid(&changes), options)));
        }
    }
    let queued = |plan: &Plan| plan.kernels.iter().filter(|kernel| kernel.entry == Entry::VisitQueue).count();
    assert!(plans.iter().all(|(_, plan)| queued(plan) > 0));
    plans
}

/// Plans of a scene with what may act beside its pairs, for every way to visit them.
fn plans_beside(pairs: &Value) -> Vec<(String, Plan)> {
    let listed = Options { listed: true, ..Options::default() };
    let [rows, clusters] = [Traversal::Rows, Traversal::Clusters]
        .map(|traversal| Options { traversal: Some(traversal), ..Options::default() });
    let mut plans = Vec::new();
    for scene in scenes_beside(pairs) {
        for options in [rows, clusters, listed] {
            plans.extend(plans_of(&format!("{} {options:?}", serde_json::to_string(&scene).unwrap()), &scene, options));
        }
    }
    plans
}

/// A scene with what may act beside its pairs, as far as it accepts that, without analyses and with all that it accepts.
fn scenes_beside(pairs: &Value) -> Vec<Checked> {
    let dimension = pairs["space"]["box"].as_array().unwrap().len();
    let last = ["x", "y", "z"][dimension - 1];
    let force = json!({"type": "body-force", "force": vec![0.4; dimension]});
    let harmonic = json!({"type": "harmonic", "stiffness": 9, "length": 0.5});
    let memory = json!({"type": "memory", "rate": 3});
    let angles = json!({"type": "angles", "stiffness": 3});
    let tether = json!({"type": "tether", "stiffness": 4});
    let bonds = |more: Value| {
        let mut bonds = json!({"type": "bonds"});
        bonds.as_object_mut().unwrap().extend(more.as_object().unwrap().clone());
        bonds
    };
    let white = json!({"type": "langevin", "friction": 1});
    let slow = json!({"type": "langevin", "friction": 1, "bath": memory});
    let noise = json!({"type": "coloured-noise", "strength": 1, "time": 0.1});
    let charges = json!({"type": "electrostatics", "bjerrum_length": 1, "background": true});
    let springs = bonds(json!({"potential": harmonic}));
    let excluding = bonds(json!({"potential": harmonic, "exclude_repulsion": true}));
    let apart = bonds(json!({"potential": harmonic, "exclude_charges": true}));
    let rubbing = bonds(json!({"friction": 2}));
    let remembering = bonds(json!({"friction": 2, "bath": memory}));
    let beside = [
        vec![],
        vec![&excluding, &angles, &tether, &force],
        vec![&springs, &angles, &white, &force],
        vec![&rubbing],
        vec![&rubbing, &white, &force],
        vec![&remembering, &angles],
        vec![&remembering, &angles, &white],
        vec![&remembering, &slow, &noise, &tether],
        vec![&charges],
        vec![&charges, &apart, &rubbing, &angles, &white, &force],
        vec![&charges, &remembering, &slow, &noise],
    ];
    let analyses = [
        json!({
            "radial_distribution": {"every": 2, "range": 1.1}, "structure_factor": {"every": 2, "range": 9}, "diffusion": {"every": 2, "window": 4},
            "viscosity": {"every": 2, "window": 4}, "trajectory": {"every": 5}, "chain_sizes": {"every": 2},
            "autocorrelations": [
                {"quantity": "velocity", "every": 2, "window": 4}, {"quantity": "force", "every": 2, "window": 4},
            ],
            "histograms": [{"quantity": "velocity", "every": 2}], "profiles": {"axis": last, "every": 2},
        }),
        json!({
            "stress": {"every": 2}, "profiles": {"axis": last, "every": 2, "quantities": ["density", "stress"]},
            "autocorrelations": [
                {"quantity": "velocity", "every": 2, "window": 4, "frame": "centre-of-mass"},
                {"quantity": "force", "every": 2, "window": 4},
            ],
            "histograms": [
                {"quantity": "velocity", "every": 2, "frame": "centre-of-mass"}, {"quantity": "acceleration", "every": 2},
            ],
        }),
    ];
    let of_species = [
        json!({
            "radial_distribution": {"every": 2, "range": 1.1, "species": "all-pairs"},
            "structure_factor": {"every": 2, "range": 9, "species": "all-pairs"},
            "diffusion": {"every": 2, "window": 4, "species": "A"},
            "autocorrelations": [
                {"quantity": "velocity", "every": 2, "window": 4, "species": "A"},
                {"quantity": "force", "every": 2, "window": 4, "species": "A"},
            ],
            "histograms": [
                {"quantity": "velocity", "every": 2, "species": "A"}, {"quantity": "acceleration", "every": 2, "species": "A"},
            ],
            "profiles": {"axis": last, "every": 2, "species": "A"},
        }),
        json!({
            "radial_distribution": {"every": 2, "range": 1.1, "species": "A"},
            "autocorrelations": [
                {"quantity": "velocity", "every": 2, "window": 4, "frame": "centre-of-mass", "species": "A"},
            ],
            "histograms": [{"quantity": "velocity", "every": 2, "frame": "centre-of-mass", "species": "A"}],
            "profiles": {"axis": "x", "every": 2, "species": "A"},
        }),
    ];
    let mut scenes = Vec::new();
    for (number, interactions) in beside.into_iter().enumerate() {
        let mut scene = pairs.clone();
        for interaction in interactions {
            let before = scene.clone();
            scene["interactions"].as_array_mut().unwrap().push(interaction.clone());
            if interaction["type"] == "electrostatics" {
                scene["particles"][0]["charge"] = json!(1);
            }
            if accepted(&scene).is_none() {
                scene = before;
            }
        }
        scenes.extend(accepted(&scene));
        let of_species = of_species.iter().filter(|_| number < 2);
        for analyses in analyses.iter().chain(of_species) {
            let mut scene = scene.clone();
            for (name, analysis) in analyses.as_object().unwrap() {
                let before = scene["output"].clone();
                scene["output"][name] = analysis.clone();
                if accepted(&scene).is_none() {
                    scene["output"] = before;
                }
            }
            scenes.extend(accepted(&scene));
        }
    }
    // Where little is accepted beside the pairs, several are the same scene.
    let mut seen = BTreeSet::new();
    scenes.retain(|scene| seen.insert(serde_json::to_string(scene).unwrap()));
    scenes
}

fn accepted(scene: &Value) -> Option<Checked> {
    scene::parse("structure", &scene.to_string(), &[]).ok()
}

/// Charges on meshes of lines of every length that a transform takes otherwise, along every axis, with and without ranks.
fn charged_plans() -> Vec<(String, Plan)> {
    let lengths = [16, 20, 24, 32, 40, 48, 60, 64, 80, 96, 120, 128, 160, 200, 240, 256, 400, 480, 512];
    let mut plans = Vec::new();
    for (length, axis) in lengths.iter().flat_map(|length| [0, 1, 2].map(|axis| (length, axis))) {
        let mut edges = [6.0; 3];
        edges[axis] = 0.5 * f64::from(*length);
        for (order, lanes) in [(4, None), (6, Some(false))] {
            let interactions = format!(
                r#"interactions=[{{"type":"dpd","repulsion":25,"friction":4.5}},
                {{"type":"electrostatics","bjerrum_length":1,"order":{order}}}]"#
            );
            let particles =
                r#"particles=[{"species":"A","count":20,"charge":1},{"species":"B","count":10,"charge":-2}]"#;
            let changes = [&format!("space.box={edges:?}")[..], &interactions, particles, SPLITTING, "time.steps=1000"];
            let options = Options { butterflies_by_lanes: lanes, ..Options::default() };
            plans.push((changes.join(" "), plan_of(&fluid(&changes), options)));
        }
    }
    // Waves one by one, and the other kind of charges, excluded by bonds.
    for charges in [r#""method":"waves""#, r#""decay":0.929,"spacing":0.3"#] {
        let interactions = format!(
            r#"interactions=[{{"type":"dpd","repulsion":25,"friction":4.5}},
            {{"type":"electrostatics","bjerrum_length":1,{charges}}},
            {{"type":"bonds","pairs":[[0,25],[3,4]],"exclude_charges":true}}]"#
        );
        let particles = r#"particles=[{"species":"A","count":20,"charge":1},{"species":"B","count":10,"charge":-2}]"#;
        for integrator in [SPLITTING, COTTER_REICH] {
            let changes = [
                "space.box=[6,5,6]",
                &interactions,
                particles,
                integrator,
                "time.steps=1000",
                r#"output.stress={"every":2}"#,
            ];
            plans.push((changes.join(" "), plan_of(&fluid(&changes), Options::default())));
        }
    }
    plans
}

/// Pairs with every law, in turns, with every way to scan.
fn fluid_plans() -> Vec<(String, Plan)> {
    let laws: [&[&str]; 9] = [
        &["interactions.0.weight_exponent=0.5"],
        &["interactions.0.repulsion=0", "interactions.0.pairs=[]"],
        &[r#"noise={"distribution":"gaussian"}"#],
        &[r#"noise={"generator":"threefry2x32-20"}"#],
        &[r#"noise={"generator":"threefry2x32-20","distribution":"gaussian"}"#],
        &["temperature=0"],
        &["interactions.0.friction=0"],
        &["interactions=[]"],
        &[VISCOSITY],
    ];
    let mixture = [
        r#"particles=[{"species":"A","count":200},{"species":"B","count":50,"mass":2.5}]"#,
        r#"interactions.0.pairs=[{"between":["A","B"],"repulsion":1.0}]"#,
    ];
    let mut plans = Vec::new();
    let grounds = INTEGRATORS
        .iter()
        .flat_map(|integrator| ["time.steps=1000", "space.box=[9,7]"].map(|space| [*integrator, space]));
    let all = grounds.flat_map(|ground| laws.map(|law| (ground, law)));
    for (number, (ground, law)) in all.enumerate() {
        let mixture: &[&str] = if number % 2 == 0 && law != ["interactions=[]"] { &mixture } else { &[] };
        let changes = [&ground[..], mixture, law, SAMPLERS].concat();
        let traversal = Some([Traversal::Rows, Traversal::Clusters][number / 2 % 2]);
        let options = Options { traversal, many_level_scan: number % 3 == 0, ..Options::default() };
        plans.extend(plans_of(&format!("{} {options:?}", changes.join(" ")), &fluid(&changes), options));
    }
    plans
}

/// The same where pairs of species have cutoffs or exponents of their own, with and without bonds and memory.
fn range_plans() -> Vec<(String, Plan)> {
    let ranges = [
        r#""pairs":[{"between":["A","B"],"cutoff":0.7}]"#,
        r#""pairs":[{"between":["A","B"],"weight_exponent":1}]"#,
        r#""pairs":[{"between":["A","B"],"cutoff":1.2,"weight_exponent":0.5}]"#,
        r#""cutoff":0.8},{"type":"dpd","repulsion":-5,"pairs":[{"between":["A","B"],"cutoff":1.2}]"#,
    ];
    let particles = [
        r#"particles=[{"species":"A","count":200,"chain":{"beads":2}},{"species":"B","count":50}]"#,
        r#"particles=[{"species":"A","count":200,"chain":{"beads":2}},{"species":"B","count":50,"mass":2.5}]"#,
    ];
    let bonds = r#",{"type":"bonds","exclude_repulsion":true,"potential":{"type":"harmonic","stiffness":9}}"#;
    let mut plans = Vec::new();
    for (range, particles) in ranges.iter().flat_map(|range| particles.map(|particles| (range, particles))) {
        for space in ["space.box=[9,7]", "space.box=[9,7,8]"] {
            for (integrator, bonds) in
                INTEGRATORS.iter().flat_map(|integrator| ["", bonds].map(|bonds| (integrator, bonds)))
            {
                let force = format!(r#"interactions=[{{"type":"dpd","repulsion":25,"friction":4.5,{range}}}{bonds}]"#);
                let scene = fluid(&[&[force.as_str(), particles, space, integrator, VISCOSITY], SAMPLERS].concat());
                for traversal in [Traversal::Rows, Traversal::Clusters] {
                    let options = Options { traversal: Some(traversal), ..Options::default() };
                    let name = format!("{force} {particles} {space} {integrator} {traversal:?}");
                    plans.extend(plans_of(&name, &scene, options));
                }
                if !integrator.contains("splitting") {
                    let options = Options { listed: true, ..Options::default() };
                    plans.extend(plans_of(
                        &format!("{force} {particles} {space} {integrator} listed"),
                        &scene,
                        options,
                    ));
                }
            }
            let memory = r#""bath":{"type":"memory","rate":3}"#;
            let force = format!(r#"interactions=[{{"type":"dpd","repulsion":25,"friction":4.5,{memory},{range}}}]"#);
            let scene = fluid(&[force.as_str(), particles, space, INTEGRATORS[3]]);
            plans.extend(plans_of(&format!("{force} {particles} {space}"), &scene, Options::default()));
        }
    }
    plans
}

/// The same with a many-body repulsion, alone and beside whatever goes with it.
fn many_body_plans() -> Vec<(String, Plan)> {
    let pairs = [
        r#"{"type":"dpd","repulsion":-40,"friction":4.5,"many_body":{"repulsion":25}}"#,
        r#"{"type":"dpd","repulsion":-40,"many_body":{"repulsion":25}}"#,
        r#"{"type":"dpd","friction":4.5,"weight_exponent":1,"many_body":{"repulsion":25}}"#,
        r#"{"type":"dpd","repulsion":-40,"friction":4.5,"many_body":{"repulsion":25},"pairs":[{"between":["A","A"],"cutoff":0.8}]}"#,
        r#"{"type":"dpd","repulsion":-40,"friction":4.5,"many_body":{"repulsion":25}},{"type":"dpd","repulsion":5,"cutoff":0.6}"#,
    ];
    let bonds = r#",{"type":"bonds","pairs":[[0,1]],"potential":{"type":"harmonic","stiffness":9}}"#;
    let particles = [
        r#"particles=[{"species":"A","count":200}]"#,
        r#"particles=[{"species":"A","count":200},{"species":"B","count":50,"mass":2.5}]"#,
    ];
    let mut plans = Vec::new();
    let forces = pairs.iter().flat_map(|pairs| particles.map(|particles| (pairs, particles)));
    for (number, (pairs, particles)) in forces.enumerate() {
        for (row, integrator) in INTEGRATORS.iter().enumerate() {
            for (column, others) in ["", bonds, "walls"].into_iter().enumerate() {
                // Either box and either traversal, by turns.
                let turn = number + row + column;
                let (space, force) =
                    [("space.box=[9,7]", "[1,2]"), ("space.box=[9,7,8]", "[1,2,3]")][(turn / 2 + number) % 2];
                let driven = format!(r#"{bonds},{{"type":"body-force","force":{force}}}"#);
                let walls = others == "walls";
                let interactions = format!("interactions=[{pairs}{}]", if walls { &driven } else { others });
                let mut changes = vec![particles, interactions.as_str(), space, integrator];
                if walls {
                    changes.push(r#"space.walls={"y":{}}"#);
                    changes.extend(SAMPLERS);
                } else if number % 4 < 2 {
                    changes.extend([SAMPLERS, &[VISCOSITY]].concat());
                }
                plans.extend(plans_in_turn(turn, &changes));
            }
        }
    }
    plans
}

/// The same where one dispatch does not look at all pairs of a radial distribution function.
fn long_range_plans() -> Vec<(String, Plan)> {
    let mut plans = Vec::new();
    for space in ["space.box=[9,7]", "space.box=[9,7,8]"] {
        for integrator in INTEGRATORS {
            for listed in [false, true].into_iter().filter(|listed| !listed || !integrator.contains("splitting")) {
                for (species, viscosity) in [("null", VISCOSITY), (r#""A""#, space), (r#""all-pairs""#, space)] {
                    let species = format!("output.radial_distribution.species={species}");
                    let scene = fluid(&[SAMPLERS, &[viscosity, space, integrator, &species]].concat());
                    let options = Options { listed, pairs_in_dispatch: Some(999), ..Options::default() };
                    plans.extend(plans_of(&format!("{space} {integrator} {species} in dispatches"), &scene, options));
                }
            }
        }
    }
    plans
}

/// The same of one of several ranks that share the box.
fn shared_plans() -> Vec<(String, Plan)> {
    // Parts so wide that exchanges overlap with their inner cells, where pairs are visited particle by particle.
    let radial = r#"output.radial_distribution={"every":2,"range":1.5}"#;
    let radial_of_species = radial.replace("1.5", r#"1.5,"species":"all-pairs""#);
    let dense = r#"interactions=[{"type":"dpd","repulsion":-40,"friction":4.5,"many_body":{"repulsion":25}}]"#;
    let walled = r#"space.walls={"y":{}}"#;
    let sheared = r#"space.shear={"rate":0.5,"gradient":"y"}"#;
    let mut plans = Vec::new();
    for (row, (space, force)) in
        [("space.box=[9,24]", "[1,2]"), ("space.box=[7,8,24]", "[1,2,3]")].into_iter().enumerate()
    {
        let driven = format!(
            r#"interactions=[{{"type":"dpd","repulsion":25,"friction":4.5}},{{"type":"body-force","force":{force}}}]"#
        );
        let driven = [driven.as_str()];
        let kinds: [&[&str]; 6] =
            [&[], &[MIXTURE, MIXTURE_FORCE], &[dense], &driven, &[walled, MIXTURE, MIXTURE_FORCE], &[sheared]];
        for (number, kind) in kinds.iter().enumerate() {
            for (column, integrator) in INTEGRATORS.iter().enumerate() {
                // Distances of pairs are not counted between walls and through boundaries that shear.
                let radial = match number {
                    4.. => "time.steps=1000",
                    1 => &radial_of_species,
                    _ => radial,
                };
                let followed = r#"output.trajectory={"every":5}"#;
                let followed = if number == 5 { "time.steps=1000" } else { followed };
                let changes = [&["time.steps=1000", space, *integrator, radial, followed], *kind].concat();
                let traversal = [Traversal::Rows, Traversal::Clusters][(row + number + column) % 2];
                let division = Division { parts: if row == 0 { [1, 2, 1] } else { [1, 1, 2] } };
                let part = Some(Part { division, rank: 1 });
                let options = Options { traversal: Some(traversal), part, ..Options::default() };
                plans.extend(plans_of(
                    &format!("{} {traversal:?} shared", changes.join(" ")),
                    &fluid(&changes),
                    options,
                ));
            }
        }
    }
    plans
}

/// The same with bonds, angles, tethers and friction along bonds.
fn shared_bond_plans() -> Vec<(String, Plan)> {
    let harmonic = r#"{"type":"bonds","potential":{"type":"harmonic","stiffness":50,"length":0.6}}"#;
    let others = r#"{"type":"bonds","potential":{"type":"fene","stiffness":9,"extent":2},"exclude_repulsion":true},
        {"type":"angles","stiffness":2}"#;
    let rubbing = r#"{"type":"bonds","friction":2},{"type":"tether","stiffness":3}"#;
    let pair = r#"{"type":"dpd","repulsion":25,"friction":4.5}"#;
    let unrubbed = r#"{"type":"dpd","repulsion":25}"#;
    let dense = r#"{"type":"dpd","repulsion":-40,"friction":4.5,"many_body":{"repulsion":25}}"#;
    let walled = r#"space.walls={"x":{}}"#;
    let sheared = r#"space.shear={"rate":0.5,"gradient":"y"}"#;
    let unchanged = "time.steps=1000";
    let particles = [
        r#"particles=[{"species":"A","count":200,"chain":{"beads":4}}]"#,
        r#"particles=[{"species":"A","count":200,"chain":{"beads":4}},{"species":"B","count":50,"mass":2.5}]"#,
    ];
    let mut plans = Vec::new();
    for (row, space) in ["space.box=[9,22]", "space.box=[7,8,25]"].into_iter().enumerate() {
        for (number, (bonds, pairs, more)) in [
            (harmonic, pair, unchanged),
            (others, pair, unchanged),
            (harmonic, dense, unchanged),
            (rubbing, pair, unchanged),
            (rubbing, unrubbed, unchanged),
            (rubbing, "", unchanged),
            (others, pair, walled),
            (others, pair, sheared),
        ]
        .into_iter()
        .enumerate()
        {
            let comma = if pairs.is_empty() { "" } else { "," };
            let interactions = format!("interactions=[{bonds}{comma}{pairs}]");
            for (column, integrator) in INTEGRATORS.iter().enumerate() {
                let sizes = if number == 0 { r#"output.chain_sizes={"every":2}"# } else { unchanged };
                let changes =
                    [space, *integrator, &interactions, particles[(number + column) % 2], more, unchanged, sizes];
                let traversal = [Traversal::Rows, Traversal::Clusters][(row + number + column) % 2];
                let division = Division { parts: if row == 0 { [1, 2, 1] } else { [1, 1, 2] } };
                let part = Some(Part { division, rank: 1 });
                let options = Options { traversal: Some(traversal), part, ..Options::default() };
                plans.extend(plans_of(
                    &format!("{} {traversal:?} shared", changes.join(" ")),
                    &fluid(&changes),
                    options,
                ));
            }
        }
    }
    plans
}

/// The same of shallow water, with particles that are followed and not.
fn shared_water_plans() -> Vec<(String, Plan)> {
    let mut plans = Vec::new();
    for spline in [1, 2, 3].map(|order| format!("interactions.0.spline_order={order}")) {
        let solver = r#"interactions.0.smoothing.solver={"type":"chebyshev","tolerance":0.1}"#;
        for mesh in [&["interactions.0.mesh=[32,32]"][..], &["interactions.0.mesh=[15,12]", solver]] {
            for more in [&[][..], &[WATER_TRACERS, r#"output.trajectory={"every":5}"#]] {
                let changes = [&[spline.as_str()], mesh, more].concat();
                for (traversal, many_level_scan) in [(Traversal::Rows, false), (Traversal::Clusters, true)] {
                    let part = Some(Part { division: Division { parts: [1, 3, 1] }, rank: 0 });
                    let traversal = Some(traversal);
                    let options = Options { traversal, many_level_scan, part, ..Options::default() };
                    let name = format!("water {} {traversal:?} {many_level_scan} shared", changes.join(" "));
                    plans.extend(plans_of(&name, &water(&changes), options));
                }
            }
        }
    }
    plans
}

/// The same with body forces of every profile, of pairs, with bonds among them, and of listed pairs.
fn driven_plans() -> Vec<(String, Plan)> {
    let particles = [
        r#"particles=[{"species":"A","count":200,"chain":{"beads":2}}]"#,
        r#"particles=[{"species":"A","count":200,"chain":{"beads":2}},{"species":"B","count":50,"mass":2.5}]"#,
    ];
    let mut plans = Vec::new();
    for particles in particles {
        for (space, force) in [("space.box=[9,7]", "[1,2]"), ("space.box=[9,7,8]", "[1,2,-3]")] {
            for profile in
                [r#""uniform""#, r#""opposed","axis":"y""#, r#""sinusoidal","axis":"x","waves":2,"species":["A"]"#]
            {
                for bonds in ["", r#",{"type":"bonds","potential":{"type":"harmonic","stiffness":9}}"#] {
                    for integrator in INTEGRATORS {
                        let interactions = format!(
                            r#"interactions=[{{"type":"dpd","repulsion":25,"friction":4.5}},
                                {{"type":"body-force","force":{force},"profile":{profile}}}{bonds}]"#
                        );
                        let changes = [&[particles, interactions.as_str(), space, integrator], SAMPLERS].concat();
                        for listed in
                            [false, true].into_iter().filter(|listed| !listed || !integrator.contains("splitting"))
                        {
                            let options = Options { listed, ..Options::default() };
                            plans.extend(plans_of(&changes.join(" "), &fluid(&changes), options));
                        }
                    }
                }
            }
        }
    }
    plans
}

/// Pairs between walls of every kind, at rest and moving, with bonds and with a body force.
fn walled_plans() -> Vec<(String, Plan)> {
    let particles = [
        r#"particles=[{"species":"A","count":200}]"#,
        r#"particles=[{"species":"A","count":200},{"species":"B","count":50,"mass":2.5}]"#,
    ];
    let spaces = [
        r#"space={"box":[9,7],"walls":{"y":{"upper_velocity":[1,0]}}}"#,
        r#"space={"box":[9,7],"walls":{"x":{"reflection":"specular"},"y":{}}}"#,
        r#"space={"box":[9,7,8],"walls":{"z":{"upper_velocity":[1,0,0]}}}"#,
        r#"space={"box":[9,7,8],"walls":{"x":{},"y":{"reflection":"specular"},"z":{}}}"#,
        r#"space={"box":[9,7,8],"walls":{"x":{"reflection":"specular"},"y":{"lower_velocity":[0,0,1]}}}"#,
        r#"space={"box":[9,7,8],"walls":{"x":{}}}"#,
    ];
    let bonds = r#",{"type":"bonds","pairs":[[0,1]],"potential":{"type":"harmonic","stiffness":9}}"#;
    let mut plans = Vec::new();
    for particles in particles {
        for space in spaces {
            let components = if space.contains("[9,7]") { "[1,2]" } else { "[1,2,-3]" };
            let force = format!(r#",{{"type":"body-force","force":{components}}}"#);
            for (first, others) in [(true, String::new()), (true, format!("{bonds}{force}")), (false, String::new())] {
                let pairs = if first { r#"{"type":"dpd","repulsion":25,"friction":4.5}"# } else { "" };
                let interactions = format!("interactions=[{pairs}{others}]");
                for integrator in INTEGRATORS {
                    let changes = [&[particles, interactions.as_str(), space, integrator], SAMPLERS].concat();
                    plans.extend(plans_of(&changes.join(" "), &fluid(&changes), Options::default()));
                }
            }
        }
    }
    plans.extend(coupled_plans_between_walls(&spaces));
    plans
}

/// Lists of neighbours, baths on every particle, a coloured noise and fixed particles between walls, and particles on a line between two.
fn coupled_plans_between_walls(spaces: &[&str]) -> Vec<(String, Plan)> {
    let others = [
        r#"{"type":"dpd","repulsion":25,"friction":4.5,"bath":{"type":"memory","rate":3}}"#,
        r#"{"type":"dpd","repulsion":25,"friction":4.5},{"type":"langevin","friction":1}"#,
        r#"{"type":"dpd","repulsion":25},{"type":"langevin","friction":1,"bath":{"type":"memory","rate":3}}"#,
        r#"{"type":"langevin","friction":1,"bath":{"type":"white","temperature":0}},{"type":"body-force","force":[1,2]}"#,
        r#"{"type":"dpd","friction":4.5},{"type":"coloured-noise","strength":1,"time":0.1}"#,
        r#"{"type":"coloured-noise","strength":1,"time":0.1,"process":"short"}"#,
        r#"{"type":"bonds","pairs":[[0,1]],"friction":1,"potential":{"type":"harmonic","stiffness":9}}"#,
        r#"{"type":"bonds","pairs":[[0,1]],"friction":1,"bath":{"type":"memory","rate":3},"potential":{"type":"harmonic","stiffness":9}}"#,
        r#"{"type":"bonds","pairs":[[0,1]],"bath":{"type":"memory","rate":3,"coupling":2,"temperature":0}}"#,
    ];
    let particles = [
        r#"particles=[{"species":"A","count":200}]"#,
        r#"particles=[{"species":"A","count":200},{"species":"B","count":50,"mass":2.5}]"#,
        r#"particles=[{"species":"A","count":200},{"species":"B","count":50,"fixed":true}]"#,
    ];
    let layer = r#"{"species":"B","count":50,"placement":{"type":"behind-walls","axis":"AXIS","thickness":1}}"#;
    let layered = format!(r#"particles=[{{"species":"A","count":200}},{layer}]"#);
    let mut plans = Vec::new();
    for space in spaces.iter().copied().chain([r#"space={"box":[900],"walls":{"x":{}}}"#]) {
        let axis = ["x", "y", "z"].into_iter().find(|axis| space.contains(&format!(r#""{axis}":{{"#))).unwrap_or("x");
        let layered = layered.replace("AXIS", axis);
        let particles: Vec<&str> = particles.into_iter().chain([layered.as_str()]).collect();
        let edges = [("[9,7,8]", "[1,2,-3]"), ("[900]", "[1]")];
        let force = edges.iter().find(|(edges, _)| space.contains(edges)).map_or("[1,2]", |(_, force)| force);
        let all = others.iter().flat_map(|others| particles.iter().map(move |particles| (others, *particles)));
        for (others, particles) in all {
            let interactions = format!("interactions=[{}]", others.replace("[1,2]", force));
            let integrator = r#"integrator={"type":"cotter-reich"}"#;
            let changes = [particles, &interactions, space, integrator];
            plans.extend(plans_of(&changes.join(" "), &fluid(&changes), Options::default()));
            if !others.contains("langevin") && !others.contains("memory") && !others.contains("bonds") {
                for lambda in ["", r#","lambda":0.65"#] {
                    let integrator = format!(r#"integrator={{"type":"groot-warren"{lambda}}}"#);
                    let changes = [particles, &interactions, space, &integrator];
                    let options = Options { listed: true, ..Options::default() };
                    plans.extend(plans_of(&changes.join(" "), &fluid(&changes), options));
                }
            }
        }
    }
    plans
}

/// Pairs beside fixed particles, with bonds, baths in split steps, ranges of their own and a many-body repulsion.
fn porous_plans() -> Vec<(String, Plan)> {
    let particles =
        r#"particles=[{"species":"A","count":200,"chain":{"beads":2}},{"species":"B","count":50,"fixed":true}]"#;
    let bonds = r#",{"type":"bonds","friction":2,"potential":{"type":"harmonic","stiffness":9}},
        {"type":"langevin","friction":1},{"type":"tether","stiffness":1}"#;
    let spared = r#",{"type":"bonds","potential":{"type":"harmonic","stiffness":9},"exclude_repulsion":true}"#;
    let interactions = [
        r#"{"type":"dpd","repulsion":25,"friction":4.5}"#,
        r#"{"type":"dpd","repulsion":25}"#,
        r#"{"type":"dpd","repulsion":25,"friction":4.5,"pairs":[{"between":["A","B"],"cutoff":0.8}]}"#,
        r#"{"type":"dpd","repulsion":-40,"friction":4.5,"many_body":{"repulsion":25}}"#,
    ];
    let acting = r#",{"type":"langevin","friction":1,"bath":{"type":"memory","rate":3}},
        {"type":"coloured-noise","strength":1,"time":0.1}"#;
    let profiles = r#"output.profiles={"axis":"x","every":2,"quantities":["density","velocity","temperature"]}"#;
    let mut plans = Vec::new();
    // Of one of several ranks, in steps that are not split.
    for (space, parts) in [("space.box=[9,24]", [1, 2, 1]), ("space.box=[7,8,24]", [1, 1, 2])] {
        let bathed = r#"interactions=[{"type":"dpd","repulsion":25,"friction":4.5},{"type":"langevin","friction":1},
            {"type":"tether","stiffness":1}]"#;
        let changes = ["time.steps=1000", space, r#"integrator={"type":"cotter-reich"}"#, bathed, particles];
        for traversal in [Traversal::Rows, Traversal::Clusters] {
            let part = Some(Part { division: Division { parts }, rank: 1 });
            let options = Options { traversal: Some(traversal), part, ..Options::default() };
            plans.extend(plans_of(&format!("{} {traversal:?} shared", changes.join(" ")), &fluid(&changes), options));
        }
    }
    for (row, pairs) in interactions.iter().enumerate() {
        for (column, space) in [
            "space.box=[9,7]",
            "space.box=[9,7,8]",
            r#"space={"box":[9,7],"walls":{"y":{}}}"#,
            r#"space={"box":[9,7,8],"walls":{"z":{}}}"#,
        ]
        .into_iter()
        .enumerate()
        {
            for (number, integrator) in INTEGRATORS.iter().enumerate() {
                let splits = integrator.contains("splitting") && column < 2;
                let excluding = if row == 3 { "" } else { spared };
                let bathed = if integrator.contains("cotter-reich") { acting } else { "" };
                for others in ["", excluding, bathed, bonds].into_iter().filter(|others| splits || *others != bonds) {
                    let interactions = format!("interactions=[{pairs}{others}]");
                    let changes = [particles, &interactions, space, integrator, "time.steps=1000", profiles];
                    let changes =
                        if others.is_empty() { [&changes[..], &OF_MOTION].concat() } else { changes.to_vec() };
                    plans.extend(plans_in_turn(row + column + number, &changes));
                }
            }
        }
    }
    plans
}

/// Pairs beside frozen particles behind walls, with bonds, body forces, ranges of their own and profiles.
fn layered_plans() -> Vec<(String, Plan)> {
    let layer = |axis: &str| {
        format!(
            r#"particles=[{{"species":"A","count":200}},
                {{"species":"B","count":40,"placement":{{"type":"behind-walls","axis":"{axis}","thickness":1}}}}]"#
        )
    };
    let spaces = [
        (r#"space={"box":[9,7],"walls":{"y":{"upper_velocity":[1,0]}}}"#, "y"),
        (r#"space={"box":[9,7,8],"walls":{"x":{"reflection":"specular"},"z":{"upper_velocity":[0,1,0]}}}"#, "z"),
        (r#"space={"box":[9,7,8],"walls":{"x":{}}}"#, "x"),
    ];
    let bonds = r#",{"type":"bonds","pairs":[[0,1]],"potential":{"type":"harmonic","stiffness":9}}"#;
    let own = r#","pairs":[{"between":["A","B"],"cutoff":0.8,"weight_exponent":1}]"#;
    let mut plans = Vec::new();
    for (space, axis) in spaces {
        let components = if space.contains("[9,7]") { "[1,2]" } else { "[1,2,-3]" };
        let others = format!(r#"{bonds},{{"type":"body-force","force":{components}}}"#);
        let profiles = format!(
            r#"output.profiles={{"axis":"{axis}","every":2,"quantities":["density","velocity","temperature"]}}"#
        );
        for (ranges, others) in [("", ""), (own, ""), ("", others.as_str())] {
            let interactions =
                format!(r#"interactions=[{{"type":"dpd","repulsion":25,"friction":4.5{ranges}}}{others}]"#);
            for integrator in INTEGRATORS {
                for traversal in [None, Some(Traversal::Rows)] {
                    let changes = [&layer(axis), &interactions, space, integrator, "time.steps=1000", &profiles];
                    let changes =
                        if others.is_empty() { [&changes[..], &OF_MOTION].concat() } else { changes.to_vec() };
                    let options = Options { traversal, ..Options::default() };
                    plans.extend(plans_of(&changes.join(" "), &fluid(&changes), options));
                }
            }
        }
    }
    plans
}

/// Pairs and chains in boxes whose boundaries shear. Some analyses take none.
fn sheared_plans() -> Vec<(String, Plan)> {
    let particles = [
        r#"particles=[{"species":"A","count":200}]"#,
        r#"particles=[{"species":"A","count":200},{"species":"B","count":50,"mass":2.5}]"#,
        r#"particles=[{"species":"A","count":200},{"species":"B","count":50}]"#,
    ];
    let spaces = [
        r#"space={"box":[9,7],"shear":{"rate":0.2,"gradient":"y"}}"#,
        r#"space={"box":[9,7,8],"shear":{"rate":-0.2,"gradient":"y"}}"#,
        r#"space={"box":[2,7,3],"shear":{"rate":0.2,"gradient":"z"}}"#,
    ];
    let bonds = r#",{"type":"bonds","pairs":[[0,1]],"potential":{"type":"harmonic","stiffness":9}},
        {"type":"angles","triples":[[0,1,2]],"stiffness":3}"#;
    let mut plans = Vec::new();
    for particles in particles {
        for space in spaces {
            for others in ["", bonds] {
                // Beside bonds also forces that depend on local densities.
                let dense = if others.is_empty() { "" } else { r#","many_body":{"repulsion":9}"# };
                let pairs = format!(r#"{{"type":"dpd","repulsion":25,"friction":4.5{dense}}}"#);
                let interactions = format!("interactions=[{pairs}{others}]");
                for integrator in INTEGRATORS {
                    let alone = fluid(&[particles, "interactions=[]", space, integrator]);
                    plans.extend(plans_of(&format!("alone {space} {integrator}"), &alone, Options::default()));
                    for traversal in [Traversal::Rows, Traversal::Clusters] {
                        let stress = r#"output.stress={"every":2}"#;
                        let changes = [particles, interactions.as_str(), space, integrator, stress];
                        let options = Options { traversal: Some(traversal), ..Options::default() };
                        let name = format!("{} {traversal:?}", changes.join(" "));
                        plans.extend(plans_of(&name, &fluid(&changes), options));
                    }
                }
            }
        }
    }
    let chain = r#"particles=[{"species":"A","count":200,"chain":{"beads":4}},{"species":"B","count":50,"mass":2.5}]"#;
    let springs = r#"{"type":"bonds","potential":{"type":"harmonic","stiffness":9}}"#;
    for (row, space) in spaces.into_iter().enumerate() {
        let components = if space.contains("[9,7]") { "[1,2]" } else { "[1,2,-3]" };
        for (column, profile) in
            ["", r#","profile":"opposed","axis":"y""#, r#","profile":"sinusoidal","axis":"y""#].into_iter().enumerate()
        {
            let force = format!(r#"{{"type":"body-force","force":{components}{profile}}}"#);
            let pairs = r#"{"type":"dpd","repulsion":25,"friction":4.5}"#;
            let interactions = format!("interactions=[{pairs},{springs},{force}]");
            for (number, integrator) in INTEGRATORS.iter().enumerate() {
                let sizes = r#"output.chain_sizes={"every":2}"#;
                plans.extend(plans_in_turn(row + column + number, &[chain, &interactions, space, integrator, sizes]));
            }
        }
    }
    plans
}

/// The same beside lists of neighbours, baths and random forces; and baths along bonds beside local densities.
fn sheared_coupled_plans() -> Vec<(String, Plan)> {
    let particles = [
        r#"particles=[{"species":"A","count":200}]"#,
        r#"particles=[{"species":"A","count":200},{"species":"B","count":50,"mass":2.5}]"#,
    ];
    let sheared = [
        r#"space={"box":[9,7],"shear":{"rate":0.2,"gradient":"y"}}"#,
        r#"space={"box":[9,7,8],"shear":{"rate":-0.2,"gradient":"z"}}"#,
    ];
    let bonds = |more: &str| {
        format!(r#"{{"type":"bonds","pairs":[[0,1]],"potential":{{"type":"harmonic","stiffness":9}}{more}}}"#)
    };
    let rubbing = bonds(r#","friction":1"#);
    let excluding = bonds(r#","exclude_repulsion":true"#);
    let remembering = bonds(r#","friction":1,"bath":{"type":"memory","rate":3}"#);
    let dpd = r#"{"type":"dpd","repulsion":25,"friction":4.5}"#;
    let memory = r#"{"type":"dpd","repulsion":25,"friction":4.5,"bath":{"type":"memory","rate":3}}"#;
    let dense = r#"{"type":"dpd","repulsion":-40,"friction":4.5,"many_body":{"repulsion":25}}"#;
    let white = r#"{"type":"langevin","friction":1}"#;
    let white_in_box = r#"{"type":"langevin","friction":1,"velocity":"laboratory"}"#;
    let slow = r#"{"type":"langevin","friction":1,"bath":{"type":"memory","rate":3}}"#;
    let noise = r#"{"type":"coloured-noise","strength":1,"time":0.1}"#;
    let remembers = [
        memory.to_owned(),
        format!("{memory},{excluding}"),
        format!("{dpd},{slow}"),
        slow.to_owned(),
        format!("{dpd},{remembering}"),
    ];
    let forgets = [
        format!("{dpd},{white}"),
        format!("{dpd},{white_in_box}"),
        format!("{dpd},{rubbing}"),
        rubbing.clone(),
        white.to_owned(),
    ];
    let kicked = [format!("{dpd},{noise}"), noise.to_owned(), format!("{dpd},{noise},{excluding}")];
    let beside_densities = [format!("{dense},{rubbing}"), format!("{dense},{remembering}")];
    let at_rest = ["space.box=[9,7]", "space.box=[9,7,8]"];
    let not_split = || INTEGRATORS.iter().filter(|integrator| !integrator.contains("splitting"));
    let stress = r#"output.stress={"every":2}"#;
    let mut scenes: Vec<[&str; 4]> = Vec::new();
    for particles in particles {
        for space in sheared {
            scenes.extend(remembers.iter().map(|others| [particles, space, others, COTTER_REICH]));
            for integrator in INTEGRATORS {
                scenes.extend(forgets.iter().map(|others| [particles, space, others, integrator]));
            }
            for integrator in INTEGRATORS {
                scenes.extend(kicked.iter().map(|others| [particles, space, others, integrator]));
            }
            for integrator in [SPLITTING, STAGED] {
                scenes.extend(remembers[2..].iter().map(|others| [particles, space, others, integrator]));
            }
        }
        for space in at_rest {
            for integrator in not_split() {
                let densities = beside_densities
                    .iter()
                    .filter(|others| !others.contains("memory") || integrator.contains("cotter-reich"));
                let all = densities.chain(&forgets[2..]);
                scenes.extend(all.map(|others| [particles, space, others, *integrator]));
            }
        }
    }
    let mut plans = Vec::new();
    for (number, [particles, space, others, integrator]) in scenes.into_iter().enumerate() {
        let interactions = format!("interactions=[{others}]");
        // Forces from places in space have no stress.
        let measured = if others.contains("langevin") || others.contains("noise") { "time.steps=1000" } else { stress };
        let changes = [particles, &interactions, space, integrator, measured];
        plans.extend(plans_in_turn(number, &changes));
    }
    plans
}

/// Baths with memory and random forces in split steps.
fn kicked_plans() -> Vec<(String, Plan)> {
    let bonds = |bath: &str| {
        format!(
            r#"{{"type":"bonds","pairs":[[0,1]],"potential":{{"type":"harmonic","stiffness":9}},"friction":1{bath}}}"#
        )
    };
    let remembering = bonds(r#","bath":{"type":"memory","rate":3}"#);
    let rubbing = bonds("");
    let slow = r#"{"type":"langevin","friction":1,"bath":{"type":"memory","rate":3}}"#;
    let cold = r#"{"type":"langevin","friction":1,"bath":{"type":"memory","rate":3,"temperature":0}}"#;
    let white = r#"{"type":"langevin","friction":1}"#;
    let noise = r#"{"type":"coloured-noise","strength":1,"time":0.1}"#;
    let tether = r#"{"type":"tether","stiffness":3}"#;
    let pairs = [
        r#"{"type":"dpd","repulsion":25,"friction":4.5}"#,
        r#"{"type":"dpd","repulsion":-40,"friction":4.5,"many_body":{"repulsion":25}}"#,
    ];
    let beside = [
        format!("{slow},{tether}"),
        cold.to_owned(),
        noise.to_owned(),
        remembering.clone(),
        format!("{noise},{remembering}"),
        format!("{slow},{noise}"),
    ];
    let dpd = r#"{"type":"dpd","repulsion":25}"#;
    let once = [
        format!("{dpd},{white},{noise},{remembering}"),
        format!("{dpd},{slow},{rubbing}"),
        format!("{white},{noise},{remembering}"),
        format!("{slow},{rubbing},{tether}"),
    ];
    let interactions: Vec<String> = pairs
        .iter()
        .flat_map(|pairs| beside.iter().map(move |beside| format!("{pairs},{beside}")))
        .chain(once)
        .collect();
    let particles = [
        r#"particles=[{"species":"A","count":200}]"#,
        r#"particles=[{"species":"A","count":200},{"species":"B","count":50,"mass":2.5}]"#,
    ];
    let spaces = ["space.box=[9,7]", "space.box=[9,7,8]", r#"space={"box":[9,7,8],"walls":{"z":{}}}"#];
    let mut plans = Vec::new();
    for (number, interactions) in interactions.iter().enumerate() {
        for particles in particles {
            // Tethers do not go with walls.
            let spaces = if interactions.contains("tether") { &spaces[..2] } else { &spaces };
            for (place, space) in spaces.iter().enumerate() {
                for integrator in [SPLITTING, STAGED] {
                    let forces = r#"output.histograms=[{"quantity":"acceleration","every":2}]"#;
                    let measured = if (number + place) % 2 == 0 { forces } else { "time.steps=1000" };
                    let interactions = format!("interactions=[{interactions}]");
                    let changes = [particles, &interactions, space, integrator, measured];
                    plans.extend(plans_in_turn(number, &changes));
                }
            }
        }
    }
    plans
}

/// The same of couplings that add their impulses up.
fn coupled_plans() -> Vec<(String, Plan)> {
    let pairs = [
        "",
        r#"{"type":"dpd","repulsion":25,"friction":4.5}"#,
        r#"{"type":"dpd","friction":4.5,"weight_exponent":1,"bath":{"type":"white","temperature":0}}"#,
        r#"{"type":"dpd","repulsion":25}"#,
        r#"{"type":"dpd","repulsion":25,"friction":4.5,"bath":{"type":"memory","rate":3,"scheme":"symmetric"}}"#,
        r#"{"type":"dpd","weight_exponent":1,"bath":{"type":"memory","rate":0,"coupling":2,"temperature":0}}"#,
    ];
    let positions = [
        "",
        r#"{"type":"langevin","friction":1}"#,
        r#"{"type":"langevin","friction":1,"bath":{"type":"memory","rate":3}}"#,
        r#"{"type":"langevin","friction":1,"bath":{"type":"memory","rate":3,"temperature":0}}"#,
    ];
    let others = ["", r#"{"type":"tether","stiffness":2}"#];
    let mut interactions = Vec::new();
    for pair in pairs {
        for position in positions {
            for other in others {
                let all: Vec<&str> = [pair, position, other].into_iter().filter(|text| !text.is_empty()).collect();
                interactions.push(format!("interactions=[{}]", all.join(",")));
            }
        }
    }
    let particles = [
        r#"particles=[{"species":"A","count":200}]"#,
        r#"particles=[{"species":"A","count":200},{"species":"B","count":50,"mass":2.5}]"#,
        r#"particles=[{"species":"A","count":200},{"species":"B","count":50,"fixed":true}]"#,
    ];
    let mut plans = Vec::new();
    // Masses, baths, a random force and forces for an analysis at once.
    for all in ["", r#",{"type":"coloured-noise","strength":1,"time":0.1}"#] {
        let interactions = format!(
            r#"interactions=[{{"type":"dpd","repulsion":25,"friction":4.5,"bath":{{"type":"memory","rate":3}}}},
                {{"type":"langevin","friction":1,"bath":{{"type":"memory","rate":3}}}}{all}]"#
        );
        for particles in particles {
            // Where particles are held there is no stress to measure.
            let held: &[&str] = if particles.contains("fixed") {
                &["output.stress=null", r#"output.profiles={"axis":"x","every":2}"#]
            } else {
                &[]
            };
            let changes = [&[interactions.as_str(), particles], SAMPLERS, held].concat();
            plans.extend(plans_of(&changes.join(" "), &fluid(&changes), Options::default()));
        }
    }
    for (number, interactions) in interactions.iter().enumerate() {
        for particles in particles {
            for space in ["space.box=[9,7]", "space.box=[9,7,8]"] {
                let generator = ["pcg4d", "threefry2x32-20"][number % 2];
                let generator = format!(r#"noise={{"generator":"{generator}"}}"#);
                for integrator in ["cotter-reich", "groot-warren"] {
                    let white = !interactions.contains("langevin") && !interactions.contains("memory");
                    if integrator == "groot-warren" && !white {
                        continue;
                    }
                    let lambda = if integrator == "groot-warren" { r#","lambda":0.65"# } else { "" };
                    let integrator = format!(r#"integrator={{"type":"{integrator}"{lambda}}}"#);
                    let changes = [interactions.as_str(), particles, space, &generator, &integrator];
                    let options =
                        Options { listed: true, many_level_scan: generator.contains("pcg"), ..Options::default() };
                    plans.extend(plans_of(&changes.join(" "), &fluid(&changes), options));
                }
            }
        }
    }
    plans
}

/// Split steps with baths without memory on particles and along bonds: alone, and with pairs that have friction and
/// that have none.
fn relaxed_plans() -> Vec<(String, Plan)> {
    let pairs = ["", r#",{"type":"dpd","repulsion":25}"#, r#",{"type":"dpd","repulsion":25,"friction":4.5}"#];
    let bonds =
        r#",{"type":"bonds","potential":{"type":"harmonic","stiffness":9}},{"type":"body-force","force":[1,2]}"#;
    let tether = r#",{"type":"tether","stiffness":9}"#;
    let rubbing = "friction along bonds";
    let particles = [
        r#"particles=[{"species":"A","count":200,"chain":{"beads":2}}]"#,
        r#"particles=[{"species":"A","count":200,"chain":{"beads":2}},{"species":"B","count":50,"mass":2.5}]"#,
    ];
    let baths = [
        (r#""bath":{"type":"white"}"#, r#"noise={"generator":"pcg4d"}"#),
        (r#""bath":{"type":"white"}"#, r#"noise={"generator":"threefry2x32-20"}"#),
        (r#""bath":{"type":"white","temperature":0}"#, r#"noise={"generator":"pcg4d"}"#),
    ];
    let mut plans = Vec::new();
    let all = pairs.iter().flat_map(|pair| particles.map(|particles| (pair, particles)));
    for (number, (pair, particles)) in all.enumerate() {
        for (space, more) in [
            ("space.box=[9,7]", ""),
            ("space.box=[9,7]", bonds),
            ("space.box=[9,7,8]", ""),
            ("space.box=[9,7,8]", tether),
            ("space.box=[9,7,8]", rubbing),
        ] {
            // What is tied to places has no stress to measure.
            let samplers = if more == tether { &SAMPLERS[..6] } else { SAMPLERS };
            let (bath, noise) = baths[number % 3];
            let interactions = if more == rubbing {
                format!(r#"interactions=[{{"type":"bonds","friction":1,{bath}}}{pair}]"#)
            } else {
                format!(r#"interactions=[{{"type":"langevin","friction":1,{bath}}}{pair}{more}]"#)
            };
            for (samplers, integrator) in [(&[][..], SPLITTING), (samplers, SPLITTING), (samplers, STAGED)] {
                let changes = [&[interactions.as_str(), particles, space, noise, integrator], samplers].concat();
                for traversal in [Traversal::Rows, Traversal::Clusters] {
                    let options = Options { traversal: Some(traversal), ..Options::default() };
                    let name = format!("{} {traversal:?}", changes.join(" "));
                    plans.extend(plans_of(&name, &fluid(&changes), options));
                }
            }
        }
    }
    plans
}

/// The same of bonds and angles, alone and among pairs, on a line, in the plane and in space.
fn bond_plans() -> Vec<(String, Plan)> {
    let memory = r#""friction":2,"bath":{"type":"memory","rate":3}"#;
    let harmonic = r#""potential":{"type":"harmonic","stiffness":9}"#;
    let fene = r#""potential":{"type":"fene","stiffness":9,"extent":4}"#;
    let bonds = [
        r#"{"type":"bonds"}"#.to_owned(),
        format!(r#"{{"type":"bonds",{harmonic}}}"#),
        format!(r#"{{"type":"bonds",{fene},{memory}}}"#),
        format!(r#"{{"type":"bonds",{harmonic},"friction":2,"exclude_repulsion":true}}"#),
        r#"{"type":"bonds","friction":2,"bath":{"type":"white","temperature":0}}"#.to_owned(),
        format!(r#"{{"type":"bonds",{memory}}},{{"type":"angles","stiffness":2}}"#),
    ];
    let others = [
        "",
        r#",{"type":"dpd","repulsion":25,"friction":4.5,"bath":{"type":"memory","rate":3}}"#,
        r#",{"type":"langevin","friction":1,"bath":{"type":"memory","rate":3}},{"type":"tether","stiffness":1}"#,
    ];
    let groups = [
        r#"particles=[{"species":"A","count":60,"chain":{"beads":3}}]"#,
        r#"particles=[{"species":"A","count":60,"chain":{"beads":3}},{"species":"B","count":9,"fixed":true}]"#,
    ];
    let integrator = r#"integrator={"type":"cotter-reich"}"#;
    let mut plans = Vec::new();
    for bonds in [
        &bonds[0],
        &bonds[1],
        r#"{"type":"bonds","exclude_repulsion":true}"#,
        &format!(r#"{{"type":"bonds",{fene},"exclude_repulsion":true}},{{"type":"angles","stiffness":2}}"#),
    ] {
        for other in ["", r#",{"type":"dpd","repulsion":25,"friction":4.5}"#] {
            for species in ["", r#",{"species":"B","count":9,"mass":2}"#] {
                let particles = format!(r#"particles=[{{"species":"A","count":60,"chain":{{"beads":3}}}}{species}]"#);
                let interactions = format!("interactions=[{bonds}{other}]");
                for space in ["space.box=[19,17]", "space.box=[9,10,11]"] {
                    for integrator in INTEGRATORS {
                        let output = r#"output={"chain_sizes":{"every":1},"stress":{"every":1},"autocorrelations":[{"quantity":"force","every":2,"window":4},{"quantity":"velocity","every":2,"window":4}]}"#;
                        let changes = [&particles, &interactions, space, integrator, output, "time.steps=8"];
                        plans.extend(plans_of(&changes.join(" "), &fluid(&changes), Options::default()));
                    }
                }
            }
        }
    }
    // Bonds with a largest force.
    for integrator in INTEGRATORS {
        for other in ["", r#","friction":2"#] {
            let interactions = format!(
                r#"interactions=[{{"type":"dpd","repulsion":25,"friction":4.5}},{{"type":"bonds",{fene}{other}}}]"#
            );
            let output = r#"output={"stress":{"every":1}}"#;
            let changes = [groups[0], &interactions, integrator, "push_off=50", output, "time.steps=8"];
            plans.extend(plans_of(&changes.join(" "), &fluid(&changes), Options::default()));
        }
    }
    // Sizes of molecules, whose bonds are listed.
    let molecules = r#"molecules=[{"beads":["A","A","A"],"bonds":[[0,1],[1,2]],"count":20}]"#;
    let species = r#"particles=[{"species":"A"}]"#;
    let sizes = r#"output={"chain_sizes":{"every":1}}"#;
    for space in [
        "space.box=[900]",
        "space.box=[19,17]",
        "space.box=[9,10,11]",
        r#"space={"box":[900],"walls":{"x":{}}}"#,
        r#"space={"box":[19,17],"walls":{"y":{}}}"#,
        r#"space={"box":[9,10,11],"walls":{"y":{}}}"#,
        r#"space={"box":[19,17],"shear":{"rate":0.2,"gradient":"y"}}"#,
        r#"space={"box":[9,10,11],"shear":{"rate":0.2,"gradient":"y"}}"#,
    ] {
        let line = space.contains("900");
        for integrator in INTEGRATORS.iter().filter(|integrator| !line || !integrator.contains("splitting")) {
            let interactions = r#"interactions=[{"type":"dpd","repulsion":25,"friction":4.5},
                {"type":"bonds","potential":{"type":"harmonic","stiffness":9}}]"#;
            let changes = [species, molecules, interactions, space, *integrator, sizes, "time.steps=8"];
            plans.extend(plans_of(&changes.join(" "), &fluid(&changes), Options::default()));
        }
    }
    for (number, bonds) in bonds.iter().enumerate() {
        for other in others {
            for particles in groups {
                for space in ["space.box=[90]", "space.box=[19,17]", "space.box=[9,10,11]"] {
                    let generator = ["pcg4d", "threefry2x32-20"][number % 2];
                    let interactions = format!("interactions=[{bonds}{other}]");
                    let generator = format!(r#"noise={{"generator":"{generator}"}}"#);
                    let output = r#"output={"chain_sizes":{"every":1},"trajectory":{"every":1},"radial_distribution":{"every":9,"range":1.1}}"#;
                    let changes = [particles, &interactions, space, &generator, integrator, output];
                    plans.extend(plans_of(&changes.join(" "), &fluid(&changes), Options::default()));
                }
            }
        }
    }
    plans
}

/// The same of coloured noise, by itself and beside another bath that draws random numbers in the same kernel.
fn noise_plans() -> Vec<(String, Plan)> {
    let mut plans = Vec::new();
    for process in ["kangaroo", "kangaroo-exponential", "short", "literal"] {
        for space in ["space.box=[900]", "space.box=[9,7]", "space.box=[9,7,8]"] {
            if process == "literal" && space != "space.box=[9,7]" {
                continue;
            }
            for generator in ["pcg4d", "threefry2x32-20"] {
                for others in ["", r#",{"type":"langevin","friction":1}"#, r#",{"type":"dpd","friction":4.5}"#] {
                    let noise = format!(r#"{{"type":"coloured-noise","strength":2,"time":0.1,"process":"{process}"}}"#);
                    let interactions = format!("interactions=[{noise}{others}]");
                    let generator = format!(r#"noise={{"generator":"{generator}"}}"#);
                    let integrator = r#"integrator={"type":"cotter-reich"}"#;
                    let changes =
                        [r#"particles=[{"species":"A","count":200}]"#, &interactions, space, &generator, integrator];
                    plans.extend(plans_of(&changes.join(" "), &fluid(&changes), Options::default()));
                }
            }
        }
    }
    plans
}

/// The same of Voronoi cells.
fn voronoi_plans() -> Vec<(String, Plan)> {
    let choices: [&[&[&str]]; 6] = [
        &[&["interactions.0.form=gradient"], &["interactions.0.form=consistent"], &["interactions.0.form=paper"]],
        &[&["integrator.type=splitting"], &["integrator.type=euler"]],
        &[&[], &["interactions.0.energy={}"], &[r#"interactions.0.energy={"conductivity":0}"#]],
        &[&[], &["interactions.0.viscosity=0"]],
        &[&[], &["temperature=0"]],
        &[&[], VORONOI_SAMPLERS],
    ];
    let mut combinations: Vec<Vec<&str>> = vec![Vec::new()];
    for choice in choices {
        combinations = combinations
            .iter()
            .flat_map(|combination| choice.iter().map(|more| [combination.as_slice(), more].concat()))
            .collect();
    }
    let mut plans = Vec::new();
    for changes in combinations {
        // One workgroup solves for the friction of few cells.
        for (count, many_level_scan, list_growth) in [(200, false, 0), (5000, true, 1)] {
            let options = Options { many_level_scan, list_growth, ..Options::default() };
            let name = format!("{count} Voronoi cells {} {options:?}", changes.join(" "));
            plans.extend(plans_of(&name, &cells(count, &changes), options));
        }
    }
    let options = Options { list_growth: 2, ..Options::default() };
    plans.extend(plans_of("Voronoi cells of many corners", &cells(200, &[]), options));
    plans.extend(plans_of("a great many Voronoi cells", &cells(70_000, &[]), Options::default()));
    plans
}

const VORONOI_SAMPLERS: &[&str] = &[
    "time.steps=1000",
    r#"output.diffusion={"every":2,"window":8}"#,
    r#"output.viscosity={"every":2,"window":8}"#,
    r#"output.autocorrelations=[{"quantity":"velocity","every":2,"window":8}]"#,
    r#"output.histograms=[{"quantity":"velocity","every":2,"axis":"x"},
        {"quantity":"speed","every":2,"frame":"centre-of-mass"}]"#,
    r#"output.profiles={"axis":"y","every":2}"#,
];

/// The same of shallow water.
fn water_plans() -> Vec<(String, Plan)> {
    let choices: [&[&[&str]]; 6] = [
        &[&["integrator.type=gyro"], &["integrator.type=rotate"]],
        &[&[], &["interactions.0.rotation=0", r#"particles.0.velocities={"type":"rest"}"#]],
        &[&[], &["interactions.0.spline_order=1"], &["interactions.0.spline_order=2"]],
        &[
            &[],
            &[r#"interactions.0.bath={"type":"memory","epsilon":1}"#],
            &[r#"interactions.0.bath={"type":"white"}"#, "temperature=0.01"],
        ],
        &[
            &[],
            &["interactions.0.smoothing.power=2"],
            &[r#"interactions.0.smoothing.solver={"type":"fft","symbol":"spectral"}"#, "interactions.0.mesh=[32,8]"],
            &[r#"interactions.0.smoothing.solver={"type":"chebyshev","tolerance":0.1}"#],
            &[
                r#"interactions.0.smoothing={"length":0.3,"power":2,"solver":{"type":"chebyshev","tolerance":0.1}}"#,
                "interactions.0.mesh=[15,12]",
            ],
            &["interactions.0.smoothing.length=0"],
        ],
        &[&[], &[WATER_TRACERS, r#"output.trajectory={"every":5}"#]],
    ];
    let mut combinations: Vec<Vec<&str>> = vec![Vec::new()];
    for choice in choices {
        let more = |combination: &Vec<&'static str>| {
            choice.iter().map(|changes| [combination, *changes].concat()).collect::<Vec<_>>()
        };
        combinations = combinations.iter().flat_map(more).collect();
    }
    // The narrowest mesh, on which only the lowest splines have room, and a long line; the longest that is transformed whole.
    combinations.push(vec!["interactions.0.spline_order=1", "interactions.0.mesh=[2,128]"]);
    combinations.push(vec!["interactions.0.mesh=[4,64]"]);
    combinations.push(vec!["interactions.0.mesh=[64,4]"]);
    combinations.push(vec!["interactions.0.mesh=[1024,32]"]);
    combinations.push(vec!["interactions.0.mesh=[8,1024]"]);
    let mut plans = Vec::new();
    for changes in combinations {
        // A bath takes its scales from the smoothing.
        let both = |change: &str| changes.iter().any(|known| known.starts_with(change));
        if both("interactions.0.smoothing.length=0") && both("interactions.0.bath") {
            continue;
        }
        let scene = water(&changes);
        for storage in [Storage::Sorted, Storage::Bins] {
            for (traversal, many_level_scan) in [(Traversal::Rows, false), (Traversal::Clusters, true)] {
                let traversal = Some(traversal);
                let options = Options { storage: Some(storage), traversal, many_level_scan, ..Options::default() };
                let name = format!("water {} {storage:?} {traversal:?} {many_level_scan}", changes.join(" "));
                plans.extend(plans_of(&name, &scene, options));
            }
        }
    }
    plans
}

const WATER_TRACERS: &str = r#"particles=[{"species":"water","count":500,"velocities":{"type":"rest"}},
    {"species":"loop","count":100,"tracer":true,"placement":{"type":"circle","center":[1,1],"radius":0.5}}]"#;

/// An entry point and the variants chosen for it.
type Source = (Entry, Choices);

/// The texts of all kernels of all plans, or why they do not link.
fn texts() -> &'static HashMap<Source, Result<LinkedText, String>> {
    static TEXTS: OnceLock<HashMap<Source, Result<LinkedText, String>>> = OnceLock::new();
    TEXTS.get_or_init(|| {
        let kernels = plans().iter().flat_map(|(_, plan)| &plan.kernels);
        let sources: BTreeSet<Source> = kernels.map(|kernel| (kernel.entry, kernel.choices.clone())).collect();
        let sources: Vec<Source> = sources.into_iter().collect();
        in_shares(&sources, |source| {
            let linked = linked_text(source.0, &source.1);
            (source.clone(), linked.map_err(|unlinked| format!("{}: {}", unlinked.place, unlinked.reason)))
        })
        .into_iter()
        .collect()
    })
}

/// The text of a kernel.
pub fn text(kernel: &Kernel) -> &'static str {
    &texts()[&(kernel.entry, kernel.choices.clone())]
        .as_ref()
        .expect("every_kernel_links lists what does not link")
        .text
}

/// What some threads make of all things, as many as there are cores.
fn in_shares<T: Sync, U: Send>(things: &[T], make: impl Fn(&T) -> U + Sync) -> Vec<U> {
    let threads = thread::available_parallelism().map_or(1, NonZero::get);
    let make = &make;
    thread::scope(|scope| {
        let shares = things.chunks(things.len().div_ceil(threads).max(1));
        let workers: Vec<_> = shares.map(|share| scope.spawn(|| share.iter().map(make).collect::<Vec<_>>())).collect();
        workers.into_iter().flat_map(|worker| worker.join().unwrap()).collect()
    })
}

/// All distinct texts, parsed and validated.
fn linked() -> &'static HashMap<&'static str, Result<LinkedShader, String>> {
    static LINKED: OnceLock<HashMap<&'static str, Result<LinkedShader, String>>> = OnceLock::new();
    LINKED.get_or_init(|| {
        let texts = texts().iter().filter_map(|((entry, _), text)| Some((text.as_ref().ok()?, *entry)));
        let distinct: BTreeMap<&'static str, (&'static LinkedText, Entry)> =
            texts.map(|(linked, entry)| (linked.text.as_str(), (linked, entry))).collect();
        let distinct: Vec<_> = distinct.into_iter().collect();
        in_shares(&distinct, |(text, (linked, entry))| {
            (*text, validate(entry.name(), entry.name(), linked).map_err(|error| error.to_string()))
        })
        .into_iter()
        .collect()
    })
}

pub fn shader(kernel: &Kernel) -> &'static LinkedShader {
    linked()[text(kernel)].as_ref().expect("every_kernel_links lists what does not link")
}

/// The rest of a kernel in a plan, where branches on constants are taken.
pub struct Specialized {
    pub bindings: Vec<Binding>,
    pub constants: Vec<Constant>,
}

impl Specialized {
    pub fn new(shader: &LinkedShader, constants: &[(Constant, f64)]) -> Self {
        let LinkedShader { bindings, constants, .. } = shader.specialized(constants);
        Self { bindings, constants }
    }
}

pub fn specialized(kernel: &Kernel, plan: &Plan) -> &'static Specialized {
    type Key = (usize, Switched);
    static KNOWN: OnceLock<Mutex<HashMap<Key, &'static Specialized>>> = OnceLock::new();
    let known = KNOWN.get_or_init(Mutex::default);
    let shader = shader(kernel);
    let constants: Vec<_> = kernel.constants_in(plan).collect();
    let key = (std::ptr::from_ref(shader).addr(), shader.switched(&constants));
    if let Some(specialized) = known.lock().unwrap().get(&key) {
        return specialized;
    }
    let specialized = Box::leak(Box::new(Specialized::new(shader, &constants)));
    known.lock().unwrap().entry(key).or_insert(specialized)
}

/// A text that is no part of the list, parsed and validated.
pub fn validated(entry: Entry, linked: &LinkedText) -> LinkedShader {
    validate(entry.name(), entry.name(), linked).unwrap()
}

/// Hashes of all kernels of the list.
pub fn hashes() -> BTreeSet<u64> {
    linked().values().map(|shader| hash_of_kernel(&shader.as_ref().unwrap().module)).collect()
}

/// Fails with all complaints, each once and with the first scene that caused it.
pub fn report(complaints: &BTreeMap<String, String>) {
    let list: Vec<String> =
        complaints.iter().map(|(complaint, scene)| format!("{complaint}\n    in {scene}")).collect();
    assert!(list.is_empty(), "{} complaints:\n{}", list.len(), list.join("\n"));
}

#[test]
fn every_kernel_links() {
    let unlinked = texts().values().filter_map(|text| text.as_ref().err());
    let failures: BTreeSet<&String> =
        unlinked.chain(linked().values().filter_map(|linked| linked.as_ref().err())).collect();
    let list: Vec<&str> = failures.iter().map(|failure| failure.as_str()).collect();
    assert!(list.is_empty(), "{} kernels do not link:\n{}", list.len(), list.join("\n"));
    // The enumeration is what gives this test its meaning: it may grow, but must not shrink unnoticed.
    assert!(linked().len() > 500, "only {} distinct kernels", linked().len());
}

fn load_constants(sources: &[Source]) {
    let failures = in_shares(sources, |(entry, choices)| {
        let found = link_loading(entry.name(), *entry, choices).map_err(|error| error.to_string());
        found.map(|shader| shader.loaded.len())
    });
    let wrong: BTreeSet<&String> = failures.iter().filter_map(|found| found.as_ref().err()).collect();
    assert!(wrong.is_empty(), "{} kernels do not link with constants in a buffer: {wrong:#?}", wrong.len());
    assert!(failures.iter().filter(|found| found.as_ref().is_ok_and(|count| *count > 0)).count() > sources.len() / 4);
}

/// Kernels whose constants lie in a buffer, some of all.
#[test]
fn kernels_load_constants() {
    let mut sources: Vec<Source> = texts().keys().cloned().collect();
    sources.sort();
    load_constants(&sources.into_iter().step_by(16).collect::<Vec<_>>());
}

#[test]
#[ignore = "validates all kernels once more: make validate"]
fn all_kernels_load_constants() {
    load_constants(&texts().keys().cloned().collect::<Vec<_>>());
}

/// Some scene asks for a kernel that comes to it: to every file, and to every name. A default may have been replaced wherever it
/// could be used, and not every variant's part of what its slot provides.
#[test]
fn every_file_and_name_can_be_asked_for() {
    let library = library().unwrap();
    let linked = texts().values().filter_map(|text| text.as_ref().ok());
    let reached: BTreeSet<(&str, u32)> =
        linked.flat_map(|linked| &linked.parts).map(|part| (part.path, part.line)).collect();
    let all = || library.files().iter().flat_map(|file| file.declarations.iter().map(|own| (file.path, own)));
    let names: BTreeSet<&str> =
        all().filter(|(path, own)| reached.contains(&(path, own.line))).map(|(_, own)| own.name).collect();
    let mut unused: Vec<String> = all()
        .filter(|(_, own)| !names.contains(own.name))
        .map(|(path, own)| format!("{path}.wgsl:{} `{}`", own.line, own.name))
        .collect();
    let files: BTreeSet<&str> = reached.iter().map(|(path, _)| *path).collect();
    unused.extend(library.files().iter().map(|file| file.path).filter(|path| !files.contains(path)).map(str::to_owned));
    assert!(unused.is_empty(), "no kernel comes to\n{}", unused.join("\n"));
}

/// One name has one meaning in the whole library, and nothing within a function hides it.
#[test]
fn names_have_one_meaning() {
    assert_eq!(library().unwrap().ambiguous(), [""; 0]);
    assert_eq!(library().unwrap().shadows(), [""; 0]);
}

#[test]
fn the_shaders_of_pictures_and_checks_are_valid() {
    let shaders = Path::new(env!("CARGO_MANIFEST_DIR")).join("shaders");
    let folders = ["plot", "check"].map(|folder| std::fs::read_dir(shaders.join(folder)).unwrap());
    let files: Vec<_> = folders.into_iter().flatten().map(|entry| entry.unwrap().path()).collect();
    assert!(!files.is_empty());
    let complaints: Vec<String> = (files.into_iter())
        .filter_map(|file| {
            let text = std::fs::read_to_string(&file).unwrap();
            let module = naga::front::wgsl::parse_str(&text).map_err(|error| error.emit_to_string(&text));
            let valid = module.and_then(|module| {
                naga::valid::Validator::new(naga::valid::ValidationFlags::all(), naga::valid::Capabilities::empty())
                    .validate(&module)
                    .map_err(|error| error.emit_to_string(&text))
            });
            valid.err().map(|error| format!("{}: {error}", file.display()))
        })
        .collect();
    assert!(complaints.is_empty(), "{}", complaints.join("\n"));
}

#[test]
fn every_constant_without_default_has_a_value_that_fits() {
    let mut complaints = BTreeMap::new();
    for (scene, plan) in plans() {
        for kernel in &plan.kernels {
            let module = &shader(kernel).module;
            let is_unused =
                |name: &str| !specialized(kernel, plan).constants.iter().any(|constant| constant.name() == name);
            for (_, constant) in module.overrides.iter() {
                let name = constant.name.as_deref().unwrap_or("?");
                let value = kernel.constants_in(plan).find(|(known, _)| known.name() == name).map(|(_, value)| value);
                let fits = match (value, &module.types[constant.ty].inner) {
                    (None, _) => constant.init.is_some() || is_unused(name),
                    (Some(value), naga::TypeInner::Scalar(naga::Scalar::F32)) => (value as f32).is_finite(),
                    (Some(value), naga::TypeInner::Scalar(naga::Scalar::U32)) => f64::from(value as u32) == value,
                    (Some(value), naga::TypeInner::Scalar(naga::Scalar::I32)) => f64::from(value as i32) == value,
                    (Some(_), other) => panic!("`{name}` has a type of its own: {other:?}"),
                };
                if !fits {
                    complaints
                        .entry(format!("`{name}` of kernel `{}` is {value:?}", kernel.name))
                        .or_insert(scene.clone());
                }
            }
        }
    }
    report(&complaints);
}

/// A kernel is given what kernels of its entry declare, with some variants at least, and no constant twice; and every constant is
/// given by some plan.
#[test]
fn constants_are_given_to_those_who_declare_them() {
    let mut complaints = BTreeMap::new();
    let mut given = BTreeSet::new();
    let declared: BTreeSet<(Entry, Constant)> = (plans().iter().flat_map(|(_, plan)| &plan.kernels))
        .flat_map(|kernel| shader(kernel).constants.iter().map(|constant| (kernel.entry, *constant)))
        .collect();
    for (scene, plan) in plans() {
        let mut complain = |complaint: String| {
            complaints.entry(complaint).or_insert(scene.clone());
        };
        for kernel in &plan.kernels {
            let own = &shader(kernel).constants;
            given.extend(kernel.constants_in(plan).map(|(constant, _)| constant).filter(|known| own.contains(known)));
            for (constant, _) in kernel.constants.iter().filter(|(own, _)| !declared.contains(&(kernel.entry, *own))) {
                complain(format!("kernel `{}` is given `{}`, which it never declares", kernel.name, constant.name()));
            }
            if let Some(constant) = repeated(&kernel.constants) {
                complain(format!("kernel `{}` is given `{}` twice", kernel.name, constant.name()));
            }
        }
        if let Some(constant) = repeated(&plan.constants) {
            complain(format!("`{}` is given twice to all kernels", constant.name()));
        }
    }
    report(&complaints);
    // A dispatch of so many workgroups is of no scene here.
    given.insert(Constant::Fold);
    let missing: Vec<&str> =
        Constant::ALL.iter().filter(|constant| !given.contains(constant)).map(|constant| constant.name()).collect();
    assert!(missing.is_empty(), "no plan sets {}", missing.join(", "));
}

/// A constant that has two values.
fn repeated(constants: &[(Constant, f64)]) -> Option<Constant> {
    let mut seen = BTreeSet::new();
    constants.iter().map(|(constant, _)| *constant).find(|constant| !seen.insert(*constant))
}

/// DirectX does not tell it to kernels whose number of workgroups a buffer says.
#[test]
fn no_kernel_asks_for_the_number_of_workgroups() {
    let asks = |shader: &LinkedShader| {
        let arguments = shader.module.entry_points.iter().flat_map(|entry| &entry.function.arguments);
        let workgroups = naga::Binding::BuiltIn(naga::BuiltIn::NumWorkGroups);
        arguments.into_iter().any(|argument| argument.binding.as_ref() == Some(&workgroups))
    };
    let kernels: BTreeSet<&&str> =
        linked().iter().filter(|(_, linked)| linked.as_ref().is_ok_and(asks)).map(|(text, _)| text).collect();
    assert!(kernels.is_empty(), "{} kernels: {kernels:?}", kernels.len());
}

#[test]
fn every_binding_has_its_buffer_and_every_buffer_a_kernel() {
    let mut complaints = BTreeMap::new();
    for (scene, plan) in plans() {
        let made = plan.buffers.iter().map(|buffer| (buffer.array, false));
        let arrays: BTreeMap<Array, bool> =
            made.chain(plan.textures.iter().map(|texture| (texture.array, true))).collect();
        if arrays.len() != plan.buffers.len() + plan.textures.len() {
            complaints.entry("two buffers or textures are the same array".to_owned()).or_insert(scene.clone());
        }
        let mut bound = BTreeSet::new();
        let storage = |kernel| specialized(kernel, plan).bindings.iter().filter(|binding| !binding.texture).count();
        let most = plan.kernels.iter().map(storage).max().unwrap_or(0);
        // What is in textures needs no buffers.
        let (asked, needed) = (plan.storage_buffers as usize, most.max(STORAGE_BUFFERS));
        if asked < needed || plan.textures.is_empty() && asked > needed {
            let complaint = format!("asks for {} storage buffers and binds {most}", plan.storage_buffers);
            complaints.entry(complaint).or_insert(scene.clone());
        }
        for kernel in &plan.kernels {
            let bindings = &specialized(kernel, plan).bindings;
            let mut complain = |complaint: String| {
                complaints.entry(format!("kernel `{}`: {complaint}", kernel.name)).or_insert(scene.clone());
            };
            if storage(kernel) > plan.storage_buffers as usize {
                let names: Vec<&str> = bindings.iter().map(|binding| binding.array.name()).collect();
                complain(format!("{} storage buffers among {}", storage(kernel), names.join(", ")));
            }
            let textures = bindings.len() - storage(kernel);
            if textures > STORAGE_TEXTURES {
                complain(format!("{textures} textures"));
            }
            if bindings.iter().map(|binding| binding.number).collect::<BTreeSet<_>>().len() != bindings.len() {
                complain("two of its buffers share a number".to_owned());
            }
            if bindings.iter().map(|binding| kernel.array_of(binding.array)).collect::<BTreeSet<_>>().len()
                != bindings.len()
            {
                complain("two of its variables are the same buffer".to_owned());
            }
            for binding in bindings {
                let array = kernel.array_of(binding.array);
                let name = array.name();
                match arrays.get(&array) {
                    Some(texture) if *texture == binding.texture => drop(bound.insert(array)),
                    Some(_) => complain(format!("`{name}` is a texture in the plan or in the kernel, but not in both")),
                    None => complain(format!("the plan has no buffer `{name}`")),
                }
            }
        }
        for array in arrays.keys().filter(|array| !bound.contains(array)) {
            complaints.entry(format!("no kernel uses buffer `{}`", array.name())).or_insert(scene.clone());
        }
    }
    report(&complaints);
}

/// No kernel has two names for one buffer: what it only loads by one name it might store into by the other.
#[test]
fn no_kernel_binds_a_buffer_twice() {
    let mut complaints = BTreeMap::new();
    for (scene, plan) in plans() {
        for kernel in plan.kernels.iter().filter(|kernel| !kernel.renamed.is_empty()) {
            let mut bound = BTreeSet::new();
            for binding in &specialized(kernel, plan).bindings {
                let array = kernel.array_of(binding.array);
                if !bound.insert(array) {
                    let complaint = format!("kernel `{}` binds `{}` twice", kernel.name, array.name());
                    complaints.entry(complaint).or_insert(scene.clone());
                }
            }
        }
    }
    report(&complaints);
}

#[test]
fn rows_of_texels_are_as_long_in_plans_as_in_shaders() {
    let said = format!("const TEXELS_IN_ROW: u32 = {}u;", Texture::ROW);
    assert!(include_str!("../../shaders/core/texels.wgsl").contains(&said), "{said}");
    let textures: Vec<&Texture> = plans().iter().flat_map(|(_, plan)| &plan.textures).collect();
    assert!(!textures.is_empty());
    for texture in textures {
        let [width, height] = texture.size.map(u64::from);
        assert!(width == Texture::ROW || width < Texture::ROW && height == 1, "{texture:?}");
        assert!(texture.row_bytes().is_multiple_of(256) && Texture::holds(width * height, texture.words));
    }
}

#[test]
fn every_kernel_of_a_plan_runs() {
    let mut complaints = BTreeMap::new();
    for (scene, plan) in plans() {
        let samplers = plan.samplers.iter().map(|sampler| &sampler.kernels);
        let begin = [&plan.prepare, &plan.sort, &plan.tidy, &plan.before_report];
        let lists = begin.into_iter().chain([&plan.report, &plan.finish_report, &plan.advance, &plan.paths.kernels]);
        let run: BTreeSet<usize> = lists.chain(samplers).flatten().copied().collect();
        for (index, kernel) in plan.kernels.iter().enumerate().filter(|(index, _)| !run.contains(index)) {
            complaints.entry(format!("kernel {index}, `{}`, is never run", kernel.name)).or_insert(scene.clone());
        }
    }
    report(&complaints);
}

#[test]
fn workgroup_memory_stays_within_the_core_limit() {
    for (scene, plan) in plans() {
        for kernel in &plan.kernels {
            let module = &shader(kernel).module;
            let context = module.to_ctx();
            let bytes: u32 = module
                .global_variables
                .iter()
                .filter(|(_, variable)| variable.space == naga::AddressSpace::WorkGroup)
                .map(|(_, variable)| match &module.types[variable.ty].inner {
                    naga::TypeInner::Array { stride, size: naga::ArraySize::Constant(length), .. } => {
                        stride * length.get()
                    }
                    // Sized when the pipeline is made: by the bins of a histogram or the lanes of a workgroup, at most.
                    naga::TypeInner::Array { stride, size: naga::ArraySize::Pending(length), .. } => {
                        stride
                            * match module.overrides[*length].name.as_deref() {
                                Some("BINS") => 4096,
                                Some("COUNTS") => 1024 + 3,
                                Some("WORKGROUP") => 128,
                                Some("QUEUE_ENTRIES") => 8 * 128,
                                Some("HIT_PLACES") => 10 * 128,
                                other => panic!("how large {other:?} may be is not known"),
                            }
                    }
                    other => other.size(context),
                })
                .sum();
            assert!(bytes <= WORKGROUP_BYTES, "kernel `{}`: {bytes} bytes in {scene}", kernel.name);
        }
    }
}

/// Kernels of a report have room for all sums that a plan may have them add up.
#[test]
fn totals_have_room_for_all_sums() {
    let page = include_str!("../../shaders/core/totals.wgsl");
    let room = page.split_once("MOST_OWN_SUMS: u32 = ").and_then(|(_, rest)| rest.split_once("u;")).unwrap().0;
    let room: f64 = room.parse().unwrap();
    let mut most = 0.0_f64;
    for (scene, plan) in plans() {
        let own = plan.constants.iter().find(|(name, _)| *name == Constant::OwnSums).map_or(0.0, |(_, own)| *own);
        assert!((1.0..=room).contains(&own), "{own} of {room} in {scene}");
        most = most.max(own);
    }
    assert!(most >= 15.0, "no plan comes near the {room}: {most}");
}

#[test]
fn host_structs_lie_as_in_the_shaders() {
    let offset = |shader: &LinkedShader, structure: &str, member: &str| {
        *shader
            .layout
            .get(&(structure.to_owned(), member.to_owned()))
            .unwrap_or_else(|| panic!("no `{structure}.{member}`"))
    };
    let control = [
        ("step", offset_of!(Control, step)),
        ("next", offset_of!(Control, next)),
        ("key", offset_of!(Control, key)),
        ("seed_key", offset_of!(Control, seed_key)),
        ("closing", offset_of!(Control, closing)),
        ("elapsed", offset_of!(Control, elapsed)),
        ("failures", offset_of!(Control, failures)),
        ("failure_elapsed", offset_of!(Control, failure_elapsed)),
        ("failure_place", offset_of!(Control, failure_place)),
        ("demand", offset_of!(Control, demand)),
        ("limited", offset_of!(Control, limited)),
        ("limited_high", offset_of!(Control, limited_high)),
        ("", size_of::<Control>()),
    ];
    let mut tables = 0;
    for (scene, plan) in plans() {
        // What the engine's upload and download, and the plan's sizes of buffers, take for granted.
        let water = plan.layout.of::<WaterLayout>();
        let stride = if water.is_some() { 24 } else { 32 };
        let bytes = |array| plan.buffers.iter().find(|buffer| buffer.array == array).map(|buffer| buffer.bytes);
        let texels = |array| {
            let texture = plan.textures.iter().find(|texture| texture.array == array)?;
            Some((texture.words, u64::from(texture.size[0]) * u64::from(texture.size[1])))
        };
        if water.is_none_or(|layout| layout.bins.is_none()) {
            let all = water.map_or(plan.particles, |layout| layout.carriers as u64);
            let particles = plan.part.as_ref().map_or(all, |part| part.slots);
            match (water, texels(Array::Particles)) {
                (_, None) => {
                    let expected = (u64::from(stride) * particles).max(64).next_multiple_of(16);
                    assert_eq!(bytes(Array::Particles), Some(expected), "{scene}");
                }
                // Of shallow water the motion, beside which there are the masses; else particles as they are in a buffer.
                (Some(_), Some((words, held))) => {
                    assert!(words == 4 && held >= particles, "{scene}");
                    assert!(texels(Array::ParticleMasses).is_some_and(|(words, held)| words == 2 && held >= particles));
                }
                (_, Some((words, held))) => assert!(words == 4 && held >= 2 * particles, "{scene}"),
            }
        }
        for kernel in &plan.kernels {
            let shader = shader(kernel);
            let declared = |name: &str| shader.layout.contains_key(&(name.to_owned(), String::new()));
            // The kernels of the smoothing do not look at it.
            for (member, expected) in control.into_iter().filter(|_| declared("Control")) {
                assert_eq!(offset(shader, "Control", member) as usize, expected, "Control.{member}, `{}`", kernel.name);
            }
            assert!(
                [0, control.len()].contains(&shader.layout.keys().filter(|(name, _)| name == "Control").count()),
                "a member of Control that the host does not know"
            );
            if declared("Domain") {
                assert_eq!(offset(shader, "Domain", "") as usize, size_of::<Domain>());
            }
            if declared("Particle") {
                assert_eq!(offset(shader, "Particle", ""), stride, "`{}` in {scene}", kernel.name);
                assert_eq!(offset(shader, "Particle", "position"), 0);
                assert_eq!(offset(shader, "Particle", "momentum"), 16);
            }
            if declared("Water") {
                let members = [("position", 0), ("velocity", 8), ("mass", 16), ("id", 20), ("", 24)];
                for (member, expected) in members {
                    assert_eq!(offset(shader, "Water", member), expected, "Water.{member}");
                }
            }
            if declared("StoredWater") {
                for (member, expected) in [("position", 0), ("velocity", 8), ("mass_and_id", 16), ("", 24)] {
                    assert_eq!(offset(shader, "StoredWater", member), expected, "StoredWater.{member}");
                }
            }
            let bindings = &specialized(kernel, plan).bindings;
            if bindings.iter().any(|binding| binding.array == Array::Coefficients) {
                tables += 1;
                // Baths on particles add a row for the species by themselves, which couplings always have.
                // Pairs with ranges of their own have one row more each, after a row for each species, and for every further repulsion one.
                let constant = |wanted| {
                    let found = plan.constants.iter().find(|(constant, _)| *constant == wanted);
                    found.map_or(1, |(_, value)| *value as u64)
                };
                let species = constant(Constant::Species);
                let ranges =
                    constant(Constant::Ranged) == 1 && plan.constants.iter().any(|own| own.0 == Constant::Ranged);
                // Baths on particles have a row for each species.
                let bathed = plan.constants.iter().any(|own| own.0 == Constant::PositionBaths);
                let relaxes = plan.kernels.iter().any(|kernel| kernel.name == "relax_particles");
                let of_species = ranges || bathed || relaxes;
                let rows = species * species * if ranges { 1 + constant(Constant::Repulsions) } else { 1 };
                // Body forces have one an axis and a species, shear one a species.
                let sheared = plan.constants.iter().any(|own| own.0 == Constant::JumpEntries);
                let driven = if plan.has_buffer(Array::Account) { 3 * species } else { 0 };
                let entries = rows + if of_species { species } else { 0 } + driven + if sheared { species } else { 0 };
                match texels(Array::Coefficients) {
                    None => assert_eq!(bytes(Array::Coefficients), Some(16 * entries)),
                    Some((words, held)) => assert!(words == 4 && held >= entries, "{scene}"),
                }
            }
            if declared("Hold") && plan.has_buffer(Array::Holds) {
                let members = [
                    ("force", offset_of!(Hold, force)),
                    ("fraction", offset_of!(Hold, fraction)),
                    ("halves", offset_of!(Hold, halves)),
                    ("jump", offset_of!(Hold, jump)),
                    ("", size_of::<Hold>()),
                ];
                for (member, expected) in members {
                    assert_eq!(offset(shader, "Hold", member) as usize, expected, "Hold.{member}");
                }
                assert_eq!(bytes(Array::Holds), Some((24 * plan.particles).max(64)));
            }
            if declared("Tracker") {
                let stride = u64::from(offset(shader, "Tracker", ""));
                assert_eq!(bytes(Array::Trackers), Some((stride * plan.particles).max(64)));
            }
        }
    }
    assert!(tables > 0, "no scene had a table of coefficients");
}

/// The largest scenes a scene file can describe, of every shape: as plans, for no device holds them.
#[test]
fn no_plan_needs_more_workgroups_than_can_be_folded() {
    for lengths in ["[1000,1000,1000]", "[2,2,1e6]", "[1e6,2,2]", "[1000,1e9]", "[2,2]", "[65536,65536]", "[3,3,3]"] {
        for count in [0_u64, 1, 64 * 65_535 + 1, u64::from(u32::MAX)] {
            // So weak forces that no density is refused.
            let weak = ["interactions.0.friction=1e-9", "interactions.0.repulsion=1e-6"];
            let changes = ["time.steps=1000", weak[0], weak[1], &format!("space.box={lengths}")];
            let samplers = [
                r#"output.radial_distribution={"every":10,"range":1}"#,
                r#"output.diffusion={"every":2,"window":8}"#,
                r#"output.viscosity={"every":2,"window":8}"#,
            ];
            let particles = format!(r#"particles=[{{"species":"A","count":{count}}}]"#);
            let scene = fluid(&[&changes[..], &samplers[..], &[particles.as_str()]].concat());
            for traversal in [Traversal::Rows, Traversal::Clusters] {
                let plan = plan_of(&scene, Options { traversal: Some(traversal), ..Options::default() });
                for kernel in &plan.kernels {
                    let groups = u64::from(kernel.workgroups);
                    assert!((1..=WORKGROUPS).contains(&groups), "`{}`: {groups} for {count} in {lengths}", kernel.name);
                    if ["bin", "scatter", "diffusion", "viscosity"].contains(&kernel.name) {
                        assert!(groups * 64 >= count, "`{}` leaves particles out: {count} in {lengths}", kernel.name);
                    }
                    // Workgroups are parts of rows, or share them all.
                    if let Some(&(_, sharers)) = kernel.constants.iter().find(|(name, _)| *name == Constant::Shares) {
                        assert_eq!(groups as f64, sharers, "`{}`: {count} in {lengths}", kernel.name);
                    } else if kernel.constants.iter().any(|(name, _)| *name == Constant::Segments) {
                        assert_eq!(
                            groups % (u64::from(plan.cells[1]) * u64::from(plan.cells[2])),
                            0,
                            "`{}`: {count} in {lengths}",
                            kernel.name
                        );
                    }
                }
            }
        }
    }
}

#[test]
fn the_standard_fluid_needs_at_most_a_hundred_bytes_a_particle() {
    let edges = [20, 25, 40, 69, 160];
    for (integrator, edge) in INTEGRATORS.iter().flat_map(|integrator| edges.map(|edge| (integrator, edge))) {
        let measured = [
            "time.steps=1000",
            "output.energies.every=20",
            r#"output.radial_distribution={"every":100,"range":3,"bins":150}"#,
        ];
        let scene = fluid(&[&measured[..], &[integrator, &format!("space.box=[{edge},{edge},{edge}]")]].concat());
        for traversal in [Traversal::Rows, Traversal::Clusters] {
            for many_level_scan in [false, true] {
                let options = Options { traversal: Some(traversal), many_level_scan, ..Options::default() };
                for (memory, plan) in plans_of(integrator, &scene, options) {
                    assert!(plan.particles >= 24_000);
                    let per_particle = plan.bytes() as f64 / plan.particles as f64;
                    // Momenta between two stages need room of their own.
                    let most = if *integrator == STAGED { 140.0 } else { 100.0 };
                    assert!(per_particle <= most, "{per_particle} bytes, {} particles, {memory}", plan.particles);
                }
            }
        }
    }
}

/// Why a library of a kernel and another file is refused, or does not link.
fn broken(path: &'static str, text: &'static str) -> (String, String) {
    let entry = "@compute @workgroup_size(1)\nfn kernel() { _ = two(1u); }\n";
    let good = "// A function.\nfn one() -> u32 { return 1u; }\n";
    let files = [("core/entry", entry), ("core/good", good), (path, text)];
    let linked = match Library::new(&files).and_then(|library| library.link("kernel", &[])) {
        Ok(linked) => linked,
        Err(unlinked) => return (unlinked.place, unlinked.reason),
    };
    match validate("trial", "kernel", &linked) {
        Err(GpuError::Shader { kernel, place, reason }) => {
            assert_eq!(kernel, "trial");
            (place, reason)
        }
        Err(other) => panic!("{other}"),
        Ok(_) => panic!("{text} links"),
    }
}

#[test]
fn an_error_in_a_shader_names_its_file_and_line() {
    // What the parser finds.
    let (place, reason) =
        broken("core/bad", "// One line,\n// and another.\nfn two(a: u32) -> u32 { return one() + ; }\n");
    assert_eq!(place, "shaders/core/bad.wgsl:3");
    assert!(reason.contains("expected"), "{reason}");
    let (place, reason) = broken("core/bad", "const A: u32 = 1u;\n\nfn two(a: u32) -> u32 { return A + twice(); }");
    assert_eq!(place, "shaders/core/bad.wgsl:3");
    assert!(reason.contains("twice"), "{reason}");
    // What the validator finds.
    let (place, reason) = broken("core/bad", "\nfn two(a: u32) -> f32 {\n    return a;\n}\n");
    assert!(["shaders/core/bad.wgsl:2", "shaders/core/bad.wgsl:3"].contains(&place.as_str()), "{place}: {reason}");
    // What the linker finds.
    let (place, reason) = broken("core/slot/variant", "fn two(a: u32) -> u32 { return a; }");
    assert_eq!(place, "core/entry.wgsl:1");
    assert_eq!(reason, "no variant that declares `two` is chosen; there are core/slot/variant");
    let library = Library::new(&[("core/nothing", "const A: u32 = 1u;")]).unwrap();
    assert_eq!(library.link("kernel", &[]).unwrap_err().reason, "there is no kernel `kernel`");
}
