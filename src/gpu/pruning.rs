//! Branches on constants of a pipeline, taken before the device sees the kernel: a law that a plan leaves out is a branch
//! of the shader and binds nothing. A driver would remove the branch too, but not what it binds: the layout of a pipeline
//! counts every array that the module mentions.

use std::cell::RefCell;
use std::collections::BTreeSet;
use std::mem;

use naga::compact::{KeepUnused, compact};
use naga::{
    Arena, BinaryOperator, Block, Constant, Expression, Function, Handle, Literal, Module, Override, Scalar, Statement,
    SwitchCase, SwitchValue, Type, TypeInner, UnaryOperator, UniqueArena,
};

/// Leaves of every branch on constants the side that is taken, and nothing that is not used then. The module stays valid.
pub(super) fn prune(module: &mut Module, value: impl Fn(&str) -> Option<f64>) {
    let Module { types, functions, entry_points, overrides, constants, global_expressions, .. } = module;
    let known = Known { types, overrides, constants, global_expressions, value };
    let functions = functions.iter_mut().map(|(_, function)| function);
    for function in functions.chain(entry_points.iter_mut().map(|entry| &mut entry.function)) {
        let body = mem::take(&mut function.body);
        function.body = known.taken(body, function);
        // A name would keep an expression that nothing uses.
        function.named_expressions.clear();
    }
    compact(module, KeepUnused::No);
}

/// Names of the constants on which branches of a valid module depend.
pub(super) fn switches(module: &Module) -> BTreeSet<String> {
    let Module { types, functions, entry_points, overrides, constants, global_expressions, .. } = module;
    let mut found = BTreeSet::new();
    let functions = functions.iter().map(|(_, function)| function);
    for function in functions.chain(entry_points.iter().map(|entry| &entry.function)) {
        let mut blocks = vec![&function.body];
        while let Some(block) = blocks.pop() {
            for statement in block {
                let condition = match statement {
                    Statement::If { condition, accept, reject } => {
                        blocks.extend([accept, reject]);
                        *condition
                    }
                    Statement::Switch { selector, cases } => {
                        blocks.extend(cases.iter().map(|case| &case.body));
                        *selector
                    }
                    Statement::Loop { body, continuing, .. } => {
                        blocks.extend([body, continuing]);
                        continue;
                    }
                    Statement::Block(block) => {
                        blocks.push(block);
                        continue;
                    }
                    _ => continue,
                };
                let asked = RefCell::new(Vec::new());
                let value = |name: &str| {
                    asked.borrow_mut().push(name.to_owned());
                    Some(0.0)
                };
                let known = Known { types, overrides, constants, global_expressions, value };
                if known.number(condition, &function.expressions).is_some() {
                    found.extend(asked.take());
                }
            }
        }
    }
    found
}

/// Values of constants.
struct Known<'a, V> {
    types: &'a UniqueArena<Type>,
    overrides: &'a Arena<Override>,
    constants: &'a Arena<Constant>,
    global_expressions: &'a Arena<Expression>,
    value: V,
}

impl<V: Fn(&str) -> Option<f64>> Known<'_, V> {
    /// A block without branches that are not taken.
    fn taken(&self, block: Block, function: &Function) -> Block {
        let mut left = Block::with_capacity(block.len());
        for (statement, span) in block.span_into_iter() {
            let inner = |block: Block| self.taken(block, function);
            match statement {
                Statement::If { condition, accept, reject } => match self.number(condition, &function.expressions) {
                    Some(truth) => left.extend_block(inner(if truth == 0.0 { reject } else { accept })),
                    None => left.push(Statement::If { condition, accept: inner(accept), reject: inner(reject) }, span),
                },
                Statement::Switch { selector, mut cases } => {
                    if let Some(number) = self.number(selector, &function.expressions)
                        && !cases.iter().any(|case| case.fall_through)
                    {
                        let is = |case: &SwitchCase| match case.value {
                            SwitchValue::I32(value) => f64::from(value) == number,
                            SwitchValue::U32(value) => f64::from(value) == number,
                            SwitchValue::Default => false,
                        };
                        let default = |case: &SwitchCase| case.value == SwitchValue::Default;
                        let place = cases.iter().position(is).or_else(|| cases.iter().position(default));
                        // A body may end with `break`, which needs the switch around it.
                        let taken = cases.swap_remove(place.unwrap_or(0));
                        cases = vec![SwitchCase { value: SwitchValue::Default, ..taken }];
                    }
                    for case in &mut cases {
                        case.body = inner(mem::take(&mut case.body));
                    }
                    left.push(Statement::Switch { selector, cases }, span);
                }
                Statement::Loop { body, continuing, break_if } => {
                    left.push(Statement::Loop { body: inner(body), continuing: inner(continuing), break_if }, span);
                }
                Statement::Block(block) => left.push(Statement::Block(inner(block)), span),
                other => left.push(other, span),
            }
            // Nothing may follow a jump, which a branch that is taken may have brought here.
            if matches!(
                left.last(),
                Some(Statement::Return { .. } | Statement::Break | Statement::Continue | Statement::Kill)
            ) {
                break;
            }
        }
        left
    }

    /// The value of an expression of constants and comparisons; truths are 1 and 0.
    fn number(&self, expression: Handle<Expression>, expressions: &Arena<Expression>) -> Option<f64> {
        match expressions[expression] {
            Expression::Literal(literal) => number_of(literal),
            Expression::Constant(constant) => self.number(self.constants[constant].init, self.global_expressions),
            Expression::Override(constant) => {
                let Override { name, init, ty, .. } = &self.overrides[constant];
                let given = name.as_deref().and_then(&self.value).map(|value| match self.types[*ty].inner {
                    TypeInner::Scalar(Scalar::F32) => f64::from(value as f32),
                    _ => value,
                });
                given.or_else(|| self.number((*init)?, self.global_expressions))
            }
            Expression::Unary { op: UnaryOperator::LogicalNot, expr } => {
                Some(f64::from(self.number(expr, expressions)? == 0.0))
            }
            Expression::Binary { op, left, right } => {
                let (left, right) = (self.number(left, expressions)?, self.number(right, expressions)?);
                let truth = match op {
                    BinaryOperator::Equal => left == right,
                    BinaryOperator::NotEqual => left != right,
                    BinaryOperator::Less => left < right,
                    BinaryOperator::LessEqual => left <= right,
                    BinaryOperator::Greater => left > right,
                    BinaryOperator::GreaterEqual => left >= right,
                    _ => return None,
                };
                Some(f64::from(truth))
            }
            _ => None,
        }
    }
}

