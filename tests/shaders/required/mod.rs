//! What a scene requires, and no more.
//!
//! Plans of all shipped scenes, with one feature on and with it off. A feature that is off leaves no kernel, array or
//! variant in the plan, and the plan differs in nothing that has to do with others: kernels and arrays are those that
//! [`features`](features) names, and everything else that differs is in `required.txt`, which `MESOSCOPE_RECORD=1`
//! writes anew. A feature that is arithmetic alone is a constant of the pipeline, by which compilers leave it out: see
//! [`branches`](branches). A value that says "off" gives the plan of the scene that never mentions the feature.

mod branches;
mod differences;
mod features;
mod scenes;

use crate::support::edited;
use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Write;
use std::path::Path;
use std::thread;

use mesoscope::plan::{Hardware, Options, Plan};
use mesoscope::run;
use mesoscope::scene::{self, Checked, Integrator, PairRelaxation};
use mesoscope::shaders::Entry;
use serde_json::{Value, json};

use crate::variants::{plans, report, shader};
use differences::{differences, linked};
use features::{Feature, features};
use scenes::{interaction, set, shipped, ways_to_say_off};

const ANY: Hardware =
    Hardware { subgroup_size: None, serial_memory: false, queues_pairs: false, largest_binding: None };

/// The two kinds of adapters that plans differ for, in turns: what a feature needs does not depend on them.
const ADAPTERS: [Hardware; 2] = [ANY, Hardware { subgroup_size: Some(8), serial_memory: true, ..ANY }];

/// The plan of a scene; none if it is no scene. A scene that names no rule of relaxation has one stage of friction: a feature may be what
/// makes the default two.
fn plan_of(text: &Value, hardware: Hardware, listed: bool) -> Option<Plan> {
    let scene = scene::parse("test", &text.to_string(), &[]).ok()?;
    if text["integrator"]["relaxation"].is_null()
        && matches!(scene.system.particle_integrator(), Some(Integrator::Splitting { relaxation: Some(_) }))
    {
        let one_stage = Integrator::Splitting { relaxation: Some(PairRelaxation::MeanField) };
        return Some(plan_as_it_is(
            &edited(&scene, |scene| *scene.system.particle_integrator_mut().unwrap() = one_stage),
            hardware,
            listed,
        ));
    }
    Some(plan_as_it_is(&scene, hardware, listed))
}

fn plan_as_it_is(scene: &Checked, hardware: Hardware, listed: bool) -> Plan {
    let options = Options { listed, ..Options::default() };
    run::plan(scene, hardware, options)
}

/// Particles stay as they are stored, but for lists of pairs.
fn are_stored(plan: &Plan) -> bool {
    plan.kernels.iter().any(|kernel| kernel.entry == Entry::VisitStored)
}

/// A word for plans that are made alike.
fn kind(scene: &Value, plan: &Plan) -> &'static str {
    match () {
        () if interaction(scene, "shallow-water").is_some() => "shallow water",
        () if interaction(scene, "voronoi").is_some() => "Voronoi cells",
        () if are_stored(plan) => "stored particles",
        () => "particles in cells",
    }
}

/// Plans with a feature and without it, of all shipped scenes that can have it, with the kind of each pair. Those whose
/// particles are in cells are also made with a list.
fn pairs_of_plans(feature: &Feature) -> Vec<(&'static str, Plan, Plan)> {
    let mut pairs = Vec::new();
    for (number, (_, mut ground)) in shipped().into_iter().enumerate() {
        (feature.ground)(&mut ground);
        // Else it is chosen by all that moves particles, and with it what lists them.
        set(&mut ground, "dpd", "skin", json!(0.3));
        let [mut on, mut off] = [ground.clone(), ground];
        (feature.with)(&mut on);
        (feature.without)(&mut off);
        if on == off {
            continue;
        }
        for listed in [false, true] {
            let plans = [&on, &off].map(|scene| plan_of(scene, ADAPTERS[number % 2], listed));
            let [Some(with), Some(without)] = plans else { break };
            // Some features need another order of particles, and with it other kernels as a whole.
            if are_stored(&with) != are_stored(&without) {
                continue;
            }
            let kind = kind(&on, &with);
            pairs.push((kind, with, without));
            if kind != "particles in cells" {
                break;
            }
        }
    }
    pairs
}

