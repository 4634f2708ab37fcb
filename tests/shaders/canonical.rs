//! A hash of what a kernel computes: of its intermediate representation, walked from the entry point. It depends neither on
//! names and binding numbers nor on the order of declarations and what the entry point does not reach.

use std::collections::HashMap;
use std::fmt::Write;

use naga::{
    ArraySize, Block, Constant, Expression, Function, GlobalVariable, Handle, Module, Override, Statement, Type,
    TypeInner,
};

/// FNV-1a over 64 bits: alike on all machines and in all versions, unlike the standard library's.
pub fn hash(text: &str) -> u64 {
    text.bytes().fold(0xcbf2_9ce4_8422_2325, |hash, byte| (hash ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3))
}

/// The hash of a module's only entry point.
pub fn hash_of_kernel(module: &Module) -> u64 {
    let entry = &module.entry_points[0];
    let mut walk = Walk { module, globals: HashMap::new(), functions: HashMap::new(), variables: String::new() };
    let sizes: Vec<String> = match &entry.workgroup_size_overrides {
        Some(sizes) => {
            sizes.iter().map(|size| size.map_or(String::new(), |size| walk.constant_expression(size))).collect()
        }
        None => Vec::new(),
    };
    let body = walk.function(&entry.function);
    hash(&format!("{:?} {sizes:?} {body} {}", entry.workgroup_size, walk.variables))
}

struct Walk<'a> {
    module: &'a Module,
    /// Global variables by the order in which they are met, which tells apart those of one type.
    globals: HashMap<Handle<GlobalVariable>, usize>,
    functions: HashMap<Handle<Function>, u64>,
    variables: String,
}

impl Walk<'_> {
    fn type_text(&self, handle: Handle<Type>) -> String {
        match &self.module.types[handle].inner {
            TypeInner::Pointer { base, space } => format!("pointer {space:?} {}", self.type_text(*base)),
            TypeInner::Array { base, size, stride } => {
                let size = match size {
                    ArraySize::Pending(length) => self.override_text(*length),
                    other => format!("{other:?}"),
                };
                format!("array {size} {stride} {}", self.type_text(*base))
            }
            TypeInner::Struct { members, span } => {
                let members: Vec<String> = (members.iter())
                    .map(|member| format!("{} {:?} {}", member.offset, member.binding, self.type_text(member.ty)))
                    .collect();
                format!("struct {span} {members:?}")
            }
            other => format!("{other:?}"),
        }
    }

    /// Constants that the host sets are known by their name.
    fn override_text(&self, handle: Handle<Override>) -> String {
        let constant = &self.module.overrides[handle];
        let init = constant.init.map(|init| self.constant_expression(init));
        format!("override {:?} {} {init:?}", constant.name, self.type_text(constant.ty))
    }

    fn constant_text(&self, handle: Handle<Constant>) -> String {
        let constant = &self.module.constants[handle];
        format!("constant {} {}", self.type_text(constant.ty), self.constant_expression(constant.init))
    }

    fn constant_expression(&self, handle: Handle<Expression>) -> String {
        let of = |handle: Handle<Expression>| self.constant_expression(handle);
        match &self.module.global_expressions[handle] {
            Expression::Constant(constant) => self.constant_text(*constant),
            Expression::Override(constant) => self.override_text(*constant),
            Expression::ZeroValue(of_type) => format!("zero {}", self.type_text(*of_type)),
            Expression::Compose { ty, components } => {
                let components: Vec<String> = components.iter().map(|component| of(*component)).collect();
                format!("compose {} {components:?}", self.type_text(*ty))
            }
            Expression::Splat { size, value } => format!("splat {size:?} {}", of(*value)),
            Expression::Unary { op, expr } => format!("{op:?} {}", of(*expr)),
            Expression::Binary { op, left, right } => format!("{op:?} {} {}", of(*left), of(*right)),
            Expression::As { expr, kind, convert } => format!("as {kind:?} {convert:?} {}", of(*expr)),
            Expression::Select { condition, accept, reject } => {
                format!("select {} {} {}", of(*condition), of(*accept), of(*reject))
            }
            Expression::Math { fun, arg, arg1, arg2, arg3 } => {
                let arguments: Vec<String> = [Some(*arg), *arg1, *arg2, *arg3].into_iter().flatten().map(of).collect();
                format!("{fun:?} {arguments:?}")
            }
            Expression::AccessIndex { base, index } => format!("access {} {index}", of(*base)),
            Expression::Literal(literal) => format!("{literal:?}"),
            other => panic!("a constant expression of a new kind: {other:?}"),
        }
    }

    fn global(&mut self, handle: Handle<GlobalVariable>) -> usize {
        if let Some(number) = self.globals.get(&handle) {
            return *number;
        }
        let number = self.globals.len();
        self.globals.insert(handle, number);
        let variable = &self.module.global_variables[handle];
        let init = variable.init.map(|init| self.constant_expression(init));
        let of_type = self.type_text(variable.ty);
        writeln!(self.variables, "{number} {:?} {of_type} {init:?}", variable.space).unwrap();
        number
    }

    fn function(&mut self, function: &Function) -> String {
        let mut text = String::new();
        for argument in &function.arguments {
            writeln!(text, "{} {:?}", self.type_text(argument.ty), argument.binding).unwrap();
        }
        if let Some(result) = &function.result {
            writeln!(text, "-> {}", self.type_text(result.ty)).unwrap();
        }
        for (_, variable) in function.local_variables.iter() {
            writeln!(text, "local {} {:?}", self.type_text(variable.ty), variable.init).unwrap();
        }
        for (_, expression) in function.expressions.iter() {
            let line = match expression {
                Expression::Constant(constant) => self.constant_text(*constant),
                Expression::Override(constant) => self.override_text(*constant),
                Expression::ZeroValue(of_type) => format!("zero {}", self.type_text(*of_type)),
                Expression::Compose { ty, components } => format!("compose {} {components:?}", self.type_text(*ty)),
                Expression::GlobalVariable(variable) => format!("global {}", self.global(*variable)),
                Expression::CallResult(called) => format!("result {:x}", self.hash_of_function(*called)),
                Expression::AtomicResult { ty, comparison } => format!("atomic {} {comparison}", self.type_text(*ty)),
                Expression::WorkGroupUniformLoadResult { ty } => format!("uniform {}", self.type_text(*ty)),
                Expression::SubgroupOperationResult { ty } => format!("subgroup {}", self.type_text(*ty)),
                other => format!("{other:?}"),
            };
            writeln!(text, "{line}").unwrap();
        }
        self.block(&function.body, &mut text);
        text
    }

    fn hash_of_function(&mut self, handle: Handle<Function>) -> u64 {
        if let Some(known) = self.functions.get(&handle) {
            return *known;
        }
        let text = self.function(&self.module.functions[handle]);
        let hash = hash(&text);
        self.functions.insert(handle, hash);
        hash
    }

    fn block(&mut self, block: &Block, text: &mut String) {
        for statement in block {
            match statement {
                Statement::Block(inner) => {
                    text.push_str("block {\n");
                    self.block(inner, text);
                }
                Statement::If { condition, accept, reject } => {
                    writeln!(text, "if {condition:?} {{").unwrap();
                    self.block(accept, text);
                    text.push_str("} else {\n");
                    self.block(reject, text);
                }
                Statement::Switch { selector, cases } => {
                    writeln!(text, "switch {selector:?} {{").unwrap();
                    for case in cases {
                        writeln!(text, "case {:?} {} {{", case.value, case.fall_through).unwrap();
                        self.block(&case.body, text);
                    }
                }
                Statement::Loop { body, continuing, break_if } => {
                    writeln!(text, "loop {break_if:?} {{").unwrap();
                    self.block(body, text);
                    text.push_str("} continuing {\n");
                    self.block(continuing, text);
                }
                Statement::Call { function, arguments, result } => {
                    writeln!(text, "call {:x} {arguments:?} {result:?}", self.hash_of_function(*function)).unwrap();
                    continue;
                }
                other => {
                    writeln!(text, "{other:?}").unwrap();
                    continue;
                }
            }
            text.push_str("}\n");
        }
    }
}

