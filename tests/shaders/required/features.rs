//! Features, one by one: how a scene has them and how not, and what of a plan is there for them.

use serde_json::{Value, json};

use super::scenes::{
    Change, add, alike, at_rest, bathed, bonded, has_particles, heat, interaction, leapfrog, leave_out, no_analyses,
    no_tracers, remove, set, set_last_group, set_pair, set_scene, split_group, tracers, write,
};

/// Something that a scene may have or not.
pub struct Feature {
    pub name: &'static str,
    /// What both scenes have for it to be possible.
    pub ground: Change,
    pub with: Change,
    pub without: Change,
    /// Parts of names of kernels, arrays, constants and files that no plan has where it is off; none where it is no business of the device.
    pub own: Option<&'static [&'static str]>,
    /// Kernels and arrays that are there for it in some scene, if nothing else needs them too.
    pub more: &'static [&'static str],
    /// Kernels and arrays that are there in its place.
    pub instead: &'static [&'static str],
    /// Whether it makes a difference to every scene that can have it.
    pub always: bool,
}

fn nothing(_: &mut Value) {}

/// Boundaries at rest.
fn no_shear(scene: &mut Value) {
    if let Some(space) = scene["space"].as_object_mut() {
        space.remove("shear");
    }
}

/// Boundaries at rest, across which nothing else counts how often a particle has gone.
fn no_other_paths(scene: &mut Value) {
    no_shear(scene);
    write(scene, "diffusion", Value::Null);
}

/// Nothing that keeps the momenta of a report.
fn no_momenta(scene: &mut Value) {
    no_analyses(scene);
    write(scene, "trajectory", Value::Null);
}

/// Pairs without friction.
fn without_frictions(scene: &mut Value) {
    leave_out(scene, "dpd", &["pairs", "bath", "friction", "many_body"]);
}

/// The first group alone, of the usual mass.
fn one_group(scene: &mut Value) {
    if interaction(scene, "harmonic-chain").is_none() {
        scene["particles"].as_array_mut().unwrap().truncate(1);
        set_last_group(scene, "mass", json!(1));
        set(scene, "dpd", "pairs", Value::Null);
        set(scene, "langevin", "species", Value::Null);
    }
}

/// Tracers in no order, which are on no loop.
fn scattered_tracers(scene: &mut Value) {
    if interaction(scene, "shallow-water").is_some() {
        set_last_group(scene, "placement", json!({"type": "random"}));
    }
}

/// Walls of which the upper has a velocity.
fn moving_walls(scene: &mut Value, velocity: f64) {
    if has_particles(scene) && interaction(scene, "harmonic-chain").is_none() {
        let mut velocities = vec![0.0; scene["space"]["box"].as_array().unwrap().len()];
        velocities[0] = velocity;
        scene["space"]["walls"] = json!({"y": {"upper_velocity": velocities}});
    }
}

fn velocities_in(frame: &str) -> Value {
    json!([{"quantity": "velocity", "every": 2, "range": 9, "frame": frame}])
}

/// Leaves out what does not go with charges.
fn without_foes_of_charges(scene: &mut Value) {
    no_analyses(scene);
    no_shear(scene);
    if let Some(space) = scene["space"].as_object_mut() {
        space.remove("walls");
    }
}

fn charged(scene: &mut Value) {
    let is_space = scene["space"]["box"].as_array().unwrap().len() == 3;
    if has_particles(scene) && interaction(scene, "harmonic-chain").is_none() && is_space {
        set_last_group(scene, "charge", json!(1));
        add(scene, json!({"type": "electrostatics", "bjerrum_length": 1, "background": true}));
    }
}

