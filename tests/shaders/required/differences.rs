//! Everything by which two plans differ, in sentences of what the first has.

use std::collections::{BTreeMap, BTreeSet};
use std::sync::Mutex;

use mesoscope::gpu::{LinkedShader, Switched, validate};
use mesoscope::plan::{Contents, Kernel, Plan};
use mesoscope::shaders::{Choices, Entry, LinkedText, library, linked_text};

use crate::canonical::hash_of_kernel;

/// What is known of a kernel once it is linked.
pub struct Linked {
    pub files: BTreeSet<&'static str>,
    pub shader: LinkedShader,
    hash: u64,
}

/// A kernel, linked and specialized once for all plans that have it.
pub fn linked(kernel: &Kernel, plan: &Plan) -> &'static Linked {
    type Known = BTreeMap<(&'static str, Switched), &'static Linked>;
    static WHOLE: Mutex<BTreeMap<(Entry, Choices), &'static Whole>> = Mutex::new(BTreeMap::new());
    static KNOWN: Mutex<Known> = Mutex::new(BTreeMap::new());
    let key = (kernel.entry, kernel.choices.clone());
    let known = WHOLE.lock().unwrap().get(&key).copied();
    let whole = known.unwrap_or_else(|| {
        let text = linked_text(kernel.entry, &kernel.choices).unwrap();
        let shader = validate(kernel.name, kernel.entry.name(), &text).unwrap();
        WHOLE.lock().unwrap().entry(key).or_insert(Box::leak(Box::new(Whole { text, shader })))
    });
    let constants: Vec<_> = kernel.constants_in(plan).collect();
    let key = (whole.text.text.as_str(), whole.shader.switched(&constants));
    if let Some(linked) = KNOWN.lock().unwrap().get(&key) {
        return linked;
    }
    let shader = whole.shader.specialized(&constants);
    let hash = hash_of_kernel(&shader.module);
    let linked = Box::leak(Box::new(Linked { files: files(&whole.text, &shader.module), shader, hash }));
    KNOWN.lock().unwrap().entry(key).or_insert(linked)
}

/// A kernel with all its branches.
struct Whole {
    text: LinkedText,
    shader: LinkedShader,
}

/// The files of which something is left in a module: a function, a variable or a constant of the plan.
fn files(text: &LinkedText, module: &naga::Module) -> BTreeSet<&'static str> {
    let functions = module.functions.iter().map(|(_, function)| &function.name);
    let variables = module.global_variables.iter().map(|(_, variable)| &variable.name);
    let overrides = module.overrides.iter().map(|(_, constant)| &constant.name);
    let left: BTreeSet<&str> = functions.chain(variables).chain(overrides).flatten().map(String::as_str).collect();
    let entry = module.entry_points[0].name.as_str();
    let declared = |path: &str, line: u32| {
        let library = library().unwrap();
        let file = library.files().iter().find(|file| file.path == path).unwrap();
        file.declarations.iter().find(|declaration| declaration.line == line).unwrap().name
    };
    let parts = text.parts.iter().filter(|part| {
        let name = declared(part.path, part.line);
        name == entry || left.contains(name)
    });
    parts.map(|part| part.path).collect()
}

/// A kernel as it is compared: what it computes, on which arrays, with which numbers.
struct Seen<'a> {
    linked: &'static Linked,
    arrays: BTreeSet<&'static str>,
    constants: BTreeMap<&'static str, u64>,
    kernel: &'a Kernel,
}

impl<'a> Seen<'a> {
    fn of(kernel: &'a Kernel, plan: &Plan) -> Self {
        let linked = linked(kernel, plan);
        let bindings = linked.shader.bindings.iter();
        let constants = kernel.constants_in(plan).filter(|(constant, _)| linked.shader.constants.contains(constant));
        Self {
            linked,
            arrays: bindings.map(|binding| kernel.array_of(binding.array).name()).collect(),
            constants: constants.map(|(constant, value)| (constant.name(), value.to_bits())).collect(),
            kernel,
        }
    }

