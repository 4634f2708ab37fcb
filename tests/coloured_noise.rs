//! Coloured noise: its process on the device against exact laws, and what it does to a gas.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

mod support;

use mesoscope::gpu::{link_texts, module_text};

#[test]
fn link_now() {
    for (space, direction) in [("space2", "direction2"), ("space3", "direction3")] {
        for jump in ["jump_kangaroo", "jump_kangaroo_exponential", "jump_short", "jump_literal"] {
            if jump == "jump_literal" && space != "space2" { continue; }
            for words in [vec!["words_pcg4d"], vec!["words_threefry", "threefry"]] {
                let mut names = vec!["control", space, direction, jump, "jump_words", "holds_on"];
                names.extend(words);
                let names: Vec<String> = names.iter().map(|n| format!("common/{n}")).collect();
                let mut texts: Vec<(&str, &str)> = names.iter().map(|n| (n.as_str(), module_text(n).unwrap())).collect();
                texts.push(("main", "@compute @workgroup_size(64)\nfn main(@builtin(global_invocation_id) i: vec3<u32>) { let h = advance_hold(i.x); let c = closing_of_hold(i.x); control.reserved = bitcast<u32>(h.opening.x + h.closing.x + c.x); }"));
                let linked = link_texts("test", &texts).unwrap_or_else(|e| panic!("{e}"));
                for m in ["", "force", "fraction", "halves", "jump"] {
                    println!("{m} {}", linked.layout[&("Hold".to_owned(), m.to_owned())]);
                }
            }
        }
    }
}