pub fn features() -> Vec<Feature> {
    vec![
        Feature {
            name: "force of pairs",
            ground: without_frictions,
            with: |scene| set(scene, "dpd", "repulsion", json!(25)),
            without: |scene| set(scene, "dpd", "repulsion", Value::Null),
            own: Some(&[
                "file pairs/law",
                "file pairs/rows",
                "file pairs/clusters",
                "array neighbours",
                "array anchors",
            ]),
            more: &[
                "arrange",
                "begin",
                "bin",
                "list",
                "pairs",
                "report_pairs",
                "scan",
                "take_stock",
                "anchors",
                "cells",
                "counts",
                "demands",
                "kicks",
                "neighbours",
                "ranks",
                "sorted",
            ],
            instead: &["tick"],
            always: true,
        },
        Feature {
            name: "repulsion",
            ground: |scene| {
                leave_out(scene, "dpd", &["pairs", "many_body"]);
                set(scene, "dpd", "friction", json!(4.5));
            },
            with: |scene| set(scene, "dpd", "repulsion", json!(25)),
            without: |scene| set(scene, "dpd", "repulsion", Value::Null),
            own: Some(&[]),
            more: &["forces"],
            instead: &[],
            always: true,
        },
        Feature {
            name: "friction of pairs",
            ground: |scene| {
                leave_out(scene, "dpd", &["pairs", "bath"]);
                set(scene, "dpd", "repulsion", json!(25));
            },
            with: |scene| set(scene, "dpd", "friction", json!(4.5)),
            without: |scene| set(scene, "dpd", "friction", Value::Null),
            own: Some(&[]),
            more: &[
                "forces",
                "drift_rest",
                "find",
                "relax",
                "relax_to_report",
                "report_bonds_between",
                "report_charges_between",
                "report_excluded_charges_between",
                "report_configuration",
                "report_motion",
                "reported_momenta",
                "scan",
                "scatter",
            ],
            instead: &["leapfrog", "report"],
            always: true,
        },
        Feature {
            name: "noise of pairs",
            ground: |scene| set(scene, "dpd", "friction", json!(4.5)),
            with: |scene| set(scene, "dpd", "bath", Value::Null),
            without: |scene| set(scene, "dpd", "bath", json!({"type": "white", "temperature": 0})),
            own: Some(&[]),
            more: &[],
            instead: &[],
            always: true,
        },
        Feature {
            name: "Gaussian noise of pairs",
            ground: nothing,
            with: |scene| set_scene(scene, "noise", json!({"distribution": "gaussian"})),
            without: |scene| set_scene(scene, "noise", Value::Null),
            own: Some(&[]),
            more: &[],
            instead: &[],
            always: false,
        },
        Feature {
            name: "general weight",
            ground: nothing,
            with: |scene| set(scene, "dpd", "weight_exponent", json!(1)),
            without: |scene| set(scene, "dpd", "weight_exponent", Value::Null),
            own: Some(&[]),
            more: &[],
            instead: &[],
            always: true,
        },
        Feature {
            name: "cutoffs of pairs",
            ground: alike,
            with: |scene| set_pair(scene, json!({"cutoff": 0.8})),
            without: nothing,
            own: Some(&[]),
            more: &[],
            instead: &[],
            always: true,
        },
        Feature {
            name: "weight exponents of pairs",
            ground: alike,
            with: |scene| set_pair(scene, json!({"weight_exponent": 1})),
            without: nothing,
            own: Some(&[]),
            more: &[],
            instead: &[],
            // Only where there is friction.
            always: false,
        },
        Feature {
            name: "many-body repulsion",
            ground: nothing,
            with: |scene| set(scene, "dpd", "many_body", json!({"repulsion": 25})),
            without: |scene| set(scene, "dpd", "many_body", Value::Null),
            own: Some(&["densities", "DENSITY"]),
            more: &["densities", "report_densities"],
            // Beside a table of species the prefilter reads positions then.
            instead: &["probes"],
            always: true,
        },
        Feature {
            name: "memory of pairs",
            ground: |scene| {
                leapfrog(scene);
                set(scene, "dpd", "friction", json!(4.5));
            },
            with: |scene| set(scene, "dpd", "bath", json!({"type": "memory", "rate": 3})),
            without: |scene| set(scene, "dpd", "bath", Value::Null),
            own: Some(&[
                "array memories",
                "file baths/pairs/memory",
                "file baths/pair_noise",
                "file couplings/lists/by_turns",
            ]),
            more: &["memories"],
            instead: &[],
            always: true,
        },
        Feature {
            name: "noise of pairs with memory",
            ground: |scene| {
                leapfrog(scene);
                set(scene, "dpd", "friction", json!(4.5));
            },
            with: |scene| set(scene, "dpd", "bath", json!({"type": "memory", "rate": 3})),
            without: |scene| set(scene, "dpd", "bath", json!({"type": "memory", "rate": 3, "temperature": 0})),
            own: Some(&["file baths/pair_noise"]),
            more: &[],
            instead: &[],
            always: true,
        },
        Feature {
            name: "two stages of friction",
            ground: nothing,
            with: |scene| scene["integrator"] = json!({"type": "splitting", "relaxation": "two-stages"}),
            without: |scene| scene["integrator"] = json!({"type": "splitting"}),
            own: Some(&["relax_first", "first_stage", "array staged", "file pairs/stages"]),
            more: &["relax_first", "report_first_stage", "stress_of_first_stage", "staged", "staged_momenta"],
            instead: &[],
            // Lists of neighbours are for other integrators.
            always: false,
        },
        Feature {
            name: "prediction",
            ground: nothing,
            with: |scene| scene["integrator"] = json!({"type": "groot-warren", "lambda": 0.65}),
            without: |scene| scene["integrator"] = json!({"type": "groot-warren"}),
            own: Some(&[]),
            more: &[],
            instead: &[],
            always: true,
        },
        Feature {
            name: "bath on particles",
            ground: leapfrog,
            with: |scene| add(scene, json!({"type": "langevin", "friction": 1})),
            without: |scene| remove(scene, "langevin"),
            own: Some(&["array position_baths", "constant POSITION_", "constant PARTICLE_STREAM"]),
            more: &["position_baths"],
            instead: &[],
            always: true,
        },
        Feature {
            name: "memory of the bath on particles",
            ground: bathed,
            with: |scene| set(scene, "langevin", "bath", json!({"type": "memory", "rate": 3})),
            without: |scene| set(scene, "langevin", "bath", Value::Null),
            own: Some(&["array position_baths", "constant POSITION_LOSS"]),
            more: &["position_baths"],
            // Beside a table of species and the baths the prefilter reads positions.
            instead: &["probes"],
            always: true,
        },
        Feature {
            name: "noise of the bath on particles",
            ground: bathed,
            with: |scene| set(scene, "langevin", "bath", Value::Null),
            without: |scene| set(scene, "langevin", "bath", json!({"type": "white", "temperature": 0})),
            own: Some(&[]),
            more: &[],
            instead: &[],
            always: true,
        },
        Feature {
            name: "tethers",
            ground: leapfrog,
            with: |scene| add(scene, json!({"type": "tether", "stiffness": 2})),
            without: |scene| remove(scene, "tether"),
            own: Some(&["tether", "TETHER"]),
            more: &["report_tethers", "tethers", "forces", "kicks"],
            // Beside a table of species and the impulses of tethers the prefilter reads positions.
            instead: &["probes"],
            always: true,
        },
        Feature {
            name: "charges",
            ground: without_foes_of_charges,
            with: charged,
            without: |scene| remove(scene, "electrostatics"),
            own: Some(&["charge", "CHARGE", "array waves", "array symbols"]),
            more: &[
                "balance_charges",
                "charge_columns",
                "charge_rows",
                "charge_spectrum",
                "pull_charges",
                "report_charges",
                "report_charges_between",
                "spread_charges",
                "take_stock",
                "charge_energies",
                "charge_impulses",
                "charged",
                "kicks",
                "node_charges",
                "node_potentials",
                "roots",
                "slots",
                "symbols",
                "waves",
                "waves_next",
            ],
            instead: &["probes"],
            always: true,
        },
        Feature {
            name: "body force",
            ground: nothing,
            with: |scene| {
                if has_particles(scene) && interaction(scene, "harmonic-chain").is_none() {
                    let force = vec![1; scene["space"]["box"].as_array().unwrap().len()];
                    add(scene, json!({"type": "body-force", "profile": "sinusoidal", "force": force, "axis": "x"}));
                }
            },
            without: |scene| remove(scene, "body-force"),
            own: Some(&["_external", "external/drifted", "account"]),
            more: &["book_external", "report_external", "account"],
            instead: &[],
            always: true,
        },
        Feature {
            name: "walls",
            // Some analyses take no walls.
            ground: no_analyses,
            with: |scene| {
                if has_particles(scene) && interaction(scene, "harmonic-chain").is_none() {
                    scene["space"]["walls"] = json!({"y": {}});
                }
            },
            without: |scene| {
                if let Some(space) = scene["space"].as_object_mut() {
                    space.remove("walls");
                }
            },
            own: Some(&["between_walls", "report_walls", "wall_impulses", "SLIDE", "LOWER_", "UPPER_"]),
            more: &["report_walls", "wall_impulses"],
            // Beside a table of species the prefilter reads positions then.
            instead: &["probes"],
            always: true,
        },
        Feature {
            name: "motion of walls",
            ground: no_analyses,
            with: |scene| moving_walls(scene, 1.0),
            without: |scene| moving_walls(scene, 0.0),
            own: Some(&[]),
            more: &[],
            instead: &[],
            always: true,
        },
        Feature {
            name: "layers behind walls",
            ground: |scene| {
                no_analyses(scene);
                moving_walls(scene, 1.0);
            },
            with: |scene| {
                if has_particles(scene) && interaction(scene, "harmonic-chain").is_none() {
                    let placement = json!({"type": "behind-walls", "axis": "y", "thickness": 1});
                    let layer = json!({"species": "wall", "number_density": 3, "placement": placement});
                    scene["particles"].as_array_mut().unwrap().push(layer);
                }
            },
            without: nothing,
            own: Some(&["file space/measured"]),
            more: &["coefficients"],
            // Beside a table of species the prefilter reads positions.
            instead: &["probes"],
            always: true,
        },
        Feature {
            name: "shear",
            // Most analyses take no shear, and neither do body forces.
            ground: |scene| {
                no_analyses(scene);
                remove(scene, "body-force");
                if let Some(space) = scene["space"].as_object_mut() {
                    space.remove("walls");
                }
            },
            with: |scene| {
                if has_particles(scene) && interaction(scene, "harmonic-chain").is_none() {
                    scene["space"]["shear"] = json!({"rate": 0.1, "gradient": "y"});
                }
            },
            without: |scene| {
                if let Some(space) = scene["space"].as_object_mut() {
                    space.remove("shear");
                }
            },
            own: Some(&[
                "shear",
                "SHEAR",
                "JUMP_ENTRIES",
                "pairs/faces",
                "external/jump",
                "external/shift",
                "reported_motion",
                "baths/flow",
            ]),
            more: &["report_walls", "wall_impulses"],
            // The prefilter reads positions then.
            instead: &["probes"],
            always: true,
        },
        Feature {
            name: "bonds",
            ground: leapfrog,
            with: bonded,
            without: |scene| remove(scene, "bonds"),
            own: Some(&[
                "kernel bonds",
                "kernel report_bonds",
                "array bonds",
                "constant BOND",
                "file bonds/bonds",
                "file bonds/bond_report",
            ]),
            // Bonds of some scenes exclude charges.
            more: &[
                "bonds",
                "report_bonds",
                "stress_of_bonds",
                "take_stock",
                "forces",
                "kicks",
                "slots",
                "exclude_charges",
                "excluded_charges",
                "report_excluded_charges",
            ],
            // Beside a table of species the prefilter reads positions then.
            instead: &["probes"],
            always: true,
        },
        Feature {
            name: "potential of bonds",
            ground: bonded,
            with: |scene| set(scene, "bonds", "potential", json!({"type": "harmonic", "stiffness": 2})),
            without: |scene| set(scene, "bonds", "potential", Value::Null),
            own: Some(&[]),
            more: &["bonds", "report_bonds", "forces"],
            instead: &[],
            always: true,
        },
        Feature {
            name: "limited extent of bonds",
            ground: bonded,
            with: |scene| set(scene, "bonds", "potential", json!({"type": "fene", "stiffness": 2, "extent": 9})),
            without: |scene| set(scene, "bonds", "potential", json!({"type": "harmonic", "stiffness": 2})),
            own: Some(&[]),
            more: &[],
            instead: &[],
            always: true,
        },
        Feature {
            name: "a largest force of bonds",
            ground: |scene| {
                bonded(scene);
                set(scene, "bonds", "potential", json!({"type": "harmonic", "stiffness": 2}));
            },
            with: |scene| scene["push_off"] = json!(5),
            without: |scene| {
                scene.as_object_mut().unwrap().remove("push_off");
            },
            own: Some(&["LARGEST_PULL", "file bonds/stretch"]),
            more: &[],
            instead: &[],
            always: false,
        },
        Feature {
            name: "friction of bonds",
            ground: bonded,
            with: |scene| set(scene, "bonds", "friction", json!(1)),
            without: |scene| set(scene, "bonds", "friction", Value::Null),
            own: Some(&["file baths/bonds"]),
            // Conservative forces are apart from it.
            more: &["forces"],
            instead: &[],
            always: true,
        },
        Feature {
            name: "memory of bonds",
            ground: |scene| {
                bonded(scene);
                set(scene, "bonds", "friction", json!(1));
            },
            with: |scene| set(scene, "bonds", "bath", json!({"type": "memory", "rate": 3})),
            without: |scene| set(scene, "bonds", "bath", Value::Null),
            own: Some(&["bond_baths", "file baths/bonds/memory", "file baths/bond_report"]),
            more: &["bond_baths"],
            instead: &[],
            always: true,
        },
        Feature {
            name: "noise of bonds",
            ground: |scene| {
                bonded(scene);
                set(scene, "bonds", "friction", json!(1));
            },
            with: |scene| set(scene, "bonds", "bath", Value::Null),
            without: |scene| set(scene, "bonds", "bath", json!({"type": "white", "temperature": 0})),
            own: Some(&[]),
            more: &[],
            instead: &[],
            always: true,
        },
        Feature {
            name: "bonds that spare repulsion",
            ground: bonded,
            with: |scene| set(scene, "bonds", "exclude_repulsion", json!(true)),
            without: |scene| set(scene, "bonds", "exclude_repulsion", Value::Null),
            own: Some(&[
                "kernel exclusions",
                "kernel report_exclusions",
                "array excluded_pairs",
                "array exclusions",
                "file bonds/exclusions",
                "file couplings/exclusions",
                "constant EXCLUSIONS",
            ]),
            more: &["excluded_pairs", "exclusions", "report_exclusions", "stress_of_exclusions"],
            instead: &[],
            always: false,
        },
        Feature {
            name: "bonds that exclude charges",
            ground: |scene| {
                without_foes_of_charges(scene);
                bonded(scene);
                charged(scene);
            },
            with: |scene| set(scene, "bonds", "exclude_charges", json!(true)),
            without: |scene| set(scene, "bonds", "exclude_charges", Value::Null),
            own: Some(&[
                "exclude_charges",
                "excluded_charges",
                "file charges/exclusions",
                "EXCLUDED_CHARGES",
                "CLOUD_SCALE",
            ]),
            more: &["exclude_charges", "excluded_charges", "report_excluded_charges"],
            instead: &[],
            always: false,
        },
        Feature {
            name: "angles",
            ground: bonded,
            with: |scene| add(scene, json!({"type": "angles", "triples": [[0, 1, 2]], "stiffness": 2})),
            without: |scene| remove(scene, "angles"),
            own: Some(&["angle", "ANGLE"]),
            more: &["angles", "report_angles", "stress_of_angles"],
            instead: &[],
            always: true,
        },
        Feature {
            name: "coloured noise",
            ground: leapfrog,
            with: |scene| add(scene, json!({"type": "coloured-noise", "strength": 1, "time": 0.05})),
            without: |scene| remove(scene, "coloured-noise"),
            own: Some(&["array holds", "constant HOLD", "constant JUMP"]),
            more: &["find_centre", "sum_momenta", "centre", "holds", "momentum_sums"],
            instead: &[],
            always: true,
        },
        Feature {
            name: "held particles",
            ground: |scene| {
                leapfrog(scene);
                split_group(scene);
            },
            with: |scene| set_last_group(scene, "fixed", json!(true)),
            without: nothing,
            own: Some(&["file space/measured"]),
            more: &[],
            instead: &[],
            always: true,
        },
        Feature {
            name: "a second species",
            ground: one_group,
            with: split_group,
            without: nothing,
            own: Some(&["array coefficients", "file space/coefficients/table", "constant SPECIES"]),
            more: &["coefficients"],
            // Beside bonds the prefilter reads positions then.
            instead: &["probes"],
            always: false,
        },
        Feature {
            name: "a second mass",
            ground: |scene| {
                one_group(scene);
                split_group(scene);
            },
            with: |scene| set_last_group(scene, "mass", json!(2)),
            without: nothing,
            own: Some(&["file space/mass/by_species"]),
            more: &[],
            instead: &[],
            always: true,
        },
        Feature {
            name: "radial distribution",
            ground: no_analyses,
            with: |scene| write(scene, "radial_distribution", json!({"every": 10, "range": 1.5})),
            without: |scene| write(scene, "radial_distribution", Value::Null),
            own: Some(&["kernel pair_histogram", "array histogram"]),
            more: &[
                "arrange_by_cell",
                "bin",
                "pair_histogram",
                "record_histogram",
                "scan",
                "cells",
                "counts",
                "histogram",
                "histogram_samples",
                "ranks",
                "sorted",
            ],
            instead: &[],
            always: true,
        },
        Feature {
            name: "radial distribution of species",
            ground: |scene| {
                no_analyses(scene);
                write(scene, "radial_distribution", json!({"every": 10, "range": 1.5}));
            },
            with: |scene| {
                write(scene, "radial_distribution", json!({"every": 10, "range": 1.5, "species": "all-pairs"}));
            },
            without: |scene| write(scene, "radial_distribution", json!({"every": 10, "range": 1.5, "species": null})),
            own: Some(&["analyses/partial"]),
            more: &[],
            instead: &[],
            always: true,
        },
        Feature {
            name: "diffusion of a species",
            ground: |scene| {
                no_analyses(scene);
                write(scene, "diffusion", json!({"every": 2, "window": 8}));
            },
            with: |scene| {
                let species = scene["particles"][0]["species"].clone();
                write(scene, "diffusion", json!({"every": 2, "window": 8, "species": species}));
            },
            without: |scene| write(scene, "diffusion", json!({"every": 2, "window": 8, "species": null})),
            own: Some(&["analyses/measured"]),
            more: &[],
            instead: &[],
            always: true,
        },
        Feature {
            name: "diffusion",
            ground: no_analyses,
            with: |scene| write(scene, "diffusion", json!({"every": 2, "window": 8})),
            without: |scene| write(scene, "diffusion", Value::Null),
            own: Some(&["diffusion", "tracker", "TRACKER"]),
            more: &[
                "diffusion",
                "record_sample",
                "diffusion_samples",
                "diffusion_sums",
                "reported",
                "trackers",
                "follow",
                "paths",
            ],
            instead: &[],
            always: true,
        },
        Feature {
            name: "viscosity",
            ground: no_analyses,
            with: |scene| write(scene, "viscosity", json!({"every": 2, "window": 8})),
            without: |scene| write(scene, "viscosity", Value::Null),
            own: Some(&["kernel viscosity", "array mode_"]),
            more: &["record_sample", "viscosity", "mode_samples", "mode_sums", "reported"],
            instead: &[],
            always: true,
        },
        Feature {
            name: "profiles of a species",
            ground: |scene| {
                no_analyses(scene);
                write(scene, "profiles", json!({"axis": "x", "every": 2}));
            },
            with: |scene| write(scene, "profiles", json!({"axis": "x", "every": 2, "species": "A"})),
            without: |scene| write(scene, "profiles", json!({"axis": "x", "every": 2})),
            own: Some(&["analyses/in_layers"]),
            more: &[],
            instead: &[],
            always: false,
        },
        Feature {
            name: "structure factor",
            ground: no_analyses,
            with: |scene| write(scene, "structure_factor", json!({"every": 2, "range": 9})),
            without: |scene| write(scene, "structure_factor", Value::Null),
            own: Some(&["kernel structure_factor", "array wave_vectors", "array density_wave"]),
            more: &[
                "structure_factor",
                "record_histogram",
                "wave_vectors",
                "density_waves",
                "density_wave_samples",
                "reported",
            ],
            instead: &[],
            always: true,
        },
        Feature {
            name: "structure factor of species",
            ground: |scene| {
                no_analyses(scene);
                write(scene, "structure_factor", json!({"every": 2, "range": 9}));
            },
            with: |scene| write(scene, "structure_factor", json!({"every": 2, "range": 9, "species": "A"})),
            without: |scene| write(scene, "structure_factor", json!({"every": 2, "range": 9})),
            own: Some(&["analyses/of_wave"]),
            more: &[],
            instead: &[],
            always: false,
        },
        Feature {
            name: "sizes of chains",
            ground: no_analyses,
            with: |scene| write(scene, "chain_sizes", json!({"every": 2})),
            without: |scene| write(scene, "chain_sizes", Value::Null),
            own: Some(&["chain_s"]),
            more: &["chain_sizes", "record_sample", "chain_samples", "chain_starts", "chain_sums", "chain_walks"],
            instead: &[],
            always: true,
        },
        Feature {
            name: "autocorrelation of velocities",
            ground: no_momenta,
            with: |scene| {
                write(
                    scene,
                    "autocorrelations",
                    json!([{"quantity": "velocity", "every": 2, "window": 8, "frame": "box"}]),
                );
            },
            without: |scene| write(scene, "autocorrelations", Value::Null),
            own: Some(&[
                "velocity_autocorrelation",
                "array velocity_origins",
                "array velocity_product",
                "reported_momenta",
            ]),
            more: &[
                "velocity_autocorrelation",
                "record_sample",
                "velocity_origins",
                "velocity_product_samples",
                "velocity_products",
                "reported",
                "reported_momenta",
            ],
            instead: &[],
            always: true,
        },
        Feature {
            name: "autocorrelation of forces",
            ground: no_analyses,
            with: |scene| write(scene, "autocorrelations", json!([{"quantity": "force", "every": 2, "window": 8}])),
            without: |scene| write(scene, "autocorrelations", Value::Null),
            own: Some(&["force_autocorrelation", "array force_origins", "array force_product", "reported_forces"]),
            more: &[
                "force_autocorrelation",
                "record_sample",
                "force_origins",
                "force_product_samples",
                "force_products",
                "reported_forces",
            ],
            instead: &[],
            always: true,
        },
        Feature {
            name: "histogram of velocities",
            ground: no_momenta,
            with: |scene| {
                write(scene, "histograms", json!([{"quantity": "velocity", "every": 2, "range": 9, "frame": "box"}]));
            },
            without: |scene| write(scene, "histograms", Value::Null),
            own: Some(&["velocity_histogram", "array velocity_count", "reported_momenta"]),
            more: &[
                "velocity_histogram",
                "record_histogram",
                "velocity_count_samples",
                "velocity_counts",
                "reported",
                "reported_momenta",
            ],
            instead: &[],
            always: true,
        },
        Feature {
            name: "histogram of speeds",
            ground: no_momenta,
            with: |scene| {
                write(scene, "histograms", json!([{"quantity": "speed", "every": 2, "range": 9, "frame": "box"}]));
            },
            without: |scene| write(scene, "histograms", Value::Null),
            own: Some(&["speed_histogram", "array speed_count", "reported_momenta"]),
            more: &[
                "speed_histogram",
                "record_histogram",
                "speed_count_samples",
                "speed_counts",
                "reported",
                "reported_momenta",
            ],
            instead: &[],
            always: true,
        },
        Feature {
            name: "histogram of accelerations",
            ground: no_analyses,
            with: |scene| write(scene, "histograms", json!([{"quantity": "acceleration", "every": 2, "range": 9}])),
            without: |scene| write(scene, "histograms", Value::Null),
            own: Some(&["acceleration_histogram", "array acceleration_count", "reported_forces"]),
            more: &[
                "acceleration_histogram",
                "record_histogram",
                "acceleration_count_samples",
                "acceleration_counts",
                "reported_forces",
            ],
            instead: &[],
            always: true,
        },
        Feature {
            name: "profiles",
            ground: no_analyses,
            with: |scene| write(scene, "profiles", json!({"axis": "x", "every": 2, "quantities": ["density"]})),
            without: |scene| write(scene, "profiles", Value::Null),
            own: Some(&["kernel profiles", "array layer", "file analyses/profiles", "LAYER"]),
            more: &["profiles", "record_histogram", "layer_samples", "layer_sums", "reported"],
            instead: &[],
            always: true,
        },
        Feature {
            name: "profiles of motion",
            ground: no_analyses,
            with: |scene| write(scene, "profiles", json!({"axis": "x", "every": 2})),
            without: |scene| write(scene, "profiles", json!({"axis": "x", "every": 2, "quantities": ["density"]})),
            own: Some(&["file analyses/layered", "LAYERED_MASS", "LAYERED_KINETIC", "array reported_momenta"]),
            more: &["reported_momenta"],
            instead: &[],
            always: true,
        },
        Feature {
            name: "stress",
            ground: no_analyses,
            with: |scene| write(scene, "stress", json!({"every": 2})),
            without: |scene| write(scene, "stress", Value::Null),
            own: Some(&["stress", "STRESS"]),
            more: &[
                "clear_stresses",
                "record_sample",
                "stress",
                "stress_charges",
                "stress_of_bonds",
                "stress_of_excluded_charges",
                "charge_stresses",
                "reported_momenta",
                "reported_stresses",
                "stress_samples",
                "stress_sums",
            ],
            instead: &[],
            always: true,
        },
        Feature {
            name: "profiles of the stress",
            ground: no_analyses,
            with: |scene| {
                let quantities = ["density", "velocity", "stress"];
                write(scene, "profiles", json!({"axis": "x", "every": 2, "quantities": quantities}));
            },
            without: |scene| write(scene, "profiles", json!({"axis": "x", "every": 2})),
            own: Some(&["stress", "STRESS"]),
            more: &["clear_stresses", "stress", "stress_of_bonds", "reported_stresses"],
            instead: &[],
            always: true,
        },
        Feature {
            name: "velocities about the centre of mass",
            ground: no_analyses,
            with: |scene| write(scene, "histograms", velocities_in("centre-of-mass")),
            without: |scene| write(scene, "histograms", velocities_in("box")),
            own: Some(&["array centre", "array momentum_sums", "file analyses/frame"]),
            more: &["find_centre", "sum_momenta", "centre", "momentum_sums"],
            instead: &[],
            always: true,
        },
        Feature {
            name: "trajectory",
            // Across boundaries that shear nothing counts how often a particle has gone round.
            ground: no_other_paths,
            with: |scene| write(scene, "trajectory", json!({"every": 5})),
            without: |scene| write(scene, "trajectory", Value::Null),
            own: Some(&["kernel follow", "array paths"]),
            more: &["follow", "follow_tracers", "paths", "reported_momenta"],
            instead: &[],
            always: true,
        },
        Feature {
            name: "more rows of energies",
            ground: nothing,
            with: |scene| write(scene, "energies", json!({"every": 3})),
            without: |scene| write(scene, "energies", json!({"every": 7})),
            own: Some(&[]),
            more: &[],
            instead: &[],
            always: true,
        },
        Feature {
            name: "pictures of another size",
            ground: nothing,
            with: |scene| write(scene, "snapshot", json!({"width": 300})),
            without: |scene| write(scene, "snapshot", Value::Null),
            own: None,
            more: &[],
            instead: &[],
            always: true,
        },
        Feature {
            name: "plots of another size",
            ground: nothing,
            with: |scene| write(scene, "plot", json!({"width": 700})),
            without: |scene| write(scene, "plot", Value::Null),
            own: None,
            more: &[],
            instead: &[],
            always: true,
        },
        Feature {
            name: "more checkpoints",
            ground: nothing,
            with: |scene| write(scene, "checkpoint", json!({"every": 9})),
            without: |scene| write(scene, "checkpoint", Value::Null),
            own: None,
            more: &[],
            instead: &[],
            always: true,
        },
        Feature {
            name: "chains side by side",
            ground: nothing,
            with: |scene| write(scene, "chain", json!({"every": 2})),
            without: |scene| write(scene, "chain", Value::Null),
            own: None,
            more: &[],
            instead: &[],
            always: true,
        },
        Feature {
            name: "numbers of neighbours",
            ground: nothing,
            with: |scene| write(scene, "neighbours", json!({"every": 2})),
            without: |scene| write(scene, "neighbours", Value::Null),
            own: None,
            more: &[],
            instead: &[],
            always: true,
        },
        Feature {
            name: "decay of a shear wave",
            ground: nothing,
            with: |scene| write(scene, "shear_wave", json!({"every": 2})),
            without: |scene| write(scene, "shear_wave", Value::Null),
            own: None,
            more: &[],
            instead: &[],
            always: true,
        },
        Feature {
            name: "fields",
            ground: nothing,
            with: |scene| write(scene, "fields", json!({"every": 10, "quantities": ["depth"]})),
            without: |scene| write(scene, "fields", Value::Null),
            own: None,
            more: &[],
            instead: &[],
            always: true,
        },
        Feature {
            name: "surface",
            ground: at_rest,
            with: |scene| {
                set(scene, "shallow-water", "surface", json!([{"type": "wave", "periods": [1, 2], "amplitude": 0.05}]));
            },
            without: |scene| set(scene, "shallow-water", "surface", Value::Null),
            own: None,
            more: &[],
            instead: &[],
            always: true,
        },
        Feature {
            name: "rotation",
            ground: at_rest,
            with: |scene| set(scene, "shallow-water", "rotation", json!(2)),
            without: |scene| set(scene, "shallow-water", "rotation", Value::Null),
            own: Some(&[]),
            more: &[],
            instead: &[],
            always: true,
        },
        Feature {
            name: "smoothing",
            ground: |scene| set(scene, "shallow-water", "bath", Value::Null),
            with: |scene| set(scene, "shallow-water", "smoothing", json!({"length": 0.4})),
            without: |scene| set(scene, "shallow-water", "smoothing", Value::Null),
            own: Some(&["array waves", "array symbols", "array roots", "file smoothing/radix"]),
            more: &["smooth columns", "smooth rows", "roots", "symbols", "waves", "waves_next"],
            instead: &["depths"],
            always: true,
        },
        Feature {
            name: "bath on the mesh",
            ground: |scene| heat(scene, "shallow-water", 0.01),
            with: |scene| set(scene, "shallow-water", "bath", json!({"type": "memory", "epsilon": 1})),
            without: |scene| set(scene, "shallow-water", "bath", Value::Null),
            own: Some(&[
                "mesh_bath",
                "file mesh/bath",
                "file mesh/surface/bath",
                "constant BATH_PERSISTENCE",
                "file noise/generators",
            ]),
            more: &["mesh_bath", "node_bath", "previous_masses", "surface"],
            instead: &[],
            always: true,
        },
        Feature {
            name: "noise on the mesh",
            ground: |scene| set(scene, "shallow-water", "bath", json!({"type": "memory", "epsilon": 1})),
            with: |scene| heat(scene, "shallow-water", 0.01),
            without: |scene| heat(scene, "shallow-water", 0.0),
            own: Some(&["file mesh/bath_noise", "file noise/generators", "constant BATH_NOISE"]),
            more: &[],
            instead: &[],
            always: true,
        },
        Feature {
            name: "tracers",
            ground: nothing,
            with: |scene| tracers(scene, 64),
            without: no_tracers,
            own: Some(&["tracer", "TRACER"]),
            more: &[
                "push_tracers",
                "push_tracers_from_report",
                "record_tracers",
                "report_tracers",
                "tracer_samples",
                "tracers",
            ],
            instead: &[],
            always: true,
        },
        Feature {
            name: "tracers on a loop",
            ground: |scene| tracers(scene, 64),
            with: nothing,
            without: scattered_tracers,
            own: Some(&["array tracer_samples", "kernel record_tracers"]),
            more: &["record_tracers", "tracer_samples"],
            instead: &[],
            always: true,
        },
        Feature {
            name: "viscosity of cells",
            ground: nothing,
            with: |scene| set(scene, "voronoi", "viscosity", json!(1)),
            without: |scene| set(scene, "voronoi", "viscosity", json!(0)),
            own: Some(&[
                "kernel friction_",
                "array solver",
                "file exchange/rubbing",
                "file exchange/random_impulse",
                "constant VISCOSITY",
            ]),
            more: &[
                "exchange",
                "friction_begin",
                "friction_end",
                "friction_image",
                "friction_setup",
                "friction_solve",
                "friction_step",
                "apply",
                "directions",
                "estimates",
                "exchanges",
                "images",
                "preconditioners",
                "searches",
                "solver",
            ],
            instead: &[],
            always: true,
        },
        Feature {
            name: "noise of cells",
            ground: |scene| set(scene, "voronoi", "energy", Value::Null),
            with: |scene| heat(scene, "voronoi", 1.0),
            without: |scene| heat(scene, "voronoi", 0.0),
            own: Some(&["file exchange/random_impulse", "file noise/generators"]),
            more: &[],
            instead: &[],
            always: true,
        },
        Feature {
            name: "energy of cells",
            ground: |scene| set(scene, "voronoi", "form", Value::Null),
            with: |scene| set(scene, "voronoi", "energy", json!({})),
            without: |scene| set(scene, "voronoi", "energy", Value::Null),
            own: Some(&[
                "file voronoi/gas/energy",
                "array predictions",
                "kernel predict",
                "file exchange/conduction",
                "file exchange/energy/",
            ]),
            more: &["predict", "predictions"],
            instead: &["pushes"],
            always: true,
        },
        Feature {
            name: "conduction of heat",
            ground: nothing,
            with: |scene| set(scene, "voronoi", "energy", json!({"conductivity": 1})),
            without: |scene| set(scene, "voronoi", "energy", json!({"conductivity": 0})),
            own: Some(&["file exchange/conduction", "constant CONDUCTIVITY"]),
            more: &[],
            instead: &[],
            always: true,
        },
        Feature {
            name: "exchange of mass",
            ground: nothing,
            with: |scene| set(scene, "voronoi", "form", json!("consistent")),
            without: |scene| set(scene, "voronoi", "form", Value::Null),
            own: Some(&["file exchange/form/exchange", "file exchange/turning"]),
            more: &[],
            instead: &["pushes"],
            always: true,
        },
    ]
}
