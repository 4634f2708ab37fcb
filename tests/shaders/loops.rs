//! Every loop of a kernel that is compiled without counters of turns ends: see crates/shader-modules.

use std::fs;
use std::path::Path;

/// Folders of kernels that keep the counters: searches whose ends follow from geometry, and whole shaders of pictures and of checks.
const COUNTED: [&str; 3] = ["check", "plot", "tessellation"];

/// A loop that counts: its head, without `for`.
struct Counting<'t> {
    counter: &'t str,
    bound: &'t str,
    step: &'t str,
}

impl<'t> Counting<'t> {
    /// The head of a loop, as in `(var k = 0u; k < END; k++)`.
    fn new(head: &'t str) -> Option<Self> {
        let mut parts = head.trim().strip_prefix('(')?.strip_suffix(')')?.split("; ");
        let (first, bound, step) = (parts.next()?, parts.next()?, parts.next()?);
        let counter = first.strip_prefix("var ")?.split_once(" =")?.0;
        parts.next().is_none().then_some(Self { counter, bound, step })
    }

    /// Whether it ends by itself: it counts to a bound that the body leaves alone, or is a branch in the form of a loop.
    fn ends(&self, body: &str) -> bool {
        let Self { counter, bound, step } = self;
        let counts_up = [format!("{counter}++"), format!("{counter} <<= 1u")].contains(&(*step).to_owned())
            || step.strip_prefix(&format!("{counter} += ")).is_some_and(|by| by != "0u");
        let counts_down = [format!("{counter}--"), format!("{counter} >>= 1u")].contains(&(*step).to_owned());
        let conditions: Vec<&str> = bound.split(" && ").collect();
        let below = |condition: &&str| {
            let bounds = [" < ", " <= "].iter().find_map(|sign| condition.strip_prefix(&format!("{counter}{sign}")));
            bounds.is_some_and(|bound| words(bound).all(|word| !is_assigned(body, word)))
        };
        let above = |condition: &&str| *condition == format!("{counter} > 0u");
        let is_branch = [format!("{counter} = false"), format!("{counter} = 0u"), format!("{counter} = 0")]
            .contains(&(*step).to_owned())
            && [(*counter).to_owned(), format!("{counter} != 0u"), format!("{counter} != 0")]
                .contains(&(*bound).to_owned());
        let counts = counts_up && conditions.iter().any(below) || counts_down && conditions.iter().any(above);
        (counts || is_branch) && !is_assigned(body, counter)
    }
}

/// The names in an expression.
fn words(text: &str) -> impl Iterator<Item = &str> {
    text.split(|letter: char| !letter.is_alphanumeric() && letter != '_').filter(|word| !word.is_empty())
}

/// Whether a block gives a name, its members or its elements another value, or a pointer to it to a function.
fn is_assigned(block: &str, name: &str) -> bool {
    block.match_indices(name).any(|(place, _)| {
        let is_part = |letter: char| letter.is_alphanumeric() || letter == '_';
        let (before, mut rest) = (block[..place].chars().next_back(), &block[place + name.len()..]);
        if before.is_some_and(|letter| is_part(letter) || letter == '.') || rest.starts_with(is_part) {
            return false;
        }
        loop {
            if let Some(member) = rest.strip_prefix('.') {
                rest = member.trim_start_matches(is_part);
            } else if rest.starts_with('[') {
                rest = &rest[enclosed(rest).len()..];
            } else {
                break;
            }
        }
        let steps = ["++", "--"].iter().any(|sign| rest.starts_with(sign));
        let signs = ["=", "+=", "-=", "*=", "/=", "|=", "&=", "^=", "<<=", ">>="];
        before == Some('&') || steps || signs.iter().any(|sign| rest.starts_with(&format!(" {sign} ")))
    })
}

/// The text from its first letter, which is a bracket, to the one that closes it.
fn enclosed(text: &str) -> &str {
    let mut depth = 0;
    let end = text.find(|letter: char| {
        depth += i32::from("{[".contains(letter)) - i32::from("}]".contains(letter));
        depth == 0
    });
    &text[..=end.unwrap()]
}

