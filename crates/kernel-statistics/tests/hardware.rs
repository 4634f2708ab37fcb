//! What a compiler of graphics cards makes of every kernel of every shipped scene, compared with a committed table.
//!
//! Mesa's driver of AMD cards compiles for a card that is not there, so that no change of a kernel loses registers, or begins to spill them,
//! unseen. Numbers are those of one version of the compiler: elsewhere nothing is compared, and the test says so. A change that is meant is
//! recorded by running this test with `MESOSCOPE_RECORD=1`; the commit says why.
#![allow(clippy::unwrap_used)]

use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::io::Write as _;
use std::num::NonZero;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::thread;

use mesoscope::gpu::link;
use mesoscope::plan::{Hardware, Kernel, Options, Plan};
use mesoscope::scene;
use naga::back::pipeline_constants::process_overrides;
use naga::back::spv;
use naga::proc::{BoundsCheckPolicies, BoundsCheckPolicy};
use naga::valid::{Capabilities, ValidationFlags, Validator};

/// The card that is compiled for: AMD's RDNA 3 (Radeon RX 7900).
const CARD: &str = "GFX1100";

/// Columns of the table: the head, and the statistics of the driver that they add up.
const COLUMNS: [(&str, &[&str]); 9] = [
    ("registers", &["VGPRs"]),
    ("spilled", &["Spilled VGPRs", "Spilled SGPRs"]),
    ("scratch", &["Scratch size"]),
    ("workgroup", &["LDS size"]),
    ("waves", &["Subgroups per SIMD"]),
    ("instructions", &["Instructions"]),
    ("branches", &["Branches"]),
    ("latency", &["Latency"]),
    ("throughput", &["Inverse Throughput"]),
];

/// A kernel as a pipeline is made of it: what two plans have in common is compiled once.
struct Compiled {
    kernel: Kernel,
    spirv: Vec<u8>,
}

impl Compiled {
    /// Links a kernel and writes the SPIR-V that wgpu 30 gives a Vulkan driver of version 1.3 which checks the bounds of buffers by itself.
    fn new(kernel: &Kernel, plan: &Plan) -> Self {
        let constants: Vec<_> = kernel.constants_in(plan).collect();
        let linked = link(kernel.name, kernel.entry, &kernel.choices).unwrap().specialized(&constants);
        let linked = linked.divided(|variable| plan.portions.get(&kernel.array_of(variable)).copied()).unwrap();
        let info = Validator::new(ValidationFlags::all(), Capabilities::all()).validate(&linked.module).unwrap();
        let used = constants.into_iter().filter(|(constant, _)| linked.constants.contains(constant));
        let constants = used.map(|(constant, value)| (constant.name().to_owned(), value)).collect();
        let entry = (naga::ShaderStage::Compute, kernel.entry.name());
        let (module, info) = process_overrides(&linked.module, &info, Some(entry), &constants).unwrap();
        let options = spv::Options {
            lang_version: (1, 6),
            flags: spv::WriterFlags::LABEL_VARYINGS | spv::WriterFlags::FORCE_POINT_SIZE,
            bounds_check_policies: BoundsCheckPolicies {
                index: BoundsCheckPolicy::Restrict,
                buffer: BoundsCheckPolicy::Unchecked,
                image_load: BoundsCheckPolicy::Unchecked,
                binding_array: BoundsCheckPolicy::Unchecked,
            },
            zero_initialize_workgroup_memory: spv::ZeroInitializeWorkgroupMemoryMode::None,
            force_loop_bounding: linked.counts_loops,
            emit_int_div_checks: true,
            ..spv::Options::default()
        };
        let pipeline = spv::PipelineOptions { shader_stage: entry.0, entry_point: entry.1.to_owned() };
        let words = spv::write_vec(&module, &info, &options, Some(&pipeline)).unwrap();
        let spirv = words.into_iter().flat_map(u32::to_le_bytes).collect();
        Self { kernel: kernel.clone(), spirv }
    }
}

/// The most that wgpu lets a kernel bind of one array, on cards of every maker.
const LARGEST_BINDING: u64 = (1 << 31) - 4;