    fn size(&self) -> (u32, Option<u32>, bool) {
        (self.kernel.workgroups, self.kernel.demand, self.kernel.takes_long)
    }

    fn equals(&self, other: &Self) -> bool {
        self.linked.hash == other.linked.hash
            && self.linked.files == other.linked.files
            && self.arrays == other.arrays
            && self.constants == other.constants
            && self.size() == other.size()
    }

    /// What differs from the same kernel in the other plan.
    fn differences(&self, other: &Self, found: &mut BTreeSet<String>) {
        let name = self.kernel.name;
        let mut sets = |what: &str, own: &BTreeSet<&'static str>, other: &BTreeSet<&'static str>| {
            found.extend(own.difference(other).map(|more| format!("{name} has {what} {more}")));
            found.extend(other.difference(own).map(|less| format!("{name} lacks {what} {less}")));
        };
        sets("file", &self.linked.files, &other.linked.files);
        sets("array", &self.arrays, &other.arrays);
        let names = |seen: &Self| seen.constants.keys().copied().collect::<BTreeSet<_>>();
        sets("constant", &names(self), &names(other));
        let both = self.constants.iter().filter_map(|(name, own)| Some((name, own, other.constants.get(name)?)));
        found.extend(
            both.filter(|(_, own, other)| own != other).map(|(value, ..)| format!("{name} has another {value}")),
        );
        if self.size() != other.size() {
            found.insert(format!("{name} has another size"));
        }
        if self.linked.hash != other.linked.hash && self.linked.files == other.linked.files {
            found.insert(format!("{name} has another text"));
        }
    }
}

/// The stages of a plan in order.
pub fn stages(plan: &Plan) -> [&Vec<usize>; 7] {
    [&plan.prepare, &plan.sort, &plan.tidy, &plan.before_report, &plan.report, &plan.advance, &plan.finish_report]
}

/// What a plan consists of: kernels, arrays, and the constants that kernels declare and the files that they reach.
pub fn names(plan: &Plan) -> BTreeSet<String> {
    let kernels = plan.kernels.iter().map(|kernel| format!("kernel {}", kernel.name));
    let arrays = held(plan).into_keys().map(|array| format!("array {array}"));
    let linked = || plan.kernels.iter().map(|kernel| linked(kernel, plan));
    let constants = linked().flat_map(|linked| &linked.shader.constants);
    let constants = constants.map(|constant| format!("constant {}", constant.name()));
    let files = linked().flat_map(|linked| &linked.files).map(|file| format!("file {file}"));
    kernels.chain(arrays).chain(constants).chain(files).collect()
}

/// Everything by which the first plan differs from the second. Numbers of the plan that no kernel declares stay on the host, and so do
/// estimates and advice.
pub fn differences(first: &Plan, second: &Plan) -> BTreeSet<String> {
    let mut found = BTreeSet::new();
    let mut seen: BTreeMap<&str, [Vec<Seen<'_>>; 2]> = BTreeMap::new();
    for (side, plan) in [first, second].into_iter().enumerate() {
        for kernel in &plan.kernels {
            seen.entry(kernel.name).or_default()[side].push(Seen::of(kernel, plan));
        }
    }
    let mut unpaired: BTreeSet<&str> = BTreeSet::new();
    for (name, [mut own, mut others]) in seen {
        own.retain(|kernel| match others.iter().position(|other| kernel.equals(other)) {
            Some(place) => {
                others.remove(place);
                false
            }
            None => true,
        });
        for (kernel, other) in own.iter().zip(&others) {
            kernel.differences(other, &mut found);
        }
        match own.len().cmp(&others.len()) {
            std::cmp::Ordering::Greater => drop(found.insert(format!("has kernel {name}"))),
            std::cmp::Ordering::Less => drop(found.insert(format!("lacks kernel {name}"))),
            std::cmp::Ordering::Equal => continue,
        }
        unpaired.insert(name);
    }
    let order = |plan: &Plan| {
        let names = |kernels: &Vec<usize>| -> Vec<&str> {
            kernels.iter().map(|kernel| plan.kernels[*kernel].name).filter(|name| !unpaired.contains(name)).collect()
        };
        stages(plan).map(names)
    };
    let titles = ["prepare", "sort", "tidy", "before_report", "report", "advance", "finish_report"];
    let orders = order(first).into_iter().zip(order(second)).zip(titles);
    found.extend(orders.filter(|((own, other), _)| own != other).map(|(_, title)| format!("another order of {title}")));
    arrays(first, second, &mut found);
    compare("sampler", &samplers(first), &samplers(second), &mut found);
    compare("number", &numbers(first), &numbers(second), &mut found);
    found
}

fn compare<T: PartialEq>(
    what: &str,
    own: &BTreeMap<&'static str, T>,
    other: &BTreeMap<&'static str, T>,
    found: &mut BTreeSet<String>,
) {
    found.extend(own.keys().filter(|name| !other.contains_key(*name)).map(|name| format!("has {what} {name}")));
    found.extend(other.keys().filter(|name| !own.contains_key(*name)).map(|name| format!("lacks {what} {name}")));
    let differs = |name: &&&'static str| other.get(**name).is_some_and(|value| *value != own[**name]);
    found.extend(own.keys().filter(differs).map(|name| format!("another {what} {name}")));
}

/// Buffers and textures by the names of their arrays, with their sizes.
fn held(plan: &Plan) -> BTreeMap<&'static str, (u64, bool)> {
    let buffers = plan.buffers.iter().map(|buffer| (buffer.array.name(), (buffer.bytes, false)));
    buffers.chain(plan.textures.iter().map(|texture| (texture.array.name(), (texture.bytes(), true)))).collect()
}

