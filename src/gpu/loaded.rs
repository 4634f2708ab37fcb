//! Constants of a kernel that lie in a buffer, so that they change without compiling the kernel again.

use crate::shaders::Constant;
use std::collections::HashMap;
use std::fmt::Write as _;

/// The number of their binding, beyond those of arrays.
pub(crate) const BINDING: u32 = 999;

/// The text of a kernel that loads its real constants from a uniform buffer, and these in the order of the buffer. Constants that `stays` names,
/// such as those that decide which code there is, stay constants.
pub(super) fn load(text: &str, stays: impl Fn(Constant) -> bool) -> (String, Vec<Constant>) {
    let declared = |line: &str| {
        let (name, _) = line.strip_prefix("override ")?.split_once(": f32;")?;
        Constant::named(name).filter(|constant| !stays(*constant))
    };
    let loaded: Vec<Constant> = text.lines().filter_map(declared).collect();
    if loaded.is_empty() {
        return (text.to_owned(), loaded);
    }
    let places: HashMap<&str, usize> =
        loaded.iter().enumerate().map(|(place, constant)| (constant.name(), place)).collect();
    let rows = loaded.len().div_ceil(4);
    let mut made = format!("@group(0) @binding({BINDING}) var<uniform> loaded_constants: array<vec4<f32>, {rows}>;\n");
    for line in text.lines() {
        if declared(line).is_some() {
            continue;
        }
        let mut rest = line;
        while let Some(begin) = rest.find(|letter: char| letter.is_ascii_alphanumeric() || letter == '_') {
            let length = rest[begin..].find(|letter: char| !(letter.is_ascii_alphanumeric() || letter == '_'));
            let end = length.map_or(rest.len(), |length| begin + length);
            made.push_str(&rest[..begin]);
            match places.get(&rest[begin..end]) {
                Some(place) => {
                    let component = ["x", "y", "z", "w"][place % 4];
                    let _ = write!(made, "loaded_constants[{}].{component}", place / 4);
                }
                None => made.push_str(&rest[begin..end]),
            }
            rest = &rest[end..];
        }
        made.push_str(rest);
        made.push('\n');
    }
    (made, loaded)
}

/// The bytes of the buffer.
pub(crate) fn bytes(loaded: &[Constant], values: &HashMap<Constant, f64>) -> Vec<u8> {
    let value = |constant: &Constant| values.get(constant).copied().unwrap_or_default() as f32;
    let mut numbers: Vec<f32> = loaded.iter().map(value).collect();
    numbers.resize(loaded.len().next_multiple_of(4), 0.0);
    bytemuck::cast_slice(&numbers).to_vec()
}