/// The shipped scenes as a graphics card runs them, the standard fluid with both ways of a leapfrog step and of a split one to visit pairs,
/// and with as many particles as a large card has memory for.
fn plans() -> Vec<(String, Plan)> {
    let hardware = Hardware { largest_binding: Some(LARGEST_BINDING), ..Hardware::default() };
    let plan = |name: &str, set: &[String], hardware: Hardware| {
        let scene = scene::load(name, set).unwrap();
        mesoscope::run::plan(&scene, hardware, Options::default())
    };
    let large = [551, 694].map(|edge| {
        let plan = plan("dpd-fluid", &[format!("space.box=[{edge},{edge},{edge}]")], hardware);
        (format!("dpd-fluid, {} million particles", plan.particles / 1_000_000), plan)
    });
    let leapfrog = ["integrator.type=groot-warren".to_owned()];
    let queue = Hardware { queues_pairs: true, ..hardware };
    let others = [
        ("dpd-fluid, groot-warren".to_owned(), plan("dpd-fluid", &leapfrog, hardware)),
        ("dpd-fluid, groot-warren, pairs from a queue".to_owned(), plan("dpd-fluid", &leapfrog, queue)),
        ("dpd-fluid, pairs from a queue".to_owned(), plan("dpd-fluid", &[], queue)),
    ];
    let shipped = scene::builtin().iter().map(|scene| (scene.name.to_owned(), plan(scene.name, &[], hardware)));
    shipped.chain(others).chain(large).collect()
}

/// A thousand million particles need some seventy bytes each and several bindings an array, which every graphics card has.
#[test]
fn a_thousand_million_particles_are_planned() {
    let plans = plans();
    for (name, plan) in plans.iter().rev().take(2) {
        assert!(plan.particles > 500_000_000, "{name}");
        assert!(plan.largest_buffer() <= LARGEST_BINDING, "{name} binds {} bytes at once", plan.largest_buffer());
        // An 80 GiB card holds them.
        assert!(plan.bytes() < 80 << 30, "{name} takes {} bytes", plan.bytes());
        assert!(plan.storage_buffers < 64, "{name} binds {} buffers", plan.storage_buffers);
    }
}

/// The manifest of Mesa's driver of AMD cards, where it is installed.
fn driver() -> Option<PathBuf> {
    let folders = ["/usr/share/vulkan/icd.d", "/usr/local/share/vulkan/icd.d", "/etc/vulkan/icd.d"];
    let files = folders.iter().filter_map(|folder| std::fs::read_dir(folder).ok()).flatten().flatten();
    let mut manifests: Vec<PathBuf> = files.map(|file| file.path()).collect();
    manifests.retain(|path| path.file_name().is_some_and(|name| name.to_string_lossy().starts_with("radeon_icd")));
    // Drivers of other architectures may lie beside that of this one.
    manifests.sort_by_key(|path| !path.to_string_lossy().contains(std::env::consts::ARCH));
    manifests.into_iter().next()
}

/// Compiles files of SPIR-V, as many at a time as there are cores: the statistics of each by name.
fn compile(driver: &Path, files: &[PathBuf]) -> BTreeMap<PathBuf, BTreeMap<String, f64>> {
    let threads = thread::available_parallelism().map_or(1, NonZero::get);
    let outputs: Vec<String> = thread::scope(|scope| {
        // By turns, since kernels that take long are neighbours.
        let share = |first: usize| files.iter().skip(first).step_by(threads);
        let workers: Vec<_> = (0..threads).map(|first| scope.spawn(move || run(driver, share(first)))).collect();
        workers.into_iter().map(|worker| worker.join().unwrap().unwrap()).collect()
    });
    let statistics = |line: &str| -> (PathBuf, BTreeMap<String, f64>) {
        let mut fields = line.split('\t');
        let file = PathBuf::from(fields.next().unwrap());
        let numbers = fields.filter_map(|field| field.split_once('='));
        (file, numbers.map(|(name, number)| (name.to_owned(), number.parse().unwrap())).collect())
    };
    outputs.iter().flat_map(|output| output.lines().skip(1)).map(statistics).collect()
}

/// What the program prints of files, or why it cannot: device and version first, then a line for each file.
fn run<'a>(driver: &Path, files: impl Iterator<Item = &'a PathBuf>) -> Result<String, String> {
    let output = Command::new(env!("CARGO_BIN_EXE_kernel-statistics"))
        .args(files)
        .env("VK_DRIVER_FILES", driver)
        .env("VK_ICD_FILENAMES", driver)
        .env("RADV_FORCE_FAMILY", CARD)
        .env("RADV_DEBUG", "nocache")
        .env_remove("VK_INSTANCE_LAYERS")
        .output()
        .unwrap();
    if !output.status.success() {
        return Err(format!("{}: {}", output.status, String::from_utf8_lossy(&output.stderr).trim()));
    }
    Ok(String::from_utf8_lossy(&output.stdout).into_owned())
}

/// A shipped scene: its plan and, of each kernel, the place among all that are compiled.
struct Row {
    scene: String,
    plan: Plan,
    places: Vec<usize>,
}

