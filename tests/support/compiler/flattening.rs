//! Functions put into the functions that call them, as every driver does: what is contracted depends on it.

use std::collections::HashMap;

use naga::{Block, Expression, Function, Handle, LocalVariable, Module, Range, Span, Statement, TypeInner};

use super::operands::{of_expression, of_statement, stands_alone};

/// Puts every function that can be into those that call it.
pub fn flatten(module: &mut Module) {
    // Functions come after those that they call.
    let functions: Vec<_> = module.functions.iter().map(|(handle, _)| handle).collect();
    for handle in functions {
        let flat = flattened(&module.functions[handle], module);
        module.functions[handle] = flat;
    }
    for entry in 0..module.entry_points.len() {
        module.entry_points[entry].function = flattened(&module.entry_points[entry].function, module);
    }
}

/// A function under way.
struct Flattening<'a> {
    module: &'a Module,
    made: Function,
}

/// A function that is copied into it.
struct Copied<'a> {
    source: &'a Function,
    values: HashMap<Handle<Expression>, Handle<Expression>>,
    locals: HashMap<Handle<LocalVariable>, Handle<LocalVariable>>,
    /// Of a function that is called: what its returns become.
    called: bool,
    returned: Option<Handle<Expression>>,
    result: Option<Handle<LocalVariable>>,
}

fn flattened(source: &Function, module: &Module) -> Function {
    let made = Function {
        name: source.name.clone(),
        arguments: source.arguments.clone(),
        result: source.result.clone(),
        diagnostic_filter_leaf: source.diagnostic_filter_leaf,
        ..Function::default()
    };
    let mut flattening = Flattening { module, made };
    let mut copied =
        Copied { source, values: HashMap::new(), locals: HashMap::new(), called: false, returned: None, result: None };
    for (handle, variable) in source.local_variables.iter() {
        let init = variable.init.map(|init| flattening.constant(source, init, None));
        let variable = LocalVariable { init, ..variable.clone() };
        copied.locals.insert(handle, flattening.made.local_variables.append(variable, Span::UNDEFINED));
    }
    let statements: Vec<&Statement> = source.body.iter().collect();
    let mut body = Block::new();
    flattening.copy(&mut copied, &statements, &mut body);
    flattening.made.body = body;
    flattening.made
}

fn returns(statement: &Statement) -> usize {
    let within = |block: &Block| block.iter().map(returns).sum::<usize>();
    match statement {
        Statement::Return { .. } => 1,
        Statement::Block(block) => within(block),
        Statement::If { accept, reject, .. } => within(accept) + within(reject),
        Statement::Switch { cases, .. } => cases.iter().map(|case| within(&case.body)).sum(),
        Statement::Loop { body, continuing, .. } => within(body) + within(continuing),
        _ => 0,
    }
}

/// Whether the returns of a function are its end or behind branches, not in loops.
fn can_be_copied(block: &Block) -> bool {
    block.iter().all(|statement| match statement {
        Statement::Block(block) => can_be_copied(block),
        Statement::If { accept, reject, .. } => can_be_copied(accept) && can_be_copied(reject),
        Statement::Loop { .. } | Statement::Switch { .. } => returns(statement) == 0,
        _ => true,
    })
}

fn ends(block: &Block) -> bool {
    match block.last() {
        Some(Statement::Return { .. } | Statement::Break | Statement::Continue) => true,
        Some(Statement::Block(block)) => ends(block),
        Some(Statement::If { accept, reject, .. }) => ends(accept) && ends(reject),
        _ => false,
    }
}

impl<'a> Flattening<'a> {
    fn append(&mut self, expression: Expression) -> Handle<Expression> {
        self.made.expressions.append(expression, Span::UNDEFINED)
    }

    fn emit(&mut self, expression: Expression, out: &mut Block) -> Handle<Expression> {
        let made = self.append(expression);
        out.push(Statement::Emit(Range::new_from_bounds(made, made)), Span::UNDEFINED);
        made
    }

    /// The initial value of a variable, emitted where it becomes that of a store.
    fn constant(
        &mut self,
        source: &Function,
        handle: Handle<Expression>,
        mut out: Option<&mut Block>,
    ) -> Handle<Expression> {
        let mut expression = source.expressions[handle].clone();
        if stands_alone(&expression) {
            return self.append(expression);
        }
        of_expression(&mut expression, |operand| *operand = self.constant(source, *operand, out.as_deref_mut()));
        match out {
            Some(out) => self.emit(expression, out),
            None => self.append(expression),
        }
    }

    fn value(&mut self, copied: &mut Copied<'_>, handle: Handle<Expression>) -> Handle<Expression> {
        if let Some(known) = copied.values.get(&handle) {
            return *known;
        }
        let expression = match &copied.source.expressions[handle] {
            Expression::LocalVariable(variable) => Expression::LocalVariable(copied.locals[variable]),
            alone if stands_alone(alone) => alone.clone(),
            other => panic!("{other:?} is used before it is emitted"),
        };
        let made = self.append(expression);
        copied.values.insert(handle, made);
        made
    }

