//! Kernels, stage by stage, and buffers.

use std::collections::BTreeSet;
use std::fmt::Write as _;

use mesoscope::gpu::{self, GpuError};
use mesoscope::numbers::{bytes, counted_in_groups, six_digits};
use mesoscope::plan::{Kernel, Plan, TIDYING};
use mesoscope::shaders::{Choice, Constant, linked_text, space};

use super::interval;
use crate::cli::Failure;
use crate::cli::table::aligned;

/// All kernels, stage by stage, and the buffers.
pub fn kernels(text: &mut String, plan: &Plan) -> Result<(), Failure> {
    let tidying = format!("Every {TIDYING} steps: sort them in memory too");
    let stages = [
        ("Once, before the first step", &plan.prepare),
        ("Every step: order the particles by cell", &plan.sort),
        (tidying.as_str(), &plan.tidy),
        ("Every step: before anything is measured", &plan.before_report),
        ("Every step without a measurement", &plan.advance),
        ("Every step with a measurement: measure", &plan.report),
        ("Every step with a measurement: finish it", &plan.finish_report),
    ];
    let shared = Shared::of(plan)?;
    text.push_str("\nShared by all kernels\n");
    wrapped(text, "laws", shared.laws.iter().filter_map(|name| constant(&plan.constants, *name)));
    if !shared.choices.is_empty() {
        text.push_str("\nShared by all kernels that see particles\n");
    }
    wrapped(text, "choices", shared.choices.iter().map(|choice| choice.path().to_owned()));
    wrapped(text, "constants", shared.constants.iter().filter_map(|name| constant(&plan.constants, *name)));
    let mut described = Vec::new();
    for (heading, kernels) in stages {
        section(text, heading, plan, kernels, &shared, &mut described)?;
    }
    for sampler in &plan.samplers {
        let heading = format!("{}: {}", sampler.id.name(), interval(sampler.first, sampler.every));
        section(text, &heading, plan, &sampler.kernels, &shared, &mut described)?;
    }
    buffers(text, plan);
    Ok(())
}

/// The linked text of a kernel, each part with the file and the line that it is from.
pub fn shader(plan: &Plan, name: &str) -> Result<String, Failure> {
    let kernel = plan.kernels.iter().find(|kernel| kernel.name == name || kernel.entry.name() == name);
    let Some(kernel) = kernel else {
        let mut known: Vec<&str> = plan.kernels.iter().map(|kernel| kernel.name).collect();
        known.sort_unstable();
        known.dedup();
        return Err(Failure::usage(format!("this scene has no kernel `{name}`; it has {}", known.join(", "))));
    };
    let linked =
        linked_text(kernel.entry, &kernel.choices).map_err(|unlinked| GpuError::unlinked(kernel.name, unlinked))?;
    let mut text = String::new();
    let mut lines = linked.text.lines();
    for (index, part) in linked.parts.iter().enumerate() {
        let end = linked.parts.get(index + 1).map_or(usize::MAX, |next| next.begins as usize);
        let _ = writeln!(text, "// shaders/{}.wgsl:{}", part.path, part.line);
        for line in lines.by_ref().take(end - part.begins as usize) {
            let _ = writeln!(text, "{line}");
        }
        text.push('\n');
    }
    Ok(text)
}

fn constant(constants: &[(Constant, f64)], name: Constant) -> Option<String> {
    let (name, value) = constants.iter().find(|(known, _)| *known == name)?;
    Some(format!("{} = {}", name.name(), six_digits(*value)))
}

/// The choices and constants of all kernels that see particles, and the constants on which branches of any kernel
/// depend, so that they need not be listed with each.
struct Shared {
    choices: Vec<Choice>,
    constants: Vec<Constant>,
    laws: BTreeSet<Constant>,
}

impl Shared {
    fn of(plan: &Plan) -> Result<Self, Failure> {
        let mut laws = BTreeSet::new();
        let mut shared: Option<(Vec<Choice>, Vec<Constant>)> = None;
        for kernel in &plan.kernels {
            let whole = gpu::link(kernel.name, kernel.entry, &kernel.choices)?;
            laws.extend(whole.switches.iter().copied());
            let choices = kernel_choices(kernel)?;
            // The others do not see particles.
            if !space::MassOfParticle::ALL.iter().any(|variant| choices.contains(&(*variant).into())) {
                continue;
            }
            let all: Vec<(Constant, f64)> = kernel.constants_in(plan).collect();
            let constants = whole.specialized(&all).constants;
            // A constant that a kernel sets for itself is not shared.
            let own = |name: &Constant| kernel.constants.iter().any(|(known, _)| known == name);
            match &mut shared {
                None => shared = Some((choices, constants.into_iter().filter(|name| !own(name)).collect())),
                Some((shared_choices, shared_constants)) => {
                    shared_choices.retain(|choice| choices.contains(choice));
                    shared_constants.retain(|name| constants.contains(name) && !own(name));
                }
            }
        }
        let (choices, constants) = shared.unwrap_or_default();
        Ok(Self { choices, constants, laws })
    }

