//! What compilers other than naga say of the kernels: Khronos' validator of SPIR-V, and Tint, the compiler of WGSL in Chrome.
//! Either is skipped, and says so, where it is not installed.

use std::collections::{BTreeMap, BTreeSet};
use std::io::Write as _;
use std::num::NonZero;
use std::path::Path;
use std::process::{Command, Stdio};
use std::thread;

use mesoscope::plan::{Kernel, Plan};
use naga::back::{pipeline_constants::process_overrides, spv};
use naga::valid::{Capabilities, ValidationFlags, Validator};

use crate::variants::{plans, report, shader, text};

/// Passes the harness, which keeps to itself what tests that succeed print.
fn skip(test: &str, reason: &str) {
    let _ = writeln!(std::io::stderr(), "{test} was skipped: {reason}");
}

/// Every distinct kernel with the first plan that has it.
fn kernels() -> Vec<(&'static Kernel, &'static Plan)> {
    let mut distinct = BTreeMap::new();
    for (_, plan) in plans() {
        for kernel in &plan.kernels {
            distinct.entry(text(kernel)).or_insert((kernel, plan));
        }
    }
    distinct.into_values().collect()
}

/// As few of the kernels as have every entry point with every file that it can come to.
fn covering() -> Vec<(&'static Kernel, &'static Plan)> {
    let mut covered = BTreeSet::new();
    let mut chosen = kernels();
    // Those of many files first: fewer are needed.
    chosen.sort_by_cached_key(|(kernel, _)| std::cmp::Reverse(kernel.files().unwrap().len()));
    chosen.retain(|(kernel, _)| {
        let before = covered.len();
        covered.extend(kernel.files().unwrap().into_iter().map(|file| (kernel.entry, file)));
        covered.len() > before
    });
    chosen
}

/// The SPIR-V that a Vulkan driver is given for a kernel.
fn spirv(kernel: &Kernel, plan: &Plan) -> Vec<u8> {
    let constants: Vec<_> = kernel.constants_in(plan).collect();
    let linked = shader(kernel).specialized(&constants);
    let info = Validator::new(ValidationFlags::all(), Capabilities::all()).validate(&linked.module).unwrap();
    let declared = constants.into_iter().filter(|(constant, _)| linked.constants.contains(constant));
    let constants = declared.map(|(constant, value)| (constant.name().to_owned(), value)).collect();
    let entry = (naga::ShaderStage::Compute, kernel.entry.name());
    let (module, info) = process_overrides(&linked.module, &info, Some(entry), &constants).unwrap();
    let options = spv::Options {
        lang_version: (1, 3),
        zero_initialize_workgroup_memory: spv::ZeroInitializeWorkgroupMemoryMode::None,
        ..spv::Options::default()
    };
    let pipeline = spv::PipelineOptions { shader_stage: entry.0, entry_point: entry.1.to_owned() };
    let words = spv::write_vec(&module, &info, &options, Some(&pipeline)).unwrap();
    words.into_iter().flat_map(u32::to_le_bytes).collect()
}

/// What `spirv-val` has against a module.
fn complaint(spirv: &[u8]) -> Option<String> {
    let mut validator = Command::new("spirv-val");
    validator.args(["--target-env", "vulkan1.1", "-"]);
    let mut child =
        validator.stdin(Stdio::piped()).stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().expect("spirv-val");
    child.stdin.take().unwrap().write_all(spirv).unwrap();
    let output = child.wait_with_output().unwrap();
    (!output.status.success()).then(|| String::from_utf8_lossy(&[output.stderr, output.stdout].concat()).into_owned())
}

/// Has every kernel validated, by as many threads as there are cores.
fn validate(test: &str, kernels: &[(&Kernel, &Plan)]) {
    if Command::new("spirv-val").arg("--version").output().is_err() {
        skip(test, "`spirv-val` is not installed (Debian, Ubuntu: apt-get install spirv-tools)");
        return;
    }
    // The validator has to complain of something.
    assert!(complaint(b"not SPIR-V at all").is_some());
    let of_share = |share: &[(&Kernel, &Plan)]| -> BTreeMap<String, String> {
        let complaints = share.iter().filter_map(|(kernel, plan)| {
            Some((
                complaint(&spirv(kernel, plan))?,
                format!("{:?} {}", kernel.entry, kernel.choices.paths().collect::<Vec<_>>().join(" ")),
            ))
        });
        complaints.collect()
    };
    let threads = thread::available_parallelism().map_or(1, NonZero::get);
    let complaints: BTreeMap<String, String> = thread::scope(|scope| {
        let shares = kernels.chunks(kernels.len().div_ceil(threads));
        let workers: Vec<_> = shares.map(|share| scope.spawn(move || of_share(share))).collect();
        workers.into_iter().flat_map(|worker| worker.join().unwrap()).collect()
    });
    println!("{} kernels", kernels.len());
    report(&complaints);
}

/// Distinct kernels of plans for any adapter.
fn portable_kernels() -> Vec<&'static Kernel> {
    let portable = |name: &str| name.contains("serial_memory=false") && !name.contains("Clusters");
    let plans = plans().iter().filter(|(name, _)| portable(name)).map(|(_, plan)| plan);
    let kernels: BTreeMap<_, _> = plans.flat_map(|plan| &plan.kernels).map(|kernel| (text(kernel), kernel)).collect();
    assert!(kernels.len() > 500, "only {} distinct kernels", kernels.len());
    kernels.into_values().collect()
}

#[test]
fn plans_for_any_adapter_need_nothing_of_it() {
    for kernel in portable_kernels() {
        let validated = Validator::new(ValidationFlags::all(), Capabilities::empty()).validate(&shader(kernel).module);
        assert!(validated.is_ok(), "`{}`: {:?}", kernel.name, validated.err());
    }
}

#[test]
fn every_module_makes_valid_spirv_in_every_kernel() {
    validate("every_module_makes_valid_spirv_in_every_kernel", &covering());
}

#[test]
#[ignore = "a minute"]
fn every_kernel_makes_valid_spirv() {
    validate("every_kernel_makes_valid_spirv", &kernels());
}

/// Those of plans for any adapter; what software adapters get beside is not WGSL of the standard.
#[test]
#[ignore = "needs Node.js with the package `webgpu`"]
fn tint_takes_every_kernel_of_plans_for_any_adapter() {
    let test = "tint_takes_every_kernel_of_plans_for_any_adapter";
    let judge = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/shaders/tint.mjs");
    let run = |folder: &Path| Command::new("node").arg(&judge).arg(folder).output();
    let folder = tempfile::tempdir().unwrap();
    match run(folder.path()) {
        Ok(output) if output.status.success() => {}
        Ok(output) => return skip(test, &String::from_utf8_lossy(&output.stderr)),
        Err(error) => return skip(test, &format!("`node` does not start: {error}")),
    }
    let kernels = portable_kernels();
    // Some hundred at a time: the process of Node.js keeps all that it has judged.
    let mut refused = Vec::new();
    for share in kernels.chunks(400) {
        let folder = tempfile::tempdir().unwrap();
        for (number, kernel) in share.iter().enumerate() {
            std::fs::write(folder.path().join(format!("{number}-{}.wgsl", kernel.name)), text(kernel)).unwrap();
        }
        let output = run(folder.path()).unwrap();
        if !output.status.success() {
            refused.extend([output.stdout, output.stderr].map(|text| String::from_utf8_lossy(&text).into_owned()));
        }
    }
    assert!(refused.is_empty(), "of {} kernels Tint refuses some: {}", kernels.len(), refused.concat());
}
