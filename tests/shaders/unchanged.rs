//! What all kernels compute and what all plans dispatch, compared with a committed record: a change of structure that leaves
//! the hashes leaves results and speed as they are.
//!
//! A change that is meant is recorded by running this test with `MESOSCOPE_RECORD=1`; the commit says why.

use std::collections::BTreeMap;
use std::fmt::Write;
use std::path::Path;

use mesoscope::gpu::LinkedShader;
use mesoscope::plan::{Contents, Kernel, Plan, Texture};

use crate::canonical::{hash, hash_of_kernel};
use crate::variants::{plans, shader as shader_of};

/// Hashes of distinct kernels, and of plans in groups of sixteen, in words of eight digits.
fn record() -> String {
    let mut hashes: BTreeMap<*const LinkedShader, u64> = BTreeMap::new();
    let mut kernels: Vec<u64> = Vec::new();
    let mut hashes_of_plans: Vec<(String, u64)> = Vec::new();
    for (scene, plan) in plans() {
        let mut text = String::new();
        for kernel in &plan.kernels {
            let shader = shader_of(kernel);
            let computed = *hashes.entry(std::ptr::from_ref(shader)).or_insert_with(|| hash_of_kernel(&shader.module));
            kernels.push(computed);
            writeln!(text, "{computed:x} {}", dispatch(plan, kernel, shader)).unwrap();
        }
        describe(plan, &mut text);
        hashes_of_plans.push((group(scene).to_owned(), hash(&text)));
    }
    kernels.sort_unstable();
    kernels.dedup();
    let mut text = format!("kernels {}\n", kernels.len());
    lines(&kernels, &mut text);
    let mut groups: BTreeMap<String, Vec<u64>> = BTreeMap::new();
    for (group, hash) in hashes_of_plans {
        groups.entry(group).or_default().push(hash);
    }
    for (group, hashes) in groups {
        writeln!(text, "plans of {group} {}", hashes.len()).unwrap();
        lines(&hashes.chunks(16).map(|some| hash(&format!("{some:x?}"))).collect::<Vec<_>>(), &mut text);
    }
    text
}

fn group(scene: &str) -> &'static str {
    ["water", "Voronoi"].into_iter().find(|family| scene.contains(family)).unwrap_or("particles")
}

fn lines(hashes: &[u64], text: &mut String) {
    for line in hashes.chunks(14) {
        let words: Vec<String> = line.iter().map(|hash| format!("{:08x}", (hash ^ (hash >> 32)) as u32)).collect();
        writeln!(text, "{}", words.join(" ")).unwrap();
    }
}

/// Size and constants of a kernel, and what it binds, which is known by size and not by name.
fn dispatch(plan: &Plan, kernel: &Kernel, shader: &LinkedShader) -> String {
    let mut constants: Vec<(&str, u64)> = (kernel.constants.iter().chain(&plan.constants))
        .filter(|(constant, _)| shader.constants.contains(constant))
        .map(|(constant, value)| (constant.name(), value.to_bits()))
        .collect();
    // Those of the kernel come first and hold.
    constants.sort_by_key(|(name, _)| *name);
    constants.dedup_by_key(|(name, _)| *name);
    let mut bound: Vec<u64> = (shader.bindings.iter())
        .map(|binding| {
            let array = kernel.array_of(binding.array);
            let buffer = plan.buffers.iter().find(|buffer| buffer.array == array).map(|buffer| buffer.bytes);
            let texture = plan.textures.iter().find(|texture| texture.array == array).map(Texture::bytes);
            buffer.or(texture).unwrap_or(0)
        })
        .collect();
    bound.sort_unstable();
    format!("{} {:?} {constants:x?} {bound:?} {}", kernel.workgroups, kernel.demand, kernel.takes_long)
}

/// What a plan holds beside its kernels.
fn describe(plan: &Plan, text: &mut String) {
    let contents = |contents: &Contents| contents.bytes().map(|bytes| (bytes.len(), hash(&format!("{bytes:x?}"))));
    let mut buffers: Vec<_> = plan.buffers.iter().map(|buffer| (buffer.bytes, contents(&buffer.contents))).collect();
    buffers.sort_unstable();
    let mut textures: Vec<_> =
        plan.textures.iter().map(|texture| (texture.size, texture.words, contents(&texture.contents))).collect();
    textures.sort_unstable();
    let samplers: Vec<_> = (plan.samplers.iter())
        .map(|s| (s.first, s.every, &s.kernels, s.quantities, s.capacity, s.needs_report, s.window.map(|w| w.samples)))
        .collect();
    let stages = [&plan.prepare, &plan.sort, &plan.tidy, &plan.before_report, &plan.report, &plan.advance];
    writeln!(text, "{buffers:?} {textures:?} {samplers:?} {stages:?} {:?}", plan.finish_report).unwrap();
}

#[test]
fn kernels_and_plans_are_those_of_the_record() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/shaders/unchanged.txt");
    let now = record();
    if std::env::var_os("MESOSCOPE_RECORD").is_some() {
        std::fs::write(&path, &now).unwrap();
    }
    let recorded = std::fs::read_to_string(&path).unwrap();
    let differing: Vec<String> = (recorded.lines().zip(now.lines()))
        .filter(|(before, after)| before != after)
        .take(5)
        .map(|(before, after)| format!("recorded: {before}\nnow:      {after}"))
        .collect();
    assert!(
        recorded == now,
        "kernels or plans differ from tests/shaders/unchanged.txt ({} lines, now {}). If that is meant, record it with \
         MESOSCOPE_RECORD=1 and say why.\n{}",
        recorded.lines().count(),
        now.lines().count(),
        differing.join("\n")
    );
}
