//! Products and sums contracted to one rounding, as WGSL lets a compiler do wherever it likes.

use naga::{BinaryOperator, Expression, Handle, Literal, MathFunction, Module, UnaryOperator};
use rand::{RngExt as _, SeedableRng as _, rngs::StdRng};

use super::rewriting::{Rewriting, Shape, rewrite};

/// Where products and sums are contracted; of a sum of two products, which one is not rounded.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Contraction {
    /// Everywhere, the first product if there are two.
    First,
    /// Everywhere, the second product if there are two.
    Second,
    /// As LLVM does where it selects instructions: products of the same basic block, once what does not change in a loop
    /// has been moved out of it; of two the one with fewer uses.
    Block,
    /// Every place by itself, as a number drawn for it says.
    Random(u64),
}

/// A product of two values, or of a component of each.
#[derive(Debug, Clone, Copy)]
struct Product {
    left: Handle<Expression>,
    right: Factor,
    negative: bool,
    component: Option<u32>,
    /// The multiplication.
    by: Handle<Expression>,
}

#[derive(Debug, Clone, Copy)]
enum Factor {
    Value(Handle<Expression>),
    Number(f32),
}

/// Contracts in every function of a module; with double precision as a product and a sum of it, rounded once, else by the
/// built-in function.
pub fn contract(module: &mut Module, contraction: Contraction, double: bool) {
    let seed = match contraction {
        Contraction::Random(seed) => seed,
        _ => 0,
    };
    let mut random = StdRng::seed_from_u64(seed);
    rewrite(module, |function, expression| match *expression {
        Expression::Binary { op: op @ (BinaryOperator::Add | BinaryOperator::Subtract), left, right } => {
            function.shape(left)?;
            let products = [left, right].map(|operand| product(function, operand));
            let chosen = choice(function, contraction, products, &mut random)?;
            let subtracted = op == BinaryOperator::Subtract;
            let product = products[chosen]?;
            let (other, signs) = match chosen {
                0 => (right, [product.negative, subtracted]),
                _ => (left, [product.negative != subtracted, false]),
            };
            Some(fused(function, product, other, signs, double))
        }
        Expression::Math { fun: MathFunction::Dot, arg, arg1: Some(other), .. } => {
            let Some(Shape::Vector(size)) = function.shape(arg) else { return None };
            let mut components: Vec<u32> = (0..size as u32).collect();
            match contraction {
                Contraction::First | Contraction::Block => {}
                Contraction::Second => components.reverse(),
                Contraction::Random(_) => match random.random_range(0..3) {
                    0 => return None,
                    1 => components.reverse(),
                    _ => {}
                },
            }
            Some(dot(function, [arg, other], &components, double))
        }
        _ => None,
    });
}

fn choice(
    function: &Rewriting<'_>,
    contraction: Contraction,
    products: [Option<Product>; 2],
    random: &mut StdRng,
) -> Option<usize> {
    let first = |[a, b]: [usize; 2]| [a, b].into_iter().find(|&operand| products[operand].is_some());
    match contraction {
        Contraction::First => first([0, 1]),
        Contraction::Second => first([1, 0]),
        Contraction::Block => {
            let near = products.map(|product| product.filter(|product| function.place(product.by) == function.here()));
            match near.map(|product| product.map(|product| function.uses(product.by))) {
                [Some(a), Some(b)] => Some(usize::from(a > b)),
                [Some(_), None] => Some(0),
                [None, Some(_)] => Some(1),
                [None, None] => None,
            }
        }
        // Every place draws, so that what is drawn elsewhere does not depend on it.
        Contraction::Random(_) => match random.random_range(0..4) {
            0 | 1 => None,
            2 => first([0, 1]),
            _ => first([1, 0]),
        },
    }
}

/// The product that a value is, if it is one.
fn product(function: &Rewriting<'_>, value: Handle<Expression>) -> Option<Product> {
    function.shape(value)?;
    match *function.expression(value) {
        // Nobody multiplies by one.
        Expression::Binary { op: BinaryOperator::Multiply, left, right } if is_one(function, left) => {
            product(function, right)
        }
        Expression::Binary { op: BinaryOperator::Multiply, left, right } if is_one(function, right) => {
            product(function, left)
        }
        Expression::Binary { op: BinaryOperator::Multiply, left, right } => {
            function.shape(left).and(function.shape(right))?;
            Some(Product { left, right: Factor::Value(right), negative: false, component: None, by: value })
        }
        // Who divides by a power of two multiplies by its inverse.
        Expression::Binary { op: BinaryOperator::Divide, left, right } => {
            let inverse = 1.0 / function.number(right)?;
            let power = inverse.is_normal() && inverse.to_bits().trailing_zeros() >= f32::MANTISSA_DIGITS - 1;
            let product = Product { left, right: Factor::Number(inverse), negative: false, component: None, by: value };
            power.then_some(product)
        }
        Expression::Unary { op: UnaryOperator::Negate, expr } => {
            let product = product(function, expr)?;
            Some(Product { negative: !product.negative, ..product })
        }
        Expression::AccessIndex { base, index } if matches!(function.shape(base), Some(Shape::Vector(_))) => {
            let product = product(function, base)?;
            Some(Product { component: Some(product.component.unwrap_or(index)), ..product })
        }
        _ => None,
    }
}

fn is_one(function: &Rewriting<'_>, value: Handle<Expression>) -> bool {
    function.number(value) == Some(1.0)
}

/// ± a product ± another value.
fn fused(
    function: &mut Rewriting<'_>,
    product: Product,
    other: Handle<Expression>,
    [product_negative, other_negative]: [bool; 2],
    double: bool,
) -> Handle<Expression> {
    let right = match product.right {
        Factor::Value(right) => right,
        Factor::Number(number) => function.literal(Literal::F32(number), Shape::Scalar),
    };
    let [mut left, mut right] = match product.component {
        None => [product.left, right],
        Some(index) => [product.left, right].map(|factor| function.component(factor, index)),
    };
    let mut other = other;
    let shape = function.shape(other).unwrap();
    if double {
        [left, right, other] = [left, right, other].map(|value| function.widened(value, 8));
    } else if let Shape::Vector(size) = shape {
        [left, right] = [left, right].map(|factor| match function.shape(factor) {
            Some(Shape::Scalar) => function.emit(Expression::Splat { size, value: factor }),
            _ => factor,
        });
    }
    let negated = |expr| Expression::Unary { op: UnaryOperator::Negate, expr };
    if product_negative {
        left = function.emit(negated(left));
    }
    if other_negative {
        other = function.emit(negated(other));
    }
    if double {
        let exact = function.binary(BinaryOperator::Multiply, left, right);
        let sum = function.binary(BinaryOperator::Add, exact, other);
        function.widened(sum, 4)
    } else {
        let fun = MathFunction::Fma;
        function.emit(Expression::Math { fun, arg: left, arg1: Some(right), arg2: Some(other), arg3: None })
    }
}

/// A scalar product as a chain.
fn dot(
    function: &mut Rewriting<'_>,
    vectors: [Handle<Expression>; 2],
    components: &[u32],
    double: bool,
) -> Handle<Expression> {
    let mut sum: Option<Handle<Expression>> = None;
    for &index in components {
        let [left, right] = vectors.map(|vector| function.component(vector, index));
        sum = Some(match sum {
            None => function.binary(BinaryOperator::Multiply, left, right),
            Some(sum) => {
                let right = Factor::Value(right);
                let product = Product { left, right, negative: false, component: None, by: left };
                fused(function, product, sum, [false; 2], double)
            }
        });
    }
    sum.expect("a vector has components")
}
