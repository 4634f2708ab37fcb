//! A function written anew, expression by expression, so that some of them can become others.

use std::collections::HashMap;

use naga::front::Typifier;
use naga::proc::ResolveContext;
use naga::{
    BinaryOperator, Block, Expression, Function, Handle, Literal, Module, Range, Scalar, ScalarKind, Span, Statement,
    TypeInner, VectorSize,
};

use super::operands::{of_expression, of_statement, stands_alone};

/// Rewrites every function of a module. `rewrite` is asked for every expression, whose operands are those of the new
/// function; what it does not replace stays.
pub fn rewrite(
    module: &mut Module,
    mut rewrite: impl FnMut(&mut Rewriting<'_>, &Expression) -> Option<Handle<Expression>>,
) {
    let functions: Vec<_> = module.functions.iter().map(|(handle, _)| handle).collect();
    for handle in functions {
        let made = rewritten(&module.functions[handle], module, &mut rewrite);
        module.functions[handle] = made;
    }
    for entry in 0..module.entry_points.len() {
        let made = rewritten(&module.entry_points[entry].function, module, &mut rewrite);
        module.entry_points[entry].function = made;
    }
}

/// Where an expression has its value.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Place {
    /// The stretch of statements without a branch.
    pub block: usize,
    /// How many loops it changes in.
    pub loops: usize,
}

/// The shape of numbers of single precision.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Shape {
    Scalar,
    Vector(VectorSize),
}

/// A function under way.
pub struct Rewriting<'a> {
    module: &'a Module,
    made: Function,
    types: Typifier,
    out: Block,
    values: HashMap<Handle<Expression>, Handle<Expression>>,
    places: HashMap<Handle<Expression>, Place>,
    uses: HashMap<Handle<Expression>, usize>,
    here: Place,
    blocks: usize,
}

type Rule<'r> = dyn FnMut(&mut Rewriting<'_>, &Expression) -> Option<Handle<Expression>> + 'r;

fn rewritten(source: &Function, module: &Module, rule: &mut Rule<'_>) -> Function {
    let mut made = source.clone();
    made.expressions.clear();
    made.named_expressions.clear();
    made.body = Block::new();
    let mut rewriting = Rewriting {
        module,
        made,
        types: Typifier::new(),
        out: Block::new(),
        values: HashMap::new(),
        places: HashMap::new(),
        uses: HashMap::new(),
        here: Place::default(),
        blocks: 0,
    };
    let inits: Vec<_> =
        source.local_variables.iter().filter_map(|(handle, local)| Some((handle, local.init?))).collect();
    for (handle, init) in inits {
        let init = rewriting.constant(source, init);
        rewriting.made.local_variables.get_mut(handle).init = Some(init);
    }
    let mut uses = HashMap::new();
    for (_, expression) in source.expressions.iter() {
        if is_emitted(expression) {
            of_expression(&mut expression.clone(), |operand| *uses.entry(*operand).or_insert(0) += 1);
        }
    }
    rewriting.block(source, &source.body, &uses, rule);
    rewriting.made.body = rewriting.out;
    rewriting.made
}

fn is_emitted(expression: &Expression) -> bool {
    !stands_alone(expression)
        && !matches!(
            expression,
            Expression::CallResult(_)
                | Expression::AtomicResult { .. }
                | Expression::WorkGroupUniformLoadResult { .. }
                | Expression::SubgroupBallotResult
                | Expression::SubgroupOperationResult { .. }
        )
}

