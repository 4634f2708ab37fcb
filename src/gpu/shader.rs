//! Kernels linked, parsed and validated; errors name the file and the line.

use std::collections::BTreeMap;

use super::GpuError;
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
}

/// A kernel parsed and validated.
#[derive(Debug)]
pub struct LinkedShader {
    /// The parsed module.
    pub module: naga::Module,
    /// The buffers and textures that the entry point uses, directly or through functions it calls.
    pub bindings: Vec<Binding>,
    /// The constants that a plan sets.
    pub constants: Vec<Constant>,
    /// Size of each struct and offset of each member: `(struct, member) -> offset`, with member `""` for the size.
    pub layout: BTreeMap<(String, String), u32>,
}

/// Links, parses and validates a kernel; `name` is what errors call it.
///
/// # Errors
/// [`GpuError::Shader`] that names the file and the line.
pub fn link(name: &str, entry: Entry, choices: &Choices) -> Result<LinkedShader, GpuError> {
    let linked = linked_text(entry, choices).map_err(|unlinked| GpuError::unlinked(name, unlinked))?;
    validate(name, entry.name(), &linked)
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
            |part| format!("shaders/{}.wgsl:{}", part.path, part.line + line - part.begins),
        )
    };
    let module = naga::front::wgsl::parse_str(text).map_err(|error| {
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
        let Some(binding) = &variable.binding else { continue };
        let name = variable.name.as_deref().unwrap_or_default();
        let array = Array::named(name).ok_or_else(|| failure(place(1), format!("there is no array `{name}`")))?;
        let texture = matches!(module.types[variable.ty].inner, naga::TypeInner::Image { .. });
        bindings.push(Binding { number: binding.binding, array, texture });
    }
    bindings.sort_by_key(|binding| binding.number);
    let constants =
        module.overrides.iter().filter_map(|(_, constant)| Constant::named(constant.name.as_deref()?)).collect();
    let mut layout = BTreeMap::new();
    for (_, declared) in module.types.iter() {
        if let (Some(name), naga::TypeInner::Struct { members, span }) = (&declared.name, &declared.inner) {
            layout.insert((name.clone(), String::new()), *span);
            for member in members {
                layout.insert((name.clone(), member.name.clone().unwrap_or_default()), member.offset);
            }
        }
    }
    Ok(LinkedShader { module, bindings, constants, layout })
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
