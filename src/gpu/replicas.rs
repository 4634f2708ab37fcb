//! Kernels of replicas: several systems that one dispatch advances, each with a part of every array to itself. The last dimension
//! of the dispatch numbers them, and what is computed of each stays the same.

use naga::{ArraySize, Module, Type, TypeInner};

use super::loaded::{self, with_words};
use super::portions::{Portions, Undivided};
use super::shader::{Binding, LinkedShader};
use crate::shaders::{Array, Entry};
use std::collections::HashMap;
use std::fmt::Write as _;

/// The number of the binding of a uniform buffer that numbers the replicas of a dispatch, four in a row.
pub(crate) const NUMBERS: u32 = loaded::BINDING - 1;

/// Systems that kernels advance at once.
pub(crate) struct Replicas<'a> {
    /// Number of systems.
    pub count: u32,
    /// Bytes of an array of one system in a buffer.
    pub bytes_of: &'a dyn Fn(Array) -> Option<u64>,
    /// Rows of a texture that each system has.
    pub rows: u32,
}

/// Bytes from the beginning of an array of one system to that of the next, in a buffer.
pub(crate) fn spacing(bytes: u64) -> u64 {
    bytes.next_multiple_of(Portions::UNIT)
}

/// The text of a kernel of replicas, given that of one system and what it binds there.
///
/// # Errors
/// [`Undivided`] if an array has elements of which its part cannot be filled.
pub(super) fn replicate(
    text: &str,
    alone: &LinkedShader,
    entry: Entry,
    replicas: &Replicas<'_>,
) -> Result<String, Undivided> {
    let (mut kept, mut lengths, mut closed) = (Vec::new(), Vec::new(), HashMap::new());
    for Binding { number, array, .. } in alone.bindings.iter().filter(|binding| !binding.texture) {
        // Arrays that the plan does not have are those of branches that it does not take.
        let used = (replicas.bytes_of)(*array).unwrap_or(Portions::UNIT);
        let bytes = spacing(used);
        let whole = |part: u64| bytes.checked_div(part).filter(|_| bytes.is_multiple_of(part));
        let (count, listed) = match contents(&alone.module, *number).ok_or(Undivided::whole(*array))? {
            Contents::List { stride } => {
                lengths.push((format!("arrayLength(&{})", array.name()), format!("{}u", used / stride)));
                (whole(stride), true)
            }
            Contents::Whole { bytes } => (whole(bytes), false),
            Contents::Open { structure, member, before, stride } => {
                let count = (bytes - before).checked_div(stride).filter(|_| (bytes - before).is_multiple_of(stride));
                closed.insert(structure, (member, count.ok_or(Undivided::whole(*array))?));
                (Some(1), false)
            }
        };
        kept.push((array.name(), count.ok_or(Undivided::whole(*array))?, listed));
    }
    let of_buffer = |word: &str| kept.iter().copied().find(|(name, ..)| *name == word);
    let Replicas { count, rows, .. } = replicas;
    let mut made = format!(
        "var<private> replica: u32;\n@group(0) @binding({NUMBERS}) var<uniform> replicas: array<vec4<u32>, {}>;\n",
        count.div_ceil(4)
    );
    let mut within = None;
    for line in text.lines() {
        if let Some((declared, name, of)) = declaration(line) {
            let _ = match of_buffer(name) {
                _ if name == loaded::NAME => writeln!(made, "{declared}{name}: array<{of}, {count}>;"),
                Some((_, count, true)) => {
                    let of = of.strip_prefix("array<").and_then(|of| of.strip_suffix('>')).unwrap_or(of);
                    writeln!(made, "{declared}{name}: array<array<{of}, {count}>>;")
                }
                Some((_, count, false)) => writeln!(made, "{declared}{name}: array<array<{of}, {count}>>;"),
                None => writeln!(made, "{line}"),
            };
            continue;
        }
        let opened = line.strip_prefix("struct ").and_then(|line| line.split_whitespace().next());
        within = opened.or(within).filter(|_| line != "}");
        if let Some((member, count)) = within.and_then(|name| closed.get(name))
            && let Some((_, of)) = line.split_once(&format!("{member}: array<"))
            && let Some((of, _)) = of.split_once(">,")
        {
            let _ = writeln!(made, "    {member}: array<{of}, {count}>,");
            continue;
        }
        let line = lengths.iter().fold(line.to_owned(), |line, (length, known)| line.replace(length, known));
        let in_part = |word: &str, before: &str, after: &str| match of_buffer(word) {
            // Members of structures.
            _ if before.ends_with('.') || after.starts_with(':') => None,
            Some((_, _, true)) => Some(format!("{word}[replica]")),
            Some((_, _, false)) => Some(format!("{word}[replica][0]")),
            None => (word == loaded::NAME).then(|| format!("{word}[replica]")),
        };
        let mut line = with_words(&line, in_part);
        for texture in alone.bindings.iter().filter(|binding| binding.texture) {
            for action in ["textureLoad", "textureStore"] {
                let call = format!("{action}({}, ", texture.array.name());
                line = line.replace(&call, &format!("{call}vec2<u32>(0u, replica * {rows}u) + "));
            }
        }
        made.push_str(&line);
        made.push('\n');
    }
    Ok(with_number(&made, entry.name()))
}

