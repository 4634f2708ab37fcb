//! Arrays that are larger than a kernel may bind, in portions: every portion is a binding of its own, and each access chooses
//! among them. What a kernel computes stays the same.

use std::collections::BTreeMap;
use std::mem;

use naga::front::Typifier;
use naga::proc::ResolveContext;
use naga::{
    ArraySize, AtomicFunction, BinaryOperator, Block, Expression, Function, GlobalVariable, Handle, Literal,
    LocalVariable, MathFunction, Module, Range, ResourceBinding, ScalarKind, Span, Statement, SwitchCase, SwitchValue,
    Type, TypeInner,
};

use super::access::plain;
use super::shader::Binding;
use crate::shaders::Array;

/// An array in portions.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Portions {
    /// Number of portions, at least two.
    pub count: u32,
    /// Bytes of each but the last, which may be shorter.
    pub bytes: u64,
}

impl Portions {
    /// Bytes that are divisible by every size of an element, and by what copies between buffers have to begin at.
    pub(crate) const UNIT: u64 = 256 * 3 * 3 * 5 * 7;

    /// Portions of an array of this size that are as large as a binding may be; none if one is enough.
    ///
    /// ```
    /// use mesoscope::gpu::Portions;
    ///
    /// let largest = (1 << 31) - 1;
    /// assert_eq!(Portions::new(largest, largest), None);
    /// // Five hundred million particles of 32 bytes.
    /// assert_eq!(Portions::new(16_000_000_000, largest).map(|portions| portions.count), Some(8));
    /// ```
    #[must_use]
    pub fn new(array: u64, binding: u64) -> Option<Self> {
        let bytes = (binding - binding % Self::UNIT).max(Self::UNIT);
        let count = u32::try_from(array.div_ceil(bytes)).ok()?;
        (array > binding).then_some(Self { count, bytes })
    }
}

/// An array that cannot be divided: a kernel uses it otherwise than by its elements, or it has more than can be numbered.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
#[error("a kernel needs the whole of `{}` at once", .array.name())]
pub struct Undivided {
    /// The array.
    pub array: Array,
    /// Bytes of it that could be divided: none, or as many as elements can be numbered.
    pub most: u64,
}

impl Undivided {
    pub(super) const fn whole(array: Array) -> Self {
        Self { array, most: 0 }
    }
}

/// Elements in a portion of an array, if it is one of elements of which portions hold whole ones.
fn elements_in_portion(module: &Module, ty: Handle<Type>, array: Array, portions: Portions) -> Result<u32, Undivided> {
    let TypeInner::Array { size: ArraySize::Dynamic, stride, .. } = module.types[ty].inner else {
        return Err(Undivided::whole(array));
    };
    let elements = portions.bytes / u64::from(stride);
    if !portions.bytes.is_multiple_of(stride.into()) {
        return Err(Undivided::whole(array));
    }
    // They are numbered by 32-bit words.
    let too_many = Undivided { array, most: u64::from(stride) << 32 };
    let numbered = elements * u64::from(portions.count) <= 1 << 32;
    u32::try_from(elements).ok().filter(|_| numbered).ok_or(too_many)
}

/// Divides arrays of a module, whose bindings are those given; adds the bindings of further portions to them.
///
/// # Errors
/// [`Undivided`] if an array has no elements of one type, more than can be numbered, or is used otherwise than by single elements.
pub(super) fn divide(
    module: &mut Module,
    bindings: &mut Vec<Binding>,
    portions_of: impl Fn(Array) -> Option<Portions>,
) -> Result<(), Undivided> {
    let numbers = module.global_variables.iter().filter_map(|(_, variable)| Some(variable.binding?.binding));
    let mut next = numbers.max().unwrap_or(0) + 1;
    let mut divided = BTreeMap::new();
    for binding in bindings.clone() {
        let Some(portions) = portions_of(binding.array).filter(|_| !binding.texture) else { continue };
        let is_bound =
            |variable: &GlobalVariable| variable.binding.is_some_and(|bound| bound.binding == binding.number);
        let undivided = Undivided::whole(binding.array);
        let found = module.global_variables.iter().find(|(_, variable)| is_bound(variable));
        let (first, variable) = found.map(|(handle, variable)| (handle, variable.clone())).ok_or(undivided)?;
        let each = elements_in_portion(module, variable.ty, binding.array, portions)?;
        let TypeInner::Array { base, .. } = module.types[variable.ty].inner else { return Err(undivided) };
        let element = plain(module, base).ok_or(undivided)?;
        let mut variables = vec![first];
        for portion in 1..portions.count {
            let bound = variable.binding.map(|bound| ResourceBinding { binding: next, ..bound });
            let name = format!("{}_portion_{portion}", binding.array.name());
            let further = GlobalVariable { name: Some(name), binding: bound, ..variable.clone() };
            variables.push(module.global_variables.append(further, Span::UNDEFINED));
            bindings.push(Binding { number: next, portion, ..binding.clone() });
            next += 1;
        }
        divided.insert(first, Divided { array: binding.array, variables, each, element });
    }
    if divided.is_empty() {
        return Ok(());
    }
    for handle in module.functions.iter().map(|(handle, _)| handle).collect::<Vec<_>>() {
        module.functions[handle] = rewritten(module, &module.functions[handle], &divided)?;
    }
    for entry in 0..module.entry_points.len() {
        module.entry_points[entry].function = rewritten(module, &module.entry_points[entry].function, &divided)?;
    }
    Ok(())
}

