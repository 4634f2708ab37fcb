//! Whether the table of arrays and the files agree.

use std::collections::BTreeSet;

use crate::Files;
use crate::accessors;
use crate::arrays::{ACCESSES, ARRAYS, Array, Function, Seen};
use crate::wgsl;

/// Compares the table with the arrays that files declare.
///
/// # Errors
/// What is wrong, and what to do.
pub fn arrays(files: &Files) -> Result<(), String> {
    let table = "build/arrays.rs";
    let mut names = BTreeSet::new();
    for Array { name, .. } in ARRAYS {
        if !names.insert(*name) {
            return Err(format!("{table}: `{name}` stands there twice"));
        }
    }
    let generated = accessors::files();
    if let Some((path, _)) = generated.iter().find(|(path, _)| files.contains_key(path)) {
        return Err(format!("shaders/{path}.wgsl is made from {table}; remove one of the two"));
    }
    let mut declared = BTreeSet::new();
    for (path, text) in files {
        for (name, of) in wgsl::arrays(text) {
            match ARRAYS.iter().find(|array| array.name == name).map(|array| &array.seen) {
                Some(Seen::As(known) | Seen::ReadAs(known)) if *known == of => {
                    return Err(format!("shaders/{path}.wgsl declares `{name}` as {table} does; remove it there"));
                }
                Some(_) => {}
                None => return Err(format!("shaders/{path}.wgsl declares `{name}`; give it a line in {table}")),
            }
            declared.insert(name);
        }
    }
    if let Some((name, _)) =
        generated.iter().flat_map(|(_, text)| wgsl::arrays(text)).find(|(name, _)| !names.contains(name))
    {
        return Err(format!("{table}: `{name}` has functions and no line among the arrays"));
    }
    declared.extend(generated.iter().flat_map(|(_, text)| wgsl::arrays(text)).map(|(name, _)| name));
    for Array { name, seen, .. } in ARRAYS {
        let variable = if let Seen::InPlaceOf(other) = seen { other } else { name };
        if !declared.contains(variable) {
            return Err(format!("{table}: no kernel declares `{variable}`, which is said of `{name}`"));
        }
    }
    for access in ACCESSES {
        let fields = accessors::fields(&access.element);
        let unknown = access.functions.iter().find_map(|function| match function {
            Function::LoadField(_, field) | Function::StoreField(_, field) => {
                Some(field).filter(|own| !fields.contains(own))
            }
            Function::Load(_) | Function::Store(_) | Function::Copy(..) => None,
        });
        if let Some(field) = unknown {
            return Err(format!("{table}: elements of `{}` have no field `{field}`", access.array));
        }
    }
    Ok(())
}