/// The declaration of a variable up to its name, the name, and its type.
fn declaration(line: &str) -> Option<(&str, &str, &str)> {
    let (declared, of) = line.strip_prefix("@group(0)").and(line.split_once(": "))?;
    let name = declared.rsplit(' ').next()?;
    let of = of.split(';').next()?;
    Some((&declared[..declared.len() - name.len()], name, of))
}

/// The contents of a buffer.
enum Contents<'a> {
    /// Elements of any number.
    List { stride: u64 },
    /// A value of known size.
    Whole { bytes: u64 },
    /// A structure that ends with elements of any number.
    Open { structure: &'a str, member: &'a str, before: u64, stride: u64 },
}

fn contents(module: &Module, number: u32) -> Option<Contents<'_>> {
    let bound = |variable: &naga::GlobalVariable| variable.binding.is_some_and(|binding| binding.binding == number);
    let (_, variable) = module.global_variables.iter().find(|(_, variable)| bound(variable))?;
    let Type { name, inner } = &module.types[variable.ty];
    let stride_of = |inner: &TypeInner| match inner {
        TypeInner::Array { size: ArraySize::Dynamic, stride, .. } => Some(u64::from(*stride)),
        _ => None,
    };
    if let Some(stride) = stride_of(inner) {
        return Some(Contents::List { stride });
    }
    if let TypeInner::Struct { members, .. } = inner
        && let Some(last) = members.last()
        && let Some(stride) = stride_of(&module.types[last.ty].inner)
    {
        let (structure, member) = (name.as_deref()?, last.name.as_deref()?);
        return Some(Contents::Open { structure, member, before: last.offset.into(), stride });
    }
    Some(Contents::Whole { bytes: inner.size(module.to_ctx()).into() })
}

/// The same text, in which an entry point first finds the number of its replica.
fn with_number(text: &str, entry: &str) -> String {
    let opening = format!("fn {entry}(");
    let Some(begin) = text.find(&opening).map(|begin| begin + opening.len()) else { return text.to_owned() };
    let mut depth = 1;
    let parameters = text[begin..].char_indices().find(|(_, letter)| {
        depth += match letter {
            '(' => 1,
            ')' => -1,
            _ => 0,
        };
        depth == 0
    });
    let end = begin + parameters.map_or(0, |(end, _)| end);
    let given = text[begin..end].split_once("@builtin(workgroup_id)").and_then(|(_, rest)| rest.split_once(':'));
    let (added, name) = if let Some((name, _)) = given {
        (String::new(), name.trim())
    } else {
        let comma = if text[begin..end].trim().is_empty() { "" } else { ", " };
        (format!("{comma}@builtin(workgroup_id) workgroup_of_replica: vec3<u32>"), "workgroup_of_replica")
    };
    let body = end + text[end..].find('{').map_or(0, |brace| brace + 1);
    format!(
        "{}{added}{}\n    replica = replicas[{name}.z / 4u][{name}.z % 4u];{}",
        &text[..end],
        &text[end..body],
        &text[body..]
    )
}
