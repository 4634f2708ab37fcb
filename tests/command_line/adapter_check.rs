//! The check of an adapter as its user meets it.

use crate::support::program::{command, fails, text};

/// The plans that every GPU gets, on any adapter.
#[test]
fn an_adapter_is_checked_and_described() {
    check_the_page(&checked(Some("gpu")));
}

#[test]
#[ignore = "a minute: an_adapter_is_checked_and_described with the plans of the adapter"]
fn an_adapter_is_checked_with_its_own_plans() {
    check_the_page(&checked(None));
}

/// What the command says, of the adapter of the tests.
fn checked(plan: Option<&str>) -> String {
    let mut check = command(&["adapters", "--check"]);
    check.args(std::env::var("MESOSCOPE_ADAPTER").iter().flat_map(|adapter| ["--adapter", adapter]));
    check.envs(plan.map(|plan| ("MESOSCOPE_PLAN", plan)));
    let output = check.output().unwrap();
    let said = text(&output.stdout).to_owned();
    assert!(output.status.success(), "{said}{}", text(&output.stderr));
    println!("{said}");
    said
}

fn check_the_page(said: &str) {
    // What a report of a fault needs.
    for part in ["mesoscope ", "system ", "adapter ", "driver ", env!("CARGO_PKG_VERSION"), std::env::consts::ARCH] {
        assert!(said.contains(part), "`{part}` is not in: {said}");
    }
    let of = |check: &str| -> &str {
        said.lines().find(|line| line.contains(check)).unwrap_or_else(|| panic!("no `{check}` in: {said}"))
    };
    for function in ["x / y", "sqrt", "inverseSqrt", "exp", "log", "sin", "cos", "pow", "x + y", "x * y", "round"] {
        assert!(of(&format!("function {function} ")).starts_with("ok "), "{said}");
    }
    assert!(of("contraction").contains("mirrored expressions"), "{said}");
    assert!(of("pairs, splitting").contains("total momentum constant to the last bit"), "{said}");
    assert!(of("pairs and a body force").contains("momentum, excluding the impulse of body forces"), "{said}");
    assert!(of("pairs between walls").contains("momentum, including that absorbed by walls"), "{said}");
    assert!(of("pairs beside frozen layers").contains("momentum, including that absorbed by walls"), "{said}");
    assert!(of("pairs in shear").contains("momentum, including that lost at sheared boundaries"), "{said}");
    assert!(
        of("Voronoi cells with energy").contains("mass, total momentum, total energy constant to the last bit"),
        "{said}"
    );
    for family in ["bonds and angles", "coloured noise", "shallow water with a bath", "shallow water, other solver"] {
        assert!(of(family).starts_with("ok ") && of(family).contains("of its change at most"), "{said}");
    }
    assert!(of("speed of `dpd-fluid`").contains("million particle-steps a second with 24000 particles"), "{said}");
    assert!(said.trim_end().ends_with("28 checks passed, 0 failed"), "{said}");
}

#[test]
fn an_adapter_to_check_has_to_exist_and_is_named_for_that_alone() {
    fails(&["adapters", "--check", "--adapter", "abacus"], 3, &["no adapter matches `abacus`"]);
    fails(&["adapters", "--adapter", "software"], 2, &["--check"]);
}