/// Dispatches and bytes of a step: each dispatch is taken to pass once over every array that it binds. wgpu puts a barrier before each, as all
/// arrays are bound to be written and each has been bound in the step before.
fn step(plan: &Plan) -> String {
    let kernels = [&plan.sort, &plan.before_report, &plan.advance].into_iter().flatten();
    let (certain, on_demand): (Vec<&usize>, Vec<&usize>) =
        kernels.partition(|kernel| plan.kernels[**kernel].demand.is_none());
    let more = match on_demand.len() {
        0 => String::new(),
        some => format!(", {some} more on demand"),
    };
    format!(
        "{} dispatches a step, each behind a barrier{more}; {} bytes held a particle, {} bound a step",
        certain.len(),
        plan.bytes().div_ceil(plan.particles.max(1)),
        plan.bytes_bound_in_a_step().div_ceil(plan.particles.max(1))
    )
}

/// The table, without its first line.
fn table(rows: &[Row], numbers: &[BTreeMap<String, f64>]) -> String {
    let mut text = String::new();
    for Row { scene, plan, places } in rows {
        writeln!(text, "\n{scene}: {}", step(plan)).unwrap();
        write!(text, "  {:30}", "").unwrap();
        for (head, _) in COLUMNS {
            write!(text, "{head:>13}").unwrap();
        }
        text.push('\n');
        for (kernel, place) in plan.kernels.iter().zip(places) {
            write!(text, "  {:30}", kernel.name).unwrap();
            for (_, names) in COLUMNS {
                let sum: f64 = names.iter().map(|name| numbers[*place].get(*name).copied().unwrap_or_default()).sum();
                write!(text, "{sum:>13}").unwrap();
            }
            text.push('\n');
        }
    }
    text
}

#[test]
fn every_kernel_of_the_shipped_scenes_compiles_as_recorded() {
    // Passes the harness, which hides what a test that succeeds prints.
    let skip = |reason: &str| {
        let _ = writeln!(std::io::stderr(), "hardware table: not compared, {reason}");
    };
    let Some(driver) = driver() else {
        return skip("for Mesa's driver of AMD cards is not installed (mesa-vulkan-drivers)");
    };
    let version = match run(&driver, std::iter::empty()) {
        Ok(version) => version.trim_end().to_owned(),
        Err(reason) => return skip(&format!("for Mesa's driver of AMD cards does not open: {reason}")),
    };
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/hardware.txt");
    let records = std::env::var_os("MESOSCOPE_RECORD").is_some();
    let recorded = std::fs::read_to_string(&path).unwrap_or_default();
    let known_version = recorded.lines().next().unwrap_or_default();
    if !records && known_version != version {
        return skip(&format!("for it was recorded with `{known_version}`, and here is `{version}`"));
    }
    let mut compiled: Vec<Compiled> = Vec::new();
    let mut known: BTreeMap<Vec<u8>, usize> = BTreeMap::new();
    let mut rows = Vec::new();
    for (scene, plan) in plans() {
        let mut places = Vec::new();
        for kernel in &plan.kernels {
            let new = Compiled::new(kernel, &plan);
            let next = compiled.len();
            let place = *known.entry(new.spirv.clone()).or_insert(next);
            if place == next {
                compiled.push(new);
            }
            places.push(place);
        }
        rows.push(Row { scene, plan, places });
    }
    let folder = tempfile::tempdir().unwrap();
    let files: Vec<PathBuf> = (0..compiled.len()).map(|number| folder.path().join(format!("{number}.spv"))).collect();
    for (file, kernel) in files.iter().zip(&compiled) {
        std::fs::write(file, &kernel.spirv).unwrap();
    }
    let statistics = compile(&driver, &files);
    let numbers: Vec<BTreeMap<String, f64>> = files.iter().map(|file| statistics[file].clone()).collect();
    let seconds = numbers.iter().map(|number| number["milliseconds"]).sum::<f64>() / 1e3;
    let slowest =
        numbers.iter().zip(&compiled).max_by(|a, b| a.0["milliseconds"].total_cmp(&b.0["milliseconds"])).unwrap();
    println!(
        "{} kernels compiled in {seconds:.1} s, the slowest `{}` in {:.0} ms",
        compiled.len(),
        slowest.1.kernel.name,
        slowest.0["milliseconds"]
    );

    let now = format!("{version}\n{}", table(&rows, &numbers));
    if records {
        std::fs::write(&path, &now).unwrap();
        return;
    }
    let differing = recorded.lines().zip(now.lines()).filter(|(before, after)| before != after);
    let list: Vec<String> = differing.map(|(before, after)| format!("- {before}\n+ {after}")).collect();
    assert!(
        recorded == now,
        "a graphics card gets other code than recorded; if that is meant, run this test with MESOSCOPE_RECORD=1 and say why.\n{}",
        list.join("\n")
    );
}
