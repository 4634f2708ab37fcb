//! Arrays that a kernel only loads, declared so: compilers may then keep them in registers, load them through caches that
//! hold no stores, and reorder loads.

use naga::valid::{FunctionInfo, GlobalUse};
use naga::{AddressSpace, Handle, Module, StorageAccess, Type, TypeInner};

/// Declares arrays that a kernel uses this way as loaded only, where it neither stores into them nor adds to them. Integers
/// that no kernel of the same dispatch adds to are plain ones.
pub(super) fn narrow(module: &mut Module, used: &FunctionInfo) {
    let loaded: Vec<_> = module
        .global_variables
        .iter()
        .filter(|(_, variable)| matches!(variable.space, AddressSpace::Storage { .. }))
        .map(|(handle, variable)| (handle, variable.ty))
        .filter(|(handle, _)| !used[*handle].intersects(GlobalUse::WRITE | GlobalUse::ATOMIC))
        .collect();
    for (handle, ty) in loaded {
        let Some(plain) = plain(module, ty) else { continue };
        let variable = &mut module.global_variables[handle];
        variable.ty = plain;
        variable.space = AddressSpace::Storage { access: StorageAccess::LOAD };
    }
}

/// The type with plain integers in place of atomic ones; none of a structure with atomic members.
pub(super) fn plain(module: &mut Module, ty: Handle<Type>) -> Option<Handle<Type>> {
    let Type { name, inner } = module.types[ty].clone();
    let inner = match inner {
        TypeInner::Atomic(scalar) => TypeInner::Scalar(scalar),
        TypeInner::Array { base, size, stride } => TypeInner::Array { base: plain(module, base)?, size, stride },
        TypeInner::Struct { members, .. } => {
            return members.iter().all(|member| plain(module, member.ty) == Some(member.ty)).then_some(ty);
        }
        _ => return Some(ty),
    };
    let span = module.types.get_span(ty);
    Some(module.types.insert(Type { name, inner }, span))
}