    /// Whether a kernel with these choices is one of those.
    fn among(&self, choices: &[Choice]) -> bool {
        self.choices.iter().all(|choice| choices.contains(choice))
    }
}

/// Kernels under a heading; one that has been described before is only named.
fn section(
    text: &mut String,
    heading: &str,
    plan: &Plan,
    kernels: &[usize],
    shared: &Shared,
    described: &mut Vec<usize>,
) -> Result<(), Failure> {
    if kernels.is_empty() {
        return Ok(());
    }
    let _ = writeln!(text, "\n{heading}");
    for (place, &index) in kernels.iter().enumerate() {
        if kernels[..place].contains(&index) {
            continue;
        }
        let kernel = &plan.kernels[index];
        let workgroups = counted_in_groups(kernel.workgroups.into(), "workgroup");
        let times = match kernels.iter().filter(|other| **other == index).count() {
            1 => String::new(),
            count => format!(", {count} times"),
        };
        let _ = writeln!(text, "  {}, {workgroups}{times}", kernel.name);
        if described.contains(&index) {
            continue;
        }
        described.push(index);
        let constants: Vec<(Constant, f64)> = kernel.constants_in(plan).collect();
        let whole = gpu::link(kernel.name, kernel.entry, &kernel.choices)?;
        let used = whole.specialized(&constants);
        let choices = kernel_choices(kernel)?;
        wrapped(text, "kernel", std::iter::once(kernel.entry.name().to_owned()));
        let own = |choice: &&Choice| !shared.among(&choices) || !shared.choices.contains(choice);
        wrapped(text, "choices", choices.iter().filter(own).map(|choice| choice.path().to_owned()));
        let own = used.constants.iter().filter(|name| !shared.among(&choices) || !shared.constants.contains(*name));
        wrapped(text, "constants", own.filter_map(|name| constant(&constants, *name)));
        let laws = whole.switches.iter().filter(|name| kernel.constants.iter().any(|(own, _)| own == *name));
        wrapped(text, "laws", laws.filter_map(|name| constant(&constants, *name)));
        let arrays = used.bindings.iter().map(|binding| kernel.array_of(binding.array).name().to_owned());
        wrapped(text, "buffers", arrays);
    }
    Ok(())
}

/// The variants that a kernel comes to.
fn kernel_choices(kernel: &Kernel) -> Result<Vec<Choice>, Failure> {
    let files = kernel.files().map_err(|unlinked| GpuError::unlinked(kernel.name, unlinked))?;
    Ok(kernel.choices.iter().filter(|choice| files.contains(choice.path())).collect())
}

/// A label and a list, broken into lines of at most 110 characters.
fn wrapped(text: &mut String, label: &str, items: impl Iterator<Item = String>) {
    let items: Vec<String> = items.collect();
    let mut line = format!("      {label:<9} ");
    let indent = line.len();
    for (place, item) in items.iter().enumerate() {
        if place > 0 && line.chars().count() + item.chars().count() > 109 {
            let _ = writeln!(text, "{}", line.trim_end());
            line = " ".repeat(indent);
        }
        line.push_str(item);
        line.push_str(if place + 1 < items.len() { ", " } else { "\n" });
    }
    if !items.is_empty() {
        text.push_str(&line);
    }
}

fn buffers(text: &mut String, plan: &Plan) {
    let textures = plan.textures.iter().map(|texture| (texture.array, texture.bytes()));
    let all = plan.buffers.iter().map(|buffer| (buffer.array, buffer.bytes)).chain(textures);
    let rows: Vec<Vec<String>> =
        all.map(|(array, size)| vec![array.name().to_owned(), bytes(size), array.purpose().to_owned()]).collect();
    let title = if plan.textures.is_empty() { "Buffers" } else { "Buffers and textures" };
    let _ = write!(text, "\n{title}\n{}", aligned(&rows, "  "));
}
