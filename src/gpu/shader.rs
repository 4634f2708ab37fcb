//! Kernels linked, parsed and validated; errors name the file and the line.

use std::collections::BTreeMap;
use std::sync::{Arc, LazyLock, Mutex, PoisonError};

use super::compiled::ConstantsIn;
use super::kept::Kept;
use super::loaded;
use super::portions::{Portions, Undivided, divide};
use super::pruning::{prune, switches};
use super::replicas::{self, Replicas, replicate};
use super::{GpuError, access};
use crate::shaders::{Array, Choices, Constant, Entry, LinkedText, linked_text};

/// A storage buffer or a texture that a kernel uses.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Binding {
    /// Number within group 0.
    pub number: u32,
    /// The array of the variable.
    pub array: Array,
    /// Whether it is a texture.
    pub texture: bool,
    /// The portion of the array, from 0: others than the first only where it is too large for one binding.
    pub portion: u32,
}

/// A kernel parsed and validated.
#[derive(Debug, Clone)]
pub struct LinkedShader {
    /// The parsed module.
    pub module: naga::Module,
    /// The buffers and textures that the entry point uses, directly or through functions it calls.
    pub bindings: Vec<Binding>,
    /// The constants that a plan sets.
    pub constants: Vec<Constant>,
    /// Those of them on which branches depend: with other values another kernel is left, see [`LinkedShader::specialized`].
    pub switches: Vec<Constant>,
    /// Constants that it loads from a buffer.
    pub loaded: Vec<Constant>,
    /// True if it has loops that may need counters to end: those of the search for Voronoi cells, whose ends follow from
    /// geometry. `tests/shaders/loops.rs` knows the ends of all others.
    pub counts_loops: bool,
    /// Size of each struct and offset of each member: `(struct, member) -> offset`, with member `""` for the size.
    pub layout: BTreeMap<(String, String), u32>,
}

impl LinkedShader {
    /// The kernel of a pipeline with these constants: branches on them are taken, and what only others use is gone.
    ///
    /// ```
    /// use mesoscope::gpu::validate;
    /// use mesoscope::shaders::{Constant, Library};
    ///
    /// let library = Library::new(&[(
    ///     "core/count",
    ///     "override HELD: u32;
    ///     var<storage, read_write> counts: array<u32>;
    ///     @compute @workgroup_size(1)
    ///     fn count() { if (HELD == 1u) { counts[0] = 1u; } }",
    /// )])?;
    /// let shader = validate("count", "count", &library.link("count", &[])?)?;
    /// assert_eq!(shader.specialized(&[(Constant::Held, 1.0)]).bindings.len(), 1);
    /// assert_eq!(shader.specialized(&[(Constant::Held, 0.0)]).bindings.len(), 0);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    #[must_use]
    pub fn specialized(&self, constants: &[(Constant, f64)]) -> Self {
        let mut module = self.module.clone();
        prune(&mut module, |name| {
            constants.iter().find(|(constant, _)| constant.name() == name).map(|(_, value)| *value)
        });
        let is_bound = |binding: &&Binding| {
            let mut variables = module.global_variables.iter().filter_map(|(_, variable)| variable.binding);
            variables.any(|bound| bound.binding == binding.number)
        };
        let bindings = self.bindings.iter().filter(is_bound).cloned().collect();
        let constants = constants_of(&module);
        let loads = module.global_variables.iter().any(|(_, variable)| is_of_constants(variable));
        let loaded = if loads { self.loaded.clone() } else { Vec::new() };
        let layout = self.layout.clone();
        Self { module, bindings, constants, switches: Vec::new(), loaded, counts_loops: self.counts_loops, layout }
    }

    /// The same with arrays in portions, each of which it binds.
    ///
    /// ```
    /// use mesoscope::gpu::{Portions, link};
    /// use mesoscope::shaders::{Array, Choices, Entry, water, mesh};
    ///
    /// let choices = Choices::new().with(mesh::Spline::Linear).with(water::Particles::InPlace);
    /// let whole = link("bin", Entry::BinWater, &choices)?;
    /// let three = |array| (array == Array::Particles).then(|| Portions::new(3 << 20, 1 << 20)).flatten();
    /// let divided = whole.clone().divided(three)?;
    /// assert!(divided.bindings.len() > whole.bindings.len());
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// [`Undivided`] if the kernel uses one of them otherwise than by its elements.
    pub fn divided(mut self, portions_of: impl Fn(Array) -> Option<Portions>) -> Result<Self, Undivided> {
        divide(&mut self.module, &mut self.bindings, portions_of)?;
        Ok(self)
    }