impl Rewriting<'_> {
    /// An expression of the new function.
    pub fn expression(&self, handle: Handle<Expression>) -> &Expression {
        &self.made.expressions[handle]
    }

    /// Where a value is known.
    pub fn place(&self, handle: Handle<Expression>) -> Place {
        self.places.get(&handle).copied().unwrap_or_default()
    }

    /// Where the expression in hand will be.
    pub fn here(&self) -> Place {
        self.here
    }

    /// How often the old function uses a value.
    pub fn uses(&self, handle: Handle<Expression>) -> usize {
        self.uses.get(&handle).copied().unwrap_or(0)
    }

    /// The shape of a value, if it is one of numbers of single precision.
    pub fn shape(&self, handle: Handle<Expression>) -> Option<Shape> {
        match self.types.get(handle, &self.module.types) {
            TypeInner::Scalar(Scalar::F32) => Some(Shape::Scalar),
            TypeInner::Vector { size, scalar: Scalar::F32 } => Some(Shape::Vector(*size)),
            _ => None,
        }
    }

    /// The number that a value is, where it is one that is written in the shader.
    pub fn number(&self, handle: Handle<Expression>) -> Option<f32> {
        let expression = match self.expression(handle) {
            Expression::Constant(constant) => &self.module.global_expressions[self.module.constants[*constant].init],
            other => other,
        };
        match expression {
            Expression::Literal(Literal::F32(number)) => Some(*number),
            _ => None,
        }
    }

    fn append(&mut self, expression: Expression) -> Handle<Expression> {
        let handle = self.made.expressions.append(expression, Span::UNDEFINED);
        let context = ResolveContext::with_locals(self.module, &self.made.local_variables, &self.made.arguments);
        self.types.grow(handle, &self.made.expressions, &context).unwrap();
        handle
    }

    /// A new expression.
    pub fn emit(&mut self, expression: Expression) -> Handle<Expression> {
        let mut loops = 0;
        of_expression(&mut expression.clone(), |operand| loops = loops.max(self.place(*operand).loops));
        if matches!(expression, Expression::Load { .. } | Expression::ImageLoad { .. }) {
            loops = self.here.loops;
        }
        let handle = self.append(expression);
        self.places.insert(handle, Place { block: self.here.block, loops });
        self.out.push(Statement::Emit(Range::new_from_bounds(handle, handle)), Span::UNDEFINED);
        handle
    }

    /// A number, or as many as another value has.
    pub fn literal(&mut self, literal: Literal, shape: Shape) -> Handle<Expression> {
        let value = self.append(Expression::Literal(literal));
        match shape {
            Shape::Scalar => value,
            Shape::Vector(size) => self.emit(Expression::Splat { size, value }),
        }
    }

    pub fn binary(
        &mut self,
        op: BinaryOperator,
        left: Handle<Expression>,
        right: Handle<Expression>,
    ) -> Handle<Expression> {
        self.emit(Expression::Binary { op, left, right })
    }

    pub fn component(&mut self, base: Handle<Expression>, index: u32) -> Handle<Expression> {
        match self.expression(base) {
            Expression::Splat { value, .. } => *value,
            _ if self.shape(base) == Some(Shape::Scalar) => base,
            _ => self.emit(Expression::AccessIndex { base, index }),
        }
    }

    /// Numbers of another width in bytes.
    pub fn widened(&mut self, expr: Handle<Expression>, width: u8) -> Handle<Expression> {
        self.emit(Expression::As { expr, kind: ScalarKind::Float, convert: Some(width) })
    }

    fn constant(&mut self, source: &Function, handle: Handle<Expression>) -> Handle<Expression> {
        let mut expression = source.expressions[handle].clone();
        if !stands_alone(&expression) {
            of_expression(&mut expression, |operand| *operand = self.constant(source, *operand));
        }
        self.append(expression)
    }

    fn value(&mut self, source: &Function, handle: Handle<Expression>) -> Handle<Expression> {
        if let Some(known) = self.values.get(&handle) {
            return *known;
        }
        assert!(stands_alone(&source.expressions[handle]), "a value is used before it is emitted");
        let made = self.append(source.expressions[handle].clone());
        self.values.insert(handle, made);
        made
    }

    fn next_block(&mut self) {
        self.blocks += 1;
        self.here.block = self.blocks;
    }

    fn nested(
        &mut self,
        source: &Function,
        block: &Block,
        uses: &HashMap<Handle<Expression>, usize>,
        rule: &mut Rule<'_>,
    ) -> Block {
        let outer = std::mem::take(&mut self.out);
        self.next_block();
        self.block(source, block, uses, rule);
        self.next_block();
        std::mem::replace(&mut self.out, outer)
    }

    fn block(
        &mut self,
        source: &Function,
        block: &Block,
        uses: &HashMap<Handle<Expression>, usize>,
        rule: &mut Rule<'_>,
    ) {
        for statement in block {
            match statement {
                Statement::Emit(range) => {
                    for handle in range.clone() {
                        let mut expression = source.expressions[handle].clone();
                        of_expression(&mut expression, |operand| *operand = self.value(source, *operand));
                        let made = rule(self, &expression).unwrap_or_else(|| self.emit(expression));
                        self.uses.insert(made, uses.get(&handle).copied().unwrap_or(0));
                        self.values.insert(handle, made);
                    }
                }
                Statement::Block(block) => self.block(source, block, uses, rule),
                Statement::If { condition, accept, reject } => {
                    let condition = self.value(source, *condition);
                    let accept = self.nested(source, accept, uses, rule);
                    let reject = self.nested(source, reject, uses, rule);
                    self.out.push(Statement::If { condition, accept, reject }, Span::UNDEFINED);
                }
                Statement::Switch { selector, cases } => {
                    let selector = self.value(source, *selector);
                    let cases = cases.iter().map(|case| {
                        let body = self.nested(source, &case.body, uses, rule);
                        naga::SwitchCase { value: case.value, body, fall_through: case.fall_through }
                    });
                    let cases = cases.collect();
                    self.out.push(Statement::Switch { selector, cases }, Span::UNDEFINED);
                }
                Statement::Loop { body, continuing, break_if } => {
                    self.here.loops += 1;
                    let body = self.nested(source, body, uses, rule);
                    let continuing = self.nested(source, continuing, uses, rule);
                    let break_if = break_if.map(|condition| self.value(source, condition));
                    self.here.loops -= 1;
                    self.out.push(Statement::Loop { body, continuing, break_if }, Span::UNDEFINED);
                }
                other => {
                    let mut statement = other.clone();
                    let mut results = Vec::new();
                    of_statement(&mut statement, |operand| *operand = self.value(source, *operand), |_| {});
                    of_statement(&mut statement, |_| {}, |result| results.push(*result));
                    for result in results {
                        let made = self.append(source.expressions[result].clone());
                        self.places.insert(made, self.here);
                        self.values.insert(result, made);
                    }
                    of_statement(&mut statement, |_| {}, |result| *result = self.values[result]);
                    self.out.push(statement, Span::UNDEFINED);
                }
            }
        }
    }
}