    fn copy(&mut self, copied: &mut Copied<'a>, statements: &[&'a Statement], out: &mut Block) {
        for (number, &statement) in statements.iter().enumerate() {
            let rest = &statements[number + 1..];
            match statement {
                Statement::Emit(range) => range.clone().for_each(|handle| self.copy_expression(copied, handle, out)),
                Statement::Block(block) => {
                    let all: Vec<&Statement> = block.iter().chain(rest.iter().copied()).collect();
                    return self.copy(copied, &all, out);
                }
                Statement::If { condition, accept, reject } => {
                    let condition = self.value(copied, *condition);
                    let leaves = copied.called && returns(statement) > 0;
                    let [accept, reject] = [accept, reject].map(|branch| {
                        let mut all: Vec<&Statement> = branch.iter().collect();
                        if leaves && !ends(branch) {
                            all.extend(rest);
                        }
                        let mut copy = Block::new();
                        self.copy(copied, &all, &mut copy);
                        copy
                    });
                    out.push(Statement::If { condition, accept, reject }, Span::UNDEFINED);
                    if leaves {
                        return;
                    }
                }
                Statement::Switch { selector, cases } => {
                    let selector = self.value(copied, *selector);
                    let cases = cases.iter().map(|case| {
                        let mut body = Block::new();
                        self.copy(copied, &case.body.iter().collect::<Vec<_>>(), &mut body);
                        naga::SwitchCase { value: case.value, body, fall_through: case.fall_through }
                    });
                    let cases = cases.collect();
                    out.push(Statement::Switch { selector, cases }, Span::UNDEFINED);
                }
                Statement::Loop { body, continuing, break_if } => {
                    let [body, continuing] = [body, continuing].map(|block| {
                        let mut copy = Block::new();
                        self.copy(copied, &block.iter().collect::<Vec<_>>(), &mut copy);
                        copy
                    });
                    let break_if = break_if.map(|condition| self.value(copied, condition));
                    out.push(Statement::Loop { body, continuing, break_if }, Span::UNDEFINED);
                }
                Statement::Return { value } if copied.called => {
                    if let Some(value) = value {
                        let value = self.value(copied, *value);
                        match copied.result {
                            None => copied.returned = Some(value),
                            Some(variable) => {
                                let pointer = self.append(Expression::LocalVariable(variable));
                                out.push(Statement::Store { pointer, value }, Span::UNDEFINED);
                            }
                        }
                    }
                    return;
                }
                Statement::Call { function, arguments, result }
                    if can_be_copied(&self.module.functions[*function].body) =>
                {
                    let arguments: Vec<_> = arguments.iter().map(|argument| self.value(copied, *argument)).collect();
                    let value = self.call(*function, &arguments, out);
                    if let Some(result) = result {
                        copied.values.insert(*result, value.expect("a function with a result"));
                    }
                }
                other => {
                    let mut statement = other.clone();
                    let mut results = Vec::new();
                    of_statement(&mut statement, |operand| *operand = self.value(copied, *operand), |_| {});
                    of_statement(&mut statement, |_| {}, |result| results.push(*result));
                    for result in results {
                        let made = self.append(copied.source.expressions[result].clone());
                        copied.values.insert(result, made);
                    }
                    of_statement(&mut statement, |_| {}, |result| *result = copied.values[result]);
                    out.push(statement, Span::UNDEFINED);
                }
            }
        }
    }

    fn copy_expression(&mut self, copied: &mut Copied<'_>, handle: Handle<Expression>, out: &mut Block) {
        let mut expression = copied.source.expressions[handle].clone();
        of_expression(&mut expression, |operand| *operand = self.value(copied, *operand));
        // A member of what has just been put together is that member.
        let member = match expression {
            Expression::AccessIndex { base, index } => self.member(base, index),
            _ => None,
        };
        let made = member.unwrap_or_else(|| self.emit(expression, out));
        copied.values.insert(handle, made);
    }

    fn member(&self, base: Handle<Expression>, index: u32) -> Option<Handle<Expression>> {
        let Expression::Compose { ty, components } = &self.made.expressions[base] else { return None };
        // Vectors may be composed of vectors.
        let whole = match self.module.types[*ty].inner {
            TypeInner::Vector { size, .. } => components.len() == size as usize,
            _ => true,
        };
        components.get(index as usize).filter(|_| whole).copied()
    }

    /// Copies the body of a function, and returns its value.
    fn call(
        &mut self,
        function: Handle<Function>,
        arguments: &[Handle<Expression>],
        out: &mut Block,
    ) -> Option<Handle<Expression>> {
        let source = &self.module.functions[function];
        let mut copied = Copied {
            source,
            values: HashMap::new(),
            locals: HashMap::new(),
            called: true,
            returned: None,
            result: None,
        };
        for (handle, expression) in source.expressions.iter() {
            if let Expression::FunctionArgument(number) = expression {
                copied.values.insert(handle, arguments[*number as usize]);
            }
        }
        for (handle, variable) in source.local_variables.iter() {
            let local = LocalVariable { init: None, ..variable.clone() };
            copied.locals.insert(handle, self.made.local_variables.append(local, Span::UNDEFINED));
            let pointer = self.append(Expression::LocalVariable(copied.locals[&handle]));
            let value = match variable.init {
                Some(init) => self.constant(source, init, Some(out)),
                None => self.append(Expression::ZeroValue(variable.ty)),
            };
            out.push(Statement::Store { pointer, value }, Span::UNDEFINED);
        }
        let many = returns_of(source) > 1;
        if let Some(result) = source.result.as_ref().filter(|_| many) {
            let variable = LocalVariable { name: None, ty: result.ty, init: None };
            copied.result = Some(self.made.local_variables.append(variable, Span::UNDEFINED));
        }
        self.copy(&mut copied, &source.body.iter().collect::<Vec<_>>(), out);
        match copied.result {
            None => copied.returned,
            Some(variable) => {
                let pointer = self.append(Expression::LocalVariable(variable));
                Some(self.emit(Expression::Load { pointer }, out))
            }
        }
    }
}

fn returns_of(function: &Function) -> usize {
    function.body.iter().map(returns).sum()
}