fn arrays(first: &Plan, second: &Plan, found: &mut BTreeSet<String>) {
    compare("array", &held(first), &held(second), found);
    let contents = |plan: &Plan| -> BTreeMap<&'static str, Vec<u8>> {
        let bytes = |contents: &Contents| contents.bytes().map(std::borrow::Cow::into_owned);
        let buffers = plan.buffers.iter().map(|buffer| (buffer.array.name(), bytes(&buffer.contents)));
        let textures = plan.textures.iter().map(|texture| (texture.array.name(), bytes(&texture.contents)));
        buffers.chain(textures).filter_map(|(name, bytes)| Some((name, bytes?))).collect()
    };
    let (own, other) = (contents(first), contents(second));
    let differs = |name: &&&'static str| other.get(**name).is_some_and(|bytes| *bytes != own[**name]);
    found.extend(own.keys().filter(differs).map(|name| format!("other contents of {name}")));
}

fn samplers(plan: &Plan) -> BTreeMap<&'static str, String> {
    let words = |sampler: &mesoscope::plan::Sampler| {
        let window = sampler.window.map(|window| window.samples);
        let numbers = [sampler.first, sampler.every, sampler.quantities as u64, sampler.capacity];
        format!("{numbers:?} {} {window:?}", sampler.needs_report)
    };
    plan.samplers.iter().map(|sampler| (sampler.id.name(), words(sampler))).collect()
}

/// Numbers that say how a plan is uploaded, read and scaled.
fn numbers(plan: &Plan) -> BTreeMap<&'static str, String> {
    let quanta = plan.quanta;
    let squares = [quanta.force_squared, quanta.curvature, quanta.length_squared, quanta.velocity_squared];
    BTreeMap::from([
        ("cells", format!("{:?}", plan.cells)),
        ("units", format!("{:?}", plan.units)),
        ("layout", format!("{:?}", plan.layout)),
        ("reported", format!("{:?}", plan.reported)),
        ("quanta_of_energy", format!("{:?}", [quanta.energy, quanta.pair_energy])),
        ("quanta_of_squares", format!("{squares:?}")),
        ("quantum_of_baths", format!("{:?}", quanta.bath_squared)),
        ("time_step", format!("{:?}", plan.time_step)),
        ("force_unit", format!("{:?}", plan.force_unit)),
        ("paths", format!("{:?}", plan.paths.every)),
        ("storage_buffers", format!("{:?}", plan.storage_buffers)),
        ("seed_key", format!("{:?}", plan.seed_key)),
    ])
}