    /// The number of buffers that it binds.
    pub(crate) fn storage_buffers(&self) -> usize {
        self.bindings.iter().filter(|binding| !binding.texture).count()
    }

    /// Bits of the values of its switches, in their order; nothing where a default holds. Equal ones leave the same kernel.
    #[must_use]
    pub fn switched(&self, constants: &[(Constant, f64)]) -> Switched {
        switched(&self.switches, constants)
    }
}

/// Bits of the values of switches.
pub type Switched = Vec<Option<u64>>;

fn switched(switches: &[Constant], constants: &[(Constant, f64)]) -> Switched {
    let given = |switch: &Constant| constants.iter().find(|(constant, _)| constant == switch);
    switches.iter().map(|switch| given(switch).map(|(_, value)| value.to_bits())).collect()
}

/// The constants that a module uses.
fn constants_of(module: &naga::Module) -> Vec<Constant> {
    module.overrides.iter().filter_map(|(_, constant)| Constant::named(constant.name.as_deref()?)).collect()
}

/// Links, parses and validates a kernel; `name` is what errors call it.
///
/// # Errors
/// [`GpuError::Shader`] that names the file and the line.
pub fn link(name: &str, entry: Entry, choices: &Choices) -> Result<LinkedShader, GpuError> {
    let linked = linked_text(entry, choices).map_err(|unlinked| GpuError::unlinked(name, unlinked))?;
    validate(name, entry.name(), &linked)
}

/// The text of a kernel, and the kernel, parsed and validated once for all plans and devices of the process.
///
/// # Errors
/// As [`link`].
pub(crate) fn link_once(
    name: &str,
    entry: Entry,
    choices: &Choices,
    place: ConstantsIn,
    replicas: Option<&Replicas<'_>>,
) -> Result<(String, Arc<LinkedShader>), GpuError> {
    static LINKED: LazyLock<Kept<String, Arc<LinkedShader>>> = LazyLock::new(Kept::default);
    let linked = linked_text(entry, choices).map_err(|unlinked| GpuError::unlinked(name, unlinked))?;
    let validated = |text: &str, loaded: &[Constant]| {
        LINKED.get_or_make(text.to_owned(), || {
            let linked = LinkedText { text: text.to_owned(), parts: linked.parts.clone() };
            Ok(Arc::new(LinkedShader { loaded: loaded.to_vec(), ..validate(name, entry.name(), &linked)? }))
        })
    };
    let (mut text, mut loaded) = (linked.text.clone(), Vec::new());
    let mut shader = validated(&text, &loaded)?;
    if place == ConstantsIn::Buffer {
        (text, loaded) = loaded::load(&text, |constant| shader.switches.contains(&constant));
        shader = validated(&text, &loaded)?;
    }
    if let Some(replicas) = replicas {
        text = replicate(&text, &shader, entry, replicas).map_err(|undivided| GpuError::undivided(name, undivided))?;
        shader = validated(&text, &loaded)?;
    }
    Ok((text, shader))
}

/// Parses and validates a kernel whose real constants lie in a buffer, but for those that decide which code there is.
///
/// # Errors
/// As [`link`].
pub fn link_loading(name: &str, entry: Entry, choices: &Choices) -> Result<Arc<LinkedShader>, GpuError> {
    Ok(link_once(name, entry, choices, ConstantsIn::Buffer, None)?.1)
}

fn is_of_constants(variable: &naga::GlobalVariable) -> bool {
    variable.binding.is_some_and(|binding| binding.binding == loaded::BINDING)
}

/// The number of buffers that a kernel binds with these constants, if all arrays of which its choices say nothing are in
/// buffers; none of a kernel that does not link.
///
/// ```
/// use mesoscope::gpu::storage_buffers;
/// use mesoscope::shaders::{Choices, Entry, mesh, water};
///
/// let choices = Choices::new().with(mesh::Spline::Linear).with(water::Particles::InPlace);
/// assert!(storage_buffers(Entry::BinWater, &choices, &[]) > 1);
/// ```
#[must_use]
pub fn storage_buffers(entry: Entry, choices: &Choices, constants: &[(Constant, f64)]) -> usize {
    type Kernel = (Entry, Choices);
    static SWITCHES: Mutex<BTreeMap<Kernel, Vec<Constant>>> = Mutex::new(BTreeMap::new());
    static COUNTS: Mutex<BTreeMap<(Kernel, Switched), usize>> = Mutex::new(BTreeMap::new());
    let kernel = (entry, choices.clone());
    let switches = SWITCHES.lock().unwrap_or_else(PoisonError::into_inner).get(&kernel).cloned();
    if let Some(switches) = switches {
        let key = (kernel.clone(), switched(&switches, constants));
        if let Some(count) = COUNTS.lock().unwrap_or_else(PoisonError::into_inner).get(&key) {
            return *count;
        }
    }
    let Ok((_, shader)) = link_once(entry.name(), entry, choices, ConstantsIn::Code, None) else { return 0 };
    let count = shader.specialized(constants).storage_buffers();
    let key = (kernel.clone(), shader.switched(constants));
    COUNTS.lock().unwrap_or_else(PoisonError::into_inner).insert(key, count);
    SWITCHES.lock().unwrap_or_else(PoisonError::into_inner).insert(kernel, shader.switches.clone());
    count
}

