//! Constants of a kernel that lie in a buffer, so that they change without compiling the kernel again.

use crate::shaders::Constant;
use std::collections::HashMap;

/// The number of their binding, beyond those of arrays.
pub(crate) const BINDING: u32 = 999;

/// The name of the buffer in kernels.
pub(super) const NAME: &str = "loaded_constants";

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
    let mut made = format!("@group(0) @binding({BINDING}) var<uniform> {NAME}: array<vec4<f32>, {rows}>;\n");
    for line in text.lines().filter(|line| declared(line).is_none()) {
        let component = |place: &usize| format!("{NAME}[{}].{}", place / 4, ["x", "y", "z", "w"][place % 4]);
        made.push_str(&with_words(line, |word, _, _| places.get(word).map(component)));
        made.push('\n');
    }
    (made, loaded)
}

/// A line with others in place of its words, given each of them and the text before and after it.
pub(super) fn with_words(line: &str, replaced: impl Fn(&str, &str, &str) -> Option<String>) -> String {
    let is_of_word = |letter: char| letter.is_ascii_alphanumeric() || letter == '_';
    let mut made = String::with_capacity(line.len());
    let mut end = 0;
    while let Some(begin) = line[end..].find(is_of_word).map(|begin| end + begin) {
        made.push_str(&line[end..begin]);
        end = begin + line[begin..].find(|letter| !is_of_word(letter)).unwrap_or(line.len() - begin);
        let word = &line[begin..end];
        made.push_str(&replaced(word, &line[..begin], &line[end..]).unwrap_or_else(|| word.to_owned()));
    }
    made + &line[end..]
}

/// The bytes of the buffer.
pub(crate) fn bytes(loaded: &[Constant], values: &HashMap<Constant, f64>) -> Vec<u8> {
    let value = |constant: &Constant| values.get(constant).copied().unwrap_or_default() as f32;
    let mut numbers: Vec<f32> = loaded.iter().map(value).collect();
    numbers.resize(loaded.len().next_multiple_of(4), 0.0);
    bytemuck::cast_slice(&numbers).to_vec()
}
