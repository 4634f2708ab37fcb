//! Built-in functions that err as much as WGSL lets them: <https://www.w3.org/TR/WGSL/#concrete-float-accuracy>.

use naga::{BinaryOperator, Expression, Handle, Literal, MathFunction, Module, ScalarKind};

use super::rewriting::{Rewriting, Shape, rewrite};

/// Which functions err.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Functions {
    Logarithms,
    Trigonometric,
    Exponentials,
    Roots,
    Quotients,
    All,
}

/// In which direction.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Deviation {
    Up,
    Down,
    /// Up or down as the last bit of the result says.
    Either,
}

const ULP: f32 = f32::EPSILON;

/// How far a result may be off: by so much where it is so small, else by a part of itself.
#[derive(Debug, Clone, Copy)]
struct Allowed {
    absolute: f32,
    within: f32,
    relative: f32,
}

/// What kind of function it is, and how far its results may be off.
fn allowed(fun: MathFunction) -> Option<(Functions, Allowed)> {
    let part = |relative| Allowed { absolute: 0.0, within: 0.0, relative };
    // An absolute error for arguments between ½ and 2, and three units of the last place beyond.
    let logarithm = |within| Allowed { absolute: 2_f32.powi(-21), within, relative: 1.5 * ULP };
    Some(match fun {
        MathFunction::Log => (Functions::Logarithms, logarithm(std::f32::consts::LN_2)),
        MathFunction::Log2 => (Functions::Logarithms, logarithm(1.0)),
        MathFunction::Sin | MathFunction::Cos => {
            (Functions::Trigonometric, Allowed { absolute: 2_f32.powi(-11), within: f32::INFINITY, relative: 0.0 })
        }
        MathFunction::Exp | MathFunction::Exp2 => (Functions::Exponentials, part(3.0 * ULP)),
        // That of exp2(y log2(x)), where both are small.
        MathFunction::Pow => (Functions::Exponentials, part(8.0 * ULP)),
        MathFunction::Sqrt | MathFunction::Length | MathFunction::Normalize => (Functions::Roots, part(2.5 * ULP)),
        MathFunction::InverseSqrt => (Functions::Roots, part(2.0 * ULP)),
        _ => return None,
    })
}

/// Makes functions of some kind err.
pub fn perturb(module: &mut Module, which: Functions, deviation: Deviation) {
    let errs = |kind| which == Functions::All || which == kind;
    rewrite(module, |function, expression| {
        let allowed = match expression {
            Expression::Math { fun, .. } => allowed(*fun).filter(|(kind, _)| errs(*kind))?.1,
            Expression::Binary { op: BinaryOperator::Divide, .. } if errs(Functions::Quotients) => {
                Allowed { absolute: 0.0, within: 0.0, relative: 2.5 * ULP }
            }
            _ => return None,
        };
        let exact = function.emit(expression.clone());
        // Integers are divided too.
        let Some(shape) = function.shape(exact) else { return Some(exact) };
        Some(deviating(function, exact, shape, allowed, deviation))
    });
}

fn deviating(
    function: &mut Rewriting<'_>,
    exact: Handle<Expression>,
    shape: Shape,
    Allowed { absolute, within, relative }: Allowed,
    deviation: Deviation,
) -> Handle<Expression> {
    let sign = match deviation {
        Deviation::Up => function.literal(Literal::F32(1.0), shape),
        Deviation::Down => function.literal(Literal::F32(-1.0), shape),
        Deviation::Either => {
            let bits = function.emit(Expression::As { expr: exact, kind: ScalarKind::Uint, convert: None });
            let one = function.literal(Literal::U32(1), shape);
            let last = function.binary(BinaryOperator::And, bits, one);
            let number = function.widened(last, 4);
            let twice = function.binary(BinaryOperator::Add, number, number);
            let unit = function.literal(Literal::F32(1.0), shape);
            function.binary(BinaryOperator::Subtract, twice, unit)
        }
    };
    let fun = MathFunction::Abs;
    let size = function.emit(Expression::Math { fun, arg: exact, arg1: None, arg2: None, arg3: None });
    let factor = function.literal(Literal::F32(relative), shape);
    let part = function.binary(BinaryOperator::Multiply, size, factor);
    let whole = function.literal(Literal::F32(absolute), shape);
    let bound = function.literal(Literal::F32(within.min(f32::MAX)), shape);
    let condition = function.binary(BinaryOperator::Less, size, bound);
    let error = function.emit(Expression::Select { condition, accept: whole, reject: part });
    let signed = function.binary(BinaryOperator::Multiply, error, sign);
    function.binary(BinaryOperator::Add, exact, signed)
}
