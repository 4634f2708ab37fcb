//! Branches whose condition depends on numbers of the plan alone: they are taken before a device sees the kernel.

use std::collections::BTreeSet;

use naga::{Block, Expression, Function, Handle, Module, Statement};

/// Those that are there for a reason: boxes with fewer than three cells on an axis; a kernel that goes on from a report or not; and
/// quarters of a turn, which are a number of the scene and no feature.
pub const KNOWN: [&str; 5] = ["CELLS_X", "CELLS_Y", "CELLS_Z", "CLOSES", "QUARTER_TURNS"];

/// Laws and reports that a scene has or not: one module stands for all of them, and constants of its pipelines say which
/// it is. What is not chosen is taken out with what it binds.
pub const LAWS: [&str; 38] = [
    "AS_PRINTED",
    "BATHS_REMEMBER",
    "BOND_BATHS_NOISY",
    "BOND_POTENTIAL",
    "CHARGE_SUMS",
    "COLOURED_NOISE",
    "COUPLINGS_CONSERVE",
    "DISTRIBUTION",
    "EDGES",
    "EXCLUSIONS",
    "FORCES_BEGUN",
    "FRICTION_LAW",
    "FRICTION_SEES",
    "FROZEN",
    "GATHERS",
    "GENERATOR",
    "GYRATES",
    "HALVES",
    "HELD",
    "HOLD_PROCESS",
    "JUMP_ENTRIES",
    "KEEPS_FORCES",
    "KEEPS_MOMENTA",
    "LISTS_ALWAYS",
    "MANY_BODY",
    "ONE_MASS",
    "OSCILLATES",
    "OWN_ACTS",
    "POSITION_BATHS",
    "POSITION_BATHS_NOISY",
    "PREDICTION",
    "PROFILE",
    "RANGED",
    "REPULSIVE",
    "SEES_FLOW",
    "TURN_SINE",
    "WALLS_MOVE",
    "WEIGHT_ROOT_EXPONENT",
];

/// The constants that conditions of branches and selections depend on, where they depend on nothing else.
pub fn on_constants(module: &Module) -> BTreeSet<String> {
    let mut found = BTreeSet::new();
    let functions = module.functions.iter().map(|(_, function)| function);
    for function in functions.chain(module.entry_points.iter().map(|entry| &entry.function)) {
        let walk = Walk { module, function };
        walk.block(&function.body, &mut found);
        for (_, expression) in function.expressions.iter() {
            if let Expression::Select { condition, .. } = expression {
                walk.condition(*condition, &mut found);
            }
        }
    }
    found
}

struct Walk<'a> {
    module: &'a Module,
    function: &'a Function,
}

impl Walk<'_> {
    fn block(&self, block: &Block, found: &mut BTreeSet<String>) {
        for statement in block {
            match statement {
                Statement::Block(inner) => self.block(inner, found),
                Statement::If { condition, accept, reject } => {
                    self.condition(*condition, found);
                    self.block(accept, found);
                    self.block(reject, found);
                }
                Statement::Switch { selector, cases } => {
                    self.condition(*selector, found);
                    for case in cases {
                        self.block(&case.body, found);
                    }
                }
                Statement::Loop { body, continuing, .. } => {
                    self.block(body, found);
                    self.block(continuing, found);
                }
                _ => {}
            }
        }
    }

    fn condition(&self, condition: Handle<Expression>, found: &mut BTreeSet<String>) {
        let mut names = BTreeSet::new();
        if self.is_constant(condition, &mut names) {
            found.extend(names);
        }
    }

    /// Whether an expression is made of constants alone; collects those that plans set.
    fn is_constant(&self, expression: Handle<Expression>, names: &mut BTreeSet<String>) -> bool {
        let mut all = |parts: &[Handle<Expression>]| parts.iter().all(|part| self.is_constant(*part, names));
        match &self.function.expressions[expression] {
            Expression::Override(constant) => {
                names.extend(self.module.overrides[*constant].name.clone());
                true
            }
            Expression::Literal(_) | Expression::Constant(_) | Expression::ZeroValue(_) => true,
            Expression::Unary { expr, .. } | Expression::As { expr, .. } => all(&[*expr]),
            Expression::Splat { value, .. } => all(&[*value]),
            Expression::AccessIndex { base, .. } => all(&[*base]),
            Expression::Binary { left, right, .. } => all(&[*left, *right]),
            Expression::Select { condition, accept, reject } => all(&[*condition, *accept, *reject]),
            Expression::Compose { components, .. } => all(components),
            Expression::Math { arg, arg1, arg2, arg3, .. } => {
                all(&[Some(*arg), *arg1, *arg2, *arg3].into_iter().flatten().collect::<Vec<_>>())
            }
            _ => false,
        }
    }
}

#[test]
fn branches_on_constants_are_found_and_others_are_not() {
    let kernel = |condition: &str| {
        let text = format!(
            "override FEATURE: u32; override OTHER: f32;
            @group(0) @binding(0) var<storage, read_write> sums: array<u32>;
            @compute @workgroup_size(1) fn main() {{ if ({condition}) {{ sums[0] = 1u; }} }}"
        );
        on_constants(&naga::front::wgsl::parse_str(&text).unwrap())
    };
    assert_eq!(kernel("FEATURE == 1u").into_iter().collect::<Vec<_>>(), ["FEATURE"]);
    assert_eq!(kernel("max(OTHER, 0.5) > f32(FEATURE)").into_iter().collect::<Vec<_>>(), ["FEATURE", "OTHER"]);
    assert!(kernel("sums[0] == FEATURE").is_empty());
}