#[test]
fn hashes_ignore_names_order_and_what_is_not_reached_and_nothing_else() {
    let of = |text: &str| hash_of_kernel(&naga::front::wgsl::parse_str(text).unwrap());
    let kernel = "
        override SCALE: f32;
        @group(0) @binding(0) var<storage, read_write> first: array<f32>;
        @group(0) @binding(1) var<storage, read_write> second: array<f32>;
        fn scaled(value: f32) -> f32 { let half = 0.5 * value; return half * SCALE; }
        @compute @workgroup_size(64) fn main(@builtin(local_invocation_index) lane: u32) {
            for (var k = 0u; k < 4u; k++) { first[lane] += scaled(second[lane + k]); }
        }";
    let moved = "
        const UNUSED: u32 = 3u;
        fn nobody_calls() -> u32 { return UNUSED; }
        @group(0) @binding(7) var<storage, read_write> b: array<f32>;
        fn f(x: f32) -> f32 { let y = 0.5 * x; return y * SCALE; }
        @group(0) @binding(3) var<storage, read_write> a: array<f32>;
        override SCALE: f32;
        @compute @workgroup_size(64) fn main(@builtin(local_invocation_index) i: u32) {
            for (var n = 0u; n < 4u; n++) { a[i] += f(b[i + n]); }
        }";
    assert_eq!(of(kernel), of(moved));
    for (from, to) in [
        ("0.5", "0.25"),
        ("k < 4u", "k < 5u"),
        ("half * SCALE", "SCALE * half"),
        ("SCALE", "OTHER"),
        ("workgroup_size(64)", "workgroup_size(32)"),
        ("second[lane + k]", "first[lane + k]"),
        ("read_write> second", "read> second"),
    ] {
        let changed = kernel.replace(from, to);
        assert_ne!(changed, kernel);
        assert_ne!(of(kernel), of(&changed), "{from} to {to}");
    }
}