/// An array that is divided.
struct Divided {
    array: Array,
    /// A variable for each portion.
    variables: Vec<Handle<GlobalVariable>>,
    /// Elements of a portion.
    each: u32,
    /// The type of an element when it is loaded.
    element: Handle<Type>,
}

/// Where an element is.
#[derive(Clone, Copy)]
enum Index {
    Constant(u32),
    Unsigned(Handle<Expression>),
    Signed(Handle<Expression>),
}

/// An element that a function accesses.
struct Element<'a> {
    array: &'a Divided,
    index: Index,
}

/// A function that accesses single elements of arrays, where these are divided.
fn rewritten(
    module: &Module,
    function: &Function,
    divided: &BTreeMap<Handle<GlobalVariable>, Divided>,
) -> Result<Function, Undivided> {
    let array_of = |expression: Handle<Expression>| match function.expressions[expression] {
        Expression::GlobalVariable(variable) => divided.get(&variable),
        _ => None,
    };
    let mut elements = BTreeMap::new();
    for (handle, expression) in function.expressions.iter() {
        let (Expression::AccessIndex { base, .. } | Expression::Access { base, .. } | Expression::ArrayLength(base)) =
            *expression
        else {
            continue;
        };
        let Some(array) = array_of(base) else { continue };
        let index = match *expression {
            Expression::AccessIndex { index, .. } => Some(Index::Constant(index)),
            Expression::Access { index, .. } => kind_of(module, function, index).and_then(|kind| match kind {
                ScalarKind::Uint => Some(Index::Unsigned(index)),
                ScalarKind::Sint => Some(Index::Signed(index)),
                _ => None,
            }),
            _ => None,
        };
        elements.insert(handle, Element { array, index: index.ok_or(Undivided::whole(array.array))? });
    }
    // An element that is accessed becomes a variable of the function: what is loaded of it is first copied there from its portion.
    let mut function = function.clone();
    for (handle, element) in &elements {
        let variable = LocalVariable { name: None, ty: element.array.element, init: None };
        let variable = function.local_variables.append(variable, Span::UNDEFINED);
        function.expressions[*handle] = Expression::LocalVariable(variable);
    }
    let body = mem::take(&mut function.body);
    function.body = Rewriting { function: &mut function, elements: &elements }.block(body)?;
    Ok(function)
}

fn kind_of(module: &Module, function: &Function, index: Handle<Expression>) -> Option<ScalarKind> {
    let context = ResolveContext::with_locals(module, &function.local_variables, &function.arguments);
    let mut types = Typifier::new();
    types.grow(index, &function.expressions, &context).ok()?;
    types.get(index, &module.types).scalar_kind()
}

/// The way from an array in portions to a part of an element.
struct Way<'a> {
    element: &'a Element<'a>,
    /// From the element to its part, the last first.
    steps: Vec<Step>,
}

enum Step {
    Access(Handle<Expression>),
    AccessIndex(u32),
}

/// A function whose accesses to arrays in portions are rewritten.
struct Rewriting<'a> {
    function: &'a mut Function,
    elements: &'a BTreeMap<Handle<Expression>, Element<'a>>,
}

