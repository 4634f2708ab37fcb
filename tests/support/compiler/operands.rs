//! The operands of expressions and statements.

use naga::{Expression, Handle, ImageQuery, Statement};

/// Whether an expression stands by itself: it has a value wherever the function is, and is never emitted.
pub fn stands_alone(expression: &Expression) -> bool {
    matches!(
        expression,
        Expression::Literal(_)
            | Expression::Constant(_)
            | Expression::Override(_)
            | Expression::ZeroValue(_)
            | Expression::FunctionArgument(_)
            | Expression::GlobalVariable(_)
            | Expression::LocalVariable(_)
    )
}

/// Visits the operands of an expression that is emitted.
pub fn of_expression(expression: &mut Expression, mut visit: impl FnMut(&mut Handle<Expression>)) {
    match expression {
        Expression::Compose { components, .. } => components.iter_mut().for_each(visit),
        Expression::Access { base, index } => [base, index].into_iter().for_each(visit),
        Expression::AccessIndex { base: operand, .. }
        | Expression::Splat { value: operand, .. }
        | Expression::Swizzle { vector: operand, .. }
        | Expression::Load { pointer: operand }
        | Expression::Unary { expr: operand, .. }
        | Expression::Relational { argument: operand, .. }
        | Expression::As { expr: operand, .. }
        | Expression::ArrayLength(operand) => visit(operand),
        Expression::Binary { left, right, .. } => [left, right].into_iter().for_each(visit),
        Expression::Select { condition, accept, reject } => [condition, accept, reject].into_iter().for_each(visit),
        Expression::Math { arg, arg1, arg2, arg3, .. } => {
            visit(arg);
            [arg1, arg2, arg3].into_iter().flatten().for_each(visit);
        }
        Expression::ImageLoad { image, coordinate, array_index, sample, level } => {
            visit(image);
            visit(coordinate);
            [array_index, sample, level].into_iter().flatten().for_each(visit);
        }
        Expression::ImageQuery { image, query } => {
            visit(image);
            if let ImageQuery::Size { level: Some(level) } = query {
                visit(level);
            }
        }
        other => panic!("no kernel has a {other:?}"),
    }
}

/// Visits the operands of a statement that holds no other statements, and its results.
pub fn of_statement(
    statement: &mut Statement,
    mut visit: impl FnMut(&mut Handle<Expression>),
    mut result: impl FnMut(&mut Handle<Expression>),
) {
    match statement {
        Statement::Return { value: Some(value) } => visit(value),
        Statement::Break
        | Statement::Continue
        | Statement::Return { value: None }
        | Statement::ControlBarrier(_)
        | Statement::MemoryBarrier(_) => {}
        Statement::Store { pointer, value } => [pointer, value].into_iter().for_each(visit),
        Statement::ImageStore { image, coordinate, array_index, value } => {
            [image, coordinate, value].into_iter().for_each(&mut visit);
            array_index.iter_mut().for_each(visit);
        }
        Statement::Atomic { pointer, fun, value, result: made } => {
            [pointer, value].into_iter().for_each(&mut visit);
            if let naga::AtomicFunction::Exchange { compare: Some(compare) } = fun {
                visit(compare);
            }
            made.iter_mut().for_each(result);
        }
        Statement::WorkGroupUniformLoad { pointer, result: made } => {
            visit(pointer);
            result(made);
        }
        Statement::Call { arguments, result: made, .. } => {
            arguments.iter_mut().for_each(visit);
            made.iter_mut().for_each(result);
        }
        Statement::SubgroupBallot { predicate, result: made } => {
            predicate.iter_mut().for_each(visit);
            result(made);
        }
        Statement::SubgroupGather { mode, argument, result: made } => {
            use naga::GatherMode as By;
            match mode {
                By::Broadcast(lane)
                | By::Shuffle(lane)
                | By::ShuffleDown(lane)
                | By::ShuffleUp(lane)
                | By::ShuffleXor(lane)
                | By::QuadBroadcast(lane) => visit(lane),
                By::BroadcastFirst | By::QuadSwap(_) => {}
            }
            visit(argument);
            result(made);
        }
        Statement::SubgroupCollectiveOperation { argument, result: made, .. } => {
            visit(argument);
            result(made);
        }
        other => panic!("no kernel has a {other:?}"),
    }
}