/// What is in the way of a feature: kernels and arrays that are not those it names, and traces of it where it is off. Adds everything
/// else by which plans differ to what is found of each kind.
fn examine(feature: &Feature, found: &mut BTreeMap<String, BTreeSet<String>>) -> Vec<String> {
    let mut complaints = Vec::new();
    let (mut more, mut instead) = (BTreeSet::new(), BTreeSet::new());
    let pairs = pairs_of_plans(feature);
    if pairs.is_empty() {
        complaints.push("no shipped scene can have it".to_owned());
    }
    for (kind, with, without) in &pairs {
        for trace in differences::names(without) {
            if feature.own.into_iter().flatten().any(|own| trace.contains(own)) {
                complaints.push(format!("{kind}: {trace} is there without it"));
            }
        }
        let differences = differences(with, without);
        if feature.own.is_none() {
            complaints
                .extend(differences.iter().map(|difference| format!("{kind}: it is for the host and {difference}")));
        } else if differences.is_empty() && feature.always {
            complaints.push(format!("{kind}: it changes nothing"));
        }
        for difference in differences {
            if let Some(name) = ["has kernel ", "has array "].iter().find_map(|what| difference.strip_prefix(what)) {
                more.insert(name.to_owned());
            } else if let Some(name) =
                ["lacks kernel ", "lacks array "].iter().find_map(|what| difference.strip_prefix(what))
            {
                instead.insert(name.to_owned());
            } else {
                found.entry(format!("{}, {kind}", feature.name)).or_default().insert(difference);
            }
        }
    }
    let mut compare = |what: &str, found: &BTreeSet<String>, named: &[&str]| {
        let named: BTreeSet<String> = named.iter().map(|name| (*name).to_owned()).collect();
        complaints.extend(found.difference(&named).map(|name| format!("`{name}` is {what} and not named")));
        complaints.extend(named.difference(found).map(|name| format!("`{name}` is named and not {what}")));
    };
    compare("there with it", &more, feature.more);
    compare("there without it", &instead, feature.instead);
    complaints
}

/// Sentences by what they are about, a line each.
fn lines(sentences: &BTreeSet<String>) -> String {
    let mut groups: BTreeMap<String, Vec<&str>> = BTreeMap::new();
    for sentence in sentences {
        let (about, name) = sentence.rsplit_once(' ').unwrap();
        groups.entry(about.to_owned()).or_default().push(name);
    }
    groups.into_iter().fold(String::new(), |mut text, (about, names)| {
        writeln!(text, "    {about} {}", names.join(" ")).unwrap();
        text
    })
}

#[test]
fn features_that_are_off_leave_nothing_and_change_nothing_else() {
    let all = features();
    let mut found = BTreeMap::new();
    let mut complaints = BTreeMap::new();
    thread::scope(|scope| {
        let halves = all.chunks(all.len().div_ceil(2)).map(|some| {
            scope.spawn(move || {
                let mut found = BTreeMap::new();
                let complaints: Vec<_> =
                    some.iter().map(|feature| (feature.name, examine(feature, &mut found))).collect();
                (found, complaints)
            })
        });
        for half in halves.collect::<Vec<_>>() {
            let (some, more) = half.join().unwrap();
            found.extend(some);
            for (feature, list) in more {
                complaints.extend(list.into_iter().map(|complaint| (complaint, feature.to_owned())));
            }
        }
    });
    report(&complaints);
    let now = found.iter().fold(String::new(), |text, (title, sentences)| text + title + "\n" + &lines(sentences));
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/shaders/required/required.txt");
    if std::env::var_os("MESOSCOPE_RECORD").is_some() {
        std::fs::write(&path, &now).unwrap();
    }
    let recorded = std::fs::read_to_string(&path).unwrap();
    let titled = |text: &str| {
        let mut title = String::new();
        let line = |line: &str| {
            if !line.starts_with(' ') {
                line.clone_into(&mut title);
            }
            format!("{title}: {}", line.trim())
        };
        text.lines().map(line).collect::<BTreeSet<String>>()
    };
    let (before, after) = (titled(&recorded), titled(&now));
    let only = |one: &BTreeSet<String>, other: &BTreeSet<String>| {
        one.difference(other).take(8).cloned().collect::<Vec<_>>().join("\n    ")
    };
    assert!(
        recorded == now,
        "features change plans in other ways than {} says. If that is meant, record it with MESOSCOPE_RECORD=1 and say why.\n\
         recorded:\n    {}\nnow:\n    {}",
        path.display(),
        only(&before, &after),
        only(&after, &before)
    );
}