/// Parses and validates the text of a kernel.
///
/// ```
/// use mesoscope::gpu::validate;
/// use mesoscope::shaders::{Array, Library};
///
/// let kernel = |statement: &str| -> &'static str {
///     format!("@compute @workgroup_size(1)\nfn double() {{\n    {statement};\n}}").leak()
/// };
/// let counts = ("core/counts", "var<storage, read_write> counts: array<u32>;");
/// let library = Library::new(&[counts, ("core/double", kernel("counts[0] *= 2u"))])?;
/// let shader = validate("double", "double", &library.link("double", &[])?)?;
/// assert_eq!(shader.bindings[0].array, Array::Counts);
///
/// let library = Library::new(&[counts, ("core/double", kernel("counts[0] *= 2f"))])?;
/// let slip = validate("double", "double", &library.link("double", &[])?);
/// assert!(slip.is_err_and(|error| error.to_string().contains("core/double.wgsl:3")));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// [`GpuError::Shader`] that names the file and the line.
pub fn validate(name: &str, entry: &str, linked: &LinkedText) -> Result<LinkedShader, GpuError> {
    let failure = |place: String, reason: String| GpuError::Shader { kernel: name.to_owned(), place, reason };
    let text = linked.text.as_str();
    let place = |line: u32| {
        let part = linked.parts.iter().rev().find(|part| part.begins <= line);
        part.map_or_else(
            || "shaders".to_owned(),
            |part| format!("shaders/{}.wgsl:{}", part.source, part.line + line - part.begins),
        )
    };
    let mut module = naga::front::wgsl::parse_str(text).map_err(|error| {
        let line = error.location(text).map_or(1, |location| location.line_number);
        failure(place(line), error.message().to_owned())
    })?;
    let info = naga::valid::Validator::new(naga::valid::ValidationFlags::all(), naga::valid::Capabilities::all())
        .validate(&module)
        .map_err(|error| {
            let line = error.spans().next().map_or(1, |(span, _)| span.location(text).line_number);
            failure(place(line), chain(error.as_inner()))
        })?;
    let index = module
        .entry_points
        .iter()
        .position(|known| known.name == entry)
        .ok_or_else(|| failure(place(1), format!("there is no entry point `{entry}`")))?;
    let used = info.get_entry_point(index);
    let mut bindings = Vec::new();
    for (_, variable) in module.global_variables.iter().filter(|(handle, _)| !used[*handle].is_empty()) {
        let Some(binding) = variable.binding.as_ref().filter(|bound| bound.binding < replicas::NUMBERS) else {
            continue;
        };
        let name = variable.name.as_deref().unwrap_or_default();
        let array = Array::named(name).ok_or_else(|| failure(place(1), format!("there is no array `{name}`")))?;
        let texture = matches!(module.types[variable.ty].inner, naga::TypeInner::Image { .. });
        bindings.push(Binding { number: binding.binding, array, texture, portion: 0 });
    }
    bindings.sort_by_key(|binding| binding.number);
    access::narrow(&mut module, used);
    let constants = constants_of(&module);
    let switches = switches(&module).iter().filter_map(|name| Constant::named(name)).collect();
    let mut layout = BTreeMap::new();
    for (_, declared) in module.types.iter() {
        if let (Some(name), naga::TypeInner::Struct { members, span }) = (&declared.name, &declared.inner) {
            layout.insert((name.clone(), String::new()), *span);
            for member in members {
                layout.insert((name.clone(), member.name.clone().unwrap_or_default()), member.offset);
            }
        }
    }
    let counts_loops = linked.parts.iter().any(|part| part.source.starts_with("tessellation/"));
    Ok(LinkedShader { module, bindings, constants, switches, loaded: Vec::new(), counts_loops, layout })
}

fn chain(error: &dyn std::error::Error) -> String {
    let mut text = error.to_string();
    let mut source = error.source();
    while let Some(inner) = source {
        text.push_str(": ");
        text.push_str(&inner.to_string());
        source = inner.source();
    }
    text
}