impl<'a> Rewriting<'a> {
    fn block(&mut self, block: Block) -> Result<Block, Undivided> {
        let mut written = Block::with_capacity(block.len());
        for (statement, span) in block.span_into_iter() {
            match statement {
                Statement::Emit(range) => self.emit(range, &mut written),
                Statement::Store { pointer, value } if let Some(way) = self.way(pointer) => {
                    self.in_portion(&way, &mut written, |_, pointer, block| {
                        block.push(Statement::Store { pointer, value }, span);
                    });
                }
                Statement::Atomic { pointer, fun, value, result } if let Some(way) = self.way(pointer) => {
                    if matches!(fun, AtomicFunction::Exchange { compare: Some(_) }) {
                        return Err(Undivided::whole(way.element.array.array));
                    }
                    let kept = result.map(|result| self.function.expressions[result].clone());
                    self.in_portion(&way, &mut written, |this, there, block| {
                        let result = kept.clone().map(|result| this.add(result));
                        block.push(Statement::Atomic { pointer: there, fun, value, result }, span);
                        if let Some(value) = result {
                            block.push(Statement::Store { pointer, value }, span);
                        }
                    });
                    if let Some(result) = result {
                        self.function.expressions[result] = Expression::Load { pointer };
                        written.push(Statement::Emit(Range::new_from_bounds(result, result)), span);
                    }
                }
                Statement::Call { ref arguments, .. }
                    if let Some(way) = arguments.iter().find_map(|value| self.way(*value)) =>
                {
                    return Err(Undivided::whole(way.element.array.array));
                }
                Statement::Block(block) => written.push(Statement::Block(self.block(block)?), span),
                Statement::If { condition, accept, reject } => {
                    let (accept, reject) = (self.block(accept)?, self.block(reject)?);
                    written.push(Statement::If { condition, accept, reject }, span);
                }
                Statement::Switch { selector, mut cases } => {
                    for case in &mut cases {
                        case.body = self.block(mem::take(&mut case.body))?;
                    }
                    written.push(Statement::Switch { selector, cases }, span);
                }
                Statement::Loop { body, continuing, break_if } => {
                    let (body, continuing) = (self.block(body)?, self.block(continuing)?);
                    written.push(Statement::Loop { body, continuing, break_if }, span);
                }
                other => written.push(other, span),
            }
        }
        Ok(written)
    }

    /// Evaluates expressions in their order; before a load from an array in portions it is copied to where it is loaded from.
    fn emit(&mut self, range: Range<Expression>, block: &mut Block) {
        let mut begun: Option<(Handle<Expression>, Handle<Expression>)> = None;
        let evaluate = |begun: Option<(_, _)>, block: &mut Block| {
            if let Some((first, last)) = begun {
                block.push(Statement::Emit(Range::new_from_bounds(first, last)), Span::UNDEFINED);
            }
        };
        for expression in range {
            if self.elements.contains_key(&expression) {
                evaluate(begun.take(), block);
                continue;
            }
            if let Expression::Load { pointer } = self.function.expressions[expression]
                && let Some(way) = self.way(pointer)
            {
                evaluate(begun.take(), block);
                self.in_portion(&way, block, |this, there, block| {
                    let value = this.add(Expression::Load { pointer: there });
                    block.push(Statement::Emit(Range::new_from_bounds(value, value)), Span::UNDEFINED);
                    block.push(Statement::Store { pointer, value }, Span::UNDEFINED);
                });
            }
            begun = Some((begun.map_or(expression, |(first, _)| first), expression));
        }
        evaluate(begun, block);
    }

