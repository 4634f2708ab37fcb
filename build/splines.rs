//! Splines of every number of points by which charges are spread over a mesh and gathered from it: the slot `charges/spline`.
//!
//! All is written out, for arrays whose elements are known need no memory.

use std::fmt::Write as _;

/// The names of the numbers of points, each of which is even.
const SPLINES: [(&str, usize); 2] = [("four", 4), ("six", 6)];

/// The weights of a difference, from the nearest nodes on.
const DIFFERENCES: [&str; 3] = ["DIFFERENCE_ONE", "DIFFERENCE_TWO", "DIFFERENCE_THREE"];

/// The variants of the slot: path and text.
pub fn variants() -> impl Iterator<Item = (String, String)> {
    SPLINES.iter().map(|(name, points)| (format!("charges/spline/{name}"), text(name, *points)))
}

fn text(name: &str, points: usize) -> String {
    let reach = 2 * points;
    let mut text = format!(
        "// Splines of {name} points.\n\
         const ORDER: u32 = {points}u;\n\
         struct SplineWeights {{ values: array<i32, {points}> }}\n\
         struct PlainWeights {{ values: array<f32, {points}> }}\n\
         struct SplineSlopes {{ values: array<f32, {reach}> }}\n\n"
    );
    text += &weights(points);
    text += &returning(
        "// Weights as real numbers.\nfn plain_weights(weights: SplineWeights) -> PlainWeights",
        &format!("PlainWeights(array<f32, {points}>"),
        (0..points).map(|node| format!("f32(weights.values[{node}])")),
    );
    text += "// Spreads the charge of a row of a cloud, from the first node under its spline on.\n\
             fn spread_row(row: u32, first: u32, weights: SplineWeights, of_row: f32) {\n";
    for node in 0..points {
        let place = format!("row + node_after(first, {node}u, CHARGE_NODES_X)");
        let _ = writeln!(text, "    spread_on({place}, weights.values[{node}], of_row);");
    }
    text += "}\n\n";
    text += &returning(
        "// The weights by which a spline gathers antisymmetric differences, from half as many nodes before it on.\n\
         fn slopes_along(weights: SplineWeights) -> SplineSlopes",
        &format!("SplineSlopes(array<f32, {reach}>"),
        (0..reach).map(|node| format!("f32({})", slope(points, node))),
    );
    text + &rows(points)
}

/// A function of one statement, which returns an array in a structure.
fn returning(head: &str, constructor: &str, values: impl Iterator<Item = String>) -> String {
    let lines: Vec<String> = values.map(|value| format!("        {value},")).collect();
    format!("{head} {{\n    return {constructor}(\n{}\n    ));\n}}\n\n", lines.join("\n"))
}

/// The recursion M(n, x) = (x M(n-1, x) + (n - x) M(n-1, x-1))/(n - 1).
fn weights(points: usize) -> String {
    let mut text = String::from(
        "// A weight times a number of wholes and a fraction in 2^-32.\n\
         fn weight_times(weight: u32, wholes: u32, fraction: u32) -> u32 { return wholes * weight + high_of_product(fraction, weight); }\n\n\
         // The weights of nodes, in 2^-24, at a place between two of them in 2^-32, from the node that is furthest before it on: by\n\
         // M(n, x) = (x M(n-1, x) + (n - x) M(n-1, x-1))/(n - 1) in integers of 2^-28.\n\
         fn weights_along(after: u32) -> SplineWeights {\n    let before = ~after;\n    \
         let m2_0 = before >> 4u;\n    let m2_1 = after >> 4u;\n",
    );
    for order in 3..=points {
        let less = order - 1;
        for node in 0..order {
            let rising = (node > 0)
                .then(|| format!("weight_times(m{less}_{}, {}u, after)", node.saturating_sub(1), less - node));
            let falling = (node < less).then(|| format!("weight_times(m{less}_{node}, {node}u, before)"));
            let terms: Vec<String> = rising.into_iter().chain(falling).collect();
            let _ = writeln!(text, "    let m{order}_{node} = ({}) / {less}u;", terms.join(" + "));
        }
    }
    let values: Vec<String> = (0..points).map(|node| format!("        i32((m{points}_{node} + 8u) >> 4u),")).collect();
    let _ = write!(text, "    return SplineWeights(array<i32, {points}>(\n{}\n    ));\n}}\n\n", values.join("\n"));
    text
}

/// The sum of weights, each times that of a difference, that a node of the reach has: Σ c(s) (w(n - s) - w(n + s)).
fn slope(points: usize, node: usize) -> String {
    let half = points / 2;
    let weight = |place: usize| place.checked_sub(half).filter(|index| *index < points);
    let terms: Vec<String> = DIFFERENCES[..half]
        .iter()
        .zip(1..)
        .filter_map(|(difference, off)| {
            let before = node.checked_sub(off).and_then(weight);
            Some(match (before, weight(node + off)) {
                (None, None) => return None,
                (Some(before), None) => format!("{difference} * weights.values[{before}]"),
                (None, Some(after)) => format!("{difference} * -weights.values[{after}]"),
                (Some(before), Some(after)) => {
                    format!("{difference} * (weights.values[{before}] - weights.values[{after}])")
                }
            })
        })
        .collect();
    terms.join(" + ")
}

/// Sums over a row of nodes, of fused products.
fn rows(points: usize) -> String {
    let (reach, half) = (2 * points, points / 2);
    let potential = |node: usize| format!("potential_at(row + node_after(first, {node}u, CHARGE_NODES_X))");
    let sum = |name: &str, weights: &str, count: usize, value: &dyn Fn(usize) -> String| {
        let mut text = format!("    var {name} = {weights}.values[0] * {};\n", value(0));
        for index in 1..count {
            let _ = writeln!(text, "    {name} = fma({weights}.values[{index}], {}, {name});", value(index));
        }
        text
    };
    let mut text = String::from(
        "// The potential of a row of nodes weighed by the spline along x; and in `slope_of_row` by its slopes as well, which reach further.\n\
         fn potential_of_row(row: u32, first: u32) -> f32 {\n",
    );
    text += &sum("sum", "plain_x", points, &|node| potential(node + half));
    text += "    return sum;\n}\nfn slope_of_row(row: u32, first: u32) -> vec2<f32> {\n";
    for node in 0..reach {
        let _ = writeln!(text, "    let p{node} = {};", potential(node));
    }
    text += &sum("plain", "plain_x", points, &|node| format!("p{}", node + half));
    text += &sum("slope", "slopes_x", reach, &|node| format!("p{node}"));
    text + "    return vec2<f32>(plain, slope);\n}\n"
}