fn number_of(literal: Literal) -> Option<f64> {
    match literal {
        Literal::F32(value) => Some(f64::from(value)),
        Literal::U32(value) => Some(f64::from(value)),
        Literal::I32(value) => Some(f64::from(value)),
        Literal::Bool(value) => Some(f64::from(value)),
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::{prune, switches};

    fn parsed(statements: &str) -> naga::Module {
        let text = format!(
            "override LAW: u32; override SHARE: f32 = 0.5;
            @group(0) @binding(0) var<storage, read_write> sums: array<u32>;
            @group(0) @binding(1) var<storage, read_write> counts: array<u32>;
            fn count() -> u32 {{ if (LAW == 2u) {{ return counts[1]; }} return 1u; }}
            @compute @workgroup_size(1) fn main() {{ {statements} }}"
        );
        naga::front::wgsl::parse_str(&text).unwrap()
    }

    fn pruned(statements: &str) -> naga::Module {
        let mut module = parsed(statements);
        prune(&mut module, |name| (name == "LAW").then_some(1.0));
        naga::valid::Validator::new(naga::valid::ValidationFlags::all(), naga::valid::Capabilities::all())
            .validate(&module)
            .unwrap();
        module
    }

    fn bound(statements: &str) -> Vec<String> {
        let module = pruned(statements);
        module.global_variables.iter().filter_map(|(_, variable)| variable.name.clone()).collect()
    }

    #[test]
    fn branches_that_are_not_taken_bind_nothing() {
        assert_eq!(bound("sums[0] = count();"), ["sums"]);
        assert_eq!(bound("if (LAW == 1u) { sums[0] = 1u; return; } counts[0] = 1u;"), ["sums"]);
        assert_eq!(bound("if (LAW != 1u) { sums[0] = counts[0]; } else if (SHARE > 0.4) { sums[0] = 2u; }"), ["sums"]);
        assert_eq!(bound("let all = counts[0]; if (!(LAW == 1u)) { sums[0] = all; }"), [""; 0]);
        assert_eq!(
            bound("for (var i = 0u; i < 3u; i++) { if (LAW < 1u) { counts[i] = 0u; } sums[i] = 0u; }"),
            ["sums"]
        );
        let cases = "case 1u: { if (sums[0] == 1u) { break; } sums[0] = 4u; } default: { counts[0] = 1u; }";
        assert_eq!(bound(&format!("switch LAW {{ {cases} }}")), ["sums"]);
        assert_eq!(bound(&format!("switch LAW + 1u {{ {cases} }}")), ["sums", "counts"]);
        assert_eq!(bound("if (sums[0] == 1u) { counts[0] = 1u; }"), ["sums", "counts"]);
    }

    #[test]
    fn constants_of_branches_that_are_not_taken_need_no_value() {
        let module = pruned("if (LAW == 1u) { sums[0] = 1u; } else { sums[0] = u32(SHARE); }");
        assert!(module.overrides.is_empty());
    }

    #[test]
    fn switches_are_constants_of_conditions() {
        let of = |statements: &str| switches(&parsed(statements)).into_iter().collect::<Vec<_>>();
        assert_eq!(of("sums[0] = count();"), ["LAW"]);
        assert_eq!(
            of("sums[0] = count(); loop { switch u32(1u) { default: { if (SHARE > 0.1) { break; } } } }"),
            ["LAW", "SHARE"]
        );
        assert_eq!(of("if (f32(sums[0]) == SHARE) { counts[0] = u32(SHARE); }"), ["LAW"]);
    }
}