/// Loops of a file that nothing says the end of.
fn endless(text: &str) -> Vec<String> {
    let lines: Vec<&str> = text.lines().collect();
    let mut found = Vec::new();
    let mut begin = 0;
    for (number, line) in lines.iter().enumerate() {
        let statement = line.split("//").next().unwrap_or_default();
        for keyword in ["for (", "while (", "loop {"] {
            let Some(place) = statement.find(keyword).filter(|place| {
                statement[..*place].chars().next_back().is_none_or(|letter| !letter.is_alphanumeric() && letter != '_')
            }) else {
                continue;
            };
            let says = lines[..number].iter().rev().take_while(|line| line.trim_start().starts_with("//"));
            let is_said = says.into_iter().any(|line| line.trim_start().starts_with("// Ends: "));
            let brace = begin + place + text[begin + place..].find('{').unwrap();
            let head = &text[begin + place + keyword.len() - 1..brace];
            let counting = (keyword == "for (").then(|| Counting::new(head)).flatten();
            let ends = counting.is_some_and(|counting| counting.ends(enclosed(&text[brace..])));
            if !ends && !is_said {
                found.push(format!("{}: {}", number + 1, line.trim()));
            }
        }
        begin += line.len() + 1;
    }
    found
}

#[test]
fn loops_without_counters_end() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("shaders");
    let (mut folders, mut loops, mut complaints) = (vec![root.clone()], 0, Vec::new());
    while let Some(folder) = folders.pop() {
        for entry in fs::read_dir(folder).unwrap() {
            let path = entry.unwrap().path();
            let inside = path.strip_prefix(&root).unwrap();
            let domain = inside.iter().next().unwrap().to_str().unwrap();
            if path.is_dir() && !COUNTED.contains(&domain) {
                folders.push(path);
            } else if path.extension().is_some_and(|extension| extension == "wgsl") && !COUNTED.contains(&domain) {
                let text = fs::read_to_string(&path).unwrap();
                loops += text.matches("for (").count();
                complaints.extend(endless(&text).into_iter().map(|line| format!("{}:{line}", inside.display())));
            }
        }
    }
    assert!(loops > 80, "{loops}");
    assert!(complaints.is_empty(), "loops whose end nothing says:\n{}", complaints.join("\n"));
}

#[test]
fn loops_that_may_not_end_are_found() {
    let ending = [
        "for (var k = 0u; k < END; k++) { sum += k; }",
        "for (var k = lane; k <= last.count; k += STRIDE) { if (sum < k) { sum = k; } }",
        "for (var axis = 0u; axis < 3u; axis++) { places[2u * axis] = 0u; own.axis = 1u; }",
        "for (var k = 8u; k > 0u; k >>= 1u) { sum += k; }",
        "for (var pending = failure; pending != 0u; pending = 0u) { store(pending); }",
        "// Ends: every turn clears a bit.\nwhile (mask != 0u) { mask &= mask - 1u; }",
    ];
    let endless_ones = [
        "for (var k = 0u; k < end; k++) { end += 1u; }",
        "for (var k = 0u; k < END; k++) { k = 0u; }",
        "for (var k = 0u; k < END; k++) { change(&k); }",
        "for (var k = 0u; k != END; k += 2u) { }",
        "for (var k = 0u; k < END; k += 0u) { }",
        "for (var k = 0u; k < list.count; k++) { list.count++; }",
        "for (var k = 0u; k < limits[0]; k++) { limits[a + 1u] = k; }",
        "for (var pending = 1u; pending != 0u; pending = 0u) { pending = 2u; }",
        "// It goes on.\nwhile (mask != 0u) { mask &= mask - 1u; }",
        "loop { if (done) { break; } }",
    ];
    assert_eq!(ending.map(endless), [const { Vec::<String>::new() }; 6]);
    assert_eq!(endless_ones.map(|text| endless(text).len()), [1; 10]);
}