#[test]
fn what_is_written_as_off_is_as_if_it_were_not_written() {
    let mut complaints = BTreeMap::new();
    for (name, off, never) in ways_to_say_off() {
        let mut compared = 0;
        for (number, (scene, [mut one, mut other])) in
            shipped().into_iter().map(|(name, scene)| (name, [scene.clone(), scene])).enumerate()
        {
            off(&mut one);
            never(&mut other);
            let plans = [&one, &other].map(|scene| plan_of(scene, ADAPTERS[number % 2], false));
            let [Some(one_plan), Some(other_plan)] = plans else { continue };
            compared += usize::from(one != other);
            for difference in differences(&one_plan, &other_plan) {
                complaints.entry(format!("{name}: {difference}")).or_insert(scene.to_owned());
            }
        }
        if compared == 0 {
            complaints.entry(format!("{name}: no shipped scene can say it")).or_insert(String::new());
        }
    }
    report(&complaints);
}

/// Every kernel of every plan that a scene can ask for declares nothing that its entry point does not use, and no
/// branch is left to a number of the plan but those that are known.
#[test]
fn kernels_declare_and_branch_on_nothing_that_is_not_needed() {
    let mut complaints = BTreeMap::new();
    let mut branches: BTreeSet<String> = BTreeSet::new();
    let mut seen = BTreeSet::new();
    for (scene, plan) in plans() {
        for kernel in &plan.kernels {
            let shader = shader(kernel);
            if !seen.insert(std::ptr::from_ref(shader)) {
                continue;
            }
            let mut complain = |complaint: String| {
                complaints.entry(format!("kernel `{}`: {complaint}", kernel.name)).or_insert(scene.clone());
            };
            let module = &shader.module;
            let bound = module.global_variables.iter().filter(|(_, variable)| variable.binding.is_some()).count();
            if bound != shader.bindings.len() {
                complain(format!("declares {bound} bindings and uses {}", shader.bindings.len()));
            }
            let counts =
                |module: &naga::Module| [module.overrides.len(), module.functions.len(), module.global_variables.len()];
            let mut compact = module.clone();
            naga::compact::compact(&mut compact, naga::compact::KeepUnused::No);
            if counts(&compact) != counts(module) {
                complain("declares constants, functions or variables that it does not use".to_owned());
            }
            branches.extend(branches::on_constants(module));
        }
    }
    report(&complaints);
    let known: BTreeSet<String> =
        branches::KNOWN.iter().chain(&branches::LAWS).map(|name| (*name).to_owned()).collect();
    assert_eq!(branches, known);
}

/// Every shipped scene: each kernel is run by some stage, each array is bound by some kernel, and each kernel finds its arrays.
#[test]
fn shipped_scenes_hold_what_they_run_and_nothing_else() {
    let mut complaints = BTreeMap::new();
    for (name, _) in shipped() {
        for hardware in ADAPTERS {
            let plan = plan_as_it_is(&scene::load(name, &[]).unwrap(), hardware, false);
            let mut complain = |complaint: String| {
                complaints.entry(complaint).or_insert(name.to_owned());
            };
            let run: BTreeSet<usize> = differences::stages(&plan)
                .into_iter()
                .chain(plan.samplers.iter().map(|sampler| &sampler.kernels))
                .chain([&plan.paths.kernels])
                .flatten()
                .copied()
                .collect();
            let bound: BTreeSet<_> = (plan.kernels.iter())
                .flat_map(|kernel| {
                    linked(kernel, &plan).shader.bindings.iter().map(|binding| kernel.array_of(binding.array))
                })
                .collect();
            let buffers = plan.buffers.iter().map(|buffer| buffer.array);
            let held: BTreeSet<_> = buffers.chain(plan.textures.iter().map(|texture| texture.array)).collect();
            for (index, kernel) in plan.kernels.iter().enumerate().filter(|(index, _)| !run.contains(index)) {
                complain(format!("kernel {index}, `{}`, is never run", kernel.name));
            }
            for array in held.difference(&bound) {
                complain(format!("no kernel binds `{}`", array.name()));
            }
            for array in bound.difference(&held) {
                complain(format!("there is no `{}`", array.name()));
            }
        }
    }
    report(&complaints);
}