    /// The way to what a pointer points to, if that is an element of an array in portions or a part of one.
    fn way(&self, pointer: Handle<Expression>) -> Option<Way<'a>> {
        let (mut here, mut steps) = (pointer, Vec::new());
        loop {
            if let Some(element) = self.elements.get(&here) {
                return Some(Way { element, steps });
            }
            let (base, step) = match self.function.expressions[here] {
                Expression::Access { base, index } => (base, Step::Access(index)),
                Expression::AccessIndex { base, index } => (base, Step::AccessIndex(index)),
                _ => return None,
            };
            steps.push(step);
            here = base;
        }
    }

    fn add(&mut self, expression: Expression) -> Handle<Expression> {
        self.function.expressions.append(expression, Span::UNDEFINED)
    }

    /// Acts on the place in a portion to which a way leads.
    fn in_portion(
        &mut self,
        way: &Way<'_>,
        block: &mut Block,
        act: impl Fn(&mut Self, Handle<Expression>, &mut Block),
    ) {
        let Divided { variables, each, .. } = way.element.array;
        let last = variables.len() - 1;
        let index = match way.element.index {
            Index::Constant(index) => {
                let portion = (index / each).min(last as u32);
                let within = self.add(Expression::Literal(Literal::U32(index - portion * each)));
                let place = self.place(variables[portion as usize], within, &way.steps, block);
                return act(self, place, block);
            }
            Index::Unsigned(index) => index,
            Index::Signed(expr) => {
                let index = self.add(Expression::As { expr, kind: ScalarKind::Uint, convert: None });
                block.push(Statement::Emit(Range::new_from_bounds(index, index)), Span::UNDEFINED);
                index
            }
        };
        let [each, highest] = [*each, last as u32].map(|number| self.add(Expression::Literal(Literal::U32(number))));
        let binary = |op, left, right| Expression::Binary { op, left, right };
        let quotient = self.add(binary(BinaryOperator::Divide, index, each));
        let (fun, arg1) = (MathFunction::Min, Some(highest));
        let portion = self.add(Expression::Math { fun, arg: quotient, arg1, arg2: None, arg3: None });
        let before = self.add(binary(BinaryOperator::Multiply, portion, each));
        let within = self.add(binary(BinaryOperator::Subtract, index, before));
        block.push(Statement::Emit(Range::new_from_bounds(quotient, within)), Span::UNDEFINED);
        let mut cases = Vec::with_capacity(variables.len());
        for (number, variable) in variables.iter().enumerate() {
            let mut body = Block::new();
            let place = self.place(*variable, within, &way.steps, &mut body);
            act(self, place, &mut body);
            let value = if number == last { SwitchValue::Default } else { SwitchValue::U32(number as u32) };
            cases.push(SwitchCase { value, body, fall_through: false });
        }
        block.push(Statement::Switch { selector: portion, cases }, Span::UNDEFINED);
    }

    /// A pointer to an element of a portion, or to the part of it to which steps lead.
    fn place(
        &mut self,
        variable: Handle<GlobalVariable>,
        within: Handle<Expression>,
        steps: &[Step],
        block: &mut Block,
    ) -> Handle<Expression> {
        let base = self.add(Expression::GlobalVariable(variable));
        let first = self.add(Expression::Access { base, index: within });
        let place = steps.iter().rev().fold(first, |base, step| {
            self.add(match *step {
                Step::Access(index) => Expression::Access { base, index },
                Step::AccessIndex(index) => Expression::AccessIndex { base, index },
            })
        });
        block.push(Statement::Emit(Range::new_from_bounds(first, place)), Span::UNDEFINED);
        place
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    use naga::valid::{Capabilities, ValidationFlags, Validator};

    /// Divides `counts`, an array of words, and `places`, a structure, in a kernel of these statements.
    fn divided(statements: &str, portions: Portions) -> Result<(Module, Vec<Binding>), Undivided> {
        let text = format!(
            "struct Places {{ first: u32, all: array<u32> }}
            @group(0) @binding(0) var<storage, read_write> counts: array<atomic<u32>>;
            @group(0) @binding(1) var<storage, read_write> places: Places;
            @compute @workgroup_size(1) fn main(@builtin(local_invocation_index) lane: u32) {{ {statements} }}"
        );
        let mut module = naga::front::wgsl::parse_str(&text).unwrap();
        let binding = |number, array| Binding { number, array, texture: false, portion: 0 };
        let mut bindings = vec![binding(0, Array::Counts), binding(1, Array::Places)];
        let is_used =
            |array| module.global_variables.iter().any(|(_, variable)| variable.name.as_deref() == Some(array));
        assert!(is_used("counts"));
        let of = |array: Array| statements.contains(array.name()).then_some(portions);
        divide(&mut module, &mut bindings, of)?;
        Validator::new(ValidationFlags::all(), Capabilities::all()).validate(&module).unwrap();
        Ok((module, bindings))
    }

    #[test]
    fn elements_are_divided_and_the_rest_is_refused() {
        let three = Portions { count: 3, bytes: 1 << 20 };
        for statements in [
            "atomicStore(&counts[lane], 1u);",
            "let before = atomicAdd(&counts[lane + 7u], 2u); atomicMax(&counts[before], before);",
            "for (var i = 0u; i < 3u; i++) { if (atomicLoad(&counts[i]) > 1u) { atomicStore(&counts[5], lane); } }",
            "atomicStore(&counts[i32(lane)], atomicLoad(&counts[1]));",
        ] {
            let (module, bindings) = divided(statements, three).unwrap();
            let of_counts = bindings.iter().filter(|binding| binding.array == Array::Counts);
            assert_eq!(of_counts.map(|binding| binding.portion).collect::<Vec<_>>(), [0, 1, 2], "{statements}");
            assert_eq!(module.global_variables.len(), 4, "{statements}");
        }
        let refused = |statements: &str, portions| divided(statements, portions).unwrap_err();
        assert_eq!(
            refused("atomicStore(&counts[arrayLength(&counts) - 1u], 1u);", three),
            Undivided::whole(Array::Counts)
        );
        assert_eq!(refused("places.all[lane] = 1u;", three), Undivided::whole(Array::Places));
        // Words beyond those that a word can number.
        let many = Portions { count: 9, bytes: 1 << 31 };
        assert_eq!(refused("atomicStore(&counts[lane], 1u);", many), Undivided { array: Array::Counts, most: 4 << 32 });
    }

    #[test]
    fn portions_hold_whole_elements_of_every_size() {
        let portions = Portions::new(1 << 34, (1 << 31) - 4).unwrap();
        assert_eq!(portions.count, 9);
        for size in [4, 8, 12, 16, 20, 28, 32, 36, 48, 60, 64] {
            assert!(portions.bytes.is_multiple_of(size), "{size}");
        }
    }
}
