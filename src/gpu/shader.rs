//! Linking: modules of plain WGSL joined into one text, with the way back from an error to its file.

use std::collections::BTreeMap;

use super::GpuError;
use super::shader_library::module_text;

/// A storage buffer or a texture that a kernel uses.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Binding {
    /// Number within group 0.
    pub number: u32,
    /// Name of the variable.
    pub name: String,
    /// Whether it is a texture.
    pub texture: bool,
}

/// A kernel's modules joined, parsed and validated.
#[derive(Debug)]
pub struct LinkedShader {
    /// The parsed module.
    pub module: naga::Module,
    /// The buffers and textures that the entry point `main` uses, directly or through functions it calls.
    pub bindings: Vec<Binding>,
    /// Names of all override constants.
    pub overrides: Vec<String>,
    /// Size of each struct and offset of each member: `(struct, member) -> offset`, with member `""` for the size.
    pub layout: BTreeMap<(String, String), u32>,
}

/// Joins, parses and validates the modules of a kernel.
///
/// # Errors
/// [`GpuError::Shader`] that names the file and the line.
pub fn link(kernel: &str, modules: &[&str]) -> Result<LinkedShader, GpuError> {
    let texts: Vec<(&str, &str)> = modules
        .iter()
        .map(|&name| match module_text(name) {
            Some(text) => Ok((name, text)),
            None => Err(GpuError::Shader {
                kernel: kernel.to_owned(),
                place: format!("shaders/{name}.wgsl"),
                reason: "there is no such module".to_owned(),
            }),
        })
        .collect::<Result<_, _>>()?;
    link_texts(kernel, &texts)
}

/// The same for modules given as `(name, text)`.
///
/// ```
/// use mesoscope::gpu::link_texts;
///
/// let data = ("common/data", "@group(0) @binding(0) var<storage, read_write> data: array<u32>;");
/// let kernel = |statement: &str| format!("@compute @workgroup_size(1)\nfn main() {{\n    {statement};\n}}");
/// let linked = link_texts("double", &[data, ("kernels/double", &kernel("data[0] *= 2u"))])?;
/// assert_eq!(linked.bindings[0].name, "data");
///
/// let slip = link_texts("double", &[data, ("kernels/double", &kernel("date[0] *= 2u"))]);
/// assert!(slip.is_err_and(|error| error.to_string().contains("kernels/double.wgsl:3")));
/// # Ok::<(), mesoscope::gpu::GpuError>(())
/// ```
///
/// # Errors
/// [`GpuError::Shader`] that names the file and the line.
pub fn link_texts(kernel: &str, modules: &[(&str, &str)]) -> Result<LinkedShader, GpuError> {
    let failure = |place: String, reason: String| GpuError::Shader { kernel: kernel.to_owned(), place, reason };
    let mut text = String::new();
    let mut starts = Vec::new();
    for &(name, part) in modules {
        starts.push((text.lines().count() as u32, name));
        text.push_str(part);
        if !part.ends_with('\n') {
            text.push('\n');
        }
    }
    let place = |line: u32| {
        let (start, name) = starts
            .iter()
            .rev()
            .find(|(start, _)| *start < line)
            .copied()
            .unwrap_or((0, modules.first().map_or("", |(name, _)| name)));
        format!("shaders/{name}.wgsl:{}", line - start)
    };
    let module = naga::front::wgsl::parse_str(&text).map_err(|error| {
        let line = error.location(&text).map_or(1, |location| location.line_number);
        failure(place(line), error.message().to_owned())
    })?;
    let info = naga::valid::Validator::new(naga::valid::ValidationFlags::all(), naga::valid::Capabilities::all())
        .validate(&module)
        .map_err(|error| {
            let line = error.spans().next().map_or(1, |(span, _)| span.location(&text).line_number);
            failure(place(line), chain(error.as_inner()))
        })?;
    let entry = module
        .entry_points
        .iter()
        .position(|entry| entry.name == "main")
        .ok_or_else(|| failure(place(1), "there is no entry point `main`".to_owned()))?;
    let used = info.get_entry_point(entry);
    let mut bindings: Vec<Binding> = module
        .global_variables
        .iter()
        .filter(|(handle, _)| !used[*handle].is_empty())
        .filter_map(|(_, variable)| {
            let binding = variable.binding.as_ref()?;
            let texture = matches!(module.types[variable.ty].inner, naga::TypeInner::Image { .. });
            Some(Binding { number: binding.binding, name: variable.name.clone()?, texture })
        })
        .collect();
    bindings.sort_by_key(|binding| binding.number);
    let overrides = module.overrides.iter().filter_map(|(_, constant)| constant.name.clone()).collect();
    let mut layout = BTreeMap::new();
    for (_, declared) in module.types.iter() {
        if let (Some(name), naga::TypeInner::Struct { members, span }) = (&declared.name, &declared.inner) {
            layout.insert((name.clone(), String::new()), *span);
            for member in members {
                layout.insert((name.clone(), member.name.clone().unwrap_or_default()), member.offset);
            }
        }
    }
    Ok(LinkedShader { module, bindings, overrides, layout })
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
